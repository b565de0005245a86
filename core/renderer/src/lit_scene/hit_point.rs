//! A hit as a program sees it.

use glam::{DVec3, Vec3, Vec4};

use crate::accel::{Hit, Ray};
use crate::math::Frame;
use crate::scene::{CornerLayer, Object, Scene, visibility};
use crate::shader::{Aside, Point, Quantity, Value};

/// Least step aside (scene units): shorter ones drown in rounding.
const LEAST_STEP: f32 = 2e-5;

/// A hit that a program is run for.
pub(super) struct HitPoint<'a> {
    scene: &'a Scene,
    object: &'a Object,
    primitive: usize,
    barycentric: [f32; 2],
    p: Vec3,
    /// Normals as modelled.
    pub(super) ng: Vec3,
    pub(super) ns: Vec3,
    /// Towards where the ray came from.
    pub(super) wo: Vec3,
    /// Kinds of the ray.
    mask: u32,
    back: bool,
    /// Width of the ray (scene units).
    width: f32,
}

impl<'a> HitPoint<'a> {
    pub(super) fn new(scene: &'a Scene, ray: &Ray, hit: &Hit, [ng, ns]: [Vec3; 2], width: f32) -> Self {
        Self {
            scene,
            object: &scene.objects[hit.object as usize],
            primitive: hit.primitive as usize,
            barycentric: hit.barycentric,
            p: ray.origin + ray.direction * hit.t,
            ng,
            ns,
            wo: -ray.direction,
            mask: ray.mask,
            back: ray.direction.dot(ng) > 0.0,
            width,
        }
    }

    /// A normal on the viewer's side as one on the modelled side.
    pub(super) fn outward(&self, normal: Vec3) -> Vec3 {
        if self.back { -normal } else { normal }
    }

    /// The way to a place aside (scene units), along the surface.
    fn step(&self, Aside(widths): Aside) -> Vec3 {
        let length = |widths: f32| if widths > 0.0 { (self.width * widths).max(LEAST_STEP) } else { 0.0 };
        let frame = Frame::new(self.ng);
        frame.tangent * length(widths[0]) + frame.bitangent * length(widths[1])
    }

    /// The ways to the two places so many widths aside (scene units).
    fn scene_steps(&self, widths: f32) -> [Vec3; 2] {
        [Aside([widths, 0.0]), Aside([0.0, widths])].map(|aside| self.step(aside))
    }

    /// How the barycentric weights change along a vector in the plane of the triangle.
    fn barycentric_change(&self, [along_b, along_c]: [Vec3; 2], step: Vec3) -> [f32; 2] {
        let (bb, bc, cc) = (along_b.dot(along_b), along_b.dot(along_c), along_c.dot(along_c));
        let (b, c) = (step.dot(along_b), step.dot(along_c));
        let determinant = bb * cc - bc * bc;
        if determinant <= 0.0 {
            return [0.0; 2];
        }
        [(b * cc - c * bc) / determinant, (c * bb - b * bc) / determinant]
    }

    fn edges(&self) -> [Vec3; 2] {
        let [a, b, c] = self.object.corners(self.primitive);
        [(b - a).as_vec3(), (c - a).as_vec3()]
    }

    fn layer(&self, attribute: u32) -> Option<&CornerLayer> {
        self.object.mesh.layers.iter().find(|layer| layer.attribute == attribute)
    }

    fn world(&self, p: Vec3) -> Vec3 {
        let space = &self.scene.space;
        (p.as_dvec3() / space.scale + space.center).as_vec3()
    }

    fn kind(&self, bits: u32) -> f32 {
        f32::from(u8::from(self.mask & bits != 0))
    }

    /// Scene units as metres.
    #[expect(clippy::cast_possible_truncation, reason = "a power of two")]
    fn metres(&self) -> f32 {
        (1.0 / self.scene.space.scale) as f32
    }

    fn object_normal(&self, normal: Vec3) -> Vec3 {
        let to_scene = self.object.object_from_scene.matrix3.inverse();
        (to_scene.transpose() * normal.as_dvec3()).normalize_or_zero().as_vec3()
    }
}

impl Point for HitPoint<'_> {
    fn attribute(&self, attribute: u32, aside: Aside) -> Value {
        let Some(layer) = self.layer(attribute) else { return Value::default() };
        let [a, b, c] = layer.corners(self.primitive).map(Vec4::from_array);
        let (along_b, along_c) = (b - a, c - a);
        let [mut u, mut v] = self.barycentric;
        let edges = self.edges();
        if aside != Aside::HERE {
            let [du, dv] = self.barycentric_change(edges, self.step(aside));
            (u, v) = (u + du, v + dv);
        }
        let changes = self.scene_steps(1.0).map(|step| {
            let [du, dv] = self.barycentric_change(edges, step);
            (along_b * du + along_c * dv).truncate().length_squared()
        });
        let step = self.width.max(LEAST_STEP);
        let width = (0.5 * (changes[0] + changes[1])).sqrt() * (self.width / step);
        Value { v: a + along_b * u + along_c * v, width }
    }

    fn object_attribute(&self, attribute: u32) -> Vec4 {
        self.object.info.attribute(attribute)
    }

    fn geometry(&self, quantity: Quantity, aside: Aside) -> Value {
        let towards = |normal: Vec3| if self.back { -normal } else { normal };
        let number = Value::number;
        match quantity {
            Quantity::Position => {
                let v = self.world(self.p + self.step(aside)).extend(1.0);
                Value { v, width: self.width * self.metres() }
            }
            Quantity::ObjectPosition => {
                let to_object = &self.object.object_from_scene;
                let p: DVec3 = (self.p + self.step(aside)).as_dvec3();
                let scale = to_object.matrix3.determinant().abs().cbrt();
                #[expect(clippy::cast_possible_truncation, reason = "widths need no more than f32")]
                let width = self.width * scale as f32;
                Value { v: to_object.transform_point3(p).as_vec3().extend(1.0), width }
            }
            Quantity::Normal => Value::vector(towards(self.ns)),
            Quantity::ObjectNormal => Value::vector(self.object_normal(towards(self.ns))),
            Quantity::TrueNormal => Value::vector(towards(self.ng)),
            Quantity::Incoming => Value::vector(self.wo),
            Quantity::ObjectIncoming => Value::vector(self.object_normal(self.wo)),
            Quantity::Reflection => {
                let ns = towards(self.ns);
                Value::vector(ns * (2.0 * self.wo.dot(ns)) - self.wo)
            }
            Quantity::Parametric => {
                let [u, v] = self.barycentric;
                Value::vector(Vec3::new(1.0 - u - v, u, 0.0))
            }
            Quantity::Backfacing => number(f32::from(u8::from(self.back))),
            Quantity::ObjectLocation => {
                let origin = self.object.object_from_scene.inverse().translation.as_vec3();
                Value::vector(self.world(origin))
            }
            Quantity::ObjectColor => Value { v: Vec4::from_array(self.object.info.color), width: 0.0 },
            Quantity::ObjectIndex => number(self.object.info.index),
            Quantity::ObjectRandom => number(self.object.info.random),
            Quantity::RayLength => Value::default(),
            Quantity::IsCamera => number(self.kind(visibility::CAMERA)),
            Quantity::IsShadow => number(self.kind(visibility::SHADOW | visibility::BLOCKERS)),
            Quantity::IsDiffuse => number(self.kind(visibility::DIFFUSE)),
            Quantity::IsGlossy => number(f32::from(visibility::is_glossy(self.mask))),
            Quantity::IsReflection => number(f32::from(visibility::is_reflection(self.mask))),
            Quantity::IsTransmission => number(self.kind(visibility::TRANSMISSION)),
        }
    }

    fn steps(&self, widths: f32) -> [Vec3; 2] {
        self.scene_steps(widths).map(|step| step * self.metres())
    }

    fn tangents(&self, attribute: u32) -> Option<[Vec3; 3]> {
        let [a, b, c] = self.layer(attribute)?.corners(self.primitive).map(Vec4::from_array);
        let (uv_b, uv_c) = ((b - a).truncate(), (c - a).truncate());
        let to_object = self.object.object_from_scene.matrix3;
        let [along_b, along_c] = self.edges().map(|edge| (to_object * edge.as_dvec3()).as_vec3());
        let side = (uv_b.x * uv_c.y - uv_b.y * uv_c.x).signum();
        let along_u = (along_b * uv_c.y - along_c * uv_b.y) * side;
        let ns = self.object_normal(self.ns);
        let tangent = (along_u - ns * along_u.dot(ns)).try_normalize()?;
        // A mirrored object's corners go round the other way in its own space.
        let turn = along_b.cross(along_c).dot(self.object_normal(self.ng)).signum();
        Some([tangent, ns.cross(tangent) * (side * turn), ns])
    }

    fn world_normal(&self, normal: Vec3) -> Vec3 {
        let matrix = self.object.object_from_scene.matrix3.transpose();
        let normal = (matrix * normal.as_dvec3()).normalize_or_zero().as_vec3();
        if self.back { -normal } else { normal }
    }
}

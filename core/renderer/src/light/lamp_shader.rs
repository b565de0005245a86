//! Lamps whose light their nodes compute, from the point of the lamp that is seen and the direction in which it is seen, as
//! Cycles evaluates a lamp's shader: the lamp's normal (of what has none, the direction itself), its own space, and texture
//! coordinates over an area lamp, around a point lamp, and across a spot's cone or a sun's disk.
//!
//! Choosing and weighing lights takes such a lamp for one of its mean light, see [`LampShader::taken_for`]. What its nodes
//! give takes the place of that wherever light arrives: a shadow ray's, that of a ray that meets the lamp, and a photon's,
//! where it lands. So they may ask how far away the lamp is seen from.

use std::sync::Arc;

use glam::{DVec3, Vec2, Vec3, Vec4};

use super::distant::SceneBall;
use super::shape::Shape;
use super::{BRIGHTEST, Photon, positive};
use crate::color::Rgb;
use crate::sampling::PhotonSampler;
use crate::scene::{Lamp, LampProgram, LampShape, Scene, SceneSpace};
use crate::shader::{Aside, Point, Quantity, Texture, Value, around};

/// Photons whose mean light a lamp is taken for.
const LOOKS: u32 = 512;

/// The least power a lamp is taken for, so that what is divided by it stays finite.
const LEAST_POWER: f32 = 1e-12;

/// The program of a lamp, and all it may ask about the lamp.
pub(super) struct LampShader {
    program: LampProgram,
    lamp: Lamp,
    textures: Arc<[Texture]>,
    space: SceneSpace,
    /// Mean of the power and the factor.
    mean: Rgb,
    /// Mean of the channels of `mean`.
    taken_for: f32,
}

/// A lamp as it is seen along a ray.
#[derive(Clone, Copy, Debug)]
pub(super) struct Look {
    /// Where the ray starts.
    pub(super) from: Vec3,
    /// Unit vector towards the lamp.
    pub(super) wi: Vec3,
    /// From there to the lamp; infinite for suns.
    pub(super) distance: f32,
    /// How far the ray had come before.
    pub(super) before: f32,
}

impl LampShader {
    /// Looks at a lamp of this shape from where its photons go. `None` where no program computes its light.
    pub(super) fn new(lamp: &Lamp, shape: &Shape, scene: &Scene, ball: &SceneBall) -> Option<Self> {
        let mut shader = Self {
            program: lamp.program.clone()?,
            lamp: lamp.clone(),
            textures: Arc::clone(&scene.textures),
            space: scene.space,
            mean: Rgb::BLACK,
            taken_for: 0.0,
        };
        // One more, of factor 1: what no photon found may still be there.
        let (mut light, mut flux, all) = (lamp.power, 1.0, shape.flux(ball).mean());
        for id in 0..LOOKS {
            let mut sampler = PhotonSampler::new(u64::from(id), 0);
            let [x, y, d0, d1, along] = std::array::from_fn(|_| sampler.draw());
            let photon = shape.emit(ball, 0.0, [x, y], [d0, d1]);
            let weight = photon.flux.mean() / all;
            if weight.is_finite() {
                light += shader.light(&shader.look_of(&photon, shape, ball, along)) * weight;
                flux += weight;
            }
        }
        shader.mean = (light / flux).map(|c| c.min(BRIGHTEST));
        shader.taken_for = shader.mean.mean().max(LEAST_POWER);
        Some(shader)
    }

    /// What sees a photon somewhere on its way through the scene.
    fn look_of(&self, photon: &Photon, shape: &Shape, ball: &SceneBall, along: f32) -> Look {
        let reach = photon.lit_from.min(1.0) + along * ball.reach_from(self.lamp.position);
        let (from, wi) = (photon.origin + photon.direction * reach, -photon.direction);
        Look { from, wi, distance: shape.distance(from, wi), before: 0.0 }
    }

    /// Power, the same in each channel, of the lamp that this one is taken for.
    pub(super) fn taken_for(&self) -> f32 {
        self.taken_for
    }

    /// What light of the lamp it is taken for is on average.
    pub(super) fn on_average(&self, light: Rgb) -> Rgb {
        light / self.taken_for * self.mean
    }

    /// What light of the lamp it is taken for really is.
    #[inline(never)]
    pub(super) fn shown(&self, light: Rgb, look: &Look) -> Rgb {
        light / self.taken_for * self.light(look)
    }

    /// Power times the factor; black where that is no number.
    fn light(&self, look: &Look) -> Rgb {
        let sight = Sight::new(self, look);
        let registers = self.program.program.run(&sight, &self.textures);
        let light = self.lamp.power * registers[self.program.factor as usize].rgb();
        if light.is_finite() { positive(light) } else { Rgb::BLACK }
    }

    fn is_sun(&self) -> bool {
        matches!(self.lamp.shape, LampShape::Sun { .. })
    }

    /// Outward normal at a point that is seen along `wi`.
    fn normal(&self, p: Vec3, wi: Vec3) -> Vec3 {
        match self.lamp.shape {
            LampShape::Rectangle { .. } | LampShape::Ellipse { .. } => self.lamp.axis,
            LampShape::Point { radius, soft_falloff } | LampShape::Spot { radius, soft_falloff, .. }
                if radius > 0.0 && !soft_falloff =>
            {
                (p - self.lamp.position).try_normalize().unwrap_or(-wi)
            }
            _ => -wi,
        }
    }

    /// Texture coordinates of a point that is seen along `wi`, where the outward normal is `normal`.
    fn uv(&self, p: Vec3, wi: Vec3, normal: Vec3) -> Vec2 {
        let local = |v: Vec3| (self.program.lamp_from_world.matrix3 * v.as_dvec3()).as_vec3();
        let middle = Vec2::splat(0.5);
        match self.lamp.shape {
            LampShape::Rectangle { size, .. } | LampShape::Ellipse { size, .. } => {
                let offset = p - self.lamp.position;
                let place = Vec2::new(offset.dot(self.lamp.x_axis), offset.dot(self.lamp.y_axis));
                middle + (place / Vec2::from(size)).clamp(-middle, middle)
            }
            LampShape::Point { .. } => around(local(normal)).into(),
            // As wide as the cone.
            LampShape::Spot { cone_angle, .. } => {
                let leaving = local(-wi).normalize_or_zero();
                middle - leaving.truncate() * (0.5 / (0.5 * cone_angle).tan() / leaving.z)
            }
            LampShape::Sun { angle } => {
                let across = local(wi).truncate() / (wi - self.lamp.axis).length();
                let per_angle = if angle > 0.0 { 0.5 / (0.25 * angle).sin() } else { 0.0 };
                middle + across * per_angle
            }
        }
    }
}

/// A point of a lamp as a program sees it.
struct Sight<'a> {
    shader: &'a LampShader,
    look: Look,
    /// In scene space; of suns without meaning.
    p: Vec3,
    /// Outward, and on the viewer's side.
    outward: Vec3,
    normal: Vec3,
}

impl<'a> Sight<'a> {
    fn new(shader: &'a LampShader, look: &Look) -> Self {
        let p = if shader.is_sun() { look.from } else { look.from + look.wi * look.distance };
        let outward = shader.normal(p, look.wi);
        let normal = if outward.dot(look.wi) > 0.0 { -outward } else { outward };
        Self { shader, look: *look, p, outward, normal }
    }

    /// In world space (m); of suns the direction in which their light travels.
    fn position(&self) -> DVec3 {
        let space = &self.shader.space;
        if self.shader.is_sun() {
            -self.look.wi.as_dvec3()
        } else {
            self.p.as_dvec3() / space.scale + space.center
        }
    }

    fn ray_length(&self) -> f32 {
        let length = self.look.before + self.look.distance;
        if self.shader.is_sun() { f32::MAX } else { length / self.shader.space.scale as f32 }
    }

    /// A direction in the lamp's own space, turned as normals are.
    fn object_normal(&self, direction: Vec3) -> Vec3 {
        let to_world = self.shader.program.lamp_from_world.matrix3.inverse();
        (to_world.transpose() * direction.as_dvec3()).normalize_or_zero().as_vec3()
    }
}

impl Point for Sight<'_> {
    fn attribute(&self, _attribute: u32, _aside: Aside) -> Value {
        Value::default()
    }

    fn object_attribute(&self, attribute: u32) -> Vec4 {
        self.shader.program.info.attribute(attribute)
    }

    fn geometry(&self, quantity: Quantity, _aside: Aside) -> Value {
        let (program, wo) = (&self.shader.program, -self.look.wi);
        let number = Value::number;
        match quantity {
            Quantity::Position => Value::vector(self.position().as_vec3()),
            Quantity::ObjectPosition => {
                Value::vector(program.lamp_from_world.transform_point3(self.position()).as_vec3())
            }
            Quantity::Normal | Quantity::TrueNormal => Value::vector(self.normal),
            Quantity::ObjectNormal => Value::vector(self.object_normal(self.normal)),
            Quantity::Incoming => Value::vector(wo),
            Quantity::ObjectIncoming => Value::vector(self.object_normal(wo)),
            Quantity::Reflection => Value::vector(self.normal * (2.0 * wo.dot(self.normal)) - wo),
            Quantity::Parametric => {
                Value::vector(self.shader.uv(self.p, self.look.wi, self.outward).extend(0.0))
            }
            Quantity::Backfacing => number(f32::from(u8::from(self.outward != self.normal))),
            Quantity::ObjectLocation => {
                Value::vector(program.lamp_from_world.inverse().translation.as_vec3())
            }
            Quantity::ObjectColor => Value { v: Vec4::from_array(program.info.color), width: 0.0 },
            Quantity::ObjectIndex => number(program.info.index),
            Quantity::ObjectRandom => number(program.info.random),
            Quantity::RayLength => number(self.ray_length()),
            // As in Cycles, which asks once for all rays.
            Quantity::IsCamera
            | Quantity::IsShadow
            | Quantity::IsDiffuse
            | Quantity::IsGlossy
            | Quantity::IsReflection
            | Quantity::IsTransmission => Value::default(),
        }
    }

    fn steps(&self, _widths: f32) -> [Vec3; 2] {
        [Vec3::ZERO; 2]
    }

    fn tangents(&self, _attribute: u32) -> Option<[Vec3; 3]> {
        None
    }

    fn world_normal(&self, normal: Vec3) -> Vec3 {
        let matrix = self.shader.program.lamp_from_world.matrix3.transpose();
        let normal = (matrix * normal.as_dvec3()).normalize_or_zero().as_vec3();
        if self.outward == self.normal { normal } else { -normal }
    }
}

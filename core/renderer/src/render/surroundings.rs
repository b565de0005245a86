//! What the pyramid is made around: the surfaces whose light is read, and which side of them light can come to; the floor
//! under a box and the inside of a wall are hidden.

use glam::Vec3;

use crate::accel::{Hit, LANES, Packet, Ray};
use crate::bsdf::LobeSet;
use crate::lit_scene::LitScene;
use crate::math::{Frame, Side};
use crate::progress::Progress;
use crate::pyramid::{Openness, SidePoint, SurfaceTriangle, Surroundings};
use crate::scene::{MIDDLE, visibility};

/// How far inside a solid a surface is known to be hidden (cells).
const DEEPEST: f32 = 16.0;

/// Straight up and, at 60° from there, to four sides.
const DIRECTIONS: [Vec3; 5] = [
    Vec3::Z,
    Vec3::new(0.866, 0.0, 0.5),
    Vec3::new(0.0, 0.866, 0.5),
    Vec3::new(-0.866, 0.0, 0.5),
    Vec3::new(0.0, -0.866, 0.5),
];

/// A scene as the pyramid sees it.
pub(super) struct SceneSurroundings<'a> {
    lit: &'a LitScene<'a>,
    /// Object and primitive of the triangles whose light is read.
    triangles: Vec<(u32, u32)>,
    progress: &'a Progress,
}

impl<'a> SceneSurroundings<'a> {
    pub(super) fn new(lit: &'a LitScene<'a>, progress: &'a Progress) -> Self {
        let mut triangles: Vec<(u32, u32)> = Vec::new();
        let objects = lit.accel.scene().objects.iter().filter(|_| lit.plan.indirect());
        for (index, object) in (0..).zip(objects) {
            let primitives = 0..object.mesh.triangles.len();
            let received =
                primitives.filter(|&i| lit.materials[object.material(i)].classes().intersects(LobeSet::READ));
            #[expect(clippy::cast_possible_truncation, reason = "meshes have fewer than 2^32 triangles")]
            triangles.extend(received.map(|i| (index, i as u32)));
        }
        Self { lit, triangles, progress }
    }

    /// The side of a surface that a ray from the point meets, where it brings no light for that.
    fn end(&self, point: &SidePoint, ray: &Ray, hit: &Hit) -> Option<Side> {
        let (ng, material) = self.lit.accel.triangle(hit.object, hit.primitive);
        let met = Side::met(ng, ray.direction);
        let from_inside = met.back != point.side.back;
        ((from_inside || hit.t < point.cell_size) && self.lit.materials[material].is_opaque()).then_some(met)
    }
}

impl Surroundings for SceneSurroundings<'_> {
    fn triangle_count(&self) -> usize {
        self.triangles.len()
    }

    fn triangle(&self, i: usize) -> SurfaceTriangle {
        let (object, primitive) = self.triangles[i];
        let of = &self.lit.accel.scene().objects[object as usize];
        let material = &self.lit.materials[of.material(primitive as usize)];
        SurfaceTriangle {
            corners: of.corners(primitive as usize),
            normal: self.lit.accel.geometric_normal(object, primitive),
            glossy: material.classes().intersects(LobeSet::ROUGH),
        }
    }

    /// Open is where a ray straight up, or one of four leaning ones, meets nothing opaque within a cell, and does not meet a
    /// surface from inside soon after. From a front one sees fronts, and from a back backs, unless the point lies inside
    /// another solid.
    fn openness(&self, points: &[SidePoint]) -> Vec<Openness> {
        let mut openness = vec![Openness::default(); points.len()];
        // Neighbours on one side look the same way: their rays stay together.
        let (mut asked, backs): (Vec<usize>, Vec<usize>) =
            (0..points.len()).partition(|&i| !points[i].side.back);
        asked.extend(backs);
        let mut packet = Packet::default();
        for (number, direction) in DIRECTIONS.into_iter().enumerate() {
            let mut ended = Vec::new();
            for sixteen in asked.chunks(LANES) {
                packet.clear();
                for (lane, &i) in sixteen.iter().enumerate() {
                    let SidePoint { p, side, cell_size } = points[i];
                    let towards = Frame::new(side.normal).from_local(direction);
                    let ray = Ray::leaving(p, side.normal, towards, visibility::DIFFUSE, MIDDLE);
                    packet.set(lane, &ray, DEEPEST * cell_size);
                }
                self.lit.accel.intersect_packet(&mut packet);
                for (lane, &i) in sixteen.iter().enumerate() {
                    let ray = packet.ray(lane);
                    let end = packet.hit(lane).and_then(|hit| Some((hit, self.end(&points[i], &ray, &hit)?)));
                    let Some((hit, met)) = end else {
                        openness[i].is_open = true;
                        continue;
                    };
                    ended.push(i);
                    if number == 0 && hit.t < points[i].cell_size {
                        openness[i].above = Some((ray.origin + hit.t * ray.direction, met.other()));
                    }
                }
            }
            asked = ended;
        }
        openness
    }

    fn leads_out(&self, point: &SidePoint) -> bool {
        let SidePoint { p, side, .. } = *point;
        let frame = Frame::new(side.normal);
        let mut packet = Packet::default();
        for (lane, direction) in [Vec3::X, Vec3::Y, Vec3::NEG_X, Vec3::NEG_Y].into_iter().enumerate() {
            let ray = Ray::leaving(p, side.normal, frame.from_local(direction), visibility::DIFFUSE, MIDDLE);
            packet.set(lane, &ray, f32::INFINITY);
        }
        self.lit.accel.intersect_packet(&mut packet);
        (0..4)
            .any(|lane| packet.hit(lane).is_none_or(|hit| self.end(point, &packet.ray(lane), &hit).is_none()))
    }

    fn see(&self, pairs: &[[Vec3; 2]]) -> Vec<bool> {
        let mut packet = Packet::default();
        let mut seen = Vec::with_capacity(pairs.len());
        for sixteen in pairs.chunks(LANES) {
            packet.clear();
            for (lane, &[p, q]) in sixteen.iter().enumerate() {
                // No unit vector: the other point is at the end of it.
                let ray = Ray { origin: p, direction: q - p, mask: visibility::DIFFUSE, time: MIDDLE };
                packet.set(lane, &ray, 1.0);
            }
            self.lit.accel.occluded_packet(&mut packet);
            seen.extend((0..sixteen.len()).map(|lane| packet.is_free(lane)));
        }
        seen
    }

    fn keep_going(&self) -> bool {
        !self.progress.is_cancelled()
    }
}

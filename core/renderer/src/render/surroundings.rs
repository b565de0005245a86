//! What the pyramid is made around: the surfaces whose light is read, and which side of them light can come to; the floor
//! under a box and the inside of a wall are hidden.

use glam::Vec3;

use crate::accel::{Hit, LANES, Packet, Ray};
use crate::bsdf::LobeSet;
use crate::lit_scene::LitScene;
use crate::math::{Frame, Side};
use crate::progress::Progress;
use crate::pyramid::{SidePoint, SurfaceTriangle, Surroundings};
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

    /// Whether a ray from the point brings no light.
    fn ends(&self, point: &SidePoint, direction: Vec3, hit: &Hit) -> bool {
        let (ng, material) = self.lit.accel.triangle(hit.object, hit.primitive);
        let from_inside = Side::met(ng, direction).back != point.side.back;
        (from_inside || hit.t < point.cell_size) && self.lit.materials[material].is_opaque()
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

    /// Whether a ray straight up, or one of four leaning ones, meets nothing opaque within a cell, and does not meet a surface
    /// from inside soon after. From a front one sees fronts, and from a back backs, unless the point lies inside another solid.
    fn open(&self, points: &[SidePoint]) -> Vec<bool> {
        let mut open = vec![false; points.len()];
        // Neighbours on one side look the same way: their rays stay together.
        let (mut asked, backs): (Vec<usize>, Vec<usize>) =
            (0..points.len()).partition(|&i| !points[i].side.back);
        asked.extend(backs);
        let mut packet = Packet::default();
        for direction in DIRECTIONS {
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
                    let hit = packet.hit(lane);
                    if hit.is_some_and(|hit| self.ends(&points[i], packet.ray(lane).direction, &hit)) {
                        ended.push(i);
                    } else {
                        open[i] = true;
                    }
                }
            }
            asked = ended;
        }
        open
    }

    fn sees(&self, p: Vec3, q: Vec3) -> bool {
        self.lit.accel.sees(p, q)
    }

    fn keep_going(&self) -> bool {
        !self.progress.is_cancelled()
    }
}

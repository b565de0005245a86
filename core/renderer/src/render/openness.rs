//! Which side of a surface light can come to: the floor under a box and the inside of a wall are hidden.

use glam::Vec3;

use crate::accel::{Hit, LANES, Packet, Ray};
use crate::lit_scene::LitScene;
use crate::math::{Frame, Side};
use crate::pyramid::SidePoint;
use crate::scene::{MIDDLE, visibility};

/// How far inside a solid a surface is known to be hidden: so many cells of its level, or of the finest level that is
/// everywhere, if these are larger.
const DEEPEST: f32 = 16.0;

/// Straight up and, at 60° from there, to four sides.
const DIRECTIONS: [Vec3; 5] = [
    Vec3::Z,
    Vec3::new(0.866, 0.0, 0.5),
    Vec3::new(0.0, 0.866, 0.5),
    Vec3::new(-0.866, 0.0, 0.5),
    Vec3::new(0.0, -0.866, 0.5),
];

/// Of each point on the side of a surface, whether light can come to it: whether a ray straight up, or one of four leaning
/// ones, meets nothing opaque within a cell, and does not meet a surface from inside soon after. From a front one sees
/// fronts, and from a back backs, unless the point lies inside another solid.
pub(super) fn open(lit: &LitScene<'_>, base_cell_size: f32, points: &[SidePoint]) -> Vec<bool> {
    let mut open = vec![false; points.len()];
    // Neighbours on one side look the same way: their rays stay together.
    let (mut asked, backs): (Vec<usize>, Vec<usize>) = (0..points.len()).partition(|&i| !points[i].side.back);
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
                packet.set(lane, &ray, DEEPEST * cell_size.max(base_cell_size));
            }
            lit.accel.intersect_packet(&mut packet);
            for (lane, &i) in sixteen.iter().enumerate() {
                let hit = packet.hit(lane);
                if hit.is_some_and(|hit| {
                    ends(lit, base_cell_size, &points[i], packet.ray(lane).direction, &hit)
                }) {
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

/// Whether a ray from the point brings no light.
fn ends(lit: &LitScene<'_>, base_cell_size: f32, point: &SidePoint, direction: Vec3, hit: &Hit) -> bool {
    let (ng, material) = lit.accel.triangle(hit.object, hit.primitive);
    let from_inside = Side::met(ng, direction).back != point.side.back;
    (from_inside || hit.t < point.cell_size.max(base_cell_size)) && lit.materials[material].is_opaque()
}

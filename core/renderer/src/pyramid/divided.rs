//! Surface of a cell that something divides: the floor on both sides of a thin wall.
//!
//! Looked for along a rim: around a large part, or through the outermost points of many small ones. What merely stands on
//! the surface, or ends within the cell, does not block the way along the rim twice.

use std::sync::atomic::{AtomicU64, Ordering};

use arrayvec::ArrayVec;
use glam::{DVec3, Vec3};
use rayon::prelude::*;

use super::clip::Part;
use super::grid::{Grid, LevelBox};
use super::index::CellKey;
use super::layout::Layout;
use super::mixed::LIFT;
use super::surfaces::OpenSum;
use super::{SidePoint, Surroundings};
use crate::math::Side;

/// How far from a part's center its corners are asked about (share of the way).
const NEAR_CORNER: f64 = 0.95;

/// Whether two groups of a part's corners lie open and do not see each other along the part's rim.
pub(super) fn is_part_divided(
    part: &Part<'_>,
    side: Side,
    cell_size: f32,
    grid: &Grid,
    scene: &impl Surroundings,
) -> bool {
    let corner = |&corner: &DVec3| (part.centroid + NEAR_CORNER * (corner - part.centroid)).as_vec3();
    let corners: Vec<Vec3> = part.corners.iter().map(corner).map(|corner| grid.position(corner)).collect();
    let blocked = blocked(&corners, LIFT * cell_size * side.normal, scene);
    let Some(first) = blocked.iter().position(|&blocked| blocked) else { return false };
    if !blocked[first + 1..].contains(&true) {
        return false;
    }
    let points: Vec<SidePoint> = corners.iter().map(|&p| SidePoint { p, side, cell_size }).collect();
    let openness = scene.openness(&points);
    let (mut groups, mut is_open) = (0, false);
    for i in (0..corners.len()).map(|i| (first + 1 + i) % corners.len()) {
        is_open |= openness[i].is_open;
        if blocked[i] {
            groups += u32::from(is_open);
            is_open = false;
        }
    }
    groups > 1
}

/// Notes which cells of a level something divides, as their rims tell.
pub(super) fn find_divided(layout: &Layout, level: usize, sums: &[OpenSum], scene: &impl Surroundings) {
    let level_box = &layout.grid.levels[level];
    layout.levels[level].keys.par_iter().zip(sums).for_each(|(key, sum)| {
        let (rim, normal) = sum.rim();
        if rim.has_points() && rim.is_divided(*key, level_box, normal, &layout.grid, scene) {
            sum.divide();
        }
    });
}

/// For each point, whether it does not see the next one, the last one the first, when both are lifted.
fn blocked(points: &[Vec3], lift: Vec3, scene: &impl Surroundings) -> Vec<bool> {
    let next = points.iter().cycle().skip(1);
    points.iter().zip(next).map(|(&p, &q)| !scene.sees(p + lift, q + lift)).collect()
}

/// The outermost open points of a cell's surface, one in each quarter around the cell's middle.
#[derive(Debug, Default)]
pub(super) struct Rim([AtomicU64; 4]);

/// Steps of a cell's edge in which points are kept, in 16 bits.
const STEPS: f32 = 65_535.0;

impl Rim {
    /// Takes a point into account, which lies in a cell `inside` from 0 to 1 by axis, on a surface with a unit normal.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "16 bits each")]
    pub(super) fn add(&self, inside: Vec3, normal: Vec3) {
        let steep = normal.abs().max_position();
        let [u, v] = [(steep + 1) % 3, (steep + 2) % 3].map(|axis| inside[axis] - 0.5);
        // In the order in which the quarters follow each other.
        let quarter = if v < 0.0 { usize::from(u < 0.0) } else { 2 + usize::from(u >= 0.0) };
        let steps = |x: f32| (x.clamp(0.0, 1.0) * STEPS).round() as u64;
        let outward = steps(2.0 * u.abs().max(v.abs())).max(1);
        let [x, y, z] = inside.to_array().map(steps);
        self.0[quarter].fetch_max(outward << 48 | x << 32 | y << 16 | z, Ordering::Relaxed);
    }

    /// Whether there are enough points to tell anything: two have one way between them, which says little.
    pub(super) fn has_points(&self) -> bool {
        self.0.iter().filter(|bits| bits.load(Ordering::Relaxed) > 0).count() > 2
    }

    /// Whether points of the rim do not see each other along it.
    #[expect(clippy::cast_precision_loss, reason = "16 bits each")]
    pub(super) fn is_divided(
        &self,
        key: CellKey,
        level: &LevelBox,
        normal: Vec3,
        grid: &Grid,
        scene: &impl Surroundings,
    ) -> bool {
        let low = level.lattice(key.cell(level).0).as_vec3();
        let point = |bits: u64| {
            let inside = [32, 16, 0].map(|shift| (bits >> shift & 0xffff) as f32 / STEPS);
            grid.position((low + Vec3::from(inside)) * level.cell_size)
        };
        let points = self.0.iter().map(|bits| bits.load(Ordering::Relaxed)).filter(|&bits| bits > 0);
        let points: ArrayVec<Vec3, 4> = points.map(point).collect();
        blocked(&points, LIFT * level.cell_size * normal, scene)
            .into_iter()
            .filter(|&blocked| blocked)
            .count()
            > 1
    }
}

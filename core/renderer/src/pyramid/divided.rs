//! Surface of a cell that something divides: the floor on both sides of a thin wall.
//!
//! Looked for along a rim: around a large part, or through the outermost points of many small ones. What merely stands on
//! the surface, or ends within the cell, does not block the way along the rim twice.

use std::ops::Range;
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

/// Rims of parts that wait to be asked about.
#[derive(Debug, Default)]
pub(super) struct PartRims {
    rims: Vec<PartRim>,
    /// Of all of them, one after the other.
    corners: Vec<Vec3>,
    /// From each corner to the next one of its part, both lifted.
    ways: Vec<[Vec3; 2]>,
}

#[derive(Debug)]
struct PartRim {
    /// Level and place of the cell that the part lies in.
    cell: (usize, usize),
    side: Side,
    cell_size: f32,
    corners: Range<usize>,
}

impl PartRims {
    /// Adds the rim of a part that lies in a cell.
    pub(super) fn add(
        &mut self,
        cell: (usize, usize),
        part: &Part<'_>,
        side: Side,
        cell_size: f32,
        grid: &Grid,
    ) {
        let first = self.corners.len();
        let corner = |corner: &DVec3| (part.centroid + NEAR_CORNER * (corner - part.centroid)).as_vec3();
        self.corners.extend(part.corners.iter().map(|p| grid.position(corner(p))));
        let corners = first..self.corners.len();
        self.ways.extend(ways(&self.corners[corners.clone()], LIFT * cell_size * side.normal));
        self.rims.push(PartRim { cell, side, cell_size, corners });
    }

    /// Gives level and place to `divide` where two groups of a part's corners lie open and do not see each other along the
    /// part's rim.
    pub(super) fn ask(&mut self, scene: &impl Surroundings, mut divide: impl FnMut((usize, usize))) {
        let seen = scene.see(&self.ways);
        for rim in self.rims.drain(..) {
            let (corners, seen) = (&self.corners[rim.corners.clone()], &seen[rim.corners.clone()]);
            if rim.is_divided(corners, seen, scene) {
                divide(rim.cell);
            }
        }
        self.corners.clear();
        self.ways.clear();
    }
}

impl PartRim {
    /// `seen`: whether each corner sees the next one.
    fn is_divided(&self, corners: &[Vec3], seen: &[bool], scene: &impl Surroundings) -> bool {
        let Some(first) = seen.iter().position(|&seen| !seen) else { return false };
        if !seen[first + 1..].contains(&false) {
            return false;
        }
        let &Self { side, cell_size, .. } = self;
        let points: Vec<SidePoint> = corners.iter().map(|&p| SidePoint { p, side, cell_size }).collect();
        let openness = scene.openness(&points);
        let (mut groups, mut is_open) = (0, false);
        for i in (0..corners.len()).map(|i| (first + 1 + i) % corners.len()) {
            is_open |= openness[i].is_open;
            if !seen[i] {
                groups += u32::from(is_open);
                is_open = false;
            }
        }
        groups > 1
    }
}

/// Notes which cells of a level something divides, as their rims tell.
pub(super) fn find_divided(layout: &Layout, level: usize, sums: &[OpenSum], scene: &impl Surroundings) {
    const CELLS: usize = 256;
    let level_box = &layout.grid.levels[level];
    let cells = layout.levels[level].keys.par_chunks(CELLS).zip(sums.par_chunks(CELLS));
    cells.for_each(|(keys, sums)| {
        let (mut asked, mut all_ways) = (Vec::new(), Vec::new());
        for (key, sum) in keys.iter().zip(sums) {
            let (rim, normal) = sum.rim();
            if rim.has_points() {
                let points = rim.points(*key, level_box, &layout.grid);
                asked.push((sum, points.len()));
                all_ways.extend(ways(&points, LIFT * level_box.cell_size * normal()));
            }
        }
        let mut seen = scene.see(&all_ways).into_iter();
        for (sum, points) in asked {
            if seen.by_ref().take(points).filter(|&seen| !seen).count() > 1 {
                sum.divide();
            }
        }
    });
}

/// From each point to the next one, from the last one to the first, all lifted.
fn ways(points: &[Vec3], lift: Vec3) -> impl Iterator<Item = [Vec3; 2]> {
    let next = points.iter().cycle().skip(1);
    points.iter().zip(next).map(move |(&p, &q)| [p + lift, q + lift])
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

    /// The points, one beside the other.
    #[expect(clippy::cast_precision_loss, reason = "16 bits each")]
    fn points(&self, key: CellKey, level: &LevelBox, grid: &Grid) -> ArrayVec<Vec3, 4> {
        let low = level.lattice(key.cell(level).0).as_vec3();
        let point = |bits: u64| {
            let inside = [32, 16, 0].map(|shift| (bits >> shift & 0xffff) as f32 / STEPS);
            grid.position((low + Vec3::from(inside)) * level.cell_size)
        };
        let points = self.0.iter().map(|bits| bits.load(Ordering::Relaxed)).filter(|&bits| bits > 0);
        points.map(point).collect()
    }
}

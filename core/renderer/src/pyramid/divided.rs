//! Parts of a surface that something divides within one cell: the floor on both sides of a thin wall.

use super::clip::Part;
use super::grid::Grid;
use super::mixed::LIFT;
use super::{SidePoint, Surroundings};
use crate::math::Side;

/// How far from a part's center its corners are asked about (share of the way).
const NEAR_CORNER: f64 = 0.95;

/// Whether two groups of a part's corners lie open and do not see each other along the part's rim. What merely stands on
/// the part, or ends within it, does not divide it.
pub(super) fn is_divided(
    part: &Part<'_>,
    side: Side,
    cell_size: f32,
    grid: &Grid,
    scene: &impl Surroundings,
) -> bool {
    let corner = |i: usize| {
        let corner = part.corners[i % part.corners.len()];
        (part.centroid + NEAR_CORNER * (corner - part.centroid)).as_vec3()
    };
    let lifted = |i: usize| grid.position(corner(i) + LIFT * cell_size * side.normal);
    let corners = 0..part.corners.len();
    let blocked: Vec<bool> = corners.clone().map(|i| !scene.sees(lifted(i), lifted(i + 1))).collect();
    let Some(first) = blocked.iter().position(|&blocked| blocked) else { return false };
    if blocked[first + 1..].iter().all(|&blocked| !blocked) {
        return false;
    }
    let points: Vec<SidePoint> =
        corners.clone().map(|i| SidePoint { p: grid.position(corner(i)), side, cell_size }).collect();
    let open = scene.open(&points);
    let (mut groups, mut is_open) = (0, false);
    for i in corners.map(|i| (first + 1 + i) % blocked.len()) {
        is_open |= open[i];
        if blocked[i] {
            groups += u32::from(is_open);
            is_open = false;
        }
    }
    groups > 1
}

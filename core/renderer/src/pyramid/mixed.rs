//! Mixed cells: those that hold surfaces which do not see each other, such as the floor on both sides of a wall.
//!
//! Their mean is the light of neither. They are found by short visibility rays between the parts of a cell, or along the
//! rim of a part, and read from finer cells instead or not at all: no light leaks through walls, however thin, and what
//! is hidden (the floor under a box) does not darken what is not.

use std::sync::atomic::{AtomicBool, Ordering};

use glam::Vec3;
use rayon::prelude::*;

use super::Surroundings;
use super::accumulator::CellSum;
use super::layout::Layout;
use super::surfaces::Surfaces;

/// Visibility rays start this far above the surface (cells): above its own curvature, below what stands on it.
pub(super) const LIFT: f32 = 0.25;

/// Cells whose rays are traced together.
const TOGETHER: usize = 512;

/// By level, by place: whether the cell is mixed. Only cells that hold light are asked about.
pub(super) fn mixed_cells(
    layout: &Layout,
    surfaces: &Surfaces<'_>,
    sums: &[Vec<CellSum>],
    scene: &impl Surroundings,
) -> Vec<Vec<bool>> {
    let finest = layout.levels.len() - 1;
    let own = |level: usize, place: usize| surfaces.levels[level].surfaces[place].centroid();
    let mut points: Vec<Vec3> =
        (0..layout.levels[finest].keys.len()).map(|place| own(finest, place)).collect();
    let mut mixed: Vec<Vec<bool>> = surfaces.levels.iter().map(|level| level.divided.clone()).collect();
    for level in (1..=finest).rev() {
        let (cells, surfaces) = (0..layout.levels[level].keys.len(), &surfaces.levels[level].surfaces);
        // A cell is represented by the largest of its parts, so that its point lies on a surface.
        let mut largest: Vec<Option<usize>> = vec![None; layout.levels[level - 1].keys.len()];
        for place in cells.clone() {
            let Some(parent) = layout.parent(level, place) else { continue };
            let area = |place: usize| surfaces[place].area;
            if area(place) == 0 {
                continue;
            }
            if largest[parent].is_none_or(|other| area(place) > area(other)) {
                largest[parent] = Some(place);
            }
        }
        let lift = LIFT * layout.grid.levels[level].cell_size;
        let lifted =
            |place: usize| layout.grid.position(points[place] + surfaces[place].mean_normal() * lift);
        let flags: Vec<AtomicBool> =
            mixed[level - 1].iter().map(|&divided| AtomicBool::new(divided)).collect();
        (0..cells.len().div_ceil(TOGETHER)).into_par_iter().for_each(|some| {
            let (mut parents, mut pairs) = (Vec::new(), Vec::new());
            for place in cells.clone().skip(some * TOGETHER).take(TOGETHER) {
                let Some(parent) = layout.parent(level, place) else { continue };
                let Some(largest) = largest[parent].filter(|_| surfaces[place].area > 0) else { continue };
                if sums[level - 1][parent].count == 0 || flags[parent].load(Ordering::Relaxed) {
                    continue;
                }
                if mixed[level][place] {
                    flags[parent].store(true, Ordering::Relaxed);
                } else if place != largest {
                    parents.push(parent);
                    pairs.push([lifted(place), lifted(largest)]);
                }
            }
            for (parent, _) in parents.into_iter().zip(scene.see(&pairs)).filter(|(_, seen)| !seen) {
                flags[parent].store(true, Ordering::Relaxed);
            }
        });
        mixed[level - 1] = flags.into_iter().map(AtomicBool::into_inner).collect();
        points = largest
            .iter()
            .enumerate()
            .map(|(place, largest)| largest.map_or_else(|| own(level - 1, place), |child| points[child]))
            .collect();
    }
    mixed
}

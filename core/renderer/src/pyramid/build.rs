//! From sums to a pyramid that can be read: levels merged octree-wise, sparse cells given their parent's value.

use rayon::prelude::*;

use super::accumulator::{Accumulator, CellSum};
use super::index::{CellKey, LevelIndex};
use super::layout::{Layout, LevelLayout};
use super::{Cell, Level, Pyramid};
use crate::color::Rgb;

/// A cell with less surface than this part of its face is read from its parent: a single photon there would be a spark.
const SLIVER: f64 = 0.1;

impl Pyramid {
    /// Merges the levels and settles which cells are read from their parents: those whose *parent* holds fewer than
    /// `4 × photons_per_cell` photons (a rule on the cell's own count would brighten the picture), and slivers.
    #[must_use]
    pub fn build(accumulator: Accumulator<'_>, layout: &Layout, photons_per_cell: u32) -> Self {
        let (mut sums, quantum) = accumulator.into_sums();
        merge(layout, &mut sums);
        let enough = 4 * u64::from(photons_per_cell);
        let mut levels: Vec<Level> = Vec::with_capacity(sums.len());
        for (number, cells) in layout.levels.iter().enumerate() {
            let parents = levels.last();
            let values = (0..cells.keys.len()).into_par_iter().map(|place| {
                let own = Cell::new(
                    irradiance(layout, cells, &sums[number], place, quantum),
                    sums[number][place].count >= enough,
                );
                let (Some(parents), true) = (parents, number > 0) else { return own };
                let (cell, class) = cells.keys[place].cell(&layout.grid.levels[number]);
                let Some(parent) = layout.grid.parent(number, cell).and_then(|c| parents.find(c, class))
                else {
                    return own;
                };
                let face = f64::from(layout.grid.levels[number].cell_size).powi(2);
                let sliver = (cells.surfaces[place].area as f64 * layout.area_unit) < SLIVER * face;
                if parent.holds_enough() && !sliver {
                    own
                } else {
                    Cell::new(parent.irradiance(), own.holds_enough())
                }
            });
            let values: Vec<Cell> = values.collect();
            levels.push(keep_lit(layout, number, cells, &sums[number], &values));
        }
        Self { grid: layout.grid.clone(), classes: layout.classes, levels }
    }
}

/// Adds every cell to its parent, from the finest level up.
fn merge(layout: &Layout, sums: &mut [Vec<CellSum>]) {
    for level in (1..sums.len()).rev() {
        let (coarser, finer) = sums.split_at_mut(level);
        for (key, sum) in layout.levels[level].keys.iter().zip(&finer[0]).filter(|(_, sum)| sum.count > 0) {
            let (cell, class) = key.cell(&layout.grid.levels[level]);
            let parent = layout.grid.parent(level, cell);
            if let Some(place) = parent.and_then(|c| layout.levels[level - 1].index.find(c, class)) {
                coarser[level - 1][place].add(sum);
            }
        }
    }
}

#[expect(clippy::cast_precision_loss, clippy::cast_possible_truncation, reason = "f32 is what is read")]
fn irradiance(layout: &Layout, cells: &LevelLayout, sums: &[CellSum], place: usize, quantum: f64) -> Rgb {
    let area = cells.surfaces[place].area as f64 * layout.area_unit;
    Rgb(sums[place].flux.map(|flux| (flux as f64 * quantum / area) as f32))
}

/// Cells without a photon need no memory: what is missing is dark where its parent holds enough photons to know, and
/// else read from the parent.
fn keep_lit(layout: &Layout, number: usize, cells: &LevelLayout, sums: &[CellSum], values: &[Cell]) -> Level {
    let lit = |place: &usize| sums[*place].count > 0;
    let places: Vec<usize> = (0..values.len()).filter(lit).collect();
    let keys = places.iter().map(|&place| -> CellKey { cells.keys[place] });
    let index = LevelIndex::new(&layout.grid.levels[number], layout.classes.count(), keys);
    Level { index, cells: places.iter().map(|&place| values[place]).collect() }
}

//! From sums to a pyramid that can be read: levels merged octree-wise, sparse cells given their parent's value.

use std::collections::BTreeMap;
use std::time::Instant;

use glam::Vec3;
use rayon::prelude::*;

use super::accumulator::{Accumulator, CellSum, SETS, Sums};
use super::bins::BinStore;
use super::grid::Grid;
use super::index::{CellKey, LevelIndex};
use super::layout::Layout;
use super::mixed::mixed_cells;
use super::{Cell, Level, Pyramid};
use crate::color::Rgb;
use crate::math::Frame;

/// A cell with less surface than this part of its face is read from its parent: a single photon there would be a spark.
const SLIVER: f64 = 0.1;

impl Pyramid {
    /// Merges the levels and settles which cells are read from their parents: those whose *parent* holds fewer than
    /// `4 × photons_per_cell` photons (a rule on the cell's own count would brighten the picture), and slivers. `visible`
    /// tells whether two points see each other: cells whose parts do not are read from finer ones. `None` once
    /// `keep_going` says no.
    #[must_use]
    pub fn build(
        accumulator: Accumulator<'_>,
        layout: &Layout,
        photons_per_cell: u32,
        visible: impl Fn(Vec3, Vec3) -> bool + Sync,
        keep_going: impl Fn() -> bool,
    ) -> Option<Self> {
        let mut sums = accumulator.into_sums();
        merge(layout, &mut sums.cells);
        let clock = Instant::now();
        merge_bins(layout, &mut sums);
        let mut bins_time = clock.elapsed();
        let mixed = mixed_cells(layout, &sums.cells, &visible);
        let enough = 4 * u64::from(photons_per_cell);
        let mut grid = layout.grid.clone();
        let base = grid.base();
        let divided = (base..grid.finest()).flat_map(|number| {
            let level = &layout.grid.levels[number];
            let (sums, mixed) = (&sums.cells, &mixed);
            layout.levels[number].keys.iter().enumerate().filter_map(move |(place, key)| {
                let count = sums[number][place].count;
                let weight = if mixed[number][place] && count >= enough { 1000 } else { 1 };
(count > 0).then(|| (number, key.cell(level).0, weight, count >= enough))
            })
        });
        grid.prune(divided);
        let mut store = BinStore::new(sums.bins);
        let mut levels: Vec<Level> = Vec::with_capacity(layout.levels.len());
        for (number, mixed) in mixed.iter().enumerate() {
            if !keep_going() {
                return None;
            }
            let parents = levels.last();
            let parent = |place: usize| -> Option<[&Cell; SETS]> {
                let parents = parents?;
                let (cell, class) = layout.levels[number].keys[place].cell(&layout.grid.levels[number]);
                let at = parents.index.find(layout.grid.parent(number, cell)?, class)?;
                Some(std::array::from_fn(|set| &parents.cells[set][at]))
            };
            // Where the parent's light is read.
            let read_above = |place: usize| {
                parent(place).filter(|[parent, _]| reads_parent(parent, layout, number, place))
            };
            let clock = Instant::now();
            let exists = |place: usize| {
                let level = &layout.grid.levels[number];
                let (cell, _) = layout.levels[number].keys[place].cell(level);
                number <= base || grid.is_divided(number - 1, level.lattice(cell) >> 1)
            };
            let glossy = push_bins(layout, number, &sums, &mut store, |place| exists(place) && read_above(place).is_none());
            bins_time += clock.elapsed();
            let is_divided = |place: usize| {
                let level = &layout.grid.levels[number];
                let (cell, _) = layout.levels[number].keys[place].cell(level);
                grid.is_divided(number, level.lattice(cell))
            };
            let settle = |place: usize| -> [Cell; SETS] {
                let enough = sums.cells[number][place].count >= enough && is_divided(place);
                let parent = read_above(place);
                std::array::from_fn(|set| {
                    let cell = match parent {
                        Some(parent) => Cell::new(parent[set].irradiance(), parent[set].glossy()),
                        None => own_cell(layout, number, place, &sums, set, glossy.get(&place).copied()),
                    };
                    cell.with(enough, mixed[place])
                })
            };
            let values: Vec<[Cell; SETS]> =
                (0..layout.levels[number].keys.len()).into_par_iter().map(settle).collect();
            levels.push(keep_lit(layout, &grid, number, &sums.cells[number], &values));
        }
        let per_finest_area = grid.levels[grid.finest()].cell_size.powi(-2);
        Some(Self { grid, classes: layout.classes, levels, store, bins_time, per_finest_area })
    }
}

/// A cell with its own light of one set.
fn own_cell(
    layout: &Layout,
    number: usize,
    place: usize,
    sums: &Sums,
    set: usize,
    glossy: Option<u32>,
) -> Cell {
    let area = layout.levels[number].surfaces[place].area as f64 * layout.area_unit;
    let flux = sums.cells[number][place].flux[set];
    Cell::new(Rgb(flux.map(|flux| (flux as f64 * sums.quantum / area) as f32)), glossy)
}

/// Whether a cell's parent is read in its place: where the photons are too few to tell, or the cell is a sliver of
/// something that is no mixture.
fn reads_parent(parent: &Cell, layout: &Layout, number: usize, place: usize) -> bool {
    let area = layout.levels[number].surfaces[place].area as f64 * layout.area_unit;
    let sliver = area < SLIVER * f64::from(layout.grid.levels[number].cell_size).powi(2);
    !parent.holds_enough() || (sliver && !parent.is_mixed())
}

/// Puts the bins of a level's glossy cells into the store, of those that are read; gives their numbers by place.
fn push_bins(
    layout: &Layout,
    number: usize,
    sums: &Sums,
    store: &mut BinStore,
    is_read: impl Fn(usize) -> bool,
) -> BTreeMap<usize, u32> {
    let surfaces = &layout.levels[number].surfaces;
    let cells = sums.glossy.get(number).into_iter().flatten().filter(|(place, _)| is_read(**place));
    cells
        .map(|(&place, bins)| {
            let area = surfaces[place].glossy_area.max(1) as f64 * layout.area_unit;
            let sets = std::array::from_fn(|set| &bins[set * sums.bins.count()..][..sums.bins.count()]);
            (place, store.push(surfaces[place].mean_normal(), sets, sums.bin_quantum / area))
        })
        .collect()
}

/// Adds every cell to its parent, from the finest level up.
fn merge(layout: &Layout, cells: &mut [Vec<CellSum>]) {
    for level in (1..layout.levels.len()).rev() {
        let (coarser, finer) = cells.split_at_mut(level);
        for (place, sum) in finer[0].iter().enumerate().filter(|(_, sum)| sum.count > 0) {
            if let Some(parent) = layout.parent(level, place) {
                coarser[level - 1][parent].add(sum);
            }
        }
    }
}

/// Adds the bins of every glossy cell to its parent's, from the finest level up.
fn merge_bins(layout: &Layout, sums: &mut Sums) {
    let frame = |level: usize, place: usize| Frame::new(layout.levels[level].surfaces[place].mean_normal());
    for level in (1..layout.levels.len()).rev() {
        let (coarser, finer) = sums.glossy.split_at_mut(level);
        for (&place, values) in &finer[0] {
            if let Some(parent) = layout.parent(level, place) {
                let count = sums.bins.count();
                let total = coarser[level - 1].entry(parent).or_insert_with(|| vec![[0; 3]; SETS * count]);
                for (values, total) in values.chunks(count).zip(total.chunks_mut(count)) {
                    sums.bins.add(&frame(level, place), values, &frame(level - 1, parent), total);
                }
            }
        }
    }
}

/// Cells without a photon need no memory: what is missing is dark where its parent holds enough photons to know, and
/// else read from the parent.
fn keep_lit(layout: &Layout, grid: &Grid, number: usize, sums: &[CellSum], values: &[[Cell; SETS]]) -> Level {
    let level = &layout.grid.levels[number];
    let exists = |place: usize| {
        let (cell, _) = layout.levels[number].keys[place].cell(level);
        number <= grid.base() || grid.is_divided(number - 1, level.lattice(cell) >> 1)
    };
    let places: Vec<usize> = (0..values.len()).filter(|&place| sums[place].count > 0 && exists(place)).collect();
    let keys = places.iter().map(|&place| -> CellKey { layout.levels[number].keys[place] });
    let index = LevelIndex::new(&layout.grid.levels[number], keys);
    let cells = std::array::from_fn(|set| places.iter().map(|&place| values[place][set]).collect());
    Level { index, cells }
}

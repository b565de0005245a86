//! From sums to a pyramid that can be read: levels merged octree-wise, sparse cells given their parent's value.

use std::collections::BTreeMap;
use std::time::{Duration, Instant};

use rayon::prelude::*;

use super::accumulator::{Accumulator, CellSum, SETS, Sums};
use super::bins::BinStore;
use super::grid::{Grid, Vote};
use super::index::{CellGroup, CellKey, LevelIndex};
use super::layout::Layout;
use super::lit::LitLayout;
use super::mixed::mixed_cells;
use super::surfaces::Surfaces;
use super::{Cell, Level, Pyramid, Surroundings};
use crate::color::Rgb;
use crate::math::Frame;

impl Pyramid {
    /// Photons that a cell has to hold for its children to be read.
    #[must_use]
    pub const fn photons_to_divide(photons_per_cell: u32) -> u32 {
        4 * photons_per_cell
    }

    /// Merges the levels and settles which cells are read from their parents: those whose *parent* holds fewer than
    /// `4 × photons_per_cell` photons (a rule on the cell's own count would brighten the picture), and slivers. Cells
    /// whose parts do not see each other are read from finer ones. `None` when cancelled.
    #[must_use]
    pub fn build(
        accumulator: Accumulator<'_>,
        layout: &Layout,
        photons_per_cell: u32,
        scene: &impl Surroundings,
    ) -> Option<Self> {
        let lit = LitLayout::new(layout, accumulator.landed());
        let mut sums = accumulator.into_sums(&lit.places);
        let (layout, surfaces) = (&lit.layout, Surfaces::measure(&lit, scene)?);
        merge(&surfaces, &mut sums.cells);
        let clock = Instant::now();
        merge_bins(layout, &surfaces, &mut sums);
        let mut bins_time = clock.elapsed();
        let mixed = mixed_cells(layout, &surfaces, &sums.cells, scene);
        let enough = Self::photons_to_divide(photons_per_cell).into();
        let grid = pruned_grid(layout, &sums, &mixed, enough);
        let mut store = BinStore::new(sums.bins);
        let known = Known { surfaces: &surfaces, sums: &sums, mixed: &mixed, grid: &grid, enough };
        let mut settled: Vec<Settled> = Vec::with_capacity(layout.levels.len());
        for number in 0..layout.levels.len() {
            if !scene.keep_going() {
                return None;
            }
            settled.push(known.settle(number, settled.last(), &mut store, &mut bins_time));
        }
        let levels = settled.into_iter().map(|settled| settled.level).collect();
        let per_finest_area = grid.levels[grid.finest()].cell_size.powi(-2);
        Some(Self { grid, classes: layout.classes, levels, store, bins_time, per_finest_area })
    }
}

/// What is known of the cells when levels are settled.
struct Known<'a> {
    surfaces: &'a Surfaces<'a>,
    sums: &'a Sums,
    /// By level and place.
    mixed: &'a [Vec<bool>],
    /// Without the refinements that are not worth it.
    grid: &'a Grid,
    /// Photons that a cell has to hold for its children to be read.
    enough: u64,
}

/// A level of the pyramid.
struct Settled {
    level: Level,
    /// Where in it the cells of the layout are, by place there; [`NOT_KEPT`] where they are not.
    places: Vec<u32>,
}

const NOT_KEPT: u32 = u32::MAX;

impl Known<'_> {
    /// Settles the cells of a level that are worth their memory. Those without a photon are not: what is missing is dark where
    /// its parent holds enough photons to know, and else read from the parent.
    #[expect(clippy::cast_possible_truncation, reason = "fewer than 2^32 cells fit in memory")]
    fn settle(
        &self,
        number: usize,
        above: Option<&Settled>,
        store: &mut BinStore,
        bins_time: &mut Duration,
    ) -> Settled {
        let Known { surfaces, sums, mixed, grid, enough } = *self;
        let (layout, sums_of, mixed) = (surfaces.layout, &sums.cells[number], &mixed[number]);
        let keys = &layout.levels[number].keys;
        let parent = |place: usize| -> Option<[&Cell; SETS]> {
            let (above, parent) = (above?, layout.parent(number, place)?);
            let at = Some(above.places[parent]).filter(|&at| at != NOT_KEPT)?;
            Some(std::array::from_fn(|set| &above.level.cells[set][at as usize]))
        };
        // A cell is not worth its memory where it would only repeat its parent: what is missing is read from there.
        let is_kept = |&place: &usize| {
            let is_read = || parent(place).is_some_and(|[parent, _]| parent.holds_enough());
            sums_of[place].count > 0 && (number == 0 || is_read())
        };
        let kept: Vec<usize> = (0..keys.len()).into_par_iter().filter(is_kept).collect();
        // Slivers of something that is no mixture have their parent's light.
        let read_above = |place: usize| {
            parent(place).filter(|[parent, _]| !parent.is_mixed() && surfaces.is_sliver(number, place))
        };
        let clock = Instant::now();
        let is_read = |place: usize| is_kept(&place) && read_above(place).is_none();
        let glossy = push_bins(surfaces, number, sums, store, is_read);
        *bins_time += clock.elapsed();
        let settle = |&place: &usize| -> [Cell; SETS] {
            let level = &layout.grid.levels[number];
            let is_divided = || grid.is_divided(number, level.lattice(keys[place].cell(level).0));
            let enough = sums_of[place].count >= enough && is_divided();
            let (parent, read_above) = (parent(place), read_above(place).is_some());
            std::array::from_fn(|set| {
                let parent = parent.map(|parent| parent[set]);
                // Direction bins are those of the finest level that is everywhere.
                let glossy = if number > grid.base() || read_above {
                    parent.and_then(Cell::glossy)
                } else {
                    glossy.get(&place).copied()
                };
                let irradiance = match parent.filter(|_| read_above) {
                    Some(parent) => parent.irradiance(),
                    None => own_irradiance(surfaces, number, place, sums, set),
                };
                Cell::new(irradiance, glossy).with(enough, mixed[place])
            })
        };
        let values: Vec<[Cell; SETS]> = kept.par_iter().map(settle).collect();
        let cells = std::array::from_fn(|set| values.iter().map(|value| value[set]).collect());
        let (mut groups, mut places) = (Vec::new(), vec![NOT_KEPT; keys.len()]);
        for (number, &place) in kept.iter().enumerate() {
            CellGroup::from(keys[place]).push(&mut groups);
            places[place] = number as u32;
        }
        let index = LevelIndex::new(&layout.grid.levels[number], &groups);
        Settled { level: Level { index, cells }, places }
    }
}

/// The grid, without refinements that hold too few photons: block by block, a level is worth reading where most of its
/// cells' parents hold enough, or where one that does is mixed.
fn pruned_grid(layout: &Layout, sums: &Sums, mixed: &[Vec<bool>], enough: u64) -> Grid {
    let mut grid = layout.grid.clone();
    let votes = (grid.base()..grid.finest()).flat_map(|number| {
        let vote = move |(place, key): (usize, &CellKey)| {
            let count = sums.cells[number][place].count;
            let vote = match (count >= enough, mixed[number][place]) {
                (true, true) => Vote::Needed,
                (true, false) => Vote::For,
                (false, _) => Vote::Against,
            };
            (count > 0).then(|| (number, key.cell(&layout.grid.levels[number]).0, vote))
        };
        layout.levels[number].keys.iter().enumerate().filter_map(vote)
    });
    grid.prune(votes);
    grid
}

/// Irradiance of a cell from its own photons of one set.
fn own_irradiance(surfaces: &Surfaces<'_>, number: usize, place: usize, sums: &Sums, set: usize) -> Rgb {
    let area = surfaces.area(number, place);
    let flux = sums.cells[number][place].flux[set];
    Rgb(flux.map(|flux| (flux as f64 * sums.quantum / area) as f32))
}

/// Puts the bins of a level's glossy cells into the store, of those that are read; gives their numbers by place.
fn push_bins(
    surfaces: &Surfaces<'_>,
    number: usize,
    sums: &Sums,
    store: &mut BinStore,
    is_read: impl Fn(usize) -> bool,
) -> BTreeMap<usize, u32> {
    let layout = surfaces.layout;
    let cells = sums.glossy.get(number).into_iter().flatten().filter(|(place, _)| is_read(**place));
    cells
        .map(|(&place, bins)| {
            let area = surfaces.levels[number].surfaces[place].glossy_area.max(1) as f64 * layout.area_unit();
            let sets = std::array::from_fn(|set| &bins[set * sums.bins.count()..][..sums.bins.count()]);
            (place, store.push(layout.bins_normal(number, place), sets, sums.bin_quantum / area))
        })
        .collect()
}

/// Adds every cell to its parent, from the finest level up, but for what is hidden in a parent that is not.
fn merge(surfaces: &Surfaces<'_>, cells: &mut [Vec<CellSum>]) {
    for level in (1..cells.len()).rev() {
        let (coarser, finer) = cells.split_at_mut(level);
        for (place, sum) in finer[0].iter().enumerate().filter(|(_, sum)| sum.count > 0) {
            if let Some(parent) = surfaces.counting_parent(level, place) {
                coarser[level - 1][parent].add(sum);
            }
        }
    }
}

/// Adds the bins of every glossy cell to its parent's, from the finest level up.
fn merge_bins(layout: &Layout, surfaces: &Surfaces<'_>, sums: &mut Sums) {
    let frame = |level: usize, place: usize| Frame::new(layout.bins_normal(level, place));
    for level in (1..sums.glossy.len()).rev() {
        let (coarser, finer) = sums.glossy.split_at_mut(level);
        for (&place, values) in &finer[0] {
            if let Some(parent) = surfaces.counting_parent(level, place) {
                let count = sums.bins.count();
                let total = coarser[level - 1].entry(parent).or_insert_with(|| vec![[0; 3]; SETS * count]);
                for (values, total) in values.chunks(count).zip(total.chunks_mut(count)) {
                    sums.bins.add(&frame(level, place), values, &frame(level - 1, parent), total);
                }
            }
        }
    }
}

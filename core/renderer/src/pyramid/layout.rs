//! Which cells the surfaces need: made from the triangles, before any photon.

use std::sync::atomic::{AtomicI64, Ordering};

use glam::{DVec3, Vec3};
use rayon::prelude::*;

use super::Surroundings;
use super::class::NormalClasses;
use super::grid::Grid;
use super::index::{CellGroup, CellKey, LevelIndex};
use super::measure::Batches;
use super::surfaces::BYTES_PER_CELL;

/// Cells of one level.
#[derive(Debug)]
pub struct LevelLayout {
    /// Where each cell lies.
    pub index: LevelIndex,
    /// Key of each cell.
    pub keys: Vec<CellKey>,
    /// Place of the coarser cell around each cell, [`NO_PARENT`] where there is none.
    parents: Vec<u32>,
    /// Mean normal of the glossy surface of each cell, zero where there is none. Empty where there is nothing glossy at all.
    glossy_normals: Vec<Vec3>,
}

/// Stands for the place of a parent where there is none.
const NO_PARENT: u32 = u32::MAX;

impl LevelLayout {
    /// Of all levels, from the cells of each.
    #[expect(clippy::cast_possible_truncation, reason = "fewer than 2^32 cells fit in memory")]
    fn all(grid: &Grid, groups: &[Vec<CellGroup>]) -> Vec<Self> {
        let indices: Vec<LevelIndex> = grid
            .levels
            .par_iter()
            .zip(groups)
            .map(|(level, groups)| LevelIndex::new(level, groups))
            .collect();
        let parents = |level: usize| -> Vec<u32> {
            let Some(above) = level.checked_sub(1) else { return vec![NO_PARENT; indices[0].len()] };
            let places = |group: &CellGroup| group.places_above(grid, level, &indices[above]);
            let places = groups[level].par_iter().flat_map_iter(places);
            places.map(|place| place.map_or(NO_PARENT, |place| place as u32)).collect()
        };
        let parents: Vec<Vec<u32>> = (0..groups.len()).map(parents).collect();
        let of_level = |((index, parents), groups): ((LevelIndex, Vec<u32>), &Vec<CellGroup>)| {
            let keys = groups.par_iter().flat_map_iter(|group| group.keys()).collect();
            Self { index, keys, parents, glossy_normals: Vec::new() }
        };
        indices.into_iter().zip(parents).zip(groups).map(of_level).collect()
    }
}

/// The cells of all levels.
#[derive(Debug)]
pub struct Layout {
    /// Where they lie.
    pub grid: Grid,
    /// How surfaces in one cell are kept apart.
    pub classes: NormalClasses,
    /// Coarsest first.
    pub levels: Vec<LevelLayout>,
    pub(super) batches: Batches,
}

impl Layout {
    /// The cells of `grid` that surfaces lie in, and the coarser ones around them. `None` when cancelled.
    #[must_use]
    pub fn new(grid: Grid, classes: NormalClasses, scene: &impl Surroundings) -> Option<Self> {
        let batches = Batches::new(&grid, scene);
        let mut groups = batches.cells(&grid, classes, scene)?;
        for level in (1..grid.levels.len()).rev() {
            let (coarser, finer) = groups.split_at_mut(level);
            coarser[level - 1].extend(finer[0].iter().filter_map(|group| group.above(&grid, level)));
            CellGroup::unite(&mut coarser[level - 1]);
        }
        let levels = LevelLayout::all(&grid, &groups);
        let mut layout = Self { grid, classes, levels, batches };
        if (0..scene.triangle_count()).any(|i| scene.triangle(i).glossy) {
            layout.add_glossy_normals(scene);
        }
        Some(layout)
    }

    fn add_glossy_normals(&mut self, scene: &impl Surroundings) {
        let with_bins = &self.levels[..=self.grid.base()];
        let empty = |level: &LevelLayout| level.keys.iter().map(|_| Default::default()).collect();
        let sums: Vec<Vec<[AtomicI64; 3]>> = with_bins.iter().map(empty).collect();
        self.batches.glossy_normals(self, scene, &|level, place, normal| {
            for (sum, value) in sums[level][place].iter().zip(normal) {
                sum.fetch_add(value, Ordering::Relaxed);
            }
        });
        let mut sums: Vec<Vec<[i64; 3]>> = sums
            .into_iter()
            .map(|level| level.into_iter().map(|sum| sum.map(AtomicI64::into_inner)).collect())
            .collect();
        for level in (1..sums.len()).rev() {
            let (coarser, finer) = sums.split_at_mut(level);
            for (place, normal) in finer[0].iter().enumerate() {
                let Some(parent) = self.parent(level, place) else { continue };
                for (sum, value) in coarser[level - 1][parent].iter_mut().zip(normal) {
                    *sum += value;
                }
            }
        }
        for (level, sums) in self.levels.iter_mut().zip(sums) {
            let mean = |sum: [i64; 3]| DVec3::from(sum.map(|c| c as f64)).normalize_or_zero().as_vec3();
            level.glossy_normals = sums.into_par_iter().map(mean).collect();
        }
    }

    /// Some of the cells, which are at `places` by level, in order, and have the coarser ones around them among them.
    #[must_use]
    pub(super) fn part(&self, places: &[Vec<u32>]) -> Self {
        let keys = self.levels.par_iter().map(|level| &level.keys);
        let of_level = |(keys, places): (&Vec<CellKey>, &Vec<u32>)| {
            let mut groups = Vec::new();
            for &place in places {
                CellGroup::from(keys[place as usize]).push(&mut groups);
            }
            groups
        };
        let groups: Vec<Vec<CellGroup>> = keys.zip(places).map(of_level).collect();
        let mut levels = LevelLayout::all(&self.grid, &groups);
        for ((part, whole), places) in levels.iter_mut().zip(&self.levels).zip(places) {
            if !whole.glossy_normals.is_empty() {
                let normals = places.par_iter().map(|&place| whole.glossy_normals[place as usize]);
                part.glossy_normals = normals.collect();
            }
        }
        Self { grid: self.grid.clone(), classes: self.classes, levels, batches: self.batches.clone() }
    }

    /// Scene area of one unit in which the area of cells is counted, a power of two.
    #[must_use]
    pub const fn area_unit(&self) -> f64 {
        self.batches.area_unit
    }

    /// Where a photon at `p` on a surface of class `class` belongs: level and place. A position that rounding put outside
    /// the cells of its surface goes to the nearest one beside it.
    #[must_use]
    pub fn find(&self, p: Vec3, class: usize) -> Option<(usize, usize)> {
        let offset = self.grid.offset(p);
        let (level, cell) = self.grid.locate(offset, self.grid.finest())?;
        let index = &self.levels[level].index;
        if let Some(place) = index.find(cell, class) {
            return Some((level, place));
        }
        // Just across a border; blocks beyond it may be refined.
        let finest = 0.25 * self.grid.levels[self.grid.finest()].cell_size;
        let cell_size = self.grid.levels[level].cell_size;
        let fraction = offset / cell_size;
        let fraction = fraction - fraction.floor() - Vec3::splat(0.5);
        let across = (Vec3::splat(0.5) - fraction.abs()) * cell_size + finest;
        let mut axes = [0, 1, 2];
        axes.sort_by(|&a, &b| fraction[b].abs().total_cmp(&fraction[a].abs()));
        // Nearest first: across the closest face, the next face, then the edge between them, and so on.
        let (a, b, c) = (1 << axes[0], 1 << axes[1], 1 << axes[2]);
        [a, b, a | b, c, a | c, b | c, a | b | c].into_iter().find_map(|borders: usize| {
            let step = |axis: usize| {
                if borders >> axis & 1 == 1 { across[axis].copysign(fraction[axis]) } else { 0.0 }
            };
            let beside = offset + Vec3::new(step(0), step(1), step(2));
            let (level, cell) = self.grid.locate(beside, self.grid.finest())?;
            Some((level, self.levels[level].index.find(cell, class)?))
        })
    }

    /// [`Layout::find`] for several photons, each a position and a class, one step for all before the next.
    #[must_use]
    pub(super) fn find_all<const N: usize>(
        &self,
        at: [Option<(Vec3, usize)>; N],
    ) -> [Option<(usize, usize)>; N] {
        let located = at.map(|at| self.grid.locate(self.grid.offset(at?.0), self.grid.finest()));
        let bricks = located.map(|located| located.map(|(level, cell)| self.levels[level].index.brick(cell)));
        std::array::from_fn(|i| {
            let ((p, class), (level, _), (brick, bit)) = (at[i]?, located[i]?, bricks[i]?);
            let place = self.levels[level].index.place(brick, bit, class);
            place.map_or_else(|| self.find(p, class), |place| Some((level, place)))
        })
    }

    /// Normal of the frame of a cell's direction bins; the class's own axis would be wrong by up to 55°.
    #[must_use]
    pub fn bins_normal(&self, level: usize, place: usize) -> Vec3 {
        self.levels[level].glossy_normals[place].try_normalize().unwrap_or(Vec3::Z)
    }

    /// Number of cells, all levels.
    #[must_use]
    pub fn cell_count(&self) -> usize {
        self.levels.iter().map(|level| level.index.len()).sum()
    }

    /// Number of cells with glossy surface.
    #[must_use]
    pub fn glossy_cell_count(&self) -> usize {
        let normals = self.levels.iter().flat_map(|level| &level.glossy_normals);
        normals.filter(|normal| **normal != Vec3::ZERO).count()
    }

    /// Place of the coarser cell that holds a cell.
    #[must_use]
    #[inline]
    pub fn parent(&self, level: usize, place: usize) -> Option<usize> {
        let parent = self.levels[level].parents[place];
        (parent != NO_PARENT).then_some(parent as usize)
    }

    /// The cell of a level that is everywhere which a cell lies in, or itself: level and place.
    #[must_use]
    pub(super) fn unrefined(&self, mut level: usize, mut place: usize) -> (usize, usize) {
        while level > self.grid.base()
            && let Some(parent) = self.parent(level, place)
        {
            (level, place) = (level - 1, parent);
        }
        (level, place)
    }

    /// Memory (bytes), with what it takes to measure the cells' surface.
    #[must_use]
    pub fn bytes(&self) -> usize {
        let level = |l: &LevelLayout| {
            l.index.bytes()
                + l.keys.len() * (size_of::<CellKey>() + size_of::<u32>() + BYTES_PER_CELL)
                + l.glossy_normals.len() * size_of::<Vec3>()
        };
        self.levels.iter().map(level).sum()
    }
}

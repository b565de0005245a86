//! Where the cells lie: nested boxes of cells, each twice as wide and twice as coarse as the next.
//!
//! The finest level covers the seen part of the scene; each coarser level covers twice the width, cut to the scene's
//! bounds. Light far away is held in cells as coarse as its distance asks for, so that a plane of kilometres round a room
//! costs a few thousand cells and the room keeps its fine ones. Cells are anchored in the world: they stay put when the
//! seen part changes.
//!
//! Below the finest of these levels there may be a few more, which exist only in the blocks of cells where they pay
//! ([`Grid::refine`]).

use glam::{DVec3, IVec3, Vec3};

/// Cells of one level.
#[derive(Clone, Copy, Debug)]
pub struct LevelBox {
    /// Edge of a cell (scene units).
    pub cell_size: f32,
    inverse_cell_size: f32,
    /// Coordinates of the lowest cell.
    low: IVec3,
    /// Cells along each axis, a multiple of the brick's edge.
    pub size: IVec3,
}

impl LevelBox {
    /// Cell coordinates within the box, or `None` outside.
    #[must_use]
    #[inline(always)]
    pub fn cell(&self, offset: Vec3) -> Option<IVec3> {
        let cell = (offset * self.inverse_cell_size).floor().as_ivec3() - self.low;
        (cell.cmpge(IVec3::ZERO) & cell.cmplt(self.size)).all().then_some(cell)
    }

    /// Coordinates in the level's lattice.
    #[must_use]
    pub fn lattice(&self, cell: IVec3) -> IVec3 {
        cell + self.low
    }

    /// From lattice coordinates to coordinates within the box, `None` outside.
    #[must_use]
    pub fn within(&self, lattice: IVec3) -> Option<IVec3> {
        let cell = lattice - self.low;
        (cell.cmpge(IVec3::ZERO) & cell.cmplt(self.size)).all().then_some(cell)
    }
}

/// The boxes of all levels, coarsest first.
#[derive(Clone, Debug)]
pub struct Grid {
    origin: Vec3,
    origin_f64: DVec3,
    /// Level 0 is the coarsest.
    pub levels: Vec<LevelBox>,
    /// The finest level that exists all over its box.
    base: usize,
    /// By block of that level, [`BRICK`] cells wide: how many levels below it exist there.
    refinements: Vec<u8>,
}

/// A place where light is read, and how finely.
#[derive(Clone, Copy, Debug)]
pub struct Reading {
    /// Where, in scene space.
    pub p: Vec3,
    /// Edge of the cells that would do (scene units).
    pub cell_size: f32,
}

/// Where photons of a pilot landed.
#[derive(Clone, Debug, Default)]
pub struct PilotLandings {
    /// How many, by block of the base level ([`Grid::block_at`]); empty where there was no pilot.
    pub counts: Vec<u32>,
    /// How many photons of the photon pass each stands for.
    pub each: f64,
    /// Photons that a cell has to hold for its children to be read.
    pub enough: f64,
}

/// What a cell has to say about reading its children.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Vote {
    /// They hold enough photons.
    For,
    /// They do not.
    Against,
    /// It cannot be read itself, whatever the others say.
    Needed,
}

/// More than the cells of a block, classes and levels included, can cast against it.
const MOST_VOTES: i64 = 1 << 24;

/// Cells per edge of a brick.
pub(super) const BRICK: i32 = 4;

/// Cells along the seen part below which a level is too coarse to be right (one eighth of the scene).
const COARSEST_RESOLUTION: f64 = 8.0;

/// Cells along the longest side beyond which nothing is refined: their index alone would take too much memory.
const MOST_RESOLUTION: u32 = 2048;

/// Readings of a pilot that a block needs for a level of its own.
const LEAST_READINGS: u32 = 2;

/// Cells of a block that share its photons: those that a plane across it meets.
const LEAST_LIT: f64 = 16.0;

/// Walls modelled at round coordinates must not lie on a border between cells; part of a finest cell.
const ANCHOR_OFFSET: f64 = 0.381_966;

impl Grid {
    /// Cells over `seen`, `resolution` along its longest side, and coarser ones over `bounds` around it. `world_origin` is
    /// the world's origin; all in scene units.
    #[must_use]
    pub fn new(seen: [DVec3; 2], bounds: [DVec3; 2], resolution: u32, world_origin: DVec3) -> Self {
        let extent = (seen[1] - seen[0]).max_element().max(1e-6);
        let finest = extent / f64::from(resolution.max(1));
        let center = (seen[0] + seen[1]) * 0.5;
        let reach = (bounds[1] - center).max(center - bounds[0]).max_element() / extent;
        let by_resolution = (f64::from(resolution) / COARSEST_RESOLUTION).log2().floor();
        let by_reach = (2.0 * reach).log2().ceil();
        let coarsenings = by_resolution.max(by_reach).clamp(0.0, 40.0);
        let coarsest = finest * coarsenings.exp2();
        // The lattice point of the coarsest level below everything is the origin of all coordinates.
        let anchor = world_origin + DVec3::splat(ANCHOR_OFFSET * finest);
        let lowest = bounds[0].min(seen[0]) - DVec3::splat(coarsest);
        let origin = anchor + ((lowest - anchor) / coarsest).floor() * coarsest;

        let half = DVec3::splat(extent * 0.5 + finest);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "at most forty levels")]
        let count = coarsenings as usize + 1;
        let levels = (0..count).map(|level| {
            let scale = ((count - 1 - level) as f64).exp2();
            let cell_size = finest * scale;
            let margin = DVec3::splat(cell_size);
            let low = (center - half * scale).max(bounds[0].min(seen[0]) - margin);
            let high = (center + half * scale).min(bounds[1].max(seen[1]) + margin);
            level_box(low - origin, high - origin, cell_size)
        });
        let levels = nested(levels.collect());
        let base = levels.len() - 1;
        let blocks = (levels[base].size / BRICK).element_product();
        #[expect(clippy::cast_sign_loss, reason = "a box has cells")]
        let refinements = vec![0; blocks as usize];
        Self { origin: origin.as_vec3(), origin_f64: origin, levels, base, refinements }
    }

    /// Adds finer levels in the blocks that `readings` ask for it: so many levels as a few of them want there, and `landings`
    /// promise photons for.
    pub fn refine(&mut self, readings: &[Reading], landings: &PilotLandings, most: u32) {
        let base = self.levels[self.base];
        let resolution = base.size.max_element() as u32;
        let most = most.min((MOST_RESOLUTION / resolution.max(1)).checked_ilog2().unwrap_or(0)) as usize;
        let mut wanted = vec![0_u32; self.refinements.len() * most];
        for reading in readings {
            let finer = (base.cell_size / reading.cell_size.max(f32::MIN_POSITIVE)).log2().round();
            let Some(block) = self.block_at(reading.p) else { continue };
            for count in wanted[block * most..][..most].iter_mut().take(finer.max(0.0) as usize) {
                *count += 1;
            }
        }
        let blocks = wanted.chunks(most.max(1)).zip(&landings.counts);
        for (refinements, (wanted, &landed)) in self.refinements.iter_mut().zip(blocks) {
            let photons = f64::from(landed) * landings.each;
            let cells = (0..).map(|deeper| LEAST_LIT * 4.0_f64.powi(deeper));
            let is_worth =
                |(&count, cells): (&u32, f64)| count >= LEAST_READINGS && photons >= landings.enough * cells;
            *refinements = wanted.iter().zip(cells).take_while(|&each| is_worth(each)).count() as u8;
        }
        for _ in 0..self.refinements.iter().copied().max().unwrap_or(0) {
            let LevelBox { cell_size, inverse_cell_size, low, size } = self.levels[self.finest()];
            let (cell_size, inverse_cell_size) = (cell_size * 0.5, inverse_cell_size * 2.0);
            self.levels.push(LevelBox { cell_size, inverse_cell_size, low: low * 2, size: size * 2 });
        }
    }

    /// Leaves out the refinements that cells vote against; `votes` are about the children of a cell of a level.
    pub(super) fn prune(&mut self, votes: impl Iterator<Item = (usize, IVec3, Vote)>) {
        let deepest = self.finest() - self.base;
        let mut counted = vec![0_i64; self.refinements.len() * deepest];
        for (level, cell, vote) in votes {
            let above = level - self.base;
            let lattice = self.levels[level].lattice(cell) >> above as i32;
            let Some(cell) = self.levels[self.base].within(lattice) else { continue };
            counted[self.block(cell) * deepest + above] += match vote {
                Vote::For => 1,
                Vote::Against => -1,
                Vote::Needed => MOST_VOTES,
            };
        }
        for (refinements, counted) in self.refinements.iter_mut().zip(counted.chunks(deepest.max(1))) {
            let worth = counted.iter().take_while(|&&votes| votes > 0).count() as u8;
            *refinements = worth.min(*refinements);
        }
    }

    /// How many blocks the base level has.
    #[must_use]
    pub fn block_count(&self) -> usize {
        self.refinements.len()
    }

    /// Number of the block around a position in scene space, `None` outside the box of the base level.
    #[must_use]
    #[inline]
    pub fn block_at(&self, p: Vec3) -> Option<usize> {
        self.levels[self.base].cell(self.offset(p)).map(|cell| self.block(cell))
    }

    /// Number of the block of a cell of the base level.
    #[inline(always)]
    #[expect(clippy::cast_sign_loss, reason = "cells within a box are not negative")]
    fn block(&self, cell: IVec3) -> usize {
        let (block, blocks) = (cell >> 2_i32, self.levels[self.base].size >> 2_i32);
        ((block.z * blocks.y + block.y) * blocks.x + block.x) as usize
    }

    /// The finest level up to `level` that exists around a position in the box of the base level.
    #[inline(always)]
    pub(super) fn existing(&self, offset: Vec3, level: usize) -> usize {
        if level <= self.base {
            return level;
        }
        let cell = self.levels[self.base].cell(offset);
        let finer = cell.map_or(0, |cell| self.refinements[self.block(cell)]);
        level.min(self.base + usize::from(finer))
    }

    /// Whether a cell, in lattice coordinates, is divided into cells of the next level.
    pub(super) fn is_divided(&self, level: usize, lattice: IVec3) -> bool {
        let Some(finer) = self.levels.get(level + 1) else { return false };
        if level < self.base {
            return finer.within(lattice << 1_i32).is_some();
        }
        let cell = self.levels[self.base].within(lattice >> (level - self.base) as i32);
        cell.is_some_and(|cell| self.base + usize::from(self.refinements[self.block(cell)]) > level)
    }

    /// Position relative to the lattice's origin, as [`LevelBox::cell`] wants it.
    #[must_use]
    #[inline(always)]
    pub fn offset(&self, p: Vec3) -> Vec3 {
        p - self.origin
    }

    /// The inverse of [`Grid::offset`].
    #[must_use]
    pub fn position(&self, offset: Vec3) -> Vec3 {
        offset + self.origin
    }

    /// The same as [`Grid::offset`] in f64, for clipping.
    #[must_use]
    pub fn offset_f64(&self, p: DVec3) -> DVec3 {
        p - self.origin_f64
    }

    /// Index of the finest level that exists all over its box.
    #[must_use]
    pub(super) const fn base(&self) -> usize {
        self.base
    }

    /// Edge of a cell of the finest level that exists all over its box (scene units).
    #[must_use]
    pub fn base_cell_size(&self) -> f32 {
        self.levels[self.base].cell_size
    }

    /// Index of the finest level.
    #[must_use]
    pub const fn finest(&self) -> usize {
        self.levels.len() - 1
    }

    /// The finest level up to `level` that exists at the position, with the cell.
    #[must_use]
    #[inline(always)]
    pub fn locate(&self, offset: Vec3, level: usize) -> Option<(usize, IVec3)> {
        let level = self.existing(offset, level);
        if let Some(cell) = self.levels[level].cell(offset) {
            return Some((level, cell));
        }
        (0..level).rev().find_map(|level| Some((level, self.levels[level].cell(offset)?)))
    }

    /// The cell of the next coarser level that holds `cell`.
    #[must_use]
    pub fn parent(&self, level: usize, cell: IVec3) -> Option<IVec3> {
        let parent = self.levels[level].lattice(cell) >> 1;
        self.levels[level - 1].within(parent)
    }
}

#[expect(clippy::cast_possible_truncation, reason = "coordinates count cells of the scene")]
fn level_box(low: DVec3, high: DVec3, cell_size: f64) -> LevelBox {
    let brick = f64::from(BRICK) * cell_size;
    let first = (low / brick).floor().as_ivec3();
    let last = (high / brick).floor().as_ivec3();
    LevelBox {
        cell_size: cell_size as f32,
        inverse_cell_size: (1.0 / cell_size) as f32,
        low: first * BRICK,
        size: (last - first + IVec3::ONE).max(IVec3::ONE) * BRICK,
    }
}

/// Widens each level so that it holds the next finer one.
fn nested(mut levels: Vec<LevelBox>) -> Vec<LevelBox> {
    for level in (1..levels.len()).rev() {
        let (low, high) =
            (levels[level].low >> 1, (levels[level].low + levels[level].size + IVec3::ONE) >> 1);
        let coarse = &mut levels[level - 1];
        let first = coarse.low.min(low).div_euclid(IVec3::splat(BRICK));
        let last =
            ((coarse.low + coarse.size).max(high) + IVec3::splat(BRICK - 1)).div_euclid(IVec3::splat(BRICK));
        coarse.low = first * BRICK;
        coarse.size = (last - first) * BRICK;
    }
    levels
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid() -> Grid {
        Grid::new(
            [DVec3::new(-0.05, -0.02, -0.03), DVec3::new(0.05, 0.03, 0.02)],
            [DVec3::splat(-0.5), DVec3::splat(0.5)],
            100,
            DVec3::new(-12.3, 4.0, 0.2),
        )
    }

    /// So many photons at the readings.
    fn landings(grid: &Grid, readings: &[Reading], photons: f64) -> PilotLandings {
        let mut counts = vec![0; grid.block_count()];
        for block in readings.iter().filter_map(|reading| grid.block_at(reading.p)) {
            counts[block] += 1;
        }
        PilotLandings { counts, each: photons / readings.len() as f64, enough: 16.0 }
    }

    #[test]
    fn boxes_nest_and_cover() {
        let grid = grid();
        assert!(
            (grid.levels[grid.finest()].cell_size - 0.001).abs() < 1e-9,
            "a hundred cells along the longest side"
        );
        for level in 1..grid.levels.len() {
            let fine = grid.levels[level];
            for corner in [IVec3::ZERO, fine.size - IVec3::ONE] {
                assert!(grid.parent(level, corner).is_some(), "level {level}");
            }
        }
        for p in [Vec3::splat(-0.4999), Vec3::splat(0.4999), Vec3::new(0.4999, -0.4999, 0.0)] {
            let (level, _) = grid.locate(grid.offset(p), grid.finest()).expect("inside the scene");
            assert!(level < grid.finest(), "far away is coarse");
        }
        let (level, _) = grid.locate(grid.offset(Vec3::new(0.049, 0.0, 0.0)), grid.finest()).expect("seen");
        assert_eq!(level, grid.finest());
    }

    #[test]
    fn cells_stay_put_when_the_seen_part_moves() {
        let bounds = [DVec3::splat(-0.5), DVec3::splat(0.5)];
        let world = DVec3::new(0.123, 0.0, 0.0);
        let a = Grid::new([DVec3::splat(-0.1), DVec3::splat(0.1)], bounds, 64, world);
        let b = Grid::new([DVec3::splat(-0.05), DVec3::splat(0.15)], bounds, 64, world);
        let boundary = |grid: &Grid, x: f32| {
            (grid.offset(Vec3::splat(x)) / grid.levels[grid.finest()].cell_size).fract()
        };
        let difference = (boundary(&a, 0.03) - boundary(&b, 0.03)).abs();
        assert!(difference.min_element() < 1e-3 || difference.max_element() > 0.999, "{difference}");
    }

    /// A block around what was read closely is refined once or twice, its neighbors are not; positions are found there at
    /// the level that exists, and cells of all levels nest.
    #[test]
    fn blocks_are_refined_where_they_are_read_closely() {
        let mut grid = grid();
        let (base, size) = (grid.finest(), grid.base_cell_size());
        let (once, twice, never) =
            (Vec3::new(0.01, 0.0, 0.0), Vec3::new(-0.03, 0.0, 0.0), Vec3::new(0.03, 0.0, 0.0));
        let reading = |p: Vec3, finer: f32| Reading { p, cell_size: size / finer };
        let readings = [
            reading(once, 2.0),
            reading(once, 9.0),
            reading(twice, 4.1),
            reading(twice, 1000.0),
            reading(never, 100.0),
            reading(never, 1.0),
            reading(Vec3::splat(0.49), 100.0),
            reading(Vec3::splat(0.49), 100.0),
        ];
        grid.refine(&readings, &landings(&grid, &readings, 1e7), 2);
        assert_eq!(grid.finest(), base + 2);
        let finest = grid.finest();
        let located = |p: Vec3| grid.locate(grid.offset(p), finest).expect("inside");
        for (p, deeper) in [(once, 1), (twice, 2), (never, 0)] {
            let (level, cell) = located(p);
            assert_eq!(level, base + deeper, "{p}");
            let lattice = grid.levels[level].lattice(cell);
            assert!(!grid.is_divided(level, lattice));
            assert!((1..=deeper).all(|up| grid.is_divided(level - up, lattice >> up as i32)));
            let above = (0..deeper)
                .try_fold((level, cell), |(level, cell), _| Some((level - 1, grid.parent(level, cell)?)));
            assert_eq!(above, grid.locate(grid.offset(p), base), "{p}");
        }
        assert!(located(Vec3::splat(0.49)).0 < base, "outside the box nothing is refined");
    }

    /// A block keeps the levels that most of its cells vote for, or that one cell needs.
    #[test]
    fn blocks_are_pruned_by_vote() {
        let (a, b, c) = (Vec3::new(0.01, 0.0, 0.0), Vec3::new(-0.03, 0.0, 0.0), Vec3::new(0.03, 0.0, 0.0));
        let mut grid = grid();
        let base = grid.finest();
        let readings = [a, a, b, b, c, c].map(|p| Reading { p, cell_size: 0.0 });
        grid.refine(&readings, &landings(&grid, &readings, 1e7), 2);
        let at = |level: usize, p: Vec3| (level, grid.levels[level].cell(grid.offset(p)).expect("inside"));
        let votes = [
            (at(base, a), Vote::For),
            (at(base + 1, a), Vote::Against),
            (at(base, b), Vote::Against),
            (at(base, b), Vote::Against),
            (at(base, b), Vote::For),
            (at(base + 1, b), Vote::For),
            (at(base, c), Vote::Against),
            (at(base, c), Vote::Needed),
            (at(base + 1, c), Vote::For),
        ];
        let votes = votes.map(|((level, cell), vote)| (level, cell, vote));
        grid.prune(votes.into_iter());
        let depth = |p: Vec3| grid.locate(grid.offset(p), grid.finest()).expect("inside").0 - base;
        assert_eq!([a, b, c].map(depth), [1, 0, 2]);
    }

    /// A block of sixteen cells across a plane needs sixteen times what one cell has to hold, and four times as many for each
    /// finer level.
    #[test]
    fn nothing_is_refined_without_photons() {
        let p = Vec3::new(0.0112, 0.0032, 0.0052);
        let readings = vec![Reading { p, cell_size: 1e-5 }; 2];
        for (photons, levels) in [(0.0, 0), (250.0, 0), (260.0, 1), (1020.0, 1), (1030.0, 2), (1e9, 2)] {
            let mut grid = grid();
            let base = grid.base();
            grid.refine(&readings, &landings(&grid, &readings, photons), 2);
            assert_eq!(grid.existing(grid.offset(p), base + 2) - base, levels, "{photons} photons");
        }
    }
}

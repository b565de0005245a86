//! Reading a finished pyramid.

use std::ops::Deref;

use glam::{IVec3, Vec3};

use super::index::NO_BRICK;
use super::{Cell, Pyramid};
use crate::color::Rgb;

/// Positions of hits are off by this at most, relative to the scene's size: some units in the last place.
const ROUNDING: f32 = 4.0 * f32::EPSILON;

/// A look-up of irradiance.
#[derive(Clone, Copy, Debug, Default)]
pub struct Place {
    /// Where.
    pub p: Vec3,
    /// Normal class.
    pub class: u32,
    /// Level.
    pub level: u32,
}

/// A pyramid as one set of photons filled it.
#[derive(Clone, Copy, Debug)]
pub struct View<'a> {
    pub(super) pyramid: &'a Pyramid,
    pub(super) set: usize,
}

impl Deref for View<'_> {
    type Target = Pyramid;

    fn deref(&self) -> &Pyramid {
        self.pyramid
    }
}

impl<'a> View<'a> {
    /// Irradiance (W·m⁻²) at `p` on a surface of class `class`, averaged over a cell of level `level`, or of the finest
    /// coarser level that reaches there and knows. Black where no light arrives; `None` where the cell is mixed.
    #[must_use]
    #[inline]
    pub fn irradiance(&self, p: Vec3, class: usize, level: usize) -> Option<Rgb> {
        match self.find(p, class, level) {
            Some(cell) if cell.is_mixed() => None,
            Some(cell) => Some(cell.irradiance()),
            None => Some(Rgb::BLACK),
        }
    }

    /// [`View::irradiance`] of several places at once, where `wanted`: one step for all before the next, so that the
    /// memory is waited for once and not once per place. Those in mixed cells are black, and wanted no more.
    #[must_use]
    #[inline(always)]
    pub fn irradiances<const N: usize>(&self, at: &[Place; N], wanted: &mut [bool; N]) -> [Rgb; N] {
        let mut bricks = [(0, NO_BRICK, 0); N];
        for i in (0..N).filter(|&i| wanted[i]) {
            let located = self.pyramid.grid.locate(self.pyramid.grid.offset(at[i].p), at[i].level as usize);
            if let Some((level, cell)) = located {
                let (brick, bit) = self.pyramid.levels[level].index.brick(cell);
                bricks[i] = (level, brick, bit);
            }
        }
        let mut places = [None; N];
        for i in 0..N {
            let (level, brick, bit) = bricks[i];
            places[i] = self.pyramid.levels[level].index.place(brick, bit, at[i].class as usize);
        }
        let mut out = [Rgb::BLACK; N];
        for i in 0..N {
            if !wanted[i] {
                continue;
            }
            let found = match places[i].map(|place| &self.pyramid.levels[bricks[i].0].cells[self.set][place])
            {
                Some(cell) if !cell.is_mixed() => Some(cell.irradiance()),
                _ => self.irradiance(at[i].p, at[i].class as usize, at[i].level as usize),
            };
            wanted[i] = found.is_some();
            out[i] = found.unwrap_or(Rgb::BLACK);
        }
        out
    }

    /// Radiance (W·m⁻²·sr⁻¹) of the glossy surfaces of class `class` at `p` towards the unit vector `direction`, divided by
    /// their tint; `shift` in [-½, ½]² as in [`super::DirectionBins::bin`].
    #[must_use]
    pub fn glossy_radiance(
        &self,
        p: Vec3,
        class: usize,
        level: usize,
        direction: Vec3,
        shift: [f32; 2],
    ) -> Rgb {
        let glossy = self.find(p, class, level).and_then(Cell::glossy);
        glossy.map_or(Rgb::BLACK, |number| self.pyramid.store.radiance(number, self.set, direction, shift))
    }

    /// The cell to read; `None` where it is dark.
    #[inline]
    fn find(&self, p: Vec3, class: usize, level: usize) -> Option<&'a Cell> {
        let offset = self.pyramid.grid.offset(p);
        let (level, cell) = self.pyramid.grid.locate(offset, level)?;
        match self.pyramid.levels[level].find(self.set, cell, class) {
            Some(found) if found.is_mixed() && found.holds_enough() => {
                self.find_finer(found, offset, class, level)
            }
            Some(found) => Some(found),
            None => {
                (self.find_across(offset, class, level)).or_else(|| self.find_coarser(cell, class, level))
            }
        }
    }

    /// Across a border of cells, where rounding may have put a place of a surface that lies in the border itself.
    fn find_across(&self, offset: Vec3, class: usize, level: usize) -> Option<&'a Cell> {
        let nudge = Vec3::splat(ROUNDING * offset.abs().max_element().max(1.0));
        [offset - nudge, offset + nudge].into_iter().find_map(|offset| {
            let cell = self.pyramid.grid.levels[level].cell(offset)?;
            let found = self.pyramid.levels[level].find(self.set, cell, class)?;
            let split = found.is_mixed() && found.holds_enough();
            if split { self.find_finer(found, offset, class, level) } else { Some(found) }
        })
    }

    /// Below a mixed cell: the coarsest that is none or too poor in photons to be split, or the finest there is.
    fn find_finer(&self, mut found: &'a Cell, offset: Vec3, class: usize, level: usize) -> Option<&'a Cell> {
        for level in level + 1..self.pyramid.levels.len() {
            let Some(cell) = self.pyramid.grid.levels[level].cell(offset) else { break };
            found = self.pyramid.levels[level].find(self.set, cell, class)?;
            if !(found.is_mixed() && found.holds_enough()) {
                break;
            }
        }
        Some(found)
    }

    /// Above a cell without a photon: dark where enough photons landed beside it to know.
    fn find_coarser(&self, mut cell: IVec3, class: usize, mut level: usize) -> Option<&'a Cell> {
        while level > 0 {
            (cell, level) = (self.pyramid.grid.parent(level, cell)?, level - 1);
            if let Some(found) = self.pyramid.levels[level].find(self.set, cell, class) {
                return (!found.holds_enough()).then_some(found);
            }
        }
        None
    }
}

//! Names of cells, for those who ask which of them a look-up reads.

use glam::{IVec3, Vec3};

use super::{Place, Pyramid};

/// A cell of a level, with one normal class.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct CellId {
    /// Level.
    pub level: usize,
    /// Normal class.
    pub class: usize,
    cell: IVec3,
}

impl Pyramid {
    /// The cell that a look-up asks first, and all coarser ones around it, the finest first.
    pub fn cells_around(&self, place: Place) -> impl Iterator<Item = CellId> {
        let located = self.grid.locate(self.grid.offset(place.p), place.level as usize);
        let first = located.map(|(level, cell)| CellId { level, class: place.class as usize, cell });
        std::iter::successors(first, |&id| self.cell_above(id))
    }

    /// The cell of the next coarser level around a cell.
    #[must_use]
    pub fn cell_above(&self, id: CellId) -> Option<CellId> {
        let level = id.level.checked_sub(1)?;
        Some(CellId { level, cell: self.grid.parent(id.level, id.cell)?, ..id })
    }

    /// Center and edge of a cell (scene units).
    #[must_use]
    pub fn cube(&self, id: CellId) -> (Vec3, f32) {
        let level = self.grid.levels[id.level];
        let center = (level.lattice(id.cell).as_vec3() + 0.5) * level.cell_size;
        (self.grid.position(center), level.cell_size)
    }
}

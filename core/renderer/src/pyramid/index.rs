//! From a cell to its place in a packed array: one brick of 4³ cells, one 64-bit mask per normal class that the brick
//! knows, two popcounts.

use glam::IVec3;

use super::class::BACKS;
use super::grid::{BRICK, LevelBox};

/// A brick is a run of these in memory. The first tells which classes the brick knows, one bit each: fronts, then backs; one
/// for each of them follows, in order: which of its cells exist, and the place of the first.
#[derive(Clone, Copy, Debug, Default)]
struct Slot([u64; 2]);

/// The cells of one level that exist.
#[derive(Clone, Debug)]
pub struct LevelIndex {
    /// Slot of the brick of every 4³ block of the level's box, [`NO_BRICK`] where there is none.
    bricks: Vec<u32>,
    slots: Vec<Slot>,
    size: IVec3,
    len: usize,
}

/// Stands for a brick where there is none.
pub(super) const NO_BRICK: u32 = u32::MAX;

/// A cell's place for sorting: brick first, then class, then cell within the brick.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct CellKey(u64);

impl CellKey {
    /// Key of a cell (within its level's box) and normal class.
    #[must_use]
    pub fn new(level: &LevelBox, cell: IVec3, class: usize) -> Self {
        let (brick, bit) = split(cell, level.size / BRICK);
        Self((brick as u64) << 16 | (class as u64) << 8 | u64::from(bit))
    }

    /// The cell and its class.
    #[must_use]
    #[expect(clippy::cast_possible_truncation, reason = "the inverse of `new`")]
    pub fn cell(self, level: &LevelBox) -> (IVec3, usize) {
        let (brick, class, bit) =
            ((self.0 >> 16) as i32, (self.0 >> 8) as usize & 0xff, self.0 as i32 & 0x3f);
        let size = level.size / BRICK;
        let corner = IVec3::new(brick % size.x, brick / size.x % size.y, brick / (size.x * size.y)) * BRICK;
        (corner + IVec3::new(bit & 3, (bit >> 2) & 3, bit >> 4), class)
    }
}

/// Brick number within the box and bit within the brick.
#[inline]
#[expect(clippy::cast_sign_loss, reason = "coordinates within a box are not negative")]
fn split(cell: IVec3, size: IVec3) -> (usize, u32) {
    let brick: IVec3 = cell >> 2_i32;
    let inner: IVec3 = cell & 3_i32;
    let number = (brick.z as usize * size.y as usize + brick.y as usize) * size.x as usize + brick.x as usize;
    (number, (inner.z << 4 | inner.y << 2 | inner.x) as u32)
}

impl LevelIndex {
    /// Index of the cells named by `keys`, which are sorted and unique. Cell `i` of the keys has place `i`.
    #[must_use]
    #[expect(clippy::cast_possible_truncation, reason = "fewer than 2^32 cells fit in memory")]
    pub fn new(level: &LevelBox, keys: impl Iterator<Item = CellKey>) -> Self {
        let size = level.size / BRICK;
        let mut bricks = vec![NO_BRICK; size.element_product() as usize];
        let mut slots: Vec<Slot> = Vec::new();
        let mut len = 0;
        for key in keys {
            let (brick, class, bit) =
                ((key.0 >> 16) as usize, (key.0 >> 8) as usize & 0xff, key.0 as u32 & 0x3f);
            if bricks[brick] == NO_BRICK {
                bricks[brick] = slots.len() as u32;
                slots.push(Slot::default());
            }
            let Slot(known) = &mut slots[bricks[brick] as usize];
            if known[class / BACKS] >> (class % BACKS) & 1 == 0 {
                known[class / BACKS] |= 1 << (class % BACKS);
                slots.push(Slot([0, len as u64]));
            }
            if let Some(Slot([mask, _])) = slots.last_mut() {
                *mask |= 1 << bit;
            }
            len += 1;
        }
        Self { bricks, slots, size, len }
    }

    /// Number of cells.
    #[must_use]
    pub const fn len(&self) -> usize {
        self.len
    }

    /// First half of [`LevelIndex::find`]: the number of the cell's brick, and the cell's bit in it.
    #[inline(always)]
    pub(super) fn brick(&self, cell: IVec3) -> (u32, u32) {
        let (brick, bit) = split(cell, self.size);
        (self.bricks[brick], bit)
    }

    /// Second half of [`LevelIndex::find`].
    #[inline(always)]
    pub(super) fn place(&self, brick: u32, bit: u32, class: usize) -> Option<usize> {
        if brick == NO_BRICK {
            return None;
        }
        let Slot([fronts, backs]) = self.slots[brick as usize];
        let (known, before) = if class < BACKS { (fronts, 0) } else { (backs, fronts.count_ones()) };
        let class = class % BACKS;
        if known >> class & 1 == 0 {
            return None;
        }
        let rank = before + (known & ((1 << class) - 1)).count_ones();
        let Slot([mask, first]) = self.slots[(brick + 1 + rank) as usize];
        let below = mask & ((1 << bit) - 1);
        (mask >> bit & 1 == 1).then(|| first as usize + below.count_ones() as usize)
    }

    /// Place of a cell (within the level's box), `None` where it does not exist.
    #[must_use]
    #[inline]
    pub fn find(&self, cell: IVec3, class: usize) -> Option<usize> {
        let (brick, bit) = self.brick(cell);
        self.place(brick, bit, class)
    }

    /// Whether a cell holds no more than the two sides of one surface, as far as its classes tell.
    #[must_use]
    pub fn is_alone(&self, cell: IVec3) -> bool {
        let (brick, bit) = self.brick(cell);
        if brick == NO_BRICK {
            return true;
        }
        let Slot([fronts, backs]) = self.slots[brick as usize];
        let classes = (fronts.count_ones() + backs.count_ones()) as usize;
        let masks = &self.slots[brick as usize + 1..][..classes];
        masks.iter().filter(|Slot([mask, _])| mask >> bit & 1 == 1).count() <= 2
    }

    /// Memory (bytes).
    #[must_use]
    pub const fn bytes(&self) -> usize {
        self.bricks.len() * size_of::<u32>() + self.slots.len() * size_of::<Slot>()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pyramid::grid::Grid;
    use glam::DVec3;
    use std::collections::BTreeSet;

    const CLASSES: i32 = 2 * BACKS as i32;

    #[test]
    fn every_cell_is_found_where_its_key_says() {
        let half = DVec3::new(0.5, 0.3, 0.1);
        let grid = Grid::new([-half, half], [-half, half], 37, DVec3::ZERO);
        let level = grid.levels[grid.finest()];
        let mut keys = BTreeSet::new();
        let mut state = 1_u64;
        for _ in 0..5000 {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            let r = |shift: u64, n: i32| ((state >> shift) % n as u64) as i32;
            let cell = IVec3::new(r(10, level.size.x), r(25, level.size.y), r(40, level.size.z));
            keys.insert(CellKey::new(&level, cell, r(50, CLASSES) as usize));
        }
        let index = LevelIndex::new(&level, keys.iter().copied());
        assert_eq!(index.len(), keys.len());
        for (place, key) in keys.iter().enumerate() {
            let (cell, class) = key.cell(&level);
            assert_eq!(CellKey::new(&level, cell, class), *key);
            assert_eq!(index.find(cell, class), Some(place));
        }
        for key in &keys {
            let (cell, _) = key.cell(&level);
            let surfaces = (0..CLASSES as usize).filter(|&class| index.find(cell, class).is_some());
            assert_eq!(index.is_alone(cell), surfaces.count() <= 2);
        }
        for z in 0..level.size.z {
            for class in 0..CLASSES as usize {
                let cell = IVec3::new(3, 5, z);
                let exists = keys.contains(&CellKey::new(&level, cell, class));
                assert_eq!(index.find(cell, class).is_some(), exists);
            }
        }
    }
}

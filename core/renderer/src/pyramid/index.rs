//! From a cell to its place in a packed array: one brick of 4³ cells, one 64-bit mask per normal class that the brick
//! knows, two popcounts.

use glam::IVec3;

use super::class::BACKS;
use super::grid::{BRICK, Grid, LevelBox};

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

/// Stands for a brick where there is none. Zero, so that memory of bricks that nobody asks for is never touched.
pub(super) const NO_BRICK: u32 = 0;

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
            ((self.0 >> 16) as i32, (self.0 >> 8) as usize & 0xff, self.0 as u32 & 0x3f);
        let size = level.size / BRICK;
        let corner = IVec3::new(brick % size.x, brick / size.x % size.y, brick / (size.x * size.y)) * BRICK;
        (corner + inner(bit), class)
    }
}

/// Cells of one brick and normal class.
#[derive(Clone, Copy, Debug)]
pub struct CellGroup {
    /// A [`CellKey`] without the cell within the brick.
    key: u64,
    /// One bit for each cell.
    mask: u64,
}

/// Children of a cell within a brick, the lowest one at the lowest bit: two along each axis.
const LOWEST_CHILDREN: u64 = 0x0000_0505_0000_0505;

impl CellGroup {
    /// One cell.
    #[must_use]
    pub fn new(level: &LevelBox, cell: IVec3, class: usize) -> Self {
        CellKey::new(level, cell, class).into()
    }

    /// Adds to a list of groups, of which the last one often takes it.
    pub fn push(self, groups: &mut Vec<Self>) {
        match groups.last_mut() {
            Some(last) if last.key == self.key => last.mask |= self.mask,
            _ => groups.push(self),
        }
    }

    /// Sorts groups and makes one of those of the same brick and class.
    pub fn unite(groups: &mut Vec<Self>) {
        groups.sort_unstable_by_key(|group| group.key);
        groups.dedup_by(|next, kept| {
            let is_same = next.key == kept.key;
            kept.mask |= if is_same { next.mask } else { 0 };
            is_same
        });
    }

    /// The same cells with another class.
    #[must_use]
    pub fn of_class(self, class: impl Fn(usize) -> usize) -> Self {
        let of = self.key as usize & 0xff;
        Self { key: self.key & !0xff | class(of) as u64, ..self }
    }

    /// The cells one by one, in order.
    pub fn keys(self) -> impl Iterator<Item = CellKey> {
        self.bits().map(move |bit| CellKey(self.key << 8 | u64::from(bit)))
    }

    fn bits(self) -> impl Iterator<Item = u32> {
        let rest = |mask: &u64| Some(mask & (mask - 1)).filter(|&rest| rest != 0);
        std::iter::successors(Some(self.mask).filter(|&mask| mask != 0), rest).map(u64::trailing_zeros)
    }

    /// The cell of the next coarser level that holds the lowest corner of the brick, and the class.
    fn corner_above(self, grid: &Grid, level: usize) -> Option<(IVec3, usize)> {
        let (corner, class) = CellKey(self.key << 8).cell(&grid.levels[level]);
        Some((grid.parent(level, corner)?, class))
    }

    /// The cells of the next coarser level around these: eight at most, all of one brick.
    #[must_use]
    pub fn above(self, grid: &Grid, level: usize) -> Option<Self> {
        let (corner, class) = self.corner_above(grid, level)?;
        let corner = CellKey::new(&grid.levels[level - 1], corner, class);
        // Each cell's bit moves to the lowest of the eight that share a parent.
        let along_x = self.mask | self.mask >> 1;
        let along_y = along_x | along_x >> 4;
        let lowest = (along_y | along_y >> 16) & LOWEST_CHILDREN;
        let mask = Self { mask: lowest, ..self }.bits().fold(0, |mask, bit| mask | 1 << half(bit));
        Some(Self { key: corner.0 >> 8, mask: mask << (corner.0 & 0x3f) })
    }

    /// Of each cell in order: the place of the one above it in the index of the next coarser level.
    pub fn places_above(
        self,
        grid: &Grid,
        level: usize,
        coarser: &LevelIndex,
    ) -> impl Iterator<Item = Option<usize>> {
        let above = self.corner_above(grid, level);
        self.bits().map(move |bit| {
            let (corner, class) = above?;
            coarser.find(corner + inner(half(bit)), class)
        })
    }
}

impl From<CellKey> for CellGroup {
    fn from(key: CellKey) -> Self {
        Self { key: key.0 >> 8, mask: 1 << (key.0 & 0x3f) }
    }
}

/// A cell within a brick.
#[expect(clippy::cast_possible_wrap, reason = "a bit of 64")]
fn inner(bit: u32) -> IVec3 {
    let bit = bit as i32;
    IVec3::new(bit & 3, (bit >> 2) & 3, bit >> 4)
}

/// From a cell within a brick to that of the cell above it, within the brick's part of the brick above.
const fn half(bit: u32) -> u32 {
    bit >> 1 & 0b01_01_01
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
    /// Index of the cells of `groups`, which are sorted and unique. Cells have their places in the order of their keys.
    #[must_use]
    #[expect(clippy::cast_possible_truncation, reason = "fewer than 2^32 cells fit in memory")]
    pub fn new(level: &LevelBox, groups: &[CellGroup]) -> Self {
        let size = level.size / BRICK;
        let mut bricks = vec![NO_BRICK; size.element_product() as usize];
        // The first one stands where there is no brick.
        let mut slots = vec![Slot::default()];
        let mut len = 0;
        for &CellGroup { key, mask } in groups {
            let (brick, class) = ((key >> 8) as usize, key as usize & 0xff);
            if bricks[brick] == NO_BRICK {
                bricks[brick] = slots.len() as u32;
                slots.push(Slot::default());
            }
            let Slot(known) = &mut slots[bricks[brick] as usize];
            known[class / BACKS] |= 1 << (class % BACKS);
            slots.push(Slot([mask, len as u64]));
            len += mask.count_ones() as usize;
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

    fn groups(keys: &BTreeSet<CellKey>) -> Vec<CellGroup> {
        let mut groups: Vec<CellGroup> = keys.iter().rev().map(|&key| key.into()).collect();
        CellGroup::unite(&mut groups);
        groups
    }

    /// The cells above groups of cells are those above each of the cells.
    #[test]
    fn groups_have_the_cells_above_their_cells() {
        let half = DVec3::new(0.5, 0.3, 0.1);
        let grid = Grid::new([-half, half], [-half, half], 37, DVec3::ZERO);
        let (finest, mut state) = (grid.finest(), 7_u64);
        let level = grid.levels[finest];
        let mut draw = |n: i32| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            ((state >> 33) % n as u64) as i32
        };
        let keys: BTreeSet<CellKey> = (0..3000)
            .map(|_| {
                let cell = IVec3::new(draw(level.size.x), draw(level.size.y), draw(level.size.z));
                CellKey::new(&level, cell, draw(3) as usize)
            })
            .collect();
        let groups = groups(&keys);
        assert!(groups.iter().flat_map(|group| group.keys()).eq(keys.iter().copied()));
        let above = |key: &CellKey| {
            let (cell, class) = key.cell(&level);
            CellKey::new(&grid.levels[finest - 1], grid.parent(finest, cell).expect("nested"), class)
        };
        let known: BTreeSet<CellKey> = keys.iter().map(above).collect();
        let mut coarser: Vec<CellGroup> =
            groups.iter().filter_map(|group| group.above(&grid, finest)).collect();
        CellGroup::unite(&mut coarser);
        assert!(coarser.iter().flat_map(|group| group.keys()).eq(known.iter().copied()));
        let index = LevelIndex::new(&grid.levels[finest - 1], &coarser);
        let order: Vec<CellKey> = known.into_iter().collect();
        let places = groups.iter().flat_map(|group| group.places_above(&grid, finest, &index));
        for (key, place) in keys.iter().zip(places) {
            assert_eq!(order[place.expect("there is one")], above(key));
        }
    }

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
        let index = LevelIndex::new(&level, &groups(&keys));
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

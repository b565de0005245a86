//! Which cells the surfaces need, and how much surface lies in each: made from the triangles, before any photon.

use glam::{DVec3, Vec3};
use rayon::prelude::*;
use rustc_hash::FxHashMap;

use super::class::{BACKS, NormalClasses};
use super::grid::Grid;
use super::index::{CellKey, LevelIndex};
use super::measure::{Cells, Measure};
use crate::math::Side;

/// One triangle as the pyramid sees it.
#[derive(Clone, Copy, Debug)]
pub struct SurfaceTriangle {
    /// Corners in scene space.
    pub corners: [DVec3; 3],
    /// Unit normal: where the front looks.
    pub normal: Vec3,
    /// True when the light leaving it is needed by direction.
    pub glossy: bool,
}

/// A point on one side of a surface.
#[derive(Clone, Copy, Debug)]
pub struct SidePoint {
    /// Where, in scene space.
    pub p: Vec3,
    /// Which side.
    pub side: Side,
    /// Edge of its cell (scene units).
    pub cell_size: f32,
}

/// Surface inside one cell and normal class. Sums are integers, so that their order does not matter.
#[derive(Clone, Copy, Debug, Default)]
pub struct CellSurface {
    /// Area in units of [`Layout::area_unit`].
    pub area: i64,
    /// Area-weighted normal, in the same unit.
    pub normal: [i64; 3],
    /// Area-weighted position relative to the lattice's origin, in the same unit.
    pub centroid: [i64; 3],
    /// Area of what needs direction bins.
    pub glossy_area: i64,
}

impl CellSurface {
    pub(super) fn add(&mut self, other: &Self) {
        self.area += other.area;
        for c in 0..3 {
            self.normal[c] += other.normal[c];
            self.centroid[c] += other.centroid[c];
        }
        self.glossy_area += other.glossy_area;
    }

    /// Takes away `area` of a surface that is the same everywhere.
    #[expect(clippy::cast_precision_loss, clippy::cast_possible_truncation, reason = "a share of the area")]
    fn split_off(&mut self, area: i64) -> Self {
        let share = |value: i64| (value as f64 * (area as f64 / self.area.max(1) as f64)).round() as i64;
        let taken = Self {
            area,
            normal: self.normal.map(share),
            centroid: self.centroid.map(share),
            glossy_area: share(self.glossy_area),
        };
        self.area -= taken.area;
        for c in 0..3 {
            self.normal[c] -= taken.normal[c];
            self.centroid[c] -= taken.centroid[c];
        }
        self.glossy_area -= taken.glossy_area;
        taken
    }

    /// True when both are flat, look at each other and lie in one plane.
    fn touches(&self, other: &Self, cell_size: f32) -> bool {
        const FLAT: f64 = 0.9999;
        let direction = |surface: &Self| DVec3::from(surface.normal.map(|c| c as f64)) / surface.area as f64;
        if self.area == 0 || other.area == 0 {
            return false;
        }
        let (a, b) = (direction(self), direction(other));
        let distance = (self.centroid() - other.centroid()).as_dvec3().dot(a).abs();
        a.length() > FLAT && b.length() > FLAT && a.dot(b) < -FLAT && distance < 1e-3 * f64::from(cell_size)
    }

    /// Center of gravity, relative to the lattice's origin.
    #[must_use]
    #[expect(clippy::cast_precision_loss, reason = "a position needs no more than 53 bits")]
    pub fn centroid(&self) -> Vec3 {
        (DVec3::from(self.centroid.map(|c| c as f64)) / self.area.max(1) as f64).as_vec3()
    }

    /// Unit mean normal; the class's own axis would be wrong by up to 55°.
    #[must_use]
    #[expect(clippy::cast_precision_loss, reason = "a direction needs no more than 53 bits")]
    pub fn mean_normal(&self) -> Vec3 {
        DVec3::from(self.normal.map(|c| c as f64)).normalize_or(DVec3::Z).as_vec3()
    }
}

/// Cells and surface of one level, coarser surface included.
#[derive(Debug)]
pub struct LevelLayout {
    /// Where each cell lies.
    pub index: LevelIndex,
    /// Key of each cell.
    pub keys: Vec<CellKey>,
    /// Surface of each cell.
    pub surfaces: Vec<CellSurface>,
    /// Whether light cannot come to the cell's surface, or hardly: it counts for itself, and not for a coarser cell that
    /// holds open surface too.
    pub hidden: Vec<bool>,
}

/// The cells of all levels.
#[derive(Debug)]
pub struct Layout {
    /// Where cells lie in space.
    pub grid: Grid,
    /// How surfaces in one cell are kept apart.
    pub classes: NormalClasses,
    /// Coarsest first.
    pub levels: Vec<LevelLayout>,
    /// Scene area (square scene units) of one unit of [`CellSurface::area`], a power of two.
    pub area_unit: f64,
}

/// Area unit: sums over the whole scene stay exact in 63 bits, and a 10⁻¹² part of the scene still counts.
const AREA_BITS: i32 = 48;

/// Where less than this part of a cell's surface is open, all of it counts: what little light there is has to land.
const LEAST_OPEN: i64 = 8;

impl Layout {
    /// Measures `count` triangles, given by index. `open` tells of points on sides of surfaces whether light can come to them:
    /// hidden surface, such as the floor under a box, is left out beside open one. `None` once `keep_going` says no.
    #[must_use]
    pub fn new(
        grid: Grid,
        classes: NormalClasses,
        count: usize,
        triangle: impl Fn(usize) -> SurfaceTriangle + Sync,
        open: impl Fn(&[SidePoint]) -> Vec<bool> + Sync,
        keep_going: impl Fn() -> bool + Sync,
    ) -> Option<Self> {
        let areas: Vec<f64> =
            (0..count).into_par_iter().map(|i| quantized_area(triangle(i).corners)).collect();
        let total: f64 = areas.iter().sum();
        let area_unit = (total.max(f64::MIN_POSITIVE).log2().ceil() - f64::from(AREA_BITS)).exp2();
        let cells = Measure { grid: &grid, classes, area_unit, open }.cells(&areas, triangle, keep_going)?;
        let levels = levels(&grid, classes, cells);
        Some(Self { grid, classes, levels, area_unit })
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

    /// Place of the coarser cell that a cell is a part of: where its surface and light are counted too.
    #[must_use]
    pub fn counting_parent(&self, level: usize, place: usize) -> Option<usize> {
        let hidden = self.levels[level].hidden[place];
        self.parent(level, place).filter(|&parent| !hidden || self.levels[level - 1].hidden[parent])
    }

    /// Place of the coarser cell that holds a cell.
    #[must_use]
    pub fn parent(&self, level: usize, place: usize) -> Option<usize> {
        let (cell, class) = self.levels[level].keys[place].cell(&self.grid.levels[level]);
        self.levels[level - 1].index.find(self.grid.parent(level, cell)?, class)
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

    /// Memory (bytes).
    #[must_use]
    pub fn bytes(&self) -> usize {
        let level = |l: &LevelLayout| {
            l.index.bytes()
                + l.keys.len() * (size_of::<CellKey>() + size_of::<CellSurface>() + size_of::<bool>())
        };
        self.levels.iter().map(level).sum()
    }
}

/// Rounded so that the sum over triangles does not depend on its order.
fn quantized_area(corners: [DVec3; 3]) -> f64 {
    let area = 0.5 * (corners[1] - corners[0]).cross(corners[2] - corners[0]).length();
    (area * 2.0_f64.powi(AREA_BITS)).round() * 2.0_f64.powi(-AREA_BITS)
}

/// Hides the surface where two flat fronts of a cell lie on each other, such as a box's bottom and the floor.
fn hide_contacts(grid: &Grid, classes: NormalClasses, cells: &mut Cells) {
    let contact = |(&(level, key), [front, _]): (&(u32, CellKey), &[CellSurface; 2])| {
        let level_box = &grid.levels[level as usize];
        let (cell, class) = key.cell(level_box);
        if class >= BACKS || classes.facing(class) < class {
            return None;
        }
        let other = (level, CellKey::new(level_box, cell, classes.facing(class)));
        let [facing, _] = cells.get(&other)?;
        let is_contact = front.touches(facing, level_box.cell_size);
        is_contact.then(|| ((level, key), other, front.area.min(facing.area)))
    };
    let contacts: Vec<_> = cells.iter().filter_map(contact).collect();
    for (a, b, area) in contacts {
        for key in [a, b] {
            if let Some([open, hidden]) = cells.get_mut(&key) {
                hidden.add(&open.split_off(area));
            }
        }
    }
}

/// What counts of a cell's open and hidden surface, and whether it is hidden as a whole, so that all of it does.
fn counted([open, hidden]: [CellSurface; 2]) -> (CellSurface, bool) {
    let mut surface = open;
    let is_hidden = open.area * LEAST_OPEN < hidden.area;
    if is_hidden {
        surface.add(&hidden);
    } else if open.glossy_area * LEAST_OPEN < hidden.glossy_area {
        surface.glossy_area += hidden.glossy_area;
    }
    (surface, is_hidden)
}

/// Sorts the cells by level and adds every cell's ancestors: what a cell counts is open there if the cell is not hidden.
fn levels(grid: &Grid, classes: NormalClasses, cells: Cells) -> Vec<LevelLayout> {
    let mut by_level: Vec<FxHashMap<CellKey, [CellSurface; 2]>> =
        vec![FxHashMap::default(); grid.levels.len()];
    let mut cells = cells;
    hide_contacts(grid, classes, &mut cells);
    for ((level, key), surfaces) in cells {
        by_level[level as usize].insert(key, surfaces);
    }
    for level in (1..grid.levels.len()).rev() {
        let (coarser, finer) = by_level.split_at_mut(level);
        for (key, &surfaces) in &finer[0] {
            let (cell, class) = key.cell(&grid.levels[level]);
            if let Some(parent) = grid.parent(level, cell) {
                let key = CellKey::new(&grid.levels[level - 1], parent, class);
                let (surface, is_hidden) = counted(surfaces);
                let [open, hidden] = coarser[level - 1].entry(key).or_default();
                if is_hidden { hidden.add(&surface) } else { open.add(&surface) }
            }
        }
    }
    by_level
        .into_iter()
        .zip(&grid.levels)
        .map(|(cells, level)| {
            let mut cells: Vec<_> = cells.into_iter().collect();
            cells.par_sort_unstable_by_key(|(key, _)| *key);
            let keys: Vec<_> = cells.iter().map(|(key, _)| *key).collect();
            let (surfaces, hidden) = cells.into_iter().map(|(_, surfaces)| counted(surfaces)).unzip();
            let index = LevelIndex::new(level, keys.iter().copied());
            LevelLayout { index, keys, surfaces, hidden }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Area per level is the area of the surfaces, both sides, at every level.
    #[test]
    fn every_level_holds_the_whole_area() {
        let p = |x: f64, y: f64, z: f64| DVec3::new(x, y, z) * 0.07;
        let triangles = [
            [p(-5.0, -5.0, -1.0), p(5.0, -5.0, -1.0), p(5.0, 5.0, -1.2)],
            [p(-1.0, 0.3, -1.0), p(1.0, 0.2, 2.0), p(0.0, 1.0, 0.4)],
            [p(0.0, 0.0, 0.0), p(0.1, 0.0, 0.0), p(0.0, 0.1, 0.05)],
        ];
        let half = DVec3::splat(0.4);
        let grid = Grid::new([-half * 0.2, half * 0.2], [-half, half], 20, DVec3::ZERO);
        let normal = |[a, b, c]: [DVec3; 3]| (b - a).cross(c - a).normalize().as_vec3();
        let triangle = |i: usize| SurfaceTriangle {
            corners: triangles[i],
            normal: normal(triangles[i]),
            glossy: i == 1,
        };
        let open = |points: &[SidePoint]| vec![true; points.len()];
        let layout = Layout::new(grid, NormalClasses::Six, triangles.len(), triangle, open, || true).unwrap();
        let exact: f64 = triangles.iter().map(|[a, b, c]| (b - a).cross(c - a).length()).sum();
        for (level, cells) in layout.levels.iter().enumerate().take(1) {
            let sum: i64 = cells.surfaces.iter().map(|s| s.area).sum();
            let sum = sum as f64 * layout.area_unit;
            assert!((sum - exact).abs() < 1e-9 * exact, "level {level}: {sum} against {exact}");
        }
        assert!(layout.levels[layout.grid.finest()].surfaces.iter().any(|s| s.glossy_area > 0));
        assert!(layout.levels[layout.grid.finest()].surfaces.iter().any(|s| s.glossy_area == 0));
    }

    /// A floor of 3 × 3 units, partly under a box of 1 × 0.5; all of it in one cell of 8.
    #[test]
    fn what_a_box_stands_on_does_not_count() {
        let p = |x: f64, y: f64| DVec3::new(x, y, 0.0) * 0.05;
        let rectangle =
            |x: f64, y: f64| [[p(0.0, 0.0), p(x, 0.0), p(x, y)], [p(0.0, 0.0), p(x, y), p(0.0, y)]];
        let floor = rectangle(3.0, 3.0);
        let bottom = rectangle(1.0, 0.5).map(|[a, b, c]| [a, c, b]);
        let triangles = [floor[0], floor[1], bottom[0], bottom[1]];
        let triangle = |i: usize| {
            let normal = if i < 2 { Vec3::Z } else { Vec3::NEG_Z };
            SurfaceTriangle { corners: triangles[i], normal, glossy: false }
        };
        let half = DVec3::splat(0.2);
        let grid = Grid::new([-half, half], [-half, half], 1, DVec3::ZERO);
        let area = |open: &(dyn Fn(&SidePoint) -> bool + Sync), side: Side| {
            let open = |points: &[SidePoint]| points.iter().map(open).collect();
            let layout = Layout::new(grid.clone(), NormalClasses::Six, 4, triangle, open, || true).unwrap();
            let (level, place) = layout.find(p(2.0, 2.0).as_vec3(), layout.classes.of(side)).unwrap();
            layout.levels[level].surfaces[place].area as f64 * layout.area_unit / 0.05_f64.powi(2)
        };
        let [top, below] = Side::both(Vec3::Z);
        let expect =
            |found: f64, known: f64| assert!((found - known).abs() < 1e-6, "{found} against {known}");
        expect(area(&|_| true, top), 8.5);
        // The back of the bottom faces up too, and is no part of the floor; of the floor's own back nothing is hidden.
        expect(area(&|_| true, below), 9.0);
        expect(area(&|_| true, Side { normal: Vec3::Z, back: true }), 0.5);
        // What is hidden counts where nothing is open.
        expect(area(&|_| false, top), 9.0);
        expect(area(&|point| point.p.x > 0.05, Side { normal: Vec3::NEG_Z, back: true }), 4.5 + 4.5);
    }
}

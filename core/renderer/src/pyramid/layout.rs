//! Which cells the surfaces need, and how much surface lies in each: made from the triangles, before any photon.

use glam::{DVec3, IVec3, Vec3};
use rayon::prelude::*;
use rustc_hash::FxHashMap;

use super::class::NormalClasses;
use super::clip::clip_triangle;
use super::grid::Grid;
use super::index::{CellKey, LevelIndex};

/// One triangle as the pyramid sees it.
#[derive(Clone, Copy, Debug)]
pub struct SurfaceTriangle {
    /// Corners in scene space.
    pub corners: [DVec3; 3],
    /// True when the light leaving it is needed by direction.
    pub glossy: bool,
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
    fn add(&mut self, other: &Self) {
        self.area += other.area;
        for c in 0..3 {
            self.normal[c] += other.normal[c];
            self.centroid[c] += other.centroid[c];
        }
        self.glossy_area += other.glossy_area;
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

type Cells = FxHashMap<(u32, CellKey), CellSurface>;

impl Layout {
    /// Measures `count` triangles, given by index; `None` once `keep_going` says no.
    #[must_use]
    pub fn new(
        grid: Grid,
        classes: NormalClasses,
        count: usize,
        triangle: impl Fn(usize) -> SurfaceTriangle + Sync,
        keep_going: impl Fn() -> bool + Sync,
    ) -> Option<Self> {
        let total: f64 = (0..count).into_par_iter().map(|i| quantized_area(triangle(i).corners)).sum();
        let area_unit = (total.max(f64::MIN_POSITIVE).log2().ceil() - f64::from(AREA_BITS)).exp2();
        let add = |mut cells: Cells, i: usize| {
            measure(&grid, classes, area_unit, &triangle(i), &mut cells);
            keep_going().then_some(cells)
        };
        let merge = |mut a: Cells, mut b: Cells| {
            if a.len() < b.len() {
                std::mem::swap(&mut a, &mut b);
            }
            for (key, surface) in b {
                a.entry(key).or_default().add(&surface);
            }
            keep_going().then_some(a)
        };
        let cells =
            (0..count).into_par_iter().try_fold(Cells::default, add).try_reduce(Cells::default, merge)?;
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
        let size = self.grid.levels[level].size;
        let fraction = offset / self.grid.levels[level].cell_size;
        let fraction = fraction - fraction.floor() - Vec3::splat(0.5);
        let mut axes = [0, 1, 2];
        axes.sort_by(|&a, &b| fraction[b].abs().total_cmp(&fraction[a].abs()));
        let step = |cell: IVec3, axis: usize| {
            let mut beside = cell;
            beside[axis] += if fraction[axis] < 0.0 { -1 } else { 1 };
            beside
        };
        // Nearest first: across the closest face, the next face, then the edge between them, and so on.
        let (a, b, c) = (axes[0], axes[1], axes[2]);
        let beside = [
            step(cell, a),
            step(cell, b),
            step(step(cell, a), b),
            step(cell, c),
            step(step(cell, a), c),
            step(step(cell, b), c),
            step(step(step(cell, a), b), c),
        ];
        let inside = |c: IVec3| (c.cmpge(IVec3::ZERO) & c.cmplt(size)).all();
        let place = beside.into_iter().filter(|&c| inside(c)).find_map(|c| index.find(c, class))?;
        Some((level, place))
    }

    /// Place of the coarser cell that holds a cell.
    #[must_use]
    pub fn parent(&self, level: usize, place: usize) -> Option<usize> {
        let (cell, class) = self.levels[level].keys[place].cell(&self.grid.levels[level]);
        self.levels[level - 1].index.find(self.grid.parent(level, cell)?, class)
    }

    /// Memory (bytes).
    #[must_use]
    pub fn bytes(&self) -> usize {
        let level = |l: &LevelLayout| {
            l.index.bytes() + l.keys.len() * (size_of::<CellKey>() + size_of::<CellSurface>())
        };
        self.levels.iter().map(level).sum()
    }
}

/// Rounded so that the sum over triangles does not depend on its order.
fn quantized_area(corners: [DVec3; 3]) -> f64 {
    let area = 0.5 * (corners[1] - corners[0]).cross(corners[2] - corners[0]).length();
    (area * 2.0_f64.powi(AREA_BITS)).round() * 2.0_f64.powi(-AREA_BITS)
}

#[expect(clippy::cast_possible_truncation, reason = "quantised on purpose")]
fn measure(
    grid: &Grid,
    classes: NormalClasses,
    area_unit: f64,
    triangle: &SurfaceTriangle,
    cells: &mut Cells,
) {
    let [a, b, c] = triangle.corners;
    let normal = (b - a).cross(c - a).normalize_or_zero();
    let sides = classes.of_sides(normal);
    clip_triangle(grid, triangle.corners, &mut |level, cell, part| {
        let units = part.area / area_unit;
        let centroid = (part.centroid * units).to_array().map(|c| c.round() as i64);
        for (class, sign) in sides.into_iter().zip([1.0, -1.0]) {
            let area = units.round() as i64;
            let surface = CellSurface {
                area,
                normal: (normal * (sign * units)).to_array().map(|c| c.round() as i64),
                centroid,
                glossy_area: if triangle.glossy { area } else { 0 },
            };
            if surface.area > 0 {
                let key = CellKey::new(&grid.levels[level], cell, class);
                cells.entry((level as u32, key)).or_default().add(&surface);
            }
        }
    });
}

/// Sorts the cells by level and adds every cell's ancestors.
fn levels(grid: &Grid, classes: NormalClasses, cells: Cells) -> Vec<LevelLayout> {
    let mut by_level: Vec<FxHashMap<CellKey, CellSurface>> = vec![FxHashMap::default(); grid.levels.len()];
    for ((level, key), surface) in cells {
        by_level[level as usize].insert(key, surface);
    }
    for level in (1..grid.levels.len()).rev() {
        let (coarser, finer) = by_level.split_at_mut(level);
        for (key, surface) in &finer[0] {
            let (cell, class) = key.cell(&grid.levels[level]);
            if let Some(parent) = grid.parent(level, cell) {
                let key = CellKey::new(&grid.levels[level - 1], parent, class);
                coarser[level - 1].entry(key).or_default().add(surface);
            }
        }
    }
    by_level
        .into_iter()
        .zip(&grid.levels)
        .map(|(cells, level)| {
            let mut cells: Vec<_> = cells.into_iter().collect();
            cells.par_sort_unstable_by_key(|(key, _)| *key);
            let (keys, surfaces): (Vec<_>, Vec<_>) = cells.into_iter().unzip();
            let index = LevelIndex::new(level, classes.count(), keys.iter().copied());
            LevelLayout { index, keys, surfaces }
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
        let triangle = |i: usize| SurfaceTriangle { corners: triangles[i], glossy: i == 1 };
        let layout = Layout::new(grid, NormalClasses::Six, triangles.len(), triangle, || true).unwrap();
        let exact: f64 = triangles.iter().map(|[a, b, c]| (b - a).cross(c - a).length()).sum();
        for (level, cells) in layout.levels.iter().enumerate().take(1) {
            let sum: i64 = cells.surfaces.iter().map(|s| s.area).sum();
            let sum = sum as f64 * layout.area_unit;
            assert!((sum - exact).abs() < 1e-9 * exact, "level {level}: {sum} against {exact}");
        }
        assert!(layout.levels[layout.grid.finest()].surfaces.iter().any(|s| s.glossy_area > 0));
        assert!(layout.levels[layout.grid.finest()].surfaces.iter().any(|s| s.glossy_area == 0));
    }
}

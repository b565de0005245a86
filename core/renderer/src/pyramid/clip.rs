//! The exact area of a triangle inside each cell, in f64: what flux is divided by.

use arrayvec::ArrayVec;
use glam::{DVec3, IVec3};

use super::grid::Grid;

/// A triangle cut by at most six planes.
type Polygon = ArrayVec<DVec3, 12>;

/// What lies of a triangle in one cell.
#[derive(Clone, Copy, Debug)]
pub(super) struct Part<'a> {
    /// Area (square scene units).
    pub(super) area: f64,
    /// Center of gravity, relative to the lattice's origin.
    pub(super) centroid: DVec3,
    /// Corners, relative to the lattice's origin.
    pub(super) corners: &'a [DVec3],
}

/// Calls `add(level, cell, part)` for every cell in which light of this triangle is stored: the finest that exist where
/// the parts of the triangle lie, or coarser ones that `is_whole` names by level and place in the level's box. The areas add up to the triangle's (Sutherland and
/// Hodgman 1974, halving cells).
pub(super) fn clip_triangle(
    grid: &Grid,
    corners: [DVec3; 3],
    is_whole: impl Fn(usize, IVec3) -> bool,
    mut add: impl FnMut(usize, IVec3, Part<'_>),
) {
    Cutter { grid, is_whole, add: &mut add }.triangle(corners);
}

/// Down to the finest cells, for [`clip_triangle`].
pub(super) const fn to_the_finest(_: usize, _: IVec3) -> bool {
    false
}

/// Cuts one triangle.
struct Cutter<'a, W, A> {
    grid: &'a Grid,
    is_whole: W,
    add: &'a mut A,
}

impl<W: Fn(usize, IVec3) -> bool, A: FnMut(usize, IVec3, Part<'_>)> Cutter<'_, W, A> {
    fn triangle(&mut self, corners: [DVec3; 3]) {
        let offsets = corners.map(|p| self.grid.offset_f64(p));
        let polygon: Polygon = offsets.into_iter().collect();
        let (low, high) = extent(&polygon);
        // The finest cell that holds the whole triangle saves the cuts above it. Coarser lattices are halves of finer ones.
        let base = self.grid.base();
        let [first, last] = [low, high].map(|p| (p / cell_size(self.grid, base)).floor().as_i64vec3());
        for up in 0..=base {
            let (level, cell) = (base - up, (first >> up as i64).as_ivec3());
            if first >> up as i64 == last >> up as i64 && self.grid.levels[level].within(cell).is_some() {
                return self.descend(level, cell, &polygon);
            }
        }
        let cell_size = cell_size(self.grid, 0);
        let (first, last) = ((low / cell_size).floor().as_ivec3(), (high / cell_size).floor().as_ivec3());
        for z in first.z..=last.z {
            let slab = cut_range(&polygon, 2, f64::from(z) * cell_size, f64::from(z + 1) * cell_size);
            for y in first.y..=last.y {
                let column = cut_range(&slab, 1, f64::from(y) * cell_size, f64::from(y + 1) * cell_size);
                for x in first.x..=last.x {
                    let (low, high) = (f64::from(x) * cell_size, f64::from(x + 1) * cell_size);
                    self.descend(0, IVec3::new(x, y, z), &cut_range(&column, 0, low, high));
                }
            }
        }
    }

    fn descend(&mut self, level: usize, lattice: IVec3, polygon: &Polygon) {
        if polygon.len() < 3 {
            return;
        }
        let Some(cell) = self.grid.levels[level].within(lattice) else { return };
        if self.grid.is_divided(level, lattice) && !(self.is_whole)(level, cell) {
            return self.halve(level + 1, lattice << 1_i32, 0, polygon);
        }
        let part = measure(polygon);
        if part.area > 0.0 {
            (self.add)(level, cell, part);
        }
    }

    /// Cuts a polygon in the middle of a coarser cell, across one axis after the other; `child` is the lowest of the cells
    /// that are still possible. What is not cut is not copied.
    fn halve(&mut self, level: usize, child: IVec3, axis: usize, polygon: &Polygon) {
        if axis == 3 {
            return self.descend(level, child, polygon);
        }
        let mut upper = child;
        upper[axis] += 1;
        let mut parts = [Polygon::new(), Polygon::new()];
        match cut(polygon, axis, f64::from(upper[axis]) * cell_size(self.grid, level), &mut parts) {
            Cut::Below => self.halve(level, child, axis + 1, polygon),
            Cut::Above => self.halve(level, upper, axis + 1, polygon),
            Cut::Both => {
                self.halve(level, child, axis + 1, &parts[0]);
                self.halve(level, upper, axis + 1, &parts[1]);
            }
        }
    }
}

fn cell_size(grid: &Grid, level: usize) -> f64 {
    f64::from(grid.levels[level].cell_size)
}

/// Where a polygon lies of a plane.
enum Cut {
    Below,
    Above,
    Both,
}

/// Cuts a polygon by a plane across `axis`; where it lies on both sides, `parts`, which are empty, become what is below and
/// above. What lies in the plane belongs above, as `floor` has it.
fn cut(polygon: &Polygon, axis: usize, plane: f64, parts: &mut [Polygon; 2]) -> Cut {
    let along = |p: &DVec3| p.to_array()[axis];
    let (low, high) = polygon
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), p| (low.min(along(p)), high.max(along(p))));
    if low >= plane {
        return Cut::Above;
    }
    if high <= plane {
        return Cut::Below;
    }
    let [below, above] = parts;
    let next = polygon.iter().skip(1).chain(polygon.first());
    for (a, b) in polygon.iter().zip(next) {
        let (da, db) = (along(a) - plane, along(b) - plane);
        if da <= 0.0 {
            below.push(*a);
        }
        if da >= 0.0 {
            above.push(*a);
        }
        if (da < 0.0 && db > 0.0) || (da > 0.0 && db < 0.0) {
            let mut p = a + (b - a) * (da / (da - db));
            p[axis] = plane;
            below.push(p);
            above.push(p);
        }
    }
    Cut::Both
}

/// The part between two planes.
fn cut_range(polygon: &Polygon, axis: usize, low: f64, high: f64) -> Polygon {
    let mut parts = [Polygon::new(), Polygon::new()];
    let from_low = match cut(polygon, axis, low, &mut parts) {
        Cut::Below => return Polygon::new(),
        Cut::Above => polygon.clone(),
        Cut::Both => parts[1].take(),
    };
    parts[0].clear();
    match cut(&from_low, axis, high, &mut parts) {
        Cut::Below => from_low,
        Cut::Above => Polygon::new(),
        Cut::Both => parts[0].take(),
    }
}

fn extent(polygon: &Polygon) -> (DVec3, DVec3) {
    polygon.iter().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), &p| (low.min(p), high.max(p)))
}

fn measure(polygon: &Polygon) -> Part<'_> {
    let a = polygon[0];
    let (mut area, mut moment) = (0.0, DVec3::ZERO);
    for edge in polygon.windows(2).skip(1) {
        let triangle = 0.5 * (edge[0] - a).cross(edge[1] - a).length();
        area += triangle;
        moment += (a + edge[0] + edge[1]) * (triangle / 3.0);
    }
    Part { area, centroid: if area > 0.0 { moment / area } else { a }, corners: polygon }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::collections::BTreeMap;

    fn grid() -> Grid {
        let half = DVec3::splat(0.5);
        Grid::new([-half * 0.2, half * 0.2], [-half, half], 32, DVec3::new(0.013, -7.0, 3.3))
    }

    fn total(corners: [DVec3; 3]) -> (f64, usize) {
        let (mut sum, mut cells) = (0.0, BTreeMap::new());
        clip_triangle(&grid(), corners, to_the_finest, |level, cell, part| {
            sum += part.area;
            *cells.entry((level, cell.to_array())).or_insert(0) += 1;
        });
        assert!(cells.values().all(|&times| times == 1), "a triangle meets a cell once");
        (sum, cells.len())
    }

    proptest! {
        #[test]
        fn areas_add_up(v in proptest::array::uniform9(-0.5..0.5_f64)) {
            let corners = [DVec3::new(v[0], v[1], v[2]), DVec3::new(v[3], v[4], v[5]), DVec3::new(v[6], v[7], v[8])];
            let exact = 0.5 * (corners[1] - corners[0]).cross(corners[2] - corners[0]).length();
            let (sum, _) = total(corners);
            prop_assert!((sum - exact).abs() <= 1e-12 + 1e-9 * exact, "{} against {}", sum, exact);
        }
    }

    #[test]
    fn a_triangle_in_a_plane_between_cells_is_counted_once() {
        let grid = grid();
        let size = f64::from(grid.levels[grid.finest()].cell_size);
        let z = size * 30.0;
        let at = |x: f64, y: f64| grid.offset_f64(DVec3::ZERO) * -1.0 + DVec3::new(x, y, z);
        let low = grid.offset_f64(DVec3::ZERO);
        let corners = [at(low.x, low.y), at(low.x + 5.0 * size, low.y), at(low.x, low.y + 5.0 * size)];
        let (sum, _) = total(corners);
        assert!((sum - 12.5 * size * size).abs() < 1e-9 * size * size, "{sum}");
    }

    #[test]
    fn a_small_triangle_lies_in_one_cell() {
        let corners = [DVec3::ZERO, DVec3::new(1e-7, 0.0, 0.0), DVec3::new(0.0, 1e-7, 0.0)];
        let (sum, cells) = total(corners);
        assert_eq!(cells, 1);
        assert!((sum - 5e-15).abs() < 1e-20);
    }
}

//! The surface of each cell, measured: triangles are cut into parts, and of each part it is asked on both sides whether
//! light can come to it. Many points are asked together, so that their rays can be traced together.

use std::ops::Range;

use glam::{DVec3, IVec3, Vec3};
use rayon::prelude::*;
use rustc_hash::FxHashMap;

use super::class::NormalClasses;
use super::clip::{Part, clip_triangle};
use super::grid::Grid;
use super::index::CellKey;
use super::layout::{CellSurface, SidePoint, SurfaceTriangle};
use crate::math::Side;

/// Surface that light can reach, and surface that is hidden.
pub(super) type Cells = FxHashMap<(u32, CellKey), [CellSurface; 2]>;

/// Parts of a triangle below this share of a cell's face are open or hidden as a whole.
const SMALL_PART: f64 = 0.1;

/// Points after which it is time to ask. Which points are asked together depends on the triangles alone, never on threads.
const TOGETHER: usize = 512;

/// How the surface of a scene is measured.
pub(super) struct Measure<'a, O> {
    /// Where the cells lie.
    pub(super) grid: &'a Grid,
    /// How surfaces in one cell are kept apart.
    pub(super) classes: NormalClasses,
    /// Scene area of one unit of [`CellSurface::area`].
    pub(super) area_unit: f64,
    /// Tells of points whether light can come to them, in order.
    pub(super) open: O,
}

impl<O: Fn(&[SidePoint]) -> Vec<bool> + Sync> Measure<'_, O> {
    /// Measures triangles, given by index with their areas. `None` once `keep_going` says no.
    pub(super) fn cells(
        &self,
        areas: &[f64],
        triangle: impl Fn(usize) -> SurfaceTriangle + Sync,
        keep_going: impl Fn() -> bool + Sync,
    ) -> Option<Cells> {
        let add = |cells: Cells, triangles: Range<usize>| {
            let mut pending = Pending { measure: self, cells, points: Vec::new(), parts: Vec::new() };
            for i in triangles {
                pending.add(&triangle(i));
            }
            pending.ask();
            keep_going().then_some(pending.cells)
        };
        let merge = |mut a: Cells, mut b: Cells| {
            if a.len() < b.len() {
                std::mem::swap(&mut a, &mut b);
            }
            for (key, surfaces) in b {
                add_surfaces(a.entry(key).or_default(), &surfaces);
            }
            keep_going().then_some(a)
        };
        self.chunks(areas).into_par_iter().try_fold(Cells::default, add).try_reduce(Cells::default, merge)
    }

    /// Ranges of triangles that make enough parts to be asked about together.
    fn chunks(&self, areas: &[f64]) -> Vec<Range<usize>> {
        let finest = f64::from(self.grid.levels[self.grid.base()].cell_size).powi(2);
        let (mut chunks, mut first, mut parts) = (Vec::new(), 0, 0.0);
        for (i, area) in areas.iter().enumerate() {
            parts += 1.0 + area / finest;
            if 2.0 * parts > TOGETHER as f64 || i + 1 == areas.len() {
                chunks.push(first..i + 1);
                (first, parts) = (i + 1, 0.0);
            }
        }
        chunks
    }
}

/// One side of a part of a triangle that waits to be asked about.
struct PendingPart {
    key: (u32, CellKey),
    area: f64,
    centroid: DVec3,
    /// Of the side.
    normal: Vec3,
    glossy: bool,
    /// Number of its points, the next ones.
    points: usize,
}

/// What a chunk of triangles adds.
struct Pending<'a, O> {
    measure: &'a Measure<'a, O>,
    cells: Cells,
    /// Points, and what area each stands for.
    points: Vec<(SidePoint, f64)>,
    parts: Vec<PendingPart>,
}

impl<O: Fn(&[SidePoint]) -> Vec<bool> + Sync> Pending<'_, O> {
    fn add(&mut self, triangle: &SurfaceTriangle) {
        let grid = self.measure.grid;
        clip_triangle(grid, triangle.corners, &mut |level, cell, part| {
            for side in Side::both(triangle.normal) {
                self.add_side(level, cell, &part, side, triangle.glossy);
            }
            if self.points.len() >= TOGETHER {
                self.ask();
            }
        });
    }

    /// Small parts are open or not as their center is, large ones as the triangles around their center are.
    fn add_side(&mut self, level: usize, cell: IVec3, part: &Part<'_>, side: Side, glossy: bool) {
        let Measure { grid, classes, .. } = self.measure;
        let cell_size = grid.levels[level].cell_size;
        let point = |offset: DVec3| SidePoint { p: grid.position(offset.as_vec3()), side, cell_size };
        let before = self.points.len();
        if part.area < SMALL_PART * f64::from(cell_size).powi(2) {
            self.points.push((point(part.centroid), part.area));
        } else {
            let corners = part.corners;
            self.points.extend((0..corners.len()).map(|i| {
                let (a, b) = (corners[i], corners[(i + 1) % corners.len()]);
                let area = 0.5 * (a - part.centroid).cross(b - part.centroid).length();
                (point((a + b + part.centroid) / 3.0), area)
            }));
        }
        self.parts.push(PendingPart {
            key: (level as u32, CellKey::new(&grid.levels[level], cell, classes.of(side))),
            area: part.area,
            centroid: part.centroid,
            normal: side.normal,
            glossy,
            points: self.points.len() - before,
        });
    }

    /// Asks about the points that wait, and adds their parts to the cells.
    fn ask(&mut self) {
        let points: Vec<SidePoint> = self.points.iter().map(|(point, _)| *point).collect();
        let open = (self.measure.open)(&points);
        let mut answers = self.points.drain(..).zip(open);
        for part in self.parts.drain(..) {
            let areas =
                answers.by_ref().take(part.points).map(|((_, area), open)| if open { area } else { 0.0 });
            let share = (areas.sum::<f64>() / part.area).min(1.0);
            let units = |share: f64| part.surface(share / self.measure.area_unit);
            let surfaces = [units(share), units(1.0 - share)];
            if surfaces.iter().any(|surface| surface.area > 0) {
                add_surfaces(self.cells.entry(part.key).or_default(), &surfaces);
            }
        }
    }
}

impl PendingPart {
    /// In `units` area units per square scene unit.
    #[expect(clippy::cast_possible_truncation, reason = "quantised on purpose")]
    fn surface(&self, units: f64) -> CellSurface {
        let units = self.area * units;
        let area = units.round() as i64;
        CellSurface {
            area,
            normal: (self.normal.as_dvec3() * units).to_array().map(|c| c.round() as i64),
            centroid: (self.centroid * units).to_array().map(|c| c.round() as i64),
            glossy_area: if self.glossy { area } else { 0 },
        }
    }
}

fn add_surfaces(sums: &mut [CellSurface; 2], surfaces: &[CellSurface; 2]) {
    for (sum, surface) in sums.iter_mut().zip(surfaces) {
        sum.add(surface);
    }
}

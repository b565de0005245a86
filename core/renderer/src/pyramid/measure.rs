//! Triangles cut into what lies of them in each cell: first to see which cells there are, and once photons have landed to
//! ask of each part whether light can come to it. Many points are asked together, so that their rays can be traced together.

use std::ops::Range;

use glam::DVec3;
use rayon::prelude::*;

use super::clip::{Part, clip_triangle};
use super::grid::Grid;
use super::index::CellKey;
use super::layout::Layout;
use super::surfaces::CellSurface;
use super::{NormalClasses, SidePoint, Surroundings};
use crate::math::Side;

/// Parts of a triangle below this share of a cell's face are open or hidden as a whole.
const SMALL_PART: f64 = 0.1;

/// Points after which it is time to ask. Which points are asked together depends on the triangles alone, never on threads.
const TOGETHER: usize = 512;

/// Area unit: sums over the whole scene stay exact in 63 bits, and a 10⁻¹² part of the scene still counts.
const AREA_BITS: i32 = 48;

/// The triangles in batches that make enough parts to be asked about together, and how finely area is counted.
#[derive(Debug)]
pub(super) struct Batches {
    ranges: Vec<Range<usize>>,
    /// Scene area of one unit of [`CellSurface::area`], a power of two.
    pub(super) area_unit: f64,
}

impl Batches {
    pub(super) fn new(grid: &Grid, scene: &impl Surroundings) -> Self {
        let triangles = 0..scene.triangle_count();
        let areas: Vec<f64> =
            triangles.into_par_iter().map(|i| quantized_area(scene.triangle(i).corners)).collect();
        let total: f64 = areas.iter().sum();
        let area_unit = (total.max(f64::MIN_POSITIVE).log2().ceil() - f64::from(AREA_BITS)).exp2();
        let finest = f64::from(grid.base_cell_size()).powi(2);
        let (mut ranges, mut first, mut parts) = (Vec::new(), 0, 0.0);
        for (i, area) in areas.iter().enumerate() {
            parts += 1.0 + area / finest;
            if 2.0 * parts > TOGETHER as f64 || i + 1 == areas.len() {
                ranges.push(first..i + 1);
                (first, parts) = (i + 1, 0.0);
            }
        }
        Self { ranges, area_unit }
    }

    /// Area in units; a part that rounds to none has no cell.
    #[expect(clippy::cast_possible_truncation, reason = "quantised on purpose")]
    fn units(&self, area: f64) -> i64 {
        (area / self.area_unit).round() as i64
    }

    /// By level, sorted: the cells that hold surface directly. `None` when cancelled.
    pub(super) fn cells(
        &self,
        grid: &Grid,
        classes: NormalClasses,
        scene: &impl Surroundings,
    ) -> Option<Vec<Vec<CellKey>>> {
        let batch = |range: &Range<usize>| {
            let mut keys: Vec<(usize, CellKey)> = Vec::new();
            for triangle in range.clone().map(|i| scene.triangle(i)) {
                let sides = Side::both(triangle.normal).map(|side| classes.of(side));
                clip_triangle(grid, triangle.corners, &mut |level, cell, part| {
                    if self.units(part.area) > 0 {
                        keys.extend(
                            sides.map(|class| (level, CellKey::new(&grid.levels[level], cell, class))),
                        );
                    }
                });
            }
            keys.sort_unstable();
            keys.dedup();
            scene.keep_going().then_some(keys)
        };
        let batches: Option<Vec<_>> = self.ranges.par_iter().map(batch).collect();
        let mut levels = vec![Vec::new(); grid.levels.len()];
        for (level, key) in batches?.into_iter().flatten() {
            levels[level].push(key);
        }
        for keys in &mut levels {
            keys.par_sort_unstable();
            keys.dedup();
        }
        Some(levels)
    }

    /// The mean normals of the glossy surfaces in cells up to the finest level that is everywhere, as sums by level and
    /// place through `add`.
    pub(super) fn glossy_normals(
        &self,
        layout: &Layout,
        scene: &impl Surroundings,
        add: &(impl Fn(usize, usize, [i64; 3]) + Sync),
    ) {
        self.ranges.par_iter().for_each(|range| {
            for triangle in range.clone().map(|i| scene.triangle(i)).filter(|triangle| triangle.glossy) {
                clip_triangle(&layout.grid, triangle.corners, &mut |level, cell, part| {
                    for side in Side::both(triangle.normal) {
                        let class = layout.classes.of(side);
                        let Some(place) = layout.levels[level].index.find(cell, class) else { continue };
                        let (level, place) = layout.unrefined(level, place);
                        let normal = side.normal.as_dvec3() * part.area;
                        add(level, place, normal.to_array().map(|c| self.units(c)));
                    }
                });
            }
        });
    }
}

/// Rounded so that the sum over triangles does not depend on its order.
fn quantized_area(corners: [DVec3; 3]) -> f64 {
    let area = 0.5 * (corners[1] - corners[0]).cross(corners[2] - corners[0]).length();
    (area * 2.0_f64.powi(AREA_BITS)).round() * 2.0_f64.powi(-AREA_BITS)
}

/// Calls `add(level, place, [open, hidden])` with the surface that light can reach and that is hidden, part by part, for the
/// cells that are `lit`. `None` when cancelled.
pub(super) fn measure(
    layout: &Layout,
    lit: &[Vec<bool>],
    scene: &impl Surroundings,
    add: &(impl Fn(usize, usize, [CellSurface; 2]) + Sync),
) -> Option<()> {
    layout.batches.ranges.par_iter().try_for_each(|range| {
        let mut pending = Pending { layout, lit, scene, add, points: Vec::new(), parts: Vec::new() };
        for i in range.clone() {
            pending.add_triangle(i);
        }
        pending.ask();
        scene.keep_going().then_some(())
    })
}

/// One side of a part of a triangle that waits to be asked about.
struct PendingPart {
    level: usize,
    place: usize,
    area: f64,
    surface: CellSurface,
    /// Number of its points, the next ones.
    points: usize,
}

/// What a batch of triangles adds.
struct Pending<'a, S, A> {
    layout: &'a Layout,
    lit: &'a [Vec<bool>],
    scene: &'a S,
    add: &'a A,
    /// Points, and what area each stands for.
    points: Vec<(SidePoint, f64)>,
    parts: Vec<PendingPart>,
}

impl<S: Surroundings, A: Fn(usize, usize, [CellSurface; 2])> Pending<'_, S, A> {
    fn add_triangle(&mut self, i: usize) {
        let triangle = self.scene.triangle(i);
        let sides = Side::both(triangle.normal).map(|side| (side, self.layout.classes.of(side)));
        clip_triangle(&self.layout.grid, triangle.corners, &mut |level, cell, part| {
            for (side, class) in sides {
                let place = self.layout.levels[level].index.find(cell, class);
                if let Some(place) = place.filter(|&place| self.lit[level][place]) {
                    self.add_part(level, place, &part, side, triangle.glossy);
                }
            }
            if self.points.len() >= TOGETHER {
                self.ask();
            }
        });
    }

    /// Small parts are open or not as their center is, large ones as the triangles around their center are.
    fn add_part(&mut self, level: usize, place: usize, part: &Part<'_>, side: Side, glossy: bool) {
        let (grid, batches) = (&self.layout.grid, &self.layout.batches);
        let cell_size = grid.levels[level].cell_size.max(grid.base_cell_size());
        let point = |offset: DVec3| SidePoint { p: grid.position(offset.as_vec3()), side, cell_size };
        let before = self.points.len();
        if part.area < SMALL_PART * f64::from(grid.levels[level].cell_size).powi(2) {
            self.points.push((point(part.centroid), part.area));
        } else {
            let corners = part.corners;
            self.points.extend((0..corners.len()).map(|i| {
                let (a, b) = (corners[i], corners[(i + 1) % corners.len()]);
                let area = 0.5 * (a - part.centroid).cross(b - part.centroid).length();
                (point((a + b + part.centroid) / 3.0), area)
            }));
        }
        let units = |v: DVec3| (v * part.area).to_array().map(|c| batches.units(c));
        let area = batches.units(part.area);
        let surface = CellSurface {
            area,
            normal: units(side.normal.as_dvec3()),
            centroid: units(part.centroid),
            glossy_area: if glossy { area } else { 0 },
        };
        let points = self.points.len() - before;
        self.parts.push(PendingPart { level, place, area: part.area, surface, points });
    }

    /// Asks about the points that wait, and adds their parts to the cells.
    #[expect(clippy::cast_precision_loss, clippy::cast_possible_truncation, reason = "a share of the area")]
    fn ask(&mut self) {
        let points: Vec<SidePoint> = self.points.iter().map(|(point, _)| *point).collect();
        let open = self.scene.open(&points);
        let mut answers = self.points.drain(..).zip(open);
        for PendingPart { level, place, area, surface, points } in self.parts.drain(..) {
            let areas = answers.by_ref().take(points).map(|((_, area), open)| if open { area } else { 0.0 });
            let share = (areas.sum::<f64>() / area).min(1.0);
            let open = surface.part((surface.area as f64 * share).round() as i64);
            (self.add)(level, place, [open, surface.without(&open)]);
        }
    }
}

//! Triangles cut into what lies of them in each cell: first to see which cells there are, and once photons have landed to
//! ask of each part whether light can come to it. Many points are asked together, so that their rays can be traced together.

use std::ops::Range;

use glam::{DVec3, IVec3};
use rayon::prelude::*;

use super::class::BACKS;
use super::clip::{Part, clip_triangle, to_the_finest};
use super::divided::PartRims;
use super::grid::Grid;
use super::index::CellGroup;
use super::layout::Layout;
use super::lit::LitLayout;
use super::surfaces::{CellSurface, OpenSum};
use super::{NormalClasses, SidePoint, Surroundings};
use crate::math::Side;
use crate::sampling::{Rng, hash};

/// Area that one point speaks for, as a share of a cell's face. Of smaller parts of a triangle only so many are asked about.
const POINT: f64 = 0.1;

/// Parts of a triangle below this share of a cell's face are open or hidden as a whole.
const SMALL_PART: f64 = 0.25;

/// Points after which it is time to ask. Which points are asked together depends on the triangles alone, never on threads.
const TOGETHER: usize = 512;

/// Sides of parts of triangles in a batch, about: enough for so many points.
const PARTS: f64 = 2048.0;

/// Area unit: sums over the whole scene stay exact in 63 bits, and a 10⁻¹² part of the scene still counts.
const AREA_BITS: i32 = 48;

/// The triangles in batches that make enough parts to be asked about together, and how finely area is counted.
#[derive(Clone, Debug)]
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
            if 2.0 * parts > PARTS || i + 1 == areas.len() {
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
    ) -> Option<Vec<Vec<CellGroup>>> {
        // Of fronts only: where one is, there is its back.
        let batch = |range: &Range<usize>| {
            let mut fronts = vec![Vec::new(); grid.levels.len()];
            for triangle in range.clone().map(|i| scene.triangle(i)) {
                let class = classes.of(Side { normal: triangle.normal, back: false });
                clip_triangle(grid, triangle.corners, to_the_finest, |level, cell, part| {
                    if self.units(part.area) > 0 {
                        CellGroup::new(&grid.levels[level], cell, class).push(&mut fronts[level]);
                    }
                });
            }
            fronts.iter_mut().for_each(CellGroup::unite);
            scene.keep_going().then_some(fronts)
        };
        let batches: Option<Vec<_>> = self.ranges.par_iter().map(batch).collect();
        let batches = batches?;
        let level = |level: usize| {
            let mut groups: Vec<CellGroup> =
                batches.iter().flat_map(|fronts| &fronts[level]).copied().collect();
            CellGroup::unite(&mut groups);
            let backs = groups.iter().map(|group| group.of_class(|front| BACKS + classes.facing(front)));
            let backs: Vec<CellGroup> = backs.collect();
            groups.extend(backs);
            CellGroup::unite(&mut groups);
            groups
        };
        Some((0..grid.levels.len()).into_par_iter().map(level).collect())
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
                clip_triangle(&layout.grid, triangle.corners, to_the_finest, |level, cell, part| {
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

/// Adds the surface of cells that matter to `sums`, and what is known of its openness. Surface where no light came is added
/// to the largest cell that none came to, and asked about as coarsely. `None` when cancelled.
pub(super) fn measure(lit: &LitLayout<'_>, scene: &impl Surroundings, sums: &[Vec<OpenSum>]) -> Option<()> {
    lit.layout.batches.ranges.par_iter().try_for_each(|range| {
        let layout = &lit.layout;
        let (points, asked, rims) = (Vec::new(), Vec::new(), PartRims::default());
        let mut pending = Pending { layout, lit, scene, sums, points, asked, rims };
        for i in range.clone() {
            pending.add_triangle(i);
        }
        pending.ask();
        scene.keep_going().then_some(())
    })
}

/// What a point that waits to be asked about speaks for.
struct Asked {
    level: usize,
    place: usize,
    /// In units.
    area: i64,
    /// Whether other surfaces share its cell.
    in_company: bool,
}

/// What a batch of triangles adds.
struct Pending<'a, S> {
    layout: &'a Layout,
    lit: &'a LitLayout<'a>,
    scene: &'a S,
    sums: &'a [Vec<OpenSum>],
    points: Vec<SidePoint>,
    /// By point.
    asked: Vec<Asked>,
    rims: PartRims,
}

impl<S: Surroundings> Pending<'_, S> {
    fn add_triangle(&mut self, i: usize) {
        let triangle = self.scene.triangle(i);
        let sides = Side::both(triangle.normal).map(|side| (side, self.layout.classes.of(side)));
        let (layout, lit) = (self.layout, self.lit);
        let is_dark = |level: usize, cell: IVec3| {
            let place = |class| layout.levels[level].index.find(cell, class);
            sides.iter().all(|&(_, class)| place(class).is_none_or(|place| !lit.is_lit[level][place]))
        };
        clip_triangle(&layout.grid, triangle.corners, is_dark, |level, cell, part| {
            let mut is_alone = None;
            for (side, class) in sides {
                let Some((of, place)) = self.counted_in(level, cell, class) else { continue };
                let surface = self.surface(&part, side, triangle.glossy);
                self.sums[of][place].add(&surface);
                let box_of = &layout.grid.levels[level];
                let in_company = of == level
                    && (layout.grid.is_divided(level, box_of.lattice(cell))
                        || !*is_alone.get_or_insert_with(|| lit.whole.levels[level].index.is_alone(cell)));
                let several = of < level || in_company;
                self.add_points((of, place), &part, surface.area, side, several, in_company);
                let is_large = part.area >= SMALL_PART * f64::from(box_of.cell_size).powi(2);
                if in_company && is_large {
                    self.rims.add((of, place), &part, side, box_of.cell_size, &layout.grid);
                }
            }
            if self.points.len() >= TOGETHER {
                self.ask();
            }
        });
    }

    /// The cell that surface of a cell is added to: itself, or the largest around it that no light came to.
    fn counted_in(&self, mut level: usize, mut cell: IVec3, class: usize) -> Option<(usize, usize)> {
        loop {
            if let Some(place) = self.layout.levels[level].index.find(cell, class) {
                return Some((level, place));
            }
            // What does not matter lies in something larger that does, without light like itself.
            let coarser = level.checked_sub(1)?;
            (level, cell) = (coarser, self.layout.grid.parent(level, cell)?);
        }
    }

    fn surface(&self, part: &Part<'_>, side: Side, glossy: bool) -> CellSurface {
        let batches = &self.layout.batches;
        let units = |v: DVec3| (v * part.area).to_array().map(|c| batches.units(c));
        let area = batches.units(part.area);
        CellSurface {
            area,
            normal: units(side.normal.as_dvec3()),
            centroid: units(part.centroid),
            glossy_area: if glossy { area } else { 0 },
        }
    }

    /// Small parts are open or not as the center of some of them is, which ones being left to chance. Of large ones each
    /// triangle around the center is asked about, unless the part is alone in its cell.
    fn add_points(
        &mut self,
        (level, place): (usize, usize),
        part: &Part<'_>,
        area: i64,
        side: Side,
        several: bool,
        in_company: bool,
    ) {
        let layout = self.layout;
        let (grid, batches) = (&layout.grid, &layout.batches);
        let mut ask = |offset: DVec3, area: i64| {
            let offset = offset.as_vec3();
            let finest = grid.locate(offset, grid.base()).map_or(0, |(level, _)| level);
            let cell_size = grid.levels[finest].cell_size;
            self.points.push(SidePoint { p: grid.position(offset), side, cell_size });
            self.asked.push(Asked { level, place, area, in_company });
        };
        let face = f64::from(grid.levels[level].cell_size).powi(2);
        let point = POINT * face;
        if part.area < point {
            // Chance belongs to the part, whatever thread cuts it.
            let bits = part.centroid.to_array().iter().fold(0, |bits, c| hash(bits, c.to_bits()));
            if f64::from(Rng::new(bits).draw()) * point < part.area {
                ask(part.centroid, batches.units(point));
            }
        } else if several && part.area >= SMALL_PART * face {
            let corners = part.corners;
            for (i, &a) in corners.iter().enumerate() {
                let b = corners[(i + 1) % corners.len()];
                let area = 0.5 * (a - part.centroid).cross(b - part.centroid).length();
                ask((a + b + part.centroid) / 3.0, batches.units(area));
            }
        } else {
            ask(part.centroid, area);
        }
    }

    /// Asks about the points that wait, and the rims.
    fn ask(&mut self) {
        self.rims.ask(self.scene, |(level, place)| self.sums[level][place].divide());
        let openness = self.scene.openness(&self.points);
        let grid = &self.layout.grid;
        // Two surfaces that face each other: the far side of one, where it shares a cell with the near side of the other, and
        // what lies between them.
        let (mut far, mut shared) = (Vec::new(), Vec::new());
        for ((asked, point), found) in self.asked.drain(..).zip(self.points.drain(..)).zip(openness) {
            let Asked { level, place, area, in_company } = asked;
            self.sums[level][place].add_answer(area, found.is_open);
            let level_box = &grid.levels[level];
            let cell = || self.layout.levels[level].keys[place].cell(level_box).0;
            if found.is_open && in_company {
                let cell = level_box.lattice(cell());
                let inside = grid.offset(point.p) / level_box.cell_size - cell.as_vec3();
                self.sums[level][place].add_open_point(inside, point.side.normal);
            }
            let Some((p, side)) = found.above else { continue };
            let cell = cell();
            if level_box.cell(grid.offset(p)) != Some(cell) {
                continue;
            }
            let above = SidePoint { p, side, ..point };
            let between = SidePoint { p: 0.5 * (point.p + p), ..point };
            let below = SidePoint { side: point.side.other(), ..point };
            for (near, far_side) in [(point.side, above), (side.other(), below)] {
                let class = self.layout.classes.of(near);
                if class == self.layout.classes.of(far_side.side)
                    && let Some(place) = self.layout.levels[level].index.find(cell, class)
                {
                    far.push(far_side);
                    shared.push((level, place, between));
                }
            }
        }
        // Where light comes to both it is not the same.
        for (found, (level, place, between)) in self.scene.openness(&far).into_iter().zip(shared) {
            if found.is_open && self.scene.leads_out(&between) {
                self.sums[level][place].divide();
            }
        }
    }
}

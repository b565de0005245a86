//! How much surface of each cell counts: what flux is divided by. Measured after the photons have landed: where none did,
//! and that is the inside of every solid, nothing has to be known.

use std::sync::atomic::{AtomicBool, AtomicI64, Ordering};

use glam::{DVec3, Vec3};
use rayon::prelude::*;

use super::Surroundings;
use super::class::BACKS;
use super::divided::{Rim, find_divided};
use super::index::CellKey;
use super::layout::Layout;
use super::lit::LitLayout;
use super::measure::measure;

/// Part of a cell's face: a cell with less surface is a sliver.
const SLIVER: f64 = 0.1;

/// Surface inside one cell and normal class. Sums are integers, so that their order does not matter.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct CellSurface {
    /// Area in units of [`Layout::area_unit`].
    pub(super) area: i64,
    /// Area-weighted normal, in the same unit.
    pub(super) normal: [i64; 3],
    /// Area-weighted position relative to the lattice's origin, in the same unit.
    pub(super) centroid: [i64; 3],
    /// Area of what needs direction bins.
    pub(super) glossy_area: i64,
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

    /// What `area` of a surface that is the same everywhere amounts to.
    #[expect(clippy::cast_precision_loss, clippy::cast_possible_truncation, reason = "a share of the area")]
    fn part(&self, area: i64) -> Self {
        let share = |value: i64| (value as f64 * (area as f64 / self.area.max(1) as f64)).round() as i64;
        Self {
            area,
            normal: self.normal.map(share),
            centroid: self.centroid.map(share),
            glossy_area: share(self.glossy_area),
        }
    }

    /// The rest of it without `part`.
    fn without(&self, part: &Self) -> Self {
        Self {
            area: self.area - part.area,
            normal: std::array::from_fn(|c| self.normal[c] - part.normal[c]),
            centroid: std::array::from_fn(|c| self.centroid[c] - part.centroid[c]),
            glossy_area: self.glossy_area - part.glossy_area,
        }
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
    #[expect(clippy::cast_precision_loss, reason = "a position needs no more than 53 bits")]
    pub(super) fn centroid(&self) -> Vec3 {
        (DVec3::from(self.centroid.map(|c| c as f64)) / self.area.max(1) as f64).as_vec3()
    }

    /// Unit mean normal; the class's own axis would be wrong by up to 55°.
    #[expect(clippy::cast_precision_loss, reason = "a direction needs no more than 53 bits")]
    pub(super) fn mean_normal(&self) -> Vec3 {
        DVec3::from(self.normal.map(|c| c as f64)).normalize_or(DVec3::Z).as_vec3()
    }
}

/// Sums of [`CellSurface`] that several threads add to.
#[derive(Debug, Default)]
struct SurfaceSum {
    area: AtomicI64,
    normal: [AtomicI64; 3],
    centroid: [AtomicI64; 3],
    glossy_area: AtomicI64,
}

impl SurfaceSum {
    fn add(&self, surface: &CellSurface) {
        let add = |sum: &AtomicI64, value: i64| sum.fetch_add(value, Ordering::Relaxed);
        add(&self.area, surface.area);
        for c in 0..3 {
            add(&self.normal[c], surface.normal[c]);
            add(&self.centroid[c], surface.centroid[c]);
        }
        add(&self.glossy_area, surface.glossy_area);
    }

    fn get(&self) -> CellSurface {
        let value = |sum: &AtomicI64| sum.load(Ordering::Relaxed);
        CellSurface {
            area: value(&self.area),
            normal: self.normal.each_ref().map(value),
            centroid: self.centroid.each_ref().map(value),
            glossy_area: value(&self.glossy_area),
        }
    }
}

/// Surface of a cell, and how much of it is open as far as anybody asked.
#[derive(Debug, Default)]
pub(super) struct OpenSum {
    whole: SurfaceSum,
    /// Area that was asked about, and what of it is open; in units of [`Layout::area_unit`].
    asked: AtomicI64,
    open: AtomicI64,
    /// Something divides a part of it.
    divided: AtomicBool,
    rim: Rim,
}

impl OpenSum {
    pub(super) fn add(&self, surface: &CellSurface) {
        self.whole.add(surface);
    }

    pub(super) fn divide(&self) {
        self.divided.store(true, Ordering::Relaxed);
    }

    /// Its open points, and its mean normal.
    pub(super) fn rim(&self) -> (&Rim, impl FnOnce() -> Vec3) {
        (&self.rim, || self.whole.get().mean_normal())
    }

    /// Takes note of an open point, see [`Rim::add`].
    pub(super) fn add_open_point(&self, inside: Vec3, normal: Vec3) {
        self.rim.add(inside, normal);
    }

    pub(super) fn add_answer(&self, area: i64, is_open: bool) {
        self.asked.fetch_add(area, Ordering::Relaxed);
        if is_open {
            self.open.fetch_add(area, Ordering::Relaxed);
        }
    }

    /// What light can reach, what is hidden, and what is unknown: all, where there is too little to ask about.
    #[expect(clippy::cast_precision_loss, clippy::cast_possible_truncation, reason = "a share of the area")]
    fn get(&self) -> [CellSurface; 3] {
        let (whole, none) = (self.whole.get(), CellSurface::default());
        let [asked, open] = [&self.asked, &self.open].map(|sum| sum.load(Ordering::Relaxed));
        if asked == 0 {
            return [none, none, whole];
        }
        let open = whole.part((whole.area as f64 * (open as f64 / asked as f64)).round() as i64);
        [open, whole.without(&open), none]
    }

    /// What is not known to be hidden.
    fn not_hidden(&self) -> CellSurface {
        let [mut open, _, unknown] = self.get();
        open.add(&unknown);
        open
    }

    /// Hides so much of the area that is not known to be hidden.
    fn hide(&self, area: i64) {
        let not_hidden = self.not_hidden().area;
        self.asked.store(self.whole.get().area, Ordering::Relaxed);
        self.open.store(not_hidden - area, Ordering::Relaxed);
    }
}

/// Memory (bytes) per cell that measuring takes. A level has a quarter of the cells of the next finer one.
pub(super) const BYTES_PER_CELL: usize =
    size_of::<OpenSum>() + size_of::<CellSurface>() + size_of::<bool>() + size_of::<[SurfaceSum; 3]>() / 4;

/// Surface of the cells of one level, by place.
#[derive(Debug)]
pub(super) struct LevelSurfaces {
    /// What counts.
    pub(super) surfaces: Vec<CellSurface>,
    /// Whether light cannot come to the cell's surface, or hardly: it counts for itself, and not for a coarser cell that
    /// holds open surface too.
    hidden: Vec<bool>,
    /// Whether something divides a part of the cell's own surface, so that light on one side of it is not that on the other.
    pub(super) divided: Vec<bool>,
}

/// Surface of all cells that light came to, and of the largest around the others that none came to. Cells within those have
/// none, nor have those of a coarsest cell that light never came to.
#[derive(Debug)]
pub(super) struct Surfaces<'a> {
    pub(super) layout: &'a Layout,
    /// By level.
    pub(super) levels: Vec<LevelSurfaces>,
}

/// Where less than this part of a cell's surface is open, all of it counts: what little light there is has to land.
const LEAST_OPEN: i64 = 8;

impl<'a> Surfaces<'a> {
    /// Asks of the surface of lit cells whether light can come to it: hidden surface, such as the floor under a box, is left
    /// out beside open one. `None` when cancelled.
    pub(super) fn measure(lit: &'a LitLayout<'_>, scene: &impl Surroundings) -> Option<Self> {
        let layout = &lit.layout;
        let none = |level: &Vec<bool>| level.par_iter().map(|_| OpenSum::default()).collect();
        let mut sums: Vec<Vec<OpenSum>> = lit.is_lit.iter().map(none).collect();
        measure(lit, scene, &sums)?;
        for (level, sums) in sums.iter().enumerate() {
            find_divided(layout, level, sums, scene);
        }
        for (level, sums) in sums.iter().enumerate() {
            hide_contacts(layout, level, sums);
        }
        let mut levels: Vec<LevelSurfaces> = Vec::new();
        // What finer cells add to the cells of a level.
        let mut finer: Vec<[SurfaceSum; 3]> = Vec::new();
        while let Some(cells) = sums.pop() {
            let level = sums.len();
            let all = |(place, cell): (usize, &OpenSum)| {
                let mut sums = cell.get();
                for (sum, finer) in sums.iter_mut().zip(finer.get(place).into_iter().flatten()) {
                    sum.add(&finer.get());
                }
                counted(sums)
            };
            let (surfaces, states): (Vec<CellSurface>, Vec<State>) =
                cells.par_iter().enumerate().map(all).unzip();
            let coarser = sums.last().map_or(0, Vec::len);
            finer = (0..coarser).into_par_iter().map(|_| Default::default()).collect();
            let places = (0..cells.len()).into_par_iter().filter(|&place| surfaces[place].area > 0);
            places.for_each(|place| {
                if let Some(parent) = layout.parent(level, place) {
                    finer[parent][states[place] as usize].add(&surfaces[place]);
                }
            });
            let hidden = states.into_iter().map(|state| state == State::Hidden).collect();
            let divided = cells.into_iter().map(|cell| cell.divided.into_inner()).collect();
            levels.push(LevelSurfaces { surfaces, hidden, divided });
        }
        levels.reverse();
        Some(Self { layout, levels })
    }

    /// Area of what counts of a cell (square scene units).
    #[expect(clippy::cast_precision_loss, reason = "an area needs no more than 53 bits")]
    pub(super) fn area(&self, level: usize, place: usize) -> f64 {
        self.levels[level].surfaces[place].area as f64 * self.layout.area_unit()
    }

    /// Whether there is so little surface in a cell that a single photon there would be a spark.
    pub(super) fn is_sliver(&self, level: usize, place: usize) -> bool {
        self.area(level, place) < SLIVER * f64::from(self.layout.grid.levels[level].cell_size).powi(2)
    }

    /// Place of the coarser cell that a cell is a part of: where its surface and light are counted too.
    pub(super) fn counting_parent(&self, level: usize, place: usize) -> Option<usize> {
        let hidden = self.levels[level].hidden[place];
        self.layout.parent(level, place).filter(|&parent| !hidden || self.levels[level - 1].hidden[parent])
    }
}

/// Hides the surface where two flat fronts of a cell lie on each other, such as a box's bottom and the floor.
fn hide_contacts(layout: &Layout, level: usize, sums: &[OpenSum]) {
    let (level_box, cells) = (&layout.grid.levels[level], &layout.levels[level]);
    let contact = |(place, key): (usize, &CellKey)| {
        let (cell, class) = key.cell(level_box);
        if class >= BACKS || layout.classes.facing(class) < class {
            return None;
        }
        let other = cells.index.find(cell, layout.classes.facing(class))?;
        let [front, facing] = [place, other].map(|place| sums[place].not_hidden());
        let is_contact = front.touches(&facing, level_box.cell_size);
        is_contact.then(|| ([place, other], front.area.min(facing.area)))
    };
    // A cell has one facing class: no two contacts share a cell.
    cells.keys.par_iter().enumerate().filter_map(contact).for_each(|(places, area)| {
        for place in places {
            sums[place].hide(area);
        }
    });
}

/// What is known of a cell's surface as a whole.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum State {
    Open,
    Hidden,
    Unknown,
}

/// What counts of a cell's surface: its open part, or all where hardly any is. What is unknown is taken to be open as far as
/// the rest of the cell is.
#[expect(clippy::cast_precision_loss, clippy::cast_possible_truncation, reason = "a share of the area")]
fn counted([mut open, mut hidden, unknown]: [CellSurface; 3]) -> (CellSurface, State) {
    let known = open.area + hidden.area;
    if known == 0 {
        return (unknown, State::Unknown);
    }
    let share = unknown.part((unknown.area as f64 * (open.area as f64 / known as f64)).round() as i64);
    open.add(&share);
    hidden.add(&unknown.without(&share));
    if open.area * LEAST_OPEN < hidden.area {
        open.add(&hidden);
        return (open, State::Hidden);
    }
    if open.glossy_area * LEAST_OPEN < hidden.glossy_area {
        open.glossy_area += hidden.glossy_area;
    }
    (open, State::Open)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Side;
    use crate::pyramid::{Grid, NormalClasses, Openness, SidePoint, SurfaceTriangle};

    /// Triangles in a place of their own, where `is_open` tells which points light can come to.
    struct Scene<F> {
        triangles: Vec<SurfaceTriangle>,
        is_open: F,
    }

    impl<F: Fn(&SidePoint) -> bool + Sync> Surroundings for Scene<F> {
        fn triangle_count(&self) -> usize {
            self.triangles.len()
        }

        fn triangle(&self, i: usize) -> SurfaceTriangle {
            self.triangles[i]
        }

        fn openness(&self, points: &[SidePoint]) -> Vec<Openness> {
            let found = |point: &SidePoint| Openness { is_open: (self.is_open)(point), above: None };
            points.iter().map(found).collect()
        }

        fn leads_out(&self, _: &SidePoint) -> bool {
            true
        }

        fn see(&self, pairs: &[[Vec3; 2]]) -> Vec<bool> {
            vec![true; pairs.len()]
        }

        fn keep_going(&self) -> bool {
            true
        }
    }

    fn triangle([a, b, c]: [DVec3; 3], glossy: bool) -> SurfaceTriangle {
        SurfaceTriangle { corners: [a, b, c], normal: (b - a).cross(c - a).normalize().as_vec3(), glossy }
    }

    /// As if photons had landed in every cell that `is_lit`.
    fn lit(layout: &Layout, is_lit: impl Fn(usize, usize) -> bool) -> LitLayout<'_> {
        let level = |number: usize| {
            let places = 0..layout.levels[number].keys.len();
            places.map(|place| is_lit(number, place)).collect()
        };
        LitLayout::new(layout, (0..layout.levels.len()).map(level).collect())
    }

    /// Area per level is the area of the surfaces, both sides, at every level.
    #[test]
    fn every_level_holds_the_whole_area() {
        let p = |x: f64, y: f64, z: f64| DVec3::new(x, y, z) * 0.07;
        let corners = [
            [p(-5.0, -5.0, -1.0), p(5.0, -5.0, -1.0), p(5.0, 5.0, -1.2)],
            [p(-1.0, 0.3, -1.0), p(1.0, 0.2, 2.0), p(0.0, 1.0, 0.4)],
            [p(0.0, 0.0, 0.0), p(0.1, 0.0, 0.0), p(0.0, 0.1, 0.05)],
        ];
        let half = DVec3::splat(0.4);
        let grid = Grid::new([-half * 0.2, half * 0.2], [-half, half], 20, DVec3::ZERO);
        let triangles = (0..).zip(corners).map(|(i, corners)| triangle(corners, i == 1)).collect();
        let scene = Scene { triangles, is_open: |_: &SidePoint| true };
        let layout = Layout::new(grid, NormalClasses::Six, &scene).unwrap();
        let lit = lit(&layout, |_, _| true);
        let surfaces = Surfaces::measure(&lit, &scene).unwrap();
        let exact: f64 = corners.iter().map(|[a, b, c]| (b - a).cross(c - a).length()).sum();
        let sum: f64 = (0..layout.levels[0].keys.len()).map(|place| surfaces.area(0, place)).sum();
        assert!((sum - exact).abs() < 1e-9 * exact, "{sum} against {exact}");
        let finest = &surfaces.levels[layout.grid.finest()].surfaces;
        assert!(finest.iter().any(|s| s.glossy_area > 0));
        assert!(finest.iter().any(|s| s.glossy_area == 0));
    }

    /// Both sides of a square: only the one that light came to is measured, all of it, as coarsely as the light tells.
    #[test]
    fn what_light_never_comes_to_is_not_measured() {
        let p = |x: f64, y: f64| DVec3::new(x, y, 0.013) * 0.1;
        let corners =
            [[p(-1.0, -1.0), p(1.0, -1.0), p(1.0, 1.0)], [p(-1.0, -1.0), p(1.0, 1.0), p(-1.0, 1.0)]];
        let half = DVec3::splat(0.1);
        let grid = Grid::new([-half, half], [-half, half], 16, DVec3::ZERO);
        let triangles = corners.map(|corners| triangle(corners, false)).to_vec();
        let scene = Scene { triangles, is_open: |point: &SidePoint| !point.side.back };
        let layout = Layout::new(grid, NormalClasses::Six, &scene).unwrap();
        let front = layout.classes.of(Side { normal: Vec3::Z, back: false });
        let finest = layout.grid.finest();
        let class =
            |level: usize, place: usize| layout.levels[level].keys[place].cell(&layout.grid.levels[level]).1;
        let coarsest: Vec<_> =
            (0..layout.levels[0].keys.len()).filter(|&place| class(0, place) == front).collect();
        let root = |mut level: usize, mut place: usize| {
            while let Some(parent) = (level > 0).then(|| layout.parent(level, place)).flatten() {
                (level, place) = (level - 1, parent);
            }
            place
        };
        let one_each: Vec<usize> = coarsest
            .iter()
            .map(|&of| {
                (0..layout.levels[finest].keys.len()).find(|&place| root(finest, place) == of).unwrap()
            })
            .collect();
        let some = lit(&layout, |level, place| level == finest && one_each.contains(&place));
        let surfaces = Surfaces::measure(&some, &scene).unwrap();
        let area_of = |key: CellKey, level: usize| -> f64 {
            let (cell, class) = key.cell(&layout.grid.levels[level]);
            let place = some.layout.levels[level].index.find(cell, class);
            place.map_or(0.0, |place| surfaces.area(level, place))
        };
        let area = |is_front: bool| -> f64 {
            let places = 0..layout.levels[0].keys.len();
            let places = places.filter(|&place| (class(0, place) == front) == is_front);
            places.map(|place| area_of(layout.levels[0].keys[place], 0)).sum()
        };
        assert!((area(true) / 0.04 - 1.0).abs() < 1e-9);
        assert_eq!(area(false), 0.0);
        // Finer cells are measured next to one that light came to.
        let all = lit(&layout, |_, _| true);
        let whole = Surfaces::measure(&all, &scene).unwrap();
        for level in 1..=finest {
            let places = 0..layout.levels[level].keys.len();
            for place in places.filter(|&place| class(level, place) == front) {
                let (parent, key) = (layout.parent(level, place).unwrap(), layout.levels[level].keys[place]);
                let above = some.places[level - 1].binary_search(&u32::try_from(parent).unwrap());
                let is_measured = above.is_ok_and(|above| some.is_lit[level - 1][above]);
                let exact = if is_measured { whole.area(level, place) } else { 0.0 };
                assert!((area_of(key, level) - exact).abs() < 1e-9 * 0.04, "level {level}");
            }
        }
    }

    /// A floor of 3 × 3 units, partly under a box of 1 × 0.5; all of it in one cell of 8.
    #[test]
    fn what_a_box_stands_on_does_not_count() {
        let p = |x: f64, y: f64| DVec3::new(x, y, 0.0) * 0.05;
        let rectangle =
            |x: f64, y: f64| [[p(0.0, 0.0), p(x, 0.0), p(x, y)], [p(0.0, 0.0), p(x, y), p(0.0, y)]];
        let floor = rectangle(3.0, 3.0);
        let bottom = rectangle(1.0, 0.5).map(|[a, b, c]| [a, c, b]);
        let half = DVec3::splat(0.2);
        let grid = Grid::new([-half, half], [-half, half], 1, DVec3::ZERO);
        let area = |is_open: &(dyn Fn(&SidePoint) -> bool + Sync), side: Side| {
            let triangles = floor.iter().chain(&bottom).map(|&corners| triangle(corners, false));
            let scene = Scene { triangles: triangles.collect(), is_open };
            let layout = Layout::new(grid.clone(), NormalClasses::Six, &scene).unwrap();
            let lit = lit(&layout, |_, _| true);
            let surfaces = Surfaces::measure(&lit, &scene).unwrap();
            let (level, place) = layout.find(p(2.0, 2.0).as_vec3(), layout.classes.of(side)).unwrap();
            surfaces.area(level, place) / 0.05_f64.powi(2)
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

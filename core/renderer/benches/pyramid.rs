//! The pyramid alone, on surfaces made for it: layout, deposits, merging, look-ups.

use std::hint::black_box;

use criterion::{BatchSize, Criterion, Throughput};
use glam::{DVec3, Vec3};
use rgp_renderer::color::Rgb;
use rgp_renderer::math::Side;
use rgp_renderer::pyramid::{
    Accumulator, Deposit, Grid, Layout, NormalClasses, Openness, Pyramid, SidePoint, SurfaceTriangle,
    Surroundings, TOGETHER,
};

const RESOLUTION: u32 = 128;
const PHOTONS: usize = 1_000_000;
const LOOKUPS: usize = 100_000;

/// Half the width of the room (scene units).
const HALF: f64 = 0.45;

/// Waves along an edge of the room's floor, and how high they are.
const WAVES: usize = 64;
const HEIGHT: f64 = 0.1;

/// A closed room of five flat walls and a finely tessellated, wavy floor.
struct Room {
    triangles: Vec<[DVec3; 3]>,
}

/// Where a photon lands.
#[derive(Clone, Copy)]
struct Landing {
    p: Vec3,
    normal: Vec3,
}

impl Room {
    fn new() -> Self {
        let mut triangles = Vec::new();
        let mut quad = |[a, b, c, d]: [DVec3; 4]| triangles.extend([[a, b, c], [a, c, d]]);
        let p = |x: f64, y: f64, z: f64| DVec3::new(x, y, z) * HALF;
        quad([p(-1.0, -1.0, 1.0), p(-1.0, 1.0, 1.0), p(1.0, 1.0, 1.0), p(1.0, -1.0, 1.0)]);
        quad([p(-1.0, -1.0, -1.0), p(-1.0, 1.0, -1.0), p(-1.0, 1.0, 1.0), p(-1.0, -1.0, 1.0)]);
        quad([p(1.0, -1.0, -1.0), p(1.0, -1.0, 1.0), p(1.0, 1.0, 1.0), p(1.0, 1.0, -1.0)]);
        quad([p(-1.0, -1.0, -1.0), p(-1.0, -1.0, 1.0), p(1.0, -1.0, 1.0), p(1.0, -1.0, -1.0)]);
        quad([p(-1.0, 1.0, -1.0), p(1.0, 1.0, -1.0), p(1.0, 1.0, 1.0), p(-1.0, 1.0, 1.0)]);
        let steps = 4 * WAVES;
        let floor = |i: usize, j: usize| {
            let [x, y] = [i, j].map(|k| 2.0 * k as f64 / steps as f64 - 1.0);
            p(x, y, HEIGHT * ((0.2 * WAVES as f64 * x).sin() * (0.3 * WAVES as f64 * y).cos()) - 0.9)
        };
        for (i, j) in (0..steps).flat_map(|i| (0..steps).map(move |j| (i, j))) {
            quad([floor(i, j), floor(i + 1, j), floor(i + 1, j + 1), floor(i, j + 1)]);
        }
        Self { triangles }
    }

    fn layout(&self) -> Layout {
        let bounds = [DVec3::splat(-HALF), DVec3::splat(HALF)];
        let grid = Grid::new(bounds, bounds, RESOLUTION, DVec3::ZERO);
        Layout::new(grid, NormalClasses::Six, self).expect("nobody cancels")
    }

    /// Points on the walls and the floor, half of them on each, in no order.
    fn landings(&self, count: usize) -> Vec<Landing> {
        // Additive recurrences with the powers of 1/φ₃ (Roberts 2018): evenly spread and the same every time.
        let spread = |i: usize, ratio: f64| (0.5 + i as f64 * ratio).fract();
        let at = |i: usize| {
            let (pick, u, v) = (spread(i, 0.819_172_513), spread(i, 0.671_043_607), spread(i, 0.549_700_478));
            let flat = 10.0;
            let index = if pick < 0.5 {
                pick * 2.0 * flat
            } else {
                flat + (pick * 2.0 - 1.0) * (self.triangles.len() as f64 - flat)
            };
            let [a, b, c] = self.triangles[index as usize];
            let (u, v) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
            let p = a + (b - a) * u + (c - a) * v;
            Landing { p: p.as_vec3(), normal: (b - a).cross(c - a).normalize().as_vec3() }
        };
        (0..count).map(at).collect()
    }
}

impl Surroundings for Room {
    fn triangle_count(&self) -> usize {
        self.triangles.len()
    }

    fn triangle(&self, i: usize) -> SurfaceTriangle {
        let [a, b, c] = self.triangles[i];
        let normal = (b - a).cross(c - a).normalize_or_zero().as_vec3();
        SurfaceTriangle { corners: [a, b, c], normal, glossy: false }
    }

    fn openness(&self, points: &[SidePoint]) -> Vec<Openness> {
        vec![Openness { is_open: true, above: None }; points.len()]
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

fn deposit(accumulator: &Accumulator<'_>, landings: &[Landing]) {
    let flux = Rgb::splat(1.0 / PHOTONS as f32);
    let side = |normal| Side { normal, back: false };
    let mut waiting = Vec::with_capacity(TOGETHER);
    for landings in landings.chunks(TOGETHER) {
        waiting.clear();
        waiting.extend(landings.iter().map(|at| Deposit { set: 0, p: at.p, side: side(at.normal), flux }));
        accumulator.deposit_all(black_box(&waiting));
    }
}

fn filled<'a>(layout: &'a Layout, landings: &[Landing]) -> Accumulator<'a> {
    let accumulator = Accumulator::new(layout, 1.0, None);
    deposit(&accumulator, landings);
    accumulator
}

fn merged(accumulator: Accumulator<'_>, layout: &Layout, room: &Room) -> Pyramid {
    Pyramid::build(accumulator, layout, 16, room).expect("nobody cancels")
}

fn pyramid_build(criterion: &mut Criterion, room: &Room, layout: &Layout, landings: &[Landing]) {
    let mut group = criterion.benchmark_group("pyramid_build");
    group.sample_size(10);
    group.bench_function("layout", |bencher| bencher.iter(|| room.layout()));
    group.bench_function("merge", |bencher| {
        let full = || filled(layout, landings);
        bencher.iter_batched(full, |accumulator| merged(accumulator, layout, room), BatchSize::PerIteration);
    });
    group.finish();
}

fn photon_deposit(criterion: &mut Criterion, layout: &Layout, landings: &[Landing]) {
    let mut group = criterion.benchmark_group("photon_deposit");
    group.sample_size(10).throughput(Throughput::Elements(landings.len() as u64));
    let accumulator = Accumulator::new(layout, 1.0, None);
    group.bench_function("million", |bencher| bencher.iter(|| deposit(&accumulator, landings)));
    group.finish();
    assert_eq!(accumulator.lost(), 0, "every photon has a cell");
}

fn pyramid_lookup(criterion: &mut Criterion, pyramid: &Pyramid, landings: &[Landing]) {
    let mut group = criterion.benchmark_group("pyramid_lookup");
    group.throughput(Throughput::Elements(LOOKUPS as u64));
    for level in 0..pyramid.level_count() {
        group.bench_function(format!("level_{level}"), |bencher| {
            bencher.iter(|| {
                for landing in &landings[..LOOKUPS] {
                    black_box(pyramid.view(0).irradiance(
                        landing.p,
                        pyramid.class(Side { normal: landing.normal, back: false }),
                        level,
                    ));
                }
            });
        });
    }
    group.finish();
}

fn main() {
    let mut criterion = Criterion::default().configure_from_args();
    let room = Room::new();
    let (layout, landings) = (room.layout(), room.landings(PHOTONS));
    pyramid_build(&mut criterion, &room, &layout, &landings);
    photon_deposit(&mut criterion, &layout, &landings);
    pyramid_lookup(&mut criterion, &merged(filled(&layout, &landings), &layout, &room), &landings);
    criterion.final_summary();
}

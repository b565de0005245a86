//! Laws of the pyramid, asked of the pyramid alone: flux is the same on all levels, a constant field is that constant at
//! every level and place, the order of deposits does not matter.

use glam::{DQuat, DVec3, Vec3};
use rgp_renderer::color::Rgb;
use rgp_renderer::math::Side;
use rgp_renderer::pyramid::{
    Accumulator, Deposit, DirectionBins, Grid, Lanes, Layout, Leaving, NormalClasses, Openness, Pyramid,
    SidePoint, SurfaceTriangle, Surroundings,
};

/// All of a square sees all of it.
const UNMIXED: &str = "no cell is mixed";

/// Edge of a finest cell.
const CELL: f64 = 1.0 / 64.0;

/// The borders of finest cells lie this part of a cell from the world's origin.
const ANCHOR_OFFSET: f64 = 0.381_966;

/// Finest cells along the square. It begins and ends in the middle of a cell; on the two coarser levels its outer cells
/// are covered to ¾ and 3/8 of their width: no cell is so empty that its parent is read instead.
const CELLS: u64 = 27;

const SIDE: f64 = CELLS as f64 * CELL;

/// A square from the origin of scene space to (SIDE, SIDE, 0), turned about the origin.
struct Square {
    turned: DQuat,
    glossy: bool,
}

/// One whose light is not needed by direction.
const fn diffuse(turned: DQuat) -> Square {
    Square { turned, glossy: false }
}

impl Surroundings for Square {
    fn triangle_count(&self) -> usize {
        2
    }

    fn triangle(&self, i: usize) -> SurfaceTriangle {
        let p = |x: f64, y: f64| self.turned * DVec3::new(x, y, 0.0) * SIDE;
        let third = if i == 0 { [p(1.0, 0.0), p(1.0, 1.0)] } else { [p(1.0, 1.0), p(0.0, 1.0)] };
        let corners = [p(0.0, 0.0), third[0], third[1]];
        SurfaceTriangle { corners, normal: normal(corners), glossy: self.glossy }
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

/// Three levels over a square from the origin of scene space to (SIDE, SIDE, 0), turned about the origin.
fn front(normal: Vec3) -> Side {
    Side { normal, back: false }
}

fn landed(p: Vec3, normal: Vec3, flux: Rgb) -> Deposit {
    Deposit { set: 0, p, side: front(normal), flux }
}

fn normal([a, b, c]: [DVec3; 3]) -> Vec3 {
    (b - a).cross(c - a).normalize().as_vec3()
}

fn layout(turned: DQuat) -> Layout {
    layout_of(&diffuse(turned))
}

fn layout_of(square: &Square) -> Layout {
    let half = 16.0 * CELL;
    let center = square.turned * DVec3::new(0.5, 0.5, 0.0) * SIDE;
    let seen = [center - half, center + half];
    // The square's corner lies 2½ cells from the lowest corner of a coarsest cell.
    let world_origin = DVec3::splat(-(2.5 + ANCHOR_OFFSET) * CELL);
    let grid = Grid::new(seen, seen, 32, world_origin);
    assert_eq!(grid.levels.len(), 3);
    Layout::new(grid, NormalClasses::Six, square).expect("nobody cancels")
}

/// Photon `i` of `n`², evenly over the square.
fn position(i: u64, n: u64) -> DVec3 {
    let at = |k: u64| (k as f64 + 0.5) / n as f64 * SIDE;
    DVec3::new(at(i % n), at(i / n), 0.0)
}

/// The pyramid of an even irradiance on the square's upper side, `n`² photons.
fn constant_field(layout: &Layout, turned: DQuat, irradiance: f64, n: u64, photons_per_cell: u32) -> Pyramid {
    let accumulator = Accumulator::new(layout, 1.0, None);
    let flux = Rgb::splat((irradiance * SIDE * SIDE / (n * n) as f64) as f32);
    for i in 0..n * n {
        let p = (turned * position(i, n)).as_vec3();
        assert!(
            accumulator.deposit(&landed(p, (turned * DVec3::Z).as_vec3(), flux)).is_some(),
            "{p} has no cell"
        );
    }
    Pyramid::build(accumulator, layout, photons_per_cell, &diffuse(turned)).expect("nobody cancels")
}

/// Irradiance of the level's cells times the part of the square in them, summed; the square is not turned.
fn flux_of_level(pyramid: &Pyramid, layout: &Layout, level: usize) -> f64 {
    let (cells, grid) = (&layout.levels[level], &layout.grid.levels[level]);
    let fluxes = cells.keys.iter().map(|key| {
        let (cell, class) = key.cell(grid);
        let low =
            grid.lattice(cell).as_dvec3() * f64::from(grid.cell_size) - layout.grid.offset_f64(DVec3::ZERO);
        let middle = low + 0.5 * f64::from(grid.cell_size);
        let inside = (low + f64::from(grid.cell_size)).min(DVec3::splat(SIDE)) - low.max(DVec3::ZERO);
        let irradiance = pyramid.view(0).irradiance(middle.as_vec3(), class, level).expect(UNMIXED);
        f64::from(irradiance.0[0]) * inside.x * inside.y
    });
    fluxes.sum()
}

/// Also where few photons make cells be read from their parents: all children of a cell are, or none. A rule on a cell's
/// own count would read the lucky ones themselves and the unlucky ones from their parents, and brighten the picture.
#[test]
fn flux_is_the_same_on_every_level() {
    let layout = layout(DQuat::IDENTITY);
    for photons in [300_u64, 3_000, 12_000, 40_000] {
        let accumulator = Accumulator::new(&layout, 1.0, None);
        let (mut state, mut total) = (photons, 0.0);
        let mut random = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 53) as f64
        };
        for _ in 0..photons {
            let p = DVec3::new(random() * SIDE, random() * SIDE, 0.0);
            let flux = random().powi(8) as f32 / photons as f32;
            total += f64::from(flux);
            accumulator.deposit(&landed(p.as_vec3(), Vec3::Z, Rgb::splat(flux)));
        }
        assert_eq!((accumulator.deposited(), accumulator.lost()), (photons, 0));
        let pyramid =
            Pyramid::build(accumulator, &layout, 16, &diffuse(DQuat::IDENTITY)).expect("nobody cancels");
        for level in 0..3 {
            let flux = flux_of_level(&pyramid, &layout, level);
            assert!((flux / total - 1.0).abs() < 1e-6, "{photons} photons, level {level}: {flux} of {total}");
        }
    }
}

#[test]
fn a_constant_field_is_that_constant_at_every_level_and_place() {
    let layout = layout(DQuat::IDENTITY);
    // Six by six photons in each finest cell, so that three by six lie in those half covered.
    for photons_per_cell in [1, 16, 1000] {
        let pyramid = constant_field(&layout, DQuat::IDENTITY, 5.0, 6 * CELLS, photons_per_cell);
        for level in 0..3 {
            for i in 0..101 * 101 {
                let p = position(i, 101).as_vec3();
                let found = pyramid.view(0).irradiance(p, pyramid.class(front(Vec3::Z)), level);
                let found = found.expect(UNMIXED).0[1];
                assert!((found / 5.0 - 1.0).abs() < 1e-5, "level {level}, {p}: {found}");
                let behind = pyramid.view(0).irradiance(
                    p,
                    pyramid.class(Side { normal: Vec3::NEG_Z, back: true }),
                    level,
                );
                assert!(behind.expect(UNMIXED).is_black(), "light behind the square: {behind:?}");
            }
        }
    }
}

/// A slanted square leaves pieces of every size in the cells. Pieces below a tenth of a face are read from coarser cells;
/// others hold n ≥ 40 of an even set of 400 photons per face, 4 and 16 times as many on the coarser levels, which counts
/// their area to better than 1 / √n. The cell's face instead of the true area would be wrong by tens of per cent.
#[test]
fn a_constant_field_on_a_slanted_surface() {
    let turned = DQuat::from_euler(glam::EulerRot::XYZ, 0.5, 0.3, 0.7);
    let layout = layout(turned);
    let normal = (turned * DVec3::Z).as_vec3();
    let pyramid = constant_field(&layout, turned, 5.0, 20 * CELLS, 16);
    for (level, photons) in [(0, 640.0_f32), (1, 160.0), (2, 40.0)] {
        let (n, mut sum) = (101, 0.0);
        for i in 0..n * n {
            let p = (turned * position(i, n)).as_vec3();
            let found = pyramid.view(0).irradiance(p, pyramid.class(front(normal)), level);
            let error = found.expect(UNMIXED).0[1] / 5.0 - 1.0;
            assert!(error.abs() < photons.sqrt().recip(), "level {level}, {p}: {error}");
            sum += f64::from(error);
        }
        let mean = sum / (n * n) as f64;
        assert!(mean.abs() < 1e-3, "level {level}: the mean is off by {mean}");
    }
}

/// Sends the same towards every direction.
struct Even(f32);

impl Leaving for Even {
    fn towards(&self, directions: &Lanes) -> Lanes {
        directions.map(|axis| axis.map(|_| self.0))
    }
}

/// Bins too are those of the coarser cells where photons are few: even light is as bright in every bin, whichever cells
/// hold enough to be read.
#[test]
fn even_light_is_even_in_every_bin() {
    let square = Square { turned: DQuat::IDENTITY, glossy: true };
    let (layout, bins) = (layout_of(&square), DirectionBins { elevation: 4, azimuth: 8 });
    let n = 4 * CELLS;
    let flux = (SIDE * SIDE / (n * n) as f64) as f32;
    for photons_per_cell in [1, 20, 1000] {
        let accumulator = Accumulator::new(&layout, 1.0, Some(bins));
        for i in 0..n * n {
            let photon = landed(position(i, n).as_vec3(), Vec3::Z, Rgb::splat(flux));
            let landing = accumulator.deposit(&photon).expect("it has a cell");
            accumulator.deposit_glossy(landing, [0.5, 0.5], &Even(5.0 * flux));
        }
        let pyramid =
            Pyramid::build(accumulator, &layout, photons_per_cell, &square).expect("nobody cancels");
        for level in 0..3 {
            for i in 0..53 * 53 {
                let direction = bins.direction(i as usize % bins.count(), [0.5, 0.5]);
                let (p, class) = (position(i, 53).as_vec3(), pyramid.class(front(Vec3::Z)));
                let found = pyramid.view(0).glossy_radiance(p, class, level, direction, [0.0; 2]).0[1];
                assert!((found / 5.0 - 1.0).abs() < 1e-3, "{photons_per_cell}, level {level}, {p}: {found}");
            }
        }
    }
}

#[test]
fn the_order_of_deposits_does_not_matter() {
    let layout = layout(DQuat::IDENTITY);
    let n = 100;
    let flux = |i: u64| Rgb([1e-6, 1e-3, 1.0].map(|size| size * ((i * 7919 % 1000) as f32).powi(4)));
    let build = |order: &mut dyn Iterator<Item = u64>| {
        let accumulator = Accumulator::new(&layout, 1e16, None);
        for i in order {
            accumulator.deposit(&landed(position(i, n).as_vec3(), Vec3::Z, flux(i)));
        }
        Pyramid::build(accumulator, &layout, 16, &diffuse(DQuat::IDENTITY)).expect("nobody cancels")
    };
    let (up, down) = (build(&mut (0..n * n)), build(&mut (0..n * n).rev()));
    for level in 0..3 {
        for i in 0..n * n {
            let p = position(i, n).as_vec3();
            let [a, b] = [&up, &down]
                .map(|pyramid| pyramid.view(0).irradiance(p, pyramid.class(front(Vec3::Z)), level));
            assert_eq!(a, b, "level {level}, {p}");
        }
    }
}

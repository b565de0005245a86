//! Photons carry the flux of their lights, and light a plane as direct sampling does.

mod light_support;

use std::f32::consts::PI;

use glam::Vec3;
use light_support::{
    Random, asked, assert_close, irradiance, lamp, object, scene, turned, vector_math, with_nodes,
};
use rgp_renderer::color::Rgb;
use rgp_renderer::light::Lights;
use rgp_renderer::scene::{Lamp, LampShape, Object};
use rgp_renderer::shader::{Quantity, VectorFunction};

const POWER: f32 = 10.0;
const BINS: usize = 8;

/// One lamp of each kind over the plane z = −0.3, tilted where that changes anything.
fn lamps() -> Vec<Lamp> {
    let place = Vec3::new(0.05, -0.1, 0.1);
    let point = |radius, soft_falloff| LampShape::Point { radius, soft_falloff };
    let spot = |radius, soft_falloff, blend| LampShape::Spot { radius, soft_falloff, cone_angle: 1.4, blend };
    let size = [0.4, 0.2];
    let shapes = [
        point(0.0, false),
        point(0.25, false),
        point(0.25, true),
        spot(0.0, false, 0.0),
        spot(0.0, false, 1.0),
        spot(0.15, false, 0.5),
        spot(0.15, true, 0.5),
        LampShape::Sun { angle: 0.0 },
        LampShape::Sun { angle: 0.6 },
        LampShape::Rectangle { size, spread: PI },
        LampShape::Rectangle { size, spread: 1.5 },
        LampShape::Rectangle { size, spread: 0.2 },
        LampShape::Ellipse { size, spread: PI },
        LampShape::Ellipse { size, spread: 2.5 },
        LampShape::Rectangle { size, spread: 0.0 },
    ];
    let round = shapes.into_iter().map(|shape| lamp(shape, POWER, place));
    let stretched = [
        (spot(0.0, false, 0.0), [1.0, 2.0]),
        (spot(0.15, false, 0.5), [0.7, 1.4]),
        (spot(0.15, true, 1.0), [2.0, 1.0]),
    ];
    let stretched = stretched.map(|(shape, stretch)| Lamp { stretch, ..lamp(shape, POWER, place) });
    round.chain(stretched).map(turned).collect()
}

/// Solid angle of a spot's elliptic cone (sr), weighted by its blend: a sum over the plane at distance 1, on which the
/// unscaled cone is a disk.
fn elliptic_solid_angle(cone_angle: f32, blend: f32, [x, y]: [f32; 2]) -> f64 {
    let [angle, blend, x, y] = [cone_angle, blend, x, y].map(f64::from);
    let (steps, rim, edge) = (1000, (0.5 * angle).tan(), (0.5 * angle).cos());
    let mut sum = 0.0;
    for i in 0..steps * steps {
        let mid = |i: u32| (f64::from(i) + 0.5) / f64::from(steps);
        let radius = rim * mid(i % steps);
        let (sin, cos) = (std::f64::consts::TAU * mid(i / steps)).sin_cos();
        let inside = ((1.0 + radius * radius).sqrt().recip() - edge) / (1.0 - edge);
        let t = if inside < blend { inside / blend } else { 1.0 };
        let distance_squared = 1.0 + radius * radius * ((x * cos).powi(2) + (y * sin).powi(2));
        sum += t * t * (3.0 - 2.0 * t) * x * y * radius / distance_squared.powf(1.5);
    }
    sum * rim * std::f64::consts::TAU / f64::from(steps * steps)
}

/// A tetrahedron whose faces emit differently.
fn emissive() -> (Object, Vec<Rgb>) {
    let corners =
        [[0.2, 0.0, 0.0], [-0.1, 0.15, 0.0], [-0.1, -0.15, 0.05], [0.0, 0.0, 0.25]].map(Vec3::from_array);
    let triangles = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
    let emission = [Rgb([3.0, 1.0, 0.0]), Rgb([1.0, 0.0, 9.0]), Rgb([7.0, 0.5, 0.0]), Rgb::BLACK];
    (object(&corners, &triangles, vec![0, 1, 2, 3], None), emission.to_vec())
}

#[test]
fn mean_of_the_photons_is_the_total_flux() {
    for lamp in lamps() {
        let lights = Lights::build(&scene(vec![lamp.clone()], Vec::new(), 0.0), &[]);
        let photon = lights.emit([0.3, 0.1, 0.6, 0.8, 0.2]).unwrap();
        if lamp.stretch == [1.0, 1.0] {
            assert_close(f64::from(photon.flux.0[1]), f64::from(lights.total_flux().0[1]), 1e-6);
        }
        let expected = match lamp.shape {
            LampShape::Spot { cone_angle, blend, .. } => {
                let solid_angle = elliptic_solid_angle(cone_angle, blend, lamp.stretch);
                POWER / (4.0 * PI) * solid_angle as f32
            }
            // E over the disk that covers the unit cube, for every direction of the sun.
            LampShape::Sun { angle } => POWER * PI * 0.75 * 2.0 / (1.0 + (0.5 * angle).cos()),
            _ => POWER,
        };
        assert_close(f64::from(lights.total_flux().0[0]), f64::from(expected), 1e-3);
    }
}

#[test]
fn mean_of_mixed_photons_is_the_total_flux() {
    let (object, emission) = emissive();
    let mut lamps = lamps();
    for (index, lamp) in lamps.iter_mut().enumerate() {
        lamp.power = Rgb([index as f32, 3.0, 0.1]);
    }
    let lights = Lights::build(&scene(lamps, vec![object], 0.5), &emission);
    let mut random = Random(1);
    let (count, mut sums, mut squares) = (200_000, [0.0_f64; 3], [0.0_f64; 3]);
    for _ in 0..count {
        let flux = lights.emit(random.uniforms()).unwrap().flux;
        for c in 0..3 {
            sums[c] += f64::from(flux.0[c]);
            squares[c] += f64::from(flux.0[c]).powi(2);
        }
    }
    for c in 0..3 {
        let mean = sums[c] / f64::from(count);
        let sigma = ((squares[c] / f64::from(count) - mean * mean) / f64::from(count)).sqrt();
        let expected = f64::from(lights.total_flux().0[c]);
        assert!((mean - expected).abs() < 4.0 * sigma, "channel {c}: {mean} ± {sigma}, not {expected}");
    }
}

/// What photons bring to a cell: how many, their flux and its standard deviation.
#[derive(Clone, Copy, Default)]
struct Cell {
    photons: u32,
    flux: f64,
    sigma: f64,
}

/// The cells of the square of side 0.8 on the plane z = −0.3, lit from above.
fn cells_on_plane(lights: &Lights, count: u32) -> Vec<Cell> {
    let mut random = Random(7);
    let mut cells = vec![Cell::default(); BINS * BINS];
    for _ in 0..count {
        let photon = lights.emit(random.uniforms()).expect("the lights emit");
        let distance = (-0.3 - photon.origin.z) / photon.direction.z;
        if photon.direction.z >= 0.0 || distance < photon.lit_from.max(0.0) {
            continue;
        }
        let place = (photon.origin + photon.direction * distance).truncate() / 0.8 + 0.5;
        if place.min_element() >= 0.0 && place.max_element() < 1.0 {
            let place = (place * BINS as f32).as_uvec2();
            let cell = &mut cells[place.y as usize * BINS + place.x as usize];
            let p = photon.origin + photon.direction * distance;
            let arrived = lights.arrived(photon.flux, photon.shaded, photon.direction, p);
            if arrived.0[0] == 0.0 {
                continue;
            }
            let flux = f64::from(arrived.0[0]) / f64::from(count);
            cell.photons += 1;
            cell.flux += flux;
            cell.sigma = cell.sigma.hypot(flux);
        }
    }
    cells
}

/// Flux through a cell from `sample_direct`, at `parts`² points of it.
fn direct_flux(lights: &Lights, cell: usize, parts: usize, choices: usize, steps: usize) -> f64 {
    let side = 0.8 / BINS as f32;
    let mid = |cell: usize, part: usize| side * (cell as f32 + (part as f32 + 0.5) / parts as f32) - 0.4;
    let mut sum = 0.0;
    for part in 0..parts * parts {
        let p = Vec3::new(mid(cell % BINS, part % parts), mid(cell / BINS, part / parts), -0.3);
        sum += irradiance(lights, p, Vec3::Z, choices, steps);
    }
    sum * f64::from(side * side) / (parts * parts) as f64
}

#[track_caller]
fn assert_photons_match(lights: &Lights, name: &str, parts: usize, choices: usize, steps: usize) {
    let count = 400_000;
    let (mut lit, mut chi_squared) = (0.0_f64, 0.0);
    for (index, cell) in cells_on_plane(lights, count).into_iter().enumerate() {
        let expected = direct_flux(lights, index, parts, choices, steps);
        if cell.photons < 25 {
            // Too few to know their own noise: the light must be as faint.
            assert!(expected < 60.0 * f64::from(lights.total_flux().0[0]) / f64::from(count));
            continue;
        }
        let error = (cell.flux - expected) / cell.sigma;
        assert!(error.abs() < 4.5, "{name}, cell {index}: {} ± {}, not {expected}", cell.flux, cell.sigma);
        lit += 1.0;
        chi_squared += error * error;
    }
    assert!(lit > 3.0, "{name}: {lit} cells are lit");
    assert!(chi_squared < lit + 4.0 * (2.0 * lit).sqrt(), "{name}: χ² {chi_squared} for {lit} cells");
}

/// Nodes that ask for the place on the lamp, its normal and how far it is seen from: (UV + N²) times the distance.
fn uneven(lamp: Lamp) -> Lamp {
    let instructions = vec![
        asked(Quantity::Parametric),
        asked(Quantity::Normal),
        vector_math(VectorFunction::Multiply, 1, 1),
        vector_math(VectorFunction::Add, 0, 2),
        asked(Quantity::RayLength),
        vector_math(VectorFunction::Multiply, 3, 4),
    ];
    let infinitely_far = matches!(lamp.shape, LampShape::Sun { .. });
    with_nodes(lamp, if infinitely_far { instructions[..4].to_vec() } else { instructions })
}

#[test]
fn photons_light_a_plane_as_direct_sampling_does() {
    for lamp in lamps().into_iter().chain(lamps().into_iter().map(uneven)) {
        let name = format!("{:?}, nodes: {}", lamp.shape, lamp.program.is_some());
        let lights = Lights::build(&scene(vec![lamp], Vec::new(), 0.0), &[]);
        let is_delta = lights.sample_direct(Vec3::new(0.0, 0.0, -0.2), [0.5; 3]).is_none_or(|s| s.is_delta);
        // Edges of what has no extent are sharp on the plane.
        let (parts, steps) = if is_delta { (64, 1) } else { (12, 10) };
        assert_photons_match(&lights, &name, parts, 1, steps);
    }
}

#[test]
fn emissive_meshes_light_a_plane_as_direct_sampling_does() {
    let (object, emission) = emissive();
    let lights = Lights::build(&scene(Vec::new(), vec![object], 0.0), &emission);
    assert_photons_match(&lights, "mesh", 10, 32, 6);
}

#[test]
fn soft_lamps_light_near_planes_less() {
    // A plane at distance h below a soft lamp of radius r: at its foot I / (h² + r²), where a sphere gives I / h².
    let soft = lamp(LampShape::Point { radius: 0.3, soft_falloff: true }, POWER, Vec3::ZERO);
    let lights = Lights::build(&scene(vec![soft], Vec::new(), 0.0), &[]);
    let mut random = Random(3);
    let (count, radius) = (2_000_000_u32, 0.05);
    let mut hits = 0.0;
    for _ in 0..count {
        let photon = lights.emit(random.uniforms()).unwrap();
        let distance = (-0.3 - photon.origin.z) / photon.direction.z;
        let place = photon.origin + photon.direction * distance;
        if photon.direction.z < 0.0 && distance >= photon.lit_from && place.truncate().length() < radius {
            hits += 1.0;
        }
    }
    let expected = f64::from(POWER / (4.0 * PI) / 0.18 * PI * radius * radius);
    let flux = hits * f64::from(POWER) / f64::from(count);
    assert!((flux / expected - 1.0).abs() < 4.0 / hits.sqrt() + 0.02, "{flux}, not {expected}");
}

#[test]
fn world_photons_bring_pi_times_radiance_to_both_sides() {
    let lights = Lights::build(&scene(Vec::new(), Vec::new(), 2.0), &[]);
    assert!(!lights.is_empty());
    assert!(lights.sample_direct(Vec3::ZERO, [0.5; 3]).is_none());
    // Flux: π L over the surface of the ball around the unit cube.
    assert_close(f64::from(lights.total_flux().0[0]), f64::from(PI * 2.0 * 4.0 * PI * 0.75), 1e-3);
    let normal = Vec3::new(0.36, 0.48, 0.8);
    let center = Vec3::new(0.2, -0.3, 0.1);
    let (mut random, count, mut sides) = (Random(5), 400_000, [0.0_f64; 2]);
    for _ in 0..count {
        let photon = lights.emit(random.uniforms()).unwrap();
        let cos = photon.direction.dot(normal);
        let distance = (center - photon.origin).dot(normal) / cos;
        if distance > 0.0 && (photon.origin + photon.direction * distance - center).length() < 0.2 {
            sides[usize::from(cos > 0.0)] += 1.0;
        }
    }
    for hits in sides {
        let flux = hits * f64::from(lights.total_flux().0[0]) / f64::from(count);
        let expected = f64::from(PI * 2.0 * PI * 0.04);
        assert!((flux / expected - 1.0).abs() < 4.0 / hits.sqrt(), "{flux}, not {expected}");
    }
}

#[test]
fn photons_leave_surfaces_on_the_side_of_their_normal() {
    let (object, emission) = emissive();
    let lamp = turned(lamp(LampShape::Rectangle { size: [0.4, 0.2], spread: PI }, POWER, Vec3::ZERO));
    let lights = Lights::build(&scene(vec![lamp], vec![object], 0.0), &emission);
    let mut random = Random(11);
    for _ in 0..10_000 {
        let photon = lights.emit(random.uniforms()).unwrap();
        assert!(photon.direction.dot(photon.normal.unwrap()) >= 0.0);
        assert!((photon.direction.length() - 1.0).abs() < 1e-5);
        assert_eq!(photon.lit_from, 0.0);
    }
}

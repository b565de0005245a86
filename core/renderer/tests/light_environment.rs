//! Worlds whose light differs from direction to direction: what is sampled, what rays see and what photons bring are one
//! and the same.

mod light_support;

use std::f32::consts::{PI, TAU};

use glam::Vec3;
use light_support::{KIND, Random, assert_close, lamp, scene};
use rgp_renderer::color::Rgb;
use rgp_renderer::light::Lights;
use rgp_renderer::scene::{Lamp, LampShape, Scene, WorldProgram, visibility};
use rgp_renderer::shader::{
    Aside, Encoding, Extension, Instruction, Interpolation, Pixels, Program, Projection, Quantity, Texture,
};

const COLUMNS: usize = 32;
const ROWS: usize = 16;

/// A scene without objects in a panorama of `COLUMNS` × `ROWS` texels.
fn panorama(lamps: Vec<Lamp>, interpolation: Interpolation, texel: impl Fn(usize, usize) -> f32) -> Scene {
    let mut scene = scene(lamps, Vec::new(), 0.0);
    let texels: Vec<[f32; 4]> = (0..COLUMNS * ROWS)
        .map(|i| texel(i % COLUMNS, i / COLUMNS))
        .map(|radiance| [radiance, 0.5 * radiance, 0.25 * radiance, 1.0])
        .collect();
    let texture = Texture::new([COLUMNS, ROWS], Pixels::Floats(texels), Encoding::Linear)
        .expect("as many texels as it says");
    scene.textures = vec![texture].into();
    let instructions = vec![
        Instruction::Geometry { quantity: Quantity::Position, aside: Aside::HERE },
        Instruction::Panorama { vector: 0, projection: Projection::Equirectangular },
        Instruction::Image {
            texture: 0,
            vector: 1,
            extension: Extension::Repeat,
            interpolation,
            unassociate: false,
        },
    ];
    let program = Program::new(instructions, 1).expect("operands before their use");
    scene.world.program = Some(WorldProgram { program, radiance: 2 });
    scene
}

/// A smooth sky with a bright spot.
fn sky(column: usize, row: usize) -> f32 {
    let smooth = 1.0 + (row as f32 / ROWS as f32) + 0.5 * (TAU * column as f32 / COLUMNS as f32).cos();
    if (column, row) == (5, 11) { 300.0 } else { smooth }
}

fn spotted_sky() -> Lights {
    Lights::build(&panorama(Vec::new(), Interpolation::Linear, sky), &[])
}

/// Directions on an even grid over the sphere, all of the same solid angle.
fn directions(rows: usize) -> impl Iterator<Item = Vec3> {
    let columns = 2 * rows;
    (0..rows * columns).map(move |i| {
        let (x, y) =
            (((i % columns) as f32 + 0.5) / columns as f32, ((i / columns) as f32 + 0.5) / rows as f32);
        let (z, angle) = (2.0 * y - 1.0, TAU * x);
        let radius = (1.0 - z * z).sqrt();
        Vec3::new(radius * angle.cos(), radius * angle.sin(), z)
    })
}

#[test]
fn the_pdf_integrates_to_one() {
    let lights = spotted_sky();
    let rows = 1024;
    let sum: f64 = directions(rows).map(|wi| f64::from(lights.world_seen(Vec3::ZERO, wi, KIND).1)).sum();
    assert_close(sum * f64::from(4.0 * PI) / (2 * rows * rows) as f64, 1.0, 2e-3);
}

/// χ² over cells of equal solid angle.
#[test]
fn sampled_directions_are_spread_as_the_pdf_says() {
    let lights = spotted_sky();
    let (rows, columns, count) = (12, 24, 200_000);
    let cell = |wi: Vec3| {
        let turn = wi.y.atan2(wi.x) / TAU + 0.5;
        let (row, column) = ((0.5 * (wi.z + 1.0) * rows as f32) as usize, (turn * columns as f32) as usize);
        row.min(rows - 1) * columns + column.min(columns - 1)
    };
    let mut expected = vec![0.0_f64; rows * columns];
    let fine = 768;
    for wi in directions(fine) {
        let pdf = f64::from(lights.world_seen(Vec3::ZERO, wi, KIND).1);
        expected[cell(wi)] += pdf * f64::from(4.0 * PI) / (2 * fine * fine) as f64 * f64::from(count);
    }
    let mut found = vec![0.0_f64; rows * columns];
    let mut random = Random(7);
    for _ in 0..count {
        let sample = lights.sample_direct(Vec3::ZERO, random.uniforms()).unwrap();
        let (radiance, pdf) = lights.world_seen(Vec3::ZERO, sample.wi, KIND);
        assert_close(f64::from(sample.pdf_solid_angle), f64::from(pdf), 1e-5);
        assert_close(f64::from(sample.radiance_over_pdf.0[0]), f64::from(radiance.0[0] / pdf), 1e-4);
        found[cell(sample.wi)] += 1.0;
    }
    let chi: f64 = found.iter().zip(&expected).map(|(f, e)| (f - e).powi(2) / e).sum();
    let freedom = (rows * columns - 1) as f64;
    assert!(chi < freedom + 5.0 * (2.0 * freedom).sqrt(), "χ² is {chi} at {freedom} degrees of freedom");
}

/// Where the radiance is sampled by its own brightness, one sample is almost as good as many.
#[test]
fn samples_weigh_much_the_same() {
    let lights = spotted_sky();
    let mut random = Random(3);
    let (mut sum, mut squares, count) = (0.0, 0.0, 50_000.0);
    for _ in 0..50_000 {
        let sample = lights.sample_direct(Vec3::ZERO, random.uniforms()).unwrap();
        let radiance = f64::from(sample.radiance_over_pdf.0[0]);
        sum += radiance;
        squares += radiance * radiance;
    }
    let mean: f64 = sum / count;
    let relative = (squares / count / (mean * mean) - 1.0).sqrt();
    assert!(relative < 0.4, "a sample is off by {relative}");
    // The integral over all directions, by the grid.
    let rows = 1024;
    let integral: f64 =
        directions(rows).map(|wi| f64::from(lights.world_seen(Vec3::ZERO, wi, KIND).0.0[0])).sum();
    assert_close(mean, integral * f64::from(4.0 * PI) / (2 * rows * rows) as f64, 0.01);
}

/// Irradiance at the origin on a surface of this normal, and its red share.
fn irradiance(lights: &Lights, normal: Vec3) -> f64 {
    let (mut random, count, mut sum) = (Random(1), 100_000, 0.0);
    for _ in 0..count {
        if let Some(sample) = lights.sample_direct(Vec3::ZERO, random.uniforms()) {
            sum += f64::from(sample.radiance_over_pdf.0[0]) * f64::from(sample.wi.dot(normal).max(0.0));
        }
    }
    sum / f64::from(count)
}

#[test]
fn a_bright_texel_is_a_sun_lamp_of_the_same_irradiance() {
    let spot =
        panorama(
            Vec::new(),
            Interpolation::Closest,
            |column, row| {
                if (column, row) == (20, 12) { 1000.0 } else { 0.0 }
            },
        );
    // From texel 20 of 32: u = 0.625 to 0.65625; from row 12 of 16: latitudes of 45° to 56.25°.
    let (u, latitude) = (20.5 / 32.0, (45.0 + 5.625_f32).to_radians());
    let longitude = TAU * (0.5 - u);
    let towards =
        Vec3::new(latitude.cos() * longitude.cos(), latitude.cos() * longitude.sin(), latitude.sin());
    let (low, high) = (45_f64.to_radians(), 56.25_f64.to_radians());
    let width = f64::from(TAU) / 32.0;
    // ∫ cos of the angle to its middle over the texel.
    let along = |from: f64, to: f64| (to - from) / 2.0 + ((2.0 * to).sin() - (2.0 * from).sin()) / 4.0;
    let flat = 2.0 * (0.5 * width).sin() * along(low, high) * f64::from(latitude.cos());
    let up = width * 0.5 * (high.sin().powi(2) - low.sin().powi(2)) * f64::from(latitude.sin());
    let expected = 1000.0 * (flat + up);
    let lights = Lights::build(&spot, &[]);
    assert_close(irradiance(&lights, towards), expected, 0.005);
    // A lamp of that irradiance, shining along -Z in its own space.
    let mut sun = lamp(LampShape::Sun { angle: 0.0 }, expected as f32, Vec3::ZERO);
    sun.axis = -towards;
    let sun = Lights::build(&scene(vec![sun], Vec::new(), 0.0), &[]);
    for normal in [Vec3::Z, towards, Vec3::new(0.6, 0.0, 0.8)] {
        assert_close(irradiance(&lights, normal), irradiance(&sun, normal), 0.01);
    }
    // Photons bring the same: the mean of flux over the disk's area, weighted by the cosine.
    assert_close(f64::from(lights.total_flux().0[0] / sun.total_flux().0[0]), 1.0, 0.01);
}

#[test]
fn photons_carry_the_integral_over_the_disk() {
    let lights = spotted_sky();
    let disk = PI * 0.75;
    let rows = 512;
    let integral: f64 =
        directions(rows).map(|wi| f64::from(lights.world_seen(Vec3::ZERO, wi, KIND).0.0[0])).sum();
    let expected = integral * f64::from(4.0 * PI) / (2 * rows * rows) as f64 * f64::from(disk);
    assert_close(f64::from(lights.total_flux().0[0]), expected, 0.005);
    let (mut random, count, mut sum, mut upward) = (Random(9), 100_000, 0.0, 0.0);
    for _ in 0..count {
        let photon = lights.emit(random.uniforms()).unwrap();
        assert!((photon.direction.length() - 1.0).abs() < 1e-5);
        sum += f64::from(photon.flux.0[0]);
        upward += f64::from(photon.flux.0[0]) * f64::from((-photon.direction.z).max(0.0));
    }
    assert_close(sum / f64::from(count), expected, 0.01);
    assert_close(upward / f64::from(count) / f64::from(disk), irradiance(&lights, Vec3::Z), 0.01);
}

#[test]
fn lamps_and_world_are_sampled_side_by_side() {
    let lamps = || vec![lamp(LampShape::Sun { angle: 0.2 }, 3.0, Vec3::ZERO)];
    let both = Lights::build(&panorama(lamps(), Interpolation::Linear, sky), &[]);
    let alone = Lights::build(&scene(lamps(), Vec::new(), 0.0), &[]);
    let sum = irradiance(&spotted_sky(), Vec3::Z) + irradiance(&alone, Vec3::Z);
    assert_close(irradiance(&both, Vec3::Z), sum, 0.01);
    // A ray that meets both learns of each how likely it was.
    let mut pdf = both.world_seen(Vec3::ZERO, Vec3::Z, KIND).1;
    both.suns(Vec3::ZERO, Vec3::Z, KIND, &mut |_, of_sun| pdf += of_sun);
    let sample = (0..1000).map(|i| both.sample_direct(Vec3::ZERO, [i as f32 / 1000.0, 0.0, 0.5]).unwrap());
    let of_sun = sample.filter(|sample| (sample.wi - Vec3::Z).length() < 1e-3).map(|s| s.pdf_solid_angle);
    assert!(of_sun.into_iter().any(|found| found > 0.0 && found < pdf));
}

#[test]
fn only_rays_that_see_the_world_find_it() {
    let mut scene = panorama(Vec::new(), Interpolation::Linear, sky);
    scene.world.visibility = visibility::CAMERA | visibility::GLOSSY;
    let lights = Lights::build(&scene, &[]);
    assert_eq!(lights.world_seen(Vec3::ZERO, Vec3::Z, visibility::DIFFUSE).0, Rgb::BLACK);
    assert!(!lights.world_seen(Vec3::ZERO, Vec3::Z, visibility::CAMERA).0.is_black());
    let sample = lights.sample_direct(Vec3::ZERO, [0.5; 3]).unwrap();
    assert_eq!(sample.visibility, visibility::GLOSSY);
    assert_eq!(lights.emit([0.5; 5]).unwrap().visibility, scene.world.visibility);
    scene.world.visibility = visibility::CAMERA;
    let lights = Lights::build(&scene, &[]);
    assert!(lights.sample_direct(Vec3::ZERO, [0.5; 3]).is_none() && lights.emit([0.5; 5]).is_none());
}

#[test]
fn worlds_that_are_black_for_diffuse_surfaces_shine_for_those_who_see_them() {
    for (quantity, seen, unseen) in [
        (Quantity::IsCamera, visibility::CAMERA, visibility::GLOSSY),
        (Quantity::IsGlossy, visibility::TRANSMISSION, visibility::CAMERA),
        (Quantity::IsReflection, visibility::GLOSSY, visibility::TRANSMISSION),
    ] {
        let mut scene = scene(Vec::new(), Vec::new(), 0.0);
        let instructions = vec![Instruction::Geometry { quantity, aside: Aside::HERE }];
        let program = Program::new(instructions, 0).expect("no operands");
        scene.world.program = Some(WorldProgram { program, radiance: 0 });
        scene.world.visibility = visibility::ALL;
        let lights = Lights::build(&scene, &[]);
        assert_eq!(lights.world_seen(Vec3::ZERO, Vec3::Z, seen).0, Rgb::WHITE, "{quantity:?}");
        assert_eq!(lights.world_seen(Vec3::ZERO, Vec3::Z, unseen).0, Rgb::BLACK, "{quantity:?}");
    }
}

#[test]
fn hostile_panoramas() {
    let black = Lights::build(&panorama(Vec::new(), Interpolation::Linear, |_, _| 0.0), &[]);
    assert!(black.is_empty() && black.world_bytes() == 0);
    let negative = Lights::build(&panorama(Vec::new(), Interpolation::Linear, |_, _| -3.0), &[]);
    assert!(negative.is_empty());
    for bad in [f32::NAN, f32::INFINITY, f32::MAX, -5.0] {
        let texel = |column, row| if (column, row) == (3, 4) { bad } else { 1.0 };
        let lights = Lights::build(&panorama(Vec::new(), Interpolation::Linear, texel), &[]);
        let mut random = Random(2);
        for _ in 0..2000 {
            let sample = lights.sample_direct(Vec3::ZERO, random.uniforms()).unwrap();
            assert!(sample.radiance_over_pdf.is_finite() && sample.pdf_solid_angle > 0.0, "{bad}");
            assert!(lights.emit(random.uniforms()).unwrap().flux.is_finite(), "{bad}");
        }
        assert!(lights.total_flux().is_finite());
    }
}

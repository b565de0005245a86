//! Furnaces: where light comes alike from everywhere, the answer is one number, in corners too.
//!
//! Closed scene, every surface emitting Le with albedo ρ: L = Le + ρ L, so L = Le / (1 − ρ). Open scene of albedo 1 in a
//! uniform world L0: L = L0, it cannot be seen.

mod support;

use glam::{DVec3, Vec3};
use rgp_renderer::color::Rgb;
use rgp_renderer::scene::record::{ClosureRecord, MaterialRecord};
use rgp_renderer::scene::{MeshArrays, SceneBuilder};
use support::*;

const PHOTONS: u64 = 400_000;
const RESOLUTION: u32 = 32;
const RAYS: u32 = 64;
const PIXELS: u32 = 24;

/// The radiance of every pixel inside `mesh`, seen from `from` in the direction of `at`.
fn inside(mesh: MeshArrays, material: MaterialRecord, from: DVec3, at: DVec3, half_width: f64) -> Vec<f64> {
    let mut builder = SceneBuilder::default();
    place(&mut builder, mesh, &[material]);
    builder.set_camera(camera(from, at, half_width, PIXELS));
    pixels(builder)
}

fn pixels(builder: SceneBuilder) -> Vec<f64> {
    finish_and_render(builder, &settings(PHOTONS, RESOLUTION, RAYS)).radiance()
}

fn closed_box() -> MeshArrays {
    cuboid(Vec3::new(-1.0, -0.7, 0.0), Vec3::new(1.0, 0.7, 1.2))
}

/// The mean, then the root mean square over pixels, in which the noise of single cells is.
fn assert_uniform(pixels: &[f64], exact: f64, mean_tolerance: f64, pixel_tolerance: f64) {
    let (mean, rms) = (mean(pixels) / exact - 1.0, spread(pixels, exact));
    let report = format!("mean {:+.3} %, rms {:.3} % of {exact}", 100.0 * mean, 100.0 * rms);
    assert!(mean.abs() < mean_tolerance && rms < pixel_tolerance, "{report}");
}

#[test]
fn box_of_albedo_one_half() {
    let from = DVec3::new(-0.8, -0.5, 0.2);
    let pixels = inside(closed_box(), emitter(0.5, 1.0), from, DVec3::new(1.0, 0.6, 0.6), 1.5);
    assert_uniform(&pixels, 2.0, 0.003, 0.01);
}

#[test]
fn box_of_albedo_nine_tenths() {
    let from = DVec3::new(-0.8, -0.5, 0.2);
    let pixels = inside(closed_box(), emitter(0.9, 1.0), from, DVec3::new(1.0, 0.6, 0.6), 1.5);
    assert_uniform(&pixels, 10.0, 0.005, 0.015);
}

#[test]
fn corner_of_a_box() {
    // About ±0.1 m round the corner, some finest cells.
    let (from, corner) = (DVec3::new(-0.2, 0.0, 0.4), DVec3::new(1.0, 0.7, 1.2));
    for albedo in [0.5, 0.9] {
        let pixels = inside(closed_box(), emitter(albedo, 1.0), from, corner, 0.06);
        assert_uniform(&pixels, 1.0 / (1.0 - f64::from(albedo)), 0.01, 0.02);
    }
}

#[test]
fn sphere_of_albedo_one_half_and_nine_tenths() {
    for albedo in [0.5, 0.9] {
        let ball = sphere(4, 1.0, Vec3::ZERO);
        let from = DVec3::new(-0.5, 0.1, 0.2);
        let pixels = inside(ball, emitter(albedo, 1.0), from, DVec3::X, 1.5);
        assert_uniform(&pixels, 1.0 / (1.0 - f64::from(albedo)), 0.005, 0.015);
    }
}

/// ρ = ρ diffuse + ρ mirror: what is followed and what is read from the pyramid are a partition.
#[test]
fn box_of_half_mirrors() {
    let closures = [
        ClosureRecord::Diffuse { color: Rgb::splat(0.4), roughness: 0.0 },
        ClosureRecord::Glossy {
            color: Rgb::splat(0.3),
            roughness: 0.0,
            anisotropy: 0.0,
            rotation: 0.0,
            multiscatter: true,
        },
        ClosureRecord::Emission { radiance: Rgb::WHITE },
    ];
    let mut builder = SceneBuilder::default();
    place(&mut builder, closed_box(), &[material(&closures)]);
    builder.set_camera(camera(DVec3::new(-0.8, -0.5, 0.2), DVec3::new(1.0, 0.6, 0.6), 1.5, PIXELS));
    // Four times the rays: those off mirrors are followed by single paths, which are noisier.
    let picture = finish_and_render(builder, &settings(PHOTONS, RESOLUTION, 4 * RAYS));
    assert_uniform(&picture.radiance(), 1.0 / 0.3, 0.006, 0.03);
}

/// A convex body sees nothing but the world: L = ρ L0 without any noise; of albedo 1 it cannot be seen.
#[test]
fn convex_body_in_a_uniform_world() {
    for albedo in [1.0_f32, 0.5] {
        let mut builder = SceneBuilder::default();
        place(&mut builder, sphere(3, 1.0, Vec3::ZERO), &[diffuse(albedo)]);
        builder.set_world(world(0.7));
        builder.set_camera(camera(DVec3::new(0.0, -4.0, 1.0), DVec3::ZERO, 0.1, PIXELS));
        for pixel in pixels(builder) {
            assert_close(pixel, 0.7 * f64::from(albedo), 1e-5);
        }
    }
}

/// An edge through pixels that have more camera samples than gather rays: rays come from all parts of a pixel.
#[test]
fn edge_in_a_uniform_world() {
    const WIDTH: u32 = 64;
    let half_floor = |x: [f32; 2]| {
        quad(
            [(0, -9.0), (1, -9.0), (1, 9.0), (0, 9.0)]
                .map(|(side, y): (usize, f32)| Vec3::new(x[side], y, 0.0)),
        )
    };
    // The picture is two metres wide; three tenths of a column of pixels are black.
    let edge = 2.0 / WIDTH as f32 * 0.3;
    let mut builder = SceneBuilder::default();
    place(&mut builder, half_floor([-9.0, edge]), &[diffuse(0.0)]);
    place(&mut builder, half_floor([edge, 9.0]), &[diffuse(1.0)]);
    builder.set_world(world(0.5));
    builder.set_camera(parallel_camera(DVec3::new(0.0, 0.0, 3.0), DVec3::ZERO, 1.0, WIDTH));
    let scene = builder.finish().expect("a scene with a camera");
    for (rays, samples) in [(1, 64), (4, 256), (16, 64), (64, 64)] {
        let mut settings = settings(PHOTONS, RESOLUTION, rays);
        settings.gather.camera_samples = samples;
        let picture = render(&scene, &settings).radiance();
        let column: Vec<f64> = picture.chunks(WIDTH as usize).map(|row| row[WIDTH as usize / 2]).collect();
        // Of independent rays the mean has a standard error of 0.08 / √rays.
        assert_close(mean(&column), 0.5 * 0.7, 0.25 / f64::from(rays).sqrt());
    }
}

/// A box without a lid, of albedo 1, seen from above with its surroundings.
#[test]
fn hollow_body_of_albedo_one_cannot_be_seen() {
    let mut builder = SceneBuilder::default();
    for corners in walls(Vec3::splat(-0.5), Vec3::splat(0.5)).into_iter().take(5) {
        place(&mut builder, quad(corners), &[diffuse(1.0)]);
    }
    builder.set_world(world(0.7));
    builder.set_camera(camera(DVec3::new(0.3, -0.4, 2.0), DVec3::ZERO, 0.4, PIXELS));
    // Ten times the photons: few of those that the world sends meet so small a body, and the mean is to be known well.
    let picture = finish_and_render(builder, &settings(10 * PHOTONS, RESOLUTION, RAYS));
    assert_uniform(&picture.radiance(), 0.7, 0.005, 0.02);
}

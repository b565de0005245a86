//! Caustics that the eye sees: closed forms, the same light as paths find, and less noise than they have.

mod support;

use glam::{DVec3, Vec3};
use rgp_renderer::color::Rgb;
use rgp_renderer::scene::record::{ClosureRecord, MaterialRecord};
use rgp_renderer::scene::{LampShape, Scene, SceneBuilder};
use rgp_renderer::settings::{EstimatorKind, RenderSettings, Switch};
use support::*;

fn glass() -> MaterialRecord {
    material(&[ClosureRecord::Glass { color: Rgb::WHITE, roughness: 0.0, ior: 1.5, multiscatter: true }])
}

/// Only caustics, and the lamps that mirrors and glass show.
fn caustics_alone(photons: u64) -> RenderSettings {
    let mut settings = settings(1000, 16, 64);
    // The edges of caustics are fine.
    settings.gather.camera_samples = 64;
    settings.photon_pass.caustic_count = photons;
    settings.effects.direct_light = Switch::Off;
    settings.effects.indirect_diffuse = Switch::Off;
    settings.effects.indirect_glossy = Switch::Off;
    settings
}

/// The caustics of every pixel, without the lamps that mirrors and glass show.
fn caustics(scene: &Scene, settings: &RenderSettings) -> Vec<f64> {
    let mut off = settings.clone();
    off.effects.caustics = Switch::Off;
    let (all, rest) = (render(scene, settings).radiance(), render(scene, &off).radiance());
    all.iter().zip(&rest).map(|(all, rest)| all - rest).collect()
}

/// Parallel light of one watt to the square meter from above.
fn sun(builder: &mut SceneBuilder) {
    builder.add_lamp(lamp(LampShape::Sun { angle: 0.0 }, 1.0, DVec3::ZERO));
}

/// A pane lets (1 − R) / (1 + R) through: R at either face, back and forth inside without end.
#[test]
fn sunlight_through_a_pane() {
    let mut builder = SceneBuilder::default();
    place(&mut builder, floor(1.0, 0.0), &[diffuse(0.6)]);
    place(&mut builder, cuboid(Vec3::new(-1.0, -1.0, 1.0), Vec3::new(1.0, 1.0, 1.02)), &[glass()]);
    sun(&mut builder);
    builder.set_camera(camera(DVec3::new(0.0, -0.8, 0.7), DVec3::new(0.0, 0.1, 0.0), 0.3, 12));
    let picture = finish_and_render(builder, &caustics_alone(200_000));
    let reflected = (0.5_f64 / 2.5).powi(2);
    let expected = 0.6 / std::f64::consts::PI * (1.0 - reflected) / (1.0 + reflected);
    assert_close(mean(&picture.radiance()), expected, 0.01);
    assert!(spread(&picture.radiance(), expected) < 0.1);
}

/// A mirror at 45 degrees turns sunlight onto a wall: all of it, and none beyond the mirror's edge.
#[test]
fn sunlight_off_a_mirror() {
    let p = |x: f32, y: f32, z: f32| Vec3::new(x, y, z);
    let wall = [p(0.0, -1.0, 0.0), p(0.0, 1.0, 0.0), p(0.0, 1.0, 2.0), p(0.0, -1.0, 2.0)];
    let mirror = [p(1.0, -0.3, 0.7), p(1.6, -0.3, 1.3), p(1.6, 0.3, 1.3), p(1.0, 0.3, 0.7)];
    let seen = |y: f64| {
        let mut builder = SceneBuilder::default();
        place(&mut builder, quad(wall), &[diffuse(0.5)]);
        place(&mut builder, quad(mirror), &[glossy(0.8, 0.0)]);
        sun(&mut builder);
        builder.set_camera(parallel_camera(DVec3::new(0.9, y, 1.0), DVec3::new(0.0, y, 1.0), 0.15, 12));
        mean(&finish_and_render(builder, &caustics_alone(200_000)).radiance())
    };
    assert_close(seen(0.0), 0.8 * 0.5 / std::f64::consts::PI, 0.01);
    assert!(seen(0.6) < 1e-4);
}

/// A ball of some material over a floor, in a black room `size` meters wide with a lamp of some radius above. The camera sees
/// nothing but the floor, on the side of the ball that looks away from the lamp.
fn ball(radius: f32, size: f32, material: MaterialRecord) -> Scene {
    let mut builder = SceneBuilder::default();
    place(&mut builder, floor(size / 2.0, 0.0), &[diffuse(0.5)]);
    place(&mut builder, sphere(5, 0.3, Vec3::new(0.0, 0.0, 0.32)), &[material]);
    let high = Vec3::new(0.5 * size, 0.5 * size, 1.0 + 0.5 * size);
    place(&mut builder, cuboid(Vec3::new(-0.5 * size, -0.5 * size, -0.1), high), &[diffuse(0.0)]);
    let shape = LampShape::Point { radius, soft_falloff: false };
    builder.add_lamp(lamp(shape, 40.0, DVec3::new(0.4, 0.5, 1.4)));
    let (from, at) = (DVec3::new(-0.3, -0.75, 0.35), DVec3::new(-0.12, -0.2, 0.0));
    builder.set_camera(camera(from, at, 0.14, 24));
    builder.finish().expect("a scene with a camera")
}

/// A varnished tile under a metal of some roughness that shows it a lamp: what is read and what is followed meet at the eye's vertex.
fn varnished_tile(roughness: f32) -> Scene {
    let mut builder = SceneBuilder::default();
    let varnish = material(&[
        ClosureRecord::Diffuse { color: Rgb::splat(0.4), roughness: 0.0 },
        ClosureRecord::Glossy {
            color: Rgb::splat(0.3),
            roughness: 0.45,
            anisotropy: 0.0,
            rotation: 0.0,
            multiscatter: true,
        },
    ]);
    place(&mut builder, floor(0.2, 0.0), &[varnish]);
    place(&mut builder, floor(1.0, 1.0), &[glossy(0.9, roughness)]);
    place(&mut builder, cuboid(Vec3::new(-1.5, -1.5, -0.1), Vec3::splat(1.5)), &[diffuse(0.0)]);
    let shape = LampShape::Point { radius: 0.15, soft_falloff: false };
    builder.add_lamp(lamp(shape, 40.0, DVec3::new(0.6, 0.0, 0.4)));
    builder.set_camera(camera(DVec3::new(-0.3, 0.0, 0.8), DVec3::ZERO, 0.15, 12));
    builder.finish().expect("a scene with a camera")
}

/// The same light as paths bring that meet the lamp by chance.
#[test]
fn as_bright_as_paths() {
    for scene in [ball(0.15, 3.0, glass()), varnished_tile(0.0), varnished_tile(0.3)] {
        let mut by_photons = caustics_alone(1_000_000);
        by_photons.gather.rays = 2048;
        let map = mean(&caustics(&scene, &by_photons));
        let mut by_paths = by_photons;
        by_paths.gather.estimator = EstimatorKind::Path;
        let paths = mean(&caustics(&scene, &by_paths));
        assert_close(map, paths, 0.02);
    }
}

/// How much pictures with different seeds differ, in parts of their mean.
fn noise(scene: &Scene, settings: &RenderSettings) -> f64 {
    let pictures = [1, 2].map(|seed| {
        let mut settings = settings.clone();
        settings.render.seed = seed;
        caustics(scene, &settings)
    });
    let [a, b] = &pictures;
    let squares: Vec<f64> = a.iter().zip(b).map(|(a, b)| 0.5 * (a - b).powi(2)).collect();
    mean(&squares).sqrt() / mean(a)
}

/// Of a small lamp, rays find sparks.
#[test]
fn less_noise_than_rays() {
    let scene = ball(0.02, 3.0, glass());
    let map = noise(&scene, &caustics_alone(300_000));
    let mut rays = caustics_alone(0);
    rays.gather.estimator = EstimatorKind::Path;
    rays.gather.rays = 1024;
    let rays = noise(&scene, &rays);
    assert!(map < 0.1 && rays > 10.0 * map, "{map}, of rays {rays}");
}

/// Photons find a small glass in a large room.
#[test]
fn a_larger_room_has_no_more_noise() {
    let [near, far] = [3.0, 30.0].map(|size| {
        let scene = ball(0.0, size, glass());
        let stored = render(&scene, &caustics_alone(100_000)).stats.photons.caustic;
        (noise(&scene, &caustics_alone(100_000)), stored as f64)
    });
    assert!(far.0 < 1.2 * near.0 && far.1 > 0.9 * near.1, "{near:?}, ten times as large {far:?}");
}

/// No photon for caustics where no light, no surface or no user asks for them.
#[test]
fn nothing_is_traced_for_nothing() {
    let mut wide = SceneBuilder::default();
    place(&mut wide, floor(1.0, 0.0), &[diffuse(0.5)]);
    place(&mut wide, sphere(3, 0.3, Vec3::new(0.0, 0.0, 0.4)), &[glass()]);
    wide.set_world(world(1.0));
    wide.set_camera(camera(DVec3::new(0.0, -1.4, 0.9), DVec3::ZERO, 0.5, 8));
    let wide = wide.finish().expect("a scene with a camera");
    let matte = ball(0.0, 3.0, diffuse(0.5));
    let mut off = caustics_alone(10_000);
    off.effects.caustics = Switch::Off;
    let cases =
        [(&wide, caustics_alone(10_000)), (&matte, caustics_alone(10_000)), (&ball(0.0, 3.0, glass()), off)];
    for (scene, settings) in cases {
        let stats = render(scene, &settings).stats;
        assert_eq!((stats.photons.caustic, stats.rays.photon), (0, 0));
    }
}

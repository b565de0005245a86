//! Light that solids absorb on its way through them (Beer and Lambert), against closed forms.

mod support;

use std::f64::consts::PI;

use glam::{DVec3, Vec3};
use rgp_renderer::color::Rgb;
use rgp_renderer::scene::record::{ClosureRecord, MaterialRecord};
use rgp_renderer::scene::{LampShape, SceneBuilder};
use rgp_renderer::settings::{EstimatorKind, RenderSettings, Switch};
use support::*;

/// What lets all light through, and absorbs it with so much per meter.
fn clear(absorption: Rgb) -> MaterialRecord {
    MaterialRecord { absorption, ..material(&[ClosureRecord::Transparent { color: Rgb::WHITE }]) }
}

fn glass(absorption: f32) -> MaterialRecord {
    let glass = ClosureRecord::Glass { color: Rgb::WHITE, roughness: 0.0, ior: 1.5, multiscatter: true };
    MaterialRecord { absorption: Rgb::splat(absorption), ..material(&[glass]) }
}

/// One face of glass of index 1.5, seen straight on.
const REFLECTED: f64 = 0.04;

/// A slab that stands upright between the camera and the world. Of two, no faces lie on each other.
fn slab(low_x: f32, high_x: f32) -> rgp_renderer::scene::MeshArrays {
    cuboid(Vec3::new(low_x, -2.0, -2.0), Vec3::new(high_x, 2.0, 2.0 + high_x))
}

fn look_along_x(builder: &mut SceneBuilder, from: f64) {
    builder.set_camera(parallel_camera(DVec3::new(from, 0.1, 0.2), DVec3::new(from + 1.0, 0.1, 0.2), 0.3, 8));
}

/// Mean of each channel.
fn channels(picture: &Picture) -> [f64; 3] {
    let pixels = picture.combined.len() / 4;
    [0, 1, 2].map(|c| picture.combined.chunks(4).map(|p| f64::from(p[c])).sum::<f64>() / pixels as f64)
}

fn assert_channels(picture: &Picture, expected: impl Fn(usize) -> f64, tolerance: f64) {
    for (channel, found) in channels(picture).into_iter().enumerate() {
        assert_close(found, expected(channel), tolerance);
    }
}

/// exp(−σ d), channel by channel, of two slabs that overlap, of what the camera is in, and of what holds no light back.
#[test]
fn clear_slabs_before_an_even_world() {
    let absorptions = [Rgb([0.1, 1.0, 3.0]), Rgb([0.7, 0.0, 0.2])];
    for (camera, lengths) in [(-5.0, [1.5, 1.0]), (0.5, [1.0, 1.0]), (1.25, [0.25, 0.75]), (3.0, [0.0, 0.0])]
    {
        let mut builder = SceneBuilder::default();
        place(&mut builder, slab(0.0, 1.5), &[clear(absorptions[0])]);
        place(&mut builder, slab(1.0, 2.0), &[clear(absorptions[1])]);
        builder.set_world(world(0.8));
        look_along_x(&mut builder, camera);
        let picture = finish_and_render(builder, &settings(100, 8, 4));
        let exponent = |c: usize| (0..2).map(|i| f64::from(absorptions[i].0[c]) * lengths[i]).sum::<f64>();
        assert_channels(&picture, |c| 0.8 * (-exponent(c)).exp(), 1e-4);
    }
}

/// A pane of glass in an even world: what is reflected, and what comes through after any number of turns inside.
#[test]
fn a_pane_before_an_even_world() {
    let mut builder = SceneBuilder::default();
    place(&mut builder, slab(0.0, 0.5), &[glass(2.0)]);
    builder.set_world(world(1.0));
    look_along_x(&mut builder, -3.0);
    let mut settings = settings(100, 8, 64);
    settings.gather.camera_samples = 256;
    let left = (-1.0_f64).exp();
    let expected = REFLECTED + (1.0 - REFLECTED).powi(2) * left / (1.0 - REFLECTED * left);
    assert_close(mean(&finish_and_render(builder, &settings).radiance()), expected, 0.02);
}

fn sun(builder: &mut SceneBuilder) {
    builder.add_lamp(lamp(LampShape::Sun { angle: 0.0 }, 1.0, DVec3::ZERO));
}

/// A floor under a slab that the sun shines through: shadow rays where it is clear, photons where it is glass.
#[test]
fn sunlight_through_slabs() {
    let left = (-0.6_f64).exp();
    let through_glass = (1.0 - REFLECTED).powi(2) * left / (1.0 - (REFLECTED * left).powi(2));
    for (material, share) in [(clear(Rgb::splat(3.0)), left), (glass(3.0), through_glass)] {
        let mut builder = SceneBuilder::default();
        place(&mut builder, floor(1.0, 0.0), &[diffuse(0.6)]);
        place(&mut builder, cuboid(Vec3::new(-1.0, -1.0, 1.0), Vec3::new(1.0, 1.0, 1.2)), &[material]);
        sun(&mut builder);
        builder.set_camera(camera(DVec3::new(0.0, -0.8, 0.7), DVec3::new(0.0, 0.1, 0.0), 0.3, 12));
        let mut settings = settings(1000, 16, 64);
        settings.gather.camera_samples = 64;
        settings.photon_pass.caustic_count = 200_000;
        settings.effects.indirect_diffuse = Switch::Off;
        let picture = finish_and_render(builder, &settings);
        assert_close(mean(&picture.radiance()), 0.6 / PI * share, 0.01);
    }
}

/// A lamp in the middle of a ball of haze, above a floor: shadow rays end in what absorbs.
#[test]
fn a_lamp_in_haze() {
    let brightness = |absorption: f32| {
        let mut builder = SceneBuilder::default();
        place(&mut builder, floor(2.0, 0.0), &[diffuse(0.6)]);
        place(&mut builder, sphere(5, 0.5, Vec3::Z), &[clear(Rgb::splat(absorption))]);
        builder.add_lamp(point_lamp(10.0, DVec3::Z));
        builder.set_camera(camera(DVec3::new(0.0, -1.0, 0.3), DVec3::ZERO, 0.2, 8));
        let mut settings = settings(1000, 16, 4);
        settings.effects.indirect_diffuse = Switch::Off;
        mean(&finish_and_render(builder, &settings).radiance())
    };
    assert_close(brightness(2.0) / brightness(0.0), (-1.0_f64).exp(), 2e-3);
}

/// Of light that leaves a wall of a sphere by Lambert's law, the share that arrives at the wall again; `thickness` is the
/// diameter times the absorption: ∫ exp(−thickness · cos) 2 cos dcos.
fn arrives(thickness: f64) -> f64 {
    2.0 * (1.0 - (1.0 + thickness) * (-thickness).exp()) / thickness.powi(2)
}

const RADIUS: f32 = 1.0;
const ALBEDO: f32 = 0.8;
const ABSORPTION: f32 = 0.7;

/// From the middle of a ball that is full of what absorbs light.
fn full_ball(wall: MaterialRecord) -> SceneBuilder {
    let mut builder = SceneBuilder::default();
    let wall = MaterialRecord { absorption: Rgb::splat(ABSORPTION), ..wall };
    place(&mut builder, sphere(5, RADIUS, Vec3::ZERO), &[wall]);
    builder.set_camera(camera(DVec3::ZERO, DVec3::new(0.9, 0.3, 0.2), 0.5, 12));
    builder
}

fn by_photons_and_by_paths(rays: u32) -> [RenderSettings; 2] {
    [EstimatorKind::Pyramid, EstimatorKind::Path].map(|estimator| {
        let mut settings = settings(400_000, 16, rays);
        settings.gather.estimator = estimator;
        settings
    })
}

/// Walls that shine: L / (1 − ρ T) exp(−σ r), T what arrives of the light between them.
#[test]
fn a_full_ball_that_shines() {
    let (sigma, radius) = (f64::from(ABSORPTION), f64::from(RADIUS));
    let left = (-sigma * radius).exp();
    let expected = left / (1.0 - f64::from(ALBEDO) * arrives(2.0 * sigma * radius));
    for settings in by_photons_and_by_paths(256) {
        let picture = finish_and_render(full_ball(emitter(ALBEDO, 1.0)), &settings);
        assert_close(mean(&picture.radiance()), expected, 0.01);
    }
}

/// A lamp in the middle, which shadow rays find and rays from the walls meet: its light and that of the walls.
#[test]
fn a_full_ball_with_a_lamp_in_it() {
    let (sigma, radius, albedo) = (f64::from(ABSORPTION), f64::from(RADIUS), f64::from(ALBEDO));
    for size in [0.0, 0.1_f32] {
        // Light of a ball starts before its middle: by two thirds of its radius in the mean.
        let way = radius - 2.0 / 3.0 * f64::from(size);
        let direct = albedo / PI * 10.0 / (4.0 * PI * radius.powi(2)) * (-sigma * way).exp();
        let left = (-sigma * radius).exp();
        let expected = direct / (1.0 - albedo * arrives(2.0 * sigma * radius)) * left;
        for settings in by_photons_and_by_paths(256) {
            let mut builder = full_ball(diffuse(ALBEDO));
            let shape = LampShape::Point { radius: size, soft_falloff: false };
            builder.add_lamp(lamp(shape, 10.0, DVec3::ZERO));
            assert_close(mean(&finish_and_render(builder, &settings).radiance()), expected, 0.01);
        }
    }
}

/// Light of a ball that hangs in a medium, seen and sampled: BSDF samples and light samples are weighed against each other
/// as if nothing were absorbed, and both lose the same.
#[test]
fn a_lamp_that_rays_meet_is_as_bright_as_one_that_they_do_not() {
    let brightness = |rays: u32, light_samples: u32| {
        let mut builder = full_ball(diffuse(0.5));
        let shape = LampShape::Point { radius: 0.4, soft_falloff: false };
        builder.add_lamp(lamp(shape, 10.0, DVec3::new(0.45, 0.0, 0.0)));
        let mut settings = settings(1000, 16, rays);
        settings.gather.light_samples = light_samples;
        settings.effects.indirect_diffuse = Switch::Off;
        mean(&finish_and_render(builder, &settings).radiance())
    };
    assert_close(brightness(2048, 1), brightness(4, 64), 0.01);
}

/// Off makes solids clear; what is not there costs nothing and is not called for.
#[test]
fn off_makes_clear() {
    let picture = |absorption: f32, switch: Switch| {
        let mut builder = SceneBuilder::default();
        place(&mut builder, slab(0.0, 1.0), &[clear(Rgb::splat(absorption))]);
        builder.set_world(world(1.0));
        look_along_x(&mut builder, -3.0);
        let mut settings = settings(100, 8, 4);
        settings.effects.absorption = switch;
        let picture = finish_and_render(builder, &settings);
        let effect = picture.stats.effects.iter().find(|effect| effect.name == "absorption");
        let called_for = effect.expect("every effect is listed").called_for;
        (mean(&picture.radiance()), called_for)
    };
    assert_eq!(picture(1.0, Switch::Off), (1.0, true));
    assert_eq!(picture(0.0, Switch::On), (1.0, false));
    assert!(picture(1.0, Switch::Auto).0 < 0.4);
}

/// Values that are none are taken for none, the user is told, and nothing is lost.
#[test]
fn absorption_that_is_no_number() {
    for (absorption, expected) in [(f32::NAN, 1.0), (-1.0, 1.0), (f32::INFINITY, 1.0), (1e30, 0.0)] {
        let mut builder = SceneBuilder::default();
        place(&mut builder, slab(0.0, 1.0), &[clear(Rgb::splat(absorption))]);
        builder.set_world(world(1.0));
        look_along_x(&mut builder, -3.0);
        let picture = finish_and_render(builder, &settings(100, 8, 4));
        assert!((mean(&picture.radiance()) - expected).abs() < 1e-6, "{absorption}");
        assert!(!picture.stats.warnings.is_empty());
    }
}

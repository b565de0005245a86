//! Panoramas: what is seen from within a room whose light is known, and where the picture ends.

mod support;

use std::f64::consts::{FRAC_PI_2, PI};

use glam::{DVec3, Vec3};
use rgp_renderer::scene::record::{CameraRecord, WorldRecord};
use rgp_renderer::scene::{Projection, SceneBuilder};
use support::*;

const PIXELS: u32 = 40;
const RADIANCE: f32 = 2.0;

fn panorama(projection: Projection, window: [f64; 4]) -> CameraRecord {
    CameraRecord { projection, window, ..camera(DVec3::ZERO, -DVec3::Z, 1.0, PIXELS) }
}

fn render(place_things: impl FnOnce(&mut SceneBuilder), camera: CameraRecord) -> Picture {
    let mut builder = SceneBuilder::default();
    place_things(&mut builder);
    builder.set_world(WorldRecord { film_transparent: true, ..world(0.0) });
    builder.set_camera(camera);
    let mut settings = settings(1, 4, 1);
    settings.gather.camera_samples = 64;
    finish_and_render(builder, &settings)
}

fn bright_dome(builder: &mut SceneBuilder) {
    place(builder, sphere(4, 1.0, Vec3::ZERO), &[emitter(0.0, RADIANCE)]);
}

/// Of the square about the image circle a share of π / 4 shows the dome. The rest is black, and not transparent.
#[test]
fn fisheyes_show_a_circle() {
    let polynomial =
        Projection::FisheyePolynomial { field_of_view: PI, coefficients: [0.0, 0.5, 0.0, 0.0, 0.0] };
    let edge = 2.0_f64.sqrt();
    for (projection, half) in [
        (Projection::FisheyeEquidistant { field_of_view: PI }, FRAC_PI_2),
        (Projection::FisheyeEquisolid { field_of_view: PI }, edge),
        (polynomial, PI),
    ] {
        let picture = render(bright_dome, panorama(projection, [-half, half, -half, half]));
        let radiance = picture.radiance();
        let mean = radiance.iter().sum::<f64>() / f64::from(PIXELS * PIXELS);
        assert_close(mean, f64::from(RADIANCE) * PI / 4.0, 0.003);
        assert!(radiance[0] == 0.0 && picture.combined.iter().skip(3).step_by(4).all(|&alpha| alpha == 1.0));
        assert_close(radiance[(PIXELS * PIXELS / 2 + PIXELS / 2) as usize], f64::from(RADIANCE), 1e-5);
    }
}

/// A wall at distance 1 is as far away as 1 / cos of the angle: clip distances cut rings out of it.
#[test]
fn panoramas_are_clipped_by_distance() {
    let wall = |builder: &mut SceneBuilder| {
        place(builder, floor(40.0, -1.0), &[emitter(0.0, RADIANCE)]);
    };
    let projection = Projection::FisheyeEquidistant { field_of_view: 2.8 };
    let record = CameraRecord { clip: [1.2, 2.5], ..panorama(projection, [-1.4, 1.4, -1.4, 1.4]) };
    let mean = render(wall, record).radiance().iter().sum::<f64>() / f64::from(PIXELS * PIXELS);
    let [near, far] = [1.2_f64, 2.5].map(|distance| distance.recip().acos());
    let ring = PI * (far * far - near * near) / (2.8 * 2.8);
    assert_close(mean, f64::from(RADIANCE) * ring, 0.005);
}

/// A border is cut out of the same picture.
#[test]
fn a_border_crops_a_panorama() {
    let room = |region: [u32; 4]| {
        let mut builder = Room::default().builder();
        let inside = Room::default().camera();
        let window = [-PI, PI, -FRAC_PI_2, FRAC_PI_2];
        builder.set_camera(CameraRecord {
            projection: Projection::Equirectangular,
            window,
            resolution: [32, 16],
            region,
            ..inside
        });
        finish_and_render(builder, &settings(20_000, 16, 4)).combined
    };
    let (whole, part) = (room([0, 0, 32, 16]), room([12, 4, 8, 8]));
    for y in 0..8 {
        let row = (4 * ((4 + y) * 32 + 12)) as usize;
        let found = &part[(4 * 8 * y) as usize..][..32];
        assert_eq!(
            found.iter().map(|v| v.to_bits()).collect::<Vec<_>>(),
            whole[row..][..32].iter().map(|v| v.to_bits()).collect::<Vec<_>>()
        );
    }
    assert!(whole.iter().any(|&v| v > 0.0 && v != 1.0));
}

#[test]
fn what_is_no_camera_is_refused_by_name() {
    let nowhere = Projection::FisheyeEquidistant { field_of_view: 0.0 };
    let not_a_number =
        Projection::FisheyePolynomial { field_of_view: 1.0, coefficients: [0.0, f64::NAN, 0.0, 0.0, 0.0] };
    for (projection, window, says) in [
        (nowhere, [-1.0, 1.0, -1.0, 1.0], "'camera': its field of view is empty"),
        (not_a_number, [-1.0, 1.0, -1.0, 1.0], "'camera': its lens polynomial is not a number"),
        (Projection::Equirectangular, [1.0, 1.0, -1.0, 1.0], "'camera': its field of view is empty"),
        (Projection::Cylindrical, [-1.0, 1.0, -1.0, 1e30], "'camera': it is farther away, or sees farther"),
    ] {
        let mut builder = SceneBuilder::default();
        builder.set_camera(panorama(projection, window));
        let message = builder.finish().expect_err("no camera").to_string();
        assert!(message.contains(says), "{message}");
    }
}

//! The lens against closed forms: the image of a small bright square at depth z, with the plane of focus at depth f, is
//! the aperture scaled by 1/f − 1/z on the plane at distance 1, or by 1 − z/f where rays are parallel. Small parts of a
//! panorama are as that plane, wherever it looks.

mod support;

use std::f64::consts::FRAC_PI_2;

use glam::{DMat4, DVec2, DVec3, Vec3};
use rgp_renderer::scene::record::{CameraRecord, LensRecord};
use rgp_renderer::scene::{Projection, SceneBuilder};
use rgp_renderer::settings::{RenderSettings, Switch};
use support::*;

const DEPTH: f64 = 4.0;
const HALF: f64 = 0.03;
const RADIUS: f64 = 0.1;
const RADIANCE: f64 = 2.0;
const PIXELS: u32 = 48;

fn lens(focus_distance: f64) -> LensRecord {
    LensRecord { radius: RADIUS, blades: 0, rotation: 0.0, ratio: 1.0, focus_distance }
}

/// A camera with a lens before a small square that shines.
fn spot(projection: Projection, half_width: f64, lens: Option<LensRecord>) -> Picture {
    let mut builder = SceneBuilder::default();
    place(&mut builder, floor(HALF as f32, -DEPTH as f32), &[emitter(0.0, RADIANCE as f32)]);
    // Far off, so that scene space is not the square's own.
    place(&mut builder, floor(0.5, 3.0), &[diffuse(0.5)]);
    let mut record = camera(DVec3::ZERO, -DVec3::Z, half_width, PIXELS);
    if projection == Projection::Equirectangular {
        // The square is not ahead, but to the right.
        record.world_from_camera = rows(DMat4::from_rotation_y(FRAC_PI_2));
        record.window = [FRAC_PI_2 - half_width, FRAC_PI_2 + half_width, -half_width, half_width];
    }
    builder.set_camera(CameraRecord { projection, lens, ..record });
    finish_and_render(builder, &sharp_settings())
}

fn sharp_settings() -> RenderSettings {
    let mut settings = settings(1, 4, 1);
    settings.gather.camera_samples = 800;
    settings
}

/// Light in the picture times its area on the window, and the mean squares of its window's x and y.
fn moments(picture: &Picture, half_width: f64) -> (f64, DVec2) {
    let (mut sum, mut squares) = (0.0, DVec2::ZERO);
    let pixel = 2.0 * half_width / f64::from(PIXELS);
    for (index, light) in picture.radiance().into_iter().enumerate() {
        let at = DVec2::new((index as u32 % PIXELS).into(), (index as u32 / PIXELS).into());
        let at = (at + 0.5) * pixel - half_width;
        sum += light;
        squares += at * at * light;
    }
    (sum * pixel * pixel, squares / sum)
}

/// Radius of the image of the aperture, its mean squares against those of the pixel and the square itself, and its light.
#[track_caller]
fn check(projection: Projection, lens: LensRecord, expected: DVec2) {
    let (focus, blades) = (lens.focus_distance, lens.blades);
    let (scale, size) = match projection {
        Projection::Orthographic => ((1.0 - DEPTH / focus).abs(), HALF),
        _ => ((1.0 / focus - 1.0 / DEPTH).abs(), HALF / DEPTH),
    };
    let half_width = 1.6 * RADIUS / lens.ratio.min(1.0) * scale + 2.0 * size;
    let picture = spot(projection, half_width, Some(lens));
    let (light, squares) = moments(&picture, half_width);
    let pixel = 2.0 * half_width / f64::from(PIXELS);
    let blur = squares - (pixel * pixel / 12.0 + size * size / 3.0);
    let exact = expected * (RADIUS * scale).powi(2);
    assert!(((blur / exact) - 1.0).abs().max_element() < 0.02, "{projection:?} {blades}: {}", blur / exact);
    assert_close(light, RADIANCE * (2.0 * size).powi(2), 0.01);
}

/// A disk of radius 1 has ¼ as its mean x²; a regular polygon (2 + cos 2π/n) / 12.
#[test]
fn the_circle_of_confusion_is_that_of_a_thin_lens() {
    for focus in [2.0, 7.0] {
        for projection in [Projection::Perspective, Projection::Orthographic, Projection::Equirectangular] {
            check(projection, lens(focus), DVec2::splat(0.25));
        }
    }
}

#[test]
fn blades_and_ratio_shape_the_blur() {
    let polygon = |n: f64| DVec2::splat((2.0 + (std::f64::consts::TAU / n).cos()) / 12.0);
    for blades in [3, 6] {
        let lens = LensRecord { blades, rotation: 0.4, ..lens(2.0) };
        check(Projection::Perspective, lens, polygon(blades.into()));
    }
    let wide = LensRecord { ratio: 0.5, ..lens(2.0) };
    for projection in [Projection::Perspective, Projection::Equirectangular] {
        check(projection, wide.clone(), DVec2::new(1.0, 0.25));
    }
}

/// What lies in the plane of focus is as sharp as without lens. For a panorama that is a sphere, and the edges of the square
/// beside it take a few samples.
#[test]
fn the_plane_of_focus_is_sharp() {
    for projection in [Projection::Perspective, Projection::Orthographic, Projection::Equirectangular] {
        let half_width = 2.0 * HALF / if projection == Projection::Orthographic { 1.0 } else { DEPTH };
        let sharp = spot(projection, half_width, None).radiance();
        let focused = spot(projection, half_width, Some(lens(DEPTH))).radiance();
        for (sharp, focused) in sharp.into_iter().zip(focused) {
            assert!((sharp - focused).abs() < 4e-3 * RADIANCE, "{focused} is not {sharp}");
        }
    }
}

/// A lens that is switched off, or has no aperture, is a pinhole to the last bit.
#[test]
fn off_is_a_pinhole() {
    let room = |lens: Option<LensRecord>, switch: Switch| {
        let mut builder = Room::default().builder();
        builder.set_camera(CameraRecord { lens, ..Room::default().camera() });
        let mut settings = settings(20_000, 16, 16);
        settings.effects.depth_of_field = switch;
        let picture = finish_and_render(builder, &settings);
        picture.combined.iter().map(|v| v.to_bits()).collect::<Vec<_>>()
    };
    let pinhole = room(None, Switch::Auto);
    assert_eq!(pinhole, room(Some(lens(1.0)), Switch::Off));
    assert_eq!(pinhole, room(Some(LensRecord { radius: 0.0, ..lens(1.0) }), Switch::On));
    assert_ne!(pinhole, room(Some(lens(1.0)), Switch::Auto));
}

/// Blur spreads light and loses none: an even wall looks even, whatever the lens.
#[test]
fn an_even_dome_stays_even() {
    let mut builder = SceneBuilder::default();
    place(&mut builder, sphere(4, 1.0, Vec3::ZERO), &[emitter(0.0, RADIANCE as f32)]);
    builder.set_camera(CameraRecord { lens: Some(lens(0.3)), ..camera(DVec3::ZERO, DVec3::X, 1.5, 16) });
    let mut settings = settings(1, 4, 1);
    settings.gather.camera_samples = 16;
    for radiance in finish_and_render(builder, &settings).radiance() {
        assert_close(radiance, RADIANCE, 1e-5);
    }
}

//! Photons of suns and the world are aimed where most would miss what the picture looks at, and the light stays the same.

mod support;

use glam::{DMat4, DVec3, Vec3};
use rgp_renderer::color::Rgb;
use rgp_renderer::scene::{LampShape, Scene, SceneBuilder};
use rgp_renderer::settings::{RenderSettings, Switch};
use support::*;

/// A room of two meters with a hole in its ceiling, on ground `half_width` meters to each side, lit by the sun and a sky of
/// radiance `sky`.
fn room(half_width: f32, sky: f32) -> Scene {
    let mut builder = SceneBuilder::default();
    let [low, high] = [Vec3::new(-1.0, -1.0, 0.0), Vec3::new(1.0, 1.0, 2.0)];
    for wall in walls(low, high).into_iter().take(5) {
        place(&mut builder, quad(wall), &[diffuse(0.7)]);
    }
    // The ceiling, but for a hole of 40 cm.
    let at = |x: f32, y: f32| Vec3::new(x, y, 2.0);
    for [x0, y0, x1, y1] in
        [[-1.0, -1.0, 1.0, -0.2], [-1.0, 0.2, 1.0, 1.0], [-1.0, -0.2, -0.2, 0.2], [0.2, -0.2, 1.0, 0.2]]
    {
        place(&mut builder, quad([at(x0, y0), at(x1, y0), at(x1, y1), at(x0, y1)]), &[diffuse(0.7)]);
    }
    place_at(
        &mut builder,
        floor(half_width, 0.0),
        &[diffuse(0.3)],
        DMat4::from_translation(DVec3::new(0.0, 0.0, -0.05)),
    );
    let mut sun = lamp(LampShape::Sun { angle: 0.01 }, 5.0, DVec3::ZERO);
    sun.power = Rgb([5.0, 4.0, 3.0]);
    builder.add_lamp(sun);
    builder.set_world(world(sky));
    builder.set_camera(camera(DVec3::new(-0.8, -0.7, 1.2), DVec3::new(0.5, 0.5, 0.8), 0.9, 16));
    builder.finish().expect("a scene with a camera")
}

fn with_aim(aim: Switch, photons: u64) -> RenderSettings {
    let mut settings = settings(photons, 24, 64);
    settings.photon_pass.aim = aim;
    settings.effects.direct_light = Switch::Off;
    settings
}

/// In a room without ground around it, half of the photons cross the room anyway: the mean is known well without aiming.
#[test]
fn aimed_photons_bring_the_same_light() {
    let scene = room(1.0, 0.5);
    let even = render(&scene, &with_aim(Switch::Off, 3_000_000));
    let aimed = render(&scene, &with_aim(Switch::On, 400_000));
    assert!(even.stats.aim.is_none());
    let stats = aimed.stats.aim.expect("photons are aimed");
    assert!(stats.lights == 2 && stats.bytes > 0 && stats.seen_after > 1.4 * stats.seen_before, "{stats:?}");
    assert_close(mean(&aimed.radiance()), mean(&even.radiance()), 0.015);
}

#[test]
fn wide_ground_takes_no_photons_from_a_room() {
    let picture = render(&room(100.0, 0.5), &with_aim(Switch::Auto, 100_000));
    let stats = picture.stats.aim.expect("most photons would miss the room");
    assert!(stats.seen_before < 0.01, "{stats:?}");
    assert!(stats.seen_after > 0.4, "{stats:?}");
    // No light comes from the ground.
    let small = render(&room(1.0, 0.5), &with_aim(Switch::On, 400_000));
    assert_close(mean(&picture.radiance()), mean(&small.radiance()), 0.03);
}

#[test]
fn where_photons_land_anyway_nothing_is_aimed() {
    let mut builder = SceneBuilder::default();
    place(&mut builder, floor(1.0, 0.0), &[diffuse(0.5)]);
    builder.add_lamp(lamp(LampShape::Sun { angle: 0.01 }, 5.0, DVec3::ZERO));
    builder.set_camera(camera(DVec3::new(0.0, -3.0, 2.0), DVec3::ZERO, 0.6, 8));
    let scene = builder.finish().expect("a scene with a camera");
    let (auto, off) =
        (render(&scene, &with_aim(Switch::Auto, 5000)), render(&scene, &with_aim(Switch::Off, 5000)));
    assert!(auto.stats.aim.is_none());
    assert_eq!(auto.combined, off.combined);
}

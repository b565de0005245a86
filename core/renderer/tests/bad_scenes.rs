//! Scenes that are wrong, empty or extreme: each gives a picture and says what was wrong, and none takes the host down.

mod support;

use glam::{DMat4, DVec3};
use rgp_renderer::color::Rgb;
use rgp_renderer::error::RenderError;
use rgp_renderer::scene::record::CameraRecord;
use rgp_renderer::scene::{LampShape, MeshArrays, Scene, SceneBuilder};
use rgp_renderer::settings::RenderSettings;
use support::*;

fn few() -> RenderSettings {
    settings(50_000, 32, 32)
}

fn finished(builder: SceneBuilder) -> Scene {
    builder.finish().expect("a scene")
}

/// Fails unless the scene renders as the sound one does, to the bit, and says `message` about `subject`, `count` times.
#[track_caller]
fn assert_harmless(sound: SceneBuilder, bad: SceneBuilder, subject: &str, message: &str, count: u64) {
    let bad = finished(bad);
    let told = bad.problems.iter().find(|p| p.subject == subject && p.message.contains(message));
    assert_eq!(told.map(|p| p.count), Some(count), "problems: {:?}", bad.problems);
    let (sound, bad) = (render(&finished(sound), &few()), render(&bad, &few()));
    assert!(sound.combined == bad.combined && sound.indirect == bad.indirect, "the picture changed");
    assert!(mean(&sound.radiance()) > 0.0);
}

#[test]
fn no_camera_is_an_error() {
    let mut builder = SceneBuilder::default();
    place(&mut builder, floor(1.0, 0.0), &[diffuse(0.5)]);
    let Err(RenderError::Scene(message)) = builder.finish() else { panic!("a scene without camera passed") };
    assert!(message.contains("camera"), "{message}");
}

#[test]
fn camera_that_is_not_a_number_is_an_error() {
    let mut builder = Room::default().builder();
    builder.set_camera(camera(DVec3::splat(f64::NAN), DVec3::ZERO, 1.0, 8));
    assert!(builder.finish().is_err());
}

#[test]
fn empty_scene_shows_the_background() {
    for radiance in [0.0_f32, 0.7] {
        let mut builder = SceneBuilder::default();
        builder.set_world(world(radiance));
        builder.add_lamp(point_lamp(1.0, DVec3::Z));
        builder.set_camera(camera(DVec3::ZERO, DVec3::X, 1.0, 9));
        let scene = finished(builder);
        assert!(scene.problems.iter().any(|p| p.message.contains("no surface")), "{:?}", scene.problems);
        let picture = render(&scene, &few());
        assert!(picture.radiance().iter().all(|&v| v == f64::from(radiance)));
    }
}

#[test]
fn scene_without_light_is_black() {
    let picture = finish_and_render(Room { lamps: 0, ..Room::default() }.builder(), &few());
    for pixel in picture.combined.chunks(4) {
        assert_eq!(pixel, [0.0, 0.0, 0.0, 1.0]);
    }
}

/// A room whose walls have some further triangles.
fn with_triangles(corners: &[[f32; 3]]) -> SceneBuilder {
    let room = Room::default();
    let mut builder = room.equipment();
    for (i, (mut mesh, material)) in room.meshes().into_iter().enumerate() {
        if i == 0 {
            let first = mesh.positions.len() as u32;
            mesh.positions.extend(corners);
            let added = (0..corners.len() as u32 / 3).map(|i| [0, 1, 2].map(|k| first + 3 * i + k));
            mesh.triangles.extend(added);
        }
        place(&mut builder, mesh, &[material]);
    }
    builder
}

#[test]
fn vertices_that_are_not_numbers() {
    let (nan, infinite) = ([f32::NAN, 0.0, 0.0], [0.0, f32::INFINITY, 0.0]);
    let corners = [nan, [0.0; 3], [1.0, 0.0, 0.0], infinite, [0.0; 3], [1.0, 0.0, 0.0]];
    let bad = with_triangles(&corners);
    assert_harmless(Room::default().builder(), bad, "box", "not a number", 2);
}

#[test]
fn vertices_no_triangle_uses() {
    let room = Room::default();
    let mut builder = room.equipment();
    for (mut mesh, material) in room.meshes() {
        mesh.positions.push([1e4, f32::NAN, 3.0]);
        mesh.positions.push([1e4, 2.0, 3.0]);
        place(&mut builder, mesh, &[material]);
    }
    let (sound, bad) = (finished(room.builder()), finished(builder));
    assert!(bad.problems.is_empty(), "{:?}", bad.problems);
    assert!(render(&sound, &few()).combined == render(&bad, &few()).combined);
}

#[test]
fn triangles_without_area() {
    // The second lies outside the room, and must not widen it.
    let a = [0.5, 1.0, 1.5];
    let corners = [a, a, a, a, [1.0, 2.0, 3.0], [2.0, 4.0, 6.0], a, [0.5, 0.2, 0.3], a];
    assert_harmless(Room::default().builder(), with_triangles(&corners), "box", "without area", 3);
}

#[test]
fn objects_with_impossible_transforms() {
    let flat = DMat4::from_scale(DVec3::new(1.0, 1.0, 0.0));
    let nan = DMat4::from_translation(DVec3::new(0.0, f64::NAN, 0.0));
    let infinite = DMat4::from_scale(DVec3::splat(f64::INFINITY));
    for (transform, message) in [(flat, "scale is zero"), (nan, "not a number"), (infinite, "not a number")] {
        let mut bad = Room::default().builder();
        place_at(&mut bad, floor(0.3, 0.0), &[diffuse(0.5)], transform);
        assert_harmless(Room::default().builder(), bad, "object", message, 1);
    }
}

#[test]
fn spots_with_a_flat_cone() {
    for flat in [DVec3::new(0.0, 1.0, 1.0), DVec3::new(1.0, 0.0, 1.0), DVec3::new(1.0, 1.0, 0.0)] {
        let mut bad = Room::default().builder();
        let spot = LampShape::Spot { radius: 0.0, soft_falloff: true, cone_angle: 0.8, blend: 0.2 };
        let mut record = lamp(spot, 10.0, DVec3::ZERO);
        record.world_from_lamp = rows(DMat4::from_scale(flat));
        bad.add_lamp(record);
        assert_harmless(Room::default().builder(), bad, "lamp", "scale is zero", 1);
    }
}

#[test]
fn mesh_without_triangles() {
    let mut bad = Room::default().builder();
    place(&mut bad, MeshArrays::default(), &[diffuse(0.5)]);
    let (sound, bad) = (finished(Room::default().builder()), finished(bad));
    assert_eq!(bad.objects.len(), sound.objects.len());
    assert!(render(&sound, &few()).combined == render(&bad, &few()).combined);
}

#[test]
fn lamps_that_cannot_shine() {
    let square = |side| LampShape::Rectangle { size: [side, side], spread: 1.0 };
    let nowhere = DVec3::splat(f64::NAN);
    for (shape, power, position, message) in [
        (square(0.0), 5.0, DVec3::ZERO, "size is zero"),
        (square(-1.0), 5.0, DVec3::ZERO, "size is zero"),
        (square(1.0), -5.0, DVec3::ZERO, "negative"),
        (square(1.0), f32::NAN, DVec3::ZERO, "not a number"),
        (square(1.0), f32::INFINITY, DVec3::ZERO, "not a number"),
        (square(1.0), 5.0, nowhere, "not a number"),
    ] {
        let mut bad = Room::default().builder();
        bad.add_lamp(lamp(shape, power, position));
        assert_harmless(Room::default().builder(), bad, "lamp", message, 1);
    }
}

/// Finite, and still more than can be worked with.
#[test]
fn objects_larger_smaller_and_farther_than_numbers_go() {
    let far = DMat4::from_translation(DVec3::X * 1e300);
    let large = DMat4::from_scale(DVec3::splat(1e200));
    let small = DMat4::from_scale(DVec3::new(1e-320, 1.0, 1.0));
    for transform in [far, large, small] {
        let mut bad = Room::default().builder();
        place_at(&mut bad, floor(0.3, 0.0), &[diffuse(0.5)], transform);
        assert_harmless(Room::default().builder(), bad, "object", "than numbers go", 1);
    }
}

#[test]
fn lamps_larger_and_farther_than_numbers_go() {
    let square = |side| LampShape::Rectangle { size: [side, side], spread: 1.0 };
    let far = DVec3::X * 1e60;
    let spot = |cone_angle| LampShape::Spot { radius: 0.1, soft_falloff: true, cone_angle, blend: 0.0 };
    let lamps = [
        lamp(square(1.0), 1.0, far),
        lamp(square(1e30), 1.0, DVec3::ZERO),
        lamp(spot(f32::NAN), 1.0, DVec3::ZERO),
        lamp(LampShape::Sun { angle: f32::INFINITY }, 1.0, DVec3::ZERO),
    ];
    for record in lamps {
        let mut bad = Room::default().builder();
        bad.add_lamp(record);
        assert_harmless(Room::default().builder(), bad, "lamp", "than numbers go", 1);
    }
}

#[test]
fn cameras_farther_than_numbers_go_are_an_error() {
    let sound = camera(DVec3::Z, DVec3::ZERO, 1.0, 8);
    let mut far = sound.clone();
    far.world_from_camera[0][3] = 1e300;
    let window = [-1e300, 1.0, -1.0, 1.0];
    let wide = CameraRecord { window, ..sound.clone() };
    let unclipped = CameraRecord { clip: [f64::NAN, 1.0], ..sound.clone() };
    let shutter = CameraRecord { shutter: vec![1e308, 0.0, 1e308, 1e308], ..sound };
    for record in [far, wide, unclipped, shutter] {
        let mut builder = Room::default().builder();
        builder.set_camera(record);
        let Err(RenderError::Scene(message)) = builder.finish() else { panic!("such a camera passed") };
        assert!(message.starts_with("camera 'camera': "), "{message}");
    }
}

/// One negative channel must not take the others with it.
#[test]
fn lamp_that_is_negative_in_one_channel() {
    let mut bad = lamp(LampShape::Sun { angle: 0.0 }, 1.0, DVec3::ZERO);
    bad.power = Rgb([2.0, -1.0, 0.5]);
    let mut builder = SceneBuilder::default();
    builder.add_lamp(bad);
    place(&mut builder, floor(1.0, 0.0), &[diffuse(0.5)]);
    builder.set_camera(parallel_camera(DVec3::Z, DVec3::ZERO, 0.1, 4));
    let picture = finish_and_render(builder, &few());
    for pixel in picture.combined.chunks(4) {
        assert_close(f64::from(pixel[0]), 2.0 * 0.5 / std::f64::consts::PI, 1e-4);
        assert_eq!(pixel[1], 0.0);
        assert_close(f64::from(pixel[2]), 0.5 * 0.5 / std::f64::consts::PI, 1e-4);
    }
}

/// A closed room of albedo 1 has no answer; it must end, be bright and finite. More than 1 counts as 1.
#[test]
fn albedo_of_one_and_above_ends() {
    let picture = |albedo: f32| {
        let mut builder = Room::default().equipment();
        for (mesh, _) in Room::default().meshes() {
            place(&mut builder, mesh, &[diffuse(albedo)]);
        }
        finish_and_render(builder, &few())
    };
    let (one, above) = (picture(1.0), picture(7.0));
    assert!(one.combined.iter().all(|v| v.is_finite() && *v >= 0.0));
    assert!(one.combined == above.combined);
    let gray = mean(&finish_and_render(Room::default().builder(), &few()).radiance());
    assert!(mean(&one.radiance()) > 3.0 * gray);
}

/// The same picture as at one metre, with as much light per area.
#[test]
fn rooms_of_a_tenth_of_a_millimetre_and_of_a_thousand_kilometres() {
    let room = Room::default();
    let one = finish_and_render(room.builder(), &few());
    for scale in [1e-4, 1e6] {
        let power = room.power * (scale * scale) as f32;
        let other = finish_and_render(Room { scale, power, ..room.clone() }.builder(), &few());
        for (a, b) in
            [(one.radiance(), other.radiance()), (one.indirect_radiance(), other.indirect_radiance())]
        {
            assert_close(mean(&b), mean(&a), 0.005);
        }
    }
}

/// Without photons there is no light to read, and the direct light is what it was.
#[test]
fn no_photons() {
    let scene = finished(Room::default().builder());
    let mut settings = settings(0, 32, 32);
    settings.gather.retrace_distance = 0.0;
    let none = render(&scene, &settings);
    settings.photon_pass.photon_count = 50_000;
    let some = render(&scene, &settings);
    assert!(none.indirect.iter().all(|&v| v == 0.0));
    let direct: Vec<f64> =
        some.radiance().iter().zip(some.indirect_radiance()).map(|(all, part)| all - part).collect();
    assert_close(mean(&none.radiance()), mean(&direct), 1e-6);
}

/// Any split of rays over camera samples gives the same mean.
#[test]
fn few_rays_and_uneven_shares() {
    let scene = finished(Room::default().builder());
    let with = |rays: u32, camera_samples: u32| {
        let mut settings = settings(200_000, 32, rays);
        settings.gather.camera_samples = camera_samples;
        render(&scene, &settings)
    };
    let many = with(256, 16);
    for (rays, camera_samples) in [(1, 1), (7, 3), (2, 5), (1, 16), (17, 16)] {
        let few = with(rays, camera_samples);
        assert_close(mean(&few.indirect_radiance()), mean(&many.indirect_radiance()), 0.05);
        assert_close(mean(&few.radiance()), mean(&many.radiance()), 0.05);
    }
}

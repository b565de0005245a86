//! What must not change the picture, or change it by a known factor.

mod support;

use glam::DVec3;
use rgp_renderer::scene::SceneBuilder;
use support::*;

fn picture(builder: SceneBuilder) -> Picture {
    finish_and_render(builder, &settings(100_000, 32, 64))
}

/// Red, green and blue of every pixel, as bits, after multiplication.
fn bits(picture: &Picture, factor: f32) -> Vec<u32> {
    let light = picture.combined.chunks(4).flat_map(|pixel| &pixel[..3]);
    light.chain(&picture.indirect).map(|v| (v * factor).to_bits()).collect()
}

fn assert_same_bits(one: &[u32], other: &[u32]) {
    let differing = one.iter().zip(other).filter(|(a, b)| a != b).count();
    assert_eq!(differing, 0, "differing numbers of {}", one.len());
}

/// Twice the size at the same watts is a quarter of the irradiance.
#[test]
fn size() {
    let room = Room::default();
    let one = picture(room.builder());
    for exponent in [-10, 4] {
        let scale = 2.0_f64.powi(exponent);
        let other = picture(Room { scale, ..room.clone() }.builder());
        assert_same_bits(&bits(&one, 1.0), &bits(&other, (scale * scale) as f32));
    }
}

#[test]
fn brightness() {
    let room = Room::default();
    let one = picture(room.builder());
    for exponent in [-20, 12] {
        let factor = 2.0_f32.powi(exponent);
        let other = picture(Room { power: room.power * factor, ..room.clone() }.builder());
        assert_same_bits(&bits(&one, factor), &bits(&other, 1.0));
    }
}

#[test]
fn order_of_objects_and_triangles() {
    let room = Room::default();
    let mut builder = room.equipment();
    for (mut mesh, material) in room.meshes().into_iter().rev() {
        mesh.triangles.reverse();
        place(&mut builder, mesh, &[material]);
    }
    assert_same_bits(&bits(&picture(room.builder()), 1.0), &bits(&picture(builder), 1.0));
}

/// Float coordinates are 6 cm apart there; objects' transforms are not. Cells are anchored in the world: they lie
/// elsewhere on the walls.
#[test]
fn distance_from_the_worlds_origin() {
    let room = Room::default();
    let one = picture(room.builder());
    let far = picture(Room { shift: DVec3::new(1e6 + 0.02, -1e6 + 0.03, 3e5 + 0.01), ..room }.builder());
    assert_same_pictures(&one, &far);
}

/// Shadow rays go elsewhere on two lamps: many, so that their mean is known.
#[test]
fn one_lamp_or_two_of_half_the_power() {
    let room = Room::default();
    let one = picture_of_many_samples(room.builder());
    let two = picture_of_many_samples(Room { lamps: 2, ..room }.builder());
    assert_same_pictures(&one, &two);
}

fn picture_of_many_samples(builder: SceneBuilder) -> Picture {
    let mut settings = settings(100_000, 32, 1024);
    settings.gather.camera_samples = 1024;
    finish_and_render(builder, &settings)
}

/// A quarter turn about an axis of the grid permutes its cells. Shadow rays go elsewhere on the lamp, which is not turned:
/// many, so that their mean is known.
#[test]
fn quarter_turn() {
    let room = Room::default();
    let one = picture_of_many_samples(room.builder());
    let mut builder = SceneBuilder::default();
    let turn = glam::DMat4::from_rotation_z(std::f64::consts::FRAC_PI_2);
    for (mut mesh, material) in room.meshes() {
        for p in &mut mesh.positions {
            *p = [-p[1], p[0], p[2]];
        }
        place(&mut builder, mesh, &[material]);
    }
    let square = rgp_renderer::scene::LampShape::Rectangle { size: [0.5; 2], spread: std::f32::consts::PI };
    builder.add_lamp(lamp(square, room.power, DVec3::new(0.0, 0.0, 0.95)));
    let turned = |x, y, z| turn.transform_point3(DVec3::new(x, y, z));
    builder.set_camera(camera(turned(-0.8, -0.7, 0.3), turned(0.3, 0.3, -0.3), 0.9, room.pixels));
    assert_same_pictures(&one, &picture_of_many_samples(builder));
}

/// Few photons make noise, not another brightness.
#[test]
fn number_of_photons() {
    let scene = Room::default().builder().finish().expect("a scene");
    let many = mean(&render(&scene, &settings(1_000_000, 64, 64)).indirect_radiance());
    for (photons, tolerance) in [(10_000, 0.03), (100_000, 0.01)] {
        let few = mean(&render(&scene, &settings(photons, 64, 64)).indirect_radiance());
        assert_close(few, many, tolerance);
    }
}

/// The same mean; pixels differ by no more than those of another seed do (half as much again for the noise of that noise).
fn assert_same_pictures(one: &Picture, other: &Picture) {
    assert_close(mean(&other.radiance()), mean(&one.radiance()), 0.003);
    let mut settings = settings(100_000, 32, 64);
    settings.render.seed = 1;
    let reseeded = finish_and_render(Room::default().builder(), &settings);
    let (difference, noise) = (rms(one, other), rms(one, &reseeded));
    assert!(difference < 1.5 * noise, "pixels differ by {difference}, by {noise} between seeds");
}

/// Root mean squared difference of pixels.
fn rms(one: &Picture, other: &Picture) -> f64 {
    let squares: Vec<f64> =
        one.radiance().iter().zip(other.radiance()).map(|(a, b)| (a - b).powi(2)).collect();
    mean(&squares).sqrt()
}

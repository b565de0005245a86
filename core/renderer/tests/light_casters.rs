//! Photons that are aimed at mirrors and glass bring the light that goes there, of every kind of light, and no other.

mod light_support;

use glam::Vec3;
use light_support::*;
use rgp_renderer::color::Rgb;
use rgp_renderer::light::{Casters, Emission, Lights};
use rgp_renderer::scene::{Lamp, LampShape};

/// The ball that light is counted in, well within what photons are aimed at.
const CENTER: Vec3 = Vec3::new(0.1, -0.15, -0.2);
const RADIUS: f32 = 0.06;

/// Boxes about points of a somewhat larger ball, as its triangles would have.
fn casters() -> Casters {
    let mut random = Random(3);
    let around = |random: &mut Random| CENTER + random.direction() * (RADIUS * 1.15);
    let boxes = (0..400).map(|_| {
        let p = around(&mut random);
        [p - 0.02, p + 0.02]
    });
    Casters::new(boxes.collect()).expect("there are boxes")
}

/// Flux into the ball, and the share of the photons that bring it.
fn flux_into_ball(count: u32, mut emit: impl FnMut() -> Option<Emission>) -> (f64, f64) {
    let (mut flux, mut met) = (0.0, 0);
    for _ in 0..count {
        let Some(emission) = emit() else { continue };
        let to = CENTER - emission.origin;
        let passes = to.cross(emission.direction).length_squared() < RADIUS * RADIUS;
        if passes && to.dot(emission.direction) > 0.0 {
            met += 1;
            flux += f64::from(emission.flux.0[1]);
        }
    }
    (flux / f64::from(count), f64::from(met) / f64::from(count))
}

#[track_caller]
fn assert_same_flux(mut lights: Lights, most_aimed: bool) {
    let mut random = Random(17);
    let (even, rare) = flux_into_ball(4_000_000, || lights.emit(random.uniforms()));
    lights.map_caustics(casters(), 0.5);
    assert!(lights.has_mapped());
    let (aimed, often) = flux_into_ball(200_000, || lights.emit_to_casters(random.uniforms()));
    assert_close(aimed, even, 0.03);
    assert!(often > 3.0 * rare && (!most_aimed || often > 0.3), "{rare} of the photons, aimed {often}");
}

fn at(shape: LampShape) -> Lamp {
    turned(lamp(shape, 3.0, Vec3::new(0.05, 0.0, 0.3)))
}

#[test]
fn point_lamps() {
    assert_same_flux(one_lamp(at(LampShape::Point { radius: 0.0, soft_falloff: false })), true);
    assert_same_flux(one_lamp(at(LampShape::Point { radius: 0.05, soft_falloff: false })), false);
}

#[test]
fn spots() {
    let spot = LampShape::Spot { radius: 0.02, soft_falloff: false, cone_angle: 1.9, blend: 0.7 };
    assert_same_flux(one_lamp(at(spot.clone())), false);
    assert_same_flux(one_lamp(Lamp { stretch: [0.7, 1.6], ..at(spot) }), false);
}

#[test]
fn area_lamps() {
    for spread in [std::f32::consts::PI, 2.2] {
        assert_same_flux(one_lamp(at(LampShape::Rectangle { size: [0.05, 0.1], spread })), false);
        assert_same_flux(one_lamp(at(LampShape::Ellipse { size: [0.05, 0.1], spread })), false);
    }
}

#[test]
fn suns() {
    assert_same_flux(one_lamp(at(LampShape::Sun { angle: 0.0 })), true);
    assert_same_flux(one_lamp(at(LampShape::Sun { angle: 0.2 })), true);
}

#[test]
fn emissive_meshes() {
    let positions = [Vec3::new(0.0, 0.0, 0.3), Vec3::new(0.1, 0.0, 0.3), Vec3::new(0.0, 0.1, 0.33)];
    let mesh = object(&positions, &[[0, 1, 2]], vec![0], None);
    assert_same_flux(Lights::build(&scene(Vec::new(), vec![mesh], 0.0), &[Rgb::splat(2.0)]), true);
}

/// What mirrors and glass see under a wide angle is met by rays often enough.
#[test]
fn wide_lights_are_left_to_rays() {
    let wide = [
        one_lamp(at(LampShape::Rectangle { size: [0.8, 0.8], spread: std::f32::consts::PI })),
        one_lamp(at(LampShape::Point { radius: 0.3, soft_falloff: false })),
        Lights::build(&scene(Vec::new(), Vec::new(), 1.0), &[]),
    ];
    for mut lights in wide {
        lights.map_caustics(casters(), 0.5);
        assert!(!lights.has_mapped());
    }
}

//! Direct light of each kind of light against its closed form.

mod light_support;

use std::f64::consts::PI;

use glam::{DAffine3, DMat3, DVec3, Vec3};
use light_support::{assert_close, irradiance, lamp, object, one_lamp, polygon_irradiance, scene, turned};
use rgp_renderer::color::Rgb;
use rgp_renderer::light::Lights;
use rgp_renderer::scene::{Lamp, LampShape, visibility};

const POWER: f32 = 10.0;
const INTENSITY: f64 = POWER as f64 / (4.0 * PI);
const FULL: f32 = std::f32::consts::PI;

fn point(radius: f32, soft_falloff: bool) -> LampShape {
    LampShape::Point { radius, soft_falloff }
}

fn rectangle(size: [f32; 2], spread: f32) -> LampShape {
    LampShape::Rectangle { size, spread }
}

fn ellipse(size: [f32; 2], spread: f32) -> LampShape {
    LampShape::Ellipse { size, spread }
}

/// Corners of a rectangular lamp, counter-clockwise seen from the side it shines to.
fn lamp_corners(lamp: &Lamp, size: [f32; 2]) -> [DVec3; 4] {
    let [x, y] = [lamp.x_axis * size[0] * 0.5, lamp.y_axis * size[1] * 0.5].map(Vec3::as_dvec3);
    let c = lamp.position.as_dvec3();
    [c - x - y, c + x - y, c + x + y, c - x + y]
}

#[test]
fn point_light_falls_with_the_square_of_the_distance() {
    let position = Vec3::new(0.1, -0.2, 0.4);
    let lights = one_lamp(lamp(point(0.0, false), POWER, position));
    for p in [Vec3::ZERO, Vec3::new(0.3, 0.1, -0.5), Vec3::new(0.1, -0.2, 0.39)] {
        let to = (position - p).as_dvec3();
        let expected = INTENSITY * to.normalize().z / to.length_squared();
        assert_close(irradiance(&lights, p, Vec3::Z, 1, 1), expected, 1e-5);
    }
    let sample = lights.sample_direct(Vec3::ZERO, [0.5; 3]).unwrap();
    assert!(sample.is_delta && sample.blockers == visibility::SHADOW);
    assert_close(f64::from(sample.distance), f64::from(position.length()), 1e-6);
}

#[test]
fn sphere_light_is_pi_radiance_sine_squared() {
    // Facing it: π L sin² = I / d² at any distance; tilted, but with the whole sphere above the surface: times cos.
    for (radius, distance) in [(0.05_f32, 0.4_f32), (0.2, 0.25), (0.2, 0.2001), (1e-3, 0.5), (1e-5, 0.5)] {
        let lights = one_lamp(lamp(point(radius, false), POWER, Vec3::new(0.0, 0.0, distance)));
        let expected = INTENSITY / f64::from(distance * distance);
        assert_close(irradiance(&lights, Vec3::ZERO, Vec3::Z, 1, 400), expected, 1e-4);
    }
    let lights = one_lamp(lamp(point(0.1, false), POWER, Vec3::new(0.3, 0.0, 0.4)));
    assert_close(irradiance(&lights, Vec3::ZERO, Vec3::Z, 1, 400), INTENSITY / 0.25 * 0.8, 1e-4);
}

#[test]
fn inside_a_sphere_light_every_surface_gets_pi_radiance() {
    let lights = one_lamp(lamp(point(0.2, false), POWER, Vec3::ZERO));
    let expected = INTENSITY / f64::from(0.2_f32 * 0.2);
    for n in [Vec3::Z, Vec3::X] {
        assert_close(irradiance(&lights, Vec3::new(0.1, 0.05, 0.0), n, 1, 600), expected, 1e-4);
    }
}

#[test]
fn soft_point_light_is_a_disk_that_faces_the_receiver() {
    // On the axis of a disk: π L r² / (r² + d²) = I / (r² + d²), finite at the lamp itself.
    for (radius, distance) in [(0.1_f32, 0.4_f32), (0.2, 0.05), (0.1, 0.001)] {
        let lights = one_lamp(lamp(point(radius, true), POWER, Vec3::new(0.0, 0.0, distance)));
        let expected = INTENSITY / f64::from(distance * distance + radius * radius);
        assert_close(irradiance(&lights, Vec3::ZERO, Vec3::Z, 1, 800), expected, 1e-4);
    }
}

#[test]
fn spot_is_a_point_light_masked_by_smoothstep_in_the_cosine() {
    let (angle, blend) = (1.2_f32, 0.4_f32);
    let shape = |blend| LampShape::Spot { radius: 0.0, soft_falloff: true, cone_angle: angle, blend };
    let at = |shape, degrees: f32| {
        let lights = one_lamp(lamp(shape, POWER, Vec3::new(0.0, 0.0, 0.5)));
        let (sin, cos) = degrees.to_radians().sin_cos();
        let p = Vec3::new(0.5 * sin, 0.0, 0.5 - 0.5 * cos);
        irradiance(&lights, p, Vec3::new(-sin, 0.0, cos), 1, 1) * 0.25 / INTENSITY
    };
    assert_close(at(shape(0.0), 0.0), 1.0, 1e-5);
    assert_close(at(shape(0.0), 34.3), 1.0, 1e-5);
    assert_eq!(at(shape(0.0), 34.5), 0.0);
    assert_eq!(at(shape(blend), 34.5), 0.0);
    assert_close(at(shape(blend), 10.0), 1.0, 1e-5);
    for degrees in [27.0_f32, 30.0, 33.0] {
        let edge = f64::from(0.5 * angle).cos();
        let t = (f64::from(degrees).to_radians().cos() - edge) / ((1.0 - edge) * f64::from(blend));
        assert!(t > 0.0 && t < 1.0);
        assert_close(at(shape(blend), degrees), t * t * (3.0 - 2.0 * t), 2e-5);
    }
}

#[test]
fn stretched_spot_lights_an_ellipse() {
    // The axes of the lamp are X and −Y: on the plane below, its hard edge is at tan (angle / 2) × stretch.
    let shape = LampShape::Spot { radius: 0.0, soft_falloff: false, cone_angle: 1.0, blend: 0.0 };
    let spot = Lamp { stretch: [0.5, 3.0], ..lamp(shape, POWER, Vec3::new(0.0, 0.0, 0.4)) };
    let lights = one_lamp(spot);
    let rim = 0.4 * 0.5_f32.tan();
    for turn in [0.0_f32, 0.4, 1.0, 1.5, 2.6] {
        let edge = Vec3::new(0.5 * turn.cos(), 3.0 * turn.sin(), 0.0) * rim;
        assert_eq!(irradiance(&lights, edge * 1.001, Vec3::Z, 1, 1), 0.0);
        let p = edge * 0.999;
        let squared = f64::from(p.length_squared() + 0.16);
        assert_close(irradiance(&lights, p, Vec3::Z, 1, 1), INTENSITY * 0.4 / squared.powf(1.5), 1e-5);
    }
}

#[test]
fn narrow_spot_keeps_its_edge() {
    // Half a degree from the axis to the edge: cosines in f32 would be off by 0.2 % here.
    let shape =
        LampShape::Spot { radius: 0.0, soft_falloff: false, cone_angle: 1_f32.to_radians(), blend: 1.0 };
    let lights = one_lamp(lamp(shape, POWER, Vec3::new(0.0, 0.0, 0.5)));
    let half = 0.5_f64.to_radians();
    let x = 0.5 * (0.5 * half).tan();
    let t = ((0.5 * half).cos() - half.cos()) / (1.0 - half.cos());
    let expected = INTENSITY / (x * x + 0.25) * (0.5 * half).cos() * t * t * (3.0 - 2.0 * t);
    assert_close(irradiance(&lights, Vec3::new(x as f32, 0.0, 0.0), Vec3::Z, 1, 1), expected, 1e-4);
}

#[test]
fn wide_spots_light_their_axis_as_point_lights_do() {
    for soft_falloff in [false, true] {
        let shape = LampShape::Spot { radius: 0.1, soft_falloff, cone_angle: 2.8, blend: 0.0 };
        let lights = one_lamp(lamp(shape, POWER, Vec3::new(0.0, 0.0, 0.4)));
        let expected = INTENSITY / if soft_falloff { 0.17 } else { 0.16 };
        assert_close(irradiance(&lights, Vec3::ZERO, Vec3::Z, 1, 800), expected, 1e-4);
    }
}

#[test]
fn sun_gives_its_irradiance_times_the_cosine() {
    let tilted = Vec3::new(0.6, 0.0, 0.8);
    for angle in [0.0_f32, 0.009, 0.2, 1.0] {
        let lights = one_lamp(lamp(LampShape::Sun { angle }, POWER, Vec3::ZERO));
        for (n, cos) in [(Vec3::Z, 1.0), (tilted, 0.8)] {
            assert_close(irradiance(&lights, Vec3::ZERO, n, 1, 400), f64::from(POWER) * cos, 1e-4);
        }
        let sample = lights.sample_direct(Vec3::ZERO, [0.5; 3]).unwrap();
        assert_eq!(sample.is_delta, angle == 0.0);
        assert_eq!(sample.distance, f32::INFINITY);
    }
}

#[test]
fn rectangle_is_lamberts_polygon_near_and_far() {
    let size = [0.6, 0.2];
    let lamps = [lamp(rectangle(size, FULL), POWER, Vec3::new(0.0, 0.0, 0.4))];
    let lamps = [lamps[0].clone(), turned(lamps[0].clone())];
    let radiance = f64::from(POWER) / (PI * 0.12);
    for lamp in lamps {
        let lights = one_lamp(lamp.clone());
        for (along, aside) in
            [(0.4, 0.0), (0.1, 0.25), (0.01, 0.1), (0.001, 0.0), (0.3, 0.9), (9.0, 3.0), (90.0, 0.0)]
        {
            // The receiver faces the lamp's plane, so that all of the lamp is above it.
            let p = lamp.position + lamp.axis * along + lamp.x_axis * aside + lamp.y_axis * (0.5 * aside);
            let n = -lamp.axis;
            let corners = lamp_corners(&lamp, size);
            let expected = radiance * polygon_irradiance(p.as_dvec3(), n.as_dvec3(), &corners).abs();
            assert_close(irradiance(&lights, p, n, 1, 500), expected, 1e-4);
        }
        let behind = lamp.position - lamp.axis * 0.1;
        assert_eq!(irradiance(&lights, behind, lamp.axis, 1, 4), 0.0);
    }
}

#[test]
fn rectangle_beside_a_wall_matches_lambert() {
    let lights = one_lamp(lamp(rectangle([0.4, 0.4], FULL), POWER, Vec3::new(0.0, 0.0, 0.4)));
    let corners =
        lamp_corners(&lamp(rectangle([0.4, 0.4], FULL), POWER, Vec3::new(0.0, 0.0, 0.4)), [0.4, 0.4]);
    let p = Vec3::new(0.201, 0.05, 0.35);
    let expected =
        f64::from(POWER) / (PI * 0.16) * polygon_irradiance(p.as_dvec3(), DVec3::NEG_X, &corners).abs();
    assert_close(irradiance(&lights, p, Vec3::NEG_X, 1, 1000), expected, 1e-4);
}

#[test]
fn disk_is_footes_formula_on_and_off_its_axis() {
    // A receiver parallel to a disk of radius r, at height h and distance d from its axis:
    // E = π L / 2 (1 − (h² + d² − r²) / √((h² + d² + r²)² − 4 r² d²)); on the axis π L r² / (r² + h²).
    let radius = 0.2_f64;
    let lights = one_lamp(lamp(ellipse([0.4, 0.4], FULL), POWER, Vec3::ZERO));
    let pi_radiance = f64::from(POWER) / (PI * radius * radius);
    for (h, d) in [(0.5, 0.0), (0.1, 0.0), (0.01, 0.0), (0.5, 0.3), (0.1, 0.19), (0.05, 0.25), (4.0, 1.0)] {
        let s = h * h + d * d;
        let root = ((s + radius * radius).powi(2) - 4.0 * (radius * d).powi(2)).sqrt();
        let expected = 0.5 * pi_radiance * (1.0 - (s - radius * radius) / root);
        let p = Vec3::new(0.6 * d as f32, 0.8 * d as f32, -h as f32);
        assert_close(irradiance(&lights, p, Vec3::Z, 1, 1000), expected, 3e-4);
    }
}

/// Irradiance below an area lamp at the origin, summed over directions.
fn by_direction(shape: &LampShape, p: DVec3) -> f64 {
    let (size, spread, round) = match *shape {
        LampShape::Rectangle { size, spread } => (size, spread, false),
        LampShape::Ellipse { size, spread } => (size, spread, true),
        _ => unreachable!(),
    };
    let [w, h] = size.map(f64::from);
    let area = w * h * if round { PI / 4.0 } else { 1.0 };
    let half = 0.5 * f64::from(spread);
    let (steps, turns) = (4000, 400);
    let (mut sum, step) = (0.0, half / f64::from(steps));
    for i in 0..steps {
        let (sin, cos) = ((f64::from(i) + 0.5) * step).sin_cos();
        let attenuation = (half.tan() - sin / cos) / (half.tan() - half);
        for k in 0..turns {
            let (y, x) = ((f64::from(k) + 0.5) * 2.0 * PI / f64::from(turns)).sin_cos();
            let place = [(p.x - p.z * x * sin / cos) / w, (p.y - p.z * y * sin / cos) / h];
            let is_inside = if round {
                place[0].hypot(place[1]) <= 0.5
            } else {
                place[0].abs().max(place[1].abs()) <= 0.5
            };
            sum += if is_inside { attenuation * sin * cos } else { 0.0 };
        }
    }
    f64::from(POWER) / (PI * area) * sum * step * 2.0 * PI / f64::from(turns)
}

#[test]
fn spread_matches_an_integral_over_directions() {
    for spread in [0.05_f32, 0.5, 1.5, 3.0] {
        for shape in [rectangle([0.6, 0.2], spread), ellipse([0.3, 0.5], spread), ellipse([0.4, 0.4], spread)]
        {
            let lights = one_lamp(lamp(shape.clone(), POWER, Vec3::ZERO));
            for p in [Vec3::new(0.0, 0.0, -0.4), Vec3::new(0.12, 0.09, -0.1), Vec3::new(0.3, 0.1, -1.5)] {
                let expected = by_direction(&shape, p.as_dvec3());
                let value = irradiance(&lights, p, Vec3::Z, 1, 600);
                assert!(
                    (value - expected).abs() <= 1e-3 * expected + 1e-9,
                    "{shape:?} {p}: {value}, not {expected}"
                );
            }
        }
    }
}

#[test]
fn spread_keeps_the_flux_and_sharpens_the_axis() {
    // Far away on the axis: P / π × tan a / (tan a − a) / d².
    for spread in [0.02_f32, 0.3, 2.0] {
        let lights = one_lamp(lamp(rectangle([0.01, 0.01], spread), POWER, Vec3::ZERO));
        let half = 0.5 * f64::from(spread);
        let expected = f64::from(POWER) / PI * half.tan() / (half.tan() - half) / 1e4;
        let blur = if spread < 0.1 { 5e-3 } else { 5e-4 };
        assert_close(irradiance(&lights, Vec3::new(0.0, 0.0, -100.0), Vec3::Z, 1, 100), expected, blur);
    }
}

#[test]
fn no_spread_is_a_beam() {
    for (shape, area) in [(rectangle([0.4, 0.2], 0.0), 0.08), (ellipse([0.4, 0.2], 0.0), 0.02 * PI)] {
        let lights = one_lamp(lamp(shape, POWER, Vec3::new(0.0, 0.0, 0.5)));
        let expected = f64::from(POWER) / area;
        assert_close(irradiance(&lights, Vec3::new(0.05, 0.05, 0.0), Vec3::Z, 1, 3), expected, 1e-5);
        assert_eq!(irradiance(&lights, Vec3::new(0.21, 0.0, 0.0), Vec3::Z, 1, 3), 0.0);
        assert!(lights.sample_direct(Vec3::ZERO, [0.5; 3]).unwrap().is_delta);
    }
}

/// A unit square about the origin whose two triangles have materials 0 and 1.
fn square(place: Option<DAffine3>) -> rgp_renderer::scene::Object {
    let corners = [[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]].map(|[x, y]| Vec3::new(x, y, 0.0));
    object(&corners, &[[0, 1, 2], [0, 2, 3]], vec![0, 1], place)
}

#[test]
fn emissive_quad_shines_to_both_sides() {
    let place = DAffine3::from_mat3_translation(
        DMat3::from_euler(glam::EulerRot::XYZ, 0.2, 0.3, 0.4)
            * DMat3::from_diagonal(DVec3::new(0.4, 0.2, 3.0)),
        DVec3::new(0.1, 0.0, 0.3),
    );
    let square = square(Some(place));
    let triangles = [square.corners(0), square.corners(1)];
    let emission = [Rgb::splat(2.0), Rgb::splat(7.0)];
    let lights = Lights::build(&scene(Vec::new(), vec![square], 0.0), &emission);
    let normal = (triangles[0][1] - triangles[0][0]).cross(triangles[0][2] - triangles[0][0]).normalize();
    for side in [1.0, -1.0] {
        for distance in [0.5, 0.1] {
            let p = triangles[0][2] * 0.5 + triangles[0][0] * 0.5 + normal * (side * distance);
            // As it will be rounded for the core.
            let p = p.as_vec3();
            let n = (-normal * side).as_vec3();
            let expected: f64 = triangles
                .iter()
                .zip([2.0, 7.0])
                .map(|(corners, radiance)| {
                    radiance * polygon_irradiance(p.as_dvec3(), n.as_dvec3(), corners).abs()
                })
                .sum();
            assert_close(irradiance(&lights, p, n, 3000, 40), expected, 1e-4);
        }
    }
}

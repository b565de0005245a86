//! Many lights: one sample among them is no noisier than among few, and finds all of their light.

mod light_support;

use std::f32::consts::{PI, TAU};

use glam::Vec3;
use light_support::{Random, assert_close, irradiance, lamp, object, one_lamp, scene};
use rgp_renderer::color::Rgb;
use rgp_renderer::light::{Lights, Receiver};
use rgp_renderer::scene::{Lamp, LampShape, Object};

const UP: Vec3 = Vec3::Z;

const POINT: LampShape = LampShape::Point { radius: 0.0, soft_falloff: false };
const PANEL: LampShape = LampShape::Rectangle { size: [0.02, 0.02], spread: PI };
const BEAM: LampShape = LampShape::Spot { radius: 0.01, soft_falloff: false, cone_angle: 0.8, blend: 0.2 };

/// So many lamps of a kind under the ceiling of the unit cube, random in place and power, that give 1 W together.
fn lamps(shape: &LampShape, count: usize) -> Vec<Lamp> {
    let mut random = Random(5);
    let mut place = || (Vec3::from_array(random.uniforms()) - 0.5) * Vec3::new(1.0, 1.0, 0.1) + 0.4 * UP;
    let power = |i: usize| 0.2 + (i % 7) as f32;
    let total: f32 = (0..count).map(power).sum();
    (0..count).map(|i| lamp(shape.clone(), power(i) / total, place())).collect()
}

fn lights(shape: &LampShape, count: usize) -> Lights {
    Lights::build(&scene(lamps(shape, count), Vec::new(), 0.0), &[])
}

/// Standard deviation of one sample over its mean, at places of the floor; the mean of its square, rooted.
fn noise(lights: &Lights) -> f64 {
    let (points, samples) = (400, 400);
    let (mut random, mut variance) = (Random(8), 0.0);
    for _ in 0..points {
        let [x, y] = random.uniforms();
        let receiver = Receiver { p: Vec3::new(x - 0.5, y - 0.5, -0.4), normal: Some(UP), sets: u32::MAX };
        let (mut sum, mut squares) = (0.0, 0.0);
        for i in 0..samples {
            let [jitter, x, y] = random.uniforms();
            let sample = lights.sample_direct(receiver, [(i as f32 + jitter) / samples as f32, x, y]);
            let value = sample.map_or(0.0, |s| f64::from(s.radiance_over_pdf.0[0] * s.wi.dot(UP).max(0.0)));
            sum += value;
            squares += value * value;
        }
        let mean = sum / f64::from(samples);
        variance += (squares / f64::from(samples) / (mean * mean) - 1.0) / f64::from(points);
    }
    variance.sqrt()
}

#[test]
fn one_sample_is_as_good_among_ten_thousand_lamps_as_among_a_few() {
    // By power alone: 0.37, 0.48 and 1.9. Most beams do not reach a place; which ones, a cluster hardly knows.
    for (shape, among_few, among_many) in [(POINT, 0.14, 0.15), (PANEL, 0.20, 0.21), (BEAM, 0.5, 1.6)] {
        let few = noise(&lights(&shape, 60));
        assert!(few < among_few, "{shape:?}: {few} among 60");
        for count in [100, 1000, 10_000] {
            let many = noise(&lights(&shape, count));
            assert!(many < among_many, "{shape:?}: {many} among {count}");
        }
    }
}

#[test]
fn lamps_of_a_tree_add_up() {
    let p = Vec3::new(0.1, -0.2, -0.1);
    for shape in [POINT, PANEL, BEAM, LampShape::Sun { angle: 0.1 }] {
        let mut lamps = lamps(&shape, 300);
        lamps.truncate(200);
        for (index, lamp) in lamps.iter_mut().enumerate() {
            let turn = index as f32;
            lamp.axis = Vec3::new(turn.cos(), turn.sin(), -0.7 - (index % 3) as f32).normalize();
            lamp.x_axis = lamp.axis.any_orthonormal_vector();
        }
        let apart: f64 = lamps.iter().map(|lamp| irradiance(&one_lamp(lamp.clone()), p, UP, 1, 20)).sum();
        let together = Lights::build(&scene(lamps, Vec::new(), 0.0), &[]);
        let mut sum = 0.0;
        let mut random = Random(3);
        let count = 400_000;
        for i in 0..count {
            let [jitter, x, y] = random.uniforms();
            let receiver = Receiver { p, normal: Some(UP), sets: u32::MAX };
            let sample = together.sample_direct(receiver, [(i as f32 + jitter) / count as f32, x, y]);
            sum += sample.map_or(0.0, |s| f64::from(s.radiance_over_pdf.0[0] * s.wi.dot(UP).max(0.0)));
        }
        assert_close(sum / f64::from(count), apart, 5e-3);
    }
}

/// A tube of so many segments around, along X under the ceiling.
fn tube(segments: u32) -> Object {
    let corner = |i: u32, k: u32| {
        let (sin, cos) = (TAU * k as f32 / segments as f32).sin_cos();
        Vec3::new(i as f32 / segments as f32 - 0.5, 0.05 * cos, 0.05 * sin + 0.1)
    };
    let positions: Vec<Vec3> =
        (0..=segments).flat_map(|i| (0..segments).map(move |k| corner(i, k))).collect();
    let quad = |i: u32, k: u32| {
        let [a, b] = [k, (k + 1) % segments].map(|k| i * segments + k);
        [[a, b, b + segments], [a, b + segments, a + segments]]
    };
    let triangles: Vec<[u32; 3]> =
        (0..segments).flat_map(|i| (0..segments).flat_map(move |k| quad(i, k))).collect();
    Object {
        mesh: std::sync::Arc::new(rgp_renderer::scene::Mesh { positions, triangles, ..Default::default() }),
        ..object(&[], &[], vec![0], None)
    }
}

#[test]
fn triangles_of_a_mesh_are_chosen_by_what_they_give() {
    // By area alone: 0.8.
    for segments in [10, 60] {
        let tube = Lights::build(&scene(Vec::new(), vec![tube(segments)], 0.0), &[Rgb::splat(1.0)]);
        let noise = noise(&tube);
        assert!(noise < 0.35, "{noise} with {segments} segments");
    }
}

//! Pdfs tell the truth: sampled directions are spread as the pdf of a ray that meets the light says.

mod light_support;

use std::f64::consts::PI;

use glam::Vec3;
use light_support::{KIND, Random, assert_close, irradiance, lamp, meets, object, scene, turned};
use rgp_renderer::color::Rgb;
use rgp_renderer::light::{Lights, Receiver};
use rgp_renderer::scene::{Lamp, LampShape, Scene};

/// Where all of the tests look from.
const FROM: Vec3 = Vec3::new(0.05, 0.1, -0.15);

fn shapes() -> Vec<LampShape> {
    let size = [0.4, 0.25];
    let full = std::f32::consts::PI;
    vec![
        LampShape::Point { radius: 0.2, soft_falloff: false },
        LampShape::Point { radius: 0.2, soft_falloff: true },
        LampShape::Point { radius: 0.9, soft_falloff: false },
        LampShape::Spot { radius: 0.2, soft_falloff: false, cone_angle: 1.2, blend: 0.5 },
        LampShape::Spot { radius: 0.2, soft_falloff: true, cone_angle: 1.2, blend: 0.5 },
        LampShape::Sun { angle: 0.5 },
        LampShape::Rectangle { size, spread: full },
        LampShape::Rectangle { size, spread: 1.4 },
        LampShape::Rectangle { size: [0.005, 0.005], spread: full },
        LampShape::Ellipse { size, spread: full },
        LampShape::Ellipse { size: [0.08, 0.05], spread: full },
        LampShape::Ellipse { size, spread: 2.2 },
        LampShape::Ellipse { size, spread: 0.9 },
    ]
}

/// Less the lamps that few random rays meet.
fn wide_shapes() -> impl Iterator<Item = LampShape> {
    let is_small = |shape: &LampShape| matches!(shape, LampShape::Rectangle { size, .. } | LampShape::Ellipse { size, .. } if size[0] < 0.1);
    shapes().into_iter().filter(move |shape| !is_small(shape))
}

/// A lamp over `FROM`, tilted and stretched.
fn placed(shape: LampShape) -> Lamp {
    turned(Lamp { stretch: [1.3, 0.8], ..lamp(shape, 5.0, Vec3::new(0.0, 0.0, 0.25)) })
}

fn emissive_scene(lamps: Vec<Lamp>) -> (Scene, Vec<Rgb>) {
    let corners =
        [[0.2, 0.0, 0.3], [-0.1, 0.15, 0.2], [-0.1, -0.15, 0.25], [0.0, 0.3, 0.1]].map(Vec3::from_array);
    let place = glam::DAffine3::from_scale_rotation_translation(
        glam::DVec3::new(1.0, 1.4, 0.7),
        glam::DQuat::from_rotation_y(0.3),
        glam::DVec3::new(0.1, 0.0, 0.0),
    );
    let mesh = object(&corners, &[[0, 1, 2], [1, 0, 3]], vec![0, 1], Some(place));
    (scene(lamps, vec![mesh], 0.0), vec![Rgb([3.0, 1.0, 0.0]), Rgb([1.0, 0.0, 9.0])])
}

/// Sum of the radiance and of the pdf of everything a ray from `FROM` meets; the pdf is that of a receiver with this
/// normal.
fn met(scene: &Scene, lights: &Lights, emission: &[Rgb], wi: Vec3, normal: Option<Vec3>) -> (f64, f64) {
    let receiver = Receiver { p: FROM, normal, sets: u32::MAX };
    let (mut radiance, mut pdf) = (0.0, 0.0);
    let mut add = |r: Rgb, p: f32| {
        radiance += f64::from(r.0[0]);
        pdf += f64::from(p);
    };
    lights.lamps_crossed(receiver, wi, 0.0..f32::INFINITY, KIND, &mut |r, p, _| add(r, p));
    lights.suns(receiver, wi, KIND, &mut add);
    for (index, object) in scene.objects.iter().enumerate() {
        for primitive in 0..object.mesh.triangles.len() {
            let corners = object.corners(primitive);
            if let Some(t) = meets(FROM, wi, corners) {
                let p = lights.emitter_pdf(receiver, index as u32, primitive as u32, wi, t as f32);
                add(emission[object.material(primitive)], p);
            }
        }
    }
    (radiance, pdf)
}

/// χ² of sampled directions in cells of (cos θ, φ) about +Z against the pdf integrated over each cell.
#[track_caller]
fn assert_spread_as_pdf(scene: &Scene, emission: &[Rgb], normal: Option<Vec3>, name: &str) {
    const ROWS: usize = 24;
    const COLUMNS: usize = 24;
    const PARTS: usize = 64;
    let lights = Lights::build(scene, emission);
    let receiver = Receiver { p: FROM, normal, sets: u32::MAX };
    let count = 200_000;
    let mut hits = vec![0.0; ROWS * COLUMNS + 1];
    let mut random = Random(9);
    for _ in 0..count {
        let cell = lights.sample_direct(receiver, random.uniforms()).map_or(ROWS * COLUMNS, |sample| {
            let row = ((0.5 - 0.5 * sample.wi.z) * ROWS as f32) as usize;
            let turn = sample.wi.y.atan2(sample.wi.x) / std::f32::consts::TAU + 0.5;
            row.min(ROWS - 1) * COLUMNS + ((turn * COLUMNS as f32) as usize).min(COLUMNS - 1)
        });
        hits[cell] += 1.0;
    }
    let (mut chi_squared, mut cells, mut whole, mut rare) = (0.0, 0.0_f64, 0.0, [0.0; 2]);
    for (cell, &found) in hits.iter().enumerate().take(ROWS * COLUMNS) {
        let mut pdf = 0.0;
        for part in 0..PARTS * PARTS {
            let jitter: [f32; 2] = random.uniforms();
            let [i, j] = jitter.map(f64::from);
            let row = (cell / COLUMNS) as f64 + ((part / PARTS) as f64 + i) / PARTS as f64;
            let column = (cell % COLUMNS) as f64 + ((part % PARTS) as f64 + j) / PARTS as f64;
            let z = 1.0 - 2.0 * row / ROWS as f64;
            let (sin, cos) = (2.0 * PI * (column / COLUMNS as f64 - 0.5)).sin_cos();
            let ring = (1.0 - z * z).sqrt();
            let wi = Vec3::new((ring * cos) as f32, (ring * sin) as f32, z as f32).normalize();
            pdf += met(scene, &lights, emission, wi, normal).1;
        }
        let share = pdf * 4.0 * PI / (ROWS * COLUMNS * PARTS * PARTS) as f64;
        whole += share;
        let expected = share * f64::from(count);
        if expected < 20.0 {
            rare[0] += found;
            rare[1] += expected;
            continue;
        }
        // The integral over a cell the light's edge crosses is known to about 1 %.
        chi_squared += (found - expected).powi(2) / (expected + (0.01 * expected).powi(2));
        cells += 1.0;
    }
    let found = 1.0 - hits[ROWS * COLUMNS] / f64::from(count);
    assert!((found - whole).abs() < 0.01, "{name}: {found} of the samples, pdf integrates to {whole}");
    assert!((rare[0] - rare[1]).abs() < 5.0 * rare[1].sqrt() + 20.0, "{name}: {rare:?} in rare cells");
    assert!(
        cells > 3.0 && chi_squared < cells + 5.0 * (2.0 * cells).sqrt(),
        "{name}: χ² {chi_squared} in {cells}"
    );
}

#[test]
fn each_lamps_directions_are_spread_as_its_pdf_says() {
    for shape in wide_shapes() {
        let name = format!("{shape:?}");
        assert_spread_as_pdf(&scene(vec![placed(shape)], Vec::new(), 0.0), &[], None, &name);
    }
}

#[test]
fn emissive_triangles_directions_are_spread_as_their_pdf_says() {
    let (scene, emission) = emissive_scene(Vec::new());
    assert_spread_as_pdf(&scene, &emission, None, "mesh");
}

#[test]
fn directions_of_many_lights_are_spread_as_their_pdf_says() {
    let (scene, emission) = emissive_scene(wide_shapes().map(placed).collect());
    assert_spread_as_pdf(&scene, &emission, None, "all");
}

#[test]
fn directions_chosen_by_the_tree_are_spread_as_their_pdf_says() {
    let lamps = (0..60).map(|i| {
        let mut lamp = lamp(LampShape::Point { radius: 0.1, soft_falloff: true }, 1.0 + i as f32, Vec3::ZERO);
        lamp.position = Random(i).direction() * 0.4;
        lamp
    });
    let (scene, emission) = emissive_scene(lamps.chain(wide_shapes().map(placed)).collect());
    for normal in [None, Some(Vec3::new(0.6, 0.0, 0.8))] {
        assert_spread_as_pdf(&scene, &emission, normal, &format!("{normal:?}"));
    }
}

#[test]
fn a_sample_and_the_ray_that_meets_it_agree() {
    for shape in shapes() {
        let name = format!("{shape:?}");
        let scene = scene(vec![placed(shape)], Vec::new(), 0.0);
        let lights = Lights::build(&scene, &[]);
        let mut random = Random(21);
        let (mut compared, mut missed) = (0, 0);
        while compared < 2000 {
            let Some(sample) = lights.sample_direct(FROM, random.uniforms()) else { continue };
            compared += 1;
            let (radiance, pdf) = met(&scene, &lights, &[], sample.wi, None);
            if pdf == 0.0 {
                // Rounding may carry a sample over the light's edge.
                missed += 1;
                continue;
            }
            assert_close(pdf, f64::from(sample.pdf_solid_angle), 1e-3);
            let expected = f64::from(sample.radiance_over_pdf.0[0] * sample.pdf_solid_angle);
            assert!(
                (radiance - expected).abs() < 2e-3 * expected + 1e-3,
                "{name}: {radiance}, not {expected}"
            );
        }
        assert!(missed < 20, "{name}: {missed} samples miss the lamp");
    }
}

#[test]
fn rays_that_meet_lights_by_chance_bring_the_same_irradiance() {
    let normal = Vec3::Z;
    for shape in wide_shapes() {
        let name = format!("{shape:?}");
        let scene = scene(vec![placed(shape)], Vec::new(), 0.0);
        let lights = Lights::build(&scene, &[]);
        let (mut random, count, mut sum, mut squares) = (Random(4), 1_000_000, 0.0, 0.0);
        for _ in 0..count {
            let wi = random.direction();
            let value = met(&scene, &lights, &[], wi, None).0 * f64::from(wi.dot(normal).max(0.0)) * 4.0 * PI;
            sum += value;
            squares += value * value;
        }
        let mean = sum / f64::from(count);
        let sigma = ((squares / f64::from(count) - mean * mean) / f64::from(count)).sqrt();
        let expected = irradiance(&lights, FROM, normal, 1, 500);
        assert!((mean - expected).abs() < 4.0 * sigma, "{name}: {mean} ± {sigma}, not {expected}");
        assert!(sigma < 0.02 * mean, "{name}: {mean} ± {sigma}");
    }
}

#[test]
fn proxies_hold_every_lamp() {
    for shape in shapes() {
        let name = format!("{shape:?}");
        let lights = Lights::build(&scene(vec![placed(shape.clone())], Vec::new(), 0.0), &[]);
        let proxies = lights.lamp_proxies();
        let is_sun = matches!(shape, LampShape::Sun { .. });
        assert_eq!(proxies.len(), usize::from(!is_sun));
        assert_eq!(lights.has_lamp_shapes(), !is_sun);
        let mut random = Random(2);
        let mut met = 0;
        for _ in 0..20_000 {
            let from = random.direction() * 0.6;
            let aim = Vec3::new(0.0, 0.0, 0.25) + random.direction() * (0.25 * random.uniform());
            let wi = (aim - from).normalize();
            let mut crossed = false;
            lights.lamps_crossed(from, wi, 0.0..f32::INFINITY, KIND, &mut |_, _, _| crossed = true);
            if crossed {
                met += 1;
                let proxy = &proxies[0];
                let mut faces =
                    proxy.triangles.iter().map(|t| t.map(|v| proxy.positions[v as usize].as_dvec3()));
                assert!(faces.any(|corners| meets(from, wi, corners).is_some()), "{name}: {from} {wi}");
            }
        }
        assert!(is_sun || met > 10, "{name}: {met}");
    }
}

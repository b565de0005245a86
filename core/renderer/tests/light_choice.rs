//! Which lights are asked, which are left out, and what odd input does.

mod light_support;

use glam::Vec3;
use light_support::{KIND, Random, assert_close, irradiance, lamp, object, one_lamp, scene, turned};
use proptest::prelude::*;
use rgp_renderer::color::Rgb;
use rgp_renderer::light::Lights;
use rgp_renderer::scene::{Lamp, LampShape, visibility};

const FULL: f32 = std::f32::consts::PI;
const POINT: LampShape = LampShape::Point { radius: 0.1, soft_falloff: false };
const PANEL: LampShape = LampShape::Rectangle { size: [0.3, 0.2], spread: FULL };

/// Number of lamps a ray from `from` along `wi` meets, suns included.
fn crossed(lights: &Lights, from: Vec3, wi: Vec3, t_max: f32, kind: u32) -> usize {
    let mut count = 0;
    lights.lamps_crossed(from, wi, 0.0..t_max, kind, &mut |_, _, _| count += 1);
    lights.suns(from, wi, kind, &mut |_, _| count += 1);
    count
}

#[test]
fn a_scene_without_light_is_empty() {
    let dark = |lamps, objects, emission: &[Rgb]| Lights::build(&scene(lamps, objects, 0.0), emission);
    let triangle = |material| object(&[Vec3::ZERO, Vec3::X, Vec3::Y], &[[0, 1, 2]], vec![material], None);
    let emission = [Rgb::BLACK, Rgb([0.0, 0.0, 1.0])];
    let zero = lamp(POINT, 0.0, Vec3::Z);
    for lights in [dark(vec![], vec![], &[]), dark(vec![zero], vec![triangle(0)], &emission)] {
        assert!(lights.is_empty());
        assert!(lights.total_flux().is_black());
        assert!(lights.emit([0.5; 5]).is_none());
        assert!(lights.sample_direct(Vec3::ZERO, [0.5; 3]).is_none());
    }
    let blue = dark(vec![], vec![triangle(0), triangle(1)], &emission);
    assert!(!blue.is_empty());
    assert_eq!(blue.emitter_pdf(Vec3::Z, 0, 0, Vec3::NEG_Z, 1.0), 0.0);
    assert!(blue.emitter_pdf(Vec3::Z, 1, 0, Vec3::NEG_Z, 1.0) > 0.0);
    assert!(!Lights::build(&scene(vec![], vec![], 1.0), &[]).is_empty());
    assert!(!Lights::build(&scene(vec![lamp(POINT, 1.0, Vec3::Z)], vec![], 0.0), &[]).is_empty());
}

#[test]
fn two_half_lamps_are_one() {
    let p = Vec3::new(0.1, 0.2, -0.3);
    for shape in
        [POINT, PANEL, LampShape::Sun { angle: 0.1 }, LampShape::Point { radius: 0.0, soft_falloff: true }]
    {
        let lamp = |power| turned(lamp(shape.clone(), power, Vec3::new(0.0, 0.0, 0.3)));
        let one = one_lamp(lamp(8.0));
        for parts in [2, 64, 128] {
            let many = vec![lamp(8.0 / parts as f32); parts];
            let many = Lights::build(&scene(many, Vec::new(), 0.0), &[]);
            let expected = irradiance(&one, p, Vec3::Z, 1, 64);
            assert_close(irradiance(&many, p, Vec3::Z, parts, 64), expected, 1e-4);
            assert_close(f64::from(many.total_flux().0[0]), f64::from(one.total_flux().0[0]), 1e-5);
        }
    }
}

#[test]
fn lights_add_up_however_they_are_chosen() {
    // A strong lamp far away beside a weak one near by, few and many.
    let p = Vec3::new(0.0, 0.0, -0.4);
    let strong = lamp(PANEL, 100.0, Vec3::new(0.0, 0.3, 5.0));
    let weak = lamp(POINT, 0.2, Vec3::new(0.1, 0.0, -0.2));
    let spot = LampShape::Spot { radius: 0.0, soft_falloff: false, cone_angle: 0.2, blend: 0.1 };
    let away = lamp(spot, 100.0, Vec3::new(0.4, 0.4, 0.0));
    let apart: f64 = [&strong, &weak, &away]
        .map(|lamp| irradiance(&one_lamp(lamp.clone()), p, Vec3::Z, 1, 200))
        .iter()
        .sum();
    for copies in [1, 40] {
        let mut lamps = vec![strong.clone(), weak.clone(), away.clone()];
        lamps.extend(vec![lamp(PANEL, 1e-6, Vec3::new(0.0, 0.0, -0.5)); 2 * copies]);
        let lights = Lights::build(&scene(lamps, Vec::new(), 0.0), &[]);
        assert_close(irradiance(&lights, p, Vec3::Z, 40_000, 8), apart, 2e-3);
    }
}

#[test]
fn the_choice_follows_what_each_light_gives() {
    // The near lamp gives 100 times the light of the far one: of 99 samples out of 100 less the even tenth, 94.
    let lamps = [Vec3::new(0.0, 0.0, 0.1), Vec3::new(0.0, 0.0, 1.0)];
    let shape = LampShape::Point { radius: 0.0, soft_falloff: false };
    let lights =
        Lights::build(&scene(lamps.map(|p| lamp(shape.clone(), 1.0, p)).to_vec(), Vec::new(), 0.0), &[]);
    let near = (0..1000)
        .filter(|&i| lights.sample_direct(Vec3::ZERO, [i as f32 / 1000.0, 0.5, 0.5]).unwrap().distance < 0.5)
        .count();
    assert!((935..=947).contains(&near), "{near}");
}

#[test]
fn lamps_hidden_from_a_ray_kind_are_not_met() {
    for shape in [POINT, PANEL, LampShape::Sun { angle: 0.1 }] {
        let mut lamp = lamp(shape, 1.0, Vec3::new(0.0, 0.0, 0.3));
        lamp.visibility = visibility::DIFFUSE;
        let lights = one_lamp(lamp);
        let met = |kind| crossed(&lights, Vec3::ZERO, Vec3::Z, f32::INFINITY, kind);
        assert_eq!((met(visibility::DIFFUSE), met(visibility::GLOSSY)), (1, 0));
        assert_eq!(lights.sample_direct(Vec3::ZERO, [0.5; 3]).unwrap().visibility, visibility::DIFFUSE);
    }
}

#[test]
fn lamps_are_met_before_the_end_of_the_ray_and_from_the_front() {
    let lights = one_lamp(lamp(PANEL, 1.0, Vec3::new(0.0, 0.0, 0.3)));
    assert_eq!(crossed(&lights, Vec3::ZERO, Vec3::Z, 0.31, KIND), 1);
    assert_eq!(crossed(&lights, Vec3::ZERO, Vec3::Z, 0.29, KIND), 0);
    assert_eq!(crossed(&lights, Vec3::ZERO, Vec3::NEG_Z, 9.0, KIND), 0);
    assert_eq!(crossed(&lights, Vec3::Z, Vec3::NEG_Z, 9.0, KIND), 0);
    assert_eq!(crossed(&lights, Vec3::new(0.16, 0.0, 0.0), Vec3::Z, 9.0, KIND), 0);
    let lights = one_lamp(lamp(POINT, 1.0, Vec3::new(0.0, 0.0, 0.3)));
    assert_eq!(crossed(&lights, Vec3::ZERO, Vec3::Z, 0.21, KIND), 1);
    assert_eq!(crossed(&lights, Vec3::ZERO, Vec3::Z, 0.19, KIND), 0);
    assert_eq!(crossed(&lights, Vec3::ZERO, Vec3::NEG_Z, 9.0, KIND), 0);
}

#[test]
fn lamps_without_shadows_are_left_to_direct_sampling() {
    for shape in [POINT, PANEL, LampShape::Sun { angle: 0.1 }] {
        let mut lamp = lamp(shape, 1.0, Vec3::new(0.0, 0.0, 0.3));
        lamp.casts_shadow = false;
        let lights = one_lamp(lamp);
        assert_eq!(crossed(&lights, Vec3::ZERO, Vec3::Z, 9.0, KIND), 0);
        assert!(!lights.has_lamp_shapes());
        let sample = lights.sample_direct(Vec3::ZERO, [0.5; 3]).unwrap();
        assert!(sample.is_delta && sample.blockers == 0);
        assert_eq!(lights.emit([0.5; 5]).unwrap().blockers, 0);
    }
}

#[test]
fn photons_do_not_start_at_a_world_that_no_surface_sees() {
    let mut scene = scene(vec![lamp(POINT, 3.0, Vec3::ZERO)], Vec::new(), 5.0);
    scene.world.visibility = visibility::CAMERA;
    assert_close(f64::from(Lights::build(&scene, &[]).total_flux().0[0]), 3.0, 1e-6);
    scene.world.visibility = visibility::CAMERA | visibility::GLOSSY;
    assert!(Lights::build(&scene, &[]).total_flux().0[0] > 3.1);
}

/// Numbers a file may hold.
fn odd_number() -> impl Strategy<Value = f32> {
    prop_oneof![
        3 => -2.0_f32..2.0,
        1 => prop::sample::select(vec![
            0.0, -0.0, 1e-30, -1e-30, 1e-6, 1e6, 1e20, 1e38, f32::MAX, f32::NAN, f32::INFINITY, f32::NEG_INFINITY, FULL,
        ]),
    ]
}

fn odd_shape() -> impl Strategy<Value = LampShape> {
    (0..5, any::<bool>(), odd_number(), odd_number(), odd_number()).prop_map(
        |(kind, soft_falloff, a, b, c)| match kind {
            0 => LampShape::Point { radius: a, soft_falloff },
            1 => LampShape::Spot { radius: a, soft_falloff, cone_angle: b, blend: c },
            2 => LampShape::Sun { angle: a },
            3 => LampShape::Rectangle { size: [a, b], spread: c },
            _ => LampShape::Ellipse { size: [a, b], spread: c },
        },
    )
}

fn odd_vector() -> impl Strategy<Value = Vec3> {
    prop_oneof![
        4 => (-0.5_f32..0.5, -0.5_f32..0.5, -0.5_f32..0.5).prop_map(Vec3::from),
        1 => (odd_number(), odd_number(), odd_number()).prop_map(Vec3::from),
    ]
}

fn odd_lamp() -> impl Strategy<Value = Lamp> {
    (odd_shape(), odd_number(), odd_number(), odd_vector(), odd_vector(), odd_vector()).prop_map(
        |(shape, red, blue, position, x_axis, axis)| {
            let power = Rgb([red, 1.0, blue]);
            Lamp { power, x_axis, axis, ..lamp(shape, 1.0, position) }
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn odd_input_never_gives_a_number_that_is_none(
        lamps in prop::collection::vec(odd_lamp(), 1..4),
        corners in prop::array::uniform3(odd_vector()),
        emission in odd_number(),
        from in (-0.5_f32..0.5, -0.5_f32..0.5, -0.5_f32..0.5).prop_map(Vec3::from),
        copies in prop::sample::select(vec![1_usize, 40]),
        seed in any::<u64>(),
    ) {
        let mesh = object(&corners, &[[0, 1, 2], [1, 1, 2]], vec![0, 0], None);
        let lights = Lights::build(&scene(vec![lamps; copies].concat(), vec![mesh], emission), &[Rgb::splat(emission)]);
        prop_assert!(lights.total_flux().0.iter().all(|c| *c >= 0.0 && c.is_finite()));
        for proxy in lights.lamp_proxies() {
            prop_assert!(proxy.triangles.iter().flatten().all(|&v| (v as usize) < proxy.positions.len()));
        }
        let mut random = Random(seed);
        let edges = [0.0, 0.5, 1.0 - f32::EPSILON / 2.0];
        for turn in 0..30 {
            let mut u: [f32; 5] = random.uniforms();
            u[turn % 5] = edges[turn % 3];
            if let Some(photon) = lights.emit(u) {
                prop_assert!(photon.flux.0.iter().all(|c| *c >= 0.0 && c.is_finite()), "{photon:?}");
                prop_assert!(photon.origin.is_finite() && (photon.direction.length() - 1.0).abs() < 1e-4, "{photon:?}");
                prop_assert!(photon.lit_from >= 0.0);
            }
            if let Some(sample) = lights.sample_direct(from, [u[0], u[1], u[2]]) {
                prop_assert!(sample.radiance_over_pdf.0.iter().all(|c| *c >= 0.0 && c.is_finite()), "{sample:?}");
                prop_assert!((sample.wi.length() - 1.0).abs() < 1e-4 && sample.distance >= 0.0, "{sample:?}");
                prop_assert!(sample.pdf_solid_angle > 0.0, "{sample:?}");
                let mut fine = true;
                let mut check = |radiance: Rgb, pdf: f32| {
                    fine &= radiance.0.iter().all(|c| *c >= 0.0 && c.is_finite()) && pdf >= 0.0;
                };
                lights.lamps_crossed(from, sample.wi, 0.0..f32::INFINITY, KIND, &mut |r, pdf, _| check(r, pdf));
                lights.suns(from, sample.wi, KIND, &mut check);
                prop_assert!(fine, "{sample:?}");
            }
        }
    }
}

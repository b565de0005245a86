//! Lamps whose nodes compute their light: what surfaces, rays and photons get of it.

mod light_support;

use std::f64::consts::PI;

use glam::{DVec3, Vec3};
use light_support::{
    KIND, Random, asked, assert_close, irradiance, lamp, one_lamp, polygon_irradiance, scene, turned,
    vector_math, with_nodes,
};
use rgp_renderer::light::Lights;
use rgp_renderer::scene::{Lamp, LampShape};
use rgp_renderer::shader::{Instruction, MathFunction, Quantity, VectorFunction};

const POWER: f32 = 10.0;
const SIZE: [f32; 2] = [0.4, 0.2];

fn rectangle() -> Lamp {
    let spread = std::f32::consts::PI;
    lamp(LampShape::Rectangle { size: SIZE, spread }, POWER, Vec3::new(0.0, 0.0, 0.3))
}

fn shapes() -> Vec<LampShape> {
    let spread = std::f32::consts::PI;
    vec![
        LampShape::Point { radius: 0.0, soft_falloff: false },
        LampShape::Point { radius: 0.1, soft_falloff: false },
        LampShape::Point { radius: 0.1, soft_falloff: true },
        LampShape::Spot { radius: 0.1, soft_falloff: false, cone_angle: 1.4, blend: 0.3 },
        LampShape::Sun { angle: 0.3 },
        LampShape::Rectangle { size: SIZE, spread },
        LampShape::Ellipse { size: SIZE, spread: 1.5 },
    ]
}

fn constant(value: f32) -> Instruction {
    Instruction::Constant { value: [value; 4] }
}

/// Integral of x h² / r⁴ over a rectangle of the plane at height h, its edges seen from the foot of the perpendicular.
fn first_moment([x0, x1]: [f64; 2], [y0, y1]: [f64; 2], h: f64) -> f64 {
    let part = |x: f64| {
        let a = x.hypot(h);
        ((y1 / a).atan() - (y0 / a).atan()) / a
    };
    -0.5 * h * h * (part(x1) - part(x0))
}

/// Radiance is P / (π A) times u = x / w + 1/2: the irradiance of a plane is known in closed form.
#[test]
fn light_that_grows_along_a_lamp_has_a_closed_form_on_a_plane() {
    let instructions = vec![
        asked(Quantity::Parametric),
        Instruction::Channel { of: 0, channel: 0 },
        constant(1.0),
        vector_math(VectorFunction::Multiply, 1, 2),
    ];
    let lights = one_lamp(with_nodes(rectangle(), instructions));
    let [w, h] = SIZE.map(|side| 0.5 * f64::from(side));
    let height = f64::from(0.3_f32 + 0.2);
    for p in [Vec3::new(0.0, 0.0, -0.2), Vec3::new(0.25, 0.1, -0.2), Vec3::new(-0.4, 0.0, -0.2)] {
        let at = p.as_dvec3();
        let corners = [[-w, -h], [-w, h], [w, h], [w, -h]].map(|[x, y]| DVec3::new(x, y, f64::from(0.3_f32)));
        let even = polygon_irradiance(at, DVec3::Z, &corners).abs();
        let moment = first_moment([-w - at.x, w - at.x], [-h - at.y, h - at.y], height);
        let radiance = f64::from(POWER) / (PI * 4.0 * w * h);
        let expected = radiance * ((0.5 + at.x / (2.0 * w)) * even + moment / (2.0 * w));
        assert_close(irradiance(&lights, p, Vec3::Z, 1, 64), expected, 1e-3);
    }
}

/// A factor of 2 everywhere is twice the light, of photons and surfaces alike; of red alone it is twice the red.
#[test]
fn a_constant_factor_multiplies_the_light() {
    for shape in shapes() {
        let plain = turned(lamp(shape, POWER, Vec3::new(0.0, 0.1, 0.3)));
        let twice = one_lamp(with_nodes(plain.clone(), vec![constant(2.0)]));
        let red =
            one_lamp(with_nodes(plain.clone(), vec![Instruction::Constant { value: [2.0, 1.0, 1.0, 1.0] }]));
        let once = one_lamp(plain);
        let flux = |lights: &Lights, channel: usize| f64::from(lights.total_flux().0[channel]);
        // One look in 513 is at a factor of 1.
        assert_close(flux(&twice, 1), 2.0 * flux(&once, 1), 2e-3);
        assert_close(flux(&red, 0), 2.0 * flux(&once, 0), 2e-3);
        assert_close(flux(&red, 1), flux(&once, 1), 2e-3);
        let mut random = Random(2);
        for _ in 0..200 {
            let u = random.uniforms();
            let p = Vec3::new(0.1, 0.0, -0.2);
            let [a, b] = [&once, &twice].map(|lights| lights.sample_direct(p, u));
            assert_eq!(a.is_some(), b.is_some());
            if let (Some(a), Some(b)) = (a, b) {
                assert_close(
                    f64::from(b.radiance_over_pdf.0[0]),
                    2.0 * f64::from(a.radiance_over_pdf.0[0]),
                    1e-5,
                );
            }
            let u = random.uniforms();
            let [a, b] = [&once, &twice].map(|lights| {
                let photon = lights.emit(u).unwrap();
                let p = photon.origin + photon.direction * 0.5;
                (photon.direction, lights.arrived(photon.flux, photon.shaded, photon.direction, p))
            });
            assert_eq!(a.0, b.0);
            assert_close(f64::from(b.1.0[0]), 2.0 * f64::from(a.1.0[0]), 1e-5);
        }
    }
}

/// A ray that meets a lamp sees the radiance that a shadow ray to the same place brings.
#[test]
fn rays_that_meet_a_lamp_see_what_shadow_rays_bring() {
    let instructions = vec![
        asked(Quantity::Parametric),
        asked(Quantity::ObjectNormal),
        vector_math(VectorFunction::Add, 0, 1),
        constant(2.0),
        vector_math(VectorFunction::Add, 2, 3),
    ];
    let mut met = 0;
    for shape in shapes() {
        let lights =
            one_lamp(with_nodes(turned(lamp(shape, POWER, Vec3::new(0.0, 0.1, 0.3))), instructions.clone()));
        let p = Vec3::new(0.1, 0.0, -0.2);
        let mut random = Random(4);
        for _ in 0..200 {
            let Some(sample) = lights.sample_direct(p, random.uniforms()) else { continue };
            let mut compare = |radiance: rgp_renderer::color::Rgb, pdf: f32| {
                met += 1;
                let expected = sample.radiance_over_pdf * sample.pdf_solid_angle;
                for channel in 0..3 {
                    assert_close(f64::from(radiance.0[channel]), f64::from(expected.0[channel]), 2e-3);
                }
                assert_close(f64::from(pdf), f64::from(sample.pdf_solid_angle), 1e-3);
            };
            lights.lamps_crossed(p, sample.wi, 0.0..f32::INFINITY, KIND, &mut |r, pdf, _| compare(r, pdf));
            lights.suns(p, sample.wi, KIND, &mut compare);
        }
    }
    assert!(met > 500, "{met}");
}

/// A lamp that Blender's Light Falloff makes constant: the irradiance of a facing surface is the same at every distance.
#[test]
fn light_may_depend_on_the_distance() {
    let point = lamp(LampShape::Point { radius: 0.0, soft_falloff: false }, POWER, Vec3::ZERO);
    let instructions = vec![asked(Quantity::RayLength), vector_math(VectorFunction::Multiply, 0, 0)];
    let lights = one_lamp(with_nodes(point, instructions));
    for distance in [0.1, 0.3, 0.45] {
        let p = Vec3::new(0.0, 0.0, -distance);
        assert_close(irradiance(&lights, p, Vec3::Z, 1, 1), f64::from(POWER) / (4.0 * PI), 1e-5);
    }
}

/// What is no number gives no light; what is enormous stays within the range of numbers.
#[test]
fn nodes_that_give_no_numbers_give_no_light() {
    for (value, is_lit) in
        [(f32::NAN, false), (f32::INFINITY, false), (-1.0, false), (1e38, false), (1e30, true)]
    {
        for shape in shapes() {
            let nodes = vec![
                asked(Quantity::RayLength),
                constant(value),
                constant(1.0),
                Instruction::Math { function: MathFunction::Multiply, a: 1, b: 2, c: 0 },
            ];
            let bad = with_nodes(lamp(shape.clone(), 1e8, Vec3::new(0.0, 0.0, 0.3)), nodes);
            let good = lamp(LampShape::Sun { angle: 0.0 }, 1.0, Vec3::ZERO);
            let lights = Lights::build(&scene(vec![bad, good], Vec::new(), 0.0), &[]);
            assert!(lights.total_flux().is_finite() && lights.total_flux().0.iter().all(|&c| c > 0.0));
            let (mut random, mut brightest) = (Random(9), 0.0_f32);
            for _ in 0..500 {
                let p = Vec3::new(0.05, 0.0, -0.2);
                if let Some(sample) = lights.sample_direct(p, random.uniforms()) {
                    assert!(sample.radiance_over_pdf.is_finite(), "{value} {shape:?}");
                    brightest = brightest.max(sample.radiance_over_pdf.0[0]);
                }
                let photon = lights.emit(random.uniforms()).unwrap();
                let p = photon.origin + photon.direction * 0.4;
                assert!(lights.arrived(photon.flux, photon.shaded, photon.direction, p).is_finite());
            }
            assert_eq!(brightest > 1e3, is_lit, "{value} {shape:?}: {brightest}");
        }
    }
}

/// A lamp that shines through a pinhole is still chosen beside another.
#[test]
fn a_lamp_that_shines_hardly_anywhere_is_still_found() {
    // Bright where u is within a ten-thousandth of its middle.
    let compare = |function, a, b| Instruction::Math { function, a, b, c: 0 };
    let instructions = vec![
        asked(Quantity::Parametric),
        Instruction::Channel { of: 0, channel: 0 },
        constant(0.5),
        compare(MathFunction::Subtract, 1, 2),
        compare(MathFunction::Absolute, 3, 3),
        constant(5e-5),
        compare(MathFunction::LessThan, 4, 5),
    ];
    let pinhole = with_nodes(rectangle(), instructions);
    let lights = Lights::build(&scene(vec![pinhole, rectangle()], Vec::new(), 0.0), &[]);
    let p = Vec3::new(0.0, 0.0, -0.2);
    // Samples in the middle of either: what is chosen rarely counts for more.
    let samples = (0..1000).filter_map(|i| lights.sample_direct(p, [i as f32 / 1000.0, 0.5, 0.5]));
    let radiances: Vec<f32> = samples.map(|sample| sample.radiance_over_pdf.0[0]).collect();
    let rare = radiances.iter().filter(|&&radiance| radiance > 5.0 * radiances[999]).count();
    // A tenth of every choice is even, and one look in 513 counts as bright.
    assert_eq!(radiances.len(), 1000);
    assert!((45..60).contains(&rare), "{rare}");
}

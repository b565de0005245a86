//! Reflections that are not the same along the surface: alphas along a tangent and across it.

mod bsdf_support;

use std::f32::consts::{PI, TAU};

use bsdf_support::{
    IMPORTANCE, RADIANCE, Rng, at, chi_square, diffuse, glossy, prepared, principled, sampled_albedo,
    significance,
};
use glam::{Quat, Vec3};
use rgp_renderer::bsdf::{Bsdf, LobeSet, MaterialTable};
use rgp_renderer::color::Rgb;
use rgp_renderer::scene::record::{ClosureRecord, NormalRecord, TangentRecord, WeightedClosure};
use rgp_renderer::scene::{Material, MaterialProgram};
use rgp_renderer::shader::{Instruction, Program, Value};

/// A material of equal shares that have one tangent; `normal` is the first one's own, should it have one.
struct Brushed {
    table: MaterialTable,
    tangent: Vec3,
    normal: Option<Vec3>,
}

impl Brushed {
    fn new(closures: &[ClosureRecord], tangent: Vec3, normal: Option<Vec3>) -> Self {
        let weight = Rgb::splat(1.0 / closures.len() as f32);
        let program = MaterialProgram {
            program: Program::new(vec![Instruction::Constant { value: [0.0; 4] }], 0).expect("a program"),
            outputs: Vec::new(),
            normal: None,
            normals: normal
                .map(|_| NormalRecord { closure: 0, coat: false, register: 0 })
                .into_iter()
                .collect(),
            tangents: (0..closures.len()).map(|closure| TangentRecord { closure, register: 0 }).collect(),
        };
        let closures = closures.iter().map(|closure| WeightedClosure { weight, closure: closure.clone() });
        let material = Material {
            name: "test".into(),
            closures: closures.collect(),
            program: Some(program),
            absorption: Rgb::BLACK,
        };
        Self { table: MaterialTable::build(&[material]), tangent, normal }
    }

    fn one(closure: ClosureRecord, tangent: Vec3) -> Self {
        Self::new(&[closure], tangent, None)
    }

    /// Its BSDF on a surface that faces +z.
    fn seen(&self, wo: Vec3) -> Bsdf<'_> {
        let material = &self.table[0];
        let registers = std::iter::once(Value::vector(self.tangent)).collect();
        let normals: Vec<Vec3> = std::iter::once(Vec3::Z).chain(self.normal).collect();
        let here = material.at(material.varying().expect("a program"), &registers, &normals);
        here.into_bsdf(wo, Vec3::Z, Vec3::Z)
    }
}

/// A Glossy BSDF of one scattering event.
fn brushed(roughness: f32, anisotropy: f32, rotation: f32) -> ClosureRecord {
    ClosureRecord::Glossy { color: Rgb::WHITE, roughness, anisotropy, rotation, multiscatter: false }
}

/// The Glossy BSDF of these alphas along the tangent and across it.
fn of_alphas(along: f32, across: f32, multiscatter: bool) -> ClosureRecord {
    let narrow = (along.min(across) / along.max(across)).sqrt();
    let anisotropy = if along < across { 1.0 - narrow } else { narrow - 1.0 };
    let roughness = (along * across).sqrt().sqrt();
    ClosureRecord::Glossy { color: Rgb::WHITE, roughness, anisotropy, rotation: 0.0, multiscatter }
}

/// Direction at `cos` from +z and a longitude.
fn around(cos: f32, phi: f32) -> Vec3 {
    Quat::from_rotation_z(phi) * at(cos)
}

fn above(rng: &mut Rng) -> Vec3 {
    let direction = rng.direction();
    Vec3::new(direction.x, direction.y, direction.z.abs().max(0.03)).normalize()
}

fn assert_close(found: Rgb, expected: Rgb, part: f32, what: &str) {
    let apart = (found - expected).map(f32::abs).max_channel();
    assert!(apart <= part * expected.max_channel() + 1e-6, "{what}: {found:?} against {expected:?}");
}

fn materials() -> Vec<(&'static str, Brushed)> {
    let tangent = Vec3::new(0.5, -2.0, 0.7);
    let metal = principled(|p| {
        (p.metallic, p.roughness) = (0.8, 0.4);
        (p.anisotropic, p.anisotropic_rotation) = (0.9, 0.15);
    });
    let all = principled(|p| {
        (p.metallic, p.transmission_weight, p.coat_weight, p.roughness) = (0.3, 0.4, 0.6, 0.5);
        (p.anisotropic, p.anisotropic_rotation, p.coat_roughness) = (0.6, 0.4, 0.3);
    });
    let leaning = Some(Vec3::new(0.3, 0.1, 0.9).normalize());
    vec![
        ("a little", Brushed::one(brushed(0.7, 0.3, 0.0), tangent)),
        ("along", Brushed::one(brushed(0.5, -0.6, 0.2), tangent)),
        ("much", Brushed::one(brushed(0.4, 0.8, 0.7), tangent)),
        ("capped", Brushed::one(brushed(0.9, -0.6, 0.2), tangent)),
        ("metal", Brushed::one(metal, tangent)),
        ("everything", Brushed::one(all.clone(), tangent)),
        ("bumped", Brushed::new(&[brushed(0.5, 0.5, 0.1), diffuse(0.5)], tangent, leaning)),
        ("all bumped", Brushed::new(&[all, diffuse(0.5)], tangent, leaning)),
    ]
}

#[test]
fn directions_are_drawn_from_their_density() {
    let (materials, cosines) = (materials(), [1.0, 0.8, 0.4, 0.1]);
    let level = significance(materials.len() * cosines.len());
    for (seed, (name, material)) in (0..).zip(&materials) {
        for cos in cosines {
            let wo = around(cos, 1.0 + seed as f32);
            let mirrored = Vec3::new(-wo.x, -wo.y, wo.z);
            let p = chi_square(&material.seen(wo), LobeSet::NON_DELTA, [mirrored, -wo], seed);
            assert!(p > level, "{name} at cosine {cos}: p = {p:.2e}, below {level:.2e}");
        }
    }
}

/// With the microfacets' slope s times the alpha in one direction, D is 1 / (π a b cos⁴ (1 + s²)²); head-on nothing is masked,
/// and Λ of the other direction is that of its own plane.
#[test]
fn slopes_along_and_across_have_the_closed_form() {
    for (along, across) in [(0.6_f32, 0.2_f32), (0.1, 0.9)] {
        let material = Brushed::one(of_alphas(along, across, false), Vec3::X);
        for (axis, alpha) in [(Vec3::X, along), (Vec3::Y, across)] {
            for slope in [0.0, 0.3] {
                let h = (Vec3::Z + axis * (slope * alpha)).normalize();
                let wi = h * (2.0 * h.z) - Vec3::Z;
                let d = 1.0 / (PI * along * across * h.z.powi(4) * (1.0_f32 + slope * slope).powi(2));
                let tan_i = wi.dot(axis) / wi.z;
                let lambda_i = 0.5 * ((1.0 + (alpha * tan_i).powi(2)).sqrt() - 1.0);
                let expected = d / (4.0 * wi.z * (1.0 + lambda_i));
                let found = material.seen(Vec3::Z).eval(wi, LobeSet::ALL, RADIANCE);
                assert_close(found, Rgb::splat(expected), 1e-3, &format!("{along} {across} {slope}"));
            }
        }
    }
}

/// Aspect of Principled: √(1 - 0.9 anisotropic), alpha over it along the tangent and times it across.
#[test]
fn principled_has_the_aspect_of_blender() {
    let metal = principled(|p| {
        (p.base_color, p.metallic, p.roughness) = (Rgb::WHITE, 1.0, 0.5);
        (p.anisotropic, p.multiscatter) = (0.8, false);
    });
    let aspect = 0.28_f32.sqrt();
    let [metal, glossy] = [metal, of_alphas(0.25 / aspect, 0.25 * aspect, false)]
        .map(|closure| Brushed::one(closure, Vec3::new(0.6, 0.8, 0.0)));
    let mut rng = Rng(4);
    for _ in 0..500 {
        let (wo, wi) = (above(&mut rng), above(&mut rng));
        let [found, expected] = [&metal, &glossy].map(|m| m.seen(wo).eval(wi, LobeSet::ALL, RADIANCE));
        assert_close(found, expected, 2e-3, "white metal is Glossy");
    }
}

#[test]
fn light_goes_the_same_way_back() {
    let mut rng = Rng(11);
    for (name, material) in materials() {
        for _ in 0..500 {
            let (wo, wi) = (above(&mut rng), above(&mut rng));
            let photon = material.seen(wo).eval(wi, LobeSet::ALL, IMPORTANCE);
            let viewer = material.seen(wi).eval(wo, LobeSet::ALL, RADIANCE);
            assert_close(photon, viewer, 1e-3, name);
        }
    }
    // Of one scattering event alone it does so without a photon's frame.
    for closure in [brushed(0.5, 0.7, 0.3), brushed(0.8, -0.4, 0.0)] {
        let material = Brushed::one(closure, Vec3::new(0.3, 1.0, 0.0));
        for _ in 0..500 {
            let (wo, wi) = (above(&mut rng), above(&mut rng));
            let there = material.seen(wo).eval(wi, LobeSet::ALL, RADIANCE);
            assert_close(there, material.seen(wi).eval(wo, LobeSet::ALL, RADIANCE), 1e-3, "one event");
        }
    }
}

#[test]
fn a_quarter_turn_swaps_the_alphas() {
    let mut rng = Rng(12);
    for anisotropy in [0.3, 0.7] {
        let same = [
            Brushed::one(brushed(0.6, anisotropy, 0.0), Vec3::X),
            Brushed::one(brushed(0.6, -anisotropy, 0.0), Vec3::Y),
            Brushed::one(brushed(0.6, -anisotropy, 0.25), Vec3::X),
            Brushed::one(brushed(0.6, anisotropy, 3.5), Vec3::NEG_X),
        ];
        for _ in 0..300 {
            let (wo, wi) = (above(&mut rng), above(&mut rng));
            let [first, others @ ..] = same.each_ref().map(|m| m.seen(wo).eval(wi, LobeSet::ALL, RADIANCE));
            for other in others {
                assert_close(other, first, 5e-3, "turned");
            }
        }
    }
}

/// The tangent turns about the normal on the viewer's side, as in Cycles: seen from behind the other way round.
#[test]
fn rotation_follows_the_side_of_the_viewer() {
    let [front, back] = [0.1, -0.1].map(|turns| Brushed::one(brushed(0.5, 0.7, turns), Vec3::X));
    let mirrored = |v: Vec3| Vec3::new(v.x, v.y, -v.z);
    let mut rng = Rng(13);
    for _ in 0..300 {
        let (wo, wi) = (above(&mut rng), above(&mut rng));
        let expected = front.seen(wo).eval(wi, LobeSet::ALL, RADIANCE);
        let found = back.seen(mirrored(wo)).eval(mirrored(wi), LobeSet::ALL, RADIANCE);
        assert_close(found, expected, 5e-3, "from behind");
    }
}

#[test]
fn none_is_the_isotropic_lobe_bit_by_bit() {
    let mut rng = Rng(14);
    for closure in [glossy(0.8, 0.6), glossy(0.8, 0.2), principled(|p| p.metallic = 0.5)] {
        let (plain, tangible) = (prepared(closure.clone()), Brushed::one(closure, Vec3::X));
        for _ in 0..300 {
            let (wo, wi, u) = (above(&mut rng), above(&mut rng), [rng.next(), rng.next()]);
            let (a, b) = (plain.bsdf(wo, Vec3::Z, Vec3::Z), tangible.seen(wo));
            assert_eq!(a.eval_with_pdf(wi, LobeSet::ALL), b.eval_with_pdf(wi, LobeSet::ALL));
            let directions = [a, b].map(|bsdf| bsdf.sample(0.4, u, LobeSet::ALL, RADIANCE).map(|s| s.wi));
            assert_eq!(directions[0], directions[1]);
        }
    }
}

/// Such as at the poles that a tangent goes around, and without a UV map.
#[test]
fn without_a_direction_it_is_isotropic_of_the_mean_alpha() {
    let mut rng = Rng(15);
    let isotropic = prepared(brushed((0.6_f32 * 0.2).sqrt().sqrt(), 0.0, 0.0));
    for tangent in [Vec3::ZERO, Vec3::Z, Vec3::NAN, Vec3::INFINITY, Vec3::splat(1e-30), Vec3::NEG_Z * 1e20] {
        let material = Brushed::one(of_alphas(0.6, 0.2, false), tangent);
        for _ in 0..100 {
            let (wo, wi) = (above(&mut rng), above(&mut rng));
            let expected = isotropic.bsdf(wo, Vec3::Z, Vec3::Z).eval(wi, LobeSet::ALL, RADIANCE);
            assert_close(material.seen(wo).eval(wi, LobeSet::ALL, RADIANCE), expected, 1e-3, "no direction");
        }
    }
}

/// Shares of light that white returns, from an independent integration of GGX with these alphas over that of
/// their mean: what Cycles makes up for is what the mean loses.
#[test]
fn white_returns_what_the_mean_alpha_makes_up_for() {
    let quarter = TAU / 4.0;
    let known = [
        ([0.3, 0.1], [(0.1, 0.0, 1.031), (0.1, quarter, 0.939), (0.6, 0.0, 0.947), (0.6, quarter, 0.987)]),
        ([0.6, 0.2], [(0.1, 0.0, 1.022), (0.1, quarter, 0.863), (0.6, 0.0, 0.945), (0.6, quarter, 0.904)]),
        ([1.0, 0.1], [(0.1, 0.0, 0.971), (0.1, quarter, 0.607), (0.6, 0.0, 0.756), (0.6, quarter, 0.643)]),
    ];
    for ([along, across], shares) in known {
        let material = Brushed::one(of_alphas(along, across, true), Vec3::X);
        for (cos, phi, expected) in shares {
            let found = sampled_albedo(&material.seen(around(cos, phi)), LobeSet::ALL, RADIANCE, 32);
            assert!((found - expected).abs() < 0.01, "{along} {across} at {cos}, {phi}: {found}");
        }
    }
}

/// At grazing a little more than arrives comes back, as in Cycles; on the mean over a hemisphere never.
#[test]
fn no_light_is_made_on_the_mean() {
    for (along, across) in [(0.02, 0.01), (0.1, 0.07), (0.3, 0.2), (0.3, 0.1), (1.0, 0.7), (1.0, 0.3)] {
        let material = Brushed::one(of_alphas(along, across, true), Vec3::X);
        let (mut most, mut mean) = (0.0_f64, 0.0);
        for ring in 0..8 {
            for sector in 0..4 {
                // Rings of the same projected area, sectors of a quarter of the circle.
                let cos = ((ring as f32 + 0.5) / 8.0).sqrt();
                let bsdf = material.seen(around(cos, (sector as f32 + 0.5) * TAU / 16.0));
                let albedo = sampled_albedo(&bsdf, LobeSet::ALL, RADIANCE, 16);
                (most, mean) = (most.max(albedo), mean + albedo / 32.0);
            }
        }
        assert!(mean < 1.0025 && mean > 0.7 && most < 1.04, "{along} {across}: {mean}, at most {most}");
    }
}

#[test]
fn bins_hold_what_the_viewer_sees() {
    let mut rng = Rng(16);
    let dielectric = principled(|p| (p.roughness, p.anisotropic) = (0.9, 0.5));
    for closure in [of_alphas(0.4, 0.9, true), of_alphas(0.7, 0.3, false), dielectric] {
        let material = Brushed::one(closure, Vec3::new(1.0, 0.4, 0.2));
        for _ in 0..300 {
            let (wo, wi) = (above(&mut rng), above(&mut rng));
            let left = material.seen(wo).eval_rough(&[[wi.x], [wi.y], [wi.z]]);
            let viewer = material.seen(wi);
            let found = Rgb([0, 1, 2].map(|c| left[c][0])) * viewer.rough_gain();
            assert_close(found, viewer.eval(wo, LobeSet::ROUGH, RADIANCE), 1e-3, "bins");
            assert!(viewer.has(LobeSet::ROUGH));
        }
    }
}

/// What is narrower one way than bins can tell is followed.
#[test]
fn a_narrow_side_makes_a_sharp_lobe() {
    let class = |along, across| {
        let material = Brushed::one(of_alphas(along, across, true), Vec3::X);
        assert!(material.table[0].classes().intersects(LobeSet::ROUGH | LobeSet::SHARP));
        [LobeSet::ROUGH, LobeSet::SHARP, LobeSet::DELTA].map(|set| material.seen(at(0.7)).has(set))
    };
    assert_eq!(class(0.9, 0.26), [true, false, false]);
    assert_eq!(class(0.9, 0.24), [false, true, false]);
    assert_eq!(class(2e-4, 0.9), [false, true, false]);
}

#[test]
fn a_surface_that_is_turned_keeps_its_tangents() {
    let mut rng = Rng(17);
    let rotation = Quat::from_axis_angle(Vec3::new(0.6, 0.0, 0.8), 1.1);
    for (name, material) in materials() {
        for _ in 0..200 {
            let (wo, wi) = (above(&mut rng), above(&mut rng));
            for mode in [RADIANCE, IMPORTANCE] {
                let still = material.seen(wo).eval(wi, LobeSet::ALL, mode);
                let turned = material.seen(wo).turned(rotation).eval(rotation * wi, LobeSet::ALL, mode);
                assert_close(turned, still, 5e-3, name);
            }
        }
    }
}

//! Directions are drawn with the density that is claimed, and weights are f · |cos| / pdf.

mod bsdf_support;

use bsdf_support::{
    IMPORTANCE, RADIANCE, Rng, at, chi_square, diffuse, glass, glossy, prepared, principled, rough_diffuse,
    seen, sheen, significance, translucent,
};
use glam::Vec3;
use rgp_renderer::bsdf::{LobeSet, PreparedMaterial};
use rgp_renderer::scene::record::ClosureRecord;

const COSINES: [f32; 4] = [1.0, 0.8, 0.4, 0.1];

/// Where the lobe is sharpest: the mirrored direction, or the refracted one.
fn mirrored(cos: f32) -> Vec3 {
    let wo = at(cos);
    Vec3::new(-wo.x, -wo.y, wo.z)
}

fn refracted(cos: f32, eta: f32) -> Vec3 {
    let sin = ((1.0 - cos * cos).max(0.0).sqrt() / eta).min(1.0);
    Vec3::new(-sin, 0.0, -(1.0 - sin * sin).max(0.0).sqrt())
}

struct Case {
    name: &'static str,
    material: PreparedMaterial,
    front: bool,
    /// Index on the far side over that on the near side, where something is refracted.
    eta: f32,
    set: LobeSet,
    cos: f32,
}

fn check(cases: &[Case]) {
    let level = significance(cases.len());
    for (seed, case) in (0..).zip(cases) {
        let Case { name, material, front, eta, set, cos } = case;
        let poles = [mirrored(*cos), refracted(*cos, *eta)];
        let p = chi_square(&seen(material, *cos, *front), *set, poles, seed);
        assert!(p > level, "{name} at cosine {cos}: p = {p:.2e}, below {level:.2e}");
    }
}

#[test]
fn wide_lobes_and_reflections_are_drawn_from_their_density() {
    let mut cases = Vec::new();
    let mut add = |name, material, cos| {
        cases.push(Case { name, material, front: true, eta: 1.0, set: LobeSet::ALL, cos });
    };
    for cos in COSINES {
        add("Lambert", prepared(diffuse(0.8)), cos);
        add("rough diffuse 0.3", prepared(rough_diffuse(0.8, 0.3)), cos);
        add("rough diffuse 1", prepared(rough_diffuse(0.8, 1.0)), cos);
        add("translucent", prepared(translucent(0.8)), cos);
        for (name, roughness) in [("sheen 0.3", 0.3), ("sheen 0.5", 0.5), ("sheen 1", 1.0)] {
            add(name, prepared(sheen(0.9, roughness)), cos);
        }
        for (name, alpha) in [("0.01", 0.01_f32), ("0.05", 0.05), ("0.2", 0.2), ("0.5", 0.5), ("1", 1.0)] {
            add(name, prepared(glossy(0.9, alpha.sqrt())), cos);
        }
    }
    check(&cases);
}

#[test]
fn rough_glass_is_drawn_from_its_density() {
    let mut cases = Vec::new();
    for (roughness, ior) in [(0.3, 1.5), (0.6, 1.5), (1.0, 2.4), (0.5, 0.8), (0.8, 1.1)] {
        for cos in COSINES {
            let mut add = |name, front, eta| {
                let material = prepared(glass(1.0, roughness, ior));
                cases.push(Case { name, material, front, eta, set: LobeSet::NON_DELTA, cos });
            };
            add("glass from outside", true, ior);
            add("glass from inside", false, 1.0 / ior);
        }
    }
    check(&cases);
}

#[test]
fn principled_mixes_are_drawn_from_their_density() {
    let everything = principled(|p| {
        p.coat_weight = 0.7;
        p.coat_roughness = 0.3;
        p.metallic = 0.3;
        p.roughness = 0.6;
        p.transmission_weight = 0.4;
        p.sheen_weight = 0.5;
        p.diffuse_roughness = 0.8;
    });
    let mut cases = Vec::new();
    for cos in COSINES {
        let mut add = |name, closure: &ClosureRecord, front, set| {
            let eta = if front { 1.5 } else { 1.0 / 1.5 };
            cases.push(Case { name, material: prepared(closure.clone()), front, eta, set, cos });
        };
        add("default", &principled(|_| ()), true, LobeSet::ALL);
        add("everything", &everything, true, LobeSet::ALL);
        add("everything from inside", &everything, false, LobeSet::ALL);
        add("one class", &everything, true, LobeSet::ROUGH);
        add("two classes", &everything, true, LobeSet::DIFFUSE | LobeSet::SHARP);
    }
    check(&cases);
}

#[test]
fn weight_is_value_times_cosine_over_density() {
    let materials = [
        prepared(diffuse(0.5)),
        prepared(rough_diffuse(0.5, 0.7)),
        prepared(translucent(0.5)),
        prepared(sheen(0.5, 0.6)),
        prepared(glossy(0.8, 0.3)),
        prepared(glass(0.9, 0.4, 1.45)),
        prepared(principled(|p| {
            p.coat_weight = 1.0;
            p.coat_roughness = 0.2;
            p.transmission_weight = 0.5;
        })),
    ];
    let mut rng = Rng(3);
    let mut seen_samples = 0;
    for material in &materials {
        for _ in 0..2000 {
            let (wo, mode) = (rng.direction(), if rng.next() < 0.5 { RADIANCE } else { IMPORTANCE });
            let bsdf = material.bsdf(wo, Vec3::Z, Vec3::new(0.2, 0.1, 1.0).normalize());
            let set = LobeSet::NON_DELTA;
            let Some(sample) = bsdf.sample(rng.next(), [rng.next(), rng.next()], set, mode) else { continue };
            // Photons spread with the cosine to the geometric normal, and have densities of their own.
            let (normal, pdf) = match mode {
                RADIANCE => (bsdf.frame.ns, bsdf.pdf(sample.wi, set)),
                IMPORTANCE => (bsdf.frame.ng, sample.pdf_solid_angle),
            };
            let cos = sample.wi.dot(normal).abs();
            let value = bsdf.eval(sample.wi, set, mode);
            assert!((pdf / sample.pdf_solid_angle - 1.0).abs() < 1e-4);
            for k in 0..3 {
                let expected = value.0[k] * cos / pdf;
                assert!((sample.weight.0[k] - expected).abs() <= 1e-4 * expected.max(1e-3));
            }
            seen_samples += 1;
        }
    }
    assert!(seen_samples > 4000);
}

#[test]
fn smooth_glass_mirrors_and_refracts_by_snell() {
    let material = prepared(glass(1.0, 0.0, 1.5));
    let bsdf = seen(&material, 0.6, true);
    let (mut reflected, mut transmitted) = (0, 0);
    for i in 0..1000 {
        let u = (i as f32 + 0.5) / 1000.0;
        let sample = bsdf.sample(u, [0.3, 0.6], LobeSet::ALL, RADIANCE).expect("glass never absorbs");
        assert!(sample.is_delta && sample.class == LobeSet::DELTA);
        assert!((sample.weight.mean() - 1.0).abs() < 1e-5, "Fresnel is the chance itself");
        let expected = if sample.is_transmission { refracted(0.6, 1.5) } else { mirrored(0.6) };
        assert!(sample.wi.distance(expected) < 1e-5);
        if sample.is_transmission { transmitted += 1 } else { reflected += 1 }
    }
    // Fresnel's equations at 53.13° for index 1.5, by hand: cos t = 0.8459, r_s = −0.3579, r_p = −0.0310.
    assert_eq!(reflected + transmitted, 1000);
    assert!((f64::from(reflected) - 64.5).abs() <= 1.0, "{reflected}");
}

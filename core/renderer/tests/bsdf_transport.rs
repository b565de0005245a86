//! Radiance and photons see the same surface: reciprocity, the adjoint, refraction and shading normals.

mod bsdf_support;

use bsdf_support::{
    IMPORTANCE, RADIANCE, Rng, at, diffuse, glass, glossy, prepared, principled, rough_diffuse,
    sampled_albedo, seen, translucent,
};
use glam::Vec3;
use rgp_renderer::bsdf::{LobeSet, PreparedMaterial, TransportMode};
use rgp_renderer::color::Rgb;
use rgp_renderer::sampling::cosine_hemisphere;
use rgp_renderer::scene::record::ClosureRecord;

/// Calls `check(wo, wi)` for directions above a plane facing +z.
fn pairs_above(mut check: impl FnMut(Vec3, Vec3)) {
    let mut rng = Rng(11);
    for _ in 0..500 {
        let [wo, wi] = [rng.direction(), rng.direction()];
        check(Vec3::new(wo.x, wo.y, wo.z.abs()), Vec3::new(wi.x, wi.y, wi.z.abs()));
    }
}

#[test]
fn diffuse_and_single_scattering_reflection_are_reciprocal() {
    // Roughness 0.1 loses so little that the energy compensation, which depends on the viewer, is below the bound.
    let base = principled(|p| {
        p.base_color = Rgb::BLACK;
        p.roughness = 0.1;
        p.specular_tint = Rgb([1.0, 0.6, 0.3]);
    });
    for (closure, bound) in [(diffuse(0.6), 1e-6), (rough_diffuse(0.6, 1.0), 1e-5), (base, 2e-3)] {
        let material = prepared(closure);
        pairs_above(|wo, wi| {
            if wo.z.min(wi.z) < 0.2 {
                return;
            }
            let there = material.bsdf(wo, Vec3::Z, Vec3::Z).eval(wi, LobeSet::ALL, RADIANCE);
            let back = material.bsdf(wi, Vec3::Z, Vec3::Z).eval(wo, LobeSet::ALL, RADIANCE);
            assert!((there - back).map(f32::abs).max_channel() <= bound * there.max_channel().max(1e-6));
        });
    }
}

#[test]
fn translucence_is_reciprocal() {
    let material = prepared(translucent(0.6));
    pairs_above(|wo, wi| {
        let there = material.bsdf(wo, Vec3::Z, Vec3::Z).eval(-wi, LobeSet::ALL, RADIANCE);
        let back = material.bsdf(-wi, Vec3::Z, Vec3::Z).eval(wo, LobeSet::ALL, RADIANCE);
        assert_eq!(there, back);
        assert!((there.mean() - 0.6 * std::f32::consts::FRAC_1_PI).abs() < 1e-6);
    });
}

#[test]
fn photons_see_the_value_that_radiance_sees_the_other_way() {
    let material = prepared(principled(|p| {
        (p.roughness, p.coat_weight, p.coat_roughness) = (0.7, 0.5, 0.4);
        (p.sheen_weight, p.diffuse_roughness) = (0.6, 1.0);
    }));
    let mut differs = 0;
    pairs_above(|wo, wi| {
        let photon = material.bsdf(wo, Vec3::Z, Vec3::Z).eval(wi, LobeSet::ALL, IMPORTANCE);
        let radiance = material.bsdf(wi, Vec3::Z, Vec3::Z).eval(wo, LobeSet::ALL, RADIANCE);
        assert!((photon - radiance).map(f32::abs).max_channel() <= 1e-5 * radiance.max_channel());
        let forward = material.bsdf(wo, Vec3::Z, Vec3::Z).eval(wi, LobeSet::ALL, RADIANCE);
        differs +=
            u32::from((forward - radiance).map(f32::abs).max_channel() > 0.01 * radiance.max_channel());
    });
    assert!(differs > 100, "layers depend on the viewer, so the two directions must differ");
}

/// Flux sent to the viewer's directions by uniform light from everywhere, and flux of photons from everywhere that leaves:
/// the same double integral over both directions.
fn both_ways(material: &PreparedMaterial, front: bool, set: LobeSet) -> (f64, f64) {
    let (mut radiance, mut importance) = (0.0, 0.0);
    for step in 0..200 {
        let cos = (step as f32 + 0.5) / 200.0;
        let weight = f64::from(2.0 * cos / 200.0);
        radiance += weight * sampled_albedo(&seen(material, cos, front), set, RADIANCE, 12);
        importance += weight * sampled_albedo(&seen(material, cos, front), set, IMPORTANCE, 12);
    }
    (radiance, importance)
}

#[test]
fn layered_diffuse_reflects_as_much_flux_as_radiance() {
    let material = prepared(principled(|p| (p.roughness, p.ior) = (0.4, 1.8)));
    let (radiance, importance) = both_ways(&material, true, LobeSet::ALL);
    assert!((radiance - importance).abs() < 0.003, "{radiance} against {importance}");
}

#[test]
fn photons_lose_the_squared_index_on_entering_and_win_it_back() {
    for roughness in [0.0, 0.5] {
        let refraction = ClosureRecord::Refraction { color: Rgb::WHITE, roughness, ior: 1.5 };
        let material = prepared(refraction);
        // Radiance that arrives outside from inside, over both hemispheres, is the flux photons carry from inside to outside.
        let outward = both_ways(&material, false, LobeSet::ALL).1;
        let seen_from_outside = both_ways(&material, true, LobeSet::ALL).0;
        assert!((outward - seen_from_outside).abs() < 0.005, "{outward} against {seen_from_outside}");
        let inward = both_ways(&material, true, LobeSet::ALL).1;
        let seen_from_inside = both_ways(&material, false, LobeSet::ALL).0;
        assert!((inward - seen_from_inside).abs() < 0.005, "{inward} against {seen_from_inside}");
        if roughness == 0.0 {
            // Everything passes inwards: 1/η² of the flux. Outwards what is not totally reflected, 1/η², times η².
            assert!((inward - 1.0 / 2.25).abs() < 1e-3 && (outward - 1.0).abs() < 5e-3);
        }
    }
}

#[test]
fn squared_index_undoes_itself_through_a_slab() {
    let material = prepared(glass(1.0, 0.0, 1.5));
    let enter = seen(&material, 0.7, true);
    let into = enter.sample(0.99, [0.5; 2], LobeSet::ALL, IMPORTANCE).expect("refracts");
    assert!(into.is_transmission && (into.eta_squared - 2.25).abs() < 1e-5);
    assert!((into.weight.mean() * into.eta_squared - 1.0).abs() < 1e-4);
    let leave = material.bsdf(-into.wi, Vec3::NEG_Z, Vec3::NEG_Z);
    let out = leave.sample(0.99, [0.5; 2], LobeSet::ALL, IMPORTANCE).expect("refracts");
    assert!((into.eta_squared * out.eta_squared - 1.0).abs() < 1e-5);
    assert!((into.weight.mean() * out.weight.mean() - 1.0).abs() < 1e-4);
    assert!(out.wi.distance(-at(0.7)) < 1e-5, "leaves parallel to where it came from");
}

#[test]
fn nothing_is_reflected_below_the_geometric_surface() {
    let ns = Vec3::new(0.6, 0.0, 0.8);
    for closure in
        [diffuse(0.8), rough_diffuse(0.8, 1.0), glossy(0.8, 0.6), principled(|p| p.coat_weight = 1.0)]
    {
        let material = prepared(closure);
        let mut rng = Rng(5);
        for _ in 0..3000 {
            let wo = rng.direction();
            let bsdf = material.bsdf(wo, Vec3::Z, ns);
            assert!(bsdf.frame.ng.dot(wo) >= 0.0);
            let wi = rng.direction();
            if wi.dot(bsdf.frame.ng) < 0.0 {
                assert!(bsdf.eval(wi, LobeSet::ALL, RADIANCE).is_black());
            }
            if let Some(sample) = bsdf.sample(rng.next(), [rng.next(), rng.next()], LobeSet::ALL, RADIANCE) {
                assert!(sample.wi.dot(bsdf.frame.ng) >= 0.0 && !sample.is_transmission);
            }
        }
    }
}

#[test]
fn photons_correct_for_shading_normals() {
    // Veach 1997, equation 5.19, for the cosine to the geometric normal: f* = f |wo·ns| / |wo·ng|.
    let ns = Vec3::new(0.3, 0.1, 0.9).normalize();
    let material = prepared(diffuse(0.5));
    let (wo, wi) = (at(0.8), Vec3::new(0.2, -0.5, 0.7).normalize());
    let value = material.bsdf(wo, Vec3::Z, ns).eval(wi, LobeSet::ALL, IMPORTANCE).mean();
    let expected = 0.5 / std::f32::consts::PI * wo.dot(ns) / wo.z;
    assert!((value / expected - 1.0).abs() < 1e-5);
}

/// Flux that leaves a surface with a leaning shading normal under uniform light, per flux that arrives.
fn leaving_when_leaning(material: &PreparedMaterial, ns: Vec3, mode: TransportMode) -> f64 {
    const COUNT: usize = 400_000;
    let mut rng = Rng(3);
    let mut sum = 0.0;
    for _ in 0..COUNT {
        let wo = cosine_hemisphere([rng.next(), rng.next()]);
        let bsdf = material.bsdf(wo, Vec3::Z, ns);
        if let Some(sample) = bsdf.sample(rng.next(), [rng.next(), rng.next()], LobeSet::ALL, mode) {
            // A photon's cosines are with the surface, a viewer's with the shading normal.
            sum += f64::from(sample.weight.mean());
        }
    }
    sum / COUNT as f64
}

#[test]
fn photons_and_radiance_agree_about_leaning_normals() {
    for lean in [0.1, 0.35, 0.7] {
        let ns = Vec3::new(lean, 0.0, f32::sqrt(1.0 - lean * lean));
        // The part of the hemisphere about ns that is above the surface, weighted by the cosine to ns.
        let expected = f64::from(0.8 * (1.0 + ns.z) / 2.0);
        let material = prepared(diffuse(0.8));
        for mode in [RADIANCE, IMPORTANCE] {
            let flux = leaving_when_leaning(&material, ns, mode);
            assert!((flux / expected - 1.0).abs() < 0.004, "{lean} {mode:?}: {flux} against {expected}");
        }
        // Gloss is sampled about the shading normal alone, so that viewers below it get nothing.
        let gloss_lost = 0.06 * f64::from(lean * lean);
        // A normal that is bent for a photon from below it stays so for the viewer, to whom rough facets send much from there.
        let rough_won = 0.026 * f64::from(lean * lean);
        let others = [
            (principled(|p| p.roughness = 0.6), 0.0),
            (translucent(0.8), 0.0),
            (rough_diffuse(0.8, 1.0), -rough_won),
            (glossy(0.8, 0.7), gloss_lost),
        ];
        for (closure, lost) in others {
            let material = prepared(closure.clone());
            let [seen, sent] = [RADIANCE, IMPORTANCE].map(|mode| leaving_when_leaning(&material, ns, mode));
            let ratio = sent / seen;
            assert!((ratio - 1.0 + lost).abs() < 0.01, "{closure:?} leaning {lean}: {ratio} of {seen}");
        }
    }
}

//! Thin walls of the Principled BSDF: sheets of glass that bend nothing, and leaves.

mod bsdf_support;

use bsdf_support::{
    IMPORTANCE, RADIANCE, Rng, at, chi_square, prepared, principled, sampled_albedo, seen, significance,
};
use glam::Vec3;
use rgp_renderer::bsdf::{LobeSet, PreparedMaterial};
use rgp_renderer::color::Rgb;
use rgp_renderer::scene::record::PrincipledRecord;

const COSINES: [f32; 5] = [0.02, 0.1, 0.3, 0.6, 1.0];

fn sheet(roughness: f32, ior: f32, change: impl FnOnce(&mut PrincipledRecord)) -> PreparedMaterial {
    prepared(principled(|p| {
        (p.thin_wall, p.transmission_weight, p.base_color) = (true, 1.0, Rgb::WHITE);
        (p.roughness, p.ior) = (roughness, ior);
        change(p);
    }))
}

/// Fresnel's reflectance of one face, by the angles (not by the formula under test).
fn face(cos: f64, ior: f64) -> f64 {
    let (i, t) = (cos.acos(), (cos.acos().sin() / ior).asin());
    if i < 1e-6 {
        return ((ior - 1.0) / (ior + 1.0)).powi(2);
    }
    let (s, p) = ((i - t).sin() / (i + t).sin(), (i - t).tan() / (i + t).tan());
    0.5 * (s * s + p * p)
}

/// What a pane of clear glass does to light is in textbooks: R = 2 r / (1 + r), T = (1 - r) / (1 + r).
#[test]
fn clear_sheets_reflect_and_let_pass_what_panes_do() {
    for ior in [1.0, 1.2, 1.5, 2.4] {
        let material = sheet(0.0, ior, |_| ());
        for cos in [0.05, 0.2, 0.5, 0.8, 1.0] {
            for front in [true, false] {
                let bsdf = seen(&material, cos, front);
                let r = face(f64::from(cos), f64::from(ior));
                let reflected = f64::from(bsdf.albedo(LobeSet::ALL).mean());
                let passed = f64::from(bsdf.transparency.mean());
                assert!((reflected - 2.0 * r / (1.0 + r)).abs() < 1e-4, "index {ior}, {cos}: {reflected}");
                assert!((passed - (1.0 - r) / (1.0 + r)).abs() < 1e-4, "index {ior}, {cos}: {passed}");
                assert!(!bsdf.has(LobeSet::NON_DELTA) && bsdf.lit_side().is_some());
            }
        }
    }
}

/// Ways to and fro added up one by one.
#[test]
fn tinted_sheets_are_the_sum_of_all_ways_through() {
    let (ior, color) = (1.5_f32, 0.6_f32);
    let material = sheet(0.0, ior, |p| p.base_color = Rgb::splat(color));
    for cos in [0.2_f64, 0.7, 1.0] {
        let sin = (1.0 - cos * cos).max(0.0).sqrt() / f64::from(ior);
        let (r, left) = (face(cos, f64::from(ior)), f64::from(color).powf(1.0 / (1.0 - sin * sin).sqrt()));
        let (mut reflected, mut passed, mut inside) = (r, 0.0, 1.0 - r);
        for way in 0..40 {
            inside *= left;
            let leaves = inside * (1.0 - r);
            *(if way % 2 == 0 { &mut passed } else { &mut reflected }) += leaves;
            inside *= r;
        }
        let bsdf = seen(&material, cos as f32, true);
        assert!((f64::from(bsdf.transparency.mean()) - passed).abs() < 1e-4, "cosine {cos}");
        assert!((f64::from(bsdf.albedo(LobeSet::ALL).mean()) - reflected).abs() < 1e-4, "cosine {cos}");
    }
}

#[test]
fn white_sheets_return_everything_and_never_more() {
    for ior in [0.7, 1.0, 1.1, 1.5, 2.4] {
        for roughness in [0.0, 0.05, 0.2, 0.5, 0.8, 1.0] {
            let material = sheet(roughness, ior, |_| ());
            for cos in COSINES {
                for front in [true, false] {
                    let what = format!("index {ior}, roughness {roughness}, cosine {cos}, front {front}");
                    let bsdf = seen(&material, cos, front);
                    let straight = f64::from(bsdf.transparency.mean());
                    let tabulated = straight + f64::from(bsdf.albedo(LobeSet::ALL).mean());
                    assert!((tabulated - 1.0).abs() < 0.002, "{what}: tabulated {tabulated}");
                    // Half a per cent more is what the tables may be off.
                    let total = straight + sampled_albedo(&bsdf, LobeSet::ALL, RADIANCE, 32);
                    assert!(total < 1.005 && total > 0.99, "{what}: {total}");
                }
            }
        }
    }
}

#[test]
fn rough_sheets_are_drawn_from_their_density() {
    let mut cases = Vec::new();
    for (roughness, ior) in [(0.3, 1.5), (0.6, 1.5), (1.0, 2.4), (0.8, 1.1)] {
        for cos in [1.0, 0.8, 0.4, 0.1] {
            cases.push((roughness, ior, cos));
        }
    }
    for (seed, &(roughness, ior, cos)) in (0..).zip(&cases) {
        let material = sheet(roughness, ior, |_| ());
        let (wo, set) = (at(cos), LobeSet::NON_DELTA);
        let poles = [Vec3::new(-wo.x, -wo.y, wo.z), -wo];
        for front in [true, false] {
            let p = chi_square(&seen(&material, cos, front), set, poles, seed);
            assert!(p > significance(2 * cases.len()), "roughness {roughness}, {ior}, {cos}: p = {p:.2e}");
        }
    }
}

/// What passes is a reflection on the other side: the same for a mirrored direction, but for the share.
#[test]
fn what_passes_is_what_a_surface_that_is_as_rough_reflects() {
    let (roughness, ior) = (0.8_f32, 1.5_f32);
    let spread = roughness.powi(2) * (3.4 * 0.5 * 1.0 / ior.powi(3)).sqrt();
    let glossy = prepared(bsdf_support::glossy(1.0, spread.sqrt()));
    let material = sheet(roughness, ior, |_| ());
    let mut rng = Rng(9);
    for _ in 0..500 {
        let wo = at(rng.next().max(0.05));
        let d = rng.direction();
        let wi = Vec3::new(d.x, d.y, d.z.abs().max(0.05)).normalize();
        let r = face(f64::from(wo.z), f64::from(ior)) as f32;
        let reflected = seen(&glossy, wo.z, true).eval(wi, LobeSet::ALL, RADIANCE).mean();
        let passed =
            seen(&material, wo.z, true).eval(Vec3::new(wi.x, wi.y, -wi.z), LobeSet::ALL, RADIANCE).mean();
        let expected = reflected * (1.0 - r) / (1.0 + r);
        assert!((passed - expected).abs() < 2e-3 * expected, "{wo} {wi}: {passed} for {expected}");
    }
}

/// Photons are the exact adjoint, and where nothing but the angle to the sheet decides, both ways are one.
#[test]
fn sheets_are_reciprocal() {
    let mut rng = Rng(4);
    let rough = sheet(0.7, 1.5, |p| p.base_color = Rgb([0.9, 0.5, 0.2]));
    let clear = sheet(0.0, 1.5, |p| (p.base_color, p.coat_weight) = (Rgb([0.9, 0.5, 0.2]), 1.0));
    for _ in 0..500 {
        let (wo, wi) = (rng.direction(), rng.direction());
        let photon = rough.bsdf(wo, Vec3::Z, Vec3::Z).eval(wi, LobeSet::ALL, IMPORTANCE);
        let radiance = rough.bsdf(wi, Vec3::Z, Vec3::Z).eval(wo, LobeSet::ALL, RADIANCE);
        assert!((photon - radiance).map(f32::abs).max_channel() <= 1e-5 * radiance.max_channel().max(1e-6));
        let [there, back] = [wo, -wo].map(|wo| clear.bsdf(wo, Vec3::Z, Vec3::Z).transparency);
        assert!((there - back).map(f32::abs).max_channel() < 1e-6);
    }
}

#[test]
fn sheets_are_finite_at_every_angle_and_of_every_index() {
    for (ior, roughness) in [(0.01, 0.0), (0.01, 1.0), (1.0, 0.5), (1.0, 0.0), (100.0, 0.7), (1.5, 0.3)] {
        for base_color in [Rgb::BLACK, Rgb::WHITE] {
            let material = sheet(roughness, ior, |p| {
                (p.base_color, p.specular_tint) = (base_color, Rgb([0.0, 1.0, 3.0]));
            });
            assert!(material.transparency().is_finite() && material.emission().is_finite());
            for cos in [0.0, 1e-20, 1e-6, 1.0] {
                let bsdf = seen(&material, cos, true);
                let (albedo, gain) = (bsdf.albedo(LobeSet::ALL), bsdf.rough_gain());
                assert!(albedo.is_finite() && bsdf.transparency.is_finite() && gain.is_finite());
                assert!((albedo + bsdf.transparency).max_channel() < 1.005, "index {ior}: {albedo:?}");
                let rough = bsdf.eval_rough(&[[0.0], [0.0], [1.0]]);
                assert!(rough.iter().all(|c| c[0].is_finite()), "index {ior}, cosine {cos}");
            }
        }
    }
}

/// The bins of a glossy cell take what a photon leaves without what its own angle does to the reflectance.
#[test]
fn a_photon_leaves_on_a_rough_sheet_what_viewers_see() {
    let mut rng = Rng(6);
    let material = sheet(0.8, 1.5, |p| p.base_color = Rgb([0.9, 0.5, 0.2]));
    for _ in 0..500 {
        let [wo, w] = [0, 1].map(|_| {
            let d = rng.direction();
            Vec3::new(d.x, d.y, d.z.abs().max(0.05)).normalize()
        });
        let left = material.bsdf(wo, Vec3::Z, Vec3::Z).eval_rough(&[[w.x], [w.y], [w.z]]);
        let viewer = material.bsdf(w, Vec3::Z, Vec3::Z);
        let seen = viewer.eval(wo, LobeSet::ROUGH, RADIANCE);
        let apart = Rgb(left.map(|c| c[0])) * viewer.rough_gain() - seen;
        assert!(apart.map(f32::abs).max_channel() <= 2e-4 * seen.max_channel());
    }
}

#[test]
fn light_passes_clear_sheets_straight_and_rough_ones_not() {
    assert!(!sheet(0.0, 1.5, |_| ()).refracts() && !sheet(0.0, 1.5, |_| ()).transparency().is_black());
    assert!(sheet(0.5, 1.5, |_| ()).refracts() && sheet(0.5, 1.5, |_| ()).transparency().is_black());
    assert!(!sheet(0.5, 1.5, |_| ()).is_opaque());
    let mut opaque = sheet(0.0, 1.5, |_| ());
    opaque.leave_out_transparency();
    assert!(opaque.is_opaque() && seen(&opaque, 0.7, true).transparency.is_black());
}

/// Half of what scatters in a leaf leaves on the other side, more with anisotropy; without a thin wall none does.
#[test]
fn leaves_share_their_albedo_between_both_sides() {
    for (weight, anisotropy, share) in [(1.0, 0.0, 0.5), (1.0, 1.0, 1.0), (0.4, 0.5, 0.3), (0.0, 0.9, 0.0)] {
        let leaf = |thin_wall| {
            prepared(principled(|p| {
                (p.thin_wall, p.subsurface_weight, p.subsurface_anisotropy) = (thin_wall, weight, anisotropy);
                (p.base_color, p.specular_ior_level) = (Rgb::splat(0.6), 0.0);
            }))
        };
        for front in [true, false] {
            let (material, solid) = (leaf(true), leaf(false));
            let [bsdf, solid] = [&material, &solid].map(|material| seen(material, 0.7, front));
            let passed = bsdf.albedo(LobeSet::TRANSLUCENT).mean();
            let kept = bsdf.albedo(LobeSet::DIFFUSE).mean();
            assert!((passed - 0.6 * share).abs() < 1e-5, "{passed} passes");
            assert!((kept - 0.6 * (1.0 - share)).abs() < 1e-5, "{kept} is kept");
            assert!((solid.albedo(LobeSet::ALL).mean() - 0.6).abs() < 1e-5);
            assert!(!solid.has(LobeSet::TRANSLUCENT));
        }
    }
}

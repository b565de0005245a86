//! Rough diffuse reflection: its value against the model written out, and roughness 0 against Lambert's.

mod bsdf_support;

use std::f64::consts::{PI, TAU};

use bsdf_support::{
    IMPORTANCE, RADIANCE, Rng, at, diffuse, mixed, prepared, principled, rough_diffuse, sampled_albedo, seen,
};
use glam::{DVec3, Vec3};
use rgp_renderer::bsdf::LobeSet;
use rgp_renderer::color::Rgb;
use rgp_renderer::scene::record::{ClosureRecord, WeightedClosure};

/// π times the BSDF of white facets, for light that met one of them alone (Fujii 2012).
fn single(roughness: f64, wo: DVec3, wi: DVec3) -> f64 {
    let s = wo.dot(wi) - wo.z * wi.z;
    let t = if s > 0.0 { s / wo.z.max(wi.z) } else { s };
    (1.0 + roughness * t) / (1.0 + roughness * (0.5 - 2.0 / (3.0 * PI)))
}

/// Share of light from everywhere that does so, for a viewer at `cos`: by the midpoint rule over the projected hemisphere.
fn returned(roughness: f64, cos: f64) -> f64 {
    const STEPS: u32 = 400;
    let middle = |step: u32| (f64::from(step) + 0.5) / f64::from(STEPS);
    let wo = DVec3::new((1.0 - cos * cos).sqrt(), 0.0, cos);
    let mut sum = 0.0;
    for (i, j) in (0..STEPS).flat_map(|i| (0..STEPS).map(move |j| (i, j))) {
        let (sin, phi) = (middle(i).sqrt(), TAU * middle(j));
        let wi = DVec3::new(sin * phi.cos(), sin * phi.sin(), (1.0 - sin * sin).sqrt());
        sum += single(roughness, wo, wi);
    }
    sum / f64::from(STEPS * STEPS)
}

/// The whole BSDF for `color`: what is lost in one bounce comes back evenly (Portsmouth, Kutz, Hill 2025, equation 24), with the
/// further factor of the color that Cycles has.
fn expected(color: f64, roughness: f64, wo: DVec3, wi: DVec3) -> f64 {
    let rings = (0..64).map(|k| (f64::from(k) + 0.5) / 64.0);
    let mean = rings.map(|cos2| returned(roughness, cos2.sqrt()) / 64.0).sum::<f64>();
    let lost = (1.0 - returned(roughness, wo.z)) * (1.0 - returned(roughness, wi.z)) / (1.0 - mean);
    let back = color * color * mean / (1.0 - color * (1.0 - mean));
    color / PI * (single(roughness, wo, wi) + back * lost)
}

#[test]
fn values_are_those_of_the_model() {
    let directions = [(0.95, 0.0), (0.7, 2.5), (0.4, 0.3), (0.15, 3.0), (0.3, -1.2)];
    let direction = |(cos, phi): (f32, f32)| {
        let sin = (1.0 - cos * cos).sqrt();
        Vec3::new(sin * phi.cos(), sin * phi.sin(), cos)
    };
    for (color, roughness) in [(0.8, 1.0), (0.4, 0.3)] {
        let material = prepared(rough_diffuse(color, roughness));
        for (wo, wi) in [(0, 1), (1, 2), (2, 4), (3, 2), (3, 3)].map(|(a, b)| (directions[a], directions[b]))
        {
            let (wo, wi) = (direction(wo), direction(wi));
            let found = material.bsdf(wo, Vec3::Z, Vec3::Z).eval(wi, LobeSet::ALL, RADIANCE).mean();
            let expected = expected(color.into(), roughness.into(), wo.as_dvec3(), wi.as_dvec3());
            let off = f64::from(found) / expected - 1.0;
            assert!(off.abs() < 1e-3, "{color} {roughness} {wo} {wi}: {found} for {expected}");
        }
    }
}

#[test]
fn no_roughness_is_lamberts_lobe_to_the_bit() {
    let matte = |roughness| {
        principled(|p| (p.ior, p.specular_ior_level, p.diffuse_roughness) = (1.0, 0.0, roughness))
    };
    for (smooth, nearly) in [(diffuse(0.6), rough_diffuse(0.6, 9e-6)), (matte(0.0), matte(9e-6))] {
        let albedo = prepared(smooth).constant_lambert();
        assert!(albedo.is_some());
        assert_eq!(prepared(nearly).constant_lambert(), albedo);
    }
    let below_gloss = |roughness| prepared(principled(|p| p.diffuse_roughness = roughness));
    let (smooth, nearly, rough) = (below_gloss(0.0), below_gloss(9e-6), below_gloss(0.5));
    let mut rng = Rng(1);
    for _ in 0..100 {
        let [wo, wi] = [rng.direction(), rng.direction()];
        let value = |material| rgp_renderer::bsdf::PreparedMaterial::bsdf(material, wo, Vec3::Z, Vec3::Z);
        let [a, b, c] = [&smooth, &nearly, &rough].map(|m| value(m).eval(wi, LobeSet::DIFFUSE, RADIANCE));
        assert_eq!(a, b);
        assert!(a.is_black() || a != c);
    }
}

#[test]
fn stored_photons_leave_as_much_flux_as_scattered_ones() {
    for closure in [rough_diffuse(0.3, 1.0), rough_diffuse(0.9, 0.4)] {
        let material = prepared(closure);
        for cos in [1.0, 0.5, 0.1] {
            let photon = seen(&material, cos, true);
            let read = seen(&material, 0.7, true).diffuse_albedo() * photon.lambert_factor();
            let scattered = sampled_albedo(&photon, LobeSet::ALL, IMPORTANCE, 48);
            let off = f64::from(read.mean()) / scattered - 1.0;
            assert!(off.abs() < 2e-3, "cosine {cos}: {read:?} for {scattered}");
        }
    }
}

#[test]
fn parts_of_different_roughness_add_up() {
    let parts = [rough_diffuse(0.9, 0.2), rough_diffuse(0.3, 1.0), diffuse(0.6)];
    let half =
        |closure: &ClosureRecord| WeightedClosure { weight: Rgb::splat(0.3), closure: closure.clone() };
    let together = mixed(parts.iter().map(half).collect());
    for (cos_o, cos_i) in [(1.0, 0.5), (0.2, 0.9), (0.05, 0.05)] {
        let value = |closure: &ClosureRecord| {
            seen(&prepared(closure.clone()), cos_o, true).eval(at(cos_i), LobeSet::ALL, RADIANCE).mean()
        };
        let expected = 0.3 * parts.iter().map(value).sum::<f32>();
        let found = seen(&together, cos_o, true).eval(at(cos_i), LobeSet::ALL, RADIANCE).mean();
        assert!((found / expected - 1.0).abs() < 1e-5, "{found} for {expected}");
    }
}

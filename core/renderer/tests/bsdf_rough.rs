//! The rough lobes evaluated for many directions at once are, with the viewer's gain, what `eval` gives one by one.

mod bsdf_support;

use bsdf_support::{RADIANCE, Rng, glass, glossy, mixed, prepared, principled};
use glam::Vec3;
use rgp_renderer::bsdf::{Bsdf, LobeSet, PreparedMaterial};
use rgp_renderer::color::Rgb;
use rgp_renderer::scene::record::{ClosureRecord, WeightedClosure};

const LANES: usize = 16;

/// One of each kind of Fresnel factor, and several lobes at once; with how far their mean gain may be from each of theirs.
fn materials() -> Vec<(PreparedMaterial, f32)> {
    let tint = Rgb([1.0, 0.6, 0.3]);
    let closures: Vec<(ClosureRecord, f32)> = vec![
        (glossy(0.8, 0.5), 0.0),
        (glossy(0.8, 1.0), 0.0),
        (principled(|_| ()), 0.0),
        (
            principled(|p| (p.metallic, p.base_color, p.specular_tint) = (1.0, tint, Rgb([0.2, 0.9, 1.0]))),
            0.0,
        ),
        (principled(|p| (p.metallic, p.coat_weight, p.coat_roughness) = (0.4, 1.0, 0.6)), 0.1),
        (principled(|p| (p.transmission_weight, p.roughness) = (0.5, 0.8)), 0.2),
        (glass(0.9, 0.7, 1.5), 0.0),
    ];
    let half = |closure| WeightedClosure { weight: Rgb::splat(0.5), closure };
    let both = mixed(vec![half(glossy(0.5, 0.6)), half(glass(1.0, 0.9, 1.33))]);
    closures.into_iter().map(|(closure, apart)| (prepared(closure), apart)).chain([(both, 0.4)]).collect()
}

fn rough(bsdf: &Bsdf<'_>, wi: &[Vec3; LANES]) -> [Rgb; LANES] {
    let all = bsdf.eval_rough(&[0, 1, 2].map(|axis| wi.map(|w| w[axis])));
    std::array::from_fn(|lane| Rgb([0, 1, 2].map(|c| all[c][lane])))
}

#[test]
fn many_directions_at_once_are_each_of_them() {
    let mut rng = Rng(5);
    let (mut compared, mut black) = (0, 0);
    for (material, of_mean_gain) in materials() {
        for _ in 0..200 {
            // Any side, any tilt of the shading normal up to 20°.
            let (wo, ng) = (rng.direction(), rng.direction());
            let ns = (ng + rng.direction() * 0.34).normalize();
            let bsdf = material.bsdf(wo, ng, ns);
            let wi: [Vec3; LANES] = std::array::from_fn(|_| rng.direction());
            let (all, gain) = (rough(&bsdf, &wi), bsdf.rough_gain());
            for (lane, w) in wi.into_iter().enumerate() {
                let one = bsdf.eval(w, LobeSet::ROUGH, RADIANCE);
                let apart = (all[lane] * gain - one).map(f32::abs).max_channel();
                // Rounding of the cosines counts by how small they are.
                let cos = wo.dot(bsdf.frame.ns).min(w.dot(bsdf.frame.ns)).clamp(1e-3, 1.0);
                let bound = one.max_channel() * (2e-5 + 2e-6 / cos + of_mean_gain);
                assert!(apart <= bound, "{apart} of {one:?}, cosine {cos}");
                if one.is_black() { black += 1 } else { compared += 1 }
            }
        }
    }
    assert!(compared > 5000 && black > 5000, "{compared} above and {black} below");
}

/// A photon from `wo` and viewers at `wi`: light of many bounces between microfacets is the viewer's.
#[test]
fn a_photon_leaves_what_viewers_see() {
    let mut rng = Rng(6);
    let mut farthest = 0.0_f32;
    for material in [prepared(glossy(1.0, 0.8)), prepared(glossy(0.5, 1.0)), prepared(principled(|_| ()))] {
        for _ in 0..200 {
            let above = |direction: Vec3| {
                Vec3::new(direction.x, direction.y, direction.z.abs().max(0.05)).normalize()
            };
            let wo = above(rng.direction());
            let photon = material.bsdf(wo, Vec3::Z, Vec3::Z);
            let wi: [Vec3; LANES] = std::array::from_fn(|_| above(rng.direction()));
            for (left, w) in rough(&photon, &wi).into_iter().zip(wi) {
                let viewer = material.bsdf(w, Vec3::Z, Vec3::Z);
                let (seen, wrong) = (viewer.eval(wo, LobeSet::ROUGH, RADIANCE), left * photon.rough_gain());
                let bound = seen.max_channel() * 2e-4;
                assert!((left * viewer.rough_gain() - seen).map(f32::abs).max_channel() <= bound, "{w}");
                farthest = farthest.max((wrong - seen).map(f32::abs).max_channel() / seen.max_channel());
            }
        }
    }
    assert!(farthest > 0.3, "the gain of the photon's direction is no stand-in: {farthest}");
}

/// At the mirror direction head-on every factor is known: D = 1 / (π α²), no masking, reflectance F0.
#[test]
fn head_on_it_is_the_closed_form() {
    let (roughness, color) = (0.8_f32, 0.01);
    let material = prepared(glossy(color, roughness));
    let value = material.bsdf(Vec3::Z, Vec3::Z, Vec3::Z).eval_rough(&[[0.0], [0.0], [1.0]])[0][0];
    let single = color / (4.0 * std::f32::consts::PI * roughness.powi(4));
    // Light of many bounces between microfacets is added: less than a percent, so dark is the color.
    assert!(value >= single && value < 1.01 * single, "{value} against {single}");
}

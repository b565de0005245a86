//! How much light comes back: white furnaces, the tables against sampling, and Cycles.

mod bsdf_support;

use bsdf_support::{
    RADIANCE, diffuse, glass, glossy, prepared, principled, rough_diffuse, sampled_albedo, seen, sheen,
    translucent,
};
use rgp_renderer::bsdf::{LobeSet, PreparedMaterial};
use rgp_renderer::color::Rgb;
use rgp_renderer::scene::record::ClosureRecord;

const ROUGHNESSES: [f32; 6] = [0.0, 0.05, 0.2, 0.5, 0.8, 1.0];
const COSINES: [f32; 5] = [0.02, 0.1, 0.3, 0.6, 1.0];

/// Most that the tables may be off. Total reflection puts an edge into the albedo that they round off.
const OUTSIDE: f64 = 0.005;
const INSIDE: f64 = 0.0075;

/// Albedo by sampling, checked to be what the tables say.
fn albedo(material: &PreparedMaterial, cos: f32, front: bool, bound: f64, what: &str) -> f64 {
    let bsdf = seen(material, cos, front);
    let sampled = sampled_albedo(&bsdf, LobeSet::ALL, RADIANCE, 48);
    let tabulated = f64::from(bsdf.albedo(LobeSet::ALL).mean());
    assert!((sampled - tabulated).abs() < bound, "{what}: sampled {sampled}, tabulated {tabulated}");
    sampled
}

#[test]
fn white_glossy_returns_everything() {
    for roughness in ROUGHNESSES {
        let material = prepared(glossy(1.0, roughness));
        for cos in COSINES {
            let what = format!("roughness {roughness}, cosine {cos}");
            let albedo = albedo(&material, cos, true, OUTSIDE, &what);
            assert!((albedo - 1.0).abs() < 0.01 && albedo < 1.005, "{what}: {albedo}");
        }
    }
}

/// The same closure where light that bounces between microfacets is lost.
fn lossy(mut closure: ClosureRecord) -> ClosureRecord {
    match &mut closure {
        ClosureRecord::Glossy { multiscatter, .. } | ClosureRecord::Glass { multiscatter, .. } => {
            *multiscatter = false;
        }
        ClosureRecord::Principled(record) => record.multiscatter = false,
        _ => unreachable!(),
    }
    closure
}

/// Head on and of GGX alpha 1: D = 1/π, masked by 2 cos / (1 + cos), so ∫ D G / (4 cos) cos dω = ∫₀¹ c / (1 + c) dc.
#[test]
fn single_scattering_of_the_roughest_surface_is_the_closed_form() {
    let exact = 1.0 - std::f64::consts::LN_2;
    for (what, closure) in [
        ("glossy", glossy(1.0, 1.0)),
        (
            "metal",
            principled(|p| {
                (p.base_color, p.metallic, p.roughness) = (Rgb::WHITE, 1.0, 1.0);
            }),
        ),
    ] {
        let found = albedo(&prepared(lossy(closure)), 1.0, true, OUTSIDE, what);
        assert!((found - exact).abs() < 0.002, "{what}: {found} against {exact}");
    }
}

/// But for grazing directions. Multiscatter GGX returns all of it ([`white_glossy_returns_everything`]).
#[test]
fn single_scattering_returns_less_the_rougher_the_surface() {
    for make in [|roughness| glossy(1.0, roughness), |roughness| glass(1.0, roughness, 1.5)] {
        for cos in [0.6, 1.0] {
            let mut before = 1.0 + 1e-6;
            for roughness in ROUGHNESSES {
                let what = format!("roughness {roughness}, cosine {cos}");
                let found = albedo(&prepared(lossy(make(roughness))), cos, true, OUTSIDE, &what);
                assert!(found < before + 1e-3, "{what}: {found} after {before}");
                before = found;
            }
            assert!(before < 0.97, "cosine {cos}: {before} at roughness 1");
        }
    }
}

/// What bounces between the facets of a layer never reaches what lies below: the base gets about the same
/// with either distribution.
#[test]
fn light_lost_in_a_layer_does_not_light_what_is_below() {
    for roughness in ROUGHNESSES {
        for cos in [0.3, 0.6, 1.0] {
            let record = principled(|p| (p.base_color, p.roughness) = (Rgb::WHITE, roughness));
            let [kept, lost] = [record.clone(), lossy(record)]
                .map(|closure| seen(&prepared(closure), cos, true).albedo(LobeSet::DIFFUSE).mean());
            assert!(
                lost <= kept + 1e-4 && lost > kept - 0.03,
                "roughness {roughness}, cosine {cos}: {lost} of {kept}"
            );
        }
    }
}

#[test]
fn white_glass_returns_everything_from_outside_and_never_more() {
    for ior in [1.1, 1.5, 2.4] {
        for roughness in ROUGHNESSES {
            let material = prepared(glass(1.0, roughness, ior));
            for cos in COSINES {
                let what = format!("ior {ior}, roughness {roughness}, cosine {cos}");
                let outside = albedo(&material, cos, true, OUTSIDE, &what);
                assert!((outside - 1.0).abs() < 0.01 && outside < 1.005, "{what}: {outside}");
                let inside = albedo(&material, cos, false, INSIDE, &what);
                assert!(inside < 1.0 + INSIDE, "{what}, from inside: {inside}");
                assert!(roughness > 0.0 || (inside - 1.0).abs() < 1e-3, "{what}, from inside: {inside}");
            }
        }
    }
}

#[test]
fn white_principled_never_returns_more_than_arrives() {
    let variants: [ClosureRecord; 7] = [
        principled(|p| p.base_color = Rgb::WHITE),
        principled(|p| (p.base_color, p.metallic) = (Rgb::WHITE, 1.0)),
        principled(|p| (p.base_color, p.metallic, p.coat_weight) = (Rgb::WHITE, 0.5, 1.0)),
        principled(|p| (p.base_color, p.coat_weight, p.coat_ior) = (Rgb::WHITE, 1.0, 2.0)),
        principled(|p| (p.base_color, p.ior, p.specular_ior_level) = (Rgb::WHITE, 1.8, 1.0)),
        principled(|p| (p.base_color, p.sheen_weight) = (Rgb::WHITE, 1.0)),
        principled(|p| (p.base_color, p.ior) = (Rgb::WHITE, 0.7)),
    ];
    for (index, variant) in variants.iter().enumerate() {
        for roughness in ROUGHNESSES {
            let ClosureRecord::Principled(mut record) = variant.clone() else { unreachable!() };
            (record.roughness, record.coat_roughness) = (roughness, 1.0 - roughness);
            record.sheen_roughness = roughness;
            let material = prepared(ClosureRecord::Principled(record));
            for cos in COSINES {
                let what = format!("variant {index}, roughness {roughness}, cosine {cos}");
                let bound = if index == 6 { INSIDE } else { OUTSIDE };
                let albedo = albedo(&material, cos, true, bound, &what);
                assert!(albedo > 0.9 && albedo < 1.0 + bound, "{what}: {albedo}");
            }
        }
    }
}

#[test]
fn lambert_albedo_is_its_color() {
    let bsdf_of = prepared(diffuse(0.37));
    for cos in COSINES {
        let bsdf = seen(&bsdf_of, cos, true);
        assert_eq!(bsdf.albedo(LobeSet::ALL), Rgb::splat(0.37));
        assert!((sampled_albedo(&bsdf, LobeSet::ALL, RADIANCE, 48) - 0.37).abs() < 1e-5);
    }
}

#[test]
fn white_rough_diffuse_returns_everything_and_others_what_they_say() {
    for roughness in [1e-4, 0.05, 0.3, 1.0] {
        for color in [1.0, 0.8, 0.3] {
            let material = prepared(rough_diffuse(color, roughness));
            for cos in COSINES {
                let what = format!("rough diffuse {roughness} of {color}, cosine {cos}");
                let sampled = albedo(&material, cos, true, OUTSIDE, &what);
                let exact = seen(&material, cos, true).albedo(LobeSet::ALL).mean();
                assert!(exact < color + 1e-5, "{what}: {exact}");
                assert!(
                    color < 1.0 || (sampled - 1.0).abs() < OUTSIDE && exact > 1.0 - 1e-5,
                    "{what}: {exact}"
                );
            }
        }
    }
}

#[test]
fn translucence_sends_its_color_through_and_nothing_back() {
    let material = prepared(translucent(0.37));
    for (cos, front) in COSINES.into_iter().flat_map(|cos| [(cos, true), (cos, false)]) {
        let bsdf = seen(&material, cos, front);
        assert_eq!(bsdf.albedo(LobeSet::TRANSLUCENT), Rgb::splat(0.37));
        assert_eq!(bsdf.diffuse_albedo(), Rgb::BLACK);
        let through = sampled_albedo(&bsdf, LobeSet::ALL, RADIANCE, 48);
        assert!((through - 0.37).abs() < 1e-5, "{through}");
        let sample = bsdf.sample(0.5, [0.3, 0.6], LobeSet::ALL, RADIANCE).expect("all passes");
        assert!(sample.is_transmission && sample.wi.dot(bsdf.frame.ns) < 0.0);
    }
}

#[test]
fn sheen_returns_what_its_table_says_and_never_more_than_arrives() {
    for roughness in ROUGHNESSES {
        let material = prepared(sheen(1.0, roughness));
        for cos in COSINES {
            let what = format!("sheen, roughness {roughness}, cosine {cos}");
            let albedo = albedo(&material, cos, true, OUTSIDE, &what);
            assert!(albedo < 1.0, "{what}: {albedo}");
        }
    }
}

#[test]
fn colored_lobes_match_their_tables() {
    for front in [true, false] {
        for cos in COSINES {
            for (name, closure) in [
                ("refraction", ClosureRecord::Refraction { color: Rgb::WHITE, roughness: 0.5, ior: 1.45 }),
                (
                    "glass",
                    ClosureRecord::Glass {
                        color: Rgb([0.9, 0.5, 0.1]),
                        roughness: 0.7,
                        ior: 1.45,
                        multiscatter: true,
                    },
                ),
                (
                    "metal",
                    principled(|p| {
                        p.metallic = 1.0;
                        p.base_color = Rgb([0.9, 0.6, 0.2]);
                        p.specular_tint = Rgb([0.8, 0.4, 0.2]);
                    }),
                ),
                (
                    "everything",
                    principled(|p| {
                        p.metallic = 0.2;
                        p.transmission_weight = 0.4;
                        p.coat_weight = 0.8;
                        p.coat_tint = Rgb([0.9, 0.6, 0.3]);
                        p.specular_tint = Rgb([1.0, 0.5, 0.2]);
                    }),
                ),
            ] {
                let bound = if front { OUTSIDE } else { INSIDE };
                albedo(
                    &prepared(closure),
                    cos,
                    front,
                    bound,
                    &format!("{name}, cosine {cos}, front {front}"),
                );
            }
        }
    }
}

/// Radiance of a sphere in a white world (strength 1) by Cycles in Blender 5.0.1, one crossing of the surface, averaged over
/// the rings of the picture where the cosine to the viewer is 2/8 to 3/8, 4/8 to 5/8 and 7/8 to 1. 400 samples a pixel.
type Rings = [[f32; 3]; 3];

fn gray(rings: [f32; 3]) -> Rings {
    rings.map(|v| [v; 3])
}

/// Closure, whether seen from outside, rings.
#[rustfmt::skip]
#[expect(clippy::approx_constant, reason = "measured; its likeness to 1/√π is chance")]
fn cycles() -> Vec<(ClosureRecord, bool, Rings)> {
    let refraction = ClosureRecord::Refraction { color: Rgb::splat(0.9), roughness: 1.0, ior: 1.5 };
    let copper = Rgb([0.9, 0.6, 0.2]);
    vec![
        (glossy(0.5, 0.7), true, gray([0.4245, 0.4114, 0.4107])),
        (ClosureRecord::Glossy { color: Rgb([0.9, 0.5, 0.1]), roughness: 1.0, anisotropy: 0.0, rotation: 0.0, multiscatter: true }, true,
            [[0.8122, 0.3386, 0.0565], [0.7894, 0.2958, 0.0450], [0.7690, 0.2584, 0.0349]]),
        (glass(1.0, 0.5, 1.5), false, gray([0.9763, 0.9945, 1.0014])),
        (glass(1.0, 0.8, 1.5), false, gray([0.9547, 0.9953, 0.9963])),
        (glass(1.0, 0.4, 0.7), true, gray([0.9865, 0.9967, 1.0002])),
        (ClosureRecord::Glass { color: Rgb([0.9, 0.5, 0.1]), roughness: 0.7, ior: 1.45, multiscatter: true }, true,
            [[0.8869, 0.4636, 0.0873], [0.8919, 0.4767, 0.0918], [0.8976, 0.4917, 0.0970]]),
        (refraction, true, gray([0.6650, 0.7233, 0.8468])),
        (rough_diffuse(1.0, 1.0), true, gray([1.0, 1.0, 1.0])),
        (ClosureRecord::Diffuse { color: Rgb([0.9, 0.5, 0.1]), roughness: 0.3 }, true,
            [[0.8946, 0.4883, 0.0969], [0.8905, 0.4796, 0.0947], [0.8863, 0.4705, 0.0923]]),
        (ClosureRecord::Diffuse { color: Rgb([0.9, 0.5, 0.1]), roughness: 1.0 }, true,
            [[0.8839, 0.4664, 0.0914], [0.8720, 0.4416, 0.0850], [0.8593, 0.4153, 0.0783]]),
        (principled(|p| (p.base_color, p.diffuse_roughness) = (Rgb([0.9, 0.5, 0.1]), 1.0)), true,
            [[0.8925, 0.5190, 0.1836], [0.8789, 0.4745, 0.1394], [0.8647, 0.4375, 0.1134]]),
        (principled(|_| ()), true, gray([0.8171, 0.8112, 0.8075])),
        (principled(|p| (p.base_color, p.roughness) = (Rgb::WHITE, 0.7)), true, gray([0.9968, 0.9988, 0.9997])),
        (principled(|p| (p.base_color, p.roughness) = (Rgb([0.8, 0.3, 0.05]), 0.4)), true,
            [[0.8249, 0.3918, 0.1753], [0.8131, 0.3471, 0.1141], [0.8079, 0.3278, 0.0878]]),
        (principled(|p| (p.specular_ior_level, p.roughness) = (1.0, 0.3)), true, gray([0.8407, 0.8226, 0.8160])),
        (principled(|p| (p.ior, p.roughness) = (2.5, 0.6)), true, gray([0.8356, 0.8327, 0.8315])),
        (principled(|p| {
            (p.ior, p.roughness, p.base_color) = (2.0, 0.4, Rgb::splat(0.5));
            p.specular_tint = Rgb([1.0, 0.5, 0.2]);
        }), true, [[0.5963, 0.5506, 0.5235], [0.5680, 0.5171, 0.4867], [0.5545, 0.5005, 0.4683]]),
        (principled(|p| (p.metallic, p.base_color, p.roughness) = (1.0, copper, 0.3)), true,
            [[0.9084, 0.6382, 0.2899], [0.9004, 0.6029, 0.2118], [0.8993, 0.5977, 0.1985]]),
        (principled(|p| {
            (p.metallic, p.base_color, p.roughness) = (1.0, copper, 0.6);
            p.specular_tint = Rgb([0.9, 0.5, 0.3]);
        }), true, [[0.8630, 0.4911, 0.1360], [0.8706, 0.5214, 0.1536], [0.8787, 0.5464, 0.1690]]),
        (principled(|p| (p.metallic, p.base_color, p.roughness) = (0.5, Rgb::splat(0.7), 0.4)), true,
            gray([0.7222, 0.7064, 0.7025])),
        (principled(|p| (p.coat_weight, p.coat_roughness, p.roughness) = (0.5, 0.4, 0.6)), true,
            gray([0.8241, 0.8155, 0.8108])),
        (principled(|p| {
            (p.coat_weight, p.coat_roughness, p.coat_ior) = (1.0, 0.1, 1.8);
            p.coat_tint = Rgb([0.9, 0.6, 0.3]);
        }), true, [[0.7859, 0.5762, 0.3848], [0.7532, 0.5203, 0.3021], [0.7479, 0.5226, 0.2995]]),
        (principled(|p| (p.coat_weight, p.metallic) = (1.0, 1.0)), true, gray([0.8266, 0.7966, 0.7939])),
        (principled(|p| {
            (p.coat_weight, p.coat_ior, p.coat_tint) = (0.7, 1.0, Rgb([0.9, 0.6, 0.3]));
        }), true, [[0.6563, 0.3625, 0.2596], [0.7144, 0.4730, 0.3110], [0.7474, 0.5701, 0.3989]]),
        (principled(|p| (p.transmission_weight, p.roughness) = (1.0, 0.3)), true, gray([0.9108, 0.9019, 0.8988])),
        (principled(|p| (p.transmission_weight, p.roughness) = (1.0, 0.8)), false, gray([0.8707, 0.8838, 0.8529])),
        (principled(|p| {
            (p.transmission_weight, p.roughness, p.specular_ior_level) = (0.5, 0.4, 0.9);
            (p.base_color, p.specular_tint) = (Rgb([0.8, 0.4, 0.9]), Rgb([0.8, 0.9, 0.3]));
        }), true, [[0.8643, 0.5825, 0.9166], [0.8557, 0.5542, 0.9106], [0.8518, 0.5416, 0.9074]]),
        (principled(|p| {
            (p.emission_strength, p.base_color, p.alpha) = (2.0, Rgb::splat(0.5), 0.8);
            (p.coat_weight, p.coat_tint) = (1.0, Rgb([0.9, 0.6, 0.3]));
        }), true, [[1.7929, 1.2068, 0.7022], [1.9120, 1.2761, 0.7021], [1.9676, 1.3764, 0.7936]]),
    ]
}

/// Cosines at the pixel centers of the picture Cycles made, 96 pixels wide, that lie in `ring`.
fn ring_cosines(ring: usize) -> Vec<f32> {
    let centers = || (0..96).map(|k| (f64::from(k) + 0.5) / 48.0 - 1.0);
    let squared = centers().flat_map(|x| centers().map(move |y| 1.0 - x * x - y * y));
    squared
        .filter(|s| *s > 0.0)
        .map(f64::sqrt)
        .filter(|c| (c * 8.0) as usize == ring)
        .map(|c| c as f32)
        .collect()
}

#[test]
fn materials_return_what_they_return_in_cycles() {
    let rings = [2, 4, 7].map(ring_cosines);
    for (closure, front, expected) in cycles() {
        let material = prepared(closure.clone());
        for (cosines, expected) in rings.iter().zip(expected) {
            let mut sum = Rgb::BLACK;
            for &cos in cosines {
                let bsdf = seen(&material, cos, front);
                sum += bsdf.albedo(LobeSet::ALL) + bsdf.emission + bsdf.transparency;
            }
            for (channel, (sum, expected)) in sum.0.iter().zip(expected).enumerate() {
                let ours = sum / cosines.len() as f32;
                let off = (ours / expected - 1.0) * 100.0;
                assert!(
                    off.abs() < 1.0,
                    "{closure:?}, channel {channel}: {ours} for {expected}, {off:+.2} %"
                );
            }
        }
    }
}

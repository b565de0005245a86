//! What a material says of itself, and that no input breaks it.

mod bsdf_support;

use bsdf_support::{
    IMPORTANCE, RADIANCE, diffuse, glass, glossy, mixed, prepared, principled, seen, sheen, table,
    translucent,
};
use glam::Vec3;
use proptest::prelude::*;
use rgp_renderer::bsdf::LobeSet;
use rgp_renderer::color::Rgb;
use rgp_renderer::scene::record::{ClosureRecord, PrincipledRecord, WeightedClosure};

fn half(closure: ClosureRecord) -> WeightedClosure {
    WeightedClosure { weight: Rgb::splat(0.5), closure }
}

#[test]
fn classes_follow_roughness() {
    let classes = |closure| prepared(closure).classes();
    assert_eq!(classes(diffuse(0.5)), LobeSet::DIFFUSE);
    assert_eq!(classes(sheen(0.5, 0.5)), LobeSet::DIFFUSE);
    assert_eq!(classes(translucent(0.5)), LobeSet::TRANSLUCENT);
    assert_eq!(classes(diffuse(0.0)), LobeSet::EMPTY);
    // Alpha is roughness squared: 0.25 is reached at 0.5.
    assert_eq!(classes(glossy(1.0, 0.5)), LobeSet::ROUGH);
    assert_eq!(classes(glossy(1.0, 0.49)), LobeSet::SHARP);
    assert_eq!(classes(glossy(1.0, 0.0)), LobeSet::DELTA);
    assert_eq!(classes(glass(1.0, 0.0, 1.5)), LobeSet::DELTA);
    assert_eq!(classes(glass(1.0, 0.3, 1.5)), LobeSet::SHARP);
    assert_eq!(classes(glass(1.0, 0.6, 1.5)), LobeSet::ROUGH | LobeSet::SHARP);
    assert_eq!(classes(principled(|_| ())), LobeSet::DIFFUSE | LobeSet::ROUGH);
    assert_eq!(classes(principled(|p| p.metallic = 1.0)), LobeSet::ROUGH);
    let glazed = principled(|p| (p.coat_weight, p.coat_roughness) = (1.0, 0.0));
    assert_eq!(classes(glazed), LobeSet::DIFFUSE | LobeSet::ROUGH | LobeSet::DELTA);
}

#[test]
fn every_lobe_belongs_to_the_classes_announced() {
    let closures = [
        diffuse(0.5),
        glossy(0.3, 0.2),
        glass(0.5, 0.7, 1.3),
        principled(|p| (p.metallic, p.transmission_weight, p.coat_weight) = (0.3, 0.5, 0.5)),
        principled(|p| (p.metallic, p.sheen_weight) = (1.0, 0.5)),
        translucent(0.5),
        sheen(0.5, 0.5),
    ];
    for closure in closures {
        let material = prepared(closure);
        let bsdf = seen(&material, 0.6, true);
        let classes =
            [LobeSet::DIFFUSE, LobeSet::ROUGH, LobeSet::SHARP, LobeSet::DELTA, LobeSet::TRANSLUCENT];
        for class in classes {
            assert_eq!(bsdf.has(class), material.classes().intersects(class));
        }
    }
}

#[test]
fn plain_diffuse_materials_take_the_fast_path() {
    assert_eq!(prepared(diffuse(0.4)).constant_lambert(), Some(Rgb::splat(0.4)));
    let lit = mixed(vec![half(diffuse(0.4)), half(ClosureRecord::Emission { radiance: Rgb::splat(6.0) })]);
    assert_eq!(lit.constant_lambert(), Some(Rgb::splat(0.2)));
    assert_eq!(lit.emission(), Rgb::splat(3.0));
    let flat = prepared(principled(|p| p.specular_ior_level = 0.0));
    assert_eq!(flat.constant_lambert(), Some(Rgb::splat(0.8)));
    assert_eq!(mixed(Vec::new()).constant_lambert(), Some(Rgb::BLACK));
    assert_eq!(prepared(principled(|_| ())).constant_lambert(), None);
    let veil = half(ClosureRecord::Transparent { color: Rgb::WHITE });
    let veiled = mixed(vec![half(diffuse(0.4)), veil]);
    assert_eq!((veiled.constant_lambert(), veiled.transparency()), (None, Rgb::splat(0.5)));
}

#[test]
fn specular_tint_is_the_color_head_on_and_never_near_zero() {
    assert_eq!(prepared(glossy(0.7, 0.8)).specular_tint(), Rgb::splat(0.7));
    let gold = Rgb([0.9, 0.6, 0.2]);
    let metal = prepared(principled(|p| (p.metallic, p.base_color) = (1.0, gold)));
    assert_eq!(metal.specular_tint(), gold);
    let plastic = prepared(principled(|_| ())).specular_tint();
    assert!((plastic - Rgb::splat(0.04)).map(f32::abs).max_channel() < 1e-6);
    assert_eq!(prepared(glossy(0.7, 0.2)).specular_tint(), Rgb::splat(0.02));
}

#[test]
fn coat_dims_emission() {
    let lamp = |coat: f32| {
        prepared(principled(|p| (p.emission_strength, p.coat_weight) = (2.0, coat))).emission().mean()
    };
    assert!((lamp(0.0) - 2.0).abs() < 1e-5);
    // The hemispherical reflectance of index 1.5 is 9.2 % (Kulla and Conty 2017).
    assert!((lamp(1.0) / 2.0 - (1.0 - 0.092)).abs() < 0.01);
}

#[test]
fn a_holdout_is_a_hole_of_its_share_and_scatters_nothing() {
    let whole = prepared(ClosureRecord::Holdout);
    assert_eq!(seen(&whole, 0.7, true).holdout(), 1.0);
    assert_eq!(whole.classes(), LobeSet::EMPTY);
    assert!(whole.is_opaque());
    let mix = mixed(vec![half(diffuse(0.8)), half(ClosureRecord::Holdout)]);
    assert_eq!(mix.constant_lambert(), None, "the quick path knows no holes");
    let bsdf = seen(&mix, 0.7, true);
    assert_eq!((bsdf.holdout(), bsdf.diffuse_albedo()), (0.5, Rgb::splat(0.4)));
}

#[test]
fn values_out_of_range_are_clamped_and_reported() {
    let white = WeightedClosure { weight: Rgb::WHITE, closure: diffuse(1.4) };
    let table = table(vec![white, half(glossy(f32::NAN, 0.2)), half(glossy(0.3, -1.0))]);
    let messages: Vec<_> = table.problems.iter().map(|p| (p.subject.as_str(), p.count)).collect();
    // Three channels are NaN; three channels above 1 and a roughness below 0.
    assert_eq!(messages, [("test", 3), ("test", 4)]);
    assert_eq!(seen(&table[0], 1.0, true).diffuse_albedo(), Rgb::WHITE);

    let many = (0..12).map(|_| half(glass(0.5, 0.3, 1.5))).collect();
    assert_eq!(bsdf_support::table(many).problems.len(), 1);
}

#[test]
fn grazing_pairs_are_finite() {
    let grazing = |x: f32| Vec3::new(x, 0.0, 1e-25);
    for roughness in [0.02, 0.3, 1.0] {
        let material = prepared(glossy(1.0, roughness));
        let bsdf = material.bsdf(grazing(1.0), Vec3::Z, Vec3::Z);
        for x in [-1.0, 1.0] {
            assert!(bsdf.eval(grazing(x), LobeSet::ALL, RADIANCE).is_finite());
            assert!(bsdf.pdf(grazing(x), LobeSet::ALL).is_finite());
        }
    }
}

fn any_value() -> impl Strategy<Value = f32> {
    prop_oneof![
        4 => 0.0_f32..=1.0,
        1 => prop::sample::select(vec![0.0, 1.0, 1e-4, 0.9999, 1e-20, -1.0, 7.0, 1e30, f32::NAN, f32::INFINITY]),
        1 => 0.0_f32..4.0,
    ]
}

fn any_color() -> impl Strategy<Value = Rgb> {
    prop::array::uniform3(any_value()).prop_map(Rgb)
}

fn any_closure() -> impl Strategy<Value = ClosureRecord> {
    prop_oneof![
        (any_color(), any_value()).prop_map(|(color, roughness)| ClosureRecord::Diffuse { color, roughness }),
        any_color().prop_map(|color| ClosureRecord::Translucent { color }),
        (any_color(), any_value()).prop_map(|(color, roughness)| ClosureRecord::Sheen { color, roughness }),
        (any_color(), any_value(), any_value(), any_value(), any::<bool>()).prop_map(
            |(color, roughness, anisotropy, rotation, multiscatter)| ClosureRecord::Glossy {
                color,
                roughness,
                anisotropy,
                rotation,
                multiscatter,
            },
        ),
        (any_color(), any_value(), any_value(), any::<bool>()).prop_map(
            |(color, roughness, ior, multiscatter)| ClosureRecord::Glass {
                color,
                roughness,
                ior,
                multiscatter
            }
        ),
        (any_color(), any_value(), any_value())
            .prop_map(|(color, roughness, ior)| ClosureRecord::Refraction { color, roughness, ior }),
        (prop::array::uniform5(any_color()), prop::array::uniform9(any_value()), any::<[bool; 2]>())
            .prop_map(|(c, v, [multiscatter, thin_wall])| {
                ClosureRecord::Principled(PrincipledRecord {
                    base_color: c[0],
                    specular_tint: c[1],
                    coat_tint: c[2],
                    emission_color: c[3],
                    metallic: v[0],
                    roughness: v[1],
                    multiscatter,
                    anisotropic: v[7],
                    anisotropic_rotation: v[8],
                    diffuse_roughness: v[3],
                    ior: v[2],
                    alpha: v[3],
                    specular_ior_level: v[4],
                    transmission_weight: v[5],
                    thin_wall,
                    subsurface_weight: v[6],
                    subsurface_anisotropy: v[7],
                    coat_weight: v[6],
                    coat_roughness: v[7],
                    coat_ior: v[8],
                    emission_strength: v[0],
                    sheen_weight: v[1],
                    sheen_roughness: v[2],
                    sheen_tint: c[4],
                })
            }),
    ]
}

fn any_direction() -> impl Strategy<Value = Vec3> {
    let component = prop_oneof![4 => -1.0_f32..1.0, 1 => prop::sample::select(vec![0.0, 1e-7, -1e-4, 1.0])];
    prop::array::uniform3(component).prop_map(|v| Vec3::from(v).try_normalize().unwrap_or(Vec3::Z))
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 3000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn nothing_is_ever_nan(
        closure in any_closure(),
        weight in any_color(),
        directions in prop::array::uniform4(any_direction()),
        u in prop::array::uniform3(0.0_f32..1.0),
    ) {
        let [wo, wi, ng, ns] = directions;
        let material = mixed(vec![WeightedClosure { weight, closure }, half(diffuse(0.5))]);
        prop_assert!(material.emission().is_finite() && material.specular_tint().is_finite());
        let bsdf = material.bsdf(wo, ng, ns);
        prop_assert!(bsdf.frame.ns.is_finite() && bsdf.frame.ns.is_normalized());
        prop_assert!(bsdf.emission.is_finite() && bsdf.transparency.is_finite());
        for mode in [RADIANCE, IMPORTANCE] {
            let value = bsdf.eval(wi, LobeSet::ALL, mode);
            prop_assert!(value.is_finite() && value.0.iter().all(|c| *c >= 0.0), "{value:?}");
            if let Some(sample) = bsdf.sample(u[0], [u[1], u[2]], LobeSet::ALL, mode) {
                prop_assert!(sample.wi.is_normalized() && sample.pdf_solid_angle > 0.0);
                prop_assert!(sample.weight.is_finite() && sample.weight.0.iter().all(|c| *c >= 0.0));
            }
        }
        prop_assert!(bsdf.pdf(wi, LobeSet::ALL).is_finite());
        let albedo = bsdf.albedo(LobeSet::ALL);
        prop_assert!(albedo.is_finite() && albedo.0.iter().all(|c| *c >= 0.0), "{albedo:?}");
    }
}

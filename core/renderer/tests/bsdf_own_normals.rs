//! Materials whose closures have shading normals of their own.

mod bsdf_support;

use std::f32::consts::FRAC_1_PI;

use bsdf_support::{
    IMPORTANCE, RADIANCE, Rng, at, chi_square, diffuse, glass, glossy, principled, rough_diffuse,
    sampled_albedo, sheen, significance, translucent,
};
use glam::{Quat, Vec3};
use rgp_renderer::bsdf::{Bsdf, LobeSet, MaterialTable};
use rgp_renderer::color::Rgb;
use rgp_renderer::scene::record::{ClosureRecord, NormalRecord, WeightedClosure};
use rgp_renderer::scene::{Material, MaterialProgram};
use rgp_renderer::shader::{Instruction, Program, Registers};

/// A material of equal shares that links normals: by closure, and for its coat alone or not. Their registers count up.
struct Linked(MaterialTable);

impl Linked {
    fn new(closures: &[ClosureRecord], normals: &[(usize, bool)]) -> Self {
        let weight = Rgb::splat(1.0 / closures.len() as f32);
        let closures = closures.iter().map(|closure| WeightedClosure { weight, closure: closure.clone() });
        let instructions = vec![Instruction::Constant { value: [0.0; 4] }; normals.len()];
        let normals = (0_u16..).zip(normals);
        let program = MaterialProgram {
            program: Program::new(instructions, 0).expect("a program"),
            outputs: Vec::new(),
            normal: None,
            normals: normals
                .map(|(register, &(closure, coat))| NormalRecord { closure, coat, register })
                .collect(),
            tangents: Vec::new(),
        };
        let material = Material {
            name: "test".into(),
            closures: closures.collect(),
            program: Some(program),
            absorption: Rgb::BLACK,
        };
        Self(MaterialTable::build(&[material]))
    }

    fn count(&self) -> usize {
        self.0[0].varying().expect("a program").normals().len()
    }

    /// Its BSDF on a surface that faces +z, whose linked normals are `normals`.
    fn seen(&self, wo: Vec3, normals: &[Vec3]) -> Bsdf<'_> {
        let varying = self.0[0].varying().expect("a program");
        let normals: Vec<Vec3> = std::iter::once(Vec3::Z).chain(normals.iter().copied()).collect();
        self.0[0].at(varying, &Registers::new(), &normals).into_bsdf(wo, Vec3::Z, Vec3::Z)
    }
}

fn leaning(x: f32, y: f32) -> Vec3 {
    Vec3::new(x, y, (1.0 - x * x - y * y).sqrt())
}

/// Where a mirror facing `normal` sends the view.
fn mirrored(wo: Vec3, normal: Vec3) -> Vec3 {
    normal * (2.0 * wo.dot(normal)) - wo
}

fn coated() -> ClosureRecord {
    principled(|p| {
        p.coat_weight = 1.0;
        p.coat_roughness = 0.3;
        p.roughness = 0.5;
        p.metallic = 0.4;
        p.sheen_weight = 0.5;
    })
}

/// Materials of many kinds, each with two normals besides the surface's own at most.
fn materials() -> Vec<(&'static str, Linked)> {
    vec![
        ("a bumped diffuse", Linked::new(&[diffuse(0.8)], &[(0, false)])),
        ("a bumped rough diffuse", Linked::new(&[rough_diffuse(0.8, 1.0)], &[(0, false)])),
        ("a bumped diffuse and a flat glossy", Linked::new(&[diffuse(0.8), glossy(0.9, 0.4)], &[(0, false)])),
        ("a flat diffuse and a bumped glossy", Linked::new(&[diffuse(0.8), glossy(0.9, 0.7)], &[(1, false)])),
        ("two bumps", Linked::new(&[diffuse(0.8), glossy(0.9, 0.6)], &[(0, false), (1, false)])),
        ("a clean coat over bumps", Linked::new(&[coated()], &[(0, false)])),
        ("a bumped coat", Linked::new(&[coated()], &[(0, true)])),
        ("coat and base with their own bumps", Linked::new(&[coated()], &[(0, false), (0, true)])),
        ("bumped glass and flat sheen", Linked::new(&[glass(1.0, 0.5, 1.4), sheen(0.8, 0.6)], &[(0, false)])),
        ("bumped cloth", Linked::new(&[translucent(0.8), sheen(0.8, 0.6)], &[(0, false), (1, false)])),
    ]
}

fn normals_of(material: &Linked) -> Vec<Vec3> {
    [leaning(0.3, 0.1), leaning(-0.15, 0.35)][..material.count() - 1].to_vec()
}

#[test]
fn directions_are_drawn_from_their_density() {
    let materials = materials();
    let cosines = [0.95, 0.5, 0.15];
    let level = significance(materials.len() * cosines.len());
    for (seed, (name, material)) in (0..).zip(&materials) {
        for cos in cosines {
            let normals = normals_of(material);
            let bsdf = material.seen(at(cos), &normals);
            let poles = [mirrored(at(cos), normals[0]), -at(cos)];
            let p = chi_square(&bsdf, LobeSet::ALL, poles, seed);
            assert!(p > level, "{name} at cosine {cos}: p = {p:.2e}, below {level:.2e}");
        }
    }
}

#[test]
fn no_light_is_made_and_little_lost() {
    let metal = principled(|p| (p.metallic, p.base_color, p.coat_weight) = (1.0, Rgb::WHITE, 1.0));
    let velvet = principled(|p| (p.base_color, p.sheen_weight) = (Rgb::WHITE, 1.0));
    let white = [
        (vec![diffuse(1.0), glossy(1.0, 0.6)], vec![(0, false)]),
        (vec![diffuse(1.0), glossy(1.0, 0.3)], vec![(1, false)]),
        (vec![glossy(1.0, 0.0), glossy(1.0, 0.5)], vec![(0, false), (1, false)]),
        (vec![metal.clone()], vec![(0, false)]),
        (vec![metal], vec![(0, true)]),
        (vec![velvet], vec![(0, false)]),
        (vec![rough_diffuse(1.0, 1.0)], vec![(0, false)]),
    ];
    let albedo = |bsdf: &Bsdf<'_>| sampled_albedo(bsdf, LobeSet::ALL, RADIANCE, 24);
    for (index, (closures, links)) in white.iter().enumerate() {
        let (flat, material) = (Linked::new(closures, &[]), Linked::new(closures, links));
        for cos in [1.0, 0.6, 0.2] {
            let whole = albedo(&flat.seen(at(cos), &[]));
            for (lean, lost) in [(0.02, 0.01), (0.3, 1.0), (0.8, 1.0)] {
                let normals = [leaning(lean, 0.0), leaning(0.0, lean)];
                let found = albedo(&material.seen(at(cos), &normals[..material.count() - 1]));
                let allowed = whole - lost..1.003;
                assert!(
                    allowed.contains(&found),
                    "{index} leaning {lean} at cosine {cos}: {found} of {whole}"
                );
            }
        }
    }
}

#[test]
fn a_diffuse_lobe_has_the_cosine_to_its_own_normal() {
    let material = Linked::new(&[diffuse(0.6), glossy(0.0, 0.5)], &[(0, false)]);
    let normal = Vec3::new(0.6, 0.0, 0.8);
    let bsdf = material.seen(at(0.9), &[normal]);
    let wi = Vec3::new(0.48, 0.6, 0.64);
    // tan² of the leaning is 0.5625, α² an eighth of it; tan² of the light's angle 1.4414. The masking of GGX is
    // 2 / (1 + √(1 + α² tan²)).
    let masking = 2.0 / (1.0 + (1.0 + 0.125 * 0.5625 * 1.441_406_3_f32).sqrt());
    let expected = 0.5 * 0.6 * FRAC_1_PI * 0.8 * masking;
    let found = bsdf.eval(wi, LobeSet::ALL, RADIANCE).mean() * wi.z;
    assert!((found / expected - 1.0).abs() < 1e-5, "{found} against {expected}");
    // Below the bump's horizon there is nothing, though it is above the surface.
    assert!(bsdf.eval(Vec3::new(-0.95, 0.0, 0.312_249_9), LobeSet::ALL, RADIANCE).is_black());
}

/// The one direction of the smooth reflection whose lobe `wo` is mirrored by, among samples.
fn reflections(bsdf: &Bsdf<'_>) -> Vec<Vec3> {
    let mut found: Vec<Vec3> = Vec::new();
    for i in 0..1000 {
        let sample = bsdf.sample((i as f32 + 0.5) / 1000.0, [0.5; 2], LobeSet::DELTA, RADIANCE);
        if let Some(sample) = sample.filter(|sample| found.iter().all(|wi| wi.distance(sample.wi) > 1e-4)) {
            found.push(sample.wi);
        }
    }
    found
}

#[test]
fn coat_and_base_mirror_about_their_own_normals() {
    let smooth =
        principled(|p| (p.metallic, p.roughness, p.coat_weight, p.coat_roughness) = (1.0, 0.0, 1.0, 0.0));
    let (wo, bump, other) = (at(0.8), leaning(0.2, 0.1), leaning(-0.1, 0.15));
    let cases = [
        (vec![(0, false)], vec![bump], [Vec3::Z, bump]),
        (vec![(0, true)], vec![bump], [bump, Vec3::Z]),
        (vec![(0, false), (0, true)], vec![bump, other], [other, bump]),
    ];
    for (links, normals, [coat, base]) in cases {
        let material = Linked::new(std::slice::from_ref(&smooth), &links);
        let found = reflections(&material.seen(wo, &normals));
        assert_eq!(found.len(), 2, "{links:?}");
        assert!(found[0].distance(mirrored(wo, coat)) < 1e-5, "{links:?}: coat");
        assert!(found[1].distance(mirrored(wo, base)) < 1e-5, "{links:?}: base");
    }
}

#[test]
fn what_links_no_normal_keeps_the_path_of_one() {
    for (closure, links) in [
        (principled(|p| p.coat_weight = 1.0), vec![]),
        (principled(|_| ()), vec![(0, true)]),
        (ClosureRecord::Transparent { color: Rgb::WHITE }, vec![(0, false)]),
    ] {
        assert_eq!(Linked::new(&[closure], &links).count(), 1);
    }
}

#[test]
fn nothing_leaves_below_the_surface() {
    let (mut rng, mut refracted) = (Rng(5), 0);
    for (name, material) in materials() {
        let passes = name.contains("glass") || name.contains("cloth");
        for _ in 0..2000 {
            let wo = rng.direction();
            let bsdf = material.seen(wo, &normals_of(&material));
            let wi = rng.direction();
            if wi.dot(bsdf.frame.ng) < 0.0 && !passes {
                assert!(bsdf.eval(wi, LobeSet::ALL, RADIANCE).is_black(), "{name}");
            }
            if let Some(sample) = bsdf.sample(rng.next(), [rng.next(), rng.next()], LobeSet::ALL, RADIANCE) {
                assert_eq!(sample.wi.dot(bsdf.frame.ng) < 0.0, sample.is_transmission, "{name}");
                assert!(sample.weight.is_finite() && (passes || !sample.is_transmission), "{name}");
                refracted += u32::from(sample.is_transmission);
            }
        }
    }
    assert!(refracted > 500);
}

#[test]
fn a_photon_gives_what_the_viewer_sees() {
    let (mut rng, mut seen) = (Rng(8), 0);
    for (name, material) in materials() {
        let normals = normals_of(&material);
        for _ in 0..2000 {
            let (wo, wi) = (rng.direction(), rng.direction());
            if wo.z.abs().min(wi.z.abs()) < 0.01 {
                continue;
            }
            let photon = material.seen(wo, &normals).eval(wi, LobeSet::ALL, IMPORTANCE);
            let viewer = material.seen(wi, &normals).eval(wo, LobeSet::ALL, RADIANCE);
            assert!((photon - viewer).map(f32::abs).max_channel() <= 1e-4 * viewer.max_channel(), "{name}");
            seen += u32::from(!viewer.is_black());
        }
    }
    assert!(seen > 4000, "{seen}");
}

#[test]
fn irradiance_is_what_the_diffuse_lobes_see() {
    let (wo, wi) = (at(0.6), at(0.7));
    assert_eq!(Linked::new(&[diffuse(0.5)], &[]).seen(wo, &[]).lambert_factor(), Rgb::WHITE);
    for links in [vec![(0, false)], vec![(0, false), (1, false)]] {
        let material = Linked::new(&[diffuse(0.8), diffuse(0.3)], &links);
        let normals = normals_of(&material);
        let photon = material.seen(wo, &normals);
        // A photon leaves a diffuse surface as its irradiance over π times the albedo.
        let left = photon.eval(wi, LobeSet::DIFFUSE, IMPORTANCE);
        let read = material.seen(wi, &normals).diffuse_albedo() * photon.lambert_factor() * FRAC_1_PI;
        assert!((left - read).map(f32::abs).max_channel() < 1e-5, "{left:?} against {read:?}");
    }
}

#[test]
fn bins_hold_what_the_viewer_sees() {
    let material = Linked::new(&[diffuse(0.8), glossy(0.2, 0.9)], &[(1, false)]);
    let (mut rng, normals, mut seen) = (Rng(6), [leaning(0.3, 0.1)], 0);
    for _ in 0..500 {
        let [wo, wi] = [0, 1].map(|_| {
            let direction = rng.direction();
            Vec3::new(direction.x, direction.y, direction.z.abs().max(0.05)).normalize()
        });
        let left = material.seen(wo, &normals).eval_rough(&[[wi.x], [wi.y], [wi.z]]);
        let viewer = material.seen(wi, &normals);
        let expected = viewer.eval(wo, LobeSet::ROUGH, RADIANCE);
        // A normal that would mirror the photon below the surface is bent for the photon, not for the viewer.
        if mirrored(wo, normals[0]).z.min(mirrored(wi, normals[0]).z) < 0.02 {
            continue;
        }
        let found = Rgb([0, 1, 2].map(|c| left[c][0])) * viewer.rough_gain();
        assert!((found - expected).map(f32::abs).max_channel() <= 1e-3 * expected.max_channel(), "{wo} {wi}");
        seen += 1;
    }
    assert!(seen > 200, "{seen}");
}

#[test]
fn a_surface_that_is_turned_keeps_its_normals() {
    let mut rng = Rng(9);
    let rotation = Quat::from_axis_angle(Vec3::new(0.6, 0.0, 0.8), 1.1);
    for (name, material) in materials() {
        let normals = normals_of(&material);
        for _ in 0..500 {
            let (wo, wi) = (rng.direction(), rng.direction());
            for mode in [RADIANCE, IMPORTANCE] {
                let still = material.seen(wo, &normals).eval(wi, LobeSet::ALL, mode);
                let turned =
                    material.seen(wo, &normals).turned(rotation).eval(rotation * wi, LobeSet::ALL, mode);
                let apart = (still - turned).map(f32::abs).max_channel();
                assert!(apart <= 1e-3 * still.max_channel() + 1e-6, "{name}: {still:?} and {turned:?}");
            }
        }
    }
}

//! Shading normals that lean so far that the mirrored view would be below the surface.

mod bsdf_support;

use bsdf_support::{RADIANCE, glass, glossy, prepared, principled};
use glam::Vec3;
use rgp_renderer::bsdf::{Bsdf, LobeSet};
use rgp_renderer::scene::record::ClosureRecord;

/// Sines of how far the shading normal leans away from the viewer.
const LEANINGS: [f32; 4] = [0.08, 0.2, 0.5, 0.95];

/// The normals of a slope that is seen at a slant, from the front, and where from: `wo`, `ng`, `ns`.
fn slant(lean: f32) -> (Vec3, Vec3, Vec3) {
    (Vec3::new(-0.995, 0.0, 0.1).normalize(), Vec3::Z, Vec3::new(lean, 0.0, (1.0 - lean * lean).sqrt()))
}

/// White mirrors and glass, all smooth.
fn mirrors() -> [(&'static str, ClosureRecord); 2] {
    [("glossy", glossy(1.0, 0.0)), ("glass", glass(1.0, 0.0, 1.8))]
}

/// Share of light that is scattered towards the viewer, on the mean over choices of lobes.
fn returned(bsdf: &Bsdf<'_>) -> f32 {
    const CHOICES: usize = 200;
    let share = |i: usize| {
        let u_lobe = (i as f32 + 0.5) / CHOICES as f32;
        bsdf.sample(u_lobe, [0.5, 0.5], LobeSet::ALL, RADIANCE).map_or(0.0, |sample| sample.weight.mean())
    };
    (0..CHOICES).map(share).sum::<f32>() / CHOICES as f32
}

#[test]
fn smooth_mirrors_and_glass_lose_no_light() {
    for (name, closure) in mirrors() {
        let material = prepared(closure);
        for lean in LEANINGS {
            let (wo, ng, ns) = slant(lean);
            for (side, wo) in [("front", wo), ("back", -wo)] {
                let share = returned(&material.bsdf(wo, ng, ns));
                assert!((share - 1.0).abs() < 0.02, "{name} leaning {lean}, {side}: {share}");
            }
        }
    }
}

/// It leans less, and in the same direction: what is mirrored is as high above the surface as it must be.
#[test]
fn a_normal_that_mirrors_below_is_turned_towards_the_geometric_one() {
    let material = prepared(glass(1.0, 0.0, 1.45));
    for (wo, height) in [
        (Vec3::new(-0.9, 0.4, 0.2), 0.01),
        (Vec3::new(-0.1, 0.99, 0.3), 0.01),
        (Vec3::new(0.3, -0.95, 0.05), 0.01),
        (Vec3::new(-0.8, 0.6, 0.005), 0.0045),
    ] {
        let wo = wo.normalize();
        for lean in [0.5_f32, 0.95, 0.99] {
            let given = Vec3::new(lean, 0.0, (1.0 - lean * lean).sqrt());
            let ns = material.bsdf(wo, Vec3::Z, given).frame.ns;
            let mirrored = 2.0 * wo.dot(given) * given - wo;
            if mirrored.z >= height {
                assert_eq!(ns, given);
                continue;
            }
            let mirrored = 2.0 * wo.dot(ns) * ns - wo;
            assert!((mirrored.z - height).abs() < 1e-4, "{wo}, {lean}: height {}", mirrored.z);
            assert!(ns.y.abs() < 1e-6 && ns.z > given.z, "{wo}, {lean}: {ns}");
        }
    }
}

#[test]
fn what_mirrors_above_keeps_its_normal() {
    let material = prepared(glossy(1.0, 0.0));
    let ns = Vec3::new(0.1, 0.0, 1.0).normalize();
    assert_eq!(material.bsdf(Vec3::new(0.6, 0.0, 0.8), Vec3::Z, ns).frame.ns, ns);
}

#[test]
fn what_is_diffuse_in_part_keeps_its_normal() {
    let plastic = prepared(principled(|p| p.roughness = 0.0));
    let (wo, ng, ns) = slant(0.08);
    assert_eq!(plastic.bsdf(wo, ng, ns).frame.ns, ns);
}

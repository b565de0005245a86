//! The GGX (Trowbridge–Reitz) distribution with Smith's height-correlated masking (Heitz 2014, "Understanding the
//! Masking-Shadowing Function in Microfacet-Based BRDFs"). `alpha` is Blender's roughness squared; where there are
//! two they are those along the x and y axes.

use std::f32::consts::{PI, TAU};

use glam::Vec3;

/// Density of microfacet normals per projected area, from the squared sine of the angle between microfacet and surface.
pub(super) fn distribution(alpha: f32, sin_squared: f32) -> f32 {
    let alpha2 = alpha * alpha;
    let spread = sin_squared + alpha2 * (1.0 - sin_squared).max(0.0);
    alpha2 / (PI * spread * spread)
}

/// Smith's auxiliary function Λ of a direction at `cos` from the normal, on either side.
pub(super) fn lambda(alpha: f32, cos: f32) -> f32 {
    let cos2 = (cos * cos).max(1e-12);
    let tan2 = (1.0 - cos2).max(0.0) / cos2;
    0.5 * ((1.0 + alpha * alpha * tan2).sqrt() - 1.0)
}

/// A microfacet normal visible from `wo` (both in the local frame, z the normal), its density
/// D · G1 · (wo·h) / cos (Dupuy and Benyoub 2023, "Sampling Visible GGX Normals with Spherical Caps").
pub(super) fn sample_visible_normal(alpha: [f32; 2], wo: Vec3, u: [f32; 2]) -> Vec3 {
    let stretched = Vec3::new(wo.x * alpha[0], wo.y * alpha[1], wo.z).normalize();
    let (sin_phi, cos_phi) = (TAU * u[0]).sin_cos();
    visible_normal(alpha, stretched, [cos_phi, sin_phi], u[1])
}

/// [`sample_visible_normal`] with the stretched direction and the azimuth (cos, sin) at hand.
pub(super) fn visible_normal(alpha: [f32; 2], stretched: Vec3, azimuth: [f32; 2], u: f32) -> Vec3 {
    let z = (1.0 - u) * (1.0 + stretched.z) - stretched.z;
    let sin = (1.0 - z * z).max(0.0).sqrt();
    let half = Vec3::new(sin * azimuth[0], sin * azimuth[1], z) + stretched;
    Vec3::new(half.x * alpha[0], half.y * alpha[1], half.z.max(0.0)).try_normalize().unwrap_or(Vec3::Z)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn projected_area_of_the_facets_is_one() {
        for alpha in [0.1, 0.5, 1.0] {
            let n = 200_000;
            let sum: f64 = (0..n)
                .map(|i| {
                    let cos = (i as f32 + 0.5) / n as f32;
                    f64::from(distribution(alpha, 1.0 - cos * cos) * cos * TAU) / f64::from(n)
                })
                .sum();
            assert!((sum - 1.0).abs() < 1e-3, "alpha {alpha}: {sum}");
        }
    }

    #[test]
    fn visible_normals_face_the_viewer() {
        for i in 0..1000 {
            let u = [(i as f32 * 0.618_034).fract(), (i as f32 * 0.754_878).fract()];
            let wo = Vec3::new(0.995, 0.0, 0.0998).normalize();
            for alpha in [[0.7; 2], [0.9, 0.1]] {
                assert!(sample_visible_normal(alpha, wo, u).dot(wo) >= 0.0);
            }
        }
    }
}

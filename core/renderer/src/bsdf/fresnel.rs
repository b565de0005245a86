//! Fresnel reflectances of smooth interfaces, and their means over the hemisphere.
//!
//! `cos` is the cosine between the direction and the (micro)normal, 0 to 1; `eta` is the index of refraction beyond the
//! interface over the one before it.

use glam::Vec3;

use crate::color::Rgb;

/// Reflectance of an unpolarized dielectric interface; 1 at total internal reflection.
pub(super) fn dielectric(cos: f32, eta: f32) -> f32 {
    let Some(cos_refracted) = cos_refracted(cos, eta) else { return 1.0 };
    let perpendicular = (cos - eta * cos_refracted) / (cos + eta * cos_refracted);
    let parallel = (cos_refracted - eta * cos) / (cos_refracted + eta * cos);
    0.5 * (perpendicular * perpendicular + parallel * parallel)
}

/// Cosine of the refracted direction (Snell's law); `None` at total internal reflection.
pub(super) fn cos_refracted(cos: f32, eta: f32) -> Option<f32> {
    let squared = 1.0 - (1.0 - cos * cos) / (eta * eta);
    (squared > 0.0).then(|| squared.sqrt())
}

/// `wo` refracted at the unit normal `normal` on its side; `None` at total internal reflection.
pub(super) fn refract(wo: Vec3, normal: Vec3, eta: f32) -> Option<Vec3> {
    let cos = wo.dot(normal);
    let cos_refracted = cos_refracted(cos, eta)?;
    Some((normal * (cos / eta - cos_refracted) - wo / eta).normalize())
}

/// Reflectance at normal incidence.
pub(super) fn f0_from_ior(ior: f32) -> f32 {
    let ratio = (ior - 1.0) / (ior + 1.0);
    ratio * ratio
}

/// The index of refraction above 1 whose reflectance at normal incidence is `f0`; Blender stops at 0.99.
pub(super) fn ior_from_f0(f0: f32) -> f32 {
    let root = f0.clamp(0.0, 0.99).sqrt();
    (1.0 + root) / (1.0 - root)
}

/// Where the dielectric curve stands between its value at normal incidence (0) and total reflection (1). Blender's
/// "generalized Schlick" interpolates a free F0 to white by it.
pub(super) fn dielectric_rise(cos: f32, eta: f32) -> f32 {
    let f0 = f0_from_ior(eta);
    ((dielectric(cos, eta) - f0) / (1.0 - f0)).clamp(0.0, 1.0)
}

/// Cosine-weighted mean of [`dielectric`] over the hemisphere (fit of Kulla and Conty 2017, "Revisiting Physically
/// Based Shading at Imageworks"; Cycles uses the same one).
pub(super) fn dielectric_mean(eta: f32) -> f32 {
    if eta < 1.0 {
        0.997_118 + eta * (0.1014 - eta * (0.965_241 + eta * 0.130_607))
    } else {
        (eta - 1.0) / (4.08567 + 1.00071 * eta)
    }
}

/// Schlick's weight, (1 − cos)⁵.
pub(super) fn schlick_rise(cos: f32) -> f32 {
    (1.0 - cos).clamp(0.0, 1.0).powi(5)
}

/// Metal after Kutz, Hasan and Edmondson 2021 ("Novel aspects of the Adobe Standard Material"): Schlick's curve from
/// `f0`, less `dip` · cos · (1 − cos)⁶, which tints the reflectance near 82°.
pub(super) fn metal(cos: f32, f0: Rgb, dip: Rgb) -> Rgb {
    let rise = schlick_rise(cos);
    let dent = dip * (cos * rise * (1.0 - cos));
    (f0.lerp(Rgb::WHITE, rise) - dent).map(|c| c.clamp(0.0, 1.0))
}

/// The `dip` of [`metal`] for which the reflectance at acos(1/7) is Schlick's times `tint`.
pub(super) fn metal_dip(f0: Rgb, tint: Rgb) -> Rgb {
    let rise = (6.0_f32 / 7.0).powi(5);
    f0.lerp(Rgb::WHITE, rise) * (Rgb::WHITE - tint) * (7.0 / (rise * 6.0 / 7.0))
}

/// Cosine-weighted mean of [`metal`] over the hemisphere.
pub(super) fn metal_mean(f0: Rgb, dip: Rgb) -> Rgb {
    f0.lerp(Rgb::WHITE, 1.0 / 21.0) - dip * (1.0 / 126.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Cosine-weighted mean by the midpoint rule.
    fn mean(f: impl Fn(f32) -> f32) -> f32 {
        let n = 20_000;
        (0..n).map(|i| (i as f32 + 0.5) / n as f32).map(|c| 2.0 * c * f(c)).sum::<f32>() / n as f32
    }

    #[test]
    fn glass_reflects_four_percent_head_on_and_everything_at_grazing() {
        assert!((dielectric(1.0, 1.5) - 0.04).abs() < 1e-6);
        assert!((dielectric(0.0, 1.5) - 1.0).abs() < 1e-6);
        assert!((dielectric(0.5, 1.0)).abs() < 1e-12);
    }

    #[test]
    fn brewster_angle_has_no_parallel_part() {
        let cos = (1.0_f32 / (1.0 + 1.5 * 1.5)).sqrt();
        let perpendicular = ((1.0 - 1.5_f32 * 1.5) / (1.0 + 1.5 * 1.5)).powi(2);
        assert!((dielectric(cos, 1.5) - 0.5 * perpendicular).abs() < 1e-6);
    }

    #[test]
    fn reflectance_is_the_same_from_both_sides() {
        for cos in [0.2, 0.5, 0.9] {
            let inside = cos_refracted(cos, 1.5).expect("no total reflection from outside");
            assert!((dielectric(cos, 1.5) - dielectric(inside, 1.0 / 1.5)).abs() < 1e-6);
        }
        assert_eq!(dielectric(0.3, 1.0 / 1.5), 1.0);
    }

    #[test]
    fn means_match_integrals() {
        for eta in [0.5, 0.7, 1.2, 1.5, 2.5] {
            let exact = mean(|c| dielectric(c, eta));
            assert!((dielectric_mean(eta) - exact).abs() < 0.012, "eta {eta}: {exact}");
        }
        let (f0, tint) = (Rgb([0.9, 0.5, 0.2]), Rgb([1.0, 0.7, 0.4]));
        let dip = metal_dip(f0, tint);
        for k in 0..3 {
            let exact = mean(|c| metal(c, f0, dip).0[k]);
            assert!((metal_mean(f0, dip).0[k] - exact).abs() < 1e-3);
        }
        let edge = f0.lerp(Rgb::WHITE, schlick_rise(1.0 / 7.0)) * tint;
        assert!((metal(1.0 / 7.0, f0, dip) - edge).max_channel().abs() < 1e-5);
    }
}

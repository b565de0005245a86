//! Maps from the unit square.

use std::f32::consts::{FRAC_PI_4, PI};

use glam::{Vec2, Vec3};

/// Uniform on the unit disk, strata kept compact (Shirley and Chiu 1997). Without branches or library calls, so that loops
/// over it become vector code; the sine and cosine of angles up to 45° are Taylor polynomials good to 4e-7.
#[must_use]
#[inline]
pub fn concentric_disk(u: [f32; 2]) -> Vec2 {
    let (x, y) = (2.0 * u[0] - 1.0, 2.0 * u[1] - 1.0);
    let wide = x.abs() > y.abs();
    let (radius, other) = if wide { (x, y) } else { (y, x) };
    let ratio = if radius == 0.0 { 0.0 } else { other / radius };
    let a = FRAC_PI_4 * ratio;
    let a2 = a * a;
    let sin = a * (1.0 + a2 * (-1.0 / 6.0 + a2 * (1.0 / 120.0 - a2 * (1.0 / 5040.0))));
    let cos = 1.0 + a2 * (-0.5 + a2 * (1.0 / 24.0 + a2 * (-1.0 / 720.0 + a2 * (1.0 / 40320.0))));
    let (along, across) = (radius * cos, radius * sin);
    if wide { Vec2::new(along, across) } else { Vec2::new(across, along) }
}

/// Direction about +z with density cos θ / π.
#[must_use]
#[inline]
pub fn cosine_hemisphere(u: [f32; 2]) -> Vec3 {
    let d = concentric_disk(u);
    d.extend((1.0 - d.length_squared()).max(0.0).sqrt())
}

/// Direction about +z with density 1 / 2π, strata kept compact.
#[must_use]
pub fn uniform_hemisphere(u: [f32; 2]) -> Vec3 {
    let d = concentric_disk(u);
    let r2 = d.length_squared();
    (d * (2.0 - r2).max(0.0).sqrt()).extend(1.0 - r2)
}

/// Density of [`uniform_hemisphere`].
pub const UNIFORM_HEMISPHERE_PDF: f32 = 0.5 / PI;

#[cfg(test)]
mod tests {
    use super::*;

    /// Uniform: equal areas of the square become equal areas of the disk, and the map agrees with sine and cosine.
    #[test]
    fn concentric_disk_is_uniform() {
        let n = 200;
        let (mut inner, mut turned) = (0, 0);
        for i in 0..n * n {
            let u = [(i % n) as f32, (i / n) as f32].map(|v| (v + 0.5) / n as f32);
            let d = concentric_disk(u);
            let edge = (2.0 * u[0] - 1.0).abs().max((2.0 * u[1] - 1.0).abs());
            assert!((d.length() - edge).abs() < 1e-6, "squares become circles");
            inner += i32::from(d.length_squared() < 0.5);
            turned += i32::from(d.y.atan2(d.x).rem_euclid(FRAC_PI_4) < 0.5 * FRAC_PI_4);
        }
        let share = |count: i32| count as f32 / (n * n) as f32;
        assert!((share(inner) - 0.5).abs() < 0.01 && (share(turned) - 0.5).abs() < 0.01);
    }
}

//! Maps from the unit square.

use std::f32::consts::{FRAC_PI_4, PI};

use glam::{Vec2, Vec3};

/// Uniform on the unit disk, strata kept compact (Shirley and Chiu 1997).
#[must_use]
pub fn concentric_disk(u: [f32; 2]) -> Vec2 {
    let (x, y) = (2.0 * u[0] - 1.0, 2.0 * u[1] - 1.0);
    if x == 0.0 && y == 0.0 {
        return Vec2::ZERO;
    }
    let (radius, angle) =
        if x.abs() > y.abs() { (x, FRAC_PI_4 * (y / x)) } else { (y, 2.0 * FRAC_PI_4 - FRAC_PI_4 * (x / y)) };
    let (sin, cos) = angle.sin_cos();
    Vec2::new(radius * cos, radius * sin)
}

/// Direction about +z with density cos θ / π.
#[must_use]
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

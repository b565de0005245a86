//! Maps from the unit square to the domains lamps are sampled over. All keep areas in proportion.

use std::f32::consts::{FRAC_PI_4, PI};

use glam::{Vec2, Vec3};

use crate::math::Frame;

/// A point of the unit disk, by the concentric map of Shirley and Chiu 1997.
pub(super) fn disk(u: [f32; 2]) -> Vec2 {
    let [a, b] = u.map(|c| 2.0 * c - 1.0);
    if a == 0.0 && b == 0.0 {
        return Vec2::ZERO;
    }
    let (radius, angle) =
        if a.abs() > b.abs() { (a, FRAC_PI_4 * (b / a)) } else { (b, 2.0 * FRAC_PI_4 - FRAC_PI_4 * (a / b)) };
    Vec2::from_angle(angle) * radius
}

/// The numbers that [`disk`] takes to a point of the unit disk.
pub(super) fn from_disk(p: Vec2) -> [f32; 2] {
    let radius = p.length();
    let (a, b) = if p.x.abs() > p.y.abs() {
        let a = radius.copysign(p.x);
        (a, a * (p.y / p.x).atan() / FRAC_PI_4)
    } else if p.y != 0.0 {
        let b = radius.copysign(p.y);
        (b * (p.x / p.y).atan() / FRAC_PI_4, b)
    } else {
        (0.0, 0.0)
    };
    [a, b].map(|c| (0.5 * (c + 1.0)).clamp(0.0, 1.0))
}

/// A direction of the cone about `axis` that holds `1 − cos` up to `one_minus_cos`, with its own `1 − cos`. The pdf per
/// solid angle is 1 / (2π `one_minus_cos`). Written in 1 − cos, which stays exact for narrow cones.
pub(super) fn cone(axis: Vec3, one_minus_cos: f32, u: [f32; 2]) -> (Vec3, f32) {
    let height = one_minus_cos * u[0];
    (about(axis, height, u[1]), height)
}

/// A direction of the whole sphere; the pdf per solid angle is 1 / (4π).
pub(super) fn sphere(u: [f32; 2]) -> Vec3 {
    about(Vec3::Z, 2.0 * u[0], u[1])
}

/// The direction at `1 − cos` = `one_minus_cos` from `axis`, turned round it by the share `turn` of a full circle.
pub(super) fn about(axis: Vec3, one_minus_cos: f32, turn: f32) -> Vec3 {
    Frame::new(axis).from_local(tilted(one_minus_cos, Vec2::from_angle(2.0 * PI * turn))).normalize()
}

/// The direction at `1 − cos` = `one_minus_cos` from +Z, towards the unit vector `towards` of the plane.
pub(super) fn tilted(one_minus_cos: f32, towards: Vec2) -> Vec3 {
    let sin = (one_minus_cos * (2.0 - one_minus_cos)).max(0.0).sqrt();
    (towards * sin).extend(1.0 - one_minus_cos)
}

/// A direction about `normal` with pdf cos / π (Malley's method).
pub(super) fn cosine(normal: Vec3, u: [f32; 2]) -> Vec3 {
    let foot = disk(u);
    let cos = (1.0 - foot.length_squared()).max(0.0).sqrt();
    Frame::new(normal).from_local(foot.extend(cos)).normalize()
}

/// `1 − cos` of the angle between two unit vectors, exact to f32 also where the angle is small.
pub(super) fn one_minus_cos(a: Vec3, b: Vec3) -> f32 {
    0.5 * (a - b).length_squared()
}

/// Finds `x` in 0..=`end` where the rising function `f` reaches `target`; `f` returns value and slope. Newton's method,
/// kept inside a shrinking bracket.
pub(super) fn invert_rising(end: f64, target: f64, f: impl Fn(f64) -> (f64, f64)) -> f64 {
    let (mut low, mut high) = (0.0, end);
    let mut x = 0.5 * end;
    for _ in 0..32 {
        let (value, slope) = f(x);
        if value < target {
            low = x;
        } else {
            high = x;
        }
        let newton = x - (value - target) / slope;
        let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
        if (next - x).abs() <= 1e-9 * end {
            return next;
        }
        x = next;
    }
    x
}

//! How an area lamp's light is spread over directions: Blender's soft box grid, whose slats hide more of the lamp the
//! further one looks from the side. With half spread a and the angle x from the axis, radiance falls as
//! 1 − tan x / tan a and is normalised so that the flux does not depend on a.

use std::f32::consts::{FRAC_PI_2, PI, TAU};

use glam::{Vec2, Vec3};

use super::warp;
use crate::math::Frame;

/// Half angles below this (rad) are parallel light to f32.
const SMALLEST_HALF_ANGLE: f32 = 1e-4;

/// Spread of an area lamp.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Spread {
    /// Every direction, radiance constant.
    Full,
    /// A cone of less than 90 degrees about the axis.
    Narrow {
        /// Half spread a (rad).
        half_angle: f64,
        /// tan a.
        tan: f32,
        /// 1 / (tan a − a).
        normalization: f32,
    },
    /// Parallel light along the axis: no ray meets it.
    Parallel,
}

impl Spread {
    /// From Blender's full spread angle (rad).
    pub(super) fn new(full_angle: f32) -> Self {
        let half = 0.5 * full_angle;
        if half >= FRAC_PI_2 || half.is_nan() {
            return Self::Full;
        }
        if half < SMALLEST_HALF_ANGLE {
            return Self::Parallel;
        }
        let half_angle = f64::from(half);
        let tan = half_angle.tan();
        Self::Narrow { half_angle, tan: tan as f32, normalization: (1.0 / (tan - half_angle)) as f32 }
    }

    /// Radiance over that of the same lamp with full spread, in a direction whose angle from the axis has tangent `tan_x`.
    pub(super) fn attenuation(&self, tan_x: f32) -> f32 {
        match *self {
            Self::Full => 1.0,
            Self::Narrow { tan, normalization, .. } => ((tan - tan_x) * normalization).max(0.0),
            Self::Parallel => 0.0,
        }
    }

    /// The radius, over the distance to the lamp's plane, of the part of the plane a point gets light from.
    pub(super) fn reach(&self) -> f32 {
        match *self {
            Self::Full => f32::INFINITY,
            Self::Narrow { tan, .. } => tan,
            Self::Parallel => 0.0,
        }
    }

    /// A direction about `axis` with a pdf in proportion to attenuation × cosine.
    pub(super) fn sample(&self, axis: Vec3, u: [f32; 2]) -> Vec3 {
        match *self {
            Self::Full => warp::cosine(axis, u),
            Self::Narrow { half_angle, .. } => {
                let angle = polar_angle(half_angle, f64::from(u[0]));
                let ring = Vec2::from_angle(TAU * u[1]) * angle.sin() as f32;
                Frame::new(axis).from_local(ring.extend(angle.cos() as f32)).normalize()
            }
            Self::Parallel => axis,
        }
    }

    /// Peak of intensity over that of a lamp with full spread and the same power, at most.
    pub(super) fn peak(&self) -> f32 {
        match *self {
            Self::Full => 1.0,
            Self::Narrow { .. } => self.attenuation(0.0),
            Self::Parallel => PI,
        }
    }
}

/// The angle below which the share `u` of the flux leaves: the integral of cos x sin x (1 − tan x / tan a) is
/// (sin² x − cot a (x − sin x cos x)) / 2.
fn polar_angle(half_angle: f64, u: f64) -> f64 {
    let cot = 1.0 / half_angle.tan();
    let whole = 1.0 - half_angle * cot;
    warp::invert_rising(half_angle, u * whole, |x| {
        let (sin, cos) = x.sin_cos();
        (sin * sin - cot * (x - sin * cos), 2.0 * sin * (cos - cot * sin))
    })
}

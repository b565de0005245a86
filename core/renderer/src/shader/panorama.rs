//! Pictures around something: where a direction or point lies in them. The formulas are those of Blender's Environment Texture
//! and Image Texture.

use std::f32::consts::{FRAC_1_PI, FRAC_1_SQRT_2, TAU};

use glam::{Vec3, Vec4};
use serde::Deserialize;

use super::Value;

/// How a picture is laid around something.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Projection {
    /// All directions by longitude and latitude.
    Equirectangular,
    /// A photograph of a mirror ball.
    MirrorBall,
    /// Around the middle of a cube from 0 to 1, by longitude and latitude.
    Sphere,
    /// Around the z axis through that middle, z from 0 to 1.
    Tube,
}

/// Place of a direction of any length, or of a point, in the unit square.
pub(super) fn place(direction: Value, projection: Projection) -> Value {
    let middle = match projection {
        Projection::Equirectangular | Projection::MirrorBall => Vec3::ZERO,
        Projection::Sphere | Projection::Tube => Vec3::splat(0.5),
    };
    let d = direction.v.truncate() - middle;
    let length = d.length();
    let unit = if length > 0.0 { d / length } else { Vec3::ZERO };
    let [u, v] = match projection {
        Projection::Equirectangular => equirectangular(unit),
        Projection::MirrorBall => mirror_ball(unit),
        Projection::Sphere => around(d),
        Projection::Tube => [longitude(d), d.z + 0.5],
    };
    // Of an angle across the whole sphere: the mean of how it changes u and v.
    let per_radian = FRAC_1_PI * FRAC_1_SQRT_2;
    let width = if length > 0.0 { direction.width / length * per_radian } else { 0.0 };
    Value { v: Vec4::new(u, v, 0.0, 1.0), width }
}

/// Longitude and latitude of a direction of any length, from 0 to 1.
#[must_use]
pub fn around(d: Vec3) -> [f32; 2] {
    let length = d.length();
    let height = if length > 0.0 { d.z / length } else { 0.0 };
    [longitude(d), 0.5 + height.clamp(-1.0, 1.0).asin() * FRAC_1_PI]
}

/// 0.5 along +Y, more towards -X; 0 on the axis.
fn longitude(d: Vec3) -> f32 {
    if d.x == 0.0 && d.y == 0.0 { 0.0 } else { 0.5 - d.x.atan2(d.y) / TAU }
}

/// +X is the middle of the picture, +Z its top.
fn equirectangular(d: Vec3) -> [f32; 2] {
    let u = 0.5 - d.y.atan2(d.x) / TAU;
    let v = d.z.atan2(d.x.hypot(d.y)) * FRAC_1_PI + 0.5;
    [u, v]
}

/// The camera looks along +Y; the direction behind the ball is the picture's rim.
fn mirror_ball(d: Vec3) -> [f32; 2] {
    let half = Vec3::new(d.x, d.y - 1.0, d.z);
    let twice = 2.0 * (-0.5 * half.y).max(0.0).sqrt();
    let half = if twice > 0.0 { half / twice } else { half };
    [0.5 * (half.x + 1.0), 0.5 * (half.z + 1.0)]
}

/// How much darker the limb of the sun is than its middle.
const LIMB: f32 = 0.6;

/// The sun as the Sky Texture shows it; see [`super::Instruction::SunDisk`].
pub(super) struct SunDisk {
    pub(super) towards: [f32; 3],
    pub(super) radius: f32,
    pub(super) bottom: [f32; 3],
    pub(super) top: [f32; 3],
    pub(super) lowest: f32,
}

impl SunDisk {
    /// Its radiance along a direction. Looked at broadly it is as much larger and fainter.
    pub(super) fn seen(&self, direction: Value) -> Value {
        let (d, towards) = (direction.v.truncate().normalize_or_zero(), Vec3::from(self.towards));
        let angle = 2.0 * (0.5 * (d - towards).length()).min(1.0).asin();
        let radius = self.radius + direction.width;
        if angle >= radius || d.z <= self.lowest {
            return Value::vector(Vec3::ZERO);
        }
        let height = 0.5 + 0.5 * (d.z.asin() - towards.z.clamp(-1.0, 1.0).asin()) / radius;
        let color = Vec3::from(self.bottom).lerp(Vec3::from(self.top), height);
        let limb = 1.0 - LIMB * (1.0 - (1.0 - (angle / radius).powi(2)).max(0.0).sqrt());
        Value::vector(color * (limb * (self.radius / radius).powi(2)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(d: Vec3, projection: Projection) -> [f32; 2] {
        let value = place(Value::vector(d), projection).v;
        [value.x, value.y]
    }

    #[test]
    fn directions_lie_where_blender_has_them() {
        let flat = |d| at(d, Projection::Equirectangular);
        assert_eq!(flat(Vec3::X), [0.5, 0.5]);
        assert_eq!(flat(Vec3::Y * 3.0), [0.25, 0.5]);
        assert_eq!(flat(Vec3::NEG_Y), [0.75, 0.5]);
        assert_eq!(flat(Vec3::Z)[1], 1.0);
        assert_eq!(flat(Vec3::NEG_Z)[1], 0.0);
        let ball = |d| at(d, Projection::MirrorBall);
        assert_eq!(ball(Vec3::NEG_Y), [0.5, 0.5]);
        let side = ball(Vec3::X);
        assert!((side[0] - 0.5 - 0.5 * FRAC_1_SQRT_2).abs() < 1e-6 && (side[1] - 0.5).abs() < 1e-6);
    }

    #[test]
    fn pictures_are_wrapped_around_the_middle() {
        let around = |x, y, z| Vec3::splat(0.5) + Vec3::new(x, y, z);
        for projection in [Projection::Sphere, Projection::Tube] {
            assert_eq!(at(around(0.0, 0.3, 0.0), projection), [0.5, 0.5]);
            assert_eq!(at(around(0.3, 0.0, 0.0), projection), [0.25, 0.5]);
        }
        assert_eq!(at(around(0.0, 0.0, 0.2), Projection::Sphere), [0.0, 1.0]);
        let raised = at(around(0.0, 3.0, 0.25), Projection::Tube);
        assert_eq!(raised, [0.5, 0.75]);
    }
}

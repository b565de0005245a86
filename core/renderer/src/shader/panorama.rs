//! Pictures of all directions: where a direction lies in them. The formulas are those of Blender's Environment Texture.

use std::f32::consts::{FRAC_1_PI, FRAC_1_SQRT_2, TAU};

use glam::{Vec3, Vec4};

use super::Value;

/// Place of a direction of any length in the unit square: an equirectangular panorama, or a photograph of a mirror `ball`.
pub(super) fn place(direction: Value, ball: bool) -> Value {
    let d = direction.v.truncate();
    let length = d.length();
    let d = if length > 0.0 { d / length } else { Vec3::ZERO };
    let [u, v] = if ball { mirror_ball(d) } else { equirectangular(d) };
    // Of an angle across the whole sphere: the mean of how it changes u and v.
    let per_radian = FRAC_1_PI * FRAC_1_SQRT_2;
    let width = if length > 0.0 { direction.width / length * per_radian } else { 0.0 };
    Value { v: Vec4::new(u, v, 0.0, 1.0), width }
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

    fn at(d: Vec3, ball: bool) -> [f32; 2] {
        let value = place(Value::vector(d), ball).v;
        [value.x, value.y]
    }

    #[test]
    fn directions_lie_where_blender_has_them() {
        assert_eq!(at(Vec3::X, false), [0.5, 0.5]);
        assert_eq!(at(Vec3::Y * 3.0, false), [0.25, 0.5]);
        assert_eq!(at(Vec3::NEG_Y, false), [0.75, 0.5]);
        assert_eq!(at(Vec3::Z, false)[1], 1.0);
        assert_eq!(at(Vec3::NEG_Z, false)[1], 0.0);
        assert_eq!(at(Vec3::NEG_Y, true), [0.5, 0.5]);
        let side = at(Vec3::X, true);
        assert!((side[0] - 0.5 - 0.5 * FRAC_1_SQRT_2).abs() < 1e-6 && (side[1] - 0.5).abs() < 1e-6);
    }
}

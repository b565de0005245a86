//! The cone of a spot lamp. Its edge is blended as in Cycles: a smoothstep in the cosine of the angle from the axis.
//! The cone masks the light, it does not concentrate it: inside, a spot shines as a point lamp of the same power.

use std::f32::consts::{PI, TAU};

use glam::Vec3;

use super::warp;

/// A spot's cone. Angles are kept as 1 − cos, which stays exact for narrow cones.
#[derive(Clone, Copy, Debug)]
pub(super) struct SpotCone {
    axis: Vec3,
    /// 1 − cos of half the cone's angle.
    edge: f32,
    /// Share of the cone, in 1 − cos, over which the light fades.
    blend: f32,
}

impl SpotCone {
    /// Full `cone_angle` in radians. `None` without a direction or an angle.
    pub(super) fn new(axis: Vec3, cone_angle: f32, blend: f32) -> Option<Self> {
        let quarter = (0.25 * cone_angle).clamp(0.0, 0.5 * PI).sin();
        let edge = 2.0 * quarter * quarter;
        let axis = axis.try_normalize()?;
        let blend = if blend > 0.0 { blend.min(1.0) } else { 0.0 };
        (edge > 0.0).then_some(Self { axis, edge, blend })
    }

    /// Share of the point lamp's light that leaves along the unit vector `direction`.
    pub(super) fn attenuation(&self, direction: Vec3) -> f32 {
        let inside = self.edge - warp::one_minus_cos(self.axis, direction);
        let fade = self.edge * self.blend;
        if inside >= fade {
            // Also the hard edge of a cone without blend.
            return if inside >= 0.0 { 1.0 } else { 0.0 };
        }
        let t = (inside / fade).max(0.0);
        t * t * (3.0 - 2.0 * t)
    }

    /// Integral of the attenuation over all directions (sr): smoothstep covers half of what it spans.
    pub(super) fn solid_angle(&self) -> f32 {
        TAU * self.edge * (1.0 - 0.5 * self.blend)
    }

    /// A direction with a pdf in proportion to the attenuation.
    pub(super) fn sample(&self, u: [f32; 2]) -> Vec3 {
        let full = 1.0 - self.blend;
        let place = u[0] * (1.0 - 0.5 * self.blend);
        let height = if place <= full {
            place
        } else {
            // Flux outside t is the integral of smoothstep, t³ − t⁴/2.
            let outside = (0.5 * self.blend - (place - full)) / self.blend;
            let t = warp::invert_rising(1.0, f64::from(outside), |t| {
                (t * t * t * (1.0 - 0.5 * t), t * t * (3.0 - 2.0 * t))
            });
            1.0 - self.blend * t as f32
        };
        warp::about(self.axis, self.edge * height, u[1])
    }

    /// False where no direction from within `radius` of the lamp's center to the point at `offset` lies in the cone.
    pub(super) fn may_reach(&self, offset: Vec3, radius: f32) -> bool {
        let distance = offset.length();
        if distance <= radius * 1.001 {
            return true;
        }
        let half_angle = (1.0 - self.edge).clamp(-1.0, 1.0).acos();
        let angle = (self.axis.dot(offset) / distance).clamp(-1.0, 1.0).acos();
        angle <= half_angle + (radius / distance).asin() + 1e-3
    }
}

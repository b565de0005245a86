//! The cone of a spot lamp. Its edge is blended as in Cycles: a smoothstep in the cosine of the angle from the axis.
//! The cone masks the light, it does not concentrate it: inside, a spot shines as a point lamp of the same power.
//!
//! Where the object's scale differs along its axes, the cone is stretched to an elliptic one: a direction is masked as its
//! image in the lamp's own unscaled space.

use std::f32::consts::{PI, TAU};

use glam::{Vec2, Vec3};

use super::cluster::cos_less;
use super::warp;
use crate::math::Frame;
use crate::scene::Lamp;

/// Cones stretched further than this, or to less than its inverse, count as stretched this far.
const LARGEST_STRETCH: f32 = 1e4;

/// Directions this far outside a cone (rad) may still count as inside, in f32.
const ROUNDING: f32 = 1e-3;

/// Steps around a quarter of a stretched cone and across it that its solid angle is summed over.
const STEPS: [u16; 2] = [64, 64];

/// A spot's cone. Angles are kept as 1 − cos, which stays exact for narrow cones.
#[derive(Clone, Copy, Debug)]
pub(super) struct SpotCone {
    axis: Vec3,
    /// 1 − cos of half the cone's angle, before it is stretched.
    edge: f32,
    /// Share of the cone, in 1 − cos, over which the light fades.
    blend: f32,
    stretched: Option<Stretched>,
    /// Cosine of an angle just outside the round cone that holds it.
    cos_outside: f32,
}

/// What an elliptic cone has beside the round one it is stretched from.
#[derive(Clone, Copy, Debug)]
struct Stretched {
    /// The lamp's x and y, at right angles to the axis.
    frame: Frame,
    /// Factors along them.
    by: Vec2,
    /// Integral of the attenuation over all directions (sr).
    solid_angle: f32,
}

impl SpotCone {
    /// Full `cone_angle` in radians. `None` without a direction or an angle.
    pub(super) fn new(lamp: &Lamp, cone_angle: f32, blend: f32) -> Option<Self> {
        let quarter = (0.25 * cone_angle).clamp(0.0, 0.5 * PI).sin();
        let edge = 2.0 * quarter * quarter;
        let axis = lamp.axis.try_normalize()?;
        let blend = if blend > 0.0 { blend.min(1.0) } else { 0.0 };
        let mut cone =
            (edge > 0.0).then_some(Self { axis, edge, blend, stretched: None, cos_outside: -1.0 })?;
        let [x, y] = lamp.stretch.map(|by| by.clamp(LARGEST_STRETCH.recip(), LARGEST_STRETCH));
        if (x - 1.0).abs().max((y - 1.0).abs()) > 1e-5 {
            let tangent = lamp.x_axis.reject_from_normalized(axis).try_normalize()?;
            let frame = Frame { tangent, bitangent: axis.cross(tangent), normal: axis };
            let mut stretched = Stretched { frame, by: Vec2::new(x, y), solid_angle: 0.0 };
            cone.stretched = Some(stretched);
            stretched.solid_angle = cone.summed_solid_angle();
            cone.stretched = Some(stretched);
        }
        cone.cos_outside = (cone.half_angle() + ROUNDING).min(PI).cos();
        Some(cone)
    }

    /// Share of the point lamp's light that leaves along the unit vector `direction`.
    pub(super) fn attenuation(&self, direction: Vec3) -> f32 {
        let height = match &self.stretched {
            None => warp::one_minus_cos(self.axis, direction),
            Some(stretched) => stretched.unscaled_height(direction),
        };
        self.fade(height / self.edge)
    }

    /// Attenuation at the share `height` of the way from axis to edge, in 1 − cos.
    fn fade(&self, height: f32) -> f32 {
        let inside = 1.0 - height;
        if inside >= self.blend {
            // Also the hard edge of a cone without blend.
            return if inside >= 0.0 { 1.0 } else { 0.0 };
        }
        let t = (inside / self.blend).max(0.0);
        t * t * (3.0 - 2.0 * t)
    }

    /// Integral of the attenuation over all directions (sr): smoothstep covers half of what it spans.
    pub(super) fn solid_angle(&self) -> f32 {
        match &self.stretched {
            None => TAU * self.edge * (1.0 - 0.5 * self.blend),
            Some(stretched) => stretched.solid_angle,
        }
    }

    /// A direction, and the attenuation there over its pdf (sr). For a round cone this is [`SpotCone::solid_angle`]; for a
    /// stretched one that is the mean.
    pub(super) fn sample(&self, u: [f32; 2]) -> (Vec3, f32) {
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
        match &self.stretched {
            None => (warp::about(self.axis, self.edge * height, u[1]), self.solid_angle()),
            Some(stretched) => self.sample_stretched(stretched, height, u[1]),
        }
    }

    /// As [`SpotCone::sample`]: `turn` goes round the unscaled cone, `height` is spread between axis and edge of the
    /// stretched one as it would be in a round one. Both are near what the light is, the rest is weight.
    fn sample_stretched(&self, stretched: &Stretched, height: f32, turn: f32) -> (Vec3, f32) {
        let towards = Vec2::from_angle(TAU * turn) * stretched.by;
        let by = towards.length();
        let edge = self.stretched_edge(by);
        let direction = stretched.frame.from_local(warp::tilted(edge * height, towards / by)).normalize();
        let spread = self.fade(height);
        if spread == 0.0 {
            return (direction, 0.0);
        }
        // The angle of `towards` changes by the product of the factors over `by`² as `turn` does.
        let around = TAU * stretched.by.element_product() / (by * by);
        let across = edge * (1.0 - 0.5 * self.blend);
        (direction, around * across * self.attenuation(direction) / spread)
    }

    /// 1 − cos of the angle from the axis to the edge, where the cone is stretched `by` this factor.
    fn stretched_edge(&self, by: f32) -> f32 {
        let cos = 1.0 - self.edge;
        let sin = by * (self.edge * (2.0 - self.edge)).max(0.0).sqrt();
        // 1 − cos / √(sin² + cos²), without its difference of numbers near one.
        let whole = sin.hypot(cos);
        if cos > 0.0 { sin * sin / (whole * (whole + cos)) } else { 1.0 - cos / whole }
    }

    /// Mean weight of the samples of a stretched cone.
    fn summed_solid_angle(&self) -> f32 {
        let mid = |i: u16, steps: u16| (f32::from(i) + 0.5) / f32::from(steps);
        let [around, across] = STEPS;
        let weight = |i: u16, k: u16| f64::from(self.sample([mid(k, across), 0.25 * mid(i, around)]).1);
        let sum: f64 = (0..around).flat_map(|i| (0..across).map(move |k| weight(i, k))).sum();
        (sum / (f64::from(around) * f64::from(across))) as f32
    }

    pub(super) fn axis(&self) -> Vec3 {
        self.axis
    }

    /// Of the round cone that holds it (rad).
    pub(super) fn half_angle(&self) -> f32 {
        let edge = self.stretched.map_or(self.edge, |stretched| {
            let [x, y] = stretched.by.to_array().map(|by| self.stretched_edge(by));
            x.max(y)
        });
        (1.0 - edge).clamp(-1.0, 1.0).acos()
    }

    /// False where no direction from within `radius` of the lamp's center to the point at `offset` lies in the cone.
    pub(super) fn may_reach(&self, offset: Vec3, radius: f32) -> bool {
        let distance = offset.length();
        if distance <= radius * 1.001 {
            return true;
        }
        let sin = radius / distance;
        cos_less(self.axis.dot(offset) / distance, [sin, (1.0 - sin * sin).sqrt()]) >= self.cos_outside
    }
}

impl Stretched {
    /// 1 − cos of the angle from the axis of the unscaled image of a unit vector.
    fn unscaled_height(&self, direction: Vec3) -> f32 {
        let local = self.frame.to_local(direction);
        let across = local.truncate() / self.by;
        let whole = across.length().hypot(local.z);
        if local.z > 0.0 {
            across.length_squared() / (whole * (whole + local.z))
        } else {
            1.0 - local.z / whole
        }
    }
}

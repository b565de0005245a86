//! Bounds on the light of one emitter or of many together: where it is, where it goes and how strong it is (Conty Estevez
//! and Kulla 2018, "Importance Sampling of Many Lights with Adaptive Tree Splitting").

use std::f32::consts::{FRAC_PI_2, PI};

use glam::Vec3;

use super::Receiver;

/// Light that leaves at a grazing angle counts as leaving with this cosine: lamps do not all fade as it does.
const LEAST_LEAVING: f32 = 0.05;

/// Emitters within a box whose light leaves within a cone.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bounds {
    /// Box that holds them; for suns the unit vectors towards them.
    pub low: Vec3,
    /// See `low`.
    pub high: Vec3,
    /// Their normals lie within `spread` (rad) of this unit vector.
    pub axis: Vec3,
    pub spread: f32,
    /// Their light goes as far as this from their normals (rad).
    pub reach: f32,
    /// They emit to the other side as well.
    pub two_sided: bool,
    /// At infinity.
    pub distant: bool,
    /// Highest radiant intensity, summed (W·sr⁻¹ × squared length scale); for suns irradiance.
    pub intensity: f32,
    /// Sets of objects that any of them lights.
    pub receivers: u32,
}

impl Bounds {
    /// Bounds of what emits to all sides from a ball.
    pub(super) fn ball(center: Vec3, radius: f32, intensity: f32) -> Self {
        Self {
            low: center - radius,
            high: center + radius,
            axis: Vec3::Z,
            spread: PI,
            reach: FRAC_PI_2,
            two_sided: false,
            distant: false,
            intensity,
            receivers: u32::MAX,
        }
    }

    pub(super) fn middle(&self) -> Vec3 {
        0.5 * (self.low + self.high)
    }

    /// Bounds of both.
    pub(super) fn union(self, other: Self) -> Self {
        let (axis, spread) = joined([self.axis, other.axis], [self.spread, other.spread]);
        Self {
            low: self.low.min(other.low),
            high: self.high.max(other.high),
            axis,
            spread,
            reach: self.reach.max(other.reach),
            two_sided: self.two_sided || other.two_sided,
            distant: self.distant,
            intensity: self.intensity + other.intensity,
            receivers: self.receivers | other.receivers,
        }
    }

    /// How badly these bounds say where light goes: the paper's M_Ω times M_A times intensity.
    pub(super) fn cost(&self) -> f32 {
        let (spread, whole) = (self.spread, (self.spread + self.reach).min(PI));
        let solid_angle = 2.0 * PI * (1.0 - spread.cos())
            + FRAC_PI_2
                * (2.0 * whole * spread.sin() - (spread - 2.0 * whole).cos() - 2.0 * spread * spread.sin()
                    + spread.cos());
        let d = self.high - self.low;
        // Never 0, so that emitters in one plane or line are told apart by the rest.
        let area = d.x * d.y + d.y * d.z + d.z * d.x + 1e-3 * d.length_squared();
        self.intensity * solid_angle * area
    }
}

/// The cone that holds two cones, by their axes and half angles.
fn joined([a, b]: [Vec3; 2], spreads: [f32; 2]) -> (Vec3, f32) {
    let (wide, narrow) = if spreads[0] >= spreads[1] { (0, 1) } else { (1, 0) };
    let axes = [a, b];
    let between = a.angle_between(b);
    if (between + spreads[narrow]).min(PI) <= spreads[wide] {
        return (axes[wide], spreads[wide]);
    }
    let spread = 0.5 * (between + spreads[0] + spreads[1]);
    let across = axes[wide].cross(axes[narrow]);
    match across.try_normalize() {
        Some(across) if spread < PI => {
            let turn = glam::Quat::from_axis_angle(across, spread - spreads[wide]);
            ((turn * axes[wide]).normalize(), spread)
        }
        _ => (axes[wide], PI),
    }
}

/// [`Bounds`] in the form look-ups want: a ball instead of the box, cosines instead of angles.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cluster {
    /// Of the ball; for suns the unit vector towards the middle of them.
    center: Vec3,
    /// For suns the sine of the angle they fill about it, or 1.
    radius: f32,
    axis: Vec3,
    cos_spread: f32,
    sin_spread: f32,
    cos_reach: f32,
    two_sided: bool,
    distant: bool,
    intensity: f32,
    receivers: u32,
}

impl Cluster {
    pub(super) fn new(bounds: &Bounds) -> Self {
        let half = 0.5 * (bounds.high - bounds.low).length();
        let (center, radius) = if bounds.distant {
            (bounds.middle().normalize_or_zero(), if half < 0.5 { 2.0 * half } else { 1.0 })
        } else {
            (bounds.middle(), half)
        };
        let (sin_spread, cos_spread) = bounds.spread.sin_cos();
        Self {
            center,
            radius,
            axis: bounds.axis,
            cos_spread,
            sin_spread: sin_spread.max(0.0),
            // Rounding must not darken what is just within reach.
            cos_reach: bounds.reach.cos() - 1e-4,
            two_sided: bounds.two_sided,
            distant: bounds.distant,
            intensity: bounds.intensity,
            receivers: bounds.receivers,
        }
    }

    /// About the irradiance the cluster gives; 0 only where there is none.
    pub(super) fn irradiance(&self, receiver: &Receiver) -> f32 {
        if self.receivers & receiver.sets == 0 {
            return 0.0;
        }
        let Some((towards, distance_squared, [sin, cos])) = self.seen_from(receiver.p) else {
            return self.intensity / (self.radius * self.radius).max(1e-12);
        };
        let facing = -towards.dot(self.axis);
        let facing = if self.two_sided { facing.abs() } else { facing };
        let outside = cos_less(facing, [self.sin_spread, self.cos_spread]);
        let leaving = cos_less(outside, [sin, cos]);
        if leaving < self.cos_reach {
            return 0.0;
        }
        let arriving =
            receiver.normal.map_or(1.0, |normal| cos_less(normal.dot(towards), [sin, cos]).max(0.0));
        self.intensity * leaving.max(LEAST_LEAVING) * arriving / distance_squared
    }

    /// The highest cosine under which light from the cluster arrives; 1 where the receiver has no normal, 0 where it is not
    /// lit by the cluster.
    pub(super) fn incidence(&self, receiver: &Receiver) -> f32 {
        if self.receivers & receiver.sets == 0 {
            return 0.0;
        }
        let Some(normal) = receiver.normal else { return 1.0 };
        if self.distant {
            let seen = self.seen_from(receiver.p);
            return seen.map_or(1.0, |(towards, _, angle)| cos_less(normal.dot(towards), angle).max(0.0));
        }
        let to = self.center - receiver.p;
        incidence_of_ball(normal.dot(to), to.length_squared(), self.radius)
    }

    /// Unit vector to the center, squared distance, and sine and cosine of the angle the ball fills about it. `None` where
    /// light may come from everywhere.
    fn seen_from(&self, p: Vec3) -> Option<(Vec3, f32, [f32; 2])> {
        if self.distant {
            // Beyond a right angle there is no bound.
            return (self.radius < 1.0)
                .then(|| (self.center, 1.0, [self.radius, (1.0 - self.radius * self.radius).sqrt()]));
        }
        let to = self.center - p;
        let distance_squared = to.length_squared();
        let radius_squared = self.radius * self.radius;
        if distance_squared <= radius_squared {
            return None;
        }
        let sin_squared = radius_squared / distance_squared;
        let angle = [sin_squared.sqrt(), (1.0 - sin_squared).sqrt()];
        Some((to / distance_squared.sqrt(), distance_squared, angle))
    }
}

/// The highest cosine with a surface's normal of a direction from there to a ball, at least 0. The ball's center lies `height`
/// above the surface's plane.
#[inline(always)]
pub(super) fn incidence_of_ball(height: f32, distance_squared: f32, radius: f32) -> f32 {
    let tangent_squared = distance_squared - radius * radius;
    let beside = (distance_squared - height * height).max(0.0).sqrt();
    // As `cos_less` of the angles.
    let partly = (height * tangent_squared.max(0.0).sqrt() + beside * radius) / distance_squared;
    let holds_normal = (tangent_squared <= 0.0) | ((height > 0.0) & (height * height >= tangent_squared));
    if holds_normal { 1.0 } else { partly.max(0.0) }
}

/// Cosine of an angle less another, at least 0: cos(max(a − b, 0)) from cos a, sin b and cos b.
pub(super) fn cos_less(cos_a: f32, [sin_b, cos_b]: [f32; 2]) -> f32 {
    if cos_a >= cos_b {
        return 1.0;
    }
    let sin_a = (1.0 - cos_a * cos_a).max(0.0).sqrt();
    cos_a * cos_b + sin_a * sin_b
}

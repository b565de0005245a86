//! Sun lamps: a disk at infinity of uniform radiance, which gives a surface facing its middle the lamp's irradiance.

use std::f32::consts::{FRAC_1_PI, FRAC_PI_2, TAU};

use glam::Vec3;

use super::cluster::Bounds;
use super::distant::SceneBall;
use super::{Crossing, LightSample, Photon, warp};
use crate::color::Rgb;
use crate::scene::Lamp;

/// Half angles below this (rad) are parallel light to f32.
const SMALLEST_HALF_ANGLE: f32 = 1e-4;

/// A sun.
#[derive(Clone, Debug)]
pub(super) struct SunLamp {
    /// Unit vector towards the middle of the sun.
    towards: Vec3,
    /// On a surface facing it (W·m⁻²).
    irradiance: Rgb,
    /// 1 − cos of half the angular diameter; 0 for parallel light.
    cone: f32,
    /// Irradiance over radiance; 1 for parallel light.
    projected_solid_angle: f32,
}

impl SunLamp {
    /// From the angular diameter (rad). `None` without a direction.
    pub(super) fn new(lamp: &Lamp, angle: f32) -> Option<Self> {
        let towards = -lamp.axis.try_normalize()?;
        let half = 0.5 * angle;
        let (cone, projected_solid_angle) = if half >= SMALLEST_HALF_ANGLE {
            let half = half.min(FRAC_PI_2);
            (2.0 * (0.5 * half).sin().powi(2), half.sin().powi(2) / FRAC_1_PI)
        } else {
            (0.0, 1.0)
        };
        Some(Self { towards, irradiance: lamp.power, cone, projected_solid_angle })
    }

    /// False for parallel light.
    pub(super) fn has_extent(&self) -> bool {
        self.cone > 0.0
    }

    /// Flux that enters the scene's ball.
    pub(super) fn flux(&self, ball: &SceneBall) -> Rgb {
        let beams = if self.has_extent() { TAU * self.cone / self.projected_solid_angle } else { 1.0 };
        self.irradiance * (beams * ball.disk_area())
    }

    /// Of its disk (sr).
    pub(super) fn solid_angle(&self) -> f32 {
        TAU * self.cone
    }

    /// Where its light comes from.
    pub(super) fn bounds(&self) -> Bounds {
        let sin = (self.cone * (2.0 - self.cone)).max(0.0).sqrt();
        // A cube within the ball of that radius, since look-ups take the ball about the cube.
        Bounds {
            distant: true,
            ..Bounds::ball(self.towards, sin * 3_f32.sqrt().recip(), self.irradiance.mean())
        }
    }

    /// A direction towards the sun.
    pub(super) fn sample(&self, u: [f32; 2]) -> LightSample {
        let (wi, _) = warp::cone(self.towards, self.cone, u);
        let (radiance_over_pdf, pdf) = if self.has_extent() {
            (self.radiance() * (TAU * self.cone), 1.0 / (TAU * self.cone))
        } else {
            (self.irradiance, 1.0)
        };
        let is_delta = !self.has_extent();
        LightSample { wi, distance: f32::INFINITY, radiance_over_pdf, pdf, is_delta, point: None }
    }

    /// What a ray that leaves the scene along `wi` sees of the sun.
    pub(super) fn crossing(&self, wi: Vec3) -> Option<Crossing> {
        (warp::one_minus_cos(self.towards, wi) <= self.cone).then(|| Crossing {
            radiance: self.radiance(),
            pdf: 1.0 / (TAU * self.cone),
            distance: f32::INFINITY,
        })
    }

    /// A photon; every one carries the whole flux into the ball.
    pub(super) fn emit(&self, ball: &SceneBall, position: [f32; 2], direction: [f32; 2]) -> Photon {
        ball.photon(-warp::cone(self.towards, self.cone, direction).0, self.flux(ball), position)
    }

    fn radiance(&self) -> Rgb {
        self.irradiance / self.projected_solid_angle
    }
}

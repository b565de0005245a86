//! The world as a light: what rays that leave the scene see, and the photons that come from there.

use std::f32::consts::PI;

use glam::Vec3;

use super::distant::SceneBall;
use super::environment::Environment;
use super::{Photon, positive, warp};
use crate::color::Rgb;
use crate::scene::World;
use crate::scene::visibility;

/// Ray kinds through which photons meet surfaces.
const OF_PHOTONS: u32 = visibility::DIFFUSE | visibility::GLOSSY | visibility::TRANSMISSION;

/// Radiance from all directions.
#[derive(Clone, Debug)]
pub(super) struct WorldLight {
    /// What every direction gives, where they are all the same.
    radiance: Rgb,
    environment: Option<Environment>,
    /// Ray kinds that see it.
    pub(super) visibility: u32,
}

impl WorldLight {
    /// `environment`: what the world's program gives, if it has one.
    pub(super) fn new(world: &World, environment: Option<Environment>) -> Self {
        let radiance = if world.program.is_some() { Rgb::BLACK } else { positive(world.radiance) };
        Self { radiance, environment, visibility: world.visibility }
    }

    /// True where no light comes from.
    pub(super) fn is_black(&self) -> bool {
        self.radiance.is_black() && self.environment.is_none()
    }

    /// The part of it whose directions are sampled.
    pub(super) fn sampled(&self) -> Option<&Environment> {
        self.environment.as_ref().filter(|environment| environment.sampled() != 0)
    }

    /// Memory (bytes).
    pub(super) fn bytes(&self) -> usize {
        self.environment.as_ref().map_or(0, Environment::bytes)
    }

    /// Radiance that a ray of one kind sees.
    pub(super) fn seen(&self, direction: Vec3, kind: u32) -> Rgb {
        if self.visibility & kind == 0 {
            return Rgb::BLACK;
        }
        self.environment.as_ref().map_or(self.radiance, |environment| environment.radiance(direction, kind))
    }

    /// Flux that enters the scene's ball: the radiance from all sides times the disk across each direction.
    pub(super) fn flux(&self, ball: &SceneBall) -> Rgb {
        if self.visibility & OF_PHOTONS == 0 {
            return Rgb::BLACK;
        }
        let fluence = self.environment.as_ref().map_or(self.radiance * (4.0 * PI), Environment::fluence);
        fluence * ball.disk_area()
    }

    /// A photon: the mean of their fluxes is the whole flux into the ball.
    pub(super) fn emit(&self, ball: &SceneBall, position: [f32; 2], direction: [f32; 2]) -> Photon {
        match &self.environment {
            None => ball.photon(warp::sphere(direction), self.flux(ball), position),
            Some(environment) => {
                let sample = environment.sample(direction);
                ball.photon(-sample.wi, sample.radiance_over_pdf * ball.disk_area(), position)
            }
        }
    }
}

//! The world as a source of photons. Rays that leave the scene see its radiance by themselves.

use std::f32::consts::PI;

use super::distant::SceneBall;
use super::{Photon, warp};
use crate::color::Rgb;
use crate::scene::World;
use crate::scene::visibility;

/// Constant radiance from all directions.
#[derive(Clone, Copy, Debug)]
pub(super) struct WorldLight {
    /// 0 where diffuse surfaces, and so photons, do not see the world.
    radiance: Rgb,
}

impl WorldLight {
    pub(super) fn new(world: &World) -> Self {
        let is_seen = world.visibility & visibility::DIFFUSE != 0;
        Self { radiance: if is_seen { super::positive(world.radiance) } else { Rgb::BLACK } }
    }

    /// Flux that enters the scene's ball: radiance × 4π × the disk across each direction.
    pub(super) fn flux(&self, ball: &SceneBall) -> Rgb {
        self.radiance * (4.0 * PI * ball.disk_area())
    }

    /// A photon; every one carries the whole flux into the ball.
    pub(super) fn emit(&self, ball: &SceneBall, position: [f32; 2], direction: [f32; 2]) -> Photon {
        ball.photon(warp::sphere(direction), self.flux(ball), position)
    }
}

//! No structure at all: every gather hit is shaded and its path followed to the end, with next-event estimation and
//! roulette. Unbiased, and the reference for all others.

use glam::Vec3;

use crate::bsdf::LobeSet;
use crate::color::Rgb;
use crate::estimator::{Estimator, Footprint};
use crate::lit_scene::Surface;
use crate::math::Side;
use crate::sampling::Rng;

/// Knows nothing, so that the gather follows everything.
#[derive(Clone, Copy, Debug)]
pub struct Path;

impl Estimator for Path {
    type Place = ();

    /// Roulette ends a path long before.
    const LEAST_DEPTH: u32 = 1000;

    #[inline]
    fn place(&self, _p: Vec3, _side: Side, _wo: Vec3, _footprint: Footprint) -> Option<()> {
        None
    }

    fn read(&self, (): &()) -> Rgb {
        Rgb::BLACK
    }

    fn radiance(
        &self,
        _surface: &Surface<'_>,
        _lobes: LobeSet,
        _footprint: Footprint,
        _rng: &mut Rng,
    ) -> Option<Rgb> {
        None
    }
}

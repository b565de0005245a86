//! Look-ups that are answered together, for estimators that want many hits at once.

use crate::color::Rgb;
use crate::estimator::{Estimator, Footprint, reflectance};
use crate::film::{Film, PixelSample};
use crate::lit_scene::Surface;
use crate::sampling::Rng;
use crate::stats::RayCounts;

use super::Gatherer;

/// Gather rays of the tiles that are answered together, about: it bounds the memory of their hits.
const RAYS_AT_ONCE: usize = 2_000_000;

/// A look-up that waits for its answer.
#[derive(Clone, Copy, Debug)]
pub(super) struct Deferred<P> {
    pub(super) place: P,
    /// Share of what will be read that reaches the camera.
    pub(super) weight: Rgb,
    /// Lane of its block, then pixel of its tile.
    pub(super) pixel: usize,
}

/// What gather rays leave behind besides light.
#[derive(Debug)]
pub(super) struct Traces<P> {
    pub(super) rays: RayCounts,
    pub(super) deferred: Vec<Deferred<P>>,
}

impl<P> Default for Traces<P> {
    fn default() -> Self {
        Self { rays: RayCounts::default(), deferred: Vec::new() }
    }
}

/// A tile whose light lacks what was deferred.
pub(super) struct OpenTile<P> {
    /// In the film.
    pub(super) index: usize,
    pub(super) samples: Vec<PixelSample>,
    pub(super) deferred: Vec<Deferred<P>>,
}

impl<E: Estimator> Gatherer<'_, E> {
    /// Tiles of a pass that are answered together.
    pub(super) fn tiles_at_once(&self, film: &Film, pass: u32) -> usize {
        let pixels = film.tiles().first().map_or(1, |tile| tile.width as usize * tile.height as usize);
        let rays = pixels * self.rays_of_pass(pass).len().max(1);
        if E::DEFERS { (RAYS_AT_ONCE / rays).max(1) } else { usize::MAX }
    }

    /// Adds what was deferred to some tiles and gives them to the film.
    pub(super) fn close(&self, mut tiles: Vec<OpenTile<E::Place>>, film: &Film) {
        if tiles.is_empty() {
            return;
        }
        tiles.sort_by_key(|tile| tile.index);
        let places: Vec<E::Place> =
            tiles.iter().flat_map(|tile| tile.deferred.iter().map(|deferred| deferred.place)).collect();
        let mut answers = self.estimator.answer(&places).into_iter();
        for mut tile in tiles {
            for (deferred, answer) in tile.deferred.iter().zip(&mut answers) {
                tile.samples[deferred.pixel].indirect += deferred.weight * answer;
            }
            film.take(tile.index, tile.samples);
        }
    }
}

/// Where light that is read goes: one lane's sample, of which `weight` is its share.
pub(super) struct Target<'t, P> {
    pub(super) traces: &'t mut Traces<P>,
    pub(super) lane: usize,
    pub(super) weight: Rgb,
}

impl<P: Copy> Target<'_, P> {
    /// What is read at `place` times `throughput`: the answer, or black and a promise.
    pub(super) fn read<E: Estimator<Place = P>>(&mut self, estimator: &E, place: P, throughput: Rgb) -> Rgb {
        if E::DEFERS {
            let weight = self.weight * throughput;
            self.traces.deferred.push(Deferred { place, weight, pixel: self.lane });
            return Rgb::BLACK;
        }
        throughput * estimator.read(&place)
    }

    /// As [`Estimator::radiance`] times `throughput`.
    pub(super) fn radiance<E: Estimator<Place = P>>(
        &mut self,
        estimator: &E,
        surface: &Surface<'_>,
        footprint: Footprint,
        throughput: Rgb,
        rng: &mut Rng,
    ) -> Option<Rgb> {
        if E::DEFERS {
            let bsdf = &surface.bsdf;
            let place = estimator.place(surface.p, bsdf.frame.ng, bsdf.wo(), footprint)?;
            return Some(self.read(estimator, place, throughput * reflectance::<E>(surface)));
        }
        Some(throughput * estimator.radiance(surface, footprint, rng)?)
    }
}

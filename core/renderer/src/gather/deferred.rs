//! Look-ups that are answered together, for estimators that want many hits at once.

use rayon::prelude::*;

use crate::bsdf::LobeSet;
use crate::color::Rgb;
use crate::effects_plan::Meter;
use crate::error::RenderError;
use crate::estimator::{Estimator, Footprint, reflectance};
use crate::film::{Film, PixelSample};
use crate::lit_scene::Surface;
use crate::sampling::Rng;
use crate::stats::RayCounts;

use super::Gatherer;
use super::audit::AuditedHit;

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
    pub(super) meter: Meter,
    pub(super) audited: Vec<AuditedHit>,
}

impl<P> Default for Traces<P> {
    fn default() -> Self {
        Self {
            rays: RayCounts::default(),
            deferred: Vec::new(),
            meter: Meter::default(),
            audited: Vec::new(),
        }
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
    /// Runs `work` on every tile of a pass, given its index in the film, in parallel: on all at once, or on so many at a time
    /// as are answered together.
    pub(super) fn pass_in_batches(
        &self,
        sample: u32,
        film: &Film,
        work: impl Fn(usize) -> Result<Option<OpenTile<E::Place>>, RenderError> + Sync,
    ) -> Result<(), RenderError> {
        let tiles = film.tiles().len();
        if !E::DEFERS {
            return (0..tiles).into_par_iter().try_for_each(|index| work(index).map(|_| ()));
        }
        let pixels = film.tiles().first().map_or(1, |tile| tile.width as usize * tile.height as usize);
        let rays = pixels * self.rays_of_sample(sample).len().max(1);
        let at_once = (RAYS_AT_ONCE / rays).max(1);
        (0..tiles).step_by(at_once).try_for_each(|first| {
            let batch = first..(first + at_once).min(tiles);
            let open: Result<Vec<_>, _> = batch.into_par_iter().map(&work).collect();
            self.close(open?.into_iter().flatten().collect(), film);
            Ok(())
        })
    }

    /// Adds what was deferred to some tiles and gives them to the film.
    fn close(&self, tiles: Vec<OpenTile<E::Place>>, film: &Film) {
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
    /// What is read at `place` times `throughput`: the answer, or black and a promise; `None` as in [`Estimator::read`].
    pub(super) fn read<E: Estimator<Place = P>>(
        &mut self,
        estimator: &E,
        place: P,
        throughput: Rgb,
    ) -> Option<Rgb> {
        if E::DEFERS {
            let weight = self.weight * throughput;
            self.traces.deferred.push(Deferred { place, weight, pixel: self.lane });
            return Some(Rgb::BLACK);
        }
        Some(throughput * estimator.read(&place)?)
    }

    /// As [`Estimator::radiance`] times `throughput`.
    pub(super) fn radiance<E: Estimator<Place = P>>(
        &mut self,
        estimator: &E,
        surface: &Surface<'_>,
        lobes: LobeSet,
        footprint: Footprint,
        throughput: Rgb,
        rng: &mut Rng,
    ) -> Option<Rgb> {
        if E::DEFERS {
            let bsdf = &surface.bsdf;
            let place = estimator.place(surface.p, bsdf.frame.side(), bsdf.wo(), footprint)?;
            return self.read(estimator, place, throughput * reflectance::<E>(surface, lobes));
        }
        Some(throughput * estimator.radiance(surface, lobes, footprint, rng)?)
    }
}

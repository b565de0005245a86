//! Renders with a baseline instead of the pyramid: the same passes round another structure.
//!
//! Photons are one set here: every pass reads all of them, as the methods are published, so that what the film says about
//! its error is the noise of the gather alone.

use std::time::Instant;

use glam::Vec3;

use crate::baseline::{
    PhotonMap, PhotonStore, Photons, PrecomputedIrradiance, Pyramid2006, ReversePhotonMap, UniformGrid,
};
use crate::error::RenderError;
use crate::estimator::{Estimator, Path};
use crate::progress::Stage;
use crate::pyramid::SETS;
use crate::settings::parse_bins;
use crate::stats::Stats;

use super::Work;

type Outcome = Result<(), RenderError>;

impl Work<'_> {
    pub(super) fn pyramid_2006(&self, stats: &mut Stats) -> Outcome {
        let bins = parse_bins(&self.settings.pyramid.bins)?;
        let resolution = self.settings.pyramid.finest_resolution;
        let build = |photons: &Photons| Pyramid2006::new(photons, self.lit, self.bounds(), resolution, bins);
        stats.estimator.name = "pyramid_2006";
        self.baseline(build, Pyramid2006::bytes, stats)
    }

    pub(super) fn photon_map(&self, stats: &mut Stats) -> Outcome {
        stats.estimator.name = "photon_map";
        self.baseline(|photons| PhotonMap::new(photons, self.k()), PhotonMap::bytes, stats)
    }

    pub(super) fn precomputed_irradiance(&self, stats: &mut Stats) -> Outcome {
        let build = |photons: &Photons| PrecomputedIrradiance::new(photons, self.k());
        stats.estimator.name = "precomputed_irradiance";
        self.baseline(build, PrecomputedIrradiance::bytes, stats)
    }

    pub(super) fn uniform_grid(&self, stats: &mut Stats) -> Outcome {
        let resolution = self.settings.pyramid.finest_resolution;
        let build = |photons: &Photons| UniformGrid::new(photons, self.bounds(), resolution, self.k());
        stats.estimator.name = "uniform_grid";
        self.baseline(build, UniformGrid::bytes, stats)
    }

    pub(super) fn reverse_photon_map(&self, stats: &mut Stats) -> Outcome {
        let build = |photons: &Photons| ReversePhotonMap::new(photons, self.k());
        stats.estimator.name = "reverse_photon_map";
        self.baseline(build, ReversePhotonMap::bytes, stats)
    }

    /// No photons and no structure.
    pub(super) fn path(&self, stats: &mut Stats) -> Outcome {
        stats.estimator.name = "path";
        self.gather([&Path; SETS], None, stats)
    }

    /// Photons, the structure that `build` makes of them, and the picture from it.
    fn baseline<E: Estimator>(
        &self,
        build: impl FnOnce(&Photons) -> E,
        bytes: impl Fn(&E) -> usize,
        stats: &mut Stats,
    ) -> Outcome {
        let store = PhotonStore::new(self.lit);
        self.photons(&store, 1, stats)?;
        self.progress.enter(Stage::Baseline);
        let clock = Instant::now();
        let photons = store.into_photons();
        stats.photons.deposited = photons.len() as u64;
        let estimator = build(&photons);
        drop(photons);
        stats.estimator.seconds = clock.elapsed().as_secs_f64();
        self.progress.check()?;
        let gathered = self.gather([&estimator; SETS], None, stats);
        stats.estimator.bytes = bytes(&estimator);
        let indirect = &mut stats.effects[self.lit.plan.indirect_owner() as usize];
        indirect.seconds += stats.estimator.seconds;
        indirect.bytes += stats.estimator.bytes;
        gathered
    }

    fn bounds(&self) -> [Vec3; 2] {
        self.lit.accel.scene().bounds
    }

    /// Photons of an estimate.
    const fn k(&self) -> u32 {
        self.settings.gather.photons_per_estimate
    }
}

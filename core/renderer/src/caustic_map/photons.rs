//! Takes caustic photons from the photon pass and makes maps of them.

use std::sync::{Mutex, PoisonError};

use glam::Vec3;

use super::{Arrival, CausticMap};
use crate::estimator::{Landing, PhotonSink};
use crate::pyramid::SETS;

/// A photon where it landed.
#[derive(Clone, Copy, Debug)]
pub struct Photon {
    pub(super) p: Vec3,
    pub(super) arrival: Arrival,
}

/// Takes photons and keeps them all.
#[derive(Debug, Default)]
pub struct CausticPhotons {
    /// Photons of each set, by batch.
    batches: Mutex<Vec<(u64, [Vec<Photon>; SETS])>>,
}

impl CausticPhotons {
    /// A map of each of the first `sets` sets, of which the `nearest` photons to a point say how bright it is; for any number
    /// of threads the same.
    #[must_use]
    pub fn into_maps(self, sets: usize, nearest: usize) -> Vec<CausticMap> {
        let mut batches = self.batches.into_inner().unwrap_or_else(PoisonError::into_inner);
        batches.sort_by_key(|&(number, _)| number);
        let photons = |set: usize| -> Vec<Photon> {
            batches.iter().flat_map(|(_, batch)| batch[set].iter().copied()).collect()
        };
        (0..sets).map(|set| CausticMap::new(&photons(set), nearest)).collect()
    }
}

impl PhotonSink for CausticPhotons {
    type Batch = [Vec<Photon>; SETS];

    fn land(&self, batch: &mut Self::Batch, landing: &Landing<'_>) {
        let (surface, flux) = (landing.surface, landing.flux);
        if flux.is_finite() {
            let (wi, ng) = (surface.bsdf.wo().into(), surface.bsdf.frame.ng.into());
            let arrival = Arrival { flux: flux.0, wi, ng };
            batch[landing.set].push(Photon { p: surface.p, arrival });
        }
    }

    fn finish(&self, number: u64, batch: Self::Batch) {
        self.batches.lock().unwrap_or_else(PoisonError::into_inner).push((number, batch));
    }
}

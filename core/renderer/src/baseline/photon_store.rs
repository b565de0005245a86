//! Photons one by one, as the baselines take them over from the photon pass.

use std::sync::{Mutex, PoisonError};

use glam::Vec3;

use crate::bsdf::Bsdf;
use crate::color::Rgb;
use crate::estimator::{Landing, PhotonSink};
use crate::lit_scene::LitScene;
use crate::neighbors::Octahedral;

/// A photon where it landed: 40 bytes, of which each baseline keeps what it needs.
#[derive(Clone, Copy, Debug)]
pub(super) struct Photon {
    /// Where.
    pub(super) p: Vec3,
    /// Flux before the surface's albedo (W).
    pub(super) flux: Rgb,
    /// Towards where it came from.
    pub(super) wi: Octahedral,
    /// The surface's normals, as modelled.
    ng: Octahedral,
    ns: Octahedral,
    material: u32,
}

impl Photon {
    /// Geometric normal on the side it came from.
    pub(super) fn ng(&self) -> Vec3 {
        let ng = Vec3::from(self.ng);
        if Vec3::from(self.wi).dot(ng) < 0.0 { -ng } else { ng }
    }

    /// How the surface scatters what comes from where the photon did.
    pub(super) fn bsdf<'a>(&self, lit: &'a LitScene<'_>) -> Bsdf<'a> {
        lit.materials[self.material as usize].bsdf(self.wi.into(), self.ng.into(), self.ns.into())
    }
}

/// Takes photons and keeps them all.
pub struct PhotonStore<'a> {
    lit: &'a LitScene<'a>,
    batches: Mutex<Vec<(u64, Photons)>>,
}

impl<'a> PhotonStore<'a> {
    /// An empty store for photons in `lit`.
    #[must_use]
    pub const fn new(lit: &'a LitScene<'a>) -> Self {
        Self { lit, batches: Mutex::new(Vec::new()) }
    }

    /// The photons in the order they were emitted and landed in, for any number of threads.
    #[must_use]
    pub fn into_photons(self) -> Photons {
        let mut batches = self.batches.into_inner().unwrap_or_else(PoisonError::into_inner);
        batches.sort_by_key(|&(number, _)| number);
        Photons(batches.into_iter().flat_map(|(_, batch)| batch.0).collect())
    }
}

impl PhotonSink for PhotonStore<'_> {
    type Batch = Photons;

    fn land(&self, batch: &mut Photons, landing: &Landing<'_>) {
        let (surface, frame) = (landing.surface, landing.surface.bsdf.frame);
        if !landing.flux.is_finite() {
            return;
        }
        let material = self.lit.accel.material(surface.hit.object, surface.hit.primitive);
        batch.0.push(Photon {
            p: surface.p,
            flux: landing.flux,
            wi: surface.bsdf.wo().into(),
            ng: surface.ng.into(),
            ns: (if frame.entering { frame.ns } else { -frame.ns }).into(),
            #[expect(clippy::cast_possible_truncation, reason = "materials are few")]
            material: material as u32,
        });
    }

    fn finish(&self, number: u64, batch: Photons) {
        self.batches.lock().unwrap_or_else(PoisonError::into_inner).push((number, batch));
    }
}

/// Photons in order.
#[derive(Debug, Default)]
pub struct Photons(pub(super) Vec<Photon>);

impl Photons {
    /// Number of photons.
    #[must_use]
    pub const fn len(&self) -> usize {
        self.0.len()
    }

    /// True where none landed.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.0.is_empty()
    }
}

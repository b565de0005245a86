//! A few photons ahead of all others, to learn where they land.

use std::sync::{Mutex, PoisonError};

use glam::Vec3;

use crate::estimator::{Landing, PhotonSink};

/// Keeps where photons landed, in no order.
#[derive(Debug, Default)]
pub struct PhotonPilot {
    places: Mutex<Vec<Vec3>>,
}

impl PhotonPilot {
    /// Where they landed, in scene space.
    #[must_use]
    pub fn places(self) -> Vec<Vec3> {
        self.places.into_inner().unwrap_or_else(PoisonError::into_inner)
    }
}

impl PhotonSink for PhotonPilot {
    type Batch = Vec<Vec3>;

    fn land(&self, batch: &mut Vec<Vec3>, landing: &Landing<'_>) {
        batch.push(landing.surface.p);
    }

    fn finish(&self, _number: u64, batch: Vec<Vec3>) {
        self.places.lock().unwrap_or_else(PoisonError::into_inner).extend(batch);
    }
}

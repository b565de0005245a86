//! A few photons ahead of all others, to learn where they land.

use std::sync::atomic::{AtomicU32, Ordering};

use crate::estimator::{Landing, PhotonSink};
use crate::pyramid::Grid;

/// Counts photons by the block of the grid that they land in: however many there are, the memory is the same.
#[derive(Debug)]
pub struct PhotonPilot<'a> {
    grid: &'a Grid,
    counts: Vec<AtomicU32>,
}

impl<'a> PhotonPilot<'a> {
    /// Nothing has landed yet.
    #[must_use]
    pub fn new(grid: &'a Grid) -> Self {
        Self { grid, counts: (0..grid.block_count()).map(|_| AtomicU32::new(0)).collect() }
    }

    /// Photons by block.
    #[must_use]
    pub fn counts(self) -> Vec<u32> {
        self.counts.into_iter().map(AtomicU32::into_inner).collect()
    }
}

impl PhotonSink for PhotonPilot<'_> {
    type Batch = ();

    fn land(&self, (): &mut (), landing: &Landing<'_>) {
        if let Some(block) = self.grid.block_at(landing.surface.p) {
            self.counts[block].fetch_add(1, Ordering::Relaxed);
        }
    }

    fn finish(&self, _number: u64, (): ()) {}
}

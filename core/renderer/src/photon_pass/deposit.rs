//! Photons into the pyramid's accumulator.

use crate::bsdf::{LobeSet, TransportMode};
use crate::color::Rgb;
use crate::estimator::{Landing, PhotonSink};
use crate::pyramid::Accumulator;

/// Deposits photons where they land.
pub struct PyramidDeposits<'a> {
    accumulator: &'a Accumulator<'a>,
}

impl<'a> PyramidDeposits<'a> {
    /// Deposits photons in `accumulator`.
    #[must_use]
    pub const fn new(accumulator: &'a Accumulator<'a>) -> Self {
        Self { accumulator }
    }
}

impl PhotonSink for PyramidDeposits<'_> {
    type Batch = ();

    #[inline]
    fn land(&self, (): &mut (), landing: &Landing<'_>) {
        let (surface, flux) = (landing.surface, landing.flux);
        let cell = self.accumulator.deposit(landing.set, surface.p, surface.bsdf.frame.side(), flux);
        let Some(cell) = cell.filter(|_| landing.glossy) else { return };
        let tint = surface.bsdf.specular_tint();
        let tinted = Rgb([0, 1, 2].map(|c| flux.0[c] / tint.0[c]));
        self.accumulator.deposit_glossy(cell, landing.at, |direction| {
            surface.bsdf.eval(direction, LobeSet::ROUGH, TransportMode::Radiance) * tinted
        });
    }

    fn finish(&self, _number: u64, (): ()) {}
}

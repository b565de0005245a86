//! Photons into the pyramid's accumulator.

use arrayvec::ArrayVec;

use crate::bsdf::Bsdf;
use crate::color::Rgb;
use crate::estimator::{Landing, PhotonSink};
use crate::pyramid::{self, Accumulator, Deposit, Lanes, Leaving, TOGETHER};

/// Deposits photons where they land.
pub struct PyramidDeposits<'a> {
    accumulator: &'a Accumulator<'a>,
    instructions: pulp::Arch,
}

impl<'a> PyramidDeposits<'a> {
    /// Deposits photons in `accumulator`.
    #[must_use]
    pub fn new(accumulator: &'a Accumulator<'a>) -> Self {
        Self { accumulator, instructions: pulp::Arch::new() }
    }
}

impl PhotonSink for PyramidDeposits<'_> {
    /// Photons that wait for others to look for their cells with.
    type Batch = ArrayVec<Deposit, TOGETHER>;

    #[inline]
    fn land(&self, waiting: &mut Self::Batch, landing: &Landing<'_>) {
        let (surface, flux) = (landing.surface, landing.flux);
        let (side, seen) = (surface.bsdf.frame.side(), flux * surface.bsdf.lambert_factor());
        let deposit = Deposit { set: landing.set, p: surface.p, side, flux: seen };
        if !landing.glossy {
            waiting.push(deposit);
            if waiting.is_full() {
                self.accumulator.deposit_all(waiting);
                waiting.clear();
            }
            return;
        }
        let Some(cell) = self.accumulator.deposit(&deposit) else { return };
        let tint = surface.bsdf.specular_tint();
        let tinted = Rgb([0, 1, 2].map(|c| flux.0[c] / tint.0[c]));
        let (accumulator, bsdf, at) = (self.accumulator, &surface.bsdf, landing.at);
        self.instructions.dispatch(GlossyDeposit { accumulator, cell, bsdf, tinted, at });
    }

    fn finish(&self, _number: u64, waiting: Self::Batch) {
        self.accumulator.deposit_all(&waiting);
    }
}

/// What a photon on a glossy surface adds to its cell's direction bins, for whichever vector instructions this processor
/// has.
struct GlossyDeposit<'a> {
    accumulator: &'a Accumulator<'a>,
    cell: pyramid::Landing,
    bsdf: &'a Bsdf<'a>,
    /// Flux over the surface's tint (W).
    tinted: Rgb,
    at: [f32; 2],
}

impl pulp::NullaryFnOnce for GlossyDeposit<'_> {
    type Output = ();

    // What is inlined into this function, and only that, is compiled for the wider instructions.
    #[inline(always)]
    fn call(self) {
        self.accumulator.deposit_glossy(self.cell, self.at, &self);
    }
}

impl Leaving for GlossyDeposit<'_> {
    #[inline(always)]
    fn towards(&self, directions: &Lanes) -> Lanes {
        let mut leaving = self.bsdf.eval_rough(directions);
        for (values, flux) in leaving.iter_mut().zip(self.tinted.0) {
            for value in values {
                *value *= flux;
            }
        }
        leaving
    }
}

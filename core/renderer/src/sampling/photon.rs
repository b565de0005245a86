//! Random numbers of one photon.

use super::rng::{Rng, hash};

/// Owen-scrambled Sobol' numbers for the first dimensions, a counter-based generator after them. Photon `i` is the same
/// photon on any thread, process or machine.
#[derive(Clone, Copy, Debug)]
pub struct PhotonSampler {
    index: u32,
    seed: u32,
    dimension: u32,
    rng: Rng,
}

/// Emission (5) and eight surfaces of four numbers each; photons deeper than that carry little of the flux.
const SOBOL_DIMENSIONS: u32 = 5 + 8 * 4;

/// Points the sequence has; photons beyond are further, independently scrambled blocks.
const BLOCK_BITS: u32 = 16;

impl PhotonSampler {
    /// The numbers of photon `id`.
    #[must_use]
    #[expect(clippy::cast_possible_truncation, reason = "the block index and the hash are cut on purpose")]
    pub fn new(id: u64, seed: u32) -> Self {
        let block = id >> BLOCK_BITS;
        Self {
            index: (id & ((1 << BLOCK_BITS) - 1)) as u32,
            seed: hash(u64::from(seed), block) as u32,
            dimension: 0,
            rng: Rng::new(hash(hash(0x5048_4F54_4F4E, u64::from(seed)), id)),
        }
    }

    /// The next number in [0, 1).
    pub fn draw(&mut self) -> f32 {
        let dimension = self.dimension;
        self.dimension += 1;
        if dimension < SOBOL_DIMENSIONS {
            sobol_burley::sample(self.index, dimension, self.seed)
        } else {
            self.rng.draw()
        }
    }
}

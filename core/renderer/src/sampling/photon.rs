//! Random numbers of one photon.

use super::rng::{Rng, hash};

/// Owen-scrambled Sobol' numbers for the first dimensions, a counter-based generator after them. Photon `i` is the same
/// photon on any thread, process or machine.
#[derive(Clone, Copy, Debug)]
pub struct PhotonSampler {
    index: u32,
    seed: u32,
    dimension: u32,
    /// The numbers of four dimensions, of which `dimension` is one or the next four begin with it.
    four: [f32; 4],
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
            four: [0.0; 4],
            rng: Rng::new(hash(hash(0x5048_4F54_4F4E, u64::from(seed)), id)),
        }
    }

    /// A number in [0, 1) that is no dimension of the sequence: an additive recurrence with the golden ratio over the photons
    /// of a block.
    #[must_use]
    #[expect(clippy::cast_precision_loss, reason = "24 bits fit a f32 exactly")]
    pub fn time(&self) -> f32 {
        let golden = self.index.wrapping_mul(0x9E37_79B9);
        ((self.seed ^ 0x5bd1_e995).wrapping_add(golden) >> 8) as f32 * (1.0 / 16_777_216.0)
    }

    /// The next number in [0, 1).
    pub fn draw(&mut self) -> f32 {
        let dimension = self.dimension;
        self.dimension += 1;
        if dimension >= SOBOL_DIMENSIONS {
            return self.rng.draw();
        }
        // Four dimensions cost little more than one.
        if dimension.is_multiple_of(4) {
            self.four = sobol_burley::sample_4d(self.index, dimension / 4, self.seed);
        }
        self.four[dimension as usize % 4]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Photon `id` draws the point `id` of its block, one dimension after the other.
    #[test]
    #[expect(clippy::cast_possible_truncation, reason = "the block index and the hash are cut on purpose")]
    fn the_first_numbers_are_a_point_of_the_sequence() {
        for (id, seed) in [(0, 0), (12_345, 7), (3 << BLOCK_BITS | 99, 7)] {
            let mut sampler = PhotonSampler::new(id, seed);
            let scramble = hash(u64::from(seed), id >> BLOCK_BITS) as u32;
            let index = (id & 0xffff) as u32;
            for dimension in 0..SOBOL_DIMENSIONS {
                assert_eq!(sampler.draw(), sobol_burley::sample(index, dimension, scramble), "{dimension}");
            }
            assert!((0.0..1.0).contains(&sampler.draw()));
        }
    }
}

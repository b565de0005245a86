//! A counter-based generator for what is too deep for a low-discrepancy sequence to matter.

/// Mixes two words (the finaliser of `SplitMix64`, Steele et al. 2014).
#[must_use]
pub const fn hash(a: u64, b: u64) -> u64 {
    let mut z = a.wrapping_add(b.wrapping_mul(0x9E37_79B9_7F4A_7C15)).wrapping_add(0x9E37_79B9_7F4A_7C15);
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    z ^ (z >> 31)
}

/// Numbers that depend only on the key they were made with.
#[derive(Clone, Copy, Debug)]
pub struct Rng {
    key: u64,
    counter: u64,
}

impl Rng {
    /// A stream of its own for each key.
    #[must_use]
    pub const fn new(key: u64) -> Self {
        Self { key, counter: 0 }
    }

    /// Uniform in [0, 1).
    pub fn draw(&mut self) -> f32 {
        self.counter += 1;
        #[expect(clippy::cast_precision_loss, reason = "24 bits fit a f32 exactly")]
        let value = (hash(self.key, self.counter) >> 40) as f32 * (1.0 / 16_777_216.0);
        value
    }

    /// A point in the unit square.
    pub fn draw2(&mut self) -> [f32; 2] {
        [self.draw(), self.draw()]
    }
}

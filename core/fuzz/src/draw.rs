//! Numbers and choices from the fuzzer's bytes. Bytes are taken from the front, and are 0 past the end: every list then is
//! empty and every choice the first, so that any bytes at all are an input.

use std::f64::consts::PI;

/// Numbers that break formulas, and those that formulas are made for.
const SPECIAL: &[f64] = &[
    0.0,
    1.0,
    0.5,
    -1.0,
    2.0,
    -0.0,
    f64::NAN,
    f64::INFINITY,
    f64::NEG_INFINITY,
    f32::MAX as f64,
    f32::MIN as f64,
    f32::MIN_POSITIVE as f64,
    1e-45,
    1e-20,
    1e20,
    1e-300,
    1e300,
    f64::MAX,
    PI,
    1e6,
];

/// The bytes that are left of an input.
#[derive(Debug)]
pub struct Draw<'a>(pub &'a [u8]);

impl Draw<'_> {
    /// The next byte.
    pub fn byte(&mut self) -> u8 {
        let Some((&first, rest)) = self.0.split_first() else { return 0 };
        self.0 = rest;
        first
    }

    /// The next bytes.
    pub fn bytes<const N: usize>(&mut self) -> [u8; N] {
        std::array::from_fn(|_| self.byte())
    }

    /// Heads or tails.
    pub fn flag(&mut self) -> bool {
        self.byte() & 1 == 1
    }

    /// A whole number below `count`, which is not 0.
    pub fn below(&mut self, count: usize) -> usize {
        usize::from(self.byte()) % count
    }

    /// An index of `count` things: nearly always of one that is there.
    pub fn index(&mut self, count: usize) -> usize {
        match usize::from(self.byte()) {
            255 => usize::from(u16::from_le_bytes(self.bytes())),
            254 => count,
            byte => byte % count.max(1),
        }
    }

    /// One of several.
    pub fn choice<'c, T>(&mut self, choices: &'c [T]) -> &'c T {
        &choices[self.below(choices.len())]
    }

    /// Up to `most` things.
    pub fn list<T>(&mut self, most: usize, mut thing: impl FnMut(&mut Self) -> T) -> Vec<T> {
        let count = self.below(most + 1);
        (0..count).map(|_| thing(self)).collect()
    }

    /// Any number: special, near one, of any magnitude, or any bits.
    pub fn number(&mut self) -> f64 {
        match self.byte() {
            0..64 => f64::from(i8::from_le_bytes(self.bytes())) / 16.0,
            64..192 => *self.choice(SPECIAL),
            192..224 => 10.0_f64.powi(i32::from(i8::from_le_bytes(self.bytes())) / 3),
            _ => f64::from(f32::from_le_bytes(self.bytes())),
        }
    }

    /// The same as f32.
    pub fn single(&mut self) -> f32 {
        self.number() as f32
    }

    /// Several of them.
    pub fn singles<const N: usize>(&mut self) -> [f32; N] {
        std::array::from_fn(|_| self.single())
    }
}

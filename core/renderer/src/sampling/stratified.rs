//! One stratum for sixteen pixels: the point sets behind packets of gather and shadow rays.
//!
//! A Sobol' (0,2)-sequence is Owen-scrambled in two steps. The leading bits, which name the stratum, are scrambled alike
//! for every pixel, so that point `i` of neighbouring pixels lies in the same stratum and their rays stay together; the
//! bits below are scrambled by the pixel's own seed, so that their errors are independent. Both steps are nested uniform
//! scrambles, and so is their composition: each pixel has a randomised (0,2)-net.
//! Hash: Laine and Karras 2011 as improved by Vegdahl (psychopath.io, "Building a Better LK Hash").

/// Pixels that share a stratum.
pub const LANES: usize = 16;

/// What tells the points of several pixels apart.
#[derive(Clone, Copy, Debug)]
pub struct PixelSeeds<const N: usize>([[u32; N]; 2]);

impl<const N: usize> PixelSeeds<N> {
    /// From one seed a pixel.
    #[must_use]
    pub fn new(seeds: &[u32; N]) -> Self {
        Self([0x68BC_21EB, 0x02E5_BE93].map(|dimension| seeds.map(|seed| mix(seed ^ dimension))))
    }
}

/// A point set shared by all pixels of a picture.
#[derive(Debug)]
pub struct StratifiedSet {
    /// Bit-reversed Sobol' numbers, before any scramble.
    raw: Vec<[u32; 2]>,
    /// The same, scrambled alike for all pixels.
    shared: Vec<[u32; 2]>,
    /// Leading bits that come from `shared`, per dimension.
    mask: [u32; 2],
}

impl StratifiedSet {
    /// A set of `count` points. Other seeds give other, independent sets.
    #[must_use]
    pub fn new(count: u32, seed: u32) -> Self {
        let bits = count.max(1).ilog2();
        let leading = |n: u32| if n == 0 { 0 } else { u32::MAX << (32 - n) };
        let seeds =
            [seed.wrapping_mul(0x9E37_79B9) ^ 0xA511_E9B3, seed.wrapping_mul(0x85EB_CA6B) ^ 0x63D8_3595];
        let raw: Vec<_> = (0..count).map(|i| [i, sobol_1_reversed(i)]).collect();
        let shared = raw.iter().map(|&[x, y]| [scramble(x, seeds[0]), scramble(y, seeds[1])]).collect();
        Self { raw, shared, mask: [leading(bits.div_ceil(2)), leading(bits / 2)] }
    }

    /// Number of points.
    #[must_use]
    pub fn len(&self) -> usize {
        self.raw.len()
    }

    /// True for a set without points.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.raw.is_empty()
    }

    /// Point `index` of the pixel with the seed `seed`, in [0, 1)².
    #[must_use]
    pub fn point(&self, index: usize, seed: u32) -> [f32; 2] {
        let [x, y] = self.points(index, &PixelSeeds::new(&[seed]));
        [x[0], y[0]]
    }

    /// Point `index` of several pixels at once: first and second coordinates.
    #[must_use]
    #[inline(always)]
    pub fn points<const N: usize>(&self, index: usize, seeds: &PixelSeeds<N>) -> [[f32; N]; 2] {
        let (raw, shared) = (self.raw[index], self.shared[index]);
        let mut out = [[0.0; N]; 2];
        for (dimension, out) in out.iter_mut().enumerate() {
            let (raw, mask) = (raw[dimension], self.mask[dimension]);
            let top = shared[dimension] & mask;
            for (value, &seed) in out.iter_mut().zip(&seeds.0[dimension]) {
                *value = unit_float(top | (scramble(raw, seed) & !mask));
            }
        }
        out
    }
}

/// Point `index` of sets that are all their seed's own, in [0, 1)²: strata and order too. Points of two such sets, or of one
/// and a [`StratifiedSet`], can be paired by their index: in the sequence's own order both would name the same strata over and
/// over, and half of all pairs never occur. Aligned runs of 2ᵏ points stay together (Burley 2020, "Practical Hash-based Owen
/// Scrambling"). First and second coordinates.
#[must_use]
#[inline(always)]
pub fn shuffled_points<const N: usize>(index: u32, seeds: &[u32; N]) -> [[f32; N]; 2] {
    let mut out = [[0.0; N]; 2];
    for (lane, &seed) in seeds.iter().enumerate() {
        let seeds = [0xA3C5_9AC3, 0x68BC_21EB, 0x02E5_BE93].map(|dimension| mix(seed ^ dimension));
        let index = scramble(index.reverse_bits(), seeds[0]);
        out[0][lane] = unit_float(scramble(index, seeds[1]));
        out[1][lane] = unit_float(scramble(sobol_1_reversed(index), seeds[2]));
    }
    out
}

/// [`shuffled_points`] of one seed.
#[must_use]
#[inline(always)]
pub fn shuffled_point(index: u32, seed: u32) -> [f32; 2] {
    shuffled_points(index, &[seed]).map(|[coordinate]| coordinate)
}

/// Second dimension of the Sobol' sequence with its bits reversed: Pascal's triangle modulo 2 times the index. Bit k is the
/// sum of the index's bits whose numbers hold all bits of k, which goes one bit of their numbers at a time.
#[inline(always)]
const fn sobol_1_reversed(index: u32) -> u32 {
    let mut x = index;
    x ^= (x & 0xAAAA_AAAA) >> 1;
    x ^= (x & 0xCCCC_CCCC) >> 2;
    x ^= (x & 0xF0F0_F0F0) >> 4;
    x ^= (x & 0xFF00_FF00) >> 8;
    x ^ (x & 0xFFFF_0000) >> 16
}

/// Nested uniform scramble of a number given with its bits reversed; the result is in natural order.
#[inline(always)]
fn scramble(reversed: u32, seed: u32) -> u32 {
    let mut x = reversed;
    x ^= x.wrapping_mul(0x3d20_adea);
    x = x.wrapping_add(seed);
    x = x.wrapping_mul((seed >> 16) | 1);
    x ^= x.wrapping_mul(0x0552_6c56);
    x ^= x.wrapping_mul(0x53a2_2864);
    x.reverse_bits()
}

/// Spreads every bit of a seed over all bits (Wellons, lowbias32).
#[inline(always)]
fn mix(mut x: u32) -> u32 {
    x ^= x >> 16;
    x = x.wrapping_mul(0x7feb_352d);
    x ^= x >> 15;
    x = x.wrapping_mul(0x846c_a68b);
    x ^ (x >> 16)
}

/// The leading 24 bits as a number in [0, 1).
#[expect(clippy::cast_precision_loss, reason = "24 bits fit a f32 exactly")]
#[inline(always)]
fn unit_float(bits: u32) -> f32 {
    (bits >> 8) as f32 * (1.0 / 16_777_216.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every elementary interval of a (0,m,2)-net in base 2 holds exactly one point (Niederreiter 1992), also after the
    /// two-step scramble.
    #[test]
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "strata are small numbers")]
    fn each_pixel_has_a_net() {
        let m = 8;
        let set = StratifiedSet::new(1 << m, 7);
        for seed in 0..20_u32 {
            let seed = seed.wrapping_mul(0x9E37_79B9);
            for split in 0..=m {
                let (columns, rows) = ((1 << split) as f32, (1 << (m - split)) as f32);
                let mut counts = vec![0; 1 << m];
                for i in 0..set.len() {
                    let [x, y] = set.point(i, seed);
                    counts[(x * columns) as usize * (1 << (m - split)) + (y * rows) as usize] += 1;
                }
                assert!(counts.iter().all(|&c| c == 1), "seed {seed}, intervals {columns} x {rows}");
            }
        }
    }

    /// Against the direction numbers of the sequence: each is the one before, and that shifted by one, added (Sobol' 1967).
    #[test]
    fn second_dimension_is_that_of_direction_numbers() {
        for index in (0..3000).chain([u32::MAX, 0x8000_0001, 0x1234_5678]) {
            let (mut direction, mut result) = (1_u32 << 31, 0);
            for bit in 0..32 {
                if index >> bit & 1 == 1 {
                    result ^= direction;
                }
                direction ^= direction >> 1;
            }
            assert_eq!(sobol_1_reversed(index).reverse_bits(), result, "{index}");
        }
    }

    /// The first and the second half of a shuffled set are nets, and so is the whole.
    #[test]
    fn shuffled_points_are_nets() {
        for (first, m) in [(0, 6), (0, 5), (32, 5), (16, 4)] {
            for seed in 0..20_u32 {
                for split in 0..=m {
                    let (columns, rows) = ((1 << split) as f32, (1 << (m - split)) as f32);
                    let mut cells = std::collections::BTreeSet::new();
                    for i in first..first + (1 << m) {
                        let [x, y] = shuffled_point(i, seed);
                        cells.insert(((x * columns) as u32, (y * rows) as u32));
                    }
                    assert_eq!(cells.len(), 1 << m, "seed {seed}, {m}, intervals {columns} x {rows}");
                }
            }
        }
    }

    /// In 64 pairs of points of two sets each quarter meets each quarter about four times. In the sequence's own order it
    /// meets one of them sixteen times and the others never: squares of the differences add up to 768.
    #[test]
    fn shuffled_points_pair_with_those_of_other_sets() {
        let set = StratifiedSet::new(64, 5);
        let pixels = 500;
        let mut squares = 0;
        for pixel in 0..pixels {
            let mut met = [[0_i32; 4]; 4];
            for i in 0..64 {
                let own = shuffled_point(i, pixel)[0];
                let other = set.point(i as usize, mix(pixel ^ 77))[0];
                met[(own * 4.0) as usize][(other * 4.0) as usize] += 1;
            }
            squares += met.as_flattened().iter().map(|met| (met - 4).pow(2)).sum::<i32>();
        }
        let mean = f64::from(squares) / f64::from(pixels);
        assert!(mean < 60.0, "{mean}");
    }

    #[test]
    fn pixels_share_the_stratum_and_nothing_else() {
        let set = StratifiedSet::new(256, 3);
        let mut different = 0;
        for i in 0..256 {
            let (a, b) = (set.point(i, 12345), set.point(i, 678));
            assert_eq!((a[0] * 16.0).floor(), (b[0] * 16.0).floor());
            assert_eq!((a[1] * 16.0).floor(), (b[1] * 16.0).floor());
            different += usize::from(a != b);
        }
        assert!(different > 250);
    }

    /// Error of the mean of a smooth integrand over seeds: zero bias, and far below random sampling's.
    #[test]
    fn the_mean_is_unbiased() {
        let set = StratifiedSet::new(64, 1);
        let f = |[x, y]: [f32; 2]| f64::from((x * 3.0).sin() * (1.0 + y * y));
        let exact = ((1.0 - 3.0_f64.cos()) / 3.0) * (4.0 / 3.0);
        let seeds = 4000;
        let means: Vec<f64> = (0..seeds)
            .map(|s: u32| (0..64).map(|i| f(set.point(i, s.wrapping_mul(0x85EB_CA6B)))).sum::<f64>() / 64.0)
            .collect();
        let mean = means.iter().sum::<f64>() / f64::from(seeds);
        let deviation = (means.iter().map(|m| (m - mean).powi(2)).sum::<f64>() / f64::from(seeds)).sqrt();
        assert!((mean - exact).abs() < 5.0 * deviation / f64::from(seeds).sqrt(), "{mean} against {exact}");
        assert!(deviation < 0.01, "stratified deviation {deviation}; random sampling has about 0.06");
    }
}

//! Each point of a pixel's set, over the pixels: uniform over the unit square, or over its stratum. What is not so makes
//! the picture wrong, however many pixels are averaged.

use rgp_renderer::sampling::{StratifiedSet, hash, shuffled_point};

const PIXELS: u64 = 1 << 18;

/// χ² of a point over all pixels, in 16 × 16 cells of the square. 255 degrees of freedom: mean 255, standard deviation 22.6.
fn chi_squared(point: impl Fn(u32) -> [f32; 2]) -> f64 {
    let mut counts = [0_u32; 256];
    for pixel in 0..PIXELS {
        let [x, y] = point(hash(3, pixel) as u32).map(|v| (v * 16.0) as usize);
        counts[y * 16 + x] += 1;
    }
    let expected = PIXELS as f64 / 256.0;
    counts.iter().map(|&n| (f64::from(n) - expected).powi(2) / expected).sum()
}

const MOST: f64 = 255.0 + 6.0 * 22.6;

#[test]
fn each_point_is_uniform_over_the_pixels() {
    for count in [1, 16, 64, 256_u32] {
        let set = StratifiedSet::new(count, 7);
        // A stratum is shared by all pixels; within it each pixel's point is its own.
        let bits = count.ilog2();
        let strata = [(1_u32 << bits.div_ceil(2)) as f32, (1_u32 << (bits / 2)) as f32];
        for index in [0, 1, 7, 100].into_iter().filter(|&i| i < count as usize) {
            let found = chi_squared(|pixel| {
                let [x, y] = set.point(index, pixel);
                [(x * strata[0]).fract(), (y * strata[1]).fract()]
            });
            assert!(found < MOST, "point {index} of {count}: χ² {found:.0}, expected 255 ± 23");
        }
    }
}

#[test]
fn each_shuffled_point_is_uniform_over_the_pixels() {
    for index in [0, 1, 7, 100] {
        let found = chi_squared(|pixel| shuffled_point(index, pixel));
        assert!(found < MOST, "point {index}: χ² {found:.0}, expected 255 ± 23");
    }
}

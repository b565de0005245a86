//! Each point of a pixel's set, over the pixels: uniform over the unit square, or over its stratum. What is not so makes
//! the picture wrong, however many pixels are averaged.

use rgp_renderer::sampling::{StratifiedSet, hash};

const PIXELS: u64 = 1 << 18;

/// χ² of point `index` of a set of `count` over all pixels, in 16 × 16 cells of the square it is spread over.
fn chi_squared(count: u32, index: usize) -> f64 {
    let set = StratifiedSet::new(count, 7);
    // A stratum is shared by all pixels; within it each pixel's point is its own.
    let bits = count.ilog2();
    let strata = [(1_u32 << bits.div_ceil(2)) as f32, (1_u32 << (bits / 2)) as f32];
    let mut counts = [0_u32; 256];
    for pixel in 0..PIXELS {
        let [x, y] = set.point(index, hash(3, pixel) as u32);
        let cell = [x * strata[0], y * strata[1]].map(|v| (v.fract() * 16.0) as usize);
        counts[cell[1] * 16 + cell[0]] += 1;
    }
    let expected = PIXELS as f64 / 256.0;
    counts.iter().map(|&n| (f64::from(n) - expected).powi(2) / expected).sum()
}

#[test]
fn each_point_is_uniform_over_the_pixels() {
    for count in [1, 16, 64, 256] {
        for index in [0, 1, 7, 100].into_iter().filter(|&i| i < count as usize) {
            // 255 degrees of freedom: mean 255, standard deviation 22.6.
            let found = chi_squared(count, index);
            assert!(found < 255.0 + 6.0 * 22.6, "point {index} of {count}: χ² {found:.0}, expected 255 ± 23");
        }
    }
}

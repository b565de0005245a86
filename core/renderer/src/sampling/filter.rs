//! Importance sampling of the pixel filter: every camera sample then has the same weight, and belongs to one pixel.

use crate::settings::PixelFilter;

/// Inverse cumulative distribution of a separable filter.
#[derive(Debug)]
pub struct FilterTable {
    offsets: Vec<f32>,
}

/// Entries of the table; linear in between, the error is below a thousandth of a pixel.
const ENTRIES: usize = 8192;

impl FilterTable {
    /// Table of a filter of width `width` (pixels) as Blender counts it: a box is that wide, a Blackman-Harris window
    /// reaches that far to either side.
    #[must_use]
    #[expect(
        clippy::cast_precision_loss,
        clippy::cast_possible_truncation,
        reason = "table indices are small"
    )]
    pub fn new(filter: PixelFilter, width: f32) -> Self {
        let width = match filter {
            PixelFilter::Box => width,
            PixelFilter::BlackmanHarris => 2.0 * width,
        };
        let steps = 16 * ENTRIES;
        let position = |i: usize| (i as f64 + 0.5) / steps as f64 - 0.5;
        let weights: Vec<f64> = (0..steps).map(|i| density(filter, position(i))).collect();
        let total: f64 = weights.iter().sum();
        let (mut offsets, mut sum, mut i) = (Vec::with_capacity(ENTRIES + 1), 0.0, 0);
        for entry in 0..=ENTRIES {
            let target = total * entry as f64 / ENTRIES as f64;
            while i < steps && sum + weights[i] < target {
                sum += weights[i];
                i += 1;
            }
            let inside = if i < steps { (target - sum) / weights[i].max(f64::MIN_POSITIVE) } else { 0.0 };
            offsets.push(((i as f64 + inside) / steps as f64 - 0.5) as f32 * width);
        }
        Self { offsets }
    }

    /// Offset from the pixel's centre (pixels) for a number in [0, 1).
    #[must_use]
    #[expect(
        clippy::cast_precision_loss,
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "u is in [0, 1)"
    )]
    pub fn sample(&self, u: f32) -> f32 {
        let scaled = u * ENTRIES as f32;
        let index = (scaled as usize).min(ENTRIES - 1);
        let t = scaled - index as f32;
        self.offsets[index] * (1.0 - t) + self.offsets[index + 1] * t
    }
}

/// Filter value at `x` in [-0.5, 0.5] of its width.
fn density(filter: PixelFilter, x: f64) -> f64 {
    match filter {
        PixelFilter::Box => 1.0,
        PixelFilter::BlackmanHarris => {
            let v = std::f64::consts::TAU * (x + 0.5);
            0.35875 - 0.48829 * v.cos() + 0.14128 * (2.0 * v).cos() - 0.01168 * (3.0 * v).cos()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn variance(filter: PixelFilter) -> f64 {
        let table = FilterTable::new(filter, 1.5);
        let n = 100_000;
        (0..n).map(|i| f64::from(table.sample((i as f32 + 0.5) / n as f32)).powi(2)).sum::<f64>()
            / f64::from(n)
    }

    #[test]
    fn box_is_uniform() {
        assert!((variance(PixelFilter::Box) - 1.5 * 1.5 / 12.0).abs() < 1e-5);
    }

    /// Second moment of the four-term window: ∫ x² cos(2πk(x + ½)) dx over its width is 1/(2π²k²).
    #[test]
    fn blackman_harris_has_its_second_moment() {
        let a = [0.35875, -0.48829, 0.14128, -0.01168];
        let terms = (1..4).map(|k| a[k] / (2.0 * std::f64::consts::PI.powi(2) * (k * k) as f64));
        let moment = a[0] / 12.0 + terms.sum::<f64>();
        let expected = 3.0 * 3.0 * moment / a[0];
        let got = variance(PixelFilter::BlackmanHarris);
        assert!((got - expected).abs() < 1e-3 * expected, "{got} against {expected}");
    }
}

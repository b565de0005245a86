//! The pixel filter: how much a sample counts for the pixels around it.

use crate::settings::PixelFilter;

/// A separable filter, centred on a pixel.
#[derive(Debug)]
pub(super) struct Filter {
    /// Distance from the pixel's centre at which it ends (pixels).
    radius: f32,
    /// Pixels on either side whose samples can count.
    reach: usize,
    /// Steps of the table per pixel.
    steps_per_pixel: f32,
    /// Weights from the centre to the radius.
    table: Vec<f32>,
}

/// Steps of the table: linear between them, the error is below 10⁻⁶ of the peak.
const STEPS: usize = 2048;

impl Filter {
    /// A filter of width `width` (pixels) as Blender counts it: a box is that wide, a Blackman-Harris window reaches that
    /// far to either side.
    pub(super) fn new(kind: PixelFilter, width: f32) -> Self {
        let (radius, weight): (f32, fn(f64) -> f64) = match kind {
            PixelFilter::Box => (0.5 * width, |_| 1.0),
            PixelFilter::BlackmanHarris => (width, blackman_harris),
        };
        let table = (0..=STEPS).map(|i| weight(i as f64 / STEPS as f64) as f32).collect();
        let reach = (radius + 0.5).ceil() as usize - 1;
        Self { radius, reach, steps_per_pixel: STEPS as f32 / radius, table }
    }

    /// Pixels on either side whose samples can count.
    pub(super) const fn reach(&self) -> usize {
        self.reach
    }

    /// Weights, along one axis, of a sample at `offset` from the centre of a pixel (pixels), for the pixels from `reach`
    /// before to `reach` behind it.
    pub(super) fn weigh(&self, offset: f32, weights: &mut [f32]) {
        let mut d = offset + self.reach as f32;
        for weight in weights {
            *weight = self.weight(d);
            d -= 1.0;
        }
    }

    /// Weight, along one axis, of a sample at distance `d` (pixels) from the pixel's centre.
    fn weight(&self, d: f32) -> f32 {
        // Half open, so that a box of one pixel is that pixel.
        if !(-self.radius..self.radius).contains(&d) {
            return 0.0;
        }
        let at = d.abs() * self.steps_per_pixel;
        let index = (at as usize).min(STEPS - 1);
        let t = at - index as f32;
        self.table[index] * (1.0 - t) + self.table[index + 1] * t
    }
}

/// The four-term window at `x` of its half width.
fn blackman_harris(x: f64) -> f64 {
    let v = std::f64::consts::PI * x;
    0.35875 + 0.48829 * v.cos() + 0.14128 * (2.0 * v).cos() + 0.01168 * (3.0 * v).cos()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn moment(filter: &Filter) -> f64 {
        let n = 100_000;
        let positions = (0..n).map(|i| ((i as f32 + 0.5) / n as f32 * 2.0 - 1.0) * 4.0);
        let (sum, second) = positions.fold((0.0, 0.0), |(sum, second), d| {
            let weight = f64::from(filter.weight(d));
            (sum + weight, second + weight * f64::from(d * d))
        });
        second / sum
    }

    #[test]
    fn box_is_uniform() {
        let filter = Filter::new(PixelFilter::Box, 1.5);
        assert!((moment(&filter) - 1.5 * 1.5 / 12.0).abs() < 1e-4);
        assert_eq!(Filter::new(PixelFilter::Box, 1.0).reach(), 0);
    }

    /// Second moment of the four-term window of width 2r: ∫ x² cos(2πkx) dx over its width is (-1)ᵏ/(2π²k²).
    #[test]
    fn blackman_harris_has_its_second_moment() {
        let a = [0.35875, -0.48829, 0.14128, -0.01168];
        let terms = (1..4).map(|k| a[k] / (2.0 * std::f64::consts::PI.powi(2) * (k * k) as f64));
        let expected = 3.0 * 3.0 * (a[0] / 12.0 + terms.sum::<f64>()) / a[0];
        let got = moment(&Filter::new(PixelFilter::BlackmanHarris, 1.5));
        assert!((got - expected).abs() < 1e-4 * expected, "{got} against {expected}");
        assert_eq!(Filter::new(PixelFilter::BlackmanHarris, 1.5).reach(), 1);
    }
}

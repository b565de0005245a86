//! The pixel filter: how much a sample counts for the pixels around it.

use crate::settings::PixelFilter;

/// A separable filter, centred on a pixel.
#[derive(Debug)]
pub(super) struct Filter {
    kind: PixelFilter,
    /// Distance from the pixel's centre at which it ends (pixels).
    radius: f32,
}

impl Filter {
    /// A filter of width `width` (pixels) as Blender counts it: a box is that wide, a Blackman-Harris window reaches that
    /// far to either side.
    pub(super) const fn new(kind: PixelFilter, width: f32) -> Self {
        let radius = match kind {
            PixelFilter::Box => 0.5 * width,
            PixelFilter::BlackmanHarris => width,
        };
        Self { kind, radius }
    }

    /// Pixels on either side whose samples can count.
    pub(super) fn reach(&self) -> usize {
        (self.radius + 0.5).ceil() as usize - 1
    }

    /// Weight, along one axis, of a sample at distance `d` (pixels) from the pixel's centre.
    pub(super) fn weight(&self, d: f32) -> f32 {
        // Half open, so that a box of one pixel is that pixel.
        if !(-self.radius..self.radius).contains(&d) {
            return 0.0;
        }
        match self.kind {
            PixelFilter::Box => 1.0,
            PixelFilter::BlackmanHarris => {
                let c = (std::f32::consts::PI * d / self.radius).cos();
                // cos 2x and cos 3x by cos x; the window is written about its middle.
                let (c2, c3) = (2.0 * c * c - 1.0, c * (4.0 * c * c - 3.0));
                0.35875 + 0.48829 * c + 0.14128 * c2 + 0.01168 * c3
            }
        }
    }
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

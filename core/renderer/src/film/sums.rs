//! Weighted sums of one pixel over passes.

use crate::color::Rgb;

/// Values of a sample that are summed: direct and indirect light, alpha, and the sample itself.
pub(super) const CHANNELS: usize = 8;

/// Sums of samples times the pixel filter. In f32: thousands of passes round by less than a hundredth of their noise.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Sums {
    channels: [f32; CHANNELS],
    /// Of weight times gather rays.
    rays: f32,
}

impl Sums {
    /// Numbers it is made of.
    pub(super) const VALUES: usize = CHANNELS + 1;

    /// The numbers it is made of.
    pub(super) fn values(&self) -> [f32; Self::VALUES] {
        std::array::from_fn(|i| *self.channels.get(i).unwrap_or(&self.rays))
    }

    /// From the numbers it is made of.
    pub(super) fn from_values(values: &[f32; Self::VALUES]) -> Self {
        Self { channels: std::array::from_fn(|i| values[i]), rays: values[CHANNELS] }
    }

    /// Adds weighted samples of `gather_rays` gather rays each.
    #[inline]
    pub(super) fn add(&mut self, weighted: &[f32; CHANNELS], gather_rays: f32) {
        for (sum, value) in self.channels.iter_mut().zip(weighted) {
            *sum += value;
        }
        self.rays += weighted[CHANNELS - 1] * gather_rays;
    }

    /// Both sums together.
    pub(super) fn with(&self, other: &Self) -> Self {
        let channels = std::array::from_fn(|c| self.channels[c] + other.channels[c]);
        Self { channels, rays: self.rays + other.rays }
    }

    /// Sum of the weights of the samples.
    pub(super) const fn weight(&self) -> f32 {
        self.channels[CHANNELS - 1]
    }

    /// True where there was a sample.
    pub(super) fn is_known(&self) -> bool {
        self.weight() > 0.0
    }

    /// Radiance.
    pub(super) fn combined(&self) -> Rgb {
        let [r, g, b, ..] = self.channels;
        Rgb([r, g, b]) * inverse(self.weight()) + self.indirect()
    }

    /// Radiance of light that was scattered at least twice.
    pub(super) fn indirect(&self) -> Rgb {
        let [_, _, _, r, g, b, ..] = self.channels;
        Rgb([r, g, b]) * inverse(self.rays)
    }

    /// Coverage.
    pub(super) fn alpha(&self) -> f32 {
        self.channels[6] * inverse(self.weight())
    }
}

/// 1 over a weight, 0 where there is none.
pub(super) fn inverse(weight: f32) -> f32 {
    if weight > 0.0 { 1.0 / weight } else { 0.0 }
}

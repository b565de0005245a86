//! The direction bins of the paper: the hemisphere about a group's normal, split evenly in elevation and azimuth.

use std::f32::consts::{FRAC_PI_2, TAU};

use glam::Vec3;

use crate::color::Rgb;
use crate::math::Frame;

/// How the hemispheres are split.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bins {
    pub(super) elevation: u32,
    pub(super) azimuth: u32,
}

impl Bins {
    pub(super) const fn count(self) -> usize {
        (self.elevation * self.azimuth) as usize
    }

    /// The direction in the middle of each bin.
    pub(super) fn directions(self, frame: &Frame) -> Vec<Vec3> {
        let middle = |bin: u32| {
            let theta = ((bin / self.azimuth) as f32 + 0.5) / self.elevation as f32 * FRAC_PI_2;
            let phi = ((bin % self.azimuth) as f32 + 0.5) / self.azimuth as f32 * TAU;
            let (sin, cos) = theta.sin_cos();
            frame.from_local(Vec3::new(sin * phi.cos(), sin * phi.sin(), cos))
        };
        (0..self.elevation * self.azimuth).map(middle).collect()
    }

    /// The four bins about a direction (z is the group's normal) and their weights, which add up to one. Towards the normal
    /// and the horizon, and below it, the outermost bins count alone.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "bins are few")]
    pub(super) fn about(self, direction: Vec3) -> [(usize, f32); 4] {
        let theta = direction.z.clamp(0.0, 1.0).acos() / FRAC_PI_2 * self.elevation as f32 - 0.5;
        let theta = theta.clamp(0.0, self.elevation as f32 - 1.0);
        let phi = (direction.y.atan2(direction.x) / TAU).rem_euclid(1.0) * self.azimuth as f32 - 0.5;
        let (ring, sector) = (theta.floor(), phi.floor());
        let (up, on) = (theta - ring, phi - sector);
        let rings = [ring as u32, (ring as u32 + 1).min(self.elevation - 1)];
        let sectors = [0, 1].map(|i| (sector as i32 + i).rem_euclid(self.azimuth as i32) as u32);
        let bin = |r: usize, s: usize| (rings[r] * self.azimuth + sectors[s]) as usize;
        [
            (bin(0, 0), (1.0 - up) * (1.0 - on)),
            (bin(0, 1), (1.0 - up) * on),
            (bin(1, 0), up * (1.0 - on)),
            (bin(1, 1), up * on),
        ]
    }
}

/// A color in four bytes: three mantissas with a common exponent (Ward 1991). With it the pyramid takes about the memory
/// that the paper gives.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct SharedExponent([u8; 4]);

/// The exponent that stands for a mantissa of one.
const BIAS: i32 = 128 + 8;

impl From<Rgb> for SharedExponent {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "quantised on purpose")]
    fn from(color: Rgb) -> Self {
        let largest = color.max_channel();
        // One more where rounding up would not fit.
        let exponent = (largest * (256.0 / 255.5)).log2().floor() + 1.0;
        if exponent <= -127.0 {
            return Self::default();
        }
        let scale = (8.0 - exponent).exp2();
        let [r, g, b] = color.0.map(|c| (c * scale).round() as u8);
        Self([r, g, b, (exponent + 128.0) as u8])
    }
}

impl From<SharedExponent> for Rgb {
    fn from(packed: SharedExponent) -> Self {
        let [r, g, b, exponent] = packed.0;
        if exponent == 0 {
            return Self::BLACK;
        }
        let scale = ((i32::from(exponent) - BIAS) as f32).exp2();
        Self([r, g, b].map(|c| f32::from(c) * scale))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BINS: Bins = Bins { elevation: 8, azimuth: 16 };

    #[test]
    fn the_middle_of_a_bin_is_that_bin_alone() {
        for (bin, direction) in BINS.directions(&Frame::new(Vec3::Z)).into_iter().enumerate() {
            let local = Frame::new(Vec3::Z).to_local(direction);
            let weight: f32 = BINS.about(local).iter().filter(|(b, _)| *b == bin).map(|(_, w)| w).sum();
            assert!(weight > 0.999, "{bin}: {weight}");
        }
    }

    /// Interpolation is linear: halfway between two bins they count alike, across the seam of the azimuth too.
    #[test]
    fn between_bins_both_count() {
        let half_turn = TAU / 16.0;
        for k in 0..16 {
            let (sin, cos) = (k as f32 * half_turn).sin_cos();
            let ring = 0.5_f32.sqrt();
            let about = BINS.about(Vec3::new(ring * cos, ring * sin, ring));
            assert!(about.iter().all(|(_, w)| (w - 0.25).abs() < 1e-4), "{about:?}");
            let expected = [(k + 15) % 16, k].map(|s| [3 * 16 + s, 4 * 16 + s]);
            let mut found = about.map(|(bin, _)| bin);
            found.sort_unstable();
            let mut expected = expected.concat();
            expected.sort_unstable();
            assert_eq!(found.to_vec(), expected);
        }
    }

    #[test]
    fn colors_come_back_to_half_a_step() {
        let mut value = 1e-30_f32;
        while value < 1e30 {
            let color = Rgb([value, 0.3 * value, 0.0]);
            let back = Rgb::from(SharedExponent::from(color));
            for c in 0..3 {
                assert!((back.0[c] - color.0[c]).abs() <= value / 254.0, "{color:?} came back as {back:?}");
            }
            value *= 1.037;
        }
        assert_eq!(Rgb::from(SharedExponent::from(Rgb::BLACK)), Rgb::BLACK);
    }
}

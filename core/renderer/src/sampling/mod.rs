//! Random numbers and the maps from the unit square. Everything is a function of ids (pixel, sample, photon), never of
//! a thread: the same picture comes out however the work is split.

mod photon;
mod rng;
mod stratified;
mod warp;

pub use photon::PhotonSampler;
pub use rng::{Rng, hash};
pub use stratified::{LANES, PixelSeeds, StratifiedSet, shuffled_point, shuffled_points};
pub use warp::{UNIFORM_HEMISPHERE_PDF, concentric_disk, cosine_hemisphere, uniform_hemisphere};

/// Power heuristic with exponent 2 (Veach 1997, section 9.2.4): weight of a sample drawn with density `pdf` where `other`
/// competes. Both densities are expected counts: samples × pdf. Against the balance heuristic it leaves the smooth direct
/// light of a lamp to the light samples, however many gather rays could meet it.
#[must_use]
pub fn power_heuristic(pdf: f32, other: f32) -> f32 {
    if other == 0.0 || pdf.is_infinite() {
        return 1.0;
    }
    let ratio = other / pdf;
    1.0 / (1.0 + ratio * ratio)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_of_both_techniques_add_up_to_one() {
        for (a, b) in [(1.0, 3.0), (1e-20, 1e15), (0.25, 0.25), (1e20, 1e-20)] {
            assert!((power_heuristic(a, b) + power_heuristic(b, a) - 1.0).abs() < 1e-6);
        }
        assert_eq!(power_heuristic(0.5, 0.0), 1.0);
        assert_eq!(power_heuristic(f32::INFINITY, 2.0), 1.0);
    }
}

//! Random numbers and the maps from the unit square. Everything is a function of ids (pixel, sample, photon), never of
//! a thread: the same picture comes out however the work is split.

mod photon;
mod rng;
mod stratified;
mod warp;

pub use photon::PhotonSampler;
pub use rng::{Rng, hash};
pub use stratified::{LANES, StratifiedSet};
pub use warp::{UNIFORM_HEMISPHERE_PDF, concentric_disk, cosine_hemisphere, uniform_hemisphere};

/// Balance heuristic (Veach 1997, eq. 9.8): weight of a sample drawn with density `pdf` where `other` competes.
/// Both densities are expected counts: samples × pdf.
#[must_use]
pub fn balance_heuristic(pdf: f32, other: f32) -> f32 {
    if pdf.is_infinite() { 1.0 } else { pdf / (pdf + other).max(f32::MIN_POSITIVE) }
}

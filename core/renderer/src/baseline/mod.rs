//! Other ways to know the light at the end of a gather ray, to measure the pyramid against. Nothing of the product uses
//! them; the setting `gather.estimator` chooses one.
//!
//! All are asked through [`crate::estimator::Estimator`] by the same gather about the same hits, and are built from the
//! same photons, taken over by [`PhotonStore`]:
//!
//! ```text
//!   photon_map              Jensen 1996               k nearest photons at every hit
//!   precomputed_irradiance  Christensen 1999          irradiance at every fourth photon, the nearest is read
//!   uniform_grid            Hansson, Harrysson 2002   flux and count of cells, added until there is enough
//!   reverse_photon_map      Havran et al. 2005        hits in a tree, photons look for them
//!   pyramid_2006            Yue et al.                the pyramid as published
//! ```
//!
//! The estimator `path`, which has no structure, audits the product too: [`crate::estimator::Path`].

mod photon_map;
mod photon_store;
mod precomputed_irradiance;
mod pyramid_2006;
mod reverse_photon_map;
mod uniform_grid;

pub use photon_map::PhotonMap;
pub use photon_store::{PhotonStore, Photons};
pub use precomputed_irradiance::PrecomputedIrradiance;
pub use pyramid_2006::Pyramid2006;
pub use reverse_photon_map::ReversePhotonMap;
pub use uniform_grid::UniformGrid;

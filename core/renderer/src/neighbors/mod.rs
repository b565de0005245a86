//! Points in space and searches about a place: what all photon maps share.

mod kd_tree;
mod nearest;
mod octahedral;

pub use kd_tree::{KdTree, LEAF, Visitor};
pub use nearest::{Candidate, Nearest};
pub use octahedral::Octahedral;

/// Points in the cube about the origin with edges of one, for tests.
#[cfg(test)]
fn cloud(count: usize, seed: u64) -> Vec<glam::Vec3> {
    let mut rng = crate::sampling::Rng::new(seed);
    (0..count).map(|_| glam::Vec3::new(rng.draw(), rng.draw(), rng.draw()) - 0.5).collect()
}

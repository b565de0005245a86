//! The renderer, in reading order: `render` runs the passes; `photon_pass` fills the `pyramid`; `gather` reads it.
#![forbid(unsafe_code)]

pub mod accel;
pub mod baseline;
pub mod bsdf;
pub mod caustic_map;
pub mod color;
pub mod effects_plan;
pub mod error;
pub mod estimator;
pub mod film;
pub mod gather;
pub mod light;
pub mod lit_scene;
pub mod math;
pub mod neighbors;
pub mod photon_pass;
pub mod progress;
pub mod pyramid;
pub mod render;
pub mod sampling;
pub mod scene;
pub mod settings;
pub mod shader;
pub mod stats;

use std::path::Path;

/// Version of the Embree library at a path.
///
/// # Errors
/// It is missing, of another major version, or no Embree at all.
pub fn embree_version(library: &Path) -> Result<(u32, u32, u32), error::RenderError> {
    Ok(rgp_embree::Library::open(library)?.version())
}

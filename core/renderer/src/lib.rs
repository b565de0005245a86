//! The renderer, in reading order: `render` runs the passes; `photon_pass` fills the `pyramid`; `gather` reads it.
#![forbid(unsafe_code)]

pub mod bsdf;
pub mod color;
pub mod light;
pub mod math;
pub mod scene;

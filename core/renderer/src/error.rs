//! Failures of a render, worded for the artist: no trailing full stop, the object named where there is one.

use thiserror::Error;

/// Why a render could not be made.
#[derive(Debug, Error)]
pub enum RenderError {
    /// The scene cannot be rendered at all.
    #[error("{0}")]
    Scene(String),
    /// A setting that does not exist or is out of range.
    #[error("{0}")]
    Settings(String),
    /// What would pass the memory limit.
    #[error("{0}")]
    Memory(String),
    /// The ray tracer failed.
    #[error(transparent)]
    Embree(rgp_embree::EmbreeError),
    /// The host asked to stop. Not a failure: what was finished is kept.
    #[error("the render was cancelled")]
    Cancelled,
    /// A bug of ours.
    #[error("internal error: {0}; please report it with the file")]
    Internal(String),
}

impl From<rgp_embree::EmbreeError> for RenderError {
    fn from(error: rgp_embree::EmbreeError) -> Self {
        match error {
            rgp_embree::EmbreeError::Cancelled => Self::Cancelled,
            other => Self::Embree(other),
        }
    }
}

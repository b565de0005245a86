//! What can go wrong, in words a user can act on.

use std::path::PathBuf;

use thiserror::Error;

use crate::sys;

/// Everything that can fail in this crate. Ray queries cannot.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum EmbreeError {
    /// The file is not there, is not a shared library for this machine, or needs another library that is not
    /// there.
    #[error(
        "Embree could not be opened from {}: {cause}. Reinstalling the add-on restores it.",
        path.display()
    )]
    Missing {
        /// The file asked for.
        path: PathBuf,
        /// What the system's loader said.
        #[source]
        cause: libloading::Error,
    },
    /// A shared library opened, but it lacks an entry point of Embree 4.
    #[error("{} is not an Embree 4 library: it has no `{symbol}`.", path.display())]
    NotEmbree {
        /// The file asked for.
        path: PathBuf,
        /// The first entry point that was not found.
        symbol: &'static str,
    },
    /// An Embree library, but not one with the data layout used here.
    #[error(
        "{} is Embree {}.{}.{}; RGP Engine needs Embree 4.3 or a later 4.x.",
        path.display(), found.0, found.1, found.2
    )]
    WrongVersion {
        /// The file asked for.
        path: PathBuf,
        /// Major, minor and patch number it reports.
        found: (u32, u32, u32),
    },
    /// Embree refused a call.
    #[error("Embree reported error {code}: {message}")]
    Device {
        /// The value of `RTCError`.
        code: i32,
        /// Embree's own explanation.
        message: String,
    },
    /// Not enough memory for the geometry or its acceleration structure.
    #[error("Not enough memory to build the ray tracing structure. Simplify the geometry or use instances.")]
    OutOfMemory,
    /// The build was stopped because the progress callback asked for it.
    #[error("The build of the ray tracing structure was canceled.")]
    Cancelled,
    /// The caller's data was refused before Embree saw it.
    #[error("Invalid geometry: {0}.")]
    InvalidInput(String),
}

impl EmbreeError {
    /// The error for a value of `RTCError` other than `RTC_ERROR_NONE`.
    pub(crate) fn from_code(code: i32, message: String) -> Self {
        match code {
            sys::ERROR_OUT_OF_MEMORY => Self::OutOfMemory,
            sys::ERROR_CANCELLED => Self::Cancelled,
            _ => Self::Device { code, message },
        }
    }
}

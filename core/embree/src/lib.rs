//! A safe, owned binding of the part of Embree 4 the renderer needs. The only crate with `unsafe`.
//!
//! Embree is not linked: [`Library::open`] opens a shared library at run time, so one build fits every
//! Blender. The order of things is [`Library`] → [`Device`] → [`SceneBuilder`] → [`CommittedScene`], and only
//! the last answers rays. Each holds what it was made from, so they may be dropped in any order.
//!
//! Wrapped: triangle meshes, single-level instances, ray masks, builds that report progress and can be
//! canceled, the closest-hit and any-hit queries for one ray and for packets of sixteen, and scene bounds.
//! Not wrapped: motion blur, curves, points, subdivision, user geometry, filter callbacks, point queries,
//! SYCL devices, and changing a scene after it was committed.
//!
//! Lengths are in the unit of the positions given; nothing here knows what that is.

mod device;
mod error;
mod library;
mod query;
mod scene;
mod sys;

pub use device::Device;
pub use error::EmbreeError;
pub use library::Library;
pub use query::{Hit, Hit16, INVALID_ID, Ray, Ray16, RayHit16};
pub use scene::{BuildQuality, CommittedScene, MOST_STEPS, SceneBuilder};

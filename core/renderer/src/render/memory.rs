//! What a render will take, said before it is taken: refused where it passes the limit, or made coarser.

use crate::error::RenderError;
use crate::film::Film;
use crate::pyramid::{Accumulator, DirectionBins, Layout};
use crate::scene::Scene;
use crate::settings::{RenderSettings, Switch};

const MEBIBYTE: u64 = 1 << 20;

/// The ray tracer's copy of a triangle with its share of the tree (bytes): measured, with room for split triangles.
const TRACED_TRIANGLE: u64 = 400;

/// The same of an object that is an instance.
const TRACED_INSTANCE: u64 = 1_000;

/// Coarsest resolution worth a picture.
const COARSEST: u32 = 8;

/// Memory that the picture and the ray tracer leave for the pyramid; `None`: as much as it wants.
#[derive(Clone, Copy, Debug)]
pub(super) struct Budget(Option<u64>);

impl Budget {
    /// What the limit leaves.
    ///
    /// # Errors
    /// The picture and the ray tracer alone pass it.
    pub(super) fn new(scene: &Scene, settings: &RenderSettings) -> Result<Self, RenderError> {
        if settings.render.memory_limit == 0 {
            return Ok(Self(None));
        }
        let limit = u64::from(settings.render.memory_limit) * MEBIBYTE;
        let [_, _, width, height] = scene.camera.region;
        let catches = settings.effects.shadow_catcher != Switch::Off && scene.catcher().is_some();
        let caught = if catches { Film::catcher_bytes_for(width, height) } else { 0 };
        let picture = Film::bytes_for(width, height, &settings.film) + caught;
        let (mut triangles, mut instances) = (0, 0);
        for object in &scene.objects {
            let trees = 1 + u64::from(catches && object.is_catcher());
            let count = object.mesh.triangles.len() as u64 * trees;
            if object.scene_from_mesh.is_some() {
                instances += trees;
            }
            if object.scene_from_mesh.is_none() || object.moves() {
                triangles += count;
            }
        }
        let steps = scene.motion_bytes() as u64;
        let tree = triangles * TRACED_TRIANGLE + instances * TRACED_INSTANCE + steps;
        let refuse = |what: String, bytes: u64, help: &str| {
            let (needs, limit) = (bytes.div_ceil(MEBIBYTE), settings.render.memory_limit);
            let message = format!("{what} would take {needs} MiB of memory, of {limit} MiB allowed; {help}");
            Err(RenderError::Memory(message))
        };
        if picture > limit {
            let help = "render a smaller picture, a part of it, or raise the memory limit";
            return refuse(format!("the picture of {width} x {height} pixels"), picture, help);
        }
        if picture + tree > limit {
            let help = "use fewer or simpler objects, or raise the memory limit";
            return refuse(format!("the ray tracer's copy of {triangles} triangles"), tree, help);
        }
        Ok(Self(Some(limit - picture - tree)))
    }

    /// What it leaves beside something else of so many bytes.
    pub(super) fn less(self, bytes: u64) -> Self {
        Self(self.0.map(|left| left.saturating_sub(bytes)))
    }

    /// The layout as fine as memory allows, from `measure(resolution)`, with the resolution.
    ///
    /// # Errors
    /// As `measure`, and where not even the coarsest fits.
    pub(super) fn fit(
        self,
        resolution: u32,
        bins: Option<DirectionBins>,
        mut measure: impl FnMut(u32) -> Result<Layout, RenderError>,
    ) -> Result<(Layout, u32), RenderError> {
        let mut tried = resolution;
        loop {
            let layout = measure(tried)?;
            let bytes = (layout.bytes() + Accumulator::bytes_for(&layout, bins)) as u64;
            if self.0.is_none_or(|left| bytes <= left) {
                return Ok((layout, tried));
            }
            if tried <= COARSEST {
                let needs = bytes.div_ceil(MEBIBYTE);
                let message = format!(
                    "a pyramid of {tried} cells would take {needs} MiB of memory, more than the limit \
                    leaves; use fewer direction bins or raise the memory limit"
                );
                return Err(RenderError::Memory(message));
            }
            tried = (tried / 2).max(COARSEST);
        }
    }
}

/// Whether a render keeps to its memory limit before it begins.
///
/// # Errors
/// What would take how much.
pub fn check_memory(scene: &Scene, settings: &RenderSettings) -> Result<(), RenderError> {
    Budget::new(scene, settings).map(|_| ())
}

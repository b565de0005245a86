//! Light linking: which objects an emitter lights, and which block its light. Objects that no emitter tells apart are one
//! set; sets of receivers and of blockers are numbered apart, and everything that is not linked is in set 0 of both.

use serde::Deserialize;

use super::record::visibility;

/// What an emitter lights and what casts its shadows (Blender's light linking): a bit for each set of objects.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LightLinks {
    /// Sets that it lights.
    pub receivers: u32,
    /// Sets that block its light; `None` where everything does.
    pub blockers: Option<u32>,
}

impl LightLinks {
    /// It lights everything, and everything blocks its light.
    pub const ALL: Self = Self { receivers: u32::MAX, blockers: None };

    /// Mask of the shadow rays of an emitter.
    #[must_use]
    pub const fn shadow_mask(&self, casts_shadow: bool) -> u32 {
        match self.blockers {
            _ if !casts_shadow => 0,
            None => visibility::SHADOW,
            Some(sets) => (sets << visibility::blocker(0).trailing_zeros()) & visibility::BLOCKERS,
        }
    }
}

impl Default for LightLinks {
    fn default() -> Self {
        Self::ALL
    }
}

/// What an object is to emitters that are linked, and what it lights itself.
#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ObjectLinks {
    /// Number of its set of receivers, below 32.
    pub receiver_set: u32,
    /// Number of its set of blockers, below [`visibility::BLOCKER_SETS`].
    pub blocker_set: u32,
    /// Where it emits.
    pub light: LightLinks,
}

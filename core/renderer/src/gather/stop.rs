//! When a gather has done enough.

use std::time::Duration;

use crate::settings::GatherSettings;
use crate::stats::StoppedBy;

use super::convergence::Convergence;

/// What ends a gather before all its rays are traced.
#[derive(Clone, Copy, Debug, Default)]
pub struct Stop {
    /// Of the whole render.
    pub(super) time_limit: Option<Duration>,
    /// Standard error, in percent of the picture's mean.
    pub(super) error_target: Option<f64>,
    /// When the gather began, since the start of the render.
    began: Duration,
}

impl Stop {
    /// From the settings; `began` is the time the gather begins, since the start of the render.
    #[must_use]
    pub fn new(settings: &GatherSettings, began: Duration) -> Self {
        Self {
            time_limit: (settings.time_limit > 0.0).then(|| Duration::from_secs_f64(settings.time_limit)),
            error_target: (settings.error_target > 0.0).then_some(settings.error_target),
            began,
        }
    }

    /// Why to stop after `passes` passes; `None` to go on. Two are made in any case: one for each set of photons.
    pub(super) fn reason(
        &self,
        convergence: &Convergence,
        passes: u32,
        elapsed: Duration,
    ) -> Option<StoppedBy> {
        if passes < 2 {
            return None;
        }
        let error = convergence.error_after(passes);
        if error.zip(self.error_target).is_some_and(|(error, target)| error <= target) {
            return Some(StoppedBy::Error);
        }
        let next = elapsed + elapsed.saturating_sub(self.began) / (passes - convergence.first).max(1);
        self.time_limit.filter(|&limit| next > limit).map(|_| StoppedBy::Time)
    }

    /// How much of the gather is done, when `share` of its rays are traced.
    pub(super) fn fraction(&self, share: f64, elapsed: Duration) -> f64 {
        let of_time = self.time_limit.map_or(0.0, |limit| {
            let whole = limit.saturating_sub(self.began).as_secs_f64();
            if whole > 0.0 { elapsed.saturating_sub(self.began).as_secs_f64() / whole } else { 1.0 }
        });
        share.max(of_time).min(1.0)
    }
}

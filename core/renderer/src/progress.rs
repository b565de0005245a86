//! What crosses threads while a render runs: how far it is, and the wish to stop.

use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use crate::error::RenderError;

/// Stages of a render, in order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// Building the ray tracer's tree.
    Accel,
    /// Laying out the pyramid over the surfaces.
    Layout,
    /// Tracing photons.
    PhotonPass,
    /// Merging the pyramid's levels.
    Pyramid,
    /// Building what stands in for the pyramid.
    Baseline,
    /// Final gathering.
    Gather,
}

impl Stage {
    /// Text for a status line.
    #[must_use]
    pub const fn label(self) -> &'static str {
        match self {
            Self::Accel => "Building BVH",
            Self::Layout => "Measuring surfaces",
            Self::PhotonPass => "Tracing photons",
            Self::Pyramid => "Building pyramid",
            Self::Baseline => "Building baseline",
            Self::Gather => "Gathering",
        }
    }
}

/// How good the picture is, and where it leads.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outlook {
    /// Standard error so far, in percent of the picture's mean.
    pub error: f64,
    /// The same, expected after all passes.
    pub error_at_end: f64,
    /// Until the target of the error is reached; `None` where there is none or it will not be.
    pub seconds_to_target: Option<f64>,
}

/// A moment's view of a render.
#[derive(Clone, Copy, Debug)]
pub struct Snapshot {
    /// What is being done.
    pub stage: Stage,
    /// Share of the stage that is done, 0 to 1.
    pub fraction: f64,
    /// Passes over the picture that are complete.
    pub passes_done: u32,
    /// Passes over the picture in all.
    pub passes_total: u32,
    /// Since the render began.
    pub elapsed: Duration,
    /// Estimated from the gather's pace; `None` before it has one.
    pub left: Option<Duration>,
    /// `None` before the first passes are complete.
    pub outlook: Option<Outlook>,
}

#[derive(Debug)]
struct State {
    stage: Stage,
    fraction: f64,
    passes_done: u32,
    passes_total: u32,
    stage_began: Instant,
    outlook: Option<Outlook>,
}

/// Shared by the thread that renders and the one that watches.
#[derive(Debug)]
pub struct Progress {
    cancelled: AtomicBool,
    began: Instant,
    state: Mutex<State>,
}

impl Default for Progress {
    fn default() -> Self {
        let now = Instant::now();
        let state = State {
            stage: Stage::Accel,
            fraction: 0.0,
            passes_done: 0,
            passes_total: 0,
            stage_began: now,
            outlook: None,
        };
        Self { cancelled: AtomicBool::new(false), began: now, state: Mutex::new(state) }
    }
}

impl Progress {
    /// Asks the render to stop.
    pub fn cancel(&self) {
        self.cancelled.store(true, Ordering::Relaxed);
    }

    /// True once somebody asked to stop.
    #[must_use]
    pub fn is_cancelled(&self) -> bool {
        self.cancelled.load(Ordering::Relaxed)
    }

    /// `Err(Cancelled)` once somebody asked to stop: `progress.check()?` between the lines of a pass.
    ///
    /// # Errors
    /// [`RenderError::Cancelled`].
    pub fn check(&self) -> Result<(), RenderError> {
        if self.is_cancelled() { Err(RenderError::Cancelled) } else { Ok(()) }
    }

    /// Enters a stage.
    pub fn enter(&self, stage: Stage) {
        let mut state = self.lock();
        state.stage = stage;
        state.fraction = 0.0;
        state.stage_began = Instant::now();
    }

    /// Share of the current stage that is done.
    pub fn set_fraction(&self, fraction: f64) {
        self.lock().fraction = fraction.clamp(0.0, 1.0);
    }

    /// Passes over the picture.
    pub fn set_passes(&self, done: u32, total: u32) {
        let mut state = self.lock();
        state.passes_done = done;
        state.passes_total = total;
    }

    /// How good the picture is.
    pub fn set_outlook(&self, outlook: Option<Outlook>) {
        self.lock().outlook = outlook;
    }

    /// Since the render began.
    #[must_use]
    pub fn elapsed(&self) -> Duration {
        self.began.elapsed()
    }

    /// A moment's view.
    #[must_use]
    pub fn snapshot(&self) -> Snapshot {
        let state = self.lock();
        let left = (state.stage == Stage::Gather && state.fraction > 0.01)
            .then(|| state.stage_began.elapsed().mul_f64((1.0 - state.fraction) / state.fraction));
        Snapshot {
            stage: state.stage,
            fraction: state.fraction,
            passes_done: state.passes_done,
            passes_total: state.passes_total,
            elapsed: self.began.elapsed(),
            left,
            outlook: state.outlook,
        }
    }

    fn lock(&self) -> std::sync::MutexGuard<'_, State> {
        // A poisoned lock still holds numbers that are good enough for a status line.
        self.state.lock().unwrap_or_else(std::sync::PoisonError::into_inner)
    }
}

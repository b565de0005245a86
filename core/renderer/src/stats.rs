//! What a render counted and timed; serialised as the stats file.

use std::ops::AddAssign;

use serde::Serialize;

use crate::settings::Switch;

/// Wall seconds of each pass.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Seconds {
    /// Ray tracer's tree.
    pub accel: f64,
    /// Photons.
    pub photon_pass: f64,
    /// Pilot, surface areas and merging.
    pub pyramid: f64,
    /// Final gathering.
    pub gather: f64,
    /// All of the above.
    pub total: f64,
}

/// Rays traced, by kind.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct RayCounts {
    /// From the camera, through mirrors and glass included.
    pub camera: u64,
    /// Gather rays, and the bounces that continue short ones.
    pub gather: u64,
    /// Next-event estimation.
    pub shadow: u64,
    /// Photon segments.
    pub photon: u64,
    /// Ends of gather rays that were followed instead of read: too short for the cell they would read.
    pub retraced: u64,
}

impl AddAssign for RayCounts {
    fn add_assign(&mut self, o: Self) {
        self.camera += o.camera;
        self.gather += o.gather;
        self.shadow += o.shadow;
        self.photon += o.photon;
        self.retraced += o.retraced;
    }
}

/// Photons of the photon pass.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct PhotonCounts {
    /// Started at a light.
    pub emitted: u64,
    /// Landings that were stored.
    pub deposited: u64,
    /// Landings that found no cell: rounding at slivers, or a flux that was not a number.
    pub lost: u64,
    /// Landings in the caustic map.
    pub caustic: u64,
}

/// How photons from suns and the world were aimed.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct AimStats {
    /// Lights whose photons were aimed.
    pub lights: usize,
    /// Share of their photons that would have landed first where the camera and its gather rays look.
    pub seen_before: f64,
    /// The same of those that were aimed.
    pub seen_after: f64,
    /// Memory (bytes).
    pub bytes: usize,
    /// Wall seconds, counted to the photon pass too.
    pub seconds: f64,
}

/// Images that materials look up.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct TextureCounts {
    /// Images.
    pub images: usize,
    /// Memory of them, with their smaller versions.
    pub bytes: usize,
}

/// Size of the pyramid.
#[derive(Clone, Debug, Default, Serialize)]
pub struct PyramidCounts {
    /// Levels, the finest included.
    pub levels: usize,
    /// Cells that hold light, all levels.
    pub cells: usize,
    /// Cells with direction bins.
    pub glossy_cells: usize,
    /// Direction bins per glossy cell.
    pub bins: usize,
    /// Edge of a finest cell (m).
    pub cell_size: f64,
    /// Memory of the finished pyramid.
    pub bytes: usize,
    /// Most memory it took while it was built.
    pub build_bytes: usize,
}

/// What answered for the light at the ends of gather rays.
#[derive(Clone, Debug, Default, Serialize)]
pub struct EstimatorStats {
    /// As in the setting `gather.estimator`.
    pub name: &'static str,
    /// Memory while it was asked.
    pub bytes: usize,
    /// Wall seconds to build it, the photons aside.
    pub seconds: f64,
}

/// One line of the effects plan.
#[derive(Clone, Debug, Serialize)]
pub struct EffectStats {
    /// Name of the effect.
    pub name: &'static str,
    /// What the user asks.
    pub switch: Switch,
    /// Whether the scene asks for it.
    pub called_for: bool,
    /// Whether it is computed.
    pub computed: bool,
    /// What in the scene asks for it, or that nothing does.
    pub because: String,
    /// The passes that compute it.
    pub pass: &'static str,
    /// Wall seconds of work done for it alone: no second is counted for two effects.
    pub seconds: f64,
    /// Most memory it took at a time.
    pub bytes: usize,
    /// Rays traced for it alone.
    pub rays: u64,
}

/// Why there were no more passes over the picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum StoppedBy {
    /// The user, or a failure.
    #[default]
    Cancel,
    /// All gather rays are traced.
    Rays,
    /// The time is up.
    Time,
    /// The error is below its target.
    Error,
}

/// Times the picture's mean: what is brighter is white on any screen, and counts as this bright in
/// [`PictureError::rms_clipped`]. Else the edge of a lamp would outweigh the rest of the picture.
pub const CLIPPED_AT: f32 = 8.0;

/// Standard error of a picture, over all pixels and channels.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct PictureError {
    /// Root mean square of the picture clipped at [`CLIPPED_AT`], in percent of the clipped picture's mean: the one number
    /// that is shown and aimed at.
    pub rms_clipped: f64,
    /// Root mean square, in percent of the picture's mean.
    pub rms_mean: f64,
    /// Root mean square, in percent of the brightest channel of all pixels.
    pub rms_peak: f64,
}

/// A cell whose look-ups disagree with paths, more than chance explains.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CellDisagreement {
    /// Its center (m).
    pub position: [f64; 3],
    /// Its edge (m).
    pub size: f64,
    /// Its normal class.
    pub class: usize,
    /// Hits that were followed.
    pub hits: u64,
    /// What was read by what was found; `None` where there is no light at all.
    pub ratio: Option<f64>,
    /// Chance that any cell of the picture would look like this one if all were right.
    pub significance: f64,
}

/// What the auditor found: how far the pyramid is off in this picture.
#[derive(Clone, Debug, Default, Serialize)]
pub struct AuditStats {
    /// Gather hits that were followed along a path.
    pub hits: u64,
    /// What look-ups have too much, in percent of the picture's mean; below 0: too little.
    pub bias: f64,
    /// How sure that is: with a confidence of 95 % it is off by no more (percent of the picture's mean).
    pub interval: f64,
    /// Cells, of all levels, with enough hits to be judged.
    pub cells_tested: usize,
    /// Those that disagree.
    pub cells_disagreeing: usize,
    /// Of these the first hundred, by what they do to the picture.
    pub cells: Vec<CellDisagreement>,
}

/// Everything a render reports.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Stats {
    /// Time.
    pub seconds: Seconds,
    /// Rays.
    pub rays: RayCounts,
    /// Photons.
    pub photons: PhotonCounts,
    /// How photons were aimed; `None` where they were not.
    pub aim: Option<AimStats>,
    /// Textures.
    pub textures: TextureCounts,
    /// Pyramid.
    pub pyramid: PyramidCounts,
    /// What the gather asked.
    pub estimator: EstimatorStats,
    /// Effects plan.
    pub effects: Vec<EffectStats>,
    /// Pixels that came out NaN or infinite and were set to black.
    pub nonfinite_pixels: u64,
    /// What was done otherwise than the settings ask, in words for the artist.
    pub warnings: Vec<String>,
    /// Passes over the picture that are complete.
    pub passes: u32,
    /// Why there were no more.
    pub stopped_by: StoppedBy,
    /// Standard error of the combined picture: noise of gather rays, light samples and photons; `None` where there was no
    /// second pass to compare with.
    pub error: Option<PictureError>,
    /// How far the pyramid is off; `None` where it was not audited.
    pub audit: Option<AuditStats>,
}

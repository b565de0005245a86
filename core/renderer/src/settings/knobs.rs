//! The table of knobs.

use serde::Serialize;

use super::parse_bins;
use crate::error::RenderError;

/// Type and range of one knob.
#[derive(Clone, Copy, Debug, Serialize)]
#[serde(tag = "type", rename_all = "snake_case")]
pub enum Kind {
    /// A whole number.
    Int {
        /// Smallest allowed.
        minimum: u64,
        /// Largest allowed.
        maximum: u64,
    },
    /// A real number.
    Float {
        /// Smallest allowed.
        minimum: f64,
        /// Largest allowed.
        maximum: f64,
    },
    /// One of several words.
    Enum {
        /// The words.
        choices: &'static [&'static str],
    },
    /// Elevation × azimuth, written `8x16`, from `1x1` to `32x64`.
    Bins,
}

/// One row of the table of knobs.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Knob {
    /// Group, as in `GROUP.NAME=VALUE`.
    pub group: &'static str,
    /// Name.
    pub name: &'static str,
    /// Type and range.
    #[serde(flatten)]
    pub kind: Kind,
    /// Unit, empty for a pure number or word.
    pub unit: &'static str,
    /// One sentence for a tooltip, without full stop.
    pub description: &'static str,
}

const fn knob(
    group: &'static str,
    name: &'static str,
    kind: Kind,
    unit: &'static str,
    description: &'static str,
) -> Knob {
    Knob { group, name, kind, unit, description }
}

const fn int(minimum: u64, maximum: u64) -> Kind {
    Kind::Int { minimum, maximum }
}

/// Words of [`super::Switch`].
const SWITCH: Kind = Kind::Enum { choices: &["auto", "on", "off"] };

/// Words of [`super::EstimatorKind`].
const ESTIMATORS: &[&str] = &[
    "pyramid",
    "pyramid_2006",
    "photon_map",
    "precomputed_irradiance",
    "uniform_grid",
    "reverse_photon_map",
    "path",
];

/// Every knob there is. Defaults are those of [`super::RenderSettings::default`].
#[rustfmt::skip]
pub const KNOBS: &[Knob] = &[
    knob("photon_pass", "photon_count", int(0, 1_000_000_000), "photons", "Photons emitted by all lights together; more make smoother indirect light"),
    knob("photon_pass", "caustic_count", int(0, 1_000_000_000), "photons", "Photons sent to mirrors and glass for caustics, where the scene has any; more make them sharper; 0 leaves out those of small lights"),
    knob("photon_pass", "caustic_nearest", int(2, 1000), "photons", "Photons over which caustics are averaged; fewer make them sharper and noisier"),
    knob("photon_pass", "caustic_solid_angle", Kind::Float { minimum: 0.0, maximum: 12.0 }, "sr", "Caustics of lights that mirrors and glass see smaller than this are made of photons, of wider ones of gather rays"),
    knob("photon_pass", "max_depth", int(1, 1000), "surfaces", "Surfaces a photon may visit before it is dropped; low values darken the picture"),
    knob("photon_pass", "aim", SWITCH, "", "Photons of suns and the world go where the picture looks; Auto: where most would miss it"),
    knob("pyramid", "finest_resolution", int(1, 1024), "cells", "Cells of the finest level along the longest side of what the camera and its gather rays see"),
    knob("pyramid", "adaptive_levels", int(0, 3), "levels", "Levels with cells finer than that, made where gather rays end nearby and photons are plenty; 0 for equal cells everywhere"),
    knob("pyramid", "bins", Kind::Bins, "", "Direction bins of glossy cells, elevation x azimuth; diffuse cells have none"),
    knob("pyramid", "normal_classes", Kind::Enum { choices: &["6", "54"] }, "", "Directions that keep surfaces in one cell apart: the six faces of a cube, or nine parts of each"),
    knob("pyramid", "photons_per_cell", int(1, 1000), "photons", "A cell is read from its parent where the parent holds fewer than four times as many photons"),
    knob("gather", "rays", int(1, 4096), "rays", "Gather rays per pixel, shared among its camera samples; more make less noise"),
    knob("gather", "camera_samples", int(1, 1024), "samples", "Camera samples per pixel, for smooth edges and shadows"),
    knob("gather", "light_samples", int(1, 64), "rays", "Shadow rays per camera sample"),
    knob("gather", "time_limit", Kind::Float { minimum: 0.0, maximum: 1e9 }, "s", "The render ends with the pass over the picture that fits into this time; at least two are made; 0 for no limit"),
    knob("gather", "error_target", Kind::Float { minimum: 0.0, maximum: 100.0 }, "%", "The render ends when its noise falls below this share of the picture's mean; 0 to trace all rays"),
    knob("gather", "sampling", Kind::Enum { choices: &["cosine", "uniform"] }, "", "Gather rays follow the surface's reflection (cosine), or are uniform over the hemisphere as in the paper"),
    knob("gather", "retrace_distance", Kind::Float { minimum: 0.0, maximum: 8.0 }, "cells", "Gather rays shorter than this many cells are continued one bounce, which keeps corners right; 0 never"),
    knob("gather", "max_depth", int(1, 1000), "bounces", "Mirror, glass and short-ray bounces after which a path ends"),
    knob("gather", "estimator", Kind::Enum { choices: ESTIMATORS }, "", "Where gather rays read the light: the pyramid, or another method to measure it against"),
    knob("gather", "audit", int(0, 1_000_000), "hits", "One gather hit in so many is also followed along a path to its end, which measures how far the pyramid is off; 0 for none; changes nothing in the picture"),
    knob("gather", "photons_per_estimate", int(2, 10_000), "photons", "Photons an estimate reaches to, where photons are read one by one; the pyramid does not use it"),
    knob("effects", "direct_light", SWITCH, "", "Light that comes straight from lights to surfaces the camera sees; Off leaves it out"),
    knob("effects", "indirect_diffuse", SWITCH, "", "Light that comes by way of diffuse surfaces; Off leaves it out, and its photons"),
    knob("effects", "indirect_glossy", SWITCH, "", "Light that comes by way of glossy surfaces; Off leaves it out, and the direction bins"),
    knob("effects", "caustics", SWITCH, "", "Light that mirrors and glass throw on surfaces the camera sees; Off leaves it out"),
    knob("effects", "mirrors_and_glass", SWITCH, "", "Mirrors, glass and sharp reflections; Off makes them black"),
    knob("effects", "environment_light", SWITCH, "", "Light of the world; Off makes the world black"),
    knob("effects", "emissive_meshes", SWITCH, "", "Light of emissive surfaces; Off makes them dark"),
    knob("effects", "alpha_transparency", SWITCH, "", "Light straight through transparent surfaces; Off makes them opaque"),
    knob("effects", "absorption", SWITCH, "", "Light that is absorbed on its way through colored glass and water; Off makes them clear"),
    knob("effects", "depth_of_field", SWITCH, "", "Blur of what is not in focus, where the camera's depth of field is on; Off makes everything sharp"),
    knob("effects", "motion_blur", SWITCH, "", "Blur of what moves while the shutter is open, where the scene's motion blur is on; Off makes everything stand still"),
    knob("effects", "shadow_catcher", SWITCH, "", "Shadows on shadow catchers in place of the catchers themselves; Off shows these as ordinary objects"),
    knob("film", "filter", Kind::Enum { choices: &["blackman_harris", "box"] }, "", "Pixel filter"),
    knob("film", "filter_width", Kind::Float { minimum: 0.1, maximum: 10.0 }, "pixels", "Width of the pixel filter as in Cycles: a box is that wide, Blackman-Harris reaches that far to either side"),
    knob("film", "exposure", Kind::Float { minimum: 0.0, maximum: 1e6 }, "", "Factor of all light in the picture, as Cycles' exposure"),
    knob("film", "tile_size", int(4, 4096), "pixels", "Edge of the tiles the picture is cut into; changes nothing in the picture"),
    knob("render", "threads", int(0, 1024), "threads", "Threads to use; 0 takes all; changes nothing in the picture"),
    knob("render", "seed", int(0, 2_147_483_647), "", "Another seed gives other noise"),
    knob("render", "memory_limit", int(0, 16_777_216), "MiB", "Memory a render may take: past it cells are made coarser, or the render is refused; 0 takes nine tenths of the machine's"),
];

impl Knob {
    pub(super) fn check(&self, value: &serde_json::Value) -> Result<(), RenderError> {
        let good = match self.kind {
            Kind::Int { minimum, maximum } => {
                value.as_u64().is_some_and(|v| (minimum..=maximum).contains(&v))
            }
            Kind::Float { minimum, maximum } => {
                value.as_f64().is_some_and(|v| (minimum..=maximum).contains(&v))
            }
            Kind::Enum { choices } => value.as_str().is_some_and(|v| choices.contains(&v)),
            Kind::Bins => value.as_str().is_some_and(|v| parse_bins(v).is_ok()),
        };
        if good {
            return Ok(());
        }
        let allowed = match self.kind {
            Kind::Int { minimum, maximum } => format!("a whole number from {minimum} to {maximum}"),
            Kind::Float { minimum, maximum } => format!("a number from {minimum} to {maximum}"),
            Kind::Enum { choices } => format!("one of {}", choices.join(", ")),
            Kind::Bins => "elevation x azimuth from 1x1 to 32x64, such as 8x16".into(),
        };
        // JSON has no NaN and no infinity: they arrive as nothing.
        let found = if value.is_null() { "not a number".into() } else { value.to_string() };
        Err(RenderError::Settings(format!("{}.{} is {found}; allowed is {allowed}", self.group, self.name)))
    }
}

pub(super) fn unknown(what: &str) -> RenderError {
    let names: Vec<_> = KNOBS.iter().map(|k| format!("{}.{}", k.group, k.name)).collect();
    RenderError::Settings(format!("there is no setting {what}; there are {}", names.join(", ")))
}

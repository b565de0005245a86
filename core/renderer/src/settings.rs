//! Every knob: one table says name, range, default, unit and meaning; the host shows the same table.

use serde::{Deserialize, Serialize};

use crate::error::RenderError;

/// Knobs of the photon pass.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct PhotonPassSettings {
    /// Photons emitted.
    pub photon_count: u64,
    /// Photons for caustics, in scenes that call for them.
    pub caustic_count: u64,
    /// Photons that end the disk over which a caustic is read.
    pub caustic_nearest: u32,
    /// Lights that mirrors and glass see under less than this (sr) have their caustics made of photons.
    pub caustic_solid_angle: f64,
    /// Surfaces a photon may visit.
    pub max_depth: u32,
    /// Whether photons from suns and the world are aimed at what the picture looks at; Auto: where most would miss it.
    pub aim: Switch,
}

/// Knobs of the pyramid.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct PyramidSettings {
    /// Cells along the longest side of the seen part.
    pub finest_resolution: u32,
    /// Levels finer than that, made where gather rays end nearby.
    pub adaptive_levels: u32,
    /// Direction bins of glossy cells, elevation × azimuth.
    pub bins: String,
    /// Normal classes: "6" or "54".
    pub normal_classes: String,
    /// A cell whose parent holds fewer than four times as many photons is read from the parent.
    pub photons_per_cell: u32,
}

/// How gather rays are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum GatherSampling {
    /// Importance sampling of the BSDF times the cosine.
    Cosine,
    /// Uniform over the hemisphere, as in the paper's eq. 2.
    Uniform,
}

/// What answers for the light at the ends of gather rays.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum EstimatorKind {
    /// The product's own.
    Pyramid,
    /// The pyramid as the paper has it.
    #[serde(rename = "pyramid_2006")]
    Pyramid2006,
    /// Nearest photons.
    PhotonMap,
    /// Irradiance at every fourth photon.
    PrecomputedIrradiance,
    /// Flux and photon counts of cells.
    UniformGrid,
    /// Photons look for hits.
    ReversePhotonMap,
    /// Paths to their end.
    Path,
}

/// Knobs of the final gather.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct GatherSettings {
    /// Gather rays per pixel.
    pub rays: u32,
    /// Camera samples per pixel; they share the gather rays.
    pub camera_samples: u32,
    /// Shadow rays per camera sample.
    pub light_samples: u32,
    /// Seconds after which no pass is begun; 0 for none.
    pub time_limit: f64,
    /// Standard error of the picture, in percent of its mean, below which it is done; 0 for none.
    pub error_target: f64,
    /// How gather rays are drawn.
    pub sampling: GatherSampling,
    /// Gather rays shorter than this many cells are continued one bounce.
    pub retrace_distance: f32,
    /// Mirror, glass and retrace bounces.
    pub max_depth: u32,
    /// What answers for the light at the ends of gather rays.
    pub estimator: EstimatorKind,
    /// One gather hit in so many is checked; 0 for none.
    pub audit: u32,
    /// Photons that an estimate of the photon map, or of what is built on it, reaches to.
    pub photons_per_estimate: u32,
}

/// Pixel filter.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PixelFilter {
    /// Four-term Blackman-Harris.
    BlackmanHarris,
    /// Constant over the width.
    Box,
}

/// Knobs of the film.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct FilmSettings {
    /// Pixel filter.
    pub filter: PixelFilter,
    /// Its width (pixels) as Blender counts it: a box is that wide, Blackman-Harris reaches that far to either side.
    pub filter_width: f32,
    /// Factor of all light in the picture.
    pub exposure: f32,
    /// Edge of a tile (pixels), rounded up to a multiple of 4.
    pub tile_size: u32,
}

/// Whether an effect is computed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Switch {
    /// Where something in the scene asks for it.
    #[default]
    Auto,
    /// In any case.
    On,
    /// Never: its light is left out of the picture.
    Off,
}

/// Switches of the effects.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct EffectSettings {
    /// Light that surfaces the camera sees get straight from lights.
    pub direct_light: Switch,
    /// Light by way of diffuse surfaces.
    pub indirect_diffuse: Switch,
    /// Light by way of glossy surfaces.
    pub indirect_glossy: Switch,
    /// Light by way of mirrors and glass, on surfaces the camera sees.
    pub caustics: Switch,
    /// Mirrors, glass and sharp reflections.
    pub mirrors_and_glass: Switch,
    /// The world's light.
    pub environment_light: Switch,
    /// Light of emissive surfaces.
    pub emissive_meshes: Switch,
    /// Surfaces that let light straight through.
    pub alpha_transparency: Switch,
    /// Blur of what is not in focus.
    pub depth_of_field: Switch,
    /// Blur of what moves while the shutter is open.
    pub motion_blur: Switch,
    /// Shadows on catchers in place of the catchers.
    pub shadow_catcher: Switch,
}

/// Knobs of the machine.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct MachineSettings {
    /// Threads; 0 takes all.
    pub threads: u32,
    /// Another seed gives another, equally good picture.
    pub seed: u32,
    /// Memory (MiB) that picture, ray tracer and pyramid may take together; 0 sets no limit.
    pub memory_limit: u32,
}

/// All knobs.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct RenderSettings {
    /// Photon pass.
    pub photon_pass: PhotonPassSettings,
    /// Pyramid.
    pub pyramid: PyramidSettings,
    /// Final gather.
    pub gather: GatherSettings,
    /// Effects.
    pub effects: EffectSettings,
    /// Film.
    pub film: FilmSettings,
    /// Machine.
    pub render: MachineSettings,
}

impl Default for PhotonPassSettings {
    fn default() -> Self {
        Self {
            photon_count: 1_000_000,
            caustic_count: 1_000_000,
            caustic_nearest: 64,
            caustic_solid_angle: 0.5,
            max_depth: 64,
            aim: Switch::Auto,
        }
    }
}

impl Default for PyramidSettings {
    fn default() -> Self {
        Self {
            finest_resolution: 128,
            adaptive_levels: 2,
            bins: "8x16".into(),
            normal_classes: "54".into(),
            photons_per_cell: 4,
        }
    }
}

impl Default for GatherSettings {
    fn default() -> Self {
        Self {
            rays: 256,
            camera_samples: 16,
            light_samples: 1,
            time_limit: 0.0,
            error_target: 0.0,
            sampling: GatherSampling::Cosine,
            retrace_distance: 1.732_050_8,
            max_depth: 32,
            estimator: EstimatorKind::Pyramid,
            audit: 1000,
            photons_per_estimate: 50,
        }
    }
}

impl Default for FilmSettings {
    fn default() -> Self {
        Self { filter: PixelFilter::BlackmanHarris, filter_width: 1.5, exposure: 1.0, tile_size: 64 }
    }
}

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

/// Words of [`Switch`].
const SWITCH: Kind = Kind::Enum { choices: &["auto", "on", "off"] };

/// Words of [`EstimatorKind`].
const ESTIMATORS: &[&str] = &[
    "pyramid",
    "pyramid_2006",
    "photon_map",
    "precomputed_irradiance",
    "uniform_grid",
    "reverse_photon_map",
    "path",
];

/// Every knob there is. Defaults are those of [`RenderSettings::default`].
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

/// Elevation and azimuth counts of `8x16`.
///
/// # Errors
/// The text is not of that form or a count is outside 1x1 to 32x64.
pub fn parse_bins(text: &str) -> Result<[u32; 2], RenderError> {
    let counts = text.split_once('x').and_then(|(a, b)| Some([a.parse().ok()?, b.parse().ok()?]));
    match counts {
        Some([e @ 1..=32, a @ 1..=64]) => Ok([e, a]),
        _ => Err(RenderError::Settings(format!(
            "pyramid.bins is '{text}'; it is written elevation x azimuth, such as 8x16, from 1x1 to 32x64"
        ))),
    }
}

impl RenderSettings {
    /// Settings from nested groups.
    ///
    /// # Errors
    /// An unknown group or name, a wrong type or a value out of range; the message lists what exists.
    pub fn from_json(value: &serde_json::Value) -> Result<Self, RenderError> {
        let groups = value
            .as_object()
            .ok_or_else(|| RenderError::Settings("settings are groups of names and values".into()))?;
        for (group, names) in groups {
            let names = names.as_object().filter(|_| KNOBS.iter().any(|k| k.group == group));
            let names = names.ok_or_else(|| unknown(group))?;
            for (name, value) in names {
                let found = KNOBS.iter().find(|k| k.group == group && k.name == name);
                found.ok_or_else(|| unknown(&format!("{group}.{name}")))?.check(value)?;
            }
        }
        serde_json::from_value(value.clone()).map_err(|e| RenderError::Settings(e.to_string()))
    }

    /// The table of knobs with their defaults.
    #[must_use]
    pub fn schema() -> serde_json::Value {
        let defaults = serde_json::to_value(Self::default()).unwrap_or_default();
        let rows = KNOBS.iter().map(|knob| {
            let mut row = serde_json::to_value(knob).unwrap_or_default();
            row["default"] = defaults[knob.group][knob.name].clone();
            for optional in ["minimum", "maximum", "choices"] {
                if row.get(optional).is_none() {
                    row[optional] = serde_json::Value::Null;
                }
            }
            row
        });
        rows.collect()
    }
}

impl Knob {
    fn check(&self, value: &serde_json::Value) -> Result<(), RenderError> {
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

fn unknown(what: &str) -> RenderError {
    let names: Vec<_> = KNOBS.iter().map(|k| format!("{}.{}", k.group, k.name)).collect();
    RenderError::Settings(format!("there is no setting {what}; there are {}", names.join(", ")))
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn the_table_names_exactly_the_fields() {
        let defaults = serde_json::to_value(RenderSettings::default()).unwrap();
        let mut fields: Vec<String> = Vec::new();
        for (group, names) in defaults.as_object().unwrap() {
            fields.extend(names.as_object().unwrap().keys().map(|name| format!("{group}.{name}")));
        }
        let mut knobs: Vec<_> = KNOBS.iter().map(|k| format!("{}.{}", k.group, k.name)).collect();
        fields.sort();
        knobs.sort();
        assert_eq!(fields, knobs);
        for knob in KNOBS {
            knob.check(&defaults[knob.group][knob.name]).expect("a default is within its range");
        }
    }

    #[test]
    fn what_is_not_allowed_is_refused_with_what_exists() {
        for bad in [
            json!({"gather": {"rayz": 1}}),
            json!({"gathering": {"rays": 1}}),
            json!({"gather": {"rays": 0}}),
            json!({"gather": {"rays": 4097}}),
            json!({"gather": {"rays": "many"}}),
            json!({"gather": {"retrace_distance": -0.1}}),
            json!({"gather": {"sampling": "random"}}),
            json!({"pyramid": {"bins": "8"}}),
            json!({"pyramid": {"bins": "33x16"}}),
            json!({"pyramid": 3}),
            json!(3),
        ] {
            assert!(RenderSettings::from_json(&bad).is_err(), "{bad} was accepted");
        }
        let nan = json!({"gather": {"retrace_distance": f64::NAN}});
        let message = RenderSettings::from_json(&nan).unwrap_err().to_string();
        assert!(message.contains("gather.retrace_distance is not a number; allowed is"), "{message}");
        let message = RenderSettings::from_json(&json!({"gather": {"rayz": 1}})).unwrap_err().to_string();
        assert!(message.contains("gather.rayz") && message.contains("gather.rays"), "{message}");
    }

    #[test]
    fn values_arrive() {
        let settings = RenderSettings::from_json(
            &json!({"gather": {"rays": 7, "sampling": "uniform"}, "pyramid": {"bins": "2x4"}}),
        )
        .unwrap();
        assert_eq!(settings.gather.rays, 7);
        assert_eq!(settings.gather.sampling, GatherSampling::Uniform);
        assert_eq!(parse_bins(&settings.pyramid.bins).unwrap(), [2, 4]);
    }
}

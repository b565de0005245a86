//! Every knob: one table says name, range, default, unit and meaning; the host shows the same table.

mod knobs;

use serde::{Deserialize, Serialize};

use crate::error::RenderError;
use knobs::unknown;
pub use knobs::{KNOBS, Kind, Knob};

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
    /// Light that is absorbed on its way through solids.
    pub absorption: Switch,
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

//! Which effects a scene calls for: made once per render, before anything is traced. What is not called for allocates
//! nothing and traces nothing.

use crate::bsdf::{LobeSet, PreparedMaterial};
use crate::light::Lights;
use crate::scene::Scene;
use crate::stats::{EffectStats, Seconds};

/// The pass that computes an effect.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pass {
    /// Photons into the pyramid.
    PhotonPass,
    /// Final gathering and everything seen from the camera.
    Gather,
}

/// One effect.
#[derive(Clone, Debug)]
pub struct Effect {
    /// Name.
    pub name: &'static str,
    /// What asks for it; `None` where nothing does.
    pub because: Option<String>,
    /// Who computes it.
    pub pass: Pass,
}

/// All effects, and the few facts the passes branch on.
#[derive(Clone, Debug)]
pub struct EffectsPlan {
    /// The effects.
    pub effects: Vec<Effect>,
    /// Something lights the scene and something receives it: photons are worth tracing.
    pub indirect: bool,
    /// Glossy surfaces are read from direction bins.
    pub direction_bins: bool,
    /// Surfaces let light straight through: shadow rays have to look.
    pub transparency: bool,
    /// There are lights to sample.
    pub direct: bool,
}

impl EffectsPlan {
    /// Plans from the scene.
    #[must_use]
    pub fn new(scene: &Scene, materials: &[PreparedMaterial], lights: &Lights) -> Self {
        let used = used_materials(scene);
        let first = |asks: &dyn Fn(&PreparedMaterial) -> bool, what: &str| {
            let found = used.iter().find(|&&(material, _)| asks(&materials[material]));
            found.map(|&(material, object)| {
                format!(
                    "{what} material '{}' on '{}'",
                    scene.materials[material].name, scene.objects[object].name
                )
            })
        };
        let has = |set: LobeSet| move |m: &PreparedMaterial| m.classes().intersects(set);
        let lamp = scene.lamps.first().map(|lamp| format!("lamp '{}'", lamp.name));
        let emissive = first(&|m| !m.emission().is_black(), "emissive");
        let world = (!scene.world.radiance.is_black()).then(|| "the world's color".to_owned());
        let light = lamp.clone().or_else(|| emissive.clone()).or_else(|| world.clone());
        let rough = first(&has(LobeSet::ROUGH), "glossy");
        let receiver = first(&has(LobeSet::DIFFUSE | LobeSet::ROUGH), "diffuse or glossy");
        let sharp = first(&has(LobeSet::SHARP | LobeSet::DELTA), "mirror-like or transmissive");
        let lit = |because: Option<String>| because.filter(|_| light.is_some());
        let transparency = first(&|m| !m.transparency().is_black(), "transparent");
        let direct = lamp.or_else(|| emissive.clone());
        let effect = |name, because: Option<String>, pass| Effect { name, because, pass };
        Self {
            indirect: lit(receiver.clone()).is_some() && !lights.is_empty(),
            direction_bins: lit(rough.clone()).is_some(),
            transparency: transparency.is_some(),
            direct: direct.is_some() && !lights.is_empty(),
            effects: vec![
                effect("direct light", direct, Pass::Gather),
                effect("indirect diffuse", lit(first(&has(LobeSet::DIFFUSE), "diffuse")), Pass::PhotonPass),
                effect("indirect glossy", lit(rough), Pass::PhotonPass),
                effect("mirror and glass chains", sharp.clone(), Pass::Gather),
                effect("caustics", lit(sharp.filter(|_| receiver.is_some())), Pass::Gather),
                effect("environment light", world, Pass::Gather),
                effect("emissive meshes", emissive, Pass::Gather),
                effect("alpha transparency", transparency, Pass::Gather),
            ],
        }
    }

    /// The plan as it is reported, with the seconds of the pass behind each effect.
    #[must_use]
    pub fn report(&self, seconds: &Seconds) -> Vec<EffectStats> {
        let report = |effect: &Effect| {
            let (pass, spent) = match effect.pass {
                Pass::PhotonPass => ("photon_pass", seconds.photon_pass + seconds.pyramid),
                Pass::Gather => ("gather", seconds.gather),
            };
            let called_for = effect.because.is_some();
            EffectStats {
                name: effect.name,
                called_for,
                because: effect.because.clone().unwrap_or_else(|| "nothing in the scene asks for it".into()),
                pass,
                seconds: if called_for { spent } else { 0.0 },
            }
        };
        self.effects.iter().map(report).collect()
    }
}

/// Materials that are on a triangle, each with the first object that has it.
fn used_materials(scene: &Scene) -> Vec<(usize, usize)> {
    let mut used = vec![None; scene.materials.len()];
    for (index, object) in scene.objects.iter().enumerate() {
        if object.mesh.slots.is_empty() {
            used[object.material(0)].get_or_insert(index);
        } else {
            let mut last = None;
            for (primitive, slot) in object.mesh.slots.iter().enumerate() {
                if last != Some(slot) {
                    used[object.material(primitive)].get_or_insert(index);
                    last = Some(slot);
                }
            }
        }
    }
    used.into_iter().enumerate().filter_map(|(material, object)| Some((material, object?))).collect()
}

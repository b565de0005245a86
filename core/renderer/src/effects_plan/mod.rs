//! Which effects a scene calls for: made once per render from the scene and the settings, before anything is traced. What
//! is not computed allocates nothing and traces nothing.
//!
//! Effects are of two kinds. Some are **classes of light paths** ([`Effect::is_path_class`]): every path from a light to
//! the eye belongs to one of them, or meets the eye through mirrors and glass alone and is always computed (decision 7).
//! Others are **parts of the scene** that paths begin or pass at: they are left out of the materials and of the world,
//! and all paths with them. Depth of field is a part of the camera, which is a pinhole without it; without motion blur all
//! stands still as in the middle of the shutter's time; shadow catchers are ordinary objects where they catch none.

mod costs;

use crate::bsdf::{LobeSet, PreparedMaterial};
use crate::scene::{Object, Scene, World};
use crate::settings::{EffectSettings, Switch};
use crate::stats::EffectStats;

pub use costs::{Costs, Meter, Owner};

/// Number of effects.
pub const EFFECTS: usize = 12;

/// One effect.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Effect {
    /// Light that one diffuse or glossy surface sends to the eye: lights are sampled, and met by gather rays.
    DirectLight,
    /// Light read from the diffuse surfaces where gather rays end.
    IndirectDiffuse,
    /// Light read from the glossy surfaces there, by direction.
    IndirectGlossy,
    /// Light that mirrors and glass throw on what the eye sees.
    Caustics,
    /// Mirrors, glass and sharp reflections.
    MirrorsAndGlass,
    /// The world's light.
    EnvironmentLight,
    /// Surfaces that shine.
    EmissiveMeshes,
    /// Surfaces that let light straight through.
    AlphaTransparency,
    /// What light loses on its way through colored glass and water.
    Absorption,
    /// Blur of what is not in focus.
    DepthOfField,
    /// Blur of what moves while the shutter is open.
    MotionBlur,
    /// Shadows on catchers, without the catchers.
    ShadowCatcher,
}

impl Effect {
    /// All, in the order they are reported in.
    pub const ALL: [Self; EFFECTS] = [
        Self::DirectLight,
        Self::IndirectDiffuse,
        Self::IndirectGlossy,
        Self::Caustics,
        Self::MirrorsAndGlass,
        Self::EnvironmentLight,
        Self::EmissiveMeshes,
        Self::AlphaTransparency,
        Self::Absorption,
        Self::DepthOfField,
        Self::MotionBlur,
        Self::ShadowCatcher,
    ];

    /// Name in settings and statistics.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::DirectLight => "direct_light",
            Self::IndirectDiffuse => "indirect_diffuse",
            Self::IndirectGlossy => "indirect_glossy",
            Self::Caustics => "caustics",
            Self::MirrorsAndGlass => "mirrors_and_glass",
            Self::EnvironmentLight => "environment_light",
            Self::EmissiveMeshes => "emissive_meshes",
            Self::AlphaTransparency => "alpha_transparency",
            Self::Absorption => "absorption",
            Self::DepthOfField => "depth_of_field",
            Self::MotionBlur => "motion_blur",
            Self::ShadowCatcher => "shadow_catcher",
        }
    }

    /// The passes that compute it.
    #[must_use]
    pub const fn pass(self) -> &'static str {
        match self {
            Self::DirectLight | Self::DepthOfField | Self::ShadowCatcher => "gather",
            _ => "photon_pass, gather",
        }
    }

    /// True for classes of light paths, false for parts of the scene.
    #[must_use]
    pub const fn is_path_class(self) -> bool {
        matches!(self, Self::DirectLight | Self::IndirectDiffuse | Self::IndirectGlossy | Self::Caustics)
    }

    /// What the user asks of it.
    #[must_use]
    pub const fn switch(self, settings: &EffectSettings) -> Switch {
        match self {
            Self::DirectLight => settings.direct_light,
            Self::IndirectDiffuse => settings.indirect_diffuse,
            Self::IndirectGlossy => settings.indirect_glossy,
            Self::Caustics => settings.caustics,
            Self::MirrorsAndGlass => settings.mirrors_and_glass,
            Self::EnvironmentLight => settings.environment_light,
            Self::EmissiveMeshes => settings.emissive_meshes,
            Self::AlphaTransparency => settings.alpha_transparency,
            Self::Absorption => settings.absorption,
            Self::DepthOfField => settings.depth_of_field,
            Self::MotionBlur => settings.motion_blur,
            Self::ShadowCatcher => settings.shadow_catcher,
        }
    }
}

/// One line of the plan.
#[derive(Clone, Debug)]
pub struct Planned {
    /// Which effect.
    pub effect: Effect,
    /// What the user asks.
    pub switch: Switch,
    /// What in the scene asks for it; `None` where nothing does.
    pub because: Option<String>,
}

impl Planned {
    /// Whether it is computed.
    #[must_use]
    pub const fn is_computed(&self) -> bool {
        match self.switch {
            Switch::Auto => self.because.is_some(),
            Switch::On => true,
            Switch::Off => false,
        }
    }

    /// As it is reported before it has cost anything.
    fn report(&self) -> EffectStats {
        EffectStats {
            name: self.effect.name(),
            switch: self.switch,
            called_for: self.because.is_some(),
            computed: self.is_computed(),
            because: self.because.clone().unwrap_or_else(|| "nothing in the scene asks for it".into()),
            pass: self.effect.pass(),
            seconds: 0.0,
            bytes: 0,
            rays: 0,
        }
    }
}

/// All effects, and the few facts the passes branch on.
#[derive(Clone, Debug)]
pub struct EffectsPlan {
    /// One line per effect, in the order of [`Effect::ALL`].
    pub planned: Vec<Planned>,
    /// Direct light is computed.
    pub direct: bool,
    /// There are lamps, emissive meshes or a world that is brighter on some sides: lights that can be sampled.
    pub light_samples: bool,
    /// Caustics that the eye sees are computed.
    pub caustics: bool,
    /// Lobes whose light is read where gather rays end.
    pub reads: LobeSet,
    /// Surfaces let light straight through: shadow rays have to look.
    pub transparency: bool,
    /// Solids absorb light: rays have to know what they are in.
    pub absorption: bool,
    /// Camera rays pass through the lens.
    pub depth_of_field: bool,
    /// Caustics that the eye sees are called for, whether they are computed or not.
    pub has_casters: bool,
    /// Rays have times, and things are where they are then.
    pub motion_blur: bool,
    /// The camera sees shadows in place of catchers.
    pub shadow_catcher: bool,
    /// Gather rays have something to find.
    pub gathers: bool,
}

impl EffectsPlan {
    /// Plans from the scene and what the user asks. Takes out of `materials` and `world` what is not computed.
    #[must_use]
    pub fn new(
        scene: &Scene,
        settings: &EffectSettings,
        materials: &mut [PreparedMaterial],
        world: &mut World,
    ) -> Self {
        let used = used_materials(scene);
        let parts = leave_out_parts(scene, &used, settings, materials, world);
        let light_samples = !scene.lamps.is_empty()
            || world.program.is_some()
            || materials.iter().any(|m| !m.emission().is_black());
        let mut planned = path_classes(scene, &used, settings, materials, world);
        planned.extend(parts);
        planned.extend([depth_of_field(scene, settings), motion_blur(scene, settings)]);
        planned.push(shadow_catcher(scene, settings));
        let computed = |effect: Effect| planned[effect as usize].is_computed();
        let lobes = |effect, set| if computed(effect) { set } else { LobeSet::EMPTY };
        let reads = lobes(Effect::IndirectDiffuse, LobeSet::DIFFUSE | LobeSet::TRANSLUCENT)
            | lobes(Effect::IndirectGlossy, LobeSet::ROUGH);
        Self {
            direct: computed(Effect::DirectLight),
            light_samples,
            caustics: computed(Effect::Caustics),
            has_casters: planned[Effect::Caustics as usize].because.is_some(),
            reads,
            transparency: computed(Effect::AlphaTransparency),
            absorption: computed(Effect::Absorption),
            depth_of_field: computed(Effect::DepthOfField),
            motion_blur: computed(Effect::MotionBlur) && moves(scene),
            shadow_catcher: computed(Effect::ShadowCatcher) && scene.catcher().is_some(),
            gathers: planned.iter().any(|line| {
                line.is_computed() && (line.effect.is_path_class() || line.effect == Effect::MirrorsAndGlass)
            }),
            planned,
        }
    }

    /// Light is read where gather rays end: photons are worth tracing.
    #[must_use]
    pub const fn indirect(&self) -> bool {
        self.reads.intersects(LobeSet::ALL)
    }

    /// Glossy surfaces are read from direction bins.
    #[must_use]
    pub const fn direction_bins(&self) -> bool {
        self.reads.intersects(LobeSet::ROUGH)
    }

    /// Gather rays are followed from where they end.
    #[must_use]
    pub const fn follows(&self) -> bool {
        self.indirect() || self.caustics
    }

    /// The effect that work for all indirect light is done for: the diffuse, or the glossy where it is alone.
    #[must_use]
    pub const fn indirect_owner(&self) -> Effect {
        if self.direction_bins() && !self.reads.intersects(LobeSet::DIFFUSE) {
            Effect::IndirectGlossy
        } else {
            Effect::IndirectDiffuse
        }
    }

    /// The effect that gather rays are traced for.
    #[must_use]
    pub const fn gather_owner(&self) -> Effect {
        if self.indirect() {
            self.indirect_owner()
        } else if self.direct {
            Effect::DirectLight
        } else if self.caustics {
            Effect::Caustics
        } else {
            Effect::MirrorsAndGlass
        }
    }

    /// The plan as it is reported before it has cost anything.
    #[must_use]
    pub fn report(&self) -> Vec<EffectStats> {
        self.planned.iter().map(Planned::report).collect()
    }
}

/// A material in use and the first object that has it, by index.
type Used = (usize, usize);

/// The first object with a material that `asks`, as the reason of an effect.
fn first(
    scene: &Scene,
    used: &[Used],
    materials: &[PreparedMaterial],
    asks: impl Fn(&PreparedMaterial) -> Option<&'static str>,
) -> Option<String> {
    used.iter().find_map(|&(material, object)| {
        let what = asks(&materials[material])?;
        let (object, material) = (&scene.objects[object].name, &scene.materials[material].name);
        Some(format!("{what} on '{object}' (material '{material}')"))
    })
}

/// Plans the parts of the scene, and leaves out those that are not computed.
fn leave_out_parts(
    scene: &Scene,
    used: &[Used],
    settings: &EffectSettings,
    materials: &mut [PreparedMaterial],
    world: &mut World,
) -> [Planned; 5] {
    let sharp = first(scene, used, materials, sharp_kind);
    let emissive = first(scene, used, materials, |m| (!m.emission().is_black()).then_some("emission"));
    let transparent =
        first(scene, used, materials, |m| (!m.transparency().is_black()).then_some("transparency"));
    let absorption = first(scene, used, materials, |m| (!m.absorption().is_black()).then_some("absorption"));
    let color = world_reason(world);
    let parts = [
        (Effect::MirrorsAndGlass, sharp),
        (Effect::EnvironmentLight, color),
        (Effect::EmissiveMeshes, emissive),
        (Effect::AlphaTransparency, transparent),
        (Effect::Absorption, absorption),
    ]
    .map(|(effect, because)| Planned { effect, switch: effect.switch(settings), because });
    for part in parts.iter().filter(|part| !part.is_computed() && part.because.is_some()) {
        match part.effect {
            Effect::MirrorsAndGlass => {
                materials.iter_mut().for_each(|m| m.leave_out_lobes(LobeSet::FOLLOWED));
            }
            Effect::EmissiveMeshes => materials.iter_mut().for_each(PreparedMaterial::leave_out_emission),
            Effect::AlphaTransparency => {
                materials.iter_mut().for_each(PreparedMaterial::leave_out_transparency);
            }
            Effect::Absorption => materials.iter_mut().for_each(PreparedMaterial::leave_out_absorption),
            _ => world.blacken(),
        }
    }
    parts
}

/// Plans the classes of light paths in what is left of the scene.
fn path_classes(
    scene: &Scene,
    used: &[Used],
    settings: &EffectSettings,
    materials: &[PreparedMaterial],
    world: &World,
) -> Vec<Planned> {
    let first =
        |asks: &dyn Fn(&PreparedMaterial) -> Option<&'static str>| first(scene, used, materials, asks);
    let has = |set: LobeSet, what: &'static str| first(&move |m| m.classes().intersects(set).then_some(what));
    let lamp = scene.lamps.first().map(|lamp| format!("lamp '{}'", lamp.name));
    let light = lamp
        .or_else(|| first(&|m| (!m.emission().is_black()).then_some("emission")))
        .or_else(|| world_reason(world));
    let lit = |because: Option<String>| because.filter(|_| light.is_some());
    let receiver = has(LobeSet::NON_DELTA, "surface");
    let because = [
        (Effect::DirectLight, light.clone().filter(|_| receiver.is_some())),
        (Effect::IndirectDiffuse, lit(has(LobeSet::DIFFUSE | LobeSet::TRANSLUCENT, "diffuse surface"))),
        (Effect::IndirectGlossy, lit(has(LobeSet::ROUGH, "glossy surface"))),
        (Effect::Caustics, lit(first(&sharp_kind).filter(|_| receiver.is_some()))),
    ];
    because
        .map(|(effect, because)| Planned { effect, switch: effect.switch(settings), because })
        .into_iter()
        .collect()
}

/// What in the world gives light.
fn world_reason(world: &World) -> Option<String> {
    let what = if world.program.is_some() { "nodes" } else { "color" };
    (!world.is_black()).then(|| format!("{what} of world '{}'", world.name))
}

/// Plans the camera's lens.
fn depth_of_field(scene: &Scene, settings: &EffectSettings) -> Planned {
    let effect = Effect::DepthOfField;
    let because = scene.camera.lens.as_ref().map(|_| format!("the aperture of '{}'", scene.camera.name));
    Planned { effect, switch: effect.switch(settings), because }
}

/// True where anything moves while the shutter is open.
fn moves(scene: &Scene) -> bool {
    scene.camera.moves() || scene.objects.iter().any(Object::moves)
}

/// Plans the time the shutter is open.
fn motion_blur(scene: &Scene, settings: &EffectSettings) -> Planned {
    let effect = Effect::MotionBlur;
    let object = scene.objects.iter().find(|object| object.moves()).map(|object| {
        let what = if object.motion.is_empty() { "changes its shape" } else { "moves" };
        format!("'{}' {what}", object.name)
    });
    let because = if scene.camera.moves() { Some(format!("'{}' moves", scene.camera.name)) } else { object };
    Planned { effect, switch: effect.switch(settings), because }
}

/// Plans what the camera sees of catchers.
fn shadow_catcher(scene: &Scene, settings: &EffectSettings) -> Planned {
    let effect = Effect::ShadowCatcher;
    let because = scene.catcher().map(|object| format!("'{}' is a shadow catcher", object.name));
    Planned { effect, switch: effect.switch(settings), because }
}

/// What a material with lobes that are followed is called.
fn sharp_kind(material: &PreparedMaterial) -> Option<&'static str> {
    let refracts = material.refracts() && material.transparency().is_black();
    material.classes().intersects(LobeSet::FOLLOWED).then_some(if refracts { "glass" } else { "mirror" })
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

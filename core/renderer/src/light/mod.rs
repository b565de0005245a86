//! Everything that emits: lamps, emissive meshes and the world. Photons start here ([`Lights::emit`]), surfaces ask for
//! their direct light ([`Lights::sample_direct`]), and rays that meet a light by chance ask what they see and how likely
//! the other way of finding it was ([`Lights::emitter_pdf`], [`Lights::lamps_crossed`], [`Lights::suns`]).
//!
//! Lamps whose nodes compute their light are in `lamp_shader.rs`. All is in scene space. Lamps have Blender's units and agree with Cycles: see each file for its formulas.

mod aim;
mod area;
mod casters;
mod caustic;
mod cluster;
mod direction_table;
mod distant;
mod emitter;
mod environment;
mod far;
mod lamp_shader;
mod met;
mod outline;
mod point;
mod proxy;
mod select;
mod shape;
mod spherical_rectangle;
mod spot;
mod spread;
mod sun;
mod tree;
mod warp;
mod world;

use std::ops::Range;

use glam::Vec3;

use crate::color::Rgb;
use crate::scene::{Scene, World, visibility};
use aim::Aim;
pub use aim::Find;
pub use casters::Casters;
use caustic::CausticLights;
pub use caustic::Sight;
use cluster::Cluster;
use distant::SceneBall;
pub use emitter::EmitterPoint;
use emitter::MeshEmitter;
pub use environment::Environment;
use lamp_shader::Look;
use outline::Outlines;
pub use proxy::LampProxy;
use select::{Cdf, Choice};
use shape::{Light, Shape};
use tree::{FEW, Tree, Weights};
use world::WorldLight;

/// Lengths and distances from the scene's middle beyond this (scene units, the scene filling a unit cube) are a mistake:
/// the light is left out.
const LARGEST_LENGTH: f32 = 1e9;

/// Power, irradiance and radiance are cut here, so that no sum or product of them leaves the range of f32.
const BRIGHTEST: f32 = 1e12;

/// A photon as it leaves its light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Emission {
    /// Where it starts.
    pub origin: Vec3,
    /// Unit vector along which it travels.
    pub direction: Vec3,
    /// Its flux over the probability of its light: the mean over N photons estimates the emitted flux.
    pub flux: Rgb,
    /// Normal of the surface or area lamp it leaves, on the side it leaves from.
    pub normal: Option<Vec3>,
    /// Distance it must travel before it lights anything; what it meets earlier blocks it and gets nothing. 0 for all but
    /// soft point and spot lamps, which show less of themselves to near receivers.
    pub lit_from: f32,
    /// Ray mask of what blocks it; 0 where it passes through everything.
    pub blockers: u32,
    /// Sets of objects that it lights.
    pub receivers: u32,
    /// Index into [`Scene::lamps`]; `None` for emissive meshes and the world.
    pub lamp: Option<usize>,
    /// Ray kinds that see the light: a surface whose lobes are not among them is not lit by it directly.
    pub visibility: u32,
    /// Where it leaves an emissive mesh.
    pub point: Option<EmitterPoint>,
    /// The light, where it is a lamp whose nodes decide what arrives, see [`Lights::arrived`].
    pub shaded: Option<usize>,
}

impl Emission {
    /// That of a choice with this density.
    fn over(self, density: f32) -> Self {
        let point = self.point.map(|point| point.chosen_with(density));
        Self { flux: self.flux / density, point, ..self }
    }
}

/// Where light is asked for.
#[derive(Clone, Copy, Debug)]
pub struct Receiver {
    /// The point.
    pub p: Vec3,
    /// Unit normal of the side that is lit; `None` where light from both sides counts.
    pub normal: Option<Vec3>,
    /// Bit of the set that its object is in; all bits where every light counts.
    pub sets: u32,
}

impl From<Vec3> for Receiver {
    fn from(p: Vec3) -> Self {
        Self { p, normal: None, sets: u32::MAX }
    }
}

/// A direction towards a light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DirectSample {
    /// Unit vector towards the light.
    pub wi: Vec3,
    /// Distance to the light, infinite for suns.
    pub distance: f32,
    /// Radiance from there over the pdf; times f·|cos| it estimates the direct light.
    pub radiance_over_pdf: Rgb,
    /// Pdf per solid angle, the choice of the light included; without meaning where `is_delta`.
    pub pdf_solid_angle: f32,
    /// True where no ray meets this light, so that this sample carries all of it: points of radius 0, suns of angle 0,
    /// parallel area lamps, and what is not blocked by everything.
    pub is_delta: bool,
    /// Mask of the shadow ray; 0 where the light passes through everything.
    pub blockers: u32,
    /// Ray kinds that see the light: lobes of other kinds are not lit by it.
    pub visibility: u32,
    /// Its caustics are made of photons.
    pub is_mapped: bool,
    /// Where on an emissive mesh it is.
    pub point: Option<EmitterPoint>,
}

/// A light's own part of [`Emission`]; the flux is that of the light.
struct Photon {
    origin: Vec3,
    direction: Vec3,
    flux: Rgb,
    normal: Option<Vec3>,
    lit_from: f32,
    point: Option<EmitterPoint>,
}

/// A light's own part of [`DirectSample`], the choice of the light not included.
struct LightSample {
    wi: Vec3,
    distance: f32,
    radiance_over_pdf: Rgb,
    pdf: f32,
    is_delta: bool,
    point: Option<EmitterPoint>,
}

/// A ray that may meet lamps.
struct Ray {
    from: Vec3,
    wi: Vec3,
    /// Distances that count.
    span: Range<f32>,
}

/// What a ray sees of a lamp, and the pdf with which the lamp's own sampling would have found it.
struct Crossing {
    radiance: Rgb,
    pdf: f32,
    /// From where the ray starts; infinite for suns.
    distance: f32,
}

/// What direct light is chosen among: a lamp, or a triangle of an emissive mesh.
#[derive(Debug)]
struct Emitter {
    /// Index into [`Lights::lights`].
    light: u32,
    /// Among the emitting triangles of the mesh.
    triangle: u32,
    cluster: Cluster,
}

/// All lights of a scene.
pub struct Lights {
    lights: Vec<Light>,
    /// Light by light.
    emitters: Vec<Emitter>,
    /// By light: its first emitter.
    first_emitter: Vec<usize>,
    /// Over `emitters`: the choice of direct light.
    tree: Tree,
    /// The area lamps of a few emitters.
    outlines: Option<Box<Outlines>>,
    /// Indices of suns that rays can meet.
    suns: Vec<usize>,
    /// Index into `lights` of each object that emits.
    light_of_object: Vec<Option<usize>>,
    world: WorldLight,
    ball: SceneBall,
    /// Of `lights` and then the world: how often photons choose them, by default by their flux.
    photon_weights: Vec<f64>,
    /// The choice by these weights.
    by_weight: Option<Cdf>,
    /// How the photons of each of them are aimed.
    aims: Vec<Option<Aim>>,
    total_flux: Rgb,
    /// Lights whose caustics are made of photons.
    caustic: Option<CausticLights>,
}

impl Lights {
    /// Lights of a scene; `emission[m]` is the radiance (W·m⁻²·sr⁻¹) both sides of material m emit, black where none.
    /// Lamps without power or size are left out; negative channels count as zero.
    #[must_use]
    pub fn build(scene: &Scene, emission: &[Rgb]) -> Self {
        let environment = Environment::new(&scene.world, &scene.textures);
        Self::with_world(scene, emission, &scene.world, environment)
    }

    /// As [`Lights::build`], in another world than the scene's own; `environment` is what its program gives.
    #[must_use]
    pub fn with_world(
        scene: &Scene,
        emission: &[Rgb],
        world: &World,
        environment: Option<Environment>,
    ) -> Self {
        let emission: Vec<Rgb> = emission.iter().map(|&radiance| positive(radiance)).collect();
        let ball = SceneBall::new(scene.bounds);
        let mut lights: Vec<Light> =
            (0..scene.lamps.len()).filter_map(|index| Light::from_lamp(index, scene, &ball)).collect();
        let mut light_of_object = vec![None; scene.objects.len()];
        for ((number, object), light) in (0..).zip(&scene.objects).zip(&mut light_of_object) {
            if let Some(emitter) = MeshEmitter::new(number, object, &emission) {
                *light = Some(lights.len());
                let shape = Shape::Mesh(emitter);
                lights.push(Light {
                    shape,
                    shader: None,
                    lamp: None,
                    blockers: object.links.shadow_mask(true),
                    receivers: object.links.receivers,
                    visibility: object.visibility,
                });
            }
        }
        let world = WorldLight::new(world, environment);
        let mut fluxes: Vec<Rgb> = lights.iter().map(|light| light.flux(&ball)).collect();
        fluxes.push(world.flux(&ball));
        let means: Vec<f64> = fluxes.iter().map(|flux| f64::from(flux.mean())).collect();
        let (mut emitters, mut bounds, mut first_emitter) = (Vec::new(), Vec::new(), Vec::new());
        for (light, index) in lights.iter().zip(0..) {
            first_emitter.push(emitters.len());
            for (triangle, bounds_of_one) in (0..).zip(light.bounds()) {
                emitters.push(Emitter { light: index, triangle, cluster: Cluster::new(&bounds_of_one) });
                bounds.push(bounds_of_one);
            }
        }
        let outline = |emitter: &Emitter| match &lights[emitter.light as usize] {
            Light { shape: Shape::Area(lamp), receivers, .. } => Some(lamp.outline(*receivers)),
            _ => None,
        };
        let outlines = (emitters.len() <= FEW).then(|| Box::new(Outlines::new(emitters.iter().map(outline))));
        let is_sun = |light: &Light| matches!(light.shape, Shape::Sun(_)) && light.can_be_met();
        Self {
            tree: Tree::build(&bounds),
            outlines,
            emitters,
            first_emitter,
            suns: (0..lights.len()).filter(|&index| is_sun(&lights[index])).collect(),
            lights,
            light_of_object,
            world,
            ball,
            by_weight: Cdf::with_even_share(&means),
            aims: vec![None; means.len()],
            photon_weights: means,
            total_flux: fluxes.into_iter().sum(),
            caustic: None,
        }
    }

    /// True when nothing emits at all, the world included.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.lights.is_empty() && self.world.is_black()
    }

    /// Memory (bytes) of the tables over the triangles of emissive meshes.
    #[must_use]
    pub fn emitter_bytes(&self) -> usize {
        let bytes = |light: &Light| if let Shape::Mesh(mesh) = &light.shape { mesh.bytes() } else { 0 };
        self.lights.iter().map(bytes).sum()
    }

    /// Memory (bytes) of all but [`Lights::emitter_bytes`].
    #[must_use]
    pub fn bytes(&self) -> usize {
        let tables = self.by_weight.as_ref().map_or(0, Cdf::bytes) + self.tree.bytes();
        self.lights.len() * size_of::<Light>() + self.emitters.len() * size_of::<Emitter>() + tables
    }

    /// Memory (bytes) of what is known about the world.
    #[must_use]
    pub fn world_bytes(&self) -> usize {
        self.world.bytes()
    }

    /// True where light comes from outside the scene, suns aside.
    #[must_use]
    pub fn has_world(&self) -> bool {
        !self.world.is_black()
    }

    /// Flux emitted into the scene (W × squared length scale), the world included.
    #[must_use]
    pub fn total_flux(&self) -> Rgb {
        self.total_flux
    }

    /// True when there is a lamp that rays can meet, suns aside.
    #[must_use]
    pub fn has_lamp_shapes(&self) -> bool {
        self.lights.iter().any(|light| light.hull().is_some())
    }

    /// Triangles that hold each lamp rays can meet, suns aside.
    #[must_use]
    pub fn lamp_proxies(&self) -> Vec<LampProxy> {
        let proxy = |light: &Light| {
            let (positions, triangles) = light.hull()?;
            Some(LampProxy { lamp: light.lamp?, positions, triangles, visibility: light.visibility })
        };
        self.lights.iter().filter_map(proxy).collect()
    }

    /// One photon: `u[0]` chooses the light, `u[1..3]` the place, `u[3..5]` the direction. `None` when nothing
    /// emits into the scene.
    #[must_use]
    pub fn emit(&self, u: [f32; 5]) -> Option<Emission> {
        let [choice, numbers @ ..] = u;
        let chosen = self.by_weight.as_ref()?.choose(choice);
        let emission = self.emission(chosen.index, chosen.rest, numbers);
        Some(emission.over(chosen.probability))
    }

    /// A photon of one light, which is then not chosen: its flux is that of the light. Lights are numbered as by
    /// [`Lights::distant`].
    #[must_use]
    pub fn emit_from(&self, light: usize, numbers: [f32; 4]) -> Emission {
        self.emission(light, 0.0, numbers)
    }

    /// `choice` is for lights of many parts.
    fn emission(&self, index: usize, choice: f32, numbers: [f32; 4]) -> Emission {
        let Some(aim) = &self.aims[index] else { return self.unaimed(index, choice, numbers) };
        let (numbers, density) = aim.warp(numbers);
        self.unaimed(index, choice, numbers).over(density)
    }

    fn unaimed(&self, index: usize, choice: f32, numbers: [f32; 4]) -> Emission {
        let [x, y, d0, d1] = numbers;
        let (position, direction) = ([x, y], [d0, d1]);
        let light = self.lights.get(index);
        let photon = match light {
            None => self.world.emit(&self.ball, position, direction),
            Some(light) => light.shape.emit(&self.ball, choice, position, direction),
        };
        Emission {
            origin: photon.origin,
            direction: photon.direction,
            flux: photon.flux,
            normal: photon.normal,
            lit_from: photon.lit_from,
            blockers: light.map_or(visibility::SHADOW, |light| light.blockers),
            receivers: light.map_or(u32::MAX, |light| light.receivers),
            lamp: light.and_then(|light| light.lamp),
            visibility: light.map_or(self.world.visibility, |light| light.visibility),
            point: photon.point,
            shaded: light.filter(|light| light.shader.is_some()).map(|_| index),
        }
    }

    /// Flux of a photon that has come straight from its light to `p`: what it left with, or what the nodes of its lamp make of
    /// that.
    #[inline]
    #[must_use]
    pub fn arrived(&self, flux: Rgb, shaded: Option<usize>, direction: Vec3, p: Vec3) -> Rgb {
        let Some(light) = shaded.map(|light| &self.lights[light]) else { return flux };
        let (wi, distance) = (-direction, light.shape.distance(p, -direction));
        light.shown(flux, &Look { from: p, wi, distance, before: 0.0 })
    }

    /// A direction from the receiver towards a lamp, an emissive triangle or a world that is not the same on all sides:
    /// `u[0]` chooses it, `u[1..3]` the place on it.
    /// `None` where the sample contributes nothing.
    #[must_use]
    pub fn sample_direct(&self, receiver: impl Into<Receiver>, u: [f32; 3]) -> Option<DirectSample> {
        let [choice, position @ ..] = u;
        let receiver = receiver.into();
        let p = receiver.p;
        let of_world = self.world_share(&receiver);
        if choice < of_world {
            return self.sample_world(of_world, position);
        }
        let choice = if of_world > 0.0 { (choice - of_world) / (1.0 - of_world) } else { choice };
        let chosen = self.choose(&receiver, choice)?;
        let probability = chosen.probability * (1.0 - of_world);
        let emitter = &self.emitters[chosen.index];
        let light = &self.lights[emitter.light as usize];
        if light.receivers & receiver.sets == 0 {
            return None;
        }
        let sample = match &light.shape {
            Shape::Point(lamp) => lamp.sample(p, position)?,
            Shape::Area(lamp) => lamp.sample(p, position)?,
            Shape::Sun(lamp) => lamp.sample(position),
            Shape::Mesh(mesh) => mesh.sample(p, emitter.triangle as usize, position)?,
        };
        let look = Look { from: p, wi: sample.wi, distance: sample.distance, before: 0.0 };
        let radiance_over_pdf = light.shown(sample.radiance_over_pdf, &look);
        if light.shader.is_some() && radiance_over_pdf.is_black() {
            return None;
        }
        Some(DirectSample {
            wi: sample.wi,
            distance: sample.distance,
            radiance_over_pdf: radiance_over_pdf / probability,
            pdf_solid_angle: sample.pdf * probability,
            is_delta: sample.is_delta || light.is_left_to_sampling(),
            blockers: light.blockers,
            visibility: light.visibility,
            is_mapped: self.is_mapped(emitter.light as usize),
            point: sample.point.map(|point| point.chosen_with(probability)),
        })
    }

    /// The emitter that `u` in 0..1 chooses to light the receiver.
    fn choose(&self, receiver: &Receiver, u: f32) -> Option<Choice> {
        if self.emitters.len() == 1 {
            return Some(Choice { index: 0, probability: 1.0, rest: u });
        }
        self.tree.choose(receiver, u, |emitters| self.irradiances(receiver, emitters))
    }

    /// Probability with which [`Lights::sample_direct`] chooses an emitter.
    fn choice_probability(&self, receiver: &Receiver, index: usize) -> f32 {
        let among_emitters = if self.emitters.len() == 1 {
            1.0
        } else {
            self.tree.probability(receiver, index, |emitters| self.irradiances(receiver, emitters))
        };
        among_emitters * (1.0 - self.world_share(receiver))
    }

    /// About the irradiance that each of some emitters gives the receiver; 0 only where there is none.
    fn irradiances(&self, receiver: &Receiver, emitters: &[u32]) -> Weights {
        let Some(outlines) = &self.outlines else {
            return emitters.iter().map(|&index| self.irradiance(receiver, index as usize)).collect();
        };
        let mut irradiances = outlines.irradiance(receiver);
        for &index in &outlines.others {
            irradiances[index] = self.irradiance(receiver, index);
        }
        emitters.iter().map(|&index| irradiances[index as usize]).collect()
    }

    fn irradiance(&self, receiver: &Receiver, index: usize) -> f32 {
        let Emitter { light, cluster, .. } = &self.emitters[index];
        let light = &self.lights[*light as usize];
        match &light.shape {
            Shape::Point(lamp) => lamp.irradiance_estimate(receiver.p) * cluster.incidence(receiver),
            Shape::Area(lamp) => lamp.outline(light.receivers).irradiance(receiver),
            Shape::Sun(_) | Shape::Mesh(_) => cluster.irradiance(receiver),
        }
    }
}

/// Negative channels and those that are not numbers made zero, enormous ones cut.
fn positive(color: Rgb) -> Rgb {
    color.map(|c| if c > 0.0 { c.min(BRIGHTEST) } else { 0.0 })
}

/// True for numbers of a sensible size.
fn is_in_reach(p: Vec3) -> bool {
    p.abs().cmple(Vec3::splat(LARGEST_LENGTH)).all()
}

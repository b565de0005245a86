//! The scene as the passes see it: what is met, how it scatters, what lights it, what is called for.

mod emitters;
mod hit_point;
mod medium;
mod motion;

use glam::{DVec3, Vec3};
use smallvec::SmallVec;

use crate::accel::{Accel, Hit, Ray};
use crate::bsdf::{Bsdf, BsdfSample, LobeSet, PreparedMaterial, ShadingFrame, Varying};
use crate::color::Rgb;
use crate::effects_plan::EffectsPlan;
use crate::light::{Lights, Receiver};
use crate::scene::visibility;
use hit_point::HitPoint;
pub use medium::Medium;

/// Everything a pass asks of the scene.
pub struct LitScene<'a> {
    /// The ray tracer.
    pub accel: Accel<'a>,
    /// By index of the scene's materials.
    pub materials: Vec<PreparedMaterial>,
    /// Lamps, emissive meshes and the world.
    pub lights: Lights,
    /// What is called for.
    pub plan: EffectsPlan,
}

/// A surface as a ray met it.
#[derive(Clone, Debug)]
pub struct Surface<'a> {
    /// Where.
    pub p: Vec3,
    /// The triangle's normal, outward as modelled.
    pub ng: Vec3,
    /// How it scatters towards where the ray came from.
    pub bsdf: Bsdf<'a>,
    /// Which triangle.
    pub hit: Hit,
    /// When, while the shutter is open.
    pub time: f32,
    /// Bit of its object's set of receivers.
    pub sets: u32,
    /// What the ray came through; clear where nobody said.
    pub medium: Medium,
    /// What its object is full of.
    solid: Medium,
}

impl Surface<'_> {
    /// What lights it.
    #[must_use]
    pub fn receiver(&self) -> Receiver {
        Receiver { p: self.p, normal: self.bsdf.lit_side(), sets: self.sets }
    }

    /// A ray that leaves it at once.
    #[must_use]
    pub fn leaving(&self, direction: Vec3, mask: u32) -> Ray {
        Ray::leaving(self.p, self.ng, direction, mask, self.time)
    }
}

impl<'a> LitScene<'a> {
    /// The surface behind a hit that is no lamp. `width` is how wide the ray is there (scene units): what varies within that
    /// is seen as its mean.
    #[must_use]
    pub fn surface(&'a self, ray: &Ray, hit: Hit, width: f32) -> Surface<'a> {
        if self.moves(hit.object) {
            return self.moving_surface(ray, hit, width);
        }
        self.still_surface(ray, hit, width)
    }

    fn still_surface(&'a self, ray: &Ray, hit: Hit, width: f32) -> Surface<'a> {
        let ng = self.accel.geometric_normal(hit.object, hit.primitive);
        let ns = self.accel.shading_normal(&hit);
        let material = &self.materials[self.accel.material(hit.object, hit.primitive)];
        let bsdf = match material.varying() {
            None => material.bsdf(-ray.direction, ng, ns),
            Some(varying) => {
                let point = HitPoint::new(self.accel.scene(), ray, &hit, [ng, ns], width);
                self.varying_bsdf(material, varying, &point)
            }
        };
        let (p, sets) = (ray.origin + ray.direction * hit.t, self.receiver_sets(hit.object));
        let (medium, solid) = (Medium::CLEAR, self.solid(&hit));
        Surface { p, ng, bsdf, hit, time: ray.time, sets, medium, solid }
    }

    /// Bit of an object's set of receivers.
    #[inline]
    #[must_use]
    pub fn receiver_sets(&self, object: u32) -> u32 {
        self.accel.scene().objects[object as usize].receiver
    }

    #[inline(never)]
    fn varying_bsdf(&self, material: &PreparedMaterial, varying: &Varying, point: &HitPoint<'_>) -> Bsdf<'a> {
        let registers = varying.run(point, &self.accel.scene().textures);
        let normals: SmallVec<[Vec3; 4]> = varying
            .normals()
            .iter()
            .map(|register| match register {
                // A program may mix normals, or compute something that is none.
                Some(register) => {
                    let normal = registers[*register as usize].v.truncate();
                    point.outward(normal).try_normalize().unwrap_or(point.ns)
                }
                None => point.ns,
            })
            .collect();
        let ns = if let [shared] = normals[..] { shared } else { point.ng };
        material.at(varying, &registers, &normals).into_bsdf(point.wo, point.ng, ns)
    }

    /// The albedo at a hit on a material that varies and is a Lambert reflector; `None` where it is more.
    #[inline(never)]
    #[must_use]
    pub fn varying_albedo(&self, material: usize, ray: &Ray, hit: &Hit, width: f32) -> Option<Rgb> {
        let varying = self.materials[material].varying().filter(|varying| varying.is_lambert())?;
        let ng = self.accel.geometric_normal(hit.object, hit.primitive);
        let ns = self.accel.shading_normal(hit);
        let scene = self.accel.scene();
        let point = HitPoint::new(scene, ray, hit, [ng, ns], width);
        Some(varying.lambert(&varying.run(&point, &scene.textures)))
    }

    /// Normals at a hit whose geometric normal is known, on the side the ray came from.
    #[must_use]
    pub fn frame(&self, ray: &Ray, hit: &Hit, ng: Vec3) -> ShadingFrame {
        ShadingFrame::new(-ray.direction, ng, self.accel.shading_normal(hit))
    }

    /// A ray at a time that starts where it enters the bounds of all there is to meet: far-off origins cost no precision. Also gives how far the
    /// origin was moved.
    #[must_use]
    pub fn entering(&self, origin: DVec3, direction: Vec3, mask: u32, time: f32) -> (Ray, f32) {
        let [low, high] = self.accel.bounds().map(Vec3::as_dvec3);
        let margin = DVec3::splat(1e-3);
        if (origin.cmpgt(low - margin) & origin.cmplt(high + margin)).all() {
            return (Ray { origin: origin.as_vec3(), direction, mask, time }, 0.0);
        }
        let d = direction.as_dvec3();
        let per_d = d.recip();
        let (to_low, to_high) = ((low - margin - origin) * per_d, (high + margin - origin) * per_d);
        let entry = to_low.min(to_high).max_element();
        let moved = if entry.is_finite() && entry > 0.0 { entry } else { 0.0 };
        #[expect(clippy::cast_possible_truncation, reason = "rays are traced in f32")]
        let moved_f32 = moved as f32;
        (Ray { origin: (origin + d * moved).as_vec3(), direction, mask, time }, moved_f32)
    }
}

/// The kind of a ray that was sampled from a BSDF, as bits of [`visibility`]: as in Cycles, one that was scattered through a
/// surface is both diffuse and a transmission.
#[must_use]
pub fn ray_kind(sample: &BsdfSample) -> u32 {
    if sample.class == LobeSet::TRANSLUCENT {
        visibility::DIFFUSE | visibility::TRANSMISSION
    } else if sample.is_transmission {
        visibility::TRANSMISSION
    } else if sample.class == LobeSet::DIFFUSE {
        visibility::DIFFUSE
    } else {
        visibility::GLOSSY
    }
}

/// Lobes that are lit by a light seen only by the ray kinds of `visible_to`.
#[must_use]
pub fn lobes_lit(visible_to: u32) -> LobeSet {
    let mut set = LobeSet::EMPTY;
    if visible_to & visibility::DIFFUSE != 0 {
        set = set | LobeSet::DIFFUSE | LobeSet::TRANSLUCENT;
    }
    if visible_to & visibility::GLOSSY != 0 {
        set = set | LobeSet::ROUGH;
    }
    if visible_to & (visibility::GLOSSY | visibility::TRANSMISSION) != 0 {
        set = set | LobeSet::SHARP | LobeSet::DELTA;
    }
    set
}

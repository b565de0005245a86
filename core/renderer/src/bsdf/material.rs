//! Materials made ready for the render: closures checked, merged and classified once, so that a hit costs little.

use std::sync::Arc;

use glam::{Quat, Vec3};
use smallvec::SmallVec;

use super::anisotropy::{self, Anisotropy};
use super::closure::{Part, PreparedClosure, most_lobes};
use super::dielectric::Glass;
use super::lobe::Lobe;
use super::normals::{Layers, Normals};
use super::oren_nayar::LEAST_ROUGHNESS;
use super::principled::{self, Principled};
use super::reflection::Roughness;
use super::sanitize::Sanitizer;
use super::varying::Varying;
use super::{Bsdf, LobeSet, MAX_LOBES, MaterialRef, ShadingFrame};
use crate::color::Rgb;
use crate::scene::record::{ClosureRecord, WeightedClosure};
use crate::scene::{Material, Problem};
use crate::shader::Registers;

/// Least value of [`PreparedMaterial::specular_tint`], so that dividing by it is safe.
const LEAST_TINT: f32 = 0.02;

/// What the effects plan takes out of a material: it is absorbed.
#[derive(Clone, Copy, Debug, Default)]
struct LeftOut {
    /// Lobes of these classes are not made.
    lobes: LobeSet,
    emission: bool,
    transparency: bool,
}

/// One material, ready to be asked for its BSDF at a hit.
#[derive(Clone, Debug, Default)]
pub struct PreparedMaterial {
    /// All Lambert closures together.
    lambert: Rgb,
    /// Emission that is the same in every direction.
    bare_emission: Rgb,
    /// Share of light that passes straight through.
    straight: Rgb,
    /// Share of a camera ray that is a hole in the picture.
    holdout: f32,
    closures: Vec<Part>,
    /// Of a material at one hit: the normals of closures that do not share one.
    normals: Normals,
    classes: LobeSet,
    constant_lambert: Option<Rgb>,
    mean_emission: Rgb,
    /// Whether the emission differs from its mean, from point to point or with the direction.
    emits_unevenly: bool,
    specular_tint: Rgb,
    /// Share of light that passes straight through, the most that can occur.
    transparency: Rgb,
    /// Whether light can be refracted through it.
    refracts: bool,
    /// Indices of refraction the energy tables will be asked for.
    etas: Vec<f32>,
    /// Of a material whose closures differ from point to point: what makes them. Its own are typical ones.
    varying: Option<Box<Varying>>,
    left_out: LeftOut,
    absorption: Rgb,
}

impl PreparedMaterial {
    /// Checks and prepares `material`; what had to be changed is added to `problems`.
    #[must_use]
    pub fn new(material: &Material, problems: &mut Vec<Problem>) -> Self {
        let mut sanitizer = Sanitizer::default();
        let mut prepared = Self::of_closures(&material.closures, Normals::default(), &[], &mut sanitizer);
        prepared.finish();
        prepared.absorption = sanitizer.absorption(material.absorption);
        sanitizer.report(&material.name, problems);
        if let Some(program) = &material.program {
            prepared.vary(Varying::new(&material.closures, program));
        }
        prepared
    }

    /// What a hit needs of closures that hold there alone; `tangents` are theirs, 0 where they have none.
    pub(super) fn at_hit(closures: &[WeightedClosure], normals: Normals, tangents: &[Vec3]) -> Self {
        Self::of_closures(closures, normals, tangents, &mut Sanitizer::default())
    }

    fn of_closures(
        closures: &[WeightedClosure],
        normals: Normals,
        tangents: &[Vec3],
        sanitizer: &mut Sanitizer,
    ) -> Self {
        let mut prepared = Self { normals, ..Self::default() };
        let mut lobes = 1;
        for (index, weighted) in closures.iter().enumerate() {
            let weight = sanitizer.weight(weighted.weight);
            let closure = sanitizer.closure(&weighted.closure);
            lobes += most_lobes(&closure, prepared.normals.is_shared());
            if lobes > MAX_LOBES {
                sanitizer.dropped += 1;
            } else if !weight.is_black() {
                prepared.add(weight, &closure, index, tangents);
            }
        }
        prepared.lambert = sanitizer.at_most_one(prepared.lambert);
        prepared.straight = sanitizer.at_most_one(prepared.straight);
        let tints = prepared.closures.iter().map(|part| part.weight * part.closure.rough_tint());
        prepared.specular_tint = tints.sum::<Rgb>().map(|c| c.max(LEAST_TINT));
        prepared
    }

    /// Makes the material one of closures that differ from point to point, and whatever it says of itself hold for all.
    fn vary(&mut self, varying: Varying) {
        for extreme in varying.extremes() {
            let mut extreme = Self::at_hit(&extreme, Normals::default(), &[]);
            extreme.finish();
            self.classes = self.classes | extreme.classes;
            self.transparency += extreme.transparency;
            self.refracts |= extreme.refracts;
            self.etas.extend(extreme.etas);
            // Where the typical emission is none, such as that of a mask, there may be some all the same.
            if self.mean_emission.is_black() {
                self.mean_emission = extreme.mean_emission;
            }
        }
        self.emits_unevenly = !self.mean_emission.is_black();
        self.transparency = self.transparency.map(|c| c.min(1.0));
        self.constant_lambert = None;
        self.varying = Some(Box::new(varying));
    }

    /// What makes the closures, where they differ from point to point.
    #[must_use]
    #[inline]
    pub fn varying(&self) -> Option<&Varying> {
        self.varying.as_deref()
    }

    /// Adds the closure that is number `index` of the material's.
    fn add(&mut self, weight: Rgb, closure: &ClosureRecord, index: usize, tangents: &[Vec3]) {
        let is_merged = self.normals.is_shared();
        let (weight, closure) = match *closure {
            ClosureRecord::Diffuse { color, roughness } if is_merged && roughness < LEAST_ROUGHNESS => {
                self.lambert += weight * color;
                return;
            }
            ClosureRecord::Transparent { color } => {
                self.straight += weight * color;
                return;
            }
            ClosureRecord::Emission { radiance } => {
                self.bare_emission += weight * radiance;
                return;
            }
            ClosureRecord::Holdout => {
                self.holdout += weight.mean();
                return;
            }
            ClosureRecord::Diffuse { color, roughness } => {
                (weight, PreparedClosure::Diffuse { color, roughness })
            }
            ClosureRecord::Translucent { color } => (weight * color, PreparedClosure::Translucent),
            ClosureRecord::Glossy { color, roughness, anisotropy, rotation, multiscatter } => {
                let factors = anisotropy::glossy_factors(anisotropy);
                let rough = Roughness::new(roughness, multiscatter).stretched(factors);
                (weight, PreparedClosure::Glossy { color, rough, rotation })
            }
            ClosureRecord::Glass { color, roughness, ior, multiscatter } => {
                let rough = Roughness::new(roughness, multiscatter);
                (weight, PreparedClosure::Glass(Glass::plain(color, rough, ior)))
            }
            ClosureRecord::Refraction { color, roughness, ior } => {
                let rough = Roughness::new(roughness, false);
                (weight * color, PreparedClosure::Refraction { rough, ior })
            }
            ClosureRecord::Sheen { color, roughness } => {
                (weight * color, PreparedClosure::Sheen { roughness })
            }
            ClosureRecord::Principled(ref record) => {
                self.straight += weight * (1.0 - record.alpha);
                let weight = weight * record.alpha;
                let principled = Principled::new(record);
                if let Some(albedo) = principled.lambert().filter(|_| is_merged) {
                    self.lambert += weight * albedo;
                    self.bare_emission += weight * principled.emission;
                    return;
                }
                (weight, PreparedClosure::Principled(Box::new(principled)))
            }
        };
        let normals = self.normals.of_closure(index, &closure);
        let anisotropy = tangents
            .get(index)
            .zip(closure.anisotropy())
            .map(|(&tangent, (alpha, rotation))| Anisotropy { alpha, rotation, tangent });
        self.closures.push(Part { weight, closure, normals, anisotropy });
    }

    /// Derives what is asked of the material as a whole.
    fn finish(&mut self) {
        self.classes = if self.lambert.is_black() { LobeSet::EMPTY } else { LobeSet::DIFFUSE };
        for part in &self.closures {
            self.classes = self.classes | part.closure.classes();
        }
        self.transparency = self.bsdf(Vec3::Z, Vec3::Z, Vec3::Z).transparency;
        self.refracts = self.closures.iter().any(|part| part.closure.transmits());
        self.etas = self.closures.iter().flat_map(|part| part.closure.etas()).collect();
        if self.closures.is_empty() && self.straight.is_black() && self.holdout == 0.0 {
            self.constant_lambert = Some(self.lambert);
        }
        self.mean_emission = self.cosine_mean_emission();
        self.emits_unevenly = self.closures.iter().any(|part| part.closure.dims_its_emission());
    }

    /// ∫ 2 cos · emission dcos.
    fn cosine_mean_emission(&self) -> Rgb {
        const STEPS: u16 = 16;
        (0..STEPS)
            .map(|k| {
                let cos = (f32::from(k) + 0.5) / f32::from(STEPS);
                let wo = Vec3::new((1.0 - cos * cos).sqrt(), 0.0, cos);
                self.bsdf(wo, Vec3::Z, Vec3::Z).emission * (2.0 * cos / f32::from(STEPS))
            })
            .sum()
    }

    /// Leaves out all lobes of the classes `lobes`: what they would scatter is absorbed.
    pub fn leave_out_lobes(&mut self, lobes: LobeSet) {
        self.left_out.lobes = self.left_out.lobes | lobes;
        self.classes = self.classes.without(lobes);
        self.refracts &= !lobes.intersects(LobeSet::DELTA);
    }

    /// Leaves out what the material emits.
    pub fn leave_out_emission(&mut self) {
        self.left_out.emission = true;
        (self.bare_emission, self.mean_emission) = (Rgb::BLACK, Rgb::BLACK);
        for part in &mut self.closures {
            if let PreparedClosure::Principled(principled) = &mut part.closure {
                principled.emission = Rgb::BLACK;
            }
        }
    }

    /// Leaves out what passes straight through: it is absorbed.
    pub fn leave_out_transparency(&mut self) {
        self.left_out.transparency = true;
        (self.straight, self.transparency) = (Rgb::BLACK, Rgb::BLACK);
        if self.closures.is_empty() && self.varying.is_none() && self.holdout == 0.0 {
            self.constant_lambert = Some(self.lambert);
        }
    }

    /// Makes the solid that the surface bounds clear.
    pub fn leave_out_absorption(&mut self) {
        self.absorption = Rgb::BLACK;
    }

    /// The material as it is at one point, where the program of `varying` gave `registers`; `normals` are those it has
    /// there ([`Varying::normals`]), on the mesh's own side.
    #[must_use]
    pub fn at(&self, varying: &Varying, registers: &Registers, normals: &[Vec3]) -> Self {
        let mut here = varying.material(registers, normals);
        here.left_out.lobes = self.left_out.lobes;
        if self.left_out.emission {
            here.leave_out_emission();
        }
        if self.left_out.transparency {
            here.leave_out_transparency();
        }
        here
    }

    /// Classes of the lobes that can occur.
    #[must_use]
    pub fn classes(&self) -> LobeSet {
        self.classes
    }

    /// Radiance emitted (W·m⁻²·sr⁻¹), the same from both sides. Under a coat it depends on the direction: this is the
    /// cosine-weighted mean, π times it is the true exitance. Where it varies it is typical. [`Bsdf::emission`] is exact.
    #[must_use]
    pub fn emission(&self) -> Rgb {
        self.mean_emission
    }

    /// True when what is emitted differs from [`PreparedMaterial::emission`], from point to point or with the direction.
    #[must_use]
    pub fn emits_unevenly(&self) -> bool {
        self.emits_unevenly
    }

    /// Share of light that passes straight through, the most that can occur.
    #[must_use]
    pub fn transparency(&self) -> Rgb {
        self.transparency
    }

    /// True when light is refracted through it.
    #[must_use]
    pub fn refracts(&self) -> bool {
        self.refracts
    }

    /// Absorption coefficient of the solid that the surface bounds (1/m).
    #[must_use]
    pub fn absorption(&self) -> Rgb {
        self.absorption
    }

    /// True when no light passes through: straight, refracted or scattered.
    #[must_use]
    pub fn is_opaque(&self) -> bool {
        self.transparency.is_black() && !self.refracts && !self.classes.intersects(LobeSet::TRANSLUCENT)
    }

    /// See [`Bsdf::holdout`].
    #[must_use]
    pub(super) fn holdout(&self) -> f32 {
        self.holdout
    }

    /// The albedo, where the material scatters as one constant Lambert lobe and nothing passes through it. A black
    /// material is one of albedo 0.
    #[must_use]
    pub fn constant_lambert(&self) -> Option<Rgb> {
        self.constant_lambert
    }

    /// Indices of refraction the energy tables will be asked for.
    pub(super) fn etas(&self) -> &[f32] {
        &self.etas
    }

    /// Normals of closures that do not share one.
    pub(super) fn normals(&self) -> &Normals {
        &self.normals
    }

    /// True where some reflection differs along the surface.
    pub(super) fn is_anisotropic(&self) -> bool {
        self.closures.iter().any(|part| part.anisotropy.is_some())
    }

    /// True when there is no lobe but Lambert's.
    pub(super) fn is_plain(&self) -> bool {
        self.closures.is_empty()
    }

    /// True when something of it is as bright from everywhere. Its normal stays as it is, for all of its lobes.
    fn is_in_part_diffuse(&self) -> bool {
        let is_diffuse = |part: &Part| part.closure.classes().intersects(LobeSet::LAMBERT);
        !self.lambert.is_black() || self.closures.iter().any(is_diffuse)
    }

    /// See [`Bsdf::specular_tint`].
    #[must_use]
    pub fn specular_tint(&self) -> Rgb {
        self.specular_tint
    }

    /// The BSDF at a hit. `wo` points to where the ray came from and decides the side; `ng` is the geometric normal on the
    /// mesh's own side (its counter-clockwise front), `ns` the interpolated one. All are unit vectors.
    #[must_use]
    #[inline]
    pub fn bsdf(&self, wo: Vec3, ng: Vec3, ns: Vec3) -> Bsdf<'_> {
        MaterialRef::Shared(self).bsdf(wo, ng, ns)
    }

    /// The same for a material that was made for this hit.
    #[must_use]
    pub fn into_bsdf<'a>(self, wo: Vec3, ng: Vec3, ns: Vec3) -> Bsdf<'a> {
        MaterialRef::Own(Arc::new(self)).bsdf(wo, ng, ns)
    }
}

impl<'a> MaterialRef<'a> {
    /// The material of a surface that was turned.
    pub(super) fn turned(self, rotation: Quat) -> Self {
        if self.normals.is_shared() && !self.is_anisotropic() {
            return self;
        }
        let normals = self.normals.turned(rotation);
        let mut turned = PreparedMaterial { normals, ..(*self).clone() };
        for anisotropy in turned.closures.iter_mut().filter_map(|part| part.anisotropy.as_mut()) {
            anisotropy.tangent = rotation * anisotropy.tangent;
        }
        Self::Own(Arc::new(turned))
    }

    #[inline]
    pub(super) fn bsdf(self, wo: Vec3, ng: Vec3, ns: Vec3) -> Bsdf<'a> {
        let material: &PreparedMaterial = &self;
        let mut frame = ShadingFrame::new(wo, ng, ns);
        if !material.is_plain() {
            frame =
                if material.is_in_part_diffuse() { frame.bent_below(wo) } else { frame.mirroring_above(wo) };
        }
        let cos = wo.dot(frame.ns).clamp(0.0, 1.0);
        let (mut emission, mut transparency) = (material.bare_emission, material.straight);
        let mut lobes = SmallVec::new();
        if !material.lambert.is_black() {
            lobes.push(Lobe::lambert(material.lambert, 0));
        }
        for (slot, part) in (1..).step_by(principled::LOBES).zip(&material.closures) {
            let Part { weight, closure, normals, anisotropy } = part;
            let (first, is_shared) = (lobes.len(), normals.base == 0);
            let cos =
                if is_shared { Layers::all(cos) } else { material.normals.cosines(*normals, wo, &frame) };
            let unscattered = closure.push(&mut lobes, *weight, frame.entering, cos, slot);
            emission += unscattered.emission;
            transparency += unscattered.straight;
            if !is_shared {
                for lobe in &mut lobes[first..] {
                    lobe.normal = principled::layer(*normals, lobe.slot - slot);
                }
            }
            if let Some(anisotropy) = anisotropy {
                let ns = material.normals.reflecting(normals.base, wo, &frame);
                anisotropy.lay(&mut lobes[first..], ns, |lobe| closure.is_anisotropic(lobe.slot - slot));
            }
        }
        if material.left_out.lobes != LobeSet::EMPTY {
            lobes.retain(|lobe: &mut Lobe| !material.left_out.lobes.intersects(lobe.class));
        }
        if material.left_out.transparency {
            transparency = Rgb::BLACK;
        }
        transparency = transparency.map(|c| c.min(1.0));
        Bsdf { material: self, wo, lobes, emission, transparency, frame }
    }
}

//! Materials made ready for the render: closures checked, merged and classified once, so that a hit costs little.

use std::ops::Index;

use glam::Vec3;
use smallvec::SmallVec;

use super::dielectric::{self, Glass};
use super::lobe::Lobe;
use super::principled::{self, Principled};
use super::reflection::{self, Roughness};
use super::sanitize::Sanitizer;
use super::{Bsdf, LobeSet, MAX_LOBES, ShadingFrame, energy_table, fresnel};
use crate::color::Rgb;
use crate::scene::record::ClosureRecord;
use crate::scene::{Material, Problem};

/// Least value of [`PreparedMaterial::specular_tint`], so that dividing by it is safe.
const LEAST_TINT: f32 = 0.02;

/// A closure that makes lobes; Lambert, transparency and constant emission are merged in the material.
#[derive(Clone, Debug)]
enum PreparedClosure {
    Glossy { color: Rgb, rough: Roughness },
    Glass(Glass),
    Refraction { rough: Roughness, ior: f32 },
    Principled(Box<Principled>),
}

/// One material, ready to be asked for its BSDF at a hit.
#[derive(Clone, Debug, Default)]
pub struct PreparedMaterial {
    /// All Lambert closures together.
    lambert: Rgb,
    /// Emission that is the same in every direction.
    bare_emission: Rgb,
    transparency: Rgb,
    closures: Vec<(Rgb, PreparedClosure)>,
    classes: LobeSet,
    constant_lambert: Option<Rgb>,
    mean_emission: Rgb,
    specular_tint: Rgb,
    /// Lobes of these classes are not made.
    left_out: LobeSet,
}

impl PreparedMaterial {
    /// Checks and prepares `material`; what had to be changed is added to `problems`.
    #[must_use]
    pub fn new(material: &Material, problems: &mut Vec<Problem>) -> Self {
        let mut sanitizer = Sanitizer::default();
        let mut prepared = Self::default();
        let mut lobes = 1;
        for weighted in &material.closures {
            let weight = sanitizer.weight(weighted.weight);
            let closure = sanitizer.closure(&weighted.closure);
            lobes += most_lobes(&closure);
            if lobes > MAX_LOBES {
                sanitizer.dropped += 1;
            } else if !weight.is_black() {
                prepared.add(weight, &closure);
            }
        }
        prepared.finish(&mut sanitizer);
        sanitizer.report(&material.name, problems);
        prepared
    }

    fn add(&mut self, weight: Rgb, closure: &ClosureRecord) {
        let closure = match *closure {
            ClosureRecord::Diffuse { color } => {
                self.lambert += weight * color;
                return;
            }
            ClosureRecord::Transparent { color } => {
                self.transparency += weight * color;
                return;
            }
            ClosureRecord::Emission { radiance } => {
                self.bare_emission += weight * radiance;
                return;
            }
            ClosureRecord::Glossy { color, roughness } => {
                PreparedClosure::Glossy { color, rough: Roughness::new(roughness) }
            }
            ClosureRecord::Glass { color, roughness, ior } => PreparedClosure::Glass(Glass {
                ior,
                f0: Rgb::splat(fresnel::f0_from_ior(ior)),
                reflection_tint: color,
                transmission_tint: color,
                rough: Roughness::new(roughness),
            }),
            ClosureRecord::Refraction { color, roughness, ior } => {
                let closure = PreparedClosure::Refraction { rough: Roughness::new(roughness), ior };
                self.closures.push((weight * color, closure));
                return;
            }
            ClosureRecord::Principled(ref record) => {
                self.transparency += weight * (1.0 - record.alpha);
                let weight = weight * record.alpha;
                let principled = Principled::new(record);
                if let Some(albedo) = principled.lambert() {
                    self.lambert += weight * albedo;
                    self.bare_emission += weight * principled.emission;
                    return;
                }
                self.closures.push((weight, PreparedClosure::Principled(Box::new(principled))));
                return;
            }
        };
        self.closures.push((weight, closure));
    }

    /// Derives what is asked of the material as a whole.
    fn finish(&mut self, sanitizer: &mut Sanitizer) {
        self.lambert = sanitizer.at_most_one(self.lambert);
        self.transparency = sanitizer.at_most_one(self.transparency);
        self.classes = if self.lambert.is_black() { LobeSet::EMPTY } else { LobeSet::DIFFUSE };
        for (_, closure) in &self.closures {
            self.classes = self.classes | closure.classes();
        }
        if self.closures.is_empty() && self.transparency.is_black() {
            self.constant_lambert = Some(self.lambert);
        }
        let tint: Rgb = self.closures.iter().map(|(weight, closure)| *weight * closure.rough_tint()).sum();
        self.specular_tint = tint.map(|c| c.max(LEAST_TINT));
        self.mean_emission = self.cosine_mean_emission();
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
        self.left_out = self.left_out | lobes;
        self.classes = self.classes.without(lobes);
    }

    /// Leaves out what the material emits.
    pub fn leave_out_emission(&mut self) {
        (self.bare_emission, self.mean_emission) = (Rgb::BLACK, Rgb::BLACK);
        for (_, closure) in &mut self.closures {
            if let PreparedClosure::Principled(principled) = closure {
                principled.emission = Rgb::BLACK;
            }
        }
    }

    /// Leaves out what passes straight through: it is absorbed.
    pub fn leave_out_transparency(&mut self) {
        self.transparency = Rgb::BLACK;
        if self.closures.is_empty() {
            self.constant_lambert = Some(self.lambert);
        }
    }

    /// Classes of the lobes that can occur.
    #[must_use]
    pub fn classes(&self) -> LobeSet {
        self.classes
    }

    /// Radiance emitted (W·m⁻²·sr⁻¹), the same from both sides. Under a coat it depends on the direction: this is the
    /// cosine-weighted mean, π times it is the true exitance. [`Bsdf::emission`] is exact.
    #[must_use]
    pub fn emission(&self) -> Rgb {
        self.mean_emission
    }

    /// Share of light that passes straight through.
    #[must_use]
    pub fn transparency(&self) -> Rgb {
        self.transparency
    }

    /// True when no light passes through, straight or refracted.
    #[must_use]
    pub fn is_opaque(&self) -> bool {
        let passes = |closure: &PreparedClosure| match closure {
            PreparedClosure::Glossy { .. } => false,
            PreparedClosure::Glass(_) | PreparedClosure::Refraction { .. } => true,
            PreparedClosure::Principled(principled) => principled.transmits(),
        };
        let refracts = !self.left_out.intersects(LobeSet::DELTA);
        self.transparency.is_black()
            && !(refracts && self.closures.iter().any(|(_, closure)| passes(closure)))
    }

    /// The albedo, where the material scatters as one constant Lambert lobe and nothing passes through it. A black
    /// material is one of albedo 0.
    #[must_use]
    pub fn constant_lambert(&self) -> Option<Rgb> {
        self.constant_lambert
    }

    /// True when there is no lobe but Lambert's.
    pub(super) fn is_plain(&self) -> bool {
        self.closures.is_empty()
    }

    /// Color at normal incidence of the lobes of class [`LobeSet::ROUGH`], at least 0.02. Direction bins hold radiance
    /// divided by it.
    #[must_use]
    pub fn specular_tint(&self) -> Rgb {
        self.specular_tint
    }

    /// The BSDF at a hit. `wo` points to where the ray came from and decides the side; `ng` is the geometric normal on the
    /// mesh's own side (its counter-clockwise front), `ns` the interpolated one. All are unit vectors.
    #[must_use]
    #[inline]
    pub fn bsdf(&self, wo: Vec3, ng: Vec3, ns: Vec3) -> Bsdf<'_> {
        let frame = ShadingFrame::new(wo, ng, ns);
        let cos = wo.dot(frame.ns).clamp(0.0, 1.0);
        let (emission, transparency) = (self.bare_emission, self.transparency);
        let mut bsdf = Bsdf { material: self, wo, lobes: SmallVec::new(), emission, transparency, frame };
        if !self.lambert.is_black() {
            bsdf.lobes.push(Lobe::lambert(self.lambert, 0));
        }
        for (slot, (weight, closure)) in (1..).step_by(principled::LOBES).zip(&self.closures) {
            bsdf.emission += closure.push(&mut bsdf.lobes, *weight, frame.entering, cos, slot);
        }
        if self.left_out != LobeSet::EMPTY {
            bsdf.lobes.retain(|lobe| !self.left_out.intersects(lobe.class));
        }
        bsdf
    }
}

impl PreparedClosure {
    /// Adds the lobes towards a viewer at `cos` from the normal; returns the radiance emitted towards it.
    fn push(&self, lobes: &mut super::LobeList, weight: Rgb, entering: bool, cos: f32, slot: u8) -> Rgb {
        match self {
            Self::Glossy { color, rough } => {
                reflection::push_constant(lobes, weight, *color, *rough, cos, slot);
            }
            Self::Glass(glass) => glass.push(lobes, weight, entering, cos, slot),
            Self::Refraction { rough, ior } => {
                let eta = if entering { *ior } else { 1.0 / ior };
                dielectric::push_refraction(lobes, weight, *rough, eta, cos, slot);
            }
            Self::Principled(principled) => {
                let seen = principled.push(lobes, weight, entering, cos, slot);
                return weight * seen * principled.emission;
            }
        }
        Rgb::BLACK
    }

    fn classes(&self) -> LobeSet {
        match self {
            Self::Glossy { rough, .. } => rough.reflection_class(),
            Self::Glass(glass) => glass.classes(),
            Self::Refraction { rough, ior } => super::lobe::transmission_class(rough.alpha, *ior),
            Self::Principled(principled) => principled.classes(),
        }
    }

    fn rough_tint(&self) -> Rgb {
        match self {
            Self::Glossy { color, rough } if rough.reflection_class() == LobeSet::ROUGH => *color,
            Self::Glass(glass) if glass.rough.reflection_class() == LobeSet::ROUGH => {
                glass.f0 * glass.reflection_tint
            }
            Self::Principled(principled) => principled.rough_tint(),
            _ => Rgb::BLACK,
        }
    }

    fn etas(&self) -> impl Iterator<Item = f32> {
        let own = match self {
            Self::Glass(glass) => Some(glass.ior),
            Self::Refraction { ior, .. } => Some(*ior),
            _ => None,
        };
        let principled = if let Self::Principled(p) = self { Some(p.etas()) } else { None };
        own.into_iter().chain(principled.into_iter().flatten())
    }
}

/// Most lobes `closure` can make besides the merged Lambert lobe.
fn most_lobes(closure: &ClosureRecord) -> usize {
    match closure {
        ClosureRecord::Glossy { .. } | ClosureRecord::Refraction { .. } => 1,
        ClosureRecord::Glass { .. } => 2,
        ClosureRecord::Principled(_) => principled::LOBES,
        _ => 0,
    }
}

/// All materials of a scene, by their index there.
#[derive(Debug, Default)]
pub struct MaterialTable {
    materials: Vec<PreparedMaterial>,
    /// Values that had to be changed, by material.
    pub problems: Vec<Problem>,
}

impl MaterialTable {
    /// Prepares `materials`, and the energy tables they need (some 20 ms the first time an index of refraction is met).
    #[must_use]
    pub fn build(materials: &[Material]) -> Self {
        let mut problems = Vec::new();
        let materials: Vec<_> = materials.iter().map(|m| PreparedMaterial::new(m, &mut problems)).collect();
        let closures = || materials.iter().flat_map(|m| &m.closures);
        if closures().next().is_some() {
            energy_table::prepare(&closures().flat_map(|(_, closure)| closure.etas()).collect::<Vec<_>>());
        }
        Self { materials, problems }
    }

    /// The materials in order.
    pub fn iter(&self) -> impl Iterator<Item = &PreparedMaterial> {
        self.materials.iter()
    }
}

impl Index<usize> for MaterialTable {
    type Output = PreparedMaterial;

    fn index(&self, index: usize) -> &PreparedMaterial {
        &self.materials[index]
    }
}

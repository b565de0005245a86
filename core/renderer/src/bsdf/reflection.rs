//! Lobes of GGX reflection: constant reflectance (Glossy BSDF), metal, and a dielectric layer over something else.

use super::fresnel;
use super::lobe::{self, Fresnel, Lobe, Shape};
use super::{LobeList, LobeSet};
use super::{anisotropy, energy_table};
use crate::color::Rgb;

/// Microfacets: Blender's roughness, and the GGX alpha it stands for. Both are zero where the lobe is a delta, so that
/// tables and class agree.
#[derive(Clone, Copy, Debug)]
pub(super) struct Roughness {
    /// Blender's roughness.
    pub(super) roughness: f32,
    /// GGX alpha; the geometric mean of both where there are two.
    pub(super) alpha: f32,
    /// The alphas along a tangent and across it, where they differ.
    pub(super) pair: Option<[f32; 2]>,
    /// Whether light that bounces between microfacets leaves in the end (Blender's Multiscatter GGX) or is lost (GGX).
    multiscatter: bool,
}

impl Roughness {
    /// From Blender's roughness, 0 to 1.
    pub(super) fn new(roughness: f32, multiscatter: bool) -> Self {
        let alpha = roughness * roughness;
        let is_delta = alpha <= lobe::DELTA_ALPHA;
        let (roughness, alpha) = if is_delta { (0.0, 0.0) } else { (roughness, alpha) };
        Self { roughness, alpha, pair: None, multiscatter }
    }

    /// The same with `factors` on alpha along a tangent and across it.
    pub(super) fn stretched(self, factors: [f32; 2]) -> Self {
        let Some([along, across]) = anisotropy::alphas(self.alpha, factors) else { return self };
        let alpha = (along * across).sqrt();
        Self { roughness: alpha.sqrt(), alpha, pair: Some([along, across]), ..self }
    }

    /// Factor on the single-scattering albedo `total`, see [`energy_table::compensation`].
    pub(super) fn gain(self, total: f32, mean: f32, fss: Rgb) -> Rgb {
        if self.multiscatter { energy_table::compensation(total, mean, fss) } else { Rgb::WHITE }
    }

    /// [`Roughness::gain`] times this is what a white surface hides from what lies below: whatever bounces between
    /// microfacets never gets there, also where it is lost.
    fn hiding(self, total: f32) -> f32 {
        if self.multiscatter { total } else { 1.0 }
    }

    /// Class of a reflection. Bins of directions blur what is narrow one way.
    pub(super) fn reflection_class(self) -> LobeSet {
        lobe::reflection_class(self.pair.map_or(self.alpha, |[along, across]| along.min(across)))
    }
}

/// Reflection of `weight`, the same at every angle; `fss` is what each bounce between microfacets leaves.
pub(super) fn constant(weight: Rgb, fss: Rgb, rough: Roughness, cos: f32, slot: u8) -> Lobe {
    let table = energy_table::reflection(rough.roughness, cos);
    let gain = rough.gain(table.total, table.mean, fss);
    let weight = weight * gain;
    Lobe {
        shape: Shape::Reflection { alpha: rough.alpha },
        fresnel: Fresnel::Full,
        weight,
        gain,
        albedo: weight * table.total,
        class: rough.reflection_class(),
        slot,
        normal: 0,
    }
}

/// Reflection of a metal, see [`fresnel::metal`].
#[derive(Clone, Copy, Debug)]
pub(super) struct Metal {
    /// Reflectance at normal incidence.
    pub(super) f0: Rgb,
    /// Dip towards grazing.
    pub(super) dip: Rgb,
}

impl Metal {
    /// Adds the lobe. Its albedo knows nothing of the clamp at 0 in [`fresnel::metal`]: 0.015 too low for an edge tint of 0,
    /// less than 0.005 from 0.2 on.
    pub(super) fn push(self, lobes: &mut LobeList, weight: Rgb, rough: Roughness, cos: f32, slot: u8) {
        let table = energy_table::reflection(rough.roughness, cos);
        let fss = fresnel::metal_mean(self.f0, self.dip);
        let gain = rough.gain(table.total, table.mean, fss);
        let weight = weight * gain;
        let schlick = self.f0 * (table.total - table.schlick) + Rgb::splat(table.schlick);
        let single = (schlick - self.dip * table.dent).map(|c| c.max(0.0));
        lobes.push(Lobe {
            shape: Shape::Reflection { alpha: rough.alpha },
            fresnel: Fresnel::Metal { f0: self.f0, dip: self.dip },
            weight,
            gain,
            albedo: weight * single,
            class: rough.reflection_class(),
            slot,
            normal: 0,
        });
    }
}

/// A dielectric coating: it reflects by Fresnel, and what lies below gets the rest.
#[derive(Clone, Copy, Debug)]
pub(super) struct Layer {
    /// Index of refraction, the same from both sides.
    pub(super) eta: f32,
    /// Reflectance at normal incidence.
    pub(super) f0: Rgb,
    /// Roughness.
    pub(super) rough: Roughness,
}

impl Layer {
    /// Adds the lobe and returns what part of the light reaches what lies below.
    pub(super) fn push(self, lobes: &mut LobeList, weight: Rgb, share: f32, cos: f32, slot: u8) -> f32 {
        let Self { eta, f0, rough } = self;
        let reflection = energy_table::reflection(rough.roughness, cos);
        let table = energy_table::dielectric(rough.roughness, cos, eta, reflection.total);
        let (rise, layer) = match rough.reflection_class() {
            LobeSet::DELTA => {
                let rise = fresnel::dielectric_rise(cos, eta);
                (rise, rise)
            }
            _ => (table.rise, table.layer),
        };
        let fss = f0.lerp(Rgb::WHITE, mean_rise(eta));
        let gain = rough.gain(reflection.total, reflection.mean, fss);
        let dimmed = gain * share;
        let reflected = dimmed * (f0 * (reflection.total - rise) + Rgb::splat(rise));
        lobes.push(Lobe {
            shape: Shape::Reflection { alpha: rough.alpha },
            fresnel: Fresnel::Dielectric { f0, eta },
            weight: weight * dimmed,
            gain,
            albedo: weight * reflected,
            class: rough.reflection_class(),
            slot,
            normal: 0,
        });
        // Cycles takes the first, an estimate. It makes light from nothing where it is the smaller: by 1.5 % at most, at
        // cosines below 0.05, but by half for indices below 1.
        let estimate = dimmed * f0.lerp(Rgb::WHITE, layer) * rough.hiding(reflection.total);
        (1.0 - estimate.max_channel().max(reflected.max_channel())).max(0.0)
    }
}

/// Cosine-weighted mean of [`fresnel::dielectric_rise`].
fn mean_rise(eta: f32) -> f32 {
    let f0 = fresnel::f0_from_ior(eta);
    ((fresnel::dielectric_mean(eta) - f0) / (1.0 - f0)).clamp(0.0, 1.0)
}

//! Lobes of a dielectric boundary: reflection and refraction (Glass BSDF), or refraction alone (Refraction BSDF).

use super::energy_table;
use super::lobe::{Fresnel, Lobe, Shape, transmission_class};
use super::reflection::Roughness;
use super::{LobeList, LobeSet, fresnel};
use crate::color::Rgb;

/// Glass: Fresnel decides between reflection and refraction.
#[derive(Clone, Copy, Debug)]
pub(super) struct Glass {
    /// Index of refraction, inside over outside.
    pub(super) ior: f32,
    /// Reflectance at normal incidence; of plain glass the one of `ior`.
    pub(super) f0: Rgb,
    /// Factor on what is reflected.
    pub(super) reflection_tint: Rgb,
    /// Factor on what is refracted.
    pub(super) transmission_tint: Rgb,
    /// Roughness.
    pub(super) rough: Roughness,
}

impl Glass {
    /// Glass of one tint whose reflectance is that of its index.
    pub(super) fn plain(color: Rgb, rough: Roughness, ior: f32) -> Self {
        let f0 = Rgb::splat(fresnel::f0_from_ior(ior));
        Self { ior, f0, reflection_tint: color, transmission_tint: color, rough }
    }

    /// Classes of both lobes.
    pub(super) fn classes(&self) -> LobeSet {
        self.rough.reflection_class() | transmission_class(self.rough.alpha, self.ior)
    }

    /// Adds a reflection (`slot`) and a transmission (`slot` + 1).
    pub(super) fn push(self, lobes: &mut LobeList, weight: Rgb, entering: bool, cos: f32, slot: u8) {
        let eta = if entering { self.ior } else { 1.0 / self.ior };
        let Roughness { roughness, alpha, .. } = self.rough;
        let class = transmission_class(alpha, eta);
        let total = energy_table::reflection(roughness, cos).total;
        let (rise, through, gain) = if class == LobeSet::DELTA {
            let rise = fresnel::dielectric_rise(cos, eta);
            (rise * total, 1.0 - rise, Rgb::WHITE)
        } else {
            let table = energy_table::dielectric(roughness, cos, eta, total);
            let plain = fresnel::f0_from_ior(eta);
            let refracted = (1.0 - plain) * (table.through + table.stray);
            let scaled = plain * (total - table.rise) + table.rise + refracted;
            (table.rise, table.through, self.rough.gain(scaled, table.mean, self.transmission_tint))
        };
        let fresnel = Fresnel::Dielectric { f0: self.f0, eta };
        let reflected = weight * gain * self.reflection_tint;
        lobes.push(Lobe {
            shape: Shape::Reflection { alpha },
            fresnel,
            weight: reflected,
            gain,
            albedo: reflected * (self.f0 * (total - rise) + Rgb::splat(rise)),
            class: self.rough.reflection_class(),
            slot,
            normal: 0,
        });
        let transmitted = weight * gain * self.transmission_tint;
        lobes.push(Lobe {
            shape: Shape::Transmission { alpha, eta },
            fresnel,
            weight: transmitted,
            gain,
            albedo: transmitted * (Rgb::WHITE - self.f0) * through,
            class,
            slot: slot + 1,
            normal: 0,
        });
    }
}

/// Refraction without Fresnel: everything passes that is not totally reflected, which is lost.
pub(super) fn push_refraction(
    lobes: &mut LobeList,
    weight: Rgb,
    rough: Roughness,
    eta: f32,
    cos: f32,
    slot: u8,
) {
    let class = transmission_class(rough.alpha, eta);
    let refracted = if class == LobeSet::DELTA {
        f32::from(u8::from(fresnel::cos_refracted(cos, eta).is_some()))
    } else {
        let total = energy_table::reflection(rough.roughness, cos).total;
        energy_table::dielectric(rough.roughness, cos, eta, total).refracted
    };
    lobes.push(Lobe {
        shape: Shape::Transmission { alpha: rough.alpha, eta },
        fresnel: Fresnel::Full,
        weight,
        gain: Rgb::WHITE,
        albedo: weight * refracted,
        class,
        slot,
        normal: 0,
    });
}

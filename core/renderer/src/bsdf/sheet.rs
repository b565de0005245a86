//! Thin walls: glass that is no solid but a sheet without thickness, such as a window pane or a soap bubble.
//!
//! Light goes to and fro between both faces; with r the reflectance of one of them, t = 1 - r, and c what is left after one way
//! through, geometric series give what leaves in the end (OpenPBR, "Thin-walled case"):
//!
//! T = c t² / (1 - r² c²),  R = r + r c T.
//!
//! Nothing is bent. What passes rough glass is a reflection mirrored to the far side, spread less than what is refracted once;
//! what passes smooth glass goes straight on, as through a Transparent BSDF: shadow rays pass too, as in Cycles.

use super::lobe::{Fresnel, Lobe, Shape};
use super::reflection::{self, Roughness};
use super::{LobeList, LobeSet, energy_table, fresnel};
use crate::color::Rgb;

/// Keeps what a sheet reflects off 0 in every channel, so that it can be divided by.
const LEAST: f32 = 1e-6;

/// A sheet of glass, the same from both sides.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sheet {
    /// Index of refraction, of the glass over that of its surroundings.
    ior: f32,
    /// Reflectance of one face at normal incidence.
    f0: Rgb,
    /// Share of light that is left after one way through at normal incidence.
    color: Rgb,
    /// What each bounce between microfacets leaves.
    bounced: Rgb,
    rough: Roughness,
    /// Of what passes.
    spread: Roughness,
}

impl Sheet {
    /// From Blender's roughness and specular tint, at most 1, and the reflectance `f0` of one face.
    pub(super) fn new(ior: f32, f0: Rgb, color: Rgb, tint: Rgb, roughness: f32) -> Self {
        // The spread of two refractions over that of a reflection, squared (Kulla and Conty 2017, "Revisiting Physically Based
        // Shading at Imageworks", p. 40, with 3.4 for 3.7 as in Cycles).
        let squared = 3.4 * (ior - 1.0) * (ior - 0.5).powi(2) / ior.powi(3);
        let alpha = (roughness * roughness * squared.max(0.0).sqrt()).min(1.0);
        Self {
            ior,
            f0,
            color,
            bounced: tint,
            // Thin walls lose nothing between microfacets, whatever the distribution.
            rough: Roughness::new(roughness, true),
            spread: Roughness::new(alpha.sqrt(), true),
        }
    }

    /// True where what passes goes straight on.
    pub(super) fn is_clear(&self) -> bool {
        self.spread.alpha == 0.0
    }

    /// Classes of its lobes.
    pub(super) fn classes(&self) -> LobeSet {
        let passed = if self.is_clear() { LobeSet::EMPTY } else { LobeSet::SHARP };
        self.rough.reflection_class() | passed
    }

    /// Color at normal incidence of what is reflected.
    pub(super) fn reflectance(&self) -> Rgb {
        self.shares(1.0)[0]
    }

    /// What is reflected and what passes at `cos` from the normal.
    fn shares(&self, cos: f32) -> [Rgb; 2] {
        let r = self.f0.lerp(Rgb::WHITE, fresnel::dielectric_rise(cos, self.ior));
        let left = match fresnel::cos_refracted(cos, self.ior) {
            Some(cos) => self.color.map(|c| c.powf(1.0 / cos)),
            None => Rgb::BLACK,
        };
        let around = r * left;
        let passed = [0, 1, 2].map(|k| {
            let through = 1.0 - r.0[k];
            left.0[k] * through * through / (1.0 - around.0[k] * around.0[k]).max(f32::MIN_POSITIVE)
        });
        [r + around * Rgb(passed), Rgb(passed)]
    }

    /// Adds a reflection (`slot`) and, unless it is clear, a transmission (`slot` + 1); returns the share that goes straight on.
    pub(super) fn push(&self, lobes: &mut LobeList, weight: Rgb, cos: f32, slot: u8) -> Rgb {
        let [reflected, passed] = self.shares(cos);
        let at_normal = self.reflectance() + Rgb::splat(LEAST);
        let lobe = reflection::constant(weight * at_normal, self.bounced, self.rough, cos, slot);
        // The angle is the viewer's, not that of microfacets, and so is what it does to the reflectance.
        let rise = Rgb([0, 1, 2].map(|k| (reflected.0[k] + LEAST) / at_normal.0[k]));
        let [weight_rising, gain, albedo] = [lobe.weight, lobe.gain, lobe.albedo].map(|part| part * rise);
        lobes.push(Lobe { weight: weight_rising, gain, albedo, ..lobe });
        if self.is_clear() {
            return weight * passed;
        }
        let table = energy_table::reflection(self.spread.roughness, cos);
        let gain = self.spread.gain(table.total, table.mean, Rgb::WHITE);
        let weight = weight * passed * gain;
        lobes.push(Lobe {
            shape: Shape::Mirrored { alpha: self.spread.alpha },
            fresnel: Fresnel::Full,
            weight,
            gain,
            albedo: weight * table.total,
            class: LobeSet::SHARP,
            slot: slot + 1,
            normal: 0,
        });
        Rgb::BLACK
    }
}

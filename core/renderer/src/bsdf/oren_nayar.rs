//! Diffuse reflection from a surface of rough facets: the model of Oren and Nayar (1994) as Fujii improved it (2012, *A tiny
//! improvement of Oren-Nayar reflectance model*), with the light of several bounces between facets brought back as by
//! Portsmouth, Kutz and Hill (2025, *EON: A Practical Energy-Preserving Rough Diffuse BRDF*).
//!
//! f = ρ/π (A + B t + M L(cos_o) L(cos_i))
//!
//! Here ρ is the color, A = 1 / (1 + C σ) and B = σ A with the roughness σ and C = 1/2 - 2/(3π); s = wo·wi - cos_o cos_i tells how
//! far both directions lean the same way, and t is s where that is negative, else s / max(cos_o, cos_i). L is what white facets
//! keep of light from everywhere in one bounce, and M what brings it back after several. Roughness 0 is Lambert's.
//!
//! M is as in Cycles from Blender 4.3 on, which has one factor ρ more than the paper: the same for white facets, up to 6 % darker
//! for ρ = 0.5 and σ = 1.

use std::f32::consts::{FRAC_1_PI, PI};

use crate::color::Rgb;

/// Roughness below this is none, as in Cycles.
pub(super) const LEAST_ROUGHNESS: f32 = 1e-5;

/// C in the formula.
const FACING_LOSS: f32 = 0.5 - 2.0 / (3.0 * PI);

/// The facets of a rough surface.
#[derive(Clone, Copy, Debug)]
pub(super) struct Facets {
    /// A in the formula.
    level: f32,
    /// B in the formula.
    depth: f32,
}

impl Facets {
    /// Those of Blender's roughness, in (0, 1].
    pub(super) fn new(roughness: f32) -> Self {
        let level = 1.0 / (1.0 + FACING_LOSS * roughness);
        Self { level, depth: roughness * level }
    }

    /// L in the formula: nothing at the horizon.
    fn lost(self, cos: f32) -> f32 {
        let (cos, sin) = (cos.min(1.0), (1.0 - cos * cos).max(0.0).sqrt());
        let leaning = sin * (cos.acos() - sin * cos - 2.0 / 3.0)
            + 2.0 / 3.0 * sin * cos * (1.0 + sin + sin * sin) / (1.0 + sin);
        self.depth * (FACING_LOSS - leaning * FRAC_1_PI)
    }

    /// Mean of L by cosine.
    fn mean_lost(self) -> f32 {
        self.depth * (FACING_LOSS - 2.0 / 3.0 + 28.0 / (15.0 * PI))
    }

    /// M in the formula, for facets of `color`.
    pub(super) fn bounced(self, color: Rgb) -> Rgb {
        let lost = self.mean_lost();
        color.map(|c| c * c * (1.0 - lost) / (lost * (1.0 - c * lost)))
    }

    /// The BSDF (sr⁻¹) over ρ, where `between` is wo·wi.
    pub(super) fn value(self, bounced: Rgb, [cos_o, cos_i]: [f32; 2], between: f32) -> Rgb {
        let s = between - cos_o * cos_i;
        let t = if s > 0.0 { s / cos_o.max(cos_i) } else { s };
        let single = Rgb::splat(self.level + self.depth * t);
        (single + bounced * (self.lost(cos_o) * self.lost(cos_i))) * FRAC_1_PI
    }

    /// Mean by cosine of [`Facets::albedo`].
    pub(super) fn mean_albedo(self, bounced: Rgb) -> Rgb {
        let lost = self.mean_lost();
        Rgb::splat(1.0 - lost) + bounced * (lost * lost)
    }

    /// The albedo over ρ, for a viewer at `cos`.
    pub(super) fn albedo(self, bounced: Rgb, cos: f32) -> Rgb {
        let lost = self.lost(cos);
        Rgb::splat(1.0 - lost) + bounced * (lost * self.mean_lost())
    }
}

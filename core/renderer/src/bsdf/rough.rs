//! The rough reflections towards many directions at once: what fills the direction bins of glossy cells.
//!
//! The same values as [`Bsdf::eval`], written without branches over arrays, so that the loops become vector code where
//! they are compiled for it. With h = wo + wi not normalized, |h| is twice the cosine at the microfacet.
//!
//! A photon comes from `wo` and the viewer is at `wi`, the reverse of what a [`Bsdf`] is made for. Single scattering does
//! not care. What stands for light of many bounces between microfacets is the viewer's, by as much as a factor of two: it
//! is left out here, and [`Bsdf::rough_gain`] brings it in where the viewer is known. How layers dim each other is taken as
//! the photon's direction has it.

use std::f32::consts::PI;

use super::lobe::{Fresnel, Shape};
use super::{Bsdf, LobeSet, ShadingFrame, fresnel};
use crate::color::Rgb;

/// Half vectors shorter than this (squared) belong to directions that are opposite but for rounding.
const LEAST_HALF: f32 = 1e-12;

impl Bsdf<'_> {
    /// Over the viewer's [`Bsdf::rough_gain`], what the lobes of class [`LobeSet::ROUGH`] send towards viewers at `N` unit
    /// vectors of light from `wo`. Directions are given by axis, values (sr⁻¹) come by channel.
    #[must_use]
    #[inline(always)]
    pub fn eval_rough<const N: usize>(&self, wi: &[[f32; N]; 3]) -> [[f32; N]; 3] {
        let mut out = [[0.0; N]; 3];
        if self.wo.dot(self.frame.ns) <= 0.0 {
            return out;
        }
        let mut half = [0.0; N];
        for i in 0..N {
            let h = [wi[0][i] + self.wo.x, wi[1][i] + self.wo.y, wi[2][i] + self.wo.z];
            half[i] = at_least(h[0] * h[0] + h[1] * h[1] + h[2] * h[2], LEAST_HALF);
        }
        for lobe in self.lobes(LobeSet::ROUGH) {
            let own = (lobe.normal != 0).then(|| self.own_frame(lobe));
            let ShadingFrame { ns, ng, .. } = *own.as_ref().unwrap_or(&self.frame);
            let mut cos_i = [0.0; N];
            let mut above = [false; N];
            for i in 0..N {
                let [x, y, z] = [wi[0][i], wi[1][i], wi[2][i]];
                cos_i[i] = x * ns.x + y * ns.y + z * ns.z;
                above[i] = (cos_i[i] > 0.0) & (x * ng.x + y * ng.y + z * ng.z > 0.0);
            }
            let mut values = match lobe.shape {
                Shape::Reflection { alpha } => microfacets(alpha, self.wo.dot(ns), &cos_i, &half),
                Shape::Anisotropic(facets) => facets.values(ns, self.wo, wi, &half),
                _ => continue,
            };
            for i in 0..N {
                values[i] = if above[i] { values[i] } else { 0.0 };
            }
            let leaning = own.map_or(1.0, |own| own.irradiance_factor(self.wo));
            let weight = [0, 1, 2].map(|c| lobe.weight.0[c] / lobe.gain.0[c] * leaning);
            add_reflected(&mut out, lobe.fresnel, weight, &values, &half);
        }
        out
    }

    /// What [`Bsdf::eval_rough`] leaves out, for a viewer at `wo`: of several lobes the mean by albedo.
    #[must_use]
    pub fn rough_gain(&self) -> Rgb {
        let (mut gain, mut total) = (Rgb::BLACK, 0.0);
        for lobe in self.lobes(LobeSet::ROUGH) {
            // Never 0, so that a black lobe alone has a gain too.
            let share = lobe.albedo.mean() + 1e-12;
            gain += lobe.gain * share;
            total += share;
        }
        if total > 0.0 { gain * (1.0 / total) } else { Rgb::WHITE }
    }
}

/// D G / (4 cos_o cos_i) of the GGX distribution, one fraction in all; `half` is |h|².
#[inline(always)]
fn microfacets<const N: usize>(alpha: f32, cos_o: f32, cos_i: &[f32; N], half: &[f32; N]) -> [f32; N] {
    let alpha2 = alpha * alpha;
    // The floors of `Lobe::eval`. With s = √(1 + α² tan²), G is 2 over the sum of both directions' s.
    let floored = cos_o.max(1e-6);
    let slope_o = (1.0 + alpha2 * (1.0 - floored * floored) / (floored * floored)).sqrt();
    let mut values = [0.0; N];
    for i in 0..N {
        let cos = at_least(cos_i[i], 1e-6);
        let along = cos_o + cos_i[i];
        let spread = half[i] - (1.0 - alpha2) * (along * along);
        let masking = cos * slope_o + (alpha2 + (1.0 - alpha2) * (cos * cos)).sqrt();
        values[i] = alpha2 * half[i] * half[i] / (2.0 * PI * floored * (spread * spread * masking));
    }
    values
}

/// Adds `values` times weight and Fresnel factor at the microfacets.
#[inline(always)]
fn add_reflected<const N: usize>(
    out: &mut [[f32; N]; 3],
    fresnel: Fresnel,
    weight: [f32; 3],
    values: &[f32; N],
    half: &[f32; N],
) {
    match fresnel {
        Fresnel::Full => {
            for (out, weight) in out.iter_mut().zip(weight) {
                for i in 0..N {
                    out[i] += weight * values[i];
                }
            }
        }
        Fresnel::Dielectric { f0, eta } => {
            let rises = dielectric_rises(eta, half);
            for (c, out) in out.iter_mut().enumerate() {
                for i in 0..N {
                    out[i] += weight[c] * values[i] * (f0.0[c] + (1.0 - f0.0[c]) * rises[i]);
                }
            }
        }
        Fresnel::Metal { f0, dip } => {
            for i in 0..N {
                let cos = 0.5 * half[i].sqrt();
                let less = at_least(1.0 - cos, 0.0);
                let rise = less * less * less * less * less;
                let dent = cos * rise * less;
                for c in 0..3 {
                    let share = f0.0[c] + (1.0 - f0.0[c]) * rise - dip.0[c] * dent;
                    out[c][i] += weight[c] * values[i] * at_least(at_most(share, 1.0), 0.0);
                }
            }
        }
    }
}

/// [`fresnel::dielectric_rise`], both polarizations over one denominator.
#[inline(always)]
fn dielectric_rises<const N: usize>(eta: f32, half: &[f32; N]) -> [f32; N] {
    let f0 = fresnel::f0_from_ior(eta);
    let (scale, per_eta2) = (1.0 / (1.0 - f0), 1.0 / (eta * eta));
    let mut rises = [0.0; N];
    for i in 0..N {
        let cos2 = at_most(0.25 * half[i], 1.0);
        let cos = cos2.sqrt();
        // 0 at total reflection, where both fractions are 1.
        let refracted = at_least(1.0 - (1.0 - cos2) * per_eta2, 0.0).sqrt();
        let (a, b) = (eta * refracted, eta * cos);
        let perpendicular = (cos - a) * (refracted + b);
        let parallel = (refracted - b) * (cos + a);
        let both = (cos + a) * (refracted + b);
        let reflected = 0.5 * (perpendicular * perpendicular + parallel * parallel) / (both * both);
        rises[i] = at_least(at_most((reflected - f0) * scale, 1.0), 0.0);
    }
    rises
}

/// The larger; one instruction where `f32::max` asks for NaN too.
#[inline(always)]
fn at_least(value: f32, least: f32) -> f32 {
    if value > least { value } else { least }
}

/// The smaller.
#[inline(always)]
fn at_most(value: f32, most: f32) -> f32 {
    if value < most { value } else { most }
}

//! Where photons go on from a hit: the adjoint of what paths from the camera see.
//!
//! `wo` is where a photon came from and `wi` where it goes. Its flux is spread over the surface as it is, so that its cosines are
//! with the geometric normal: f*(wo, wi) = f(wi, wo) |wo·ns| / |wo·ng|, and weight = f* · |wi·ng| / pdf (Veach 1997, section
//! 5.3.2), with the shading normal as a viewer at `wi` has it.
//!
//! What is as bright from everywhere is so for viewers below the shading normal too, as long as they see the surface. Photons of
//! Lambert's lobes leave about the geometric normal, therefore; about the shading normal, as much of them would be missing as
//! lies between the two planes: half of 1 - ns·ng at every bounce.

use std::f32::consts::FRAC_1_PI;

use glam::Vec3;

use super::lobe::{Lobe, Shape};
use super::{Bsdf, BsdfSample, LobeSet, ShadingFrame, sample_of, sample_on_side};
use crate::color::Rgb;

impl Bsdf<'_> {
    /// [`Bsdf::sample`] for photons.
    pub(super) fn sample_photon(&self, u_lobe: f32, u: [f32; 2], set: LobeSet) -> Option<BsdfSample> {
        let total = self.chances(set);
        let (lobe, chance) = self.choose(u_lobe * total, set)?;
        let frame = self.photon_frame(lobe);
        let wi = sample_on_side(lobe, &frame, self.wo, u)?;
        if lobe.class == LobeSet::DELTA {
            let chance = chance / total;
            return sample_of(lobe, wi, self.delta_adjoint(lobe, &frame, wi) / chance, chance);
        }
        if self.material.is_plain() {
            let pdf = wi.dot(self.frame.ng).abs() * FRAC_1_PI;
            return sample_of(lobe, wi, lobe.albedo * self.frame.irradiance_factor(self.wo), pdf);
        }
        let pdf = self.photon_pdf(wi, set) / total;
        let value = self.eval_adjoint(wi, set);
        sample_of(lobe, wi, value * (wi.dot(self.frame.ng).abs() / pdf), pdf)
    }

    /// f*(wo, wi), see the module; delta lobes give nothing.
    pub(super) fn eval_adjoint(&self, wi: Vec3, set: LobeSet) -> Rgb {
        let seen_back = self.adjoint(wi);
        seen_back.eval_with_pdf(self.wo, set).0 * seen_back.frame.irradiance_factor(self.wo)
    }

    /// What photons of `lobe` are scattered about.
    fn photon_frame(&self, lobe: &Lobe) -> ShadingFrame {
        match lobe.shape {
            Shape::Lambert | Shape::OrenNayar(_) | Shape::Translucent => {
                ShadingFrame { ns: self.frame.ng, ..self.frame }
            }
            _ if lobe.normal != 0 => self.own_frame(lobe),
            _ => self.frame,
        }
    }

    /// Density per solid angle of [`Bsdf::sample_photon`] at `wi`, times the albedo of the lobes of `set`.
    fn photon_pdf(&self, wi: Vec3, set: LobeSet) -> f32 {
        let mut pdf = 0.0;
        for lobe in self.lobes(set).filter(|lobe| lobe.class != LobeSet::DELTA) {
            let frame = self.photon_frame(lobe);
            let is_on_side = |normal: Vec3| (wi.dot(normal) < 0.0) == lobe.is_transmission();
            if is_on_side(frame.ns) && is_on_side(frame.ng) {
                pdf += lobe.albedo.mean() * lobe.eval(&frame, self.wo, wi).1;
            }
        }
        pdf
    }

    /// Weight of a delta lobe about the normal of `frame`, its chance aside.
    fn delta_adjoint(&self, lobe: &Lobe, frame: &ShadingFrame, wi: Vec3) -> Rgb {
        let adjoint = self.adjoint(wi);
        let back = adjoint.lobes.iter().find(|other| other.slot == lobe.slot);
        let value = back.map_or(Rgb::BLACK, |back| match back.normal {
            0 => back.delta_factor(&adjoint.frame, wi),
            _ => back.delta_factor(&adjoint.own_frame(back), wi),
        });
        let leaning = frame.irradiance_factor(self.wo) / frame.irradiance_factor(wi).max(1e-3);
        value * (leaning / (lobe.eta() * lobe.eta()))
    }

    /// The same hit seen from `wi`.
    fn adjoint(&self, wi: Vec3) -> Self {
        let [ng, ns] = self.frame.unturned();
        self.material.clone().bsdf(wi, ng, ns)
    }
}

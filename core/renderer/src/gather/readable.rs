//! Hits that need nothing but one look-up: the common end of a gather ray.

use std::f32::consts::FRAC_1_PI;

use glam::Vec3;

use crate::accel::{Hit, Ray};
use crate::color::Rgb;
use crate::estimator::{Estimator, Footprint};
use crate::math::Side;

use super::Gatherer;

/// A hit on a Lambert surface whose light can be read.
pub(super) struct Readable<P> {
    pub(super) place: P,
    /// Turns what is read into radiance.
    pub(super) reflectance: Rgb,
}

impl<E: Estimator> Gatherer<'_, E> {
    /// What to read for a hit on a constant Lambert surface; `None` where there is more to it than a look-up, or it moves. `solid_angle`
    /// is what the ray stands for.
    #[inline(always)]
    pub(super) fn readable(&self, ray: &Ray, hit: &Hit, solid_angle: f32) -> Option<Readable<E::Place>> {
        if self.lit.accel.is_lamp(hit.object) || self.lit.moves(hit.object) {
            return None;
        }
        let (ng, material) = self.lit.accel.triangle(hit.object, hit.primitive);
        let albedo_over_pi = self.plain_read[material]?;
        let place = self.place(ray, hit, ng, solid_angle)?;
        let reflectance = if E::READS_RADIANCE { Rgb::WHITE } else { albedo_over_pi };
        Some(Readable { place, reflectance })
    }

    /// The same for a Lambert surface whose albedo varies.
    #[inline(never)]
    pub(super) fn readable_varying(
        &self,
        ray: &Ray,
        hit: &Hit,
        solid_angle: f32,
    ) -> Option<Readable<E::Place>> {
        if self.lit.accel.is_lamp(hit.object) || self.lit.moves(hit.object) {
            return None;
        }
        let (ng, material) = self.lit.accel.triangle(hit.object, hit.primitive);
        if !self.varying_lambert_read[material] {
            return None;
        }
        let place = self.place(ray, hit, ng, solid_angle)?;
        let width = solid_angle.sqrt() * hit.t;
        let reflectance = if E::READS_RADIANCE {
            Rgb::WHITE
        } else {
            self.lit.varying_albedo(material, ray, hit, width)? * FRAC_1_PI
        };
        Some(Readable { place, reflectance })
    }

    #[inline(always)]
    fn place(&self, ray: &Ray, hit: &Hit, ng: Vec3, solid_angle: f32) -> Option<E::Place> {
        let side = Side::met(ng, ray.direction);
        let footprint = Footprint { solid_angle, travelled: hit.t, sharp: false };
        self.estimator.place(ray.origin + ray.direction * hit.t, side, -ray.direction, footprint)
    }
}

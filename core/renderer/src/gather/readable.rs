//! Hits that need nothing but one look-up: the common end of a gather ray.

use std::f32::consts::FRAC_1_PI;

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
    /// What to read for a hit; `None` where there is more to it than a look-up. `solid_angle` is what the ray stands for.
    #[inline(always)]
    pub(super) fn readable(&self, ray: &Ray, hit: &Hit, solid_angle: f32) -> Option<Readable<E::Place>> {
        if self.lit.accel.is_lamp(hit.object) {
            return None;
        }
        let (ng, material) = self.lit.accel.triangle(hit.object, hit.primitive);
        let plain = self.plain_read[material];
        if plain.is_none() && !self.varying_lambert_read[material] {
            return None;
        }
        let side = Side::met(ng, ray.direction);
        let footprint = Footprint { solid_angle, travelled: hit.t, sharp: false };
        let place =
            self.estimator.place(ray.origin + ray.direction * hit.t, side, -ray.direction, footprint)?;
        let reflectance = match plain {
            _ if E::READS_RADIANCE => Rgb::WHITE,
            Some(albedo_over_pi) => albedo_over_pi,
            None => {
                let width = footprint.area().sqrt();
                self.lit.varying_albedo(material, ray, hit, width)? * FRAC_1_PI
            }
        };
        Some(Readable { place, reflectance })
    }
}

//! Caustics that the eye sees: read from the map where it has them, met by gather rays where it has not.

use std::f32::consts::FRAC_1_PI;

use glam::Vec3;

use crate::accel::LANES;
use crate::bsdf::{Bsdf, LobeSet};
use crate::color::Rgb;
use crate::effects_plan::Effect;
use crate::estimator::Estimator;

use super::block::Block;
use super::vertex::{GatherRay, Vertex};

impl<E: Estimator> Block<'_, '_, E> {
    /// Adds what the caustic map holds for the camera samples.
    #[inline(never)]
    pub(super) fn read_caustics(&mut self) {
        let Some(map) = self.gatherer.caustics else { return };
        let owner = self.traces.meter.enter(Effect::Caustics);
        // Indirect light is a sum over gather rays.
        let per_sample = 1.0 / self.gatherer.direct_share;
        for lane in 0..LANES {
            let radiance = if self.lambert.set[lane] {
                let irradiance = map.irradiance(self.lambert.p[lane], self.lambert.ng[lane]);
                self.lambert.weight[lane] * irradiance * FRAC_1_PI
            } else if let Some(Vertex { surface, throughput }) = self.vertices[lane].as_deref() {
                *throughput * map.radiance(surface.p, &surface.bsdf)
            } else {
                continue;
            };
            self.samples[lane].indirect += radiance * per_sample;
        }
        self.traces.meter.back(owner);
    }

    /// What caustics of lights in the map count that a gather ray brings through mirrors and glass: the map holds those on
    /// diffuse and wide glossy lobes, not those that a sharp one reflects.
    pub(super) fn share_of_mapped(&self, lane: usize, ray: &GatherRay) -> Rgb {
        if !self.gatherer.lit.lights.has_mapped() || ray.pdf.is_none() {
            return Rgb::WHITE;
        }
        let Some(vertex) = &self.vertices[lane] else { return Rgb::BLACK };
        Rgb::WHITE - read_share(&vertex.surface.bsdf, self.packet.ray(lane).direction, LobeSet::ALL)
    }
}

/// What lights in the map count after a surface that reflects with the lobes of `set`, if they counted `mapped` before:
/// light on lobes that could be read is no caustic that the eye sees, and counts as it is.
pub(super) fn with_read(mapped: Rgb, bsdf: &Bsdf<'_>, wi: Vec3, set: LobeSet) -> Rgb {
    let read = read_share(bsdf, wi, set);
    read + (Rgb::WHITE - read) * mapped
}

/// Of the light along `wi` that the lobes of `set` reflect, the share of those whose light is read.
fn read_share(bsdf: &Bsdf<'_>, wi: Vec3, set: LobeSet) -> Rgb {
    if !bsdf.has(set.and(LobeSet::SHARP)) {
        return Rgb::WHITE;
    }
    let (read, _) = bsdf.eval_with_pdf(wi, set.and(LobeSet::READ));
    let (all, _) = bsdf.eval_with_pdf(wi, set);
    Rgb([0, 1, 2].map(|c| if all.0[c] > 0.0 { (read.0[c] / all.0[c]).min(1.0) } else { 0.0 }))
}

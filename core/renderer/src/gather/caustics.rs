//! Caustics that the eye sees: read from the map where it has them, met by gather rays where it has not.

use std::f32::consts::FRAC_1_PI;

use glam::Vec3;

use crate::accel::LANES;
use crate::bsdf::{Bsdf, BsdfSample, LobeSet};
use crate::color::Rgb;
use crate::effects_plan::{Effect, Meter};
use crate::estimator::Estimator;
use crate::lit_scene::Surface;

use super::Gatherer;
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
                *throughput * self.gatherer.caustics_at(surface, &mut self.traces.meter)
            } else {
                continue;
            };
            self.samples[lane].indirect += radiance * per_sample;
        }
        self.traces.meter.back(owner);
    }

    /// What mapped lights count that a gather ray brings through mirrors and glass: the map holds their caustics on diffuse
    /// and wide glossy lobes, not those that a sharp one reflects.
    pub(super) fn share_of_mapped(&self, lane: usize, ray: &GatherRay) -> Mapped {
        let share = match self.vertices[lane].as_deref() {
            _ if !self.gatherer.lit.lights.has_mapped() || ray.pdf.is_none() => Rgb::WHITE,
            Some(Vertex { surface, .. }) => {
                Rgb::WHITE - read_share(&surface.bsdf, self.packet.ray(lane).direction, LobeSet::ALL)
            }
            None => Rgb::BLACK,
        };
        Mapped { share, is_sharp: ray.sharp }
    }
}

impl<E: Estimator> Gatherer<'_, E> {
    /// What the caustic map holds for a surface, towards where the ray came from.
    #[inline(never)]
    pub(super) fn caustics_at(&self, surface: &Surface<'_>, meter: &mut Meter) -> Rgb {
        let map = self.caustics.filter(|_| surface.bsdf.has(LobeSet::READ));
        map.map_or(Rgb::BLACK, |map| {
            let owner = meter.enter(Effect::Caustics);
            let at_rest = self.lit.moves(surface.hit.object).then(|| self.lit.at_rest(surface).0);
            let surface = at_rest.as_ref().unwrap_or(surface);
            let radiance = map.radiance(surface.p, &surface.bsdf);
            meter.back(owner);
            radiance
        })
    }
}

/// What mapped lights count along a ray that is followed.
#[derive(Clone, Copy, Debug)]
pub(super) struct Mapped {
    /// Of those that the mirror or glass where it is now shows.
    pub(super) share: Rgb,
    /// It came from the eye's vertex by way of nothing but mirrors, glass and sharp gloss: where it is not read it is at a
    /// vertex of the eye's, and the map is.
    pub(super) is_sharp: bool,
}

impl Mapped {
    /// Goes on from a surface that reflects with `lobes`; gives what lights count that are met without anything between.
    pub(super) fn follow(&mut self, bsdf: &Bsdf<'_>, sample: &BsdfSample, lobes: LobeSet) -> Rgb {
        let mut on_the_way = self.share;
        if lobes.intersects(LobeSet::READ) && !sample.is_delta {
            let read = read_share(bsdf, sample.wi, lobes);
            let followed = (Rgb::WHITE - read) * self.share;
            on_the_way = read + followed;
            self.share = if self.is_sharp { followed } else { on_the_way };
        }
        self.is_sharp &= LobeSet::FOLLOWED.intersects(sample.class);
        on_the_way
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

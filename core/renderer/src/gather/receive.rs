//! What the gather rays of a packet bring: read together where they can be, followed one by one where not.

use crate::accel::{Hit, LANES, Ray};
use crate::color::Rgb;
use crate::effects_plan::Effect;
use crate::estimator::{Estimator, Footprint};
use crate::lit_scene::Medium;
use crate::sampling::{Rng, hash};
use crate::scene::visibility;

use super::Width;
use super::block::Block;
use super::deferred::{Deferred, Target};
use super::path::Sampled;
use super::vertex::GatherRay;

impl<E: Estimator> Block<'_, '_, E> {
    /// Adds what the gather rays of a packet bring: those that end on constant Lambert surfaces are read together, the
    /// others followed one by one.
    #[inline(always)]
    pub(super) fn receive(&mut self, pdfs: &[f32; LANES], index: u32) {
        let g = self.gatherer;
        let mut places = [E::Place::default(); LANES];
        let mut weight = [Rgb::BLACK; LANES];
        let mut read = [false; LANES];
        let mut solid_angles = [0.0; LANES];
        for lane in 0..LANES {
            solid_angles[lane] = g.solid_angle(pdfs[lane]);
        }
        for lane in 0..LANES {
            if !self.packet.is_set(lane) {
                continue;
            }
            let (ray, solid_angle) = match self.others[lane] {
                Some(ray) => (ray, ray.pdf.map_or(0.0, |pdf| g.solid_angle(pdf))),
                None => (GatherRay::diffuse(self.lambert.weight[lane], Some(pdfs[lane])), solid_angles[lane]),
            };
            let hit = match self.packet.hit(lane) {
                Some(hit) if g.lit.accel.is_lamp(hit.object) => self.cross_lamps(lane, &ray, solid_angle),
                hit => hit,
            };
            let can_be_read = !ray.sharp && self.medium(lane).is_clear();
            // No closure: it would not be compiled for the wider instructions.
            let readable = match hit {
                Some(hit) if can_be_read => g.readable(&self.packet.ray(lane), &hit, solid_angle),
                _ => None,
            };
            match readable {
                Some(readable) => {
                    places[lane] = readable.place;
                    weight[lane] = ray.weight * readable.reflectance;
                    read[lane] = true;
                }
                None => {
                    let varying = hit
                        .filter(|_| g.has_varying && can_be_read)
                        .and_then(|hit| g.readable_varying(&self.packet.ray(lane), &hit, solid_angle));
                    if let Some(readable) = varying {
                        places[lane] = readable.place;
                        weight[lane] = ray.weight * readable.reflectance;
                        read[lane] = true;
                    } else {
                        self.receive_other(lane, &ray, hit, solid_angle, index);
                    }
                }
            }
        }
        if E::DEFERS {
            for lane in (0..LANES).filter(|&lane| read[lane]) {
                let (place, weight) = (places[lane], weight[lane]);
                self.traces.deferred.push(Deferred { place, weight, pixel: lane });
            }
            return;
        }
        let asked = read;
        let found = g.estimator.read_all(&places, &mut read);
        for lane in 0..LANES {
            self.samples[lane].indirect += weight[lane] * found[lane];
        }
        if read != asked {
            let untold = std::array::from_fn(|lane| asked[lane] && !read[lane]);
            self.receive_untold(&untold, pdfs, index);
        }
    }

    /// Follows the rays to what was asked for and could not be told.
    #[inline(never)]
    fn receive_untold(&mut self, untold: &[bool; LANES], pdfs: &[f32; LANES], index: u32) {
        let g = self.gatherer;
        for lane in (0..LANES).filter(|&lane| untold[lane]) {
            let gather_ray = self.gather_ray(lane, pdfs[lane]);
            let solid_angle = gather_ray.pdf.map_or(0.0, |pdf| g.solid_angle(pdf));
            let hit = match self.packet.hit(lane) {
                // The light of the lamps has been added.
                Some(hit) if g.lit.accel.is_lamp(hit.object) => {
                    let ray = self.packet.ray(lane);
                    g.lit.accel.intersect(&Ray { mask: ray.mask & !visibility::LAMP, ..ray })
                }
                hit => hit,
            };
            self.receive_other(lane, &gather_ray, hit, solid_angle, index);
        }
    }

    /// The gather ray of a lane, of which a diffuse one has the density `pdf`.
    #[inline(always)]
    fn gather_ray(&self, lane: usize, pdf: f32) -> GatherRay {
        self.others[lane].unwrap_or_else(|| GatherRay::diffuse(self.lambert.weight[lane], Some(pdf)))
    }

    /// Adds the light of the lamps that the ray of a lane met first; gives what is behind them.
    #[inline(never)]
    fn cross_lamps(&mut self, lane: usize, gather_ray: &GatherRay, solid_angle: f32) -> Option<Hit> {
        let ray = self.packet.ray(lane);
        let sampled = self.sampled(lane, gather_ray, solid_angle);
        let from = sampled.receiver(ray.origin);
        let (behind, light) = self.gatherer.cross_lamps(from, &ray, 0.0, sampled, &mut self.traces.meter);
        self.add_met(lane, gather_ray, light);
        behind
    }

    /// As `receive`, for a ray that meets light or anything but a constant Lambert surface, or is too short to be read.
    #[inline(never)]
    fn receive_other(
        &mut self,
        lane: usize,
        gather_ray: &GatherRay,
        hit: Option<Hit>,
        solid_angle: f32,
        index: u32,
    ) {
        let g = self.gatherer;
        let mut rng = Rng::new(hash(self.keys[lane], u64::from(index) << 16 | 2));
        let sampled = self.sampled(lane, gather_ray, solid_angle);
        let (ray, mut end) = (self.packet.ray(lane), None);
        let met = g.meet(ray, Some(hit), sampled, &mut rng, &mut self.traces.meter, &mut end);
        self.add_met(lane, gather_ray, met.light);
        if end.is_some() && g.lit.plan.follows() {
            let footprint = Footprint { solid_angle, travelled: met.distance, sharp: gather_ray.sharp };
            let weight = gather_ray.weight * met.through;
            let mapped = self.share_of_mapped(lane, gather_ray);
            let target = Target { traces: &mut self.traces, lane, weight };
            let radiance = g.outgoing(&mut end, footprint, mapped, &mut rng, target);
            self.samples[lane].indirect += weight * radiance;
        }
    }

    /// How the gather ray of a lane was found.
    fn sampled(&self, lane: usize, gather_ray: &GatherRay, solid_angle: f32) -> Sampled {
        let (lit_side, sets) = match &self.vertices[lane] {
            Some(vertex) => (vertex.surface.bsdf.lit_side(), vertex.surface.sets),
            None => (Some(self.lambert.ns[lane]), self.lambert.sets[lane]),
        };
        Sampled {
            pdf: gather_ray.pdf,
            shares: self.gatherer.shares,
            kind: gather_ray.kind,
            light: self.gatherer.lit.plan.direct.then_some(Effect::DirectLight),
            lit_side,
            sets,
            width: Width::of_solid_angle(solid_angle),
            mapped: Rgb::WHITE,
            moved: 0.0,
            medium: self.medium(lane),
        }
    }

    /// What the gather ray of a lane starts in.
    #[inline(always)]
    pub(super) fn medium(&self, lane: usize) -> Medium {
        if self.gatherer.lit.plan.absorption { self.medium_of_vertex(lane) } else { Medium::CLEAR }
    }

    #[inline(never)]
    fn medium_of_vertex(&self, lane: usize) -> Medium {
        let direction = self.packet.ray(lane).direction;
        self.vertices[lane].as_ref().map_or(Medium::CLEAR, |vertex| vertex.surface.medium_towards(direction))
    }

    /// Adds the light that a gather ray met. What a mirror shows is no direct light, though it belongs to the same layer of
    /// the picture.
    fn add_met(&mut self, lane: usize, gather_ray: &GatherRay, light: Rgb) {
        let g = self.gatherer;
        if g.lit.plan.direct || gather_ray.pdf.is_none() {
            self.samples[lane].direct += gather_ray.weight * light * g.direct_share;
        }
    }
}

//! The photon pass: light from the lamps, followed from surface to surface and deposited at every landing.
//!
//! N photons start with the flux Φᵢ / N, chosen by power. Wherever a photon lands on a diffuse or glossy surface its flux
//! (before the surface's albedo) is deposited: Σ flux / area estimates the irradiance, direct and indirect, caustics
//! included (Jensen 1996). Photons for caustics are a pass of their own: they leave towards mirrors and glass, go from one to
//! the next, and are kept where they then land on anything else. Roulette is unbiased; depth is cut only as a safeguard.

mod deposit;
mod pilot;

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};

use glam::Vec3;
use rayon::prelude::*;

use crate::accel::{Hit, Ray};
use crate::bsdf::{LobeSet, TransportMode};
use crate::color::Rgb;
use crate::effects_plan::{Costs, Effect, Meter};
use crate::error::RenderError;
use crate::estimator::{Landing, PhotonSink};
use crate::lit_scene::{LitScene, Medium, lobes_lit, ray_kind};
use crate::progress::Progress;
use crate::pyramid::SETS;
use crate::sampling::PhotonSampler;
use crate::scene::{MIDDLE, visibility};

pub use deposit::PyramidDeposits;
pub use pilot::PhotonPilot;

/// Photons of one task: long enough to hide scheduling, short enough to cancel at once.
const BATCH: u64 = 4096;

/// Photons of a task that are clocked, to tell what each effect costs.
const CLOCKED: u64 = 64;

/// Highest chance of surviving a landing: an albedo of one would never end.
const MAX_SURVIVAL: f32 = 0.98;

/// Surfaces the light of a lamp without shadow is followed through.
const MAX_PASSED_THROUGH: u32 = 64;

/// What the pass counted.
#[derive(Clone, Copy, Debug, Default)]
pub struct PhotonPassCounts {
    /// Photons started.
    pub emitted: u64,
    /// Segments traced.
    pub segments: u64,
    /// What each effect cost.
    pub costs: Costs,
}

/// Which light photons carry.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Carry {
    /// All, to every surface.
    All,
    /// That of lights whose caustics are made of photons, through mirrors and glass to the first surface that is neither.
    Caustics,
}

/// What the pass is to do.
#[derive(Clone, Copy, Debug)]
pub struct PhotonPass {
    /// Which light.
    pub carry: Carry,
    /// Photons.
    pub count: u64,
    /// Surfaces a photon may visit.
    pub max_depth: u32,
    /// Another seed gives other photons.
    pub seed: u32,
    /// Sets the photons are dealt into.
    pub sets: usize,
}

/// Traces the photons of a pass, dealt in order into its sets.
///
/// # Errors
/// [`RenderError::Cancelled`].
pub fn run<S: PhotonSink>(
    lit: &LitScene<'_>,
    pass: PhotonPass,
    sink: &S,
    progress: &Progress,
) -> Result<PhotonPassCounts, RenderError> {
    let PhotonPass { carry, count, max_depth, seed, sets } = pass;
    let (called_for, owner) = match carry {
        Carry::All => (lit.plan.indirect() && !lit.lights.is_empty(), lit.plan.indirect_owner()),
        Carry::Caustics => (lit.plan.caustics && lit.lights.has_mapped(), Effect::Caustics),
    };
    if !called_for || count == 0 {
        return Ok(PhotonPassCounts::default());
    }
    let (segments, done) = (AtomicU64::new(0), AtomicU64::new(0));
    let costs = Mutex::new(Costs::default());
    let set_of = |id: u64| (id * sets as u64 / count) as usize;
    #[expect(clippy::cast_precision_loss, reason = "a share of at most 10^9 photons")]
    let tracers: [Tracer<'_, S>; SETS] = std::array::from_fn(|set| {
        let first = |set: usize| (set as u64 * count).div_ceil(sets as u64);
        let share = (1.0 / (first(set + 1) - first(set)).max(1) as f64) as f32;
        Tracer { lit, sink, carry, set, share, max_depth }
    });
    (0..count.div_ceil(BATCH)).into_par_iter().try_for_each(|batch| {
        progress.check()?;
        let ids = batch * BATCH..((batch + 1) * BATCH).min(count);
        let clocked_end = (ids.start + CLOCKED).min(ids.end);
        let mut landed = S::Batch::default();
        let mut meter = Meter::default();
        let mut traced = 0;
        for (ids, clocked) in [(ids.start..clocked_end, true), (clocked_end..ids.end, false)] {
            meter.begin(clocked);
            meter.enter(owner);
            for id in ids {
                let sampler = PhotonSampler::new(id, seed);
                traced += tracers[set_of(id)].photon(sampler, &mut landed, &mut meter);
            }
            meter.end();
        }
        *costs.lock().unwrap_or_else(PoisonError::into_inner) += meter.costs;
        sink.finish(batch, landed);
        segments.fetch_add(traced, Ordering::Relaxed);
        let done = done.fetch_add(ids.end - ids.start, Ordering::Relaxed);
        #[expect(clippy::cast_precision_loss, reason = "a fraction for a status line")]
        progress.set_fraction(done as f64 / count as f64);
        Ok::<(), RenderError>(())
    })?;
    let costs = costs.into_inner().unwrap_or_else(PoisonError::into_inner);
    Ok(PhotonPassCounts { emitted: count, segments: segments.into_inner(), costs })
}

struct Tracer<'a, S> {
    lit: &'a LitScene<'a>,
    sink: &'a S,
    carry: Carry,
    /// Set of its photons, and one photon's share of the light.
    set: usize,
    share: f32,
    max_depth: u32,
}

impl<S: PhotonSink> Tracer<'_, S> {
    /// Follows one photon from its lamp; gives the number of segments traced.
    fn photon(&self, mut sampler: PhotonSampler, landed: &mut S::Batch, meter: &mut Meter) -> u64 {
        let (lit, shutter) = (self.lit, &self.lit.accel.scene().camera.shutter);
        let time = if lit.plan.motion_blur { shutter.time(sampler.time()) } else { MIDDLE };
        let emission = match self.carry {
            Carry::All => lit.emit(std::array::from_fn(|_| sampler.draw()), time),
            Carry::Caustics => lit.emit_to_casters(std::array::from_fn(|_| sampler.draw()), time),
        };
        let Some(emission) = emission else { return 0 };
        let mut flux = emission.flux * self.share;
        let leaving = match emission.normal {
            Some(normal) => {
                Ray::leaving(emission.origin, normal, emission.direction, visibility::DIFFUSE, time).origin
            }
            None => emission.origin,
        };
        // On its first way a photon is a shadow ray the other way round.
        let mask = visibility::DIFFUSE | visibility::SHADOW;
        let (mut ray, mut travelled) = self.lit.entering(leaving.as_dvec3(), emission.direction, mask, time);
        let lobes = lobes_lit(emission.visibility);
        let mut medium = lit.medium_at(leaving, time, meter);
        let mut segments = 0;
        for _ in 0..MAX_PASSED_THROUGH {
            segments += 1;
            meter.count_own(1);
            let Some(hit) = self.lit.accel.intersect(&ray) else { break };
            travelled += hit.t;
            flux *= medium.transmittance(hit.t);
            let visible_to = self.lit.accel.scene().objects[hit.object as usize].visibility;
            let is_blocked = visible_to & emission.blockers != 0;
            if travelled >= emission.lit_from && visible_to & visibility::DIFFUSE != 0 {
                let (sets, shaded) = (emission.receivers, emission.shaded);
                let arrival = Arrival { ray, hit, medium, flux, lobes, sets, shaded, is_blocked };
                segments += self.scatter(arrival, &mut sampler, landed, meter);
            }
            if is_blocked {
                break;
            }
            let ng = self.lit.normal_met(&ray, &hit);
            medium = self.lit.medium_behind(medium, &ray, &hit, ng);
            ray = Ray::leaving(ray.origin + ray.direction * hit.t, ng, ray.direction, mask, time);
        }
        segments
    }

    /// Deposits at a hit and follows what leaves it, until roulette ends it.
    fn scatter(
        &self,
        arrival: Arrival,
        sampler: &mut PhotonSampler,
        landed: &mut S::Batch,
        meter: &mut Meter,
    ) -> u64 {
        let (mut segments, mut thrown) = (0, self.carry == Carry::All);
        let Arrival { mut ray, mut hit, mut medium, mut flux, .. } = arrival;
        let Arrival { lobes: mut lit, mut sets, mut shaded, .. } = arrival;
        let mut passes = arrival.is_blocked;
        for _ in 0..self.max_depth {
            let mut surface = self.lit.surface(&ray, hit, 0.0);
            surface.medium = medium;
            let bsdf = &surface.bsdf;
            let lobes = if sets & surface.sets == 0 { LobeSet::EMPTY } else { lit };
            let arrived = self.lit.lights.arrived(flux, shaded, ray.direction, surface.p);
            let is_dark = shaded.is_some() && arrived.is_black();
            if thrown && !is_dark && bsdf.has(lobes.and(LobeSet::READ)) {
                let glossy = self.carry == Carry::All && bsdf.has(lobes.and(LobeSet::ROUGH));
                let at = if glossy { [sampler.draw(), sampler.draw()] } else { [0.0; 2] };
                let glossy = glossy && self.lit.plan.direction_bins();
                let at_rest = self.lit.moves(hit.object).then(|| self.lit.at_rest(&surface));
                let (stored, grown) =
                    at_rest.as_ref().map_or((&surface, 1.0), |(at_rest, grown)| (at_rest, *grown));
                let flux = arrived * (bsdf.frame.irradiance_factor(-ray.direction) * grown);
                let landing = Landing { surface: stored, set: self.set, flux, glossy, at };
                let owner = meter.enter_if(glossy.then_some(Effect::IndirectGlossy));
                self.sink.land(landed, &landing);
                meter.back(owner);
            }
            let u_lobe = sampler.draw();
            let u = [sampler.draw(), sampler.draw()];
            let followed = if self.carry == Carry::All { lobes } else { lobes.and(LobeSet::FOLLOWED) };
            let through = if passes { bsdf.transparency } else { Rgb::BLACK };
            let Some(next) =
                self.next_direction(bsdf, through, ray.direction, followed, [u_lobe, u[0], u[1]])
            else {
                break;
            };
            // Flux over index squared is what refraction conserves.
            let survival = (next.weight.max_channel() * next.eta_squared).min(MAX_SURVIVAL);
            if sampler.draw() >= survival {
                break;
            }
            if !next.straight {
                (flux, shaded) = (arrived, None);
            }
            if is_dark && shaded.is_none() {
                break;
            }
            flux = flux * next.weight * (1.0 / survival);
            medium = surface.medium_towards(next.direction);
            ray = surface.leaving(next.direction, next.kind);
            if !next.straight {
                (lit, sets, thrown) = (LobeSet::ALL, u32::MAX, true);
            }
            passes = true;
            segments += 1;
            let owner = meter.enter_if(next.effect.filter(|_| self.carry == Carry::All));
            meter.count_own(1);
            let next_hit = self.lit.accel.intersect(&ray);
            meter.back(owner);
            let Some(next_hit) = next_hit else { break };
            if !medium.is_clear() {
                let owner = meter.enter(Effect::Absorption);
                flux *= medium.transmittance(next_hit.t);
                meter.back(owner);
            }
            hit = next_hit;
        }
        segments
    }

    fn next_direction(
        &self,
        bsdf: &crate::bsdf::Bsdf<'_>,
        transparency: Rgb,
        direction: Vec3,
        lobes: LobeSet,
        [u_lobe, u0, u1]: [f32; 3],
    ) -> Option<Next> {
        let (through, scattered) = (transparency.mean(), bsdf.albedo(lobes).mean());
        let chance = if through > 0.0 { through / (through + scattered) } else { 0.0 };
        if u_lobe < chance {
            let weight = transparency * (1.0 / chance);
            return Some(Next {
                direction,
                weight,
                kind: visibility::DIFFUSE,
                straight: true,
                effect: Some(Effect::AlphaTransparency),
                eta_squared: 1.0,
            });
        }
        let u_lobe = ((u_lobe - chance) / (1.0 - chance)).min(1.0 - f32::EPSILON);
        let sample = bsdf.sample(u_lobe, [u0, u1], lobes, TransportMode::Importance)?;
        let weight = sample.weight * (1.0 / (1.0 - chance));
        Some(Next {
            direction: sample.wi,
            weight,
            kind: ray_kind(&sample),
            straight: false,
            effect: LobeSet::FOLLOWED.intersects(sample.class).then_some(Effect::MirrorsAndGlass),
            eta_squared: sample.eta_squared,
        })
    }
}

/// A photon on its way from the light to a hit.
struct Arrival {
    ray: Ray,
    hit: Hit,
    /// What it came through.
    medium: Medium,
    flux: Rgb,
    /// Lobes that it lights, and the sets of objects that it lights.
    lobes: LobeSet,
    sets: u32,
    /// See [`crate::light::Emission`]; the flux is that before the lamp's nodes.
    shaded: Option<usize>,
    /// False: it goes on behind the surface as if that were not there.
    is_blocked: bool,
}

struct Next {
    direction: Vec3,
    weight: Rgb,
    kind: u32,
    straight: bool,
    /// What the way on is for, where it is not for indirect light in general.
    effect: Option<Effect>,
    /// See [`crate::bsdf::BsdfSample`].
    eta_squared: f32,
}

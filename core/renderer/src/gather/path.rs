//! Rays that are followed one by one: through transparent surfaces, off mirrors and glass, and on from gather hits that
//! cannot be read, such as those too near for the pyramid's cells.
//!
//! Path classes are a partition: at every vertex each lobe is either read or followed, never both.

use glam::Vec3;

use crate::accel::{Hit, Ray};
use crate::bsdf::{LobeSet, TransportMode};
use crate::color::Rgb;
use crate::effects_plan::{Effect, Meter};
use crate::estimator::{Estimator, Footprint};
use crate::light::{Receiver, Sight};
use crate::lit_scene::{Medium, Surface, lobes_lit, ray_kind};
use crate::sampling::Rng;
use crate::scene::visibility;

use super::caustics::{Mapped, with_read};
use super::deferred::{Target, Traces};
use super::direct::{Shares, shadow_ray, transmittance};
use super::{Gatherer, Width};

/// Transparent surfaces a ray passes before it ends.
const MAX_TRANSPARENT: u32 = 64;

/// Throughput below this is left to roulette.
const ROULETTE_BELOW: f32 = 0.5;

/// How a direction was found, for the weight of the light it meets.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sampled {
    /// Density per solid angle; `None` for mirrors, glass and the camera, which no light sample competes with.
    pub(super) pdf: Option<f32>,
    /// Samples of either technique.
    pub(super) shares: Shares,
    /// Kind of the ray, a bit of [`visibility`].
    pub(super) kind: u32,
    /// What the light it meets is for; `None` for what the camera sees.
    pub(super) light: Option<Effect>,
    /// [`Bsdf::lit_side`](crate::bsdf::Bsdf::lit_side) of the surface it left.
    pub(super) lit_side: Option<Vec3>,
    /// Bit of the set of receivers that its object is in; all bits for the camera.
    pub(super) sets: u32,
    /// How wide the ray is.
    pub(super) width: Width,
    /// What lights count whose caustics are made of photons.
    pub(super) mapped: Rgb,
    /// Distance from where the ray began to where it is traced from.
    pub(super) moved: f32,
    /// What the ray starts in.
    pub(super) medium: Medium,
}

impl Sampled {
    /// A ray from the camera.
    pub(super) const fn by_camera(width: Width) -> Self {
        Self {
            pdf: None,
            shares: Shares::EVEN,
            kind: visibility::CAMERA,
            light: None,
            lit_side: None,
            sets: u32::MAX,
            width,
            mapped: Rgb::WHITE,
            moved: 0.0,
            medium: Medium::CLEAR,
        }
    }

    fn sight(&self) -> Sight {
        Sight { kind: self.kind, mapped: self.mapped, moved: self.moved }
    }

    /// What it left, at `p`.
    pub(super) fn receiver(&self, p: Vec3) -> Receiver {
        Receiver { p, normal: self.lit_side, sets: self.sets }
    }

    fn weight(&self, pdf_light: f32) -> f32 {
        self.pdf.map_or(1.0, |pdf| self.shares.of_bsdf(pdf, pdf_light))
    }
}

/// What a ray met, but for the surface at its end.
#[derive(Debug)]
pub(super) struct Met {
    /// Light from lamps, emissive surfaces and the world along the ray, weighted.
    pub(super) light: Rgb,
    /// Length of the ray.
    pub(super) distance: f32,
    /// Share of light from the surface that arrives through what is transparent before it, and what absorbs light.
    pub(super) through: Rgb,
    /// Share of a camera ray that sees a hole in the picture. Where the object is one, there is no surface.
    pub(super) hole: f32,
}

impl<'a, E: Estimator> Gatherer<'a, E> {
    /// Follows a ray to the surface it ends at, which goes into `end`: it is too large to be handed on by value. `first` is
    /// the ray's first hit if that is known already.
    pub(super) fn meet(
        &self,
        ray: Ray,
        first: Option<Option<Hit>>,
        sampled: Sampled,
        rng: &mut Rng,
        meter: &mut Meter,
        end: &mut Option<Surface<'a>>,
    ) -> Met {
        let owner = meter.owner();
        let met = self.meet_first(ray, first, sampled, rng, meter, end);
        meter.back(owner);
        met
    }

    fn meet_first(
        &self,
        mut ray: Ray,
        first: Option<Option<Hit>>,
        sampled: Sampled,
        rng: &mut Rng,
        meter: &mut Meter,
        end: &mut Option<Surface<'a>>,
    ) -> Met {
        *end = None;
        let mut met = Met { light: Rgb::BLACK, distance: 0.0, through: Rgb::WHITE, hole: 0.0 };
        let (from, lit) = (sampled.receiver(ray.origin), self.lit);
        let mut medium = sampled.medium;
        let mut known = first;
        for _ in 0..MAX_TRANSPARENT {
            let mut hit = known.take().unwrap_or_else(|| lit.accel.intersect(&ray));
            if hit.is_some_and(|hit| lit.accel.is_lamp(hit.object)) {
                let (behind, light) =
                    self.cross_lamps(from, &ray, met.distance, Sampled { medium, ..sampled }, meter);
                met.light += met.through * light;
                hit = behind;
            }
            let Some(hit) = hit else {
                let world = lit.lights.has_world().then_some(Effect::EnvironmentLight);
                meter.enter_if(world.or(sampled.light));
                let left = met.through * medium.transmittance(f32::INFINITY);
                met.light += left * self.escaped(from, ray.direction, sampled);
                return met;
            };
            met.distance += hit.t;
            if !medium.is_clear() {
                let owner = meter.enter(Effect::Absorption);
                met.through *= medium.transmittance(hit.t);
                meter.back(owner);
            }
            let surface = end.insert(lit.surface(&ray, hit, sampled.width.at(met.distance)));
            surface.medium = medium;
            let by_camera = sampled.kind == visibility::CAMERA;
            let is_hole = by_camera && self.is_holdout(&hit);
            if !surface.bsdf.emission.is_black() && !is_hole {
                let owner = meter.enter(Effect::EmissiveMeshes);
                let pdf = lit.emitter_pdf(from, &ray, &hit, met.distance);
                let share = lit.lights.share_of_mesh(from, hit.object, sampled.sight());
                met.light += met.through * surface.bsdf.emission * share * sampled.weight(pdf);
                meter.back(owner);
            }
            let transparency = surface.bsdf.transparency;
            let chance = transparency.mean().clamp(0.0, 1.0);
            if chance <= 0.0 || rng.draw() >= chance {
                let per_chance = 1.0 / (1.0 - chance).max(f32::MIN_POSITIVE);
                met.through = met.through * per_chance;
                if is_hole {
                    (met.hole, *end) = (1.0, None);
                } else if by_camera {
                    met.hole = (surface.bsdf.holdout() * per_chance).min(1.0);
                }
                return met;
            }
            met.through = met.through * transparency * (1.0 / chance);
            medium = surface.medium_towards(ray.direction);
            ray = surface.leaving(ray.direction, ray.mask);
            *end = None;
            meter.enter(Effect::AlphaTransparency);
            meter.count(Effect::AlphaTransparency, 1);
        }
        met.through = Rgb::BLACK;
        met
    }

    /// Lamps do not stop a ray: what is behind those that this one met first, and their light, weighted. `travelled` is how
    /// far the ray's origin is from `from`, where the direction was chosen; `sampled.medium` is what it is in there.
    pub(super) fn cross_lamps(
        &self,
        from: Receiver,
        ray: &Ray,
        travelled: f32,
        sampled: Sampled,
        meter: &mut Meter,
    ) -> (Option<Hit>, Rgb) {
        let behind = self.lit.accel.intersect(&Ray { mask: ray.mask & !visibility::LAMP, ..*ray });
        let until = behind.map_or(f32::INFINITY, |hit| travelled + hit.t);
        let mut light = Rgb::BLACK;
        let owner = meter.enter_if(sampled.light);
        let lights = &self.lit.lights;
        let span = travelled..until;
        lights.lamps_crossed(from, ray.direction, span, sampled.sight(), &mut |radiance, pdf, distance| {
            let left = sampled.medium.transmittance(distance - travelled);
            light += left * radiance * sampled.weight(pdf);
        });
        meter.back(owner);
        (behind, light)
    }

    /// Light from outside the scene along a camera ray.
    pub(super) fn background(&self, ray: &Ray) -> Rgb {
        let sight = Sampled::by_camera(Width::NONE);
        self.escaped(sight.receiver(ray.origin), ray.direction, sight)
    }

    /// Light from outside the scene.
    fn escaped(&self, from: Receiver, direction: Vec3, sampled: Sampled) -> Rgb {
        let (world, pdf) = self.lit.lights.world_seen(from, direction, sampled.sight());
        let mut light = world * sampled.weight(pdf);
        self.lit.lights.suns(from, direction, sampled.sight(), &mut |radiance, pdf| {
            light += radiance * sampled.weight(pdf);
        });
        light
    }

    /// Radiance leaving the surface `end` towards where the ray came from, without its emission: read where the estimator
    /// allows, followed where not, from surface to surface. Look-ups that are deferred go to `target` instead.
    pub(super) fn outgoing(
        &self,
        end: &mut Option<Surface<'a>>,
        mut footprint: Footprint,
        mut mapped: Mapped,
        rng: &mut Rng,
        mut target: Target<'_, E::Place>,
    ) -> Rgb {
        let mut radiance = Rgb::BLACK;
        let mut throughput = Rgb::WHITE;
        // What light counts for that comes through mirrors and glass: caustics, or the look-up that a followed vertex replaces.
        let mut light = self.lit.plan.caustics.then_some(Effect::Caustics);
        let owner = target.traces.meter.owner();
        for depth in 0..self.max_depth {
            let Some(surface) = end.as_ref() else { break };
            let lobes = match self.read(surface, footprint, throughput, rng, &mut target) {
                Some(read) => {
                    radiance += read;
                    LobeSet::FOLLOWED
                }
                None => {
                    target.traces.rays.retraced += 1;
                    if mapped.is_sharp {
                        radiance += throughput * self.caustics_at(surface, &mut target.traces.meter);
                    }
                    LobeSet::ALL
                }
            };
            if !surface.bsdf.has(lobes) {
                break;
            }
            if lobes.intersects(LobeSet::NON_DELTA) {
                let followed = if light.is_some() { LobeSet::FOLLOWED } else { LobeSet::EMPTY };
                let counted = lobes.and(self.lit.plan.reads | followed);
                let replaces = lobes.intersects(LobeSet::READ);
                let effect = if replaces { Some(self.lit.plan.indirect_owner()) } else { light };
                let before = target.traces.meter.enter_if(effect);
                radiance +=
                    throughput * self.one_light(surface, [lobes, counted], mapped.share, rng, target.traces);
                target.traces.meter.back(before);
            }
            let sample = surface.bsdf.sample(rng.draw(), rng.draw2(), lobes, TransportMode::Radiance);
            let Some(sample) = sample else { break };
            let on_the_way = mapped.follow(&surface.bsdf, &sample, lobes);
            throughput *= sample.weight;
            let survives = survives(&mut throughput, depth, rng);
            if !survives || !self.pass(&mut light, sample.class, &mut target.traces.meter) {
                break;
            }
            let kind = ray_kind(&sample);
            let ray = surface.leaving(sample.wi, kind | self.lit.accel.lamp_bit());
            let medium = surface.medium_towards(sample.wi);
            target.traces.rays.gather += 1;
            let hit = self.lit.accel.intersect(&ray);
            let readable = hit.filter(|_| !sample.is_delta && medium.is_clear()).and_then(|hit| {
                self.readable(&ray, &hit, 0.0).or_else(|| self.readable_varying(&ray, &hit, 0.0))
            });
            let read = readable.and_then(|readable| {
                target.read(self.estimator, readable.place, throughput * readable.reflectance)
            });
            if let Some(read) = read {
                radiance += read;
                break;
            }
            let pdf = (!sample.is_delta).then_some(sample.pdf_solid_angle);
            let lit_side = surface.bsdf.lit_side();
            let (shares, width) = (Shares::EVEN, Width::NONE);
            let (sets, mapped, moved) = (surface.sets, on_the_way, 0.0);
            let sampled = Sampled { pdf, shares, kind, light, lit_side, sets, width, mapped, moved, medium };
            let met = self.meet(ray, Some(hit), sampled, rng, &mut target.traces.meter, end);
            if light.is_some() {
                radiance += throughput * met.light;
            }
            throughput *= met.through;
            footprint = if sample.is_delta {
                Footprint { travelled: footprint.travelled + met.distance, sharp: false, ..footprint }
            } else {
                Footprint { solid_angle: 0.0, travelled: met.distance, sharp: false }
            };
            target.traces.meter.back(owner);
        }
        target.traces.meter.back(owner);
        radiance
    }

    /// Radiance of the lobes that are read, towards where the ray came from, times `throughput`; `None` where the ray has to
    /// be followed instead.
    fn read(
        &self,
        surface: &Surface<'_>,
        footprint: Footprint,
        throughput: Rgb,
        rng: &mut Rng,
        target: &mut Target<'_, E::Place>,
    ) -> Option<Rgb> {
        let reads = self.lit.plan.reads;
        if !E::READS_BOTH_SIDES && surface.bsdf.has(reads.and(LobeSet::TRANSLUCENT)) {
            return None;
        }
        let at_rest = self.lit.moves(surface.hit.object).then(|| self.lit.at_rest(surface).0);
        let surface = at_rest.as_ref().unwrap_or(surface);
        if !surface.bsdf.has(reads.and(LobeSet::ROUGH)) {
            return target.radiance(self.estimator, surface, reads, footprint, throughput, rng);
        }
        let owner = target.traces.meter.enter(Effect::IndirectGlossy);
        let read = target.radiance(self.estimator, surface, reads, footprint, throughput, rng);
        target.traces.meter.back(owner);
        read
    }

    /// Notes a lobe of class `class` that a path goes on through, and what light it meets from there counts for. False where
    /// nothing does.
    fn pass(&self, light: &mut Option<Effect>, class: LobeSet, meter: &mut Meter) -> bool {
        let plan = &self.lit.plan;
        if LobeSet::FOLLOWED.intersects(class) {
            meter.enter(Effect::MirrorsAndGlass);
            meter.count(Effect::MirrorsAndGlass, 1);
        } else {
            meter.count(plan.indirect_owner(), 1);
            *light = plan.reads.intersects(class).then_some(plan.indirect_owner());
        }
        light.is_some() || plan.indirect()
    }

    /// Direct light at a vertex that is followed: one light sample against one direction of the BSDF, drawn from `lobes`. Of
    /// these the light of the `counted` ones is wanted; what sharp ones reflect of a light in the caustic map counts as
    /// `mapped` says.
    fn one_light(
        &self,
        surface: &Surface<'_>,
        [lobes, counted]: [LobeSet; 2],
        mapped: Rgb,
        rng: &mut Rng,
        traces: &mut Traces<E::Place>,
    ) -> Rgb {
        if !self.lit.plan.light_samples {
            return Rgb::BLACK;
        }
        let u = [rng.draw(), rng.draw(), rng.draw()];
        if !surface.bsdf.has(counted) {
            return Rgb::BLACK;
        }
        let Some(sample) = self.lit.sample_direct(surface.receiver(), u, surface.time) else {
            return Rgb::BLACK;
        };
        let Some(shadow) = shadow_ray(surface, &sample, lobes, counted, Shares::EVEN) else {
            return Rgb::BLACK;
        };
        let radiance = if sample.is_mapped {
            let lit = counted.and(lobes_lit(sample.visibility));
            shadow.radiance * with_read(mapped, &surface.bsdf, sample.wi, lit)
        } else {
            shadow.radiance
        };
        radiance * transmittance(self.lit, &shadow, traces)
    }
}

/// Russian roulette: false where the path ends.
fn survives(throughput: &mut Rgb, depth: u32, rng: &mut Rng) -> bool {
    let most = throughput.max_channel();
    if most >= ROULETTE_BELOW && depth <= 8 {
        return true;
    }
    let survival = most.min(0.95);
    if rng.draw() >= survival {
        return false;
    }
    *throughput = *throughput * (1.0 / survival);
    true
}

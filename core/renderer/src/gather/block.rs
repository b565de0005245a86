//! Sixteen pixels at a time: one camera sample each, their shadow rays, and their gather rays stratum by stratum, so that
//! the rays of a packet stay together.

use std::f32::consts::PI;

use glam::DVec2;

use crate::accel::{Hit, LANES, Packet, Ray};
use crate::bsdf::{LobeSet, TransportMode};
use crate::color::Rgb;
use crate::effects_plan::Effect;
use crate::estimator::Estimator;
use crate::film::{BLOCK, PixelSample, TileRect};
use crate::lit_scene::{Medium, ray_kind};
use crate::sampling::{PixelSeeds, Rng, hash, shuffled_point, shuffled_points};
use crate::scene::{MIDDLE, visibility};
use crate::settings::GatherSampling;

use super::camera::{CameraRay, camera_ray};
use super::catcher::Caught;
use super::deferred::Traces;
use super::direct::{ShadowRay, lambert_shadow_ray, shadow_ray, transmittance};
use super::lambert::LambertLanes;
use super::path::Sampled;
use super::vertex::{GatherRay, Vertex, rotate};
use super::{Gatherer, Width};

/// Tells a pixel's points on lamps from its points in the pixel.
const LAMP_SEED: u32 = 0x9E37_79B1;

/// Work on one block of pixels.
pub(super) struct Block<'a, 'g, E: Estimator> {
    pub(super) gatherer: &'g Gatherer<'a, E>,
    /// Number of the camera sample.
    pub(super) sample: u32,
    pub(super) keys: [u64; LANES],
    pub(super) seeds: PixelSeeds<LANES>,
    /// Camera samples on constant Lambert surfaces, and on all others.
    pub(super) lambert: LambertLanes,
    pub(super) vertices: [Option<Box<Vertex<'a>>>; LANES],
    /// Whether there are such others.
    pub(super) has_vertices: bool,
    /// Those that met a shadow catcher.
    pub(super) caught: [Option<Caught>; LANES],
    pub(super) samples: [PixelSample; LANES],
    pub(super) packet: Packet,
    /// How wide each camera ray is from where it starts.
    width: [Width; LANES],
    /// See [`CameraRay`].
    moved: [f32; LANES],
    /// What each camera ray starts in.
    medium: [Medium; LANES],
    /// Of the packet: gather rays that did not start on a constant Lambert surface.
    pub(super) others: [Option<GatherRay>; LANES],
    pub(super) traces: Traces<E::Place>,
}

impl<'a, 'g, E: Estimator> Block<'a, 'g, E> {
    /// An idle block.
    pub(super) fn new(gatherer: &'g Gatherer<'a, E>, sample: u32) -> Self {
        Self {
            gatherer,
            sample,
            keys: [0; LANES],
            seeds: PixelSeeds::new(&[0; LANES]),
            lambert: LambertLanes::default(),
            vertices: [const { None }; LANES],
            has_vertices: false,
            caught: [None; LANES],
            samples: [PixelSample::default(); LANES],
            packet: Packet::default(),
            width: [Width::NONE; LANES],
            moved: [0.0; LANES],
            medium: [Medium::CLEAR; LANES],
            others: [None; LANES],
            traces: Traces::default(),
        }
    }

    /// Rays traced so far, what they cost, and look-ups that wait for their answer.
    pub(super) fn finish(self) -> Traces<E::Place> {
        self.traces
    }

    /// Computes the pixels of the block whose lowest corner is (x, y) and writes those inside `tile` to `out`.
    #[inline(always)]
    pub(super) fn run(&mut self, x: u32, y: u32, tile: TileRect, out: &mut [PixelSample]) {
        let deferred = self.traces.deferred.len();
        self.traces.meter.begin(self.gatherer.is_clocked(self.sample, x, y));
        self.start(x, y);
        if self.lambert.any() || self.has_vertices {
            self.light();
            if self.gatherer.caustics.is_some() {
                self.read_caustics();
            }
            self.gather();
        }
        self.traces.meter.end();
        let pixel = |px: u32, py: u32| ((py - tile.y) * tile.width + px - tile.x) as usize;
        for lane in 0..LANES as u32 {
            let (px, py) = (x + lane % BLOCK, y + lane / BLOCK);
            if px < tile.x + tile.width && py < tile.y + tile.height {
                out[pixel(px, py)] = self.samples[lane as usize];
            }
        }
        for deferred in &mut self.traces.deferred[deferred..] {
            let lane = deferred.pixel as u32;
            deferred.pixel = pixel(x + lane % BLOCK, y + lane / BLOCK);
        }
    }

    /// Camera rays, followed through mirrors and glass to a surface that scatters.
    fn start(&mut self, x: u32, y: u32) {
        let g = self.gatherer;
        let camera = &g.lit.accel.scene().camera;
        self.packet.clear();
        self.lambert.clear();
        self.has_vertices = false;
        self.others = [None; LANES];
        if g.lit.plan.shadow_catcher {
            self.caught = [None; LANES];
        }
        let mut seeds = [0; LANES];
        for (lane, seed) in seeds.iter_mut().enumerate() {
            let (px, py) = (x + lane as u32 % BLOCK, y + lane as u32 / BLOCK);
            let (frame_x, frame_y) = (camera.region[0] + px, camera.region[1] + py);
            let key = hash(u64::from(g.seed), u64::from(frame_y) << 32 | u64::from(frame_x));
            self.keys[lane] = key;
            *seed = (key >> 32) as u32;
            self.samples[lane] = PixelSample::default();
            self.vertices[lane] = None;
            if px >= camera.region[2] || py >= camera.region[3] {
                continue;
            }
            let u = match &g.camera_set {
                Some(set) => set.point(self.sample as usize, key as u32),
                None => shuffled_point(self.sample, key as u32),
            };
            let offset = [u[0] - 0.5, u[1] - 0.5];
            self.samples[lane] = PixelSample { offset, taken: true, ..Default::default() };
            let offset = DVec2::new(f64::from(offset[0]), f64::from(offset[1]));
            let position = DVec2::new(f64::from(frame_x), f64::from(frame_y)) + 0.5 + offset;
            let time = if g.lit.plan.motion_blur { self.time(lane) } else { MIDDLE };
            let seen = match &g.lens {
                None => camera_ray(camera, g.lit, position, None, time),
                Some(lens) => {
                    let owner = self.traces.meter.enter(Effect::DepthOfField);
                    let point = lens.point(shuffled_point(self.sample, hash(key, 4) as u32));
                    self.traces.meter.back(owner);
                    camera_ray(camera, g.lit, position, Some((lens, point)), time)
                }
            };
            let Some(CameraRay { ray, reach, start, moved, spread }) = seen else {
                // Beside a fisheye's picture it is black, even where the film is transparent, as in Cycles.
                self.samples[lane].alpha = 1.0;
                continue;
            };
            (self.width[lane], self.moved[lane]) = (g.camera_width.spread_by(spread).after(start), moved);
            self.medium[lane] = g.lit.medium_at(ray.origin, time, &mut self.traces.meter);
            self.packet.set(lane, &ray, reach);
        }
        self.seeds = PixelSeeds::new(&seeds);
        g.lit.accel.intersect_packet(&mut self.packet);
        for lane in 0..LANES {
            if self.packet.is_set(lane) {
                self.traces.rays.camera += 1;
                let (ray, hit) = (self.packet.ray(lane), self.packet.hit(lane));
                if !self.start_lambert(lane, &ray, hit) {
                    self.follow_camera(lane, ray, hit);
                }
            }
        }
    }

    /// When the camera sample of a lane is taken, while the shutter is open.
    fn time(&mut self, lane: usize) -> f32 {
        let owner = self.traces.meter.enter(Effect::MotionBlur);
        let [u, _] = shuffled_point(self.sample, hash(self.keys[lane], 5) as u32);
        let time = self.gatherer.lit.accel.scene().camera.shutter.time(u);
        self.traces.meter.back(owner);
        time
    }

    /// Takes the common case: the camera sees a surface that is nothing but a constant Lambert reflector.
    fn start_lambert(&mut self, lane: usize, ray: &Ray, hit: Option<Hit>) -> bool {
        let g = self.gatherer;
        let Some(hit) = hit.filter(|hit| !g.lit.accel.is_lamp(hit.object)) else { return false };
        let (ng, material) = g.lit.accel.triangle(hit.object, hit.primitive);
        let is_common = g.sampling == GatherSampling::Cosine && self.medium[lane].is_clear();
        if !is_common || g.is_holdout(&hit) || g.lit.moves(hit.object) {
            return false;
        }
        let albedo = match g.plain[material] {
            Some(albedo_over_pi) => albedo_over_pi * PI,
            None => match g.lit.varying_albedo(material, ray, &hit, self.width[lane].at(hit.t)) {
                Some(albedo) => albedo,
                None => return false,
            },
        };
        let frame = g.lit.frame(ray, &hit, ng);
        let p = ray.origin + ray.direction * hit.t;
        self.lambert.put(lane, p, frame.ng, frame.ns, albedo, ray.time);
        self.lambert.sets[lane] = g.lit.receiver_sets(hit.object);
        self.samples[lane].alpha = 1.0;
        if g.is_catcher(&hit) {
            self.caught[lane] = Some(g.behind_catcher(ray));
        }
        true
    }

    fn follow_camera(&mut self, lane: usize, mut ray: Ray, hit: Option<Hit>) {
        let g = self.gatherer;
        let mut rng = Rng::new(hash(self.keys[lane], u64::from(self.sample) << 16 | 1));
        let mut sampled = Sampled::by_camera(self.width[lane]);
        (sampled.moved, sampled.medium) = (self.moved[lane], self.medium[lane]);
        let owner = self.traces.meter.owner();
        let (mut first, mut throughput) = (Some(hit), Rgb::WHITE);
        let transparent_film = g.lit.accel.scene().world.film_transparent;
        for depth in 0..g.max_depth {
            let mut end = None;
            let met = g.meet(ray, first.take(), sampled, &mut rng, &mut self.traces.meter, &mut end);
            let sample = &mut self.samples[lane];
            let is_film = met.hole == 0.0 && end.is_none() && transparent_film;
            if depth > 0 || !is_film {
                sample.direct += throughput * met.light;
            }
            if depth == 0 && !is_film {
                sample.alpha = 1.0 - met.hole;
            }
            let Some(surface) = end else { break };
            if depth == 0 && g.is_catcher(&surface.hit) {
                self.caught[lane] = Some(g.caught(&ray, &surface, &met));
            }
            throughput *= met.through;
            if surface.bsdf.has(LobeSet::NON_DELTA) {
                self.vertices[lane] = Some(Box::new(Vertex { surface, throughput }));
                self.has_vertices = true;
                break;
            }
            let sample =
                surface.bsdf.sample(rng.draw(), rng.draw2(), LobeSet::DELTA, TransportMode::Radiance);
            let Some(sample) = sample else { break };
            self.traces.meter.enter(Effect::MirrorsAndGlass);
            self.traces.meter.count(Effect::MirrorsAndGlass, 1);
            throughput *= sample.weight;
            (sampled.kind, sampled.sets) = (ray_kind(&sample), surface.sets);
            (sampled.width, sampled.moved) = (sampled.width.after(met.distance), 0.0);
            sampled.medium = surface.medium_towards(sample.wi);
            ray = surface.leaving(sample.wi, sampled.kind | g.lit.accel.lamp_bit());
            self.traces.rays.camera += 1;
        }
        self.traces.meter.back(owner);
    }

    /// Direct light: shadow rays of the camera sample.
    #[inline(always)]
    pub(super) fn light(&mut self) {
        let g = self.gatherer;
        if !(g.lit.plan.direct && g.lit.plan.light_samples) {
            return;
        }
        let owner = self.traces.meter.enter(Effect::DirectLight);
        let seeds = self.keys.map(|key| key as u32 ^ LAMP_SEED);
        for i in 0..g.light_samples {
            let index = self.sample * g.light_samples + i;
            self.packet.clear();
            let mut shadows: [Option<ShadowRay>; LANES] = [None; LANES];
            let [x, y] = shuffled_points(index, &seeds);
            for (lane, shadow) in shadows.iter_mut().enumerate() {
                *shadow = self.shadow(lane, [rotate(self.keys[lane], index), x[lane], y[lane]]);
                let traced = shadow.as_ref().filter(|shadow| shadow.is_all_or_nothing(g.lit));
                if let Some(shadow) = traced {
                    self.packet.set(lane, &shadow.ray, shadow.t_far);
                    self.traces.rays.shadow += 1;
                    self.traces.meter.count(Effect::DirectLight, 1);
                }
            }
            if !self.packet.is_empty() {
                g.lit.accel.occluded_packet(&mut self.packet);
            }
            for (lane, shadow) in shadows.iter().enumerate() {
                let Some(shadow) = shadow else { continue };
                let seen = if !self.packet.is_set(lane) {
                    transmittance(g.lit, shadow, &mut self.traces)
                } else if self.packet.is_free(lane) {
                    Rgb::WHITE
                } else {
                    continue;
                };
                self.samples[lane].direct += shadow.radiance * seen * g.per_light_sample;
            }
        }
        self.traces.meter.back(owner);
    }

    /// A shadow ray of one lane, its radiance as the camera sees it.
    fn shadow(&self, lane: usize, u: [f32; 3]) -> Option<ShadowRay> {
        let g = self.gatherer;
        if self.lambert.set[lane] {
            let sample = g.lit.sample_direct(self.lambert.receiver(lane), u, self.lambert.time[lane])?;
            return lambert_shadow_ray(&self.lambert, lane, &sample, g.shares);
        }
        let vertex = self.vertices[lane].as_ref()?;
        let sample = g.lit.sample_direct(vertex.surface.receiver(), u, vertex.surface.time)?;
        let mut shadow = shadow_ray(&vertex.surface, &sample, LobeSet::ALL, LobeSet::ALL, g.shares)?;
        shadow.radiance *= vertex.throughput;
        Some(shadow)
    }

    /// Gather rays of the camera sample.
    #[inline(always)]
    pub(super) fn gather(&mut self) {
        let plan = &self.gatherer.lit.plan;
        if !plan.gathers {
            return;
        }
        let owner = self.traces.meter.owner();
        for index in self.gatherer.rays_of_sample(self.sample) {
            let pdfs = self.aim(index);
            let sharp = self.has_vertices && self.others.iter().flatten().all(|ray| ray.sharp);
            let effect =
                if sharp && !self.lambert.any() { Effect::MirrorsAndGlass } else { plan.gather_owner() };
            self.traces.meter.enter(effect);
            self.gatherer.lit.accel.intersect_packet(&mut self.packet);
            let rays = self.packet.len() as u64;
            self.traces.rays.gather += rays;
            self.traces.meter.count(effect, rays);
            let auditor = self.gatherer.auditor;
            let audited = auditor.and_then(|auditor| auditor.lane(self.keys[0], index));
            let before = audited.map(|lane| self.samples[lane].indirect);
            self.receive(&pdfs, index);
            if let (Some(lane), Some(before)) = (audited, before) {
                self.audit(lane, pdfs[lane], index, before);
            }
        }
        self.traces.meter.back(owner);
    }

    /// Puts gather ray `index` of every lane into the packet; gives the densities of those that start on constant Lambert
    /// surfaces.
    #[inline(always)]
    fn aim(&mut self, index: u32) -> [f32; LANES] {
        let g = self.gatherer;
        let points = g.gather_set.points(index as usize, &self.seeds);
        let lamps = g.lit.accel.lamp_bit();
        let pdfs = self.lambert.aim(points, visibility::DIFFUSE | lamps, &mut self.packet);
        if self.has_vertices {
            self.aim_others(points, index);
        }
        pdfs
    }

    fn aim_others(&mut self, points: [[f32; LANES]; 2], index: u32) {
        let g = self.gatherer;
        let lamps = g.lit.accel.lamp_bit();
        for lane in 0..LANES {
            self.others[lane] = None;
            let Some(vertex) = &self.vertices[lane] else { continue };
            let u = points.map(|coordinate| coordinate[lane]);
            let Some((ray, direction)) = vertex.gather_ray(u, rotate(self.keys[lane], index), g.sampling)
            else {
                continue;
            };
            let leaving = vertex.surface.leaving(direction, ray.kind | lamps);
            self.packet.set(lane, &leaving, f32::INFINITY);
            self.others[lane] = Some(ray);
        }
    }

    /// The gather rays that `run` would trace, pixel by pixel within each stratum.
    pub(super) fn collect_gather_rays(&mut self, x: u32, y: u32, rays: &mut Vec<Ray>) {
        self.start(x, y);
        for index in self.gatherer.rays_of_sample(self.sample) {
            self.aim(index);
            rays.extend(
                (0..LANES).filter(|&lane| self.packet.is_set(lane)).map(|lane| self.packet.ray(lane)),
            );
        }
    }
}

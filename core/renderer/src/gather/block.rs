//! Sixteen pixels at a time: one camera sample each, their shadow rays, and their gather rays stratum by stratum, so that
//! the rays of a packet stay together.

use std::f32::consts::{FRAC_1_PI, PI};

use glam::{DVec2, Vec3};

use crate::accel::{LANES, Packet, Ray};
use crate::bsdf::{LobeSet, TransportMode};
use crate::color::Rgb;
use crate::film::{BLOCK, PixelSample, TileRect};
use crate::lit_scene::{Surface, ray_kind};
use crate::math::Frame;
use crate::sampling::{Rng, UNIFORM_HEMISPHERE_PDF, cosine_hemisphere, hash, uniform_hemisphere};
use crate::scene::visibility;
use crate::settings::GatherSampling;
use crate::stats::RayCounts;

use super::Gatherer;
use super::camera::camera_ray;
use super::direct::{ShadowRay, Shares, shadow_ray, transmittance};
use super::path::{Footprint, Sampled};

/// Where a camera sample is shaded.
struct Vertex<'a> {
    surface: Surface<'a>,
    /// Share of its light that reaches the camera.
    throughput: Rgb,
    frame: Frame,
    /// The albedo, where the surface is a constant Lambert reflector.
    lambert: Option<Rgb>,
}

/// Work on one block of pixels.
pub struct Block<'a, 'g> {
    gatherer: &'g Gatherer<'a>,
    /// Number of the camera sample, which is the number of the pass.
    pass: u32,
    keys: [u64; LANES],
    seeds: [u32; LANES],
    vertices: [Option<Vertex<'a>>; LANES],
    samples: [PixelSample; LANES],
    packet: Packet,
    rays: RayCounts,
}

/// A direction to gather from.
#[derive(Clone, Copy)]
struct GatherRay {
    direction: Vec3,
    /// f · cos / pdf.
    weight: Rgb,
    pdf: Option<f32>,
    kind: u32,
    sharp: bool,
}

impl<'a, 'g> Block<'a, 'g> {
    /// An idle block.
    pub fn new(gatherer: &'g Gatherer<'a>, pass: u32) -> Self {
        Self {
            gatherer,
            pass,
            keys: [0; LANES],
            seeds: [0; LANES],
            vertices: [const { None }; LANES],
            samples: [PixelSample::default(); LANES],
            packet: Packet::default(),
            rays: RayCounts::default(),
        }
    }

    /// Rays traced so far.
    pub const fn rays(&self) -> RayCounts {
        self.rays
    }

    /// Computes the pixels of the block whose lowest corner is (x, y) and writes those inside `tile` to `out`.
    pub fn run(&mut self, x: u32, y: u32, tile: TileRect, out: &mut [PixelSample]) {
        self.start(x, y);
        self.light();
        self.gather();
        for lane in 0..LANES as u32 {
            let (px, py) = (x + lane % BLOCK, y + lane / BLOCK);
            if px < tile.x + tile.width && py < tile.y + tile.height {
                out[((py - tile.y) * tile.width + px - tile.x) as usize] = self.samples[lane as usize];
            }
        }
    }

    /// Camera rays, followed through mirrors and glass to a surface that scatters.
    fn start(&mut self, x: u32, y: u32) {
        let g = self.gatherer;
        let camera = &g.lit.accel.scene().camera;
        self.packet.clear();
        let mut reach = [0.0; LANES];
        for lane in 0..LANES {
            let (px, py) = (x + lane as u32 % BLOCK, y + lane as u32 / BLOCK);
            let (frame_x, frame_y) = (camera.region[0] + px, camera.region[1] + py);
            let key = hash(u64::from(g.seed), u64::from(frame_y) << 32 | u64::from(frame_x));
            self.keys[lane] = key;
            self.seeds[lane] = (key >> 32) as u32;
            self.samples[lane] = PixelSample::default();
            self.vertices[lane] = None;
            if px >= camera.region[2] || py >= camera.region[3] {
                continue;
            }
            let u = g.camera_set.point(self.pass as usize, key as u32);
            let offset = [u[0] - 0.5, u[1] - 0.5];
            self.samples[lane] = PixelSample { offset, taken: true, ..Default::default() };
            let offset = DVec2::new(f64::from(offset[0]), f64::from(offset[1]));
            let position = DVec2::new(f64::from(frame_x), f64::from(frame_y)) + 0.5 + offset;
            let (ray, far) = camera_ray(camera, g.lit, position);
            reach[lane] = far;
            self.packet.set(lane, &ray, far);
        }
        g.lit.accel.intersect_packet(&mut self.packet);
        for lane in 0..LANES {
            if self.packet.is_set(lane) {
                self.rays.camera += 1;
                self.follow_camera(lane);
            }
        }
    }

    fn follow_camera(&mut self, lane: usize) {
        let g = self.gatherer;
        let mut rng = Rng::new(hash(self.keys[lane], u64::from(self.pass) << 16 | 1));
        let mut sampled = Sampled { pdf: None, shares: Shares::EVEN, kind: visibility::CAMERA };
        let (mut ray, mut first) = (self.packet.ray(lane), Some(self.packet.hit(lane)));
        let mut throughput = Rgb::WHITE;
        let transparent_film = g.lit.accel.scene().world.film_transparent;
        for depth in 0..g.max_depth {
            let met = g.meet(ray, first.take(), sampled, &mut rng);
            let sample = &mut self.samples[lane];
            if met.surface.is_some() || depth > 0 || !transparent_film {
                sample.direct += throughput * met.light;
                sample.alpha = 1.0;
            }
            let Some(surface) = met.surface else { return };
            throughput *= met.through;
            if surface.bsdf.has(LobeSet::NON_DELTA) {
                let lambert = g.lambert_of(&surface);
                let frame = Frame::new(surface.bsdf.frame.ns);
                self.vertices[lane] = Some(Vertex { surface, throughput, frame, lambert });
                return;
            }
            let sample =
                surface.bsdf.sample(rng.next(), rng.next2(), LobeSet::DELTA, TransportMode::Radiance);
            let Some(sample) = sample else { return };
            throughput *= sample.weight;
            sampled.kind = ray_kind(&sample);
            ray = Ray::leaving(surface.p, surface.ng, sample.wi, sampled.kind | g.lit.accel.lamp_bit());
            self.rays.camera += 1;
        }
    }

    /// Direct light: shadow rays of the camera sample.
    fn light(&mut self) {
        let g = self.gatherer;
        if !g.lit.plan.direct || self.vertices.iter().all(Option::is_none) {
            return;
        }
        for i in 0..g.light_samples {
            let index = self.pass * g.light_samples + i;
            let [x, y] = g.light_set.points(index as usize, &self.seeds);
            self.packet.clear();
            let mut shadows: [Option<ShadowRay>; LANES] = [None; LANES];
            for lane in 0..LANES {
                let Some(vertex) = &self.vertices[lane] else { continue };
                let choice = rotate(self.keys[lane], index);
                let sample = g.lit.lights.sample_direct(vertex.surface.p, [choice, x[lane], y[lane]]);
                shadows[lane] = sample.and_then(|s| shadow_ray(&vertex.surface, &s, LobeSet::ALL, g.shares));
                if let Some(shadow) =
                    shadows[lane].as_ref().filter(|s| s.casts_shadow && !g.lit.plan.transparency)
                {
                    self.packet.set(lane, &shadow.ray, shadow.t_far);
                    self.rays.shadow += 1;
                }
            }
            if !self.packet.is_empty() {
                g.lit.accel.occluded_packet(&mut self.packet);
            }
            for (lane, shadow) in shadows.iter().enumerate() {
                let (Some(shadow), Some(vertex)) = (shadow, &self.vertices[lane]) else { continue };
                let seen = if self.packet.is_set(lane) {
                    if self.packet.is_free(lane) { Rgb::WHITE } else { Rgb::BLACK }
                } else {
                    transmittance(g.lit, shadow, &mut self.rays.shadow)
                };
                let share = 1.0 / g.light_samples as f32;
                self.samples[lane].direct += vertex.throughput * shadow.radiance * seen * share;
            }
        }
    }

    /// Gather rays of the camera sample.
    fn gather(&mut self) {
        for index in self.gatherer.rays_of_pass(self.pass) {
            let gather_rays = self.aim(index);
            if self.packet.is_empty() {
                continue;
            }
            self.gatherer.lit.accel.intersect_packet(&mut self.packet);
            for (lane, ray) in gather_rays.iter().enumerate() {
                if let Some(ray) = ray {
                    self.receive(lane, ray, index);
                }
            }
        }
    }

    /// Puts gather ray `index` of every lane into the packet.
    fn aim(&mut self, index: u32) -> [Option<GatherRay>; LANES] {
        let g = self.gatherer;
        let [x, y] = g.gather_set.points(index as usize, &self.seeds);
        self.packet.clear();
        let mut gather_rays: [Option<GatherRay>; LANES] = [None; LANES];
        for lane in 0..LANES {
            let Some(vertex) = &self.vertices[lane] else { continue };
            gather_rays[lane] = g.gather_ray(vertex, [x[lane], y[lane]], self.keys[lane], index);
            if let Some(ray) = &gather_rays[lane] {
                let mask = ray.kind | g.lit.accel.lamp_bit();
                let leaving = Ray::leaving(vertex.surface.p, vertex.surface.ng, ray.direction, mask);
                self.packet.set(lane, &leaving, f32::INFINITY);
                self.rays.gather += 1;
            }
        }
        gather_rays
    }

    /// The gather rays that `run` would trace, pixel by pixel within each stratum.
    pub(super) fn collect_gather_rays(&mut self, x: u32, y: u32, rays: &mut Vec<Ray>) {
        self.start(x, y);
        for index in self.gatherer.rays_of_pass(self.pass) {
            self.aim(index);
            rays.extend(
                (0..LANES).filter(|&lane| self.packet.is_set(lane)).map(|lane| self.packet.ray(lane)),
            );
        }
    }

    /// Adds what one gather ray brings.
    fn receive(&mut self, lane: usize, gather_ray: &GatherRay, index: u32) {
        let g = self.gatherer;
        let Some(vertex) = &self.vertices[lane] else { return };
        let hit = self.packet.hit(lane);
        let weight = vertex.throughput * gather_ray.weight;
        let solid_angle = gather_ray.pdf.map_or(0.0, |pdf| (g.per_ray / pdf).min(g.widest));
        let ray = self.packet.ray(lane);
        if let Some(hit) = hit
            && !g.lit.accel.is_lamp(hit.object)
        {
            let material = g.lit.accel.material(hit.object, hit.primitive);
            if let Some(albedo_over_pi) = g.plain[material].filter(|_| !gather_ray.sharp) {
                let level = g.pyramid.level_for(solid_angle * hit.t * hit.t);
                if hit.t >= g.retrace_distance * g.pyramid.nominal_cell_size(level) {
                    let ng = g.lit.accel.geometric_normal(hit.object, hit.primitive);
                    let facing = if ray.direction.dot(ng) > 0.0 { -ng } else { ng };
                    let p = ray.origin + ray.direction * hit.t;
                    let irradiance = g.pyramid.irradiance(p, g.pyramid.class(facing), level);
                    self.samples[lane].indirect += weight * albedo_over_pi * irradiance;
                    return;
                }
            }
        }
        let mut rng = Rng::new(hash(self.keys[lane], u64::from(index) << 16 | 2));
        let sampled = Sampled { pdf: gather_ray.pdf, shares: g.shares, kind: gather_ray.kind };
        let met = g.meet(ray, Some(hit), sampled, &mut rng);
        let sample = &mut self.samples[lane];
        sample.direct += weight * met.light * g.direct_share;
        if let Some(surface) = met.surface {
            let footprint = Footprint { solid_angle, travelled: met.distance, sharp: gather_ray.sharp };
            sample.indirect +=
                weight * met.through * g.outgoing(surface, footprint, &mut rng, &mut self.rays);
        }
    }
}

impl Gatherer<'_> {
    fn gather_ray(&self, vertex: &Vertex<'_>, u: [f32; 2], key: u64, index: u32) -> Option<GatherRay> {
        let bsdf = &vertex.surface.bsdf;
        let uniform = self.sampling == GatherSampling::Uniform && !bsdf.has(LobeSet::SHARP | LobeSet::DELTA);
        if uniform {
            let direction = vertex.frame.from_local(uniform_hemisphere(u));
            let f = bsdf.eval(direction, LobeSet::ALL, TransportMode::Radiance);
            let weight = f * (direction.dot(bsdf.frame.ns).abs() / UNIFORM_HEMISPHERE_PDF);
            let kind = visibility::DIFFUSE;
            return Some(GatherRay {
                direction,
                weight,
                pdf: Some(UNIFORM_HEMISPHERE_PDF),
                kind,
                sharp: false,
            });
        }
        if let Some(albedo) = vertex.lambert {
            let local = cosine_hemisphere(u);
            let direction = vertex.frame.from_local(local);
            let above = direction.dot(bsdf.frame.ng) > 0.0 && local.z > 0.0;
            let pdf = Some(local.z * FRAC_1_PI);
            let kind = visibility::DIFFUSE;
            return above.then_some(GatherRay { direction, weight: albedo, pdf, kind, sharp: false });
        }
        let sample = bsdf.sample(rotate(key, index), u, LobeSet::ALL, TransportMode::Radiance)?;
        Some(GatherRay {
            direction: sample.wi,
            weight: sample.weight,
            pdf: (!sample.is_delta).then_some(sample.pdf_solid_angle),
            kind: ray_kind(&sample),
            sharp: (LobeSet::SHARP | LobeSet::DELTA).intersects(sample.class),
        })
    }
}

/// A pixel's own additive recurrence with the golden ratio: evenly spread in one dimension.
fn rotate(key: u64, index: u32) -> f32 {
    let golden = index.wrapping_mul(0x9E37_79B9);
    (((key as u32) ^ 0x5bd1_e995).wrapping_add(golden) >> 8) as f32 * (1.0 / 16_777_216.0)
}

/// The widest solid angle a stratum of `rays` cosine-distributed rays covers: the outermost, at the horizon.
pub fn widest_stratum(rays: u32) -> f32 {
    2.0 * PI / (rays as f32).powf(0.75)
}

//! Which photons from far away the picture needs: paths from the camera are followed backwards to where light could come from,
//! and the photons that would travel them noted.

use std::collections::HashSet;

use glam::{DVec2, IVec3, Vec3};
use rayon::prelude::*;

use super::camera::camera_ray;
use super::readings::first_scatterer;
use crate::bsdf::{LobeSet, TransportMode};
use crate::color::Rgb;
use crate::light::{Emission, Find};
use crate::lit_scene::{LitScene, Surface, ray_kind};
use crate::pyramid::Reading;
use crate::sampling::{PhotonSampler, Rng, hash};
use crate::scene::{MIDDLE, visibility};

/// Mirrors, panes and transparent surfaces a path passes.
const MAX_DEPTH: u32 = 8;

/// Photons of suns and the world that would reach what gather rays see, directly or by way of a few surfaces.
#[must_use]
pub fn finds(lit: &LitScene<'_>, seed: u32) -> Vec<Find> {
    const EDGE: u32 = 64;
    const GATHER_RAYS: u32 = 8;
    let camera = &lit.accel.scene().camera;
    let frame = DVec2::from(camera.resolution.map(f64::from));
    let of_pixel = |i: u32| {
        let mut rng = Rng::new(hash(hash(u64::from(seed), 0x61_69_6d), u64::from(i)));
        let at = DVec2::new(f64::from(i % EDGE), f64::from(i / EDGE)) + 0.5;
        let mut finds = Vec::new();
        if let Some(seen) = camera_ray(camera, lit, at / f64::from(EDGE) * frame, None, MIDDLE)
            && let Some(surface) = first_scatterer(lit, seen.ray, MAX_DEPTH, &mut rng)
        {
            for _ in 0..GATHER_RAYS {
                walk(lit, &surface, &mut rng, &mut finds);
            }
        }
        finds
    };
    (0..EDGE * EDGE).into_par_iter().flat_map_iter(of_pixel).collect()
}

/// A path on from what the camera sees, and the light that could come to each of its points.
fn walk(lit: &LitScene<'_>, start: &Surface<'_>, rng: &mut Rng, finds: &mut Vec<Find>) {
    const SURFACES: usize = 4;
    let mut throughput = Rgb::WHITE;
    let mut next = onward(lit, start, &mut throughput, rng);
    for _ in 0..SURFACES {
        let Some(surface) = next else { return };
        let u = [rng.draw(), rng.draw(), rng.draw()];
        if let Some((wi, find)) = lit.lights.photon_through(surface.p, u)
            && is_lit(lit, &surface, wi)
        {
            let cos = wi.dot(surface.ng).abs();
            finds.push(find.weighing(throughput.mean() * cos));
        }
        next = onward(lit, &surface, &mut throughput, rng);
    }
}

/// The next surface of a path; `throughput` takes what the one before keeps.
fn onward<'a>(
    lit: &'a LitScene<'a>,
    surface: &Surface<'_>,
    throughput: &mut Rgb,
    rng: &mut Rng,
) -> Option<Surface<'a>> {
    let sample = surface.bsdf.sample(rng.draw(), rng.draw2(), LobeSet::ALL, TransportMode::Radiance)?;
    *throughput *= sample.weight.map(|c| c.min(1.0));
    let ray = surface.leaving(sample.wi, ray_kind(&sample));
    first_scatterer(lit, ray, MAX_DEPTH, rng)
}

/// True where light from far away along `wi` comes to a surface, panes of glass passed straight.
fn is_lit(lit: &LitScene<'_>, surface: &Surface<'_>, wi: Vec3) -> bool {
    let mut ray = surface.leaving(wi, visibility::SHADOW);
    for _ in 0..MAX_DEPTH {
        let Some(hit) = lit.accel.intersect(&ray) else { return true };
        let met = lit.surface(&ray, hit, 0.0);
        if met.bsdf.has(LobeSet::NON_DELTA) && met.bsdf.transparency.is_black() {
            return false;
        }
        ray = met.leaving(wi, ray.mask);
    }
    false
}

/// Where the camera and its gather rays look, in coarse cells.
pub struct Seen {
    cells: HashSet<IVec3>,
    per_cell: f32,
}

impl Seen {
    /// From what they see.
    #[must_use]
    pub fn new(seen: &[Reading]) -> Self {
        const CELLS: f32 = 16.0;
        let spread = |axis: usize| {
            let mut values: Vec<f32> = seen.iter().map(|reading| reading.p[axis]).collect();
            values.sort_by(f32::total_cmp);
            values
                .get(values.len() * 3 / 4)
                .zip(values.get(values.len() / 4))
                .map_or(0.0, |(high, low)| high - low)
        };
        let widest = 2.0 * spread(0).max(spread(1)).max(spread(2));
        let per_cell = CELLS / widest.max(1e-4);
        Self { cells: seen.iter().map(|reading| cell(reading.p, per_cell)).collect(), per_cell }
    }

    fn holds(&self, p: Vec3) -> bool {
        self.cells.contains(&cell(p, self.per_cell))
    }
}

/// Surfaces are rarely an odd part of a cell from the scene's middle, where rounding would tell cells apart.
fn cell(p: Vec3, per_cell: f32) -> IVec3 {
    (p * per_cell + 0.381_966).floor().as_ivec3()
}

/// Of photons that are tried: the share of those that land where the picture looks, and the flux they bring there (mean
/// channel).
#[derive(Clone, Copy, Debug, Default)]
pub struct Landings {
    /// Share of the photons.
    pub share: f64,
    /// Flux.
    pub flux: f64,
}

/// Tries photons of one light, see [`crate::light::Lights::emit_from`].
#[must_use]
pub fn landings(lit: &LitScene<'_>, light: usize, seen: &Seen, seed: u32) -> Landings {
    const PHOTONS: u64 = 4096;
    let lands = |emission: &Emission, rng: &mut Rng| {
        let (ray, _) =
            lit.entering(emission.origin.as_dvec3(), emission.direction, visibility::DIFFUSE, MIDDLE);
        first_scatterer(lit, ray, MAX_DEPTH, rng).is_some_and(|surface| seen.holds(surface.p))
    };
    let fluxes: Vec<Option<f64>> = (0..PHOTONS)
        .into_par_iter()
        .map(|id| {
            let mut sampler = PhotonSampler::new(id, seed);
            let numbers = std::array::from_fn(|_| sampler.draw());
            let mut rng = Rng::new(hash(u64::from(seed), id));
            let emission = lit.lights.emit_from(light, numbers);
            lands(&emission, &mut rng).then(|| f64::from(emission.flux.mean()))
        })
        .collect();
    let landed = fluxes.iter().flatten();
    Landings {
        share: landed.clone().count() as f64 / PHOTONS as f64,
        flux: landed.sum::<f64>() / PHOTONS as f64,
    }
}

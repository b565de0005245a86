//! The final gather: the picture, from the pyramid or what stands in for it.
//!
//! For each pixel, `camera_samples` points x are seen; from each, gather rays leave with density p and meet points y. The
//! radiance towards the camera is the light emitted and arriving directly at x, plus (paper, eq. 2, 3)
//! `1/N Σ f(x) cos / p · L(y)`, where L(y) is read over the footprint Ω r² with Ω = 1 / (N p).
//!
//! One pass over the picture is one camera sample of every pixel; passes are independent and their mean is the picture.

mod block;
mod camera;
mod deferred;
mod direct;
mod floor;
mod lambert;
mod look_up;
mod path;
mod readable;
mod vertex;

use std::ops::Range;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

use glam::{DVec2, Vec3};
use rayon::prelude::*;

use crate::accel::Ray;
use crate::bsdf::{LobeSet, TransportMode};
use crate::color::Rgb;
use crate::error::RenderError;
use crate::estimator::Estimator;
use crate::film::{BLOCK, Film, PixelSample};
use crate::lit_scene::{LitScene, Surface, ray_kind};
use crate::progress::Progress;
use crate::sampling::{Rng, StratifiedSet, hash};
use crate::scene::visibility;
use crate::settings::{GatherSampling, RenderSettings};
use crate::stats::RayCounts;

use block::{Block, widest_stratum};
use camera::camera_ray;
use deferred::OpenTile;
use direct::Shares;
pub use floor::{TraceFloor, trace_floor};
pub use look_up::PyramidLookup;

/// What every gather ray needs to know.
pub struct Gatherer<'a, E> {
    lit: &'a LitScene<'a>,
    estimator: &'a E,
    seed: u32,
    camera_samples: u32,
    light_samples: u32,
    rays: u32,
    max_depth: u32,
    sampling: GatherSampling,
    camera_set: StratifiedSet,
    light_set: StratifiedSet,
    gather_set: StratifiedSet,
    /// Of a pixel: light samples against gather rays.
    shares: Shares,
    /// 1 / light samples.
    per_light_sample: f32,
    /// 1 / rays.
    per_ray: f32,
    /// Camera samples per gather ray: the direct light a gather ray finds belongs to a sum over camera samples.
    direct_share: f32,
    /// Widest solid angle of a gather ray (sr).
    widest: f32,
    /// By material: albedo / π where all there is to know is a constant Lambert reflection.
    plain: Vec<Option<Rgb>>,
}

impl<'a, E: Estimator> Gatherer<'a, E> {
    /// Prepares a gather whose rays are answered by `estimator`.
    #[must_use]
    pub fn new(lit: &'a LitScene<'a>, estimator: &'a E, settings: &RenderSettings) -> Self {
        let gather = &settings.gather;
        let seed = settings.render.seed;
        let set = |count: u32, salt: u64| StratifiedSet::new(count, hash(u64::from(seed), salt) as u32);
        let plain = lit.materials.iter().map(|material| {
            let albedo = material.constant_lambert().filter(|_| material.emission().is_black());
            albedo.map(|albedo| albedo * std::f32::consts::FRAC_1_PI)
        });
        Self {
            lit,
            estimator,
            seed,
            camera_samples: gather.camera_samples,
            light_samples: gather.light_samples,
            rays: gather.rays,
            max_depth: gather.max_depth.max(E::LEAST_DEPTH),
            sampling: gather.sampling,
            camera_set: set(gather.camera_samples, 1),
            light_set: set(gather.camera_samples * gather.light_samples, 2),
            gather_set: set(gather.rays, 3),
            shares: Shares {
                light: (gather.camera_samples * gather.light_samples) as f32,
                bsdf: gather.rays as f32,
            },
            per_light_sample: 1.0 / gather.light_samples as f32,
            per_ray: 1.0 / gather.rays as f32,
            direct_share: gather.camera_samples as f32 / gather.rays as f32,
            widest: widest_stratum(gather.rays),
            plain: plain.collect(),
        }
    }

    /// Gather rays that belong to a camera sample: as even a share as can be.
    fn rays_of_pass(&self, pass: u32) -> Range<u32> {
        let first =
            |pass: u32| (u64::from(pass) * u64::from(self.rays) / u64::from(self.camera_samples)) as u32;
        first(pass)..first(pass + 1)
    }
}

/// Renders all passes into `film`.
///
/// # Errors
/// [`RenderError::Cancelled`]; what is finished is in the film.
pub fn run<E: Estimator>(
    gatherer: &Gatherer<'_, E>,
    film: &Film,
    progress: &Progress,
) -> Result<RayCounts, RenderError> {
    let passes = gatherer.camera_samples;
    let (rays, done) = (Mutex::new(RayCounts::default()), AtomicUsize::new(0));
    let tiles = film.tiles().len();
    let open = Mutex::new(Vec::new());
    for pass in 0..passes {
        progress.set_passes(pass, passes);
        let at_once = gatherer.tiles_at_once(film, pass);
        let finished = (0..tiles).step_by(at_once).try_for_each(|first| {
            let batch = first..first.saturating_add(at_once).min(tiles);
            let finished = batch.into_par_iter().try_for_each(|index| {
                let (counts, unanswered) = run_tile(gatherer, pass, film, index, progress)?;
                lock(&open).extend(unanswered);
                *lock(&rays) += counts;
                let done = done.fetch_add(1, Ordering::Relaxed) + 1;
                progress.set_fraction(done as f64 / (tiles * passes as usize) as f64);
                Ok::<(), RenderError>(())
            });
            gatherer.close(std::mem::take(&mut lock(&open)), film);
            finished
        });
        film.finish_pass(gatherer.rays_of_pass(pass).len() as u32);
        finished?;
    }
    progress.set_passes(passes, passes);
    Ok(rays.into_inner().unwrap_or_else(PoisonError::into_inner))
}

/// Counts of a tile, and the tile itself where its light is not complete.
type TileOutcome<E> = (RayCounts, Option<OpenTile<<E as Estimator>::Place>>);

fn run_tile<E: Estimator>(
    gatherer: &Gatherer<'_, E>,
    pass: u32,
    film: &Film,
    index: usize,
    progress: &Progress,
) -> Result<TileOutcome<E>, RenderError> {
    let tile = film.tiles()[index];
    let mut samples = vec![PixelSample::default(); (tile.width * tile.height) as usize];
    let mut block = Block::new(gatherer, pass);
    for y in (tile.y..tile.y + tile.height).step_by(BLOCK as usize) {
        progress.check()?;
        for x in (tile.x..tile.x + tile.width).step_by(BLOCK as usize) {
            block.run(x, y, tile, &mut samples);
        }
    }
    let (counts, deferred) = block.finish();
    if E::DEFERS {
        return Ok((counts, Some(OpenTile { index, samples, deferred })));
    }
    film.take(index, samples);
    Ok((counts, None))
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Points that the camera and its gather rays see: a pilot that decides how fine the cells are.
#[must_use]
pub fn seen_points(lit: &LitScene<'_>, seed: u32) -> Vec<Vec3> {
    const EDGE: u32 = 48;
    const GATHER_RAYS: u32 = 4;
    const MAX_DEPTH: u32 = 8;
    let camera = &lit.accel.scene().camera;
    let [left, bottom, width, height] = camera.region.map(f64::from);
    let points = (0..EDGE * EDGE).into_par_iter().flat_map_iter(|i| {
        let mut rng = Rng::new(hash(hash(u64::from(seed), 0x70_69_6c_6f_74), u64::from(i)));
        let at = DVec2::new(f64::from(i % EDGE), f64::from(i / EDGE)) + 0.5;
        let position = DVec2::new(left, bottom) + at / f64::from(EDGE) * DVec2::new(width, height);
        let (ray, _) = camera_ray(camera, lit, position);
        let mut points = Vec::new();
        if let Some(surface) = first_scatterer(lit, ray, MAX_DEPTH, &mut rng) {
            points.push(surface.p);
            for _ in 0..GATHER_RAYS {
                let sample =
                    surface.bsdf.sample(rng.draw(), rng.draw2(), LobeSet::ALL, TransportMode::Radiance);
                let ray = sample.map(|s| Ray::leaving(surface.p, surface.ng, s.wi, ray_kind(&s)));
                points
                    .extend(ray.and_then(|ray| first_scatterer(lit, ray, MAX_DEPTH, &mut rng)).map(|s| s.p));
            }
        }
        points
    });
    points.collect()
}

/// The first surface along a ray that is not only mirror, glass or transparent; lamps do not count.
fn first_scatterer<'a>(
    lit: &'a LitScene<'a>,
    mut ray: Ray,
    max_depth: u32,
    rng: &mut Rng,
) -> Option<Surface<'a>> {
    ray.mask &= !visibility::LAMP;
    for _ in 0..max_depth {
        let hit = lit.accel.intersect(&ray)?;
        let surface = lit.surface(&ray, hit);
        if rng.draw() < surface.bsdf.transparency.mean() {
            ray = Ray::leaving(surface.p, surface.ng, ray.direction, ray.mask);
        } else if surface.bsdf.has(LobeSet::NON_DELTA) {
            return Some(surface);
        } else {
            let sample =
                surface.bsdf.sample(rng.draw(), rng.draw2(), LobeSet::ALL, TransportMode::Radiance)?;
            ray = Ray::leaving(surface.p, surface.ng, sample.wi, ray_kind(&sample));
        }
    }
    None
}

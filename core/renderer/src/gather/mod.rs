//! The final gather: the picture, from the pyramid or what stands in for it.
//!
//! For each pixel, `camera_samples` points x are seen; from each, gather rays leave with density p and meet points y. The
//! radiance towards the camera is the light emitted and arriving directly at x, plus (paper, eq. 2, 3)
//! `1/N Σ f(x) cos / p · L(y)`, where L(y) is read over the footprint Ω r² with Ω = 1 / (N p).
//!
//! One pass over the picture is one camera sample of every pixel; passes are independent and their mean is the picture.
//! Even and odd passes read different photons: how much they differ says how far the picture is from its limit.

mod audit;
mod block;
mod camera;
mod catcher;
mod caustics;
mod convergence;
mod deferred;
mod direct;
mod disagreement;
mod floor;
mod lambert;
mod path;
mod pilot;
mod pyramid_lookup;
mod readable;
mod readings;
mod receive;
mod stop;
mod vertex;

use std::ops::Range;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

use crate::accel::Hit;
use crate::bsdf::{LobeSet, PreparedMaterial, Varying};
use crate::caustic_map::CausticMap;
use crate::color::Rgb;
use crate::effects_plan::Costs;
use crate::error::RenderError;
use crate::estimator::{Estimator, Path};
use crate::film::{BLOCK, Film, PixelSample};
use crate::lit_scene::LitScene;
use crate::progress::Progress;
use crate::pyramid::SETS;
use crate::sampling::{StratifiedSet, hash};
use crate::scene::Lens;
use crate::settings::{GatherSampling, RenderSettings};
use crate::stats::{RayCounts, StoppedBy};

pub use audit::Auditor;
use block::Block;
use camera::camera_width;
use catcher::CatcherTile;
use convergence::Convergence;
use deferred::{OpenTile, Traces};
use direct::Shares;
pub use disagreement::Disagreement;
pub use floor::{TraceFloor, trace_floor};
pub use pilot::{Landings, Seen, finds, landings};
pub use pyramid_lookup::PyramidLookup;
pub use readings::readings;
pub use stop::Stop;

/// One block in so many is clocked, to tell what each effect costs.
const CLOCKED: u64 = 64;

/// Gather rays of each camera sample from which on these come in one order, the same in all pixels. They are then spread over
/// all directions. Of fewer, each direction would belong to its own part of every pixel, and many parts to none.
const RAYS_IN_ORDER: u32 = 4;

/// What every gather ray needs to know.
pub struct Gatherer<'a, E> {
    lit: &'a LitScene<'a>,
    estimator: &'a E,
    /// Caustics of the photons it reads.
    caustics: Option<&'a CausticMap>,
    seed: u32,
    camera_samples: u32,
    light_samples: u32,
    rays: u32,
    max_depth: u32,
    sampling: GatherSampling,
    /// The lens that camera rays pass through, and where.
    lens: Option<&'a Lens>,
    /// Camera samples in the order of the gather rays, so that the pixel filter weighs all strata of these alike; `None` where
    /// they have an order of each pixel's own.
    camera_set: Option<StratifiedSet>,
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
    /// The same, where its light is read.
    plain_read: Vec<Option<Rgb>>,
    /// By material: it is a Lambert reflector of an albedo that varies, whose light is read.
    varying_lambert_read: Vec<bool>,
    /// Whether there is one.
    has_varying: bool,
    /// Of rays from the camera, where each unit of the window is one of angle or length.
    camera_width: Width,
    /// Checks look-ups.
    auditor: Option<&'a Auditor<'a>>,
}

fn is_varying_lambert(material: &PreparedMaterial) -> bool {
    material.varying().is_some_and(Varying::is_lambert)
}

/// How wide a ray is (scene units): `start`, and so much more per distance.
#[derive(Clone, Copy, Debug)]
struct Width {
    start: f32,
    spread: f32,
    /// Blur of the lens where the ray starts, and how it grows; below zero before it grows again.
    blur: f32,
    blur_spread: f32,
}

impl Width {
    /// That of a ray without extent.
    const NONE: Self = Self { start: 0.0, spread: 0.0, blur: 0.0, blur_spread: 0.0 };

    /// Of a ray that stands for a solid angle.
    fn of_solid_angle(solid_angle: f32) -> Self {
        Self { spread: solid_angle.sqrt(), ..Self::NONE }
    }

    fn at(self, distance: f32) -> f32 {
        self.start + self.spread * distance + (self.blur + self.blur_spread * distance).abs()
    }

    /// That of a ray that spreads so much more.
    fn spread_by(self, factor: f32) -> Self {
        Self { spread: self.spread * factor, ..self }
    }

    /// That of the ray that goes on after a distance.
    fn after(self, distance: f32) -> Self {
        Self {
            start: self.start + self.spread * distance,
            blur: self.blur + self.blur_spread * distance,
            ..self
        }
    }
}

impl<'a, E: Estimator> Gatherer<'a, E> {
    /// Prepares a gather whose rays are answered by `estimator`; `caustics` are those of lights whose caustics are made of
    /// photons.
    #[must_use]
    pub fn new(
        lit: &'a LitScene<'a>,
        estimator: &'a E,
        caustics: Option<&'a CausticMap>,
        settings: &RenderSettings,
    ) -> Self {
        let gather = &settings.gather;
        let seed = settings.render.seed;
        let set = |count: u32, salt: u64| StratifiedSet::new(count, hash(u64::from(seed), salt) as u32);
        let plain = lit.materials.iter().map(|material| {
            let albedo = material.constant_lambert().filter(|_| material.emission().is_black());
            albedo.map(|albedo| albedo * std::f32::consts::FRAC_1_PI)
        });
        let plain: Vec<Option<Rgb>> = plain.collect();
        let reads_diffuse = lit.plan.reads.intersects(LobeSet::DIFFUSE);
        let varying_lambert_read: Vec<bool> =
            lit.materials.iter().map(|material| reads_diffuse && is_varying_lambert(material)).collect();
        let camera = &lit.accel.scene().camera;
        let lens = camera.lens.as_ref().filter(|_| lit.plan.depth_of_field);
        Self {
            lit,
            estimator,
            caustics,
            seed,
            camera_samples: gather.camera_samples,
            light_samples: gather.light_samples,
            rays: gather.rays,
            max_depth: gather.max_depth.max(E::LEAST_DEPTH),
            sampling: gather.sampling,
            lens,
            camera_set: (gather.rays / gather.camera_samples >= RAYS_IN_ORDER)
                .then(|| set(gather.camera_samples, 1)),
            gather_set: set(gather.rays, 3),
            shares: Shares {
                light: (gather.camera_samples * gather.light_samples) as f32,
                bsdf: gather.rays as f32,
            },
            per_light_sample: 1.0 / gather.light_samples as f32,
            per_ray: 1.0 / gather.rays as f32,
            direct_share: gather.camera_samples as f32 / gather.rays as f32,
            widest: widest_stratum(gather.rays),
            plain_read: if reads_diffuse { plain.clone() } else { vec![None; plain.len()] },
            plain,
            has_varying: varying_lambert_read.contains(&true),
            varying_lambert_read,
            camera_width: camera_width(camera, lens, gather.camera_samples),
            auditor: None,
        }
    }

    /// The same, audited.
    #[must_use]
    pub const fn audited(mut self, auditor: Option<&'a Auditor<'a>>) -> Self {
        self.auditor = auditor;
        self
    }

    /// True where camera rays see a hole in the picture.
    fn is_holdout(&self, hit: &Hit) -> bool {
        self.lit.accel.scene().objects[hit.object as usize].is_holdout()
    }

    /// True for the blocks, at (x, y) of a pass, whose work is clocked to tell what each effect costs.
    fn is_clocked(&self, sample: u32, x: u32, y: u32) -> bool {
        let key = u64::from(sample) << 48 | u64::from(y) << 24 | u64::from(x);
        hash(u64::from(self.seed), key).is_multiple_of(CLOCKED)
    }

    /// What a gather ray of density `pdf` stands for (sr).
    #[inline(always)]
    fn solid_angle(&self, pdf: f32) -> f32 {
        (self.per_ray / pdf).min(self.widest)
    }

    /// The camera sample of a pass. Even passes go through the first half of the set and odd ones through the second, so
    /// that each half of the film has a well-spread set of its own, after any number of passes.
    const fn sample_of_pass(&self, pass: u32) -> u32 {
        let half = pass % SETS as u32;
        half * self.camera_samples.div_ceil(SETS as u32) + pass / SETS as u32
    }

    /// Gather rays that belong to a camera sample: as even a share as can be.
    fn rays_of_sample(&self, sample: u32) -> Range<u32> {
        let first =
            |sample: u32| (u64::from(sample) * u64::from(self.rays) / u64::from(self.camera_samples)) as u32;
        first(sample)..first(sample + 1)
    }
}

/// The widest solid angle a stratum of `rays` cosine-distributed rays covers: the outermost, at the horizon.
fn widest_stratum(rays: u32) -> f32 {
    std::f32::consts::TAU / (rays as f32).powf(0.75)
}

/// What a gather did.
#[derive(Clone, Copy, Debug)]
pub struct Gathered {
    /// Rays traced.
    pub rays: RayCounts,
    /// What each effect cost.
    pub costs: Costs,
    /// Why there were no more passes.
    pub stopped_by: StoppedBy,
}

/// Renders passes into `film` until `stop` is content. The passes are gathered by one and the other of `gatherers` (which
/// read different photons) by turns, and fill the film's halves by turns. `without` gathers light on shadow catchers in the
/// scene without other objects.
///
/// # Errors
/// [`RenderError::Cancelled`]; what is finished is in the film.
pub fn run<'a, E: Estimator>(
    gatherers: &[Gatherer<'a, E>; SETS],
    without: Option<&Gatherer<'a, Path>>,
    film: &Film,
    stop: Stop,
    progress: &Progress,
) -> Result<Gathered, RenderError> {
    let passes = gatherers[0].camera_samples;
    let counted = Mutex::new((RayCounts::default(), Costs::default()));
    let done = AtomicUsize::new(0);
    let tiles = film.tiles().len();
    let instructions = pulp::Arch::new();
    // Passes that are there already were made by an earlier render.
    let first = film.passes().min(passes);
    let mut convergence = Convergence::new(progress.elapsed(), first);
    let mut stopped_by = StoppedBy::Rays;
    for pass in first..passes {
        progress.set_passes(pass, passes);
        let half = pass as usize % SETS;
        let gatherer = &gatherers[half];
        let sample = gatherer.sample_of_pass(pass);
        let finished = gatherer.pass_in_batches(sample, film, |index| {
            let (rays, costs, open) =
                instructions.dispatch(TileWork { gatherer, without, sample, film, index, progress })?;
            let mut counted = counted.lock().unwrap_or_else(PoisonError::into_inner);
            counted.0 += rays;
            counted.1 += costs;
            drop(counted);
            let done = done.fetch_add(1, Ordering::Relaxed) + 1;
            let share = done as f64 / (tiles * (passes - first) as usize) as f64;
            progress.set_fraction(stop.fraction(share, progress.elapsed()));
            Ok(open)
        });
        film.finish_pass(gatherer.rays_of_sample(sample).len() as u32, half, finished.is_ok());
        if let Some(auditor) = gatherer.auditor {
            auditor.finish_pass(gatherer.rays_of_sample(sample).len() as u64);
        }
        finished?;
        if half + 1 == SETS {
            convergence.add(pass + 1, progress.elapsed(), film.picture_error());
            progress.set_outlook(convergence.outlook(passes, &stop));
        }
        if let Some(reason) =
            stop.reason(&convergence, pass + 1, progress.elapsed()).filter(|_| pass + 1 < passes)
        {
            stopped_by = reason;
            progress.set_passes(pass + 1, pass + 1);
            break;
        }
        progress.set_passes(pass + 1, passes);
    }
    progress.set_fraction(1.0);
    let (rays, costs) = counted.into_inner().unwrap_or_else(PoisonError::into_inner);
    Ok(Gathered { rays, costs, stopped_by })
}

/// A tile of a pass, for whichever vector instructions this processor has.
struct TileWork<'w, 'a, E> {
    gatherer: &'w Gatherer<'a, E>,
    /// Gathers light on shadow catchers, if there are any.
    without: Option<&'w Gatherer<'a, Path>>,
    /// Number of the camera sample.
    sample: u32,
    film: &'w Film,
    index: usize,
    progress: &'w Progress,
}

impl<E: Estimator> pulp::NullaryFnOnce for TileWork<'_, '_, E> {
    /// What was counted, and the tile itself where its light is not complete.
    type Output = Result<(RayCounts, Costs, Option<OpenTile<E::Place>>), RenderError>;

    // What is inlined into this function, and only that, is compiled for the wider instructions.
    #[inline(always)]
    fn call(self) -> Self::Output {
        let tile = self.film.tiles()[self.index];
        let mut samples = vec![PixelSample::default(); (tile.width * tile.height) as usize];
        let mut block = Block::new(self.gatherer, self.sample);
        let mut catchers = self.without.map(|without| CatcherTile::new(without, self.sample, tile));
        for y in (tile.y..tile.y + tile.height).step_by(BLOCK as usize) {
            self.progress.check()?;
            for x in (tile.x..tile.x + tile.width).step_by(BLOCK as usize) {
                block.run(x, y, tile, &mut samples);
                if let Some(catchers) = &mut catchers {
                    catchers.light(&mut block, x, y);
                }
            }
        }
        let Traces { mut rays, deferred, mut meter, audited } = block.finish();
        if let Some(catchers) = catchers {
            let (caught, rays_of_catchers, costs) = catchers.finish();
            self.film.take_catchers(self.index, caught);
            rays += rays_of_catchers;
            meter.costs += costs;
        }
        if let Some(auditor) = self.gatherer.auditor {
            auditor.take(self.index, audited);
        }
        if E::DEFERS {
            return Ok((rays, meter.costs, Some(OpenTile { index: self.index, samples, deferred })));
        }
        self.film.take(self.index, samples);
        Ok((rays, meter.costs, None))
    }
}

//! The order of everything.

mod aim;
mod baselines;
mod caustics;
mod fingerprint;
mod memory;
mod surroundings;

use std::path;
use std::time::Instant;

use glam::{DVec3, Vec3};

use crate::accel::Accel;
use crate::bsdf::{MaterialTable, PreparedMaterial};
use crate::effects_plan::{Effect, EffectsPlan};
use crate::error::RenderError;
use crate::estimator::{Estimator, Path, PhotonSink};
use crate::film::Film;
use crate::gather::{self, Auditor, Gatherer, PyramidLookup, Stop, TraceFloor};
use crate::light::{Environment, Lights};
use crate::lit_scene::LitScene;
use crate::photon_pass::{self, Carry, PhotonPass, PhotonPilot, PyramidDeposits};
use crate::progress::{Progress, Stage};
use crate::pyramid::{
    Accumulator, DirectionBins, Grid, Layout, NormalClasses, PilotLandings, Pyramid, Reading, SETS,
};
use crate::scene::Scene;
use crate::settings::{EstimatorKind, RenderSettings, Switch, parse_bins};
use crate::shader::Texture;
use crate::stats::{EstimatorStats, Stats, TextureCounts};

pub use fingerprint::fingerprint;
use memory::Budget;
pub use memory::check_memory;
use surroundings::SceneSurroundings;

/// Renders `scene` into `film`, with Embree from the file `library`. `stats` grows as passes end, so that it is worth
/// reading after a cancel too.
///
/// # Errors
/// Embree missing or out of memory; [`RenderError::Cancelled`], after which the film holds what was finished.
pub fn render(
    scene: &Scene,
    settings: &RenderSettings,
    library: &path::Path,
    film: &Film,
    progress: &Progress,
    stats: &mut Stats,
) -> Result<(), RenderError> {
    let began = Instant::now();
    let result = threads(settings)?.install(|| passes(scene, settings, library, film, progress, stats));
    stats.nonfinite_pixels = film.nonfinite();
    stats.passes = progress.snapshot().passes_done;
    stats.seconds.total = began.elapsed().as_secs_f64();
    result
}

/// Traces the gather rays of a render one by one, without shading: the time no gather of single rays can beat.
///
/// # Errors
/// As [`render`].
pub fn trace_floor(
    scene: &Scene,
    settings: &RenderSettings,
    library: &path::Path,
) -> Result<TraceFloor, RenderError> {
    let progress = Progress::default();
    let [_, _, width, height] = scene.camera.region;
    let film = Film::new(width, height, &settings.film);
    threads(settings)?.install(|| {
        let lit = light(scene, &MaterialTable::build(&scene.materials), settings, library, &progress)?;
        Ok(gather::trace_floor(&Gatherer::new(&lit, &Path, None, settings), &film))
    })
}

fn threads(settings: &RenderSettings) -> Result<rayon::ThreadPool, RenderError> {
    let builder = rayon::ThreadPoolBuilder::new().num_threads(settings.render.threads as usize);
    builder.build().map_err(|e| RenderError::Internal(format!("no threads: {e}")))
}

fn passes(
    scene: &Scene,
    settings: &RenderSettings,
    library: &path::Path,
    film: &Film,
    progress: &Progress,
    stats: &mut Stats,
) -> Result<(), RenderError> {
    progress.enter(Stage::Accel);
    let clock = Instant::now();
    stats.textures = TextureCounts {
        images: scene.textures.len(),
        bytes: scene.textures.iter().map(Texture::bytes).sum(),
    };
    let materials = MaterialTable::build(&scene.materials);
    let told = materials.problems.iter().map(|p| format!("material '{}': {}", p.subject, p.message));
    stats.warnings.extend(told);
    let mut lit = light(scene, &materials, settings, library, progress)?;
    let catchers = lit.plan.shadow_catcher.then(|| scene.without_objects());
    let without =
        catchers.as_ref().map(|catchers| light_without(catchers, &materials, settings, library, progress));
    let without = without.transpose()?;
    stats.seconds.accel = clock.elapsed().as_secs_f64();
    stats.effects = lit.plan.report();
    if let Some(without) = &without {
        film.expect_catchers(scene.world.film_transparent);
        let [_, _, width, height] = scene.camera.region;
        let film_bytes = Film::catcher_bytes_for(width, height) as usize;
        let lights = &without.lights;
        let bytes = film_bytes + lights.bytes() + lights.emitter_bytes() + lights.world_bytes();
        stats.effects[Effect::ShadowCatcher as usize].bytes = bytes;
    }
    if lit.plan.direct {
        stats.effects[Effect::DirectLight as usize].bytes = lit.lights.bytes();
    }
    if lit.plan.motion_blur {
        stats.effects[Effect::MotionBlur as usize].bytes = scene.motion_bytes();
    }
    stats.effects[Effect::EnvironmentLight as usize].bytes = lit.lights.world_bytes();
    stats.effects[Effect::EmissiveMeshes as usize].bytes = lit.lights.emitter_bytes();

    let (rays, seed) = (settings.gather.rays, settings.render.seed);
    let seen = if lit.plan.indirect() { gather::readings(&lit, rays, seed) } else { Vec::new() };
    stats.aim = aim::aim(&mut lit, &seen, settings);
    progress.check()?;
    let work = Work { lit: &lit, without: without.as_ref(), seen: &seen, settings, film, progress };
    match settings.gather.estimator {
        EstimatorKind::Pyramid => work.pyramid(stats),
        EstimatorKind::Pyramid2006 => work.pyramid_2006(stats),
        EstimatorKind::PhotonMap => work.photon_map(stats),
        EstimatorKind::PrecomputedIrradiance => work.precomputed_irradiance(stats),
        EstimatorKind::UniformGrid => work.uniform_grid(stats),
        EstimatorKind::ReversePhotonMap => work.reverse_photon_map(stats),
        EstimatorKind::Path => work.path(stats),
    }
}

/// The pilot traces one photon in so many.
const PILOT_SHARE: u64 = 64;

/// The passes over a scene that is ready to be traced.
struct Work<'a> {
    lit: &'a LitScene<'a>,
    /// The scene without what is not a shadow catcher, where there is one.
    without: Option<&'a LitScene<'a>>,
    /// Points that the camera and its gather rays see.
    seen: &'a [Reading],
    settings: &'a RenderSettings,
    film: &'a Film,
    progress: &'a Progress,
}

impl Work<'_> {
    /// Photons into the pyramid, and the picture from it.
    fn pyramid(&self, stats: &mut Stats) -> Result<(), RenderError> {
        let Work { lit, settings, progress, .. } = *self;
        progress.enter(Stage::Layout);
        let clock = Instant::now();
        let [elevation, azimuth] = parse_bins(&settings.pyramid.bins)?;
        let bins = lit.plan.direction_bins().then_some(DirectionBins { elevation, azimuth });
        let wanted = settings.pyramid.finest_resolution;
        let surroundings = SceneSurroundings::new(lit, progress);
        let classes = NormalClasses::of_setting(&settings.pyramid.normal_classes);
        let measure = |resolution| {
            Layout::new(self.grid(resolution)?, classes, &surroundings).ok_or(RenderError::Cancelled)
        };
        let budget = Budget::new(lit.accel.scene(), settings)?.less(self.caustic_bytes());
        let (layout, resolution) = budget.fit(wanted, bins, measure)?;
        if resolution < wanted {
            stats.warnings.push(format!("the memory limit allows {resolution} cells instead of {wanted}"));
        }
        stats.pyramid.cell_size =
            f64::from(layout.grid.levels[layout.grid.finest()].cell_size) / lit.accel.scene().space.scale;
        stats.seconds.pyramid = clock.elapsed().as_secs_f64();
        progress.check()?;

        // A single pass has nothing to be compared with and reads all photons.
        let sets = SETS.min(settings.gather.camera_samples as usize);
        let accumulator = Accumulator::new(&layout, lit.lights.total_flux().max_channel(), bins);
        self.photons(&PyramidDeposits::new(&accumulator), sets, stats)?;
        stats.photons.deposited = accumulator.deposited();
        stats.photons.lost = accumulator.lost();

        progress.enter(Stage::Pyramid);
        let clock = Instant::now();
        stats.pyramid.build_bytes = layout.bytes() + accumulator.bytes();
        let build_bin_bytes = accumulator.bin_bytes();
        let pyramid = Pyramid::build(accumulator, &layout, settings.pyramid.photons_per_cell, &surroundings)
            .ok_or(RenderError::Cancelled)?;
        drop(layout);
        stats.pyramid.levels = pyramid.level_count();
        stats.pyramid.cells = pyramid.cell_count();
        stats.pyramid.bytes = pyramid.bytes();
        stats.pyramid.glossy_cells = pyramid.glossy_cell_count();
        stats.pyramid.bins = bins.map_or(0, DirectionBins::count);
        stats.seconds.pyramid += clock.elapsed().as_secs_f64();
        self.charge_pyramid(&pyramid, build_bin_bytes, stats);
        stats.estimator =
            EstimatorStats { name: "pyramid", bytes: stats.pyramid.bytes, seconds: stats.seconds.pyramid };
        let lookup = |set| PyramidLookup::new(pyramid.view(set), settings.gather.retrace_distance);
        let lookups: [_; SETS] = std::array::from_fn(lookup);
        self.gather(lookups.each_ref(), Some(&pyramid), stats)
    }

    /// Cells as fine as what the camera and its gather rays see asks for, `resolution` of them along its longest side.
    fn grid(&self, resolution: u32) -> Result<Grid, RenderError> {
        let scene = self.lit.accel.scene();
        let bounds = scene.bounds.map(Vec3::as_dvec3);
        let world_origin = -scene.space.center * scene.space.scale;
        let mut grid = Grid::new(seen_bounds(self.seen, scene.bounds), bounds, resolution, world_origin);
        let landings = self.pilot_landings(&grid)?;
        grid.refine(self.seen, &landings, self.settings.pyramid.adaptive_levels);
        Ok(grid)
    }

    /// Where photons will be plenty, for cells that are finer there.
    fn pilot_landings(&self, grid: &Grid) -> Result<PilotLandings, RenderError> {
        let Work { lit, settings, progress, .. } = *self;
        let count = settings.photon_pass.photon_count / PILOT_SHARE;
        if settings.pyramid.adaptive_levels == 0 || count == 0 {
            return Ok(PilotLandings::default());
        }
        let landings = PhotonPilot::new(grid);
        let pass = PhotonPass {
            carry: Carry::All,
            count,
            max_depth: settings.photon_pass.max_depth,
            seed: settings.render.seed,
            sets: 1,
        };
        photon_pass::run(lit, pass, &landings, progress)?;
        let each = settings.photon_pass.photon_count as f64 / count as f64;
        let enough = f64::from(Pyramid::photons_to_divide(settings.pyramid.photons_per_cell));
        Ok(PilotLandings { counts: landings.counts(), each, enough })
    }

    /// Charges the pyramid to the effects that are read from it: bins to the glossy, all else to indirect light in general.
    fn charge_pyramid(&self, pyramid: &Pyramid, build_bin_bytes: usize, stats: &mut Stats) {
        if !self.lit.plan.indirect() {
            return;
        }
        let bins_seconds =
            if self.lit.plan.direction_bins() { pyramid.bins_time().as_secs_f64() } else { 0.0 };
        let cell_bytes =
            (stats.pyramid.build_bytes - build_bin_bytes).max(pyramid.bytes() - pyramid.bin_bytes());
        let bins = &mut stats.effects[Effect::IndirectGlossy as usize];
        bins.seconds += bins_seconds;
        bins.bytes += build_bin_bytes.max(pyramid.bin_bytes());
        let cells = &mut stats.effects[self.lit.plan.indirect_owner() as usize];
        cells.seconds += stats.seconds.pyramid - bins_seconds;
        cells.bytes += cell_bytes;
    }

    /// Traces the photons, dealt into `sets` sets.
    fn photons(&self, sink: &impl PhotonSink, sets: usize, stats: &mut Stats) -> Result<(), RenderError> {
        self.progress.enter(Stage::PhotonPass);
        let clock = Instant::now();
        let (settings, seed) = (&self.settings.photon_pass, self.settings.render.seed);
        let (count, max_depth) = (settings.photon_count, settings.max_depth);
        let pass = PhotonPass { carry: Carry::All, count, max_depth, seed, sets };
        let counts = photon_pass::run(self.lit, pass, sink, self.progress)?;
        stats.photons.emitted = counts.emitted;
        stats.rays.photon += counts.segments;
        stats.seconds.photon_pass = clock.elapsed().as_secs_f64() + stats.aim.map_or(0.0, |aim| aim.seconds);
        counts.costs.charge(&mut stats.effects, stats.seconds.photon_pass);
        Ok(())
    }

    /// Makes the picture; even and odd passes ask one estimator each. What is read from `audited` is checked.
    fn gather<E: Estimator>(
        &self,
        estimators: [&E; SETS],
        audited: Option<&Pyramid>,
        stats: &mut Stats,
    ) -> Result<(), RenderError> {
        let Work { lit, settings, .. } = *self;
        let maps = self.caustics(SETS.min(settings.gather.camera_samples as usize), stats)?;
        self.progress.enter(Stage::Gather);
        let clock = Instant::now();
        let auditor = audited.and_then(|pyramid| Auditor::new(lit, pyramid, maps.first(), settings));
        let gatherers = std::array::from_fn(|half| {
            let caustics = maps.get(half).or(maps.first());
            Gatherer::new(lit, estimators[half], caustics, settings).audited(auditor.as_ref())
        });
        let stop = Stop::new(&self.settings.gather, self.progress.elapsed());
        let without = self.without.map(|without| Gatherer::new(without, &Path, None, settings));
        let gathered = gather::run(&gatherers, without.as_ref(), self.film, stop, self.progress);
        stats.error = self.film.picture_error();
        stats.seconds.gather = clock.elapsed().as_secs_f64();
        if let Some(auditor) = &auditor {
            let [width, height] = self.film.size();
            let (audit, disagreement) = auditor.result(width * height, self.film.mean());
            stats.audit = Some(audit);
            self.film.set_audit(disagreement.picture(lit, settings.render.seed));
        }
        let gathered = gathered?;
        gathered.costs.charge(&mut stats.effects, stats.seconds.gather);
        stats.rays += gathered.rays;
        stats.stopped_by = gathered.stopped_by;
        Ok(())
    }
}

/// Materials, lights, tree and plan.
fn light<'a>(
    scene: &'a Scene,
    materials: &MaterialTable,
    settings: &RenderSettings,
    library: &path::Path,
    progress: &Progress,
) -> Result<LitScene<'a>, RenderError> {
    let mut materials: Vec<PreparedMaterial> = materials.iter().cloned().collect();
    let mut world = scene.world.clone();
    let environment = if settings.effects.environment_light == Switch::Off {
        None
    } else {
        Environment::new(&world, &scene.textures)
    };
    if environment.is_none() && world.program.is_some() && settings.effects.environment_light != Switch::Off {
        world.blacken();
    }
    let plan = EffectsPlan::new(scene, &settings.effects, &mut materials, &mut world);
    let emission: Vec<_> = materials.iter().map(PreparedMaterial::emission).collect();
    let mut lights = Lights::with_world(scene, &emission, &world, environment);
    // The reference stays free of photons: it finds caustics as rays do.
    let by_photons = plan.has_casters && settings.gather.estimator != EstimatorKind::Path;
    if let Some(casters) = by_photons.then(|| caustics::casters(scene, &materials)).flatten() {
        lights.map_caustics(casters, settings.photon_pass.caustic_solid_angle as f32);
    }
    let proxies = lights.lamp_proxies();
    let threads = settings.render.threads as usize;
    let accel = Accel::build(scene, &proxies, plan.motion_blur, library, threads, progress)?;
    Ok(LitScene { accel, materials, lights, plan })
}

/// As [`light`], for a scene whose light is gathered without photons.
fn light_without<'a>(
    scene: &'a Scene,
    materials: &MaterialTable,
    settings: &RenderSettings,
    library: &path::Path,
    progress: &Progress,
) -> Result<LitScene<'a>, RenderError> {
    let mut settings = settings.clone();
    settings.gather.estimator = EstimatorKind::Path;
    light(scene, materials, &settings, library, progress)
}

/// Points beyond this share on either side do not decide how fine the cells are.
const OUTLIERS: f64 = 0.02;

/// The box is widened by this share of its width: the pilot sees points, not extents.
const MARGIN: f64 = 0.1;

/// A box around most of the points, within the scene's bounds.
fn seen_bounds(readings: &[Reading], bounds: [Vec3; 2]) -> [DVec3; 2] {
    let bounds = bounds.map(Vec3::as_dvec3);
    if readings.is_empty() {
        return bounds;
    }
    let (mut low, mut high) = (DVec3::ZERO, DVec3::ZERO);
    for axis in 0..3 {
        let mut values: Vec<f32> = readings.iter().map(|reading| reading.p[axis]).collect();
        values.sort_by(f32::total_cmp);
        let skipped = (values.len() as f64 * OUTLIERS) as usize;
        low[axis] = f64::from(values[skipped]);
        high[axis] = f64::from(values[values.len() - 1 - skipped]);
    }
    let margin = (high - low).max_element() * MARGIN;
    let (low, high) = ((low - margin).max(bounds[0]), (high + margin).min(bounds[1]));
    [low.min(high), low.max(high)]
}

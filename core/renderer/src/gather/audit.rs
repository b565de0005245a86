//! The auditor: one gather hit in so many is followed along an ordinary path to its end, beside the look-up that the picture
//! takes. The mean difference is how far the pyramid is off in this picture: the blur and the leaks of its cells, and what
//! their photons have in common.
//!
//! It draws numbers and traces rays of its own, so that no pixel changes.

use std::sync::{Mutex, PoisonError};

use super::block::Block;
use super::caustics::Mapped;
use super::deferred::{Target, Traces};
use super::disagreement::{Disagreement, Hits};
use super::path::Sampled;
use super::vertex::GatherRay;
use super::{Gatherer, PyramidLookup, Shares, Width};
use crate::accel::{Hit, LANES, Ray};
use crate::caustic_map::CausticMap;
use crate::color::Rgb;
use crate::estimator::{Estimator, Footprint, Path};
use crate::lit_scene::{LitScene, Medium};
use crate::pyramid::{Place, Pyramid};
use crate::sampling::{Rng, hash};
use crate::settings::RenderSettings;
use crate::stats::AuditStats;

/// Standard errors to either side within which 95 % of all measurements lie.
const CONFIDENCE: f64 = 1.96;

/// What was read for a gather hit and what a path found there, as the camera sees it.
#[derive(Clone, Copy, Debug)]
pub(super) struct AuditedHit {
    /// Where the look-up was; `None` where the hit was followed or is no surface.
    place: Option<Place>,
    read: f32,
    found: f32,
}

/// Follows hits and compares.
pub struct Auditor<'a> {
    follower: Gatherer<'a, Path>,
    pyramid: &'a Pyramid,
    lookup: PyramidLookup<'a>,
    /// One packet of gather rays in so many has a lane that is audited.
    packets: u64,
    /// Hits of the pass under way, by tile.
    pass: Mutex<Vec<(usize, Vec<AuditedHit>)>>,
    sums: Mutex<Sums>,
}

#[derive(Debug, Default)]
struct Sums {
    /// Gather rays a pixel.
    rays_per_pixel: u64,
    hits: u64,
    /// Of read − found, and of its square.
    difference: f64,
    square: f64,
    cells: Hits,
}

impl<E: Estimator> Block<'_, '_, E> {
    /// Has what the gather ray of a lane brought checked; `before` is the lane's indirect light without it.
    #[inline(never)]
    pub(super) fn audit(&mut self, lane: usize, pdf: f32, index: u32, before: Rgb) {
        let g = self.gatherer;
        let Some(auditor) = g.auditor.filter(|_| self.packet.is_set(lane)) else { return };
        let Some(hit) = self.packet.hit(lane) else { return };
        let gather_ray = match self.others[lane] {
            Some(ray) => ray,
            None => GatherRay::diffuse(self.lambert.weight[lane], Some(pdf)),
        };
        let solid_angle = gather_ray.pdf.map_or(0.0, |pdf| g.solid_angle(pdf));
        let read = self.samples[lane].indirect - before;
        let key = hash(self.keys[lane], u64::from(index) << 16 | 6);
        let mapped = self.share_of_mapped(lane, &gather_ray);
        let audited = auditor.follow(
            (self.packet.ray(lane), hit, self.medium(lane)),
            &gather_ray,
            solid_angle,
            mapped,
            read,
            key,
        );
        self.traces.audited.push(audited);
    }
}

impl<'a> Auditor<'a> {
    /// An auditor of the look-ups in `pyramid`; `None` where the settings want none.
    #[must_use]
    pub fn new(
        lit: &'a LitScene<'a>,
        pyramid: &'a Pyramid,
        caustics: Option<&'a CausticMap>,
        settings: &RenderSettings,
    ) -> Option<Self> {
        let packets = u64::from(settings.gather.audit).div_ceil(LANES as u64);
        (packets > 0 && lit.plan.follows()).then(|| Self {
            follower: Gatherer::new(lit, &Path, caustics, settings),
            pyramid,
            lookup: PyramidLookup::new(pyramid.view(0), settings.gather.retrace_distance),
            packets,
            pass: Mutex::default(),
            sums: Mutex::default(),
        })
    }

    /// The lane of a packet that is audited, if one is: any lane of any packet is as likely.
    #[inline(always)]
    pub(super) fn lane(&self, key: u64, index: u32) -> Option<usize> {
        let drawn = hash(key, u64::from(index) << 16 | 5);
        let lane = (drawn >> 60) as usize % LANES;
        (drawn & 0xFFFF_FFFF_FFFF).is_multiple_of(self.packets).then_some(lane)
    }

    /// Follows the hit of a gather ray, which starts in a medium, for which the picture took `read`.
    #[inline(never)]
    pub(super) fn follow(
        &self,
        (ray, hit, medium): (Ray, Hit, Medium),
        gather_ray: &GatherRay,
        solid_angle: f32,
        mapped: Mapped,
        read: Rgb,
        key: u64,
    ) -> AuditedHit {
        let g = &self.follower;
        let (mut rng, mut traces, mut end) = (Rng::new(key), Traces::default(), None);
        let width = Width::of_solid_angle(solid_angle);
        // What the ray meets on its way belongs to the direct light; it is the same for both.
        let sampled = Sampled {
            pdf: gather_ray.pdf,
            shares: Shares::EVEN,
            kind: gather_ray.kind,
            light: None,
            lit_side: None,
            sets: u32::MAX,
            width,
            mapped: Rgb::WHITE,
            moved: 0.0,
            medium,
        };
        let met = g.meet(ray, Some(Some(hit)), sampled, &mut rng, &mut traces.meter, &mut end);
        let footprint = Footprint { solid_angle, travelled: met.distance, sharp: gather_ray.sharp };
        let place = end.as_ref().filter(|_| !gather_ray.sharp).and_then(|surface| {
            let at_rest = g.lit.moves(surface.hit.object).then(|| g.lit.at_rest(surface).0);
            let surface = at_rest.as_ref().unwrap_or(surface);
            self.lookup.place(surface.p, surface.bsdf.frame.side(), surface.bsdf.wo(), footprint)
        });
        let target = Target { traces: &mut traces, lane: 0, weight: Rgb::WHITE };
        let found =
            gather_ray.weight * met.through * g.outgoing(&mut end, footprint, mapped, &mut rng, target);
        AuditedHit { place, read: read.mean(), found: found.mean() }
    }

    /// Takes the hits of a tile.
    pub(super) fn take(&self, tile: usize, hits: Vec<AuditedHit>) {
        if !hits.is_empty() {
            lock(&self.pass).push((tile, hits));
        }
    }

    /// Adds the hits of a pass of so many rays a pixel, tile by tile, whichever came first.
    pub(super) fn finish_pass(&self, rays_per_pixel: u64) {
        let mut tiles = std::mem::take(&mut *lock(&self.pass));
        tiles.sort_unstable_by_key(|(tile, _)| *tile);
        let sums = &mut *lock(&self.sums);
        sums.rays_per_pixel += rays_per_pixel;
        for hit in tiles.into_iter().flat_map(|(_, hits)| hits) {
            let [read, found] = [hit.read, hit.found].map(f64::from);
            if !(read.is_finite() && found.is_finite()) {
                continue;
            }
            sums.hits += 1;
            sums.difference += read - found;
            sums.square += (read - found).powi(2);
            if let Some(place) = hit.place {
                sums.cells.add(self.pyramid.cells_around(place), read, found);
            }
        }
    }

    /// What was found, for a picture of `pixels` pixels whose mean is `mean`; and the cells that disagree, to be drawn.
    #[must_use]
    pub fn result(&self, pixels: usize, mean: f64) -> (AuditStats, Disagreement<'a>) {
        let sums = lock(&self.sums);
        let space = &self.follower.lit.accel.scene().space;
        let disagreement = sums.cells.disagreement(self.pyramid);
        let total = sums.rays_per_pixel as f64 * pixels as f64 * mean;
        let hits_per_audited = (self.packets * LANES as u64) as f64;
        let percent = if total > 0.0 { 100.0 * hits_per_audited / total } else { 0.0 };
        let stats = AuditStats {
            hits: sums.hits,
            bias: percent * sums.difference,
            interval: percent * CONFIDENCE * sums.square.sqrt(),
            cells_tested: sums.cells.tested(),
            cells_disagreeing: disagreement.len(),
            cells: disagreement.list(space),
        };
        (stats, disagreement)
    }
}

fn lock<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

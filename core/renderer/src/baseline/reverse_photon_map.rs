//! Reverse photon mapping (Havran, Herzog, Seidel 2005, "Fast Final Gathering via Reverse Photon Mapping"): gather hits
//! are collected and put in a tree of their own, and photons look for the hits near them.
//!
//! Each photon spreads its flux over a disk of its own that holds k photons; those of one leaf of the photons' tree share
//! one radius. Leaves go down the tree of the hits together. Diffuse light only: a glossy surface counts as a diffuse one of
//! the same albedo.

use std::f32::consts::FRAC_1_PI;
use std::sync::atomic::{AtomicUsize, Ordering};

use glam::Vec3;
use rayon::prelude::*;

use super::photon_map::PhotonMap;
use super::photon_store::Photons;
use crate::color::Rgb;
use crate::estimator::{Estimator, Footprint};
use crate::math::Side;
use crate::neighbors::LEAF;

/// Hits that are not split any more.
const HITS: usize = 32;

/// Below this many hits a subtree is done on one thread.
const PARALLEL: usize = 4096;

/// A leaf of the photons' tree.
#[derive(Clone, Copy, Debug)]
struct Group {
    /// Box of all that its photons reach.
    low: Vec3,
    high: Vec3,
    squared_radius: f32,
}

impl Group {
    fn reaches(&self, low: Vec3, high: Vec3) -> bool {
        (self.low.cmple(high) & self.high.cmpge(low)).all()
    }
}

/// A gather hit and the light that has been found for it.
#[derive(Clone, Copy, Debug)]
struct Hit {
    p: Vec3,
    ng: Vec3,
    irradiance: Rgb,
    /// In the batch.
    number: u32,
}

/// Photons that look for hits.
#[derive(Debug)]
pub struct ReversePhotonMap {
    map: PhotonMap,
    groups: Vec<Group>,
    largest_batch: AtomicUsize,
    /// The vector instructions this processor has.
    instructions: pulp::Arch,
}

impl ReversePhotonMap {
    /// The tree of the photons and the disks of its leaves, which hold `k` photons.
    #[must_use]
    pub fn new(photons: &Photons, k: u32) -> Self {
        let map = PhotonMap::new(photons, k);
        let group = |first: usize| {
            let points = || (first..(first + LEAF).min(map.len())).map(|place| map.photon(place).0);
            let squared_radius = map.squared_radius(map.photon(first + points().count() / 2).0);
            let reach = Vec3::splat(squared_radius.sqrt());
            Group {
                low: points().fold(Vec3::INFINITY, Vec3::min) - reach,
                high: points().fold(Vec3::NEG_INFINITY, Vec3::max) + reach,
                squared_radius,
            }
        };
        let groups = (0..map.len().div_ceil(LEAF)).into_par_iter().map(|leaf| group(leaf * LEAF)).collect();
        Self { map, groups, largest_batch: AtomicUsize::new(0), instructions: pulp::Arch::new() }
    }

    /// Memory (bytes), with the hits of the largest batch so far.
    #[must_use]
    pub fn bytes(&self) -> usize {
        let hits = self.largest_batch.load(Ordering::Relaxed);
        self.map.bytes() + self.groups.len() * size_of::<Group>() + hits * size_of::<Hit>()
    }

    /// Adds the light of `groups` to the hits of one branch of their tree.
    fn descend(&self, hits: &mut [Hit], groups: &[u32]) {
        let low = hits.iter().fold(Vec3::INFINITY, |low, hit| low.min(hit.p));
        let high = hits.iter().fold(Vec3::NEG_INFINITY, |high, hit| high.max(hit.p));
        let near = |&number: &u32| self.groups[number as usize].reaches(low, high);
        let groups: Vec<u32> = groups.iter().copied().filter(near).collect();
        if hits.len() <= HITS {
            self.instructions.dispatch(
                #[inline(always)]
                || self.splat(hits, &groups, low, high),
            );
            return;
        }
        let axis = (high - low).max_position();
        let by_axis = |a: &Hit, b: &Hit| a.p[axis].total_cmp(&b.p[axis]).then(a.number.cmp(&b.number));
        let half = hits.len() / 2;
        hits.select_nth_unstable_by(half, by_axis);
        let parallel = hits.len() >= PARALLEL;
        let (lower, upper) = hits.split_at_mut(half);
        if parallel {
            rayon::join(|| self.descend(lower, &groups), || self.descend(upper, &groups));
        } else {
            self.descend(lower, &groups);
            self.descend(upper, &groups);
        }
    }

    /// Adds the light of the photons of `groups` to a few hits, which lie in the box from `low` to `high`.
    #[inline(always)]
    fn splat(&self, hits: &mut [Hit], groups: &[u32], low: Vec3, high: Vec3) {
        let mut p = [[f32::INFINITY; HITS]; 3];
        let mut ng = [[0.0; HITS]; 3];
        let mut sums = [[0.0; HITS]; 3];
        for (i, hit) in hits.iter().enumerate() {
            for axis in 0..3 {
                (p[axis][i], ng[axis][i]) = (hit.p[axis], hit.ng[axis]);
            }
        }
        for &number in groups {
            let squared_radius = self.groups[number as usize].squared_radius;
            let first = number as usize * LEAF;
            for place in first..(first + LEAF).min(self.map.len()) {
                let (at, flux, wi) = self.map.photon(place);
                if at.clamp(low, high).distance_squared(at) >= squared_radius {
                    continue;
                }
                let per_area = flux * (FRAC_1_PI / squared_radius);
                for i in 0..HITS {
                    let (x, y, z) = (p[0][i] - at.x, p[1][i] - at.y, p[2][i] - at.z);
                    let cos = ng[0][i] * wi.x + ng[1][i] * wi.y + ng[2][i] * wi.z;
                    let lit = (x * x + y * y + z * z < squared_radius) & (cos > 0.0);
                    for (sum, c) in sums.iter_mut().zip(per_area.0) {
                        sum[i] += if lit { c } else { 0.0 };
                    }
                }
            }
        }
        for (i, hit) in hits.iter_mut().enumerate() {
            hit.irradiance = Rgb(sums.map(|sum| sum[i]));
        }
    }
}

impl Estimator for ReversePhotonMap {
    /// Position and normal.
    type Place = (Vec3, Vec3);

    const DEFERS: bool = true;

    #[inline]
    fn place(&self, p: Vec3, side: Side, _wo: Vec3, footprint: Footprint) -> Option<(Vec3, Vec3)> {
        (!footprint.sharp).then_some((p, side.normal))
    }

    fn read(&self, place: &(Vec3, Vec3)) -> Option<Rgb> {
        self.answer(std::slice::from_ref(place)).pop()
    }

    fn answer(&self, places: &[(Vec3, Vec3)]) -> Vec<Rgb> {
        self.largest_batch.fetch_max(places.len(), Ordering::Relaxed);
        #[expect(clippy::cast_possible_truncation, reason = "batches are bounded")]
        let hit = |(number, &(p, ng))| Hit { p, ng, irradiance: Rgb::BLACK, number: number as u32 };
        let mut hits: Vec<Hit> = places.iter().enumerate().map(hit).collect();
        #[expect(clippy::cast_possible_truncation, reason = "photons are numbered in 32 bits")]
        let groups: Vec<u32> = (0..self.groups.len() as u32).collect();
        self.descend(&mut hits, &groups);
        let mut answers = vec![Rgb::BLACK; places.len()];
        for hit in hits {
            answers[hit.number as usize] = hit.irradiance;
        }
        answers
    }
}

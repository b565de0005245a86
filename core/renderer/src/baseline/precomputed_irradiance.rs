//! Irradiance precomputed at some photons and read from the nearest of them (Christensen 1999, "Faster Photon Map Global
//! Illumination"). Diffuse light only: a glossy surface counts as a diffuse one of the same albedo.

use glam::Vec3;
use rayon::prelude::*;

use super::photon_map::PhotonMap;
use super::photon_store::{Photon, Photons};
use crate::color::Rgb;
use crate::estimator::{Estimator, Footprint};
use crate::math::Side;
use crate::neighbors::{KdTree, Octahedral, Visitor};

/// Of this many photons one has an irradiance.
const SHARE: usize = 4;

/// Irradiance farther away is not read (scene units).
const MAX_RADIUS: f32 = 0.1;

/// Least cosine between normals that count as alike (Christensen's).
const LEAST_COSINE: f32 = 0.9;

#[derive(Clone, Copy, Debug)]
struct Record {
    irradiance: [f32; 3],
    ng: Octahedral,
}

/// Irradiance here and there.
#[derive(Debug)]
pub struct PrecomputedIrradiance {
    tree: KdTree,
    /// By place in the tree.
    records: Vec<Record>,
}

impl PrecomputedIrradiance {
    /// Computes the irradiance at every fourth photon from the `k` nearest.
    #[must_use]
    pub fn new(photons: &Photons, k: u32) -> Self {
        let map = PhotonMap::new(photons, k);
        let chosen: Vec<&Photon> = photons.0.iter().step_by(SHARE).collect();
        let (tree, order) = KdTree::new(chosen.iter().map(|photon| photon.p));
        let record = |&i: &u32| {
            let photon = chosen[i as usize];
            let irradiance = map.irradiance_at(photon.p, photon.ng()).0;
            Record { irradiance, ng: photon.ng().into() }
        };
        Self { tree, records: order.par_iter().map(record).collect() }
    }

    /// Memory (bytes); the photons are not kept.
    #[must_use]
    pub const fn bytes(&self) -> usize {
        self.tree.bytes() + self.records.len() * size_of::<Record>()
    }
}

/// The nearest record with much the same normal.
struct Closest<'a> {
    records: &'a [Record],
    ng: Vec3,
    bound: f32,
    place: Option<usize>,
}

impl Visitor for Closest<'_> {
    #[inline]
    fn bound(&self) -> f32 {
        self.bound
    }

    #[inline]
    fn meet(&mut self, place: usize, squared_distance: f32) {
        if Vec3::from(self.records[place].ng).dot(self.ng) > LEAST_COSINE {
            (self.bound, self.place) = (squared_distance, Some(place));
        }
    }
}

impl Estimator for PrecomputedIrradiance {
    /// Position and normal.
    type Place = (Vec3, Vec3);

    #[inline]
    fn place(&self, p: Vec3, side: Side, _wo: Vec3, footprint: Footprint) -> Option<(Vec3, Vec3)> {
        (!footprint.sharp).then_some((p, side.normal))
    }

    fn read(&self, &(p, ng): &(Vec3, Vec3)) -> Option<Rgb> {
        let bound = MAX_RADIUS * MAX_RADIUS;
        let mut closest = Closest { records: &self.records, ng, bound, place: None };
        self.tree.search(p, &mut closest);
        Some(closest.place.map_or(Rgb::BLACK, |place| Rgb(self.records[place].irradiance)))
    }
}

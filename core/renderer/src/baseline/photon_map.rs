//! The photon map: photons in a kd-tree, the nearest of which are looked up at every gather hit (Jensen 1996; Jensen
//! 2001, chapter 7).
//!
//! A photon takes 28 bytes, as in the paper's comparison: 12 for its position, 12 for its flux, 4 for its direction. Light
//! is the flux over the disk that the k-th photon ends, of photons that came from the surface's side; the BSDF is evaluated
//! for each. Disks that reach round an edge or past a rim are too dark, as in all photon maps.

use std::f32::consts::PI;

use glam::Vec3;

use super::photon_store::{Photon, Photons};
use crate::bsdf::{LobeSet, TransportMode};
use crate::color::Rgb;
use crate::estimator::{Estimator, Footprint};
use crate::lit_scene::Surface;
use crate::math::Side;
use crate::neighbors::{KdTree, Nearest, Octahedral};
use crate::sampling::Rng;

/// Photons farther away than this are never near (scene units: the scene is one wide).
const MAX_RADIUS: f32 = 0.1;

/// Photons in one place make no disk smaller than what separates a ray from its surface (square scene units).
pub(super) const LEAST_SQUARED_RADIUS: f32 = 1e-12;

/// What is stored besides the position.
#[derive(Clone, Copy, Debug)]
struct Arrival {
    flux: [f32; 3],
    /// Towards where the photon came from.
    wi: Octahedral,
}

/// Photons about a point.
struct Disk<'a> {
    arrivals: &'a [Arrival],
    nearest: Nearest,
}

/// The map.
#[derive(Debug)]
pub struct PhotonMap {
    tree: KdTree,
    /// By place in the tree.
    arrivals: Vec<Arrival>,
    /// Photons that end the disk of an estimate.
    k: usize,
}

impl PhotonMap {
    /// The map of `photons`; estimates reach to the `k`-th nearest.
    #[must_use]
    pub fn new(photons: &Photons, k: u32) -> Self {
        let (tree, order) = KdTree::new(photons.0.iter().map(|photon| photon.p));
        let arrival = |photon: &Photon| Arrival { flux: photon.flux.0, wi: photon.wi };
        let arrivals = order.iter().map(|&i| arrival(&photons.0[i as usize])).collect();
        Self { tree, arrivals, k: k as usize }
    }

    /// Memory (bytes).
    #[must_use]
    pub const fn bytes(&self) -> usize {
        self.tree.bytes() + self.arrivals.len() * size_of::<Arrival>()
    }

    /// Squared radius of the disk about `p`, no smaller than [`LEAST_SQUARED_RADIUS`].
    pub(super) fn squared_radius(&self, p: Vec3) -> f32 {
        self.disk(p).nearest.finish().1.max(LEAST_SQUARED_RADIUS)
    }

    /// Places of the photons, in order of the tree.
    pub(super) const fn len(&self) -> usize {
        self.arrivals.len()
    }

    /// Position, flux and direction (towards where it came from) of the photon at a place.
    pub(super) fn photon(&self, place: usize) -> (Vec3, Rgb, Vec3) {
        let arrival = self.arrivals[place];
        (self.tree.point(place), Rgb(arrival.flux), arrival.wi.into())
    }

    fn disk(&self, p: Vec3) -> Disk<'_> {
        let mut nearest = Nearest::new(self.k, MAX_RADIUS);
        self.tree.search(p, &mut nearest);
        Disk { arrivals: &self.arrivals, nearest }
    }

    /// Irradiance at `p` on the side of `ng` (W·m⁻²).
    pub(super) fn irradiance_at(&self, p: Vec3, ng: Vec3) -> Rgb {
        self.disk(p).sum(ng, |flux, _| flux)
    }
}

impl Disk<'_> {
    /// Mean over the disk of what photons from the side of `ng` leave there: `leaving` of flux and direction.
    fn sum(mut self, ng: Vec3, leaving: impl Fn(Rgb, Vec3) -> Rgb) -> Rgb {
        let (candidates, squared_radius) = self.nearest.finish();
        let mut sum = Rgb::BLACK;
        for candidate in candidates {
            let arrival = self.arrivals[candidate.place as usize];
            let wi = Vec3::from(arrival.wi);
            if wi.dot(ng) > 0.0 {
                sum += leaving(Rgb(arrival.flux), wi);
            }
        }
        sum * (1.0 / (PI * squared_radius.max(LEAST_SQUARED_RADIUS)))
    }
}

impl Estimator for PhotonMap {
    /// Position and normal.
    type Place = (Vec3, Vec3);

    #[inline]
    fn place(&self, p: Vec3, side: Side, _wo: Vec3, footprint: Footprint) -> Option<(Vec3, Vec3)> {
        (!footprint.sharp).then_some((p, side.normal))
    }

    fn read(&self, &(p, ng): &(Vec3, Vec3)) -> Option<Rgb> {
        Some(self.irradiance_at(p, ng))
    }

    /// The BSDF is evaluated for every photon.
    fn radiance(
        &self,
        surface: &Surface<'_>,
        lobes: LobeSet,
        footprint: Footprint,
        _rng: &mut Rng,
    ) -> Option<Rgb> {
        let bsdf = &surface.bsdf;
        let (p, ng) = self.place(surface.p, bsdf.frame.side(), bsdf.wo(), footprint)?;
        Some(self.disk(p).sum(ng, |flux, wi| flux * bsdf.eval(wi, lobes, TransportMode::Radiance)))
    }
}

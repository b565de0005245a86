//! Photons that mirrors and glass threw on surfaces, one by one: read where the eye sees them, and nowhere else (Jensen 1996;
//! decision 21).
//!
//! Light is the flux of the nearest photons over the disk that the k-th ends, weighted by Epanechnikov's kernel
//! 2 (1 − d²/r²) / (π r²), whose integral over the disk is one. Photons of other surfaces are left out: those whose normal is
//! another, and those above or below the disk.

mod photons;

use std::f32::consts::FRAC_2_PI;

use glam::Vec3;

use crate::bsdf::{Bsdf, LobeSet, TransportMode};
use crate::color::Rgb;
use crate::neighbors::{Candidate, KdTree, Nearest, Octahedral, Visitor};
pub use photons::CausticPhotons;
use photons::Photon;

/// Disks are this many times as large as that of a typical photon at most (radius): beyond caustics there are next to none.
const WIDEST: f32 = 4.0;

/// The same in scene units: the scene is one wide.
const MAX_RADIUS: f32 = 0.1;

/// Photons in one place make no disk smaller than what separates a ray from its surface (square scene units).
const LEAST_SQUARED_RADIUS: f32 = 1e-12;

/// Cosine between normals of surfaces that are one.
const SAME_NORMAL: f32 = 0.8;

/// Sine of the angle to the surface under which photons are seen that lie on it.
const SAME_PLANE: f32 = 0.5;

/// Photons that say how large a typical disk is.
const TYPICAL: usize = 256;

/// What is stored besides the position.
#[derive(Clone, Copy, Debug)]
struct Arrival {
    /// Before the surface's albedo (W).
    flux: [f32; 3],
    /// Towards where it came from.
    wi: Octahedral,
    /// The surface's normal on that side.
    ng: Octahedral,
}

/// One half's photons.
#[derive(Debug)]
pub struct CausticMap {
    tree: KdTree,
    /// By place in the tree.
    arrivals: Vec<Arrival>,
    /// Photons that end a disk.
    nearest: usize,
    /// Of the largest disk (scene units).
    max_radius: f32,
}

/// A search for photons of one surface.
struct OneSurface<'a> {
    map: &'a CausticMap,
    p: Vec3,
    ng: Vec3,
    /// Light on the other side counts too.
    both_sides: bool,
    nearest: Nearest,
}

impl CausticMap {
    /// Of photons of which the `nearest` to a point end its disk.
    fn new(photons: &[Photon], nearest: usize) -> Self {
        let (tree, order) = KdTree::new(photons.iter().map(|photon| photon.p));
        let arrivals = order.iter().map(|&number| photons[number as usize].arrival).collect();
        let mut map = Self { tree, arrivals, nearest, max_radius: MAX_RADIUS };
        let places = (0..map.arrivals.len()).step_by(map.arrivals.len().div_ceil(TYPICAL).max(1));
        let mut radii: Vec<f32> = places
            .map(|place| {
                let ng = map.arrivals[place].ng.into();
                map.search(map.tree.point(place), ng, false).nearest.finish().1.sqrt()
            })
            .collect();
        radii.sort_by(f32::total_cmp);
        if let Some(typical) = radii.get(radii.len() / 2) {
            map.max_radius = (WIDEST * typical).min(MAX_RADIUS);
        }
        map
    }

    /// Memory (bytes) of a photon while the map is built: as it is taken, as it is put in order, and as it is stored.
    pub const BYTES_PER_PHOTON: u64 =
        (2 * size_of::<Photon>() + size_of::<(Vec3, u32)>() + 12 + size_of::<Arrival>()) as u64;

    /// Number of photons.
    #[must_use]
    pub const fn len(&self) -> usize {
        self.arrivals.len()
    }

    /// True without photons.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.arrivals.is_empty()
    }

    /// Irradiance (W·m⁻²) at `p` on the side of the unit normal `ng`.
    #[must_use]
    pub fn irradiance(&self, p: Vec3, ng: Vec3) -> Rgb {
        self.search(p, ng, false).sum(|flux, _| flux)
    }

    /// Radiance (W·m⁻²·sr⁻¹) that the diffuse and wide glossy lobes of the surface at `p` send to the viewer.
    #[must_use]
    pub fn radiance(&self, p: Vec3, bsdf: &Bsdf<'_>) -> Rgb {
        let search = self.search(p, bsdf.frame.ng, bsdf.lit_side().is_none());
        search.sum(|flux, wi| flux * bsdf.eval(wi, LobeSet::READ, TransportMode::Radiance))
    }

    fn search(&self, p: Vec3, ng: Vec3, both_sides: bool) -> OneSurface<'_> {
        let nearest = Nearest::new(self.nearest, self.max_radius);
        let mut search = OneSurface { map: self, p, ng, both_sides, nearest };
        self.tree.search(p, &mut search);
        search
    }
}

impl OneSurface<'_> {
    /// Sum over the disk of what photons leave there: `leaving` of flux and direction.
    fn sum(mut self, leaving: impl Fn(Rgb, Vec3) -> Rgb) -> Rgb {
        let (candidates, squared_radius) = self.nearest.finish();
        let squared_radius = squared_radius.max(LEAST_SQUARED_RADIUS);
        let mut sum = Rgb::BLACK;
        for &Candidate { squared_distance, place } in candidates {
            let arrival = self.map.arrivals[place as usize];
            let weight = 1.0 - squared_distance / squared_radius;
            sum += leaving(Rgb(arrival.flux), arrival.wi.into()) * weight;
        }
        sum * (FRAC_2_PI / squared_radius)
    }
}

impl Visitor for OneSurface<'_> {
    #[inline]
    fn bound(&self) -> f32 {
        self.nearest.bound()
    }

    #[inline]
    fn meet(&mut self, place: usize, squared_distance: f32) {
        let cos = Vec3::from(self.map.arrivals[place].ng).dot(self.ng);
        let height = (self.map.tree.point(place) - self.p).dot(self.ng);
        let same_side = cos > SAME_NORMAL || (self.both_sides && cos < -SAME_NORMAL);
        let flat = SAME_PLANE * SAME_PLANE * squared_distance + LEAST_SQUARED_RADIUS;
        if same_side && height * height <= flat {
            self.nearest.meet(place, squared_distance);
        }
    }
}

//! The Radiance Grid Pyramid exactly as published (Yue, Iwasaki, Nishita, section 5).
//!
//! - Cells are those of an octree over the scene's bounds, made where photons land. Within a cell photons are grouped by
//!   the normal of their surface, discretised to the six directions of the axes.
//! - Each group of each cell holds the outgoing radiance per direction bin: incoming flux × BRDF over the area of the cell's
//!   face. The surface's color is part of it.
//! - It is read at the level whose cell face is nearest to the footprint (eq. 5), interpolated linearly in position and
//!   direction. Of the eight cells about a position those without a photon of the group do not count: their share would
//!   make a wall that lies off the middle of its cells darker.
//!
//! There is no true area, no rule on counts and no retrace.

mod bins;
mod build;

use glam::{IVec3, Vec3};
use rustc_hash::FxHashMap;

use super::photon_store::Photons;
use crate::color::Rgb;
use crate::estimator::{Estimator, Footprint};
use crate::lit_scene::LitScene;
use crate::math::{Frame, Side};
use bins::{Bins, SharedExponent};
use build::Builder;

/// Discretised normals.
const GROUPS: usize = 6;

/// The grid is wider than the scene by this part on every side, so that walls at its bounds lie within cells.
const MARGIN: f32 = 1e-3;

/// Where the cells lie, and how each is divided.
#[derive(Clone, Copy, Debug)]
struct Lattice {
    low: Vec3,
    finest_cell_size: f32,
    /// Number of the finest level, M.
    finest: u32,
    bins: Bins,
}

impl Lattice {
    fn new([low, high]: [Vec3; 2], resolution: u32, [elevation, azimuth]: [u32; 2]) -> Self {
        let margin = (high - low).max_element().max(f32::MIN_POSITIVE) * MARGIN;
        let extent = (high - low).max_element() + 2.0 * margin;
        Self {
            low: low - margin,
            finest_cell_size: extent / resolution as f32,
            finest: resolution.next_power_of_two().ilog2(),
            bins: Bins { elevation, azimuth },
        }
    }

    /// Eq. 4.
    fn cell_size(&self, level: u32) -> f32 {
        self.finest_cell_size * (1_u32 << (self.finest - level)) as f32
    }

    /// The cell of a level that holds `p`, which lies within the scene.
    fn cell(&self, p: Vec3, level: u32) -> IVec3 {
        let finest = ((p - self.low) / self.finest_cell_size).floor().as_ivec3();
        finest.clamp(IVec3::ZERO, IVec3::splat((1 << self.finest) - 1)) >> (self.finest - level)
    }

    /// Eq. 5, to the nearest level there is.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped")]
    fn level(&self, footprint: f32) -> u32 {
        let coarser = (footprint.sqrt() / self.finest_cell_size).max(1.0).log2().round();
        self.finest - (coarser as u32).min(self.finest)
    }
}

/// Group of a unit normal.
fn group_of(normal: Vec3) -> usize {
    let axis = normal.abs().max_position();
    2 * axis + usize::from(normal[axis] < 0.0)
}

/// The discretised normal of a group.
const fn group_normal(group: usize) -> Vec3 {
    [Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y, Vec3::Z, Vec3::NEG_Z][group]
}

/// Level, group and cell in one number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
struct Key(u64);

impl Key {
    #[expect(clippy::cast_sign_loss, reason = "cells within the lattice")]
    fn new(level: u32, group: usize, cell: IVec3) -> Self {
        let [x, y, z] = cell.to_array().map(|c| c as u64);
        Self(u64::from(level) << 51 | (group as u64) << 48 | x << 32 | y << 16 | z)
    }
}

/// Cells with their bins one after another.
#[derive(Debug, Default)]
struct Cells {
    keys: Vec<Key>,
    radiance: Vec<SharedExponent>,
}

impl Cells {
    fn push(&mut self, key: Key, radiance: impl Iterator<Item = SharedExponent>) {
        self.keys.push(key);
        self.radiance.extend(radiance);
    }

    fn append(&mut self, mut other: Self) {
        self.keys.append(&mut other.keys);
        self.radiance.append(&mut other.radiance);
    }
}

/// The finished pyramid.
#[derive(Debug)]
pub struct Pyramid2006 {
    lattice: Lattice,
    /// Number of each cell in `radiance`.
    index: FxHashMap<Key, u32>,
    /// Radiance (W·m⁻²·sr⁻¹) by cell, by bin.
    radiance: Vec<SharedExponent>,
}

/// A hit to be read.
#[derive(Clone, Copy, Debug, Default)]
pub struct Place {
    p: Vec3,
    wo: Vec3,
    group: u8,
    level: u8,
}

impl Pyramid2006 {
    /// Sums the photons of `lit` over the cells of `bounds`: `resolution` of them along the longest side, each with
    /// elevation × azimuth `bins`.
    #[must_use]
    pub fn new(
        photons: &Photons,
        lit: &LitScene<'_>,
        bounds: [Vec3; 2],
        resolution: u32,
        bins: [u32; 2],
    ) -> Self {
        let lattice = Lattice::new(bounds, resolution, bins);
        let mut cells = Cells::default();
        for group in 0..GROUPS {
            cells.append(Builder::new(&lattice, lit, &photons.0, group).build());
        }
        #[expect(clippy::cast_possible_truncation, reason = "four billion cells fit no machine")]
        let index = cells.keys.iter().enumerate().map(|(number, &key)| (key, number as u32)).collect();
        Self { lattice, index, radiance: cells.radiance }
    }

    /// Memory (bytes).
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.radiance.len() * size_of::<SharedExponent>()
            + self.index.capacity() * (size_of::<(Key, u32)>() + 1)
    }
}

impl Estimator for Pyramid2006 {
    type Place = Place;

    const READS_RADIANCE: bool = true;

    #[inline]
    #[expect(clippy::cast_possible_truncation, reason = "six groups, some tens of levels")]
    fn place(&self, p: Vec3, side: Side, wo: Vec3, footprint: Footprint) -> Option<Place> {
        let level = self.lattice.level(footprint.area()) as u8;
        (!footprint.sharp).then_some(Place { p, wo, group: group_of(side.normal) as u8, level })
    }

    fn read(&self, place: &Place) -> Option<Rgb> {
        let (level, group) = (u32::from(place.level), usize::from(place.group));
        let bins = self.lattice.bins.about(Frame::new(group_normal(group)).to_local(place.wo));
        let at = (place.p - self.lattice.low) / self.lattice.cell_size(level) - 0.5;
        let (low, share) = (at.floor().as_ivec3(), at - at.floor());
        let (mut sum, mut weights) = (Rgb::BLACK, 0.0);
        for corner in 0..8 {
            let step = IVec3::new(corner & 1, corner >> 1 & 1, corner >> 2);
            let cell = low + step;
            let Some(&number) =
                (cell.min_element() >= 0).then(|| self.index.get(&Key::new(level, group, cell))).flatten()
            else {
                continue;
            };
            let weight = Vec3::select(step.cmpeq(IVec3::ONE), share, 1.0 - share).element_product();
            let first = number as usize * self.lattice.bins.count();
            let radiance: Rgb =
                bins.iter().map(|&(bin, share)| Rgb::from(self.radiance[first + bin]) * share).sum();
            sum += radiance * weight;
            weights += weight;
        }
        Some(if weights > 0.0 { sum * (1.0 / weights) } else { Rgb::BLACK })
    }
}

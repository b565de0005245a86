//! From photons to cells: the photons sorted as an octree orders its cells, then cell by cell, parents from children.

use glam::{IVec3, Vec3};
use rayon::prelude::*;

use super::bins::SharedExponent;
use super::{Cells, Key, Lattice};
use crate::baseline::photon_store::Photon;
use crate::bsdf::{LobeSet, TransportMode};
use crate::color::Rgb;
use crate::lit_scene::LitScene;
use crate::math::Frame;

/// Below this many photons a cell is built on one thread.
const PARALLEL: usize = 10_000;

/// Makes the cells of one group of normals.
pub(super) struct Builder<'a> {
    lattice: &'a Lattice,
    lit: &'a LitScene<'a>,
    photons: &'a [Photon],
    group: usize,
    /// Of the bins.
    directions: Vec<Vec3>,
}

/// A photon by the octree's order of its finest cell.
type Ordered = (u64, u32);

impl<'a> Builder<'a> {
    /// For the photons of one group among `photons`.
    pub(super) fn new(
        lattice: &'a Lattice,
        lit: &'a LitScene<'a>,
        photons: &'a [Photon],
        group: usize,
    ) -> Self {
        let directions = lattice.bins.directions(&Frame::new(super::group_normal(group)));
        Self { lattice, lit, photons, group, directions }
    }

    /// The cells that hold photons of the group, on all levels.
    pub(super) fn build(&self) -> Cells {
        let photons = self.photons.iter().enumerate();
        let own = photons.filter(|(_, photon)| super::group_of(photon.ng()) == self.group);
        let mut ordered: Vec<Ordered> = own
            .map(|(i, photon)| (interleave(self.lattice.cell(photon.p, self.lattice.finest)), i as u32))
            .collect();
        ordered.par_sort_unstable();
        let mut cells = Cells::default();
        if !ordered.is_empty() {
            self.add(0, &ordered, &mut cells);
        }
        cells
    }

    /// Adds the cell of `level` that holds exactly `photons`, and all below it, to `cells`; gives its outgoing flux (W·sr⁻¹)
    /// by bin.
    fn add(&self, level: u32, photons: &[Ordered], cells: &mut Cells) -> Vec<Rgb> {
        let sums = if level == self.lattice.finest {
            self.outgoing(photons)
        } else {
            self.merge(level, photons, cells)
        };
        let edge = self.lattice.cell_size(level);
        let cell = self.lattice.cell(self.photons[photons[0].1 as usize].p, level);
        let face = 1.0 / (edge * edge);
        cells.push(
            Key::new(level, self.group, cell),
            sums.iter().map(|&sum| SharedExponent::from(sum * face)),
        );
        sums
    }

    /// Sum of the children of a cell.
    fn merge(&self, level: u32, photons: &[Ordered], cells: &mut Cells) -> Vec<Rgb> {
        let shift = 3 * (self.lattice.finest - level - 1);
        let children: Vec<&[Ordered]> = photons.chunk_by(|a, b| a.0 >> shift == b.0 >> shift).collect();
        let mut total = vec![Rgb::BLACK; self.directions.len()];
        let mut add = |sums: Vec<Rgb>| total.iter_mut().zip(sums).for_each(|(total, sum)| *total += sum);
        if photons.len() < PARALLEL {
            children.into_iter().for_each(|child| add(self.add(level + 1, child, cells)));
            return total;
        }
        let built = children.into_par_iter().map(|child| {
            let mut own = Cells::default();
            (self.add(level + 1, child, &mut own), own)
        });
        for (sums, own) in built.collect::<Vec<_>>() {
            add(sums);
            cells.append(own);
        }
        total
    }

    /// Incoming flux times BRDF of the photons of a finest cell, by bin (paper, 5.1). Diffuse light leaves in all
    /// directions of the group alike.
    fn outgoing(&self, photons: &[Ordered]) -> Vec<Rgb> {
        let mut sums = vec![Rgb::BLACK; self.directions.len()];
        for &(_, i) in photons {
            let photon = &self.photons[i as usize];
            let bsdf = photon.bsdf(self.lit);
            let diffuse = bsdf.diffuse_albedo() * std::f32::consts::FRAC_1_PI;
            let glossy = bsdf.has(LobeSet::ROUGH);
            for (sum, &direction) in sums.iter_mut().zip(&self.directions) {
                let mut f = diffuse;
                if glossy {
                    f += bsdf.eval(direction, LobeSet::ROUGH, TransportMode::Radiance);
                }
                *sum += photon.flux * f;
            }
        }
        sums
    }
}

/// Bits of the coordinates in turn: the order of an octree's cells.
#[expect(clippy::cast_sign_loss, reason = "cells of photons lie within the lattice")]
fn interleave(cell: IVec3) -> u64 {
    let spread = |v: i32| (0..21).fold(0, |bits, i| bits | (v as u64 >> i & 1) << (3 * i));
    spread(cell.x) | spread(cell.y) << 1 | spread(cell.z) << 2
}

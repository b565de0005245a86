//! Cells whose look-ups disagree with the paths that an auditor followed from the same hits, more than chance explains.
//!
//! A hit counts for the cell that was read and for all coarser ones around it: a small cell needs many hits to be sure of,
//! a large one collects them.

use std::f64::consts::PI;

use glam::DVec3;
use rayon::prelude::*;
use rustc_hash::{FxHashMap, FxHashSet};

use super::camera::camera_ray;
use super::readings::first_scatterer;
use crate::lit_scene::LitScene;
use crate::pyramid::{CellId, Place, Pyramid};
use crate::sampling::{Rng, hash};
use crate::scene::{MIDDLE, SceneSpace};
use crate::stats::CellDisagreement;

/// Hits of a cell below which nothing is said about it.
const LEAST_HITS: u64 = 32;

/// What is known of the spread before a cell's own hits count for as many hits: a few that happen to agree prove nothing.
const PRIOR_HITS: f64 = 32.0;

/// Chance that one cell of a whole picture is listed though nothing is wrong.
const SIGNIFICANT: f64 = 0.001;

/// Cells that are listed at most, those that change the picture most.
const LISTED: usize = 100;

/// Sums over audited hits, of light as the camera sees it.
#[derive(Clone, Copy, Debug, Default)]
struct Sums {
    hits: u64,
    read: f64,
    found: f64,
    /// Of (read − found)².
    square: f64,
    /// Of read².
    read_square: f64,
}

impl Sums {
    fn add(&mut self, read: f64, found: f64) {
        self.hits += 1;
        self.read += read;
        self.found += found;
        self.square += (read - found).powi(2);
        self.read_square += read * read;
    }

    /// Probability of a difference like this by chance, where the variance of read − found is `relative` times read² on
    /// average over all hits. Student's t, brought to a normal distribution by Wallace's formula.
    fn chance(&self, relative: f64) -> f64 {
        let hits = self.hits as f64;
        let difference = self.read - self.found;
        let own = self.square - difference * difference / hits;
        let prior = PRIOR_HITS * relative * self.read_square / hits;
        let freedom = hits - 1.0 + PRIOR_HITS;
        let variance = (own + prior) / freedom;
        if variance <= 0.0 {
            return 1.0;
        }
        let t_square = difference * difference / (hits * variance);
        let z =
            (8.0 * freedom + 1.0) / (8.0 * freedom + 3.0) * (freedom * (t_square / freedom).ln_1p()).sqrt();
        2.0 * normal_tail(z)
    }

    fn with(self, other: Self) -> Self {
        Self {
            hits: self.hits + other.hits,
            read: self.read + other.read,
            found: self.found + other.found,
            square: self.square + other.square,
            read_square: self.read_square + other.read_square,
        }
    }

    /// From −1, all light is missing, to 1, there should be none.
    fn excess(&self) -> f64 {
        (self.read - self.found) / self.read.max(self.found).max(f64::MIN_POSITIVE)
    }
}

/// The hits of a cell, dealt by turns to two halves: what a single bright path says, the other half does not confirm.
#[derive(Clone, Copy, Debug, Default)]
struct CellSums([Sums; 2]);

impl CellSums {
    fn add(&mut self, read: f64, found: f64) {
        let [a, b] = &mut self.0;
        if a.hits > b.hits { b.add(read, found) } else { a.add(read, found) }
    }

    fn all(&self) -> Sums {
        self.0[0].with(self.0[1])
    }

    /// Probability that both halves differ like this, in the same direction, by chance.
    fn chance(&self, relative: f64) -> f64 {
        let [a, b] = &self.0;
        if (a.read > a.found) != (b.read > b.found) {
            return 1.0;
        }
        0.5 * a.chance(relative).max(b.chance(relative)).powi(2)
    }
}

/// Probability that a normal variable is above `z`, by Laplace's continued fraction; one half below 2, where nothing is
/// significant.
fn normal_tail(z: f64) -> f64 {
    if z < 2.0 {
        return 0.5;
    }
    let fraction = (1..100).rev().fold(z, |below, k| z + f64::from(k) / below);
    (-0.5 * z * z).exp() / ((2.0 * PI).sqrt() * fraction)
}

/// Audited hits, by cell.
#[derive(Debug, Default)]
pub(super) struct Hits {
    cells: FxHashMap<CellId, CellSums>,
    all: Sums,
}

impl Hits {
    /// Adds a hit to the cells it lies in.
    pub(super) fn add(&mut self, cells: impl Iterator<Item = CellId>, read: f64, found: f64) {
        self.all.add(read, found);
        for id in cells {
            self.cells.entry(id).or_default().add(read, found);
        }
    }

    fn enough(&self) -> impl Iterator<Item = (CellId, &CellSums)> {
        self.cells.iter().filter(|(_, sums)| sums.0[1].hits >= LEAST_HITS / 2).map(|(id, sums)| (*id, sums))
    }

    /// Cells with enough hits to be judged.
    pub(super) fn tested(&self) -> usize {
        self.enough().count()
    }

    /// Cells that disagree, those aside that hold a smaller one that does.
    pub(super) fn disagreement<'a>(&self, pyramid: &'a Pyramid) -> Disagreement<'a> {
        let relative = self.all.square / self.all.read_square.max(f64::MIN_POSITIVE);
        let tested = self.tested() as f64;
        let found = self.enough().filter_map(|(id, sums)| {
            let significance = sums.chance(relative) * tested;
            (significance < SIGNIFICANT).then_some((id, sums.all(), significance))
        });
        let mut found: Vec<_> = found.collect();
        let above = |id: CellId| std::iter::successors(pyramid.cell_above(id), |&id| pyramid.cell_above(id));
        let coarser: FxHashSet<CellId> = found.iter().flat_map(|(id, ..)| above(*id)).collect();
        found.retain(|(id, ..)| !coarser.contains(id));
        let weight = |sums: &Sums| (sums.read - sums.found).abs();
        found.sort_by(|(_, a, _), (_, b, _)| weight(b).total_cmp(&weight(a)));
        Disagreement { pyramid, cells: found }
    }
}

/// The cells that disagree.
pub struct Disagreement<'a> {
    pyramid: &'a Pyramid,
    /// With their significance, those that change the picture most first.
    cells: Vec<(CellId, Sums, f64)>,
}

impl Disagreement<'_> {
    pub(super) fn len(&self) -> usize {
        self.cells.len()
    }

    /// The first of them, in metres.
    pub(super) fn list(&self, space: &SceneSpace) -> Vec<CellDisagreement> {
        let cell = |(id, sums, significance): &(CellId, Sums, f64)| {
            let (center, size) = self.pyramid.cube(*id);
            let position: DVec3 = center.as_dvec3() / space.scale + space.center;
            CellDisagreement {
                position: position.to_array(),
                size: f64::from(size) / space.scale,
                class: id.class,
                hits: sums.hits,
                ratio: (sums.found > 0.0).then(|| sums.read / sums.found),
                significance: *significance,
            }
        };
        self.cells.iter().take(LISTED).map(cell).collect()
    }

    /// The cells over the picture: what the camera sees in the middle of each pixel, rows from the bottom, as the part of
    /// its light that is wrong, from −1 (all of it is missing) to 1 (there should be none), 0 where nothing is known to be
    /// wrong; `None` where nothing is anywhere.
    #[must_use]
    pub fn picture(&self, lit: &LitScene<'_>, seed: u32) -> Option<Vec<f32>> {
        const MAX_DEPTH: u32 = 8;
        if self.cells.is_empty() {
            return None;
        }
        #[expect(clippy::cast_possible_truncation, reason = "a picture of f32")]
        let excess: FxHashMap<CellId, f32> =
            self.cells.iter().map(|(id, sums, _)| (*id, sums.excess() as f32)).collect();
        let camera = &lit.accel.scene().camera;
        let [left, bottom, width, height] = camera.region;
        let finest = self.pyramid.level_count() as u32 - 1;
        let pixel = |i: u32| {
            let at = glam::DVec2::new(f64::from(left + i % width), f64::from(bottom + i / width)) + 0.5;
            let mut rng = Rng::new(hash(hash(u64::from(seed), 0x61_75_64_69_74), u64::from(i)));
            let ray = camera_ray(camera, lit, at, None, MIDDLE)?.ray;
            let seen = first_scatterer(lit, ray, MAX_DEPTH, &mut rng)?;
            let class = self.pyramid.class(seen.bsdf.frame.side()) as u32;
            let place = Place { p: seen.p, class, level: finest };
            self.pyramid.cells_around(place).find_map(|id| excess.get(&id).copied())
        };
        Some((0..width * height).into_par_iter().map(|i| pixel(i).unwrap_or(0.0)).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Table values of the normal distribution.
    #[test]
    fn tails_of_the_normal_distribution() {
        for (z, expected) in
            [(2.0, 0.022_750_13), (3.0, 1.349_898e-3), (5.0, 2.866_516e-7), (8.0, 6.220_961e-16)]
        {
            let tail = normal_tail(z);
            assert!((tail / expected - 1.0).abs() < 1e-5, "{z}: {tail}");
        }
    }

    /// Paths that find all light in one of four, none in the others, as behind a narrow door.
    fn paths(hits: u64, mean: f64, seed: u64) -> CellSums {
        let mut rng = Rng::new(seed);
        let mut sums = CellSums::default();
        (0..hits).for_each(|_| sums.add(1.0, if rng.draw() < 0.25 { 4.0 * mean } else { 0.0 }));
        sums
    }

    #[test]
    fn what_agrees_on_average_is_not_suspected_and_what_does_not_is() {
        let relative = paths(100_000, 1.0, 1).all().square / 100_000.0;
        let cells = 2_000;
        let least = (0..cells).map(|seed| paths(40, 1.0, seed).chance(relative)).fold(1.0, f64::min);
        assert!(least * cells as f64 > SIGNIFICANT, "one of {cells} honest cells is listed, {least:.1e}");
        for (hits, mean) in [(1_000, 0.6), (1_000, 1.6), (200, 0.0)] {
            let chance = paths(hits, mean, 7).chance(relative);
            assert!(
                chance * (cells as f64) < SIGNIFICANT,
                "{mean} instead of 1 over {hits} hits: {chance:.1e}"
            );
        }
    }
}

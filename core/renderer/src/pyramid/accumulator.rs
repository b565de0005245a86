//! Flux while photons land: integer sums, so that the order of photons, threads and machines does not matter.
//!
//! Photons come in two sets that are kept apart, each an estimate of all the light: what two halves of a picture read from
//! different sets differs by the photons' noise too.

use std::collections::BTreeMap;
use std::hint::black_box;
use std::sync::atomic::{AtomicI64, AtomicU32, AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};

use glam::Vec3;
use rayon::prelude::*;

use super::bins::{BinCorners, DirectionBins, LANES, Lanes};
use super::layout::Layout;
use crate::color::Rgb;
use crate::math::{Frame, Side};
use crate::sampling::{Rng, hash};

/// Sets of photons.
pub const SETS: usize = 2;

/// Flux and photons of every cell that can receive light directly.
#[derive(Debug)]
pub struct Accumulator<'a> {
    layout: &'a Layout,
    /// By level, by place.
    cells: Vec<Vec<AtomicCell>>,
    /// By level, by place, where there are glossy surfaces at all; filled where the first photon lands on one.
    glossy: Vec<Vec<Mutex<GlossySums>>>,
    bins: DirectionBins,
    corners: BinCorners,
    quantum: f64,
    /// 1 / quantum: exact, since both are powers of two.
    per_quantum: f64,
    lost: AtomicU64,
}

/// What landed in one cell, in a cache line of its own.
#[derive(Debug, Default)]
#[repr(align(64))]
struct AtomicCell {
    /// By set: red, green, blue in quanta.
    flux: [[AtomicI64; 3]; SETS],
    /// Photons of all sets.
    count: AtomicU32,
}

/// A photon that has landed.
#[derive(Clone, Copy, Debug)]
pub struct Deposit {
    /// Set it belongs to.
    pub set: usize,
    /// Where, in scene space.
    pub p: Vec3,
    /// On which side of a surface.
    pub side: Side,
    /// Before the surface's albedo (W).
    pub flux: Rgb,
}

/// Quanta of each channel of [`LANES`] bins at a time, the bins of one set after those of the other; empty until a photon
/// lands. One lock costs less than atomic sums for every bin, and leaves the additions to vector code.
type GlossySums = Box<[[[i64; LANES]; 3]]>;

/// What a photon sends on from a glossy surface. No closure: what is to become vector code has to be inlined for sure.
pub trait Leaving {
    /// Flux times BSDF over the surface's tint (W·sr⁻¹) towards unit vectors.
    fn towards(&self, directions: &Lanes) -> Lanes;
}

/// The cell a photon was added to.
#[derive(Clone, Copy, Debug)]
pub struct Landing {
    level: usize,
    place: usize,
    set: usize,
}

/// Photons that look for their cells together.
pub const TOGETHER: usize = 16;

/// One photon of a billion still is some million quanta, and two thousand times the emitted flux fits in a cell.
const QUANTUM_BITS: f64 = 52.0;

/// Quanta of a cell over quanta of a bin: bins need fewer bits, and what is steep at grazing has to fit.
const COARSER: f64 = 4096.0;

/// Numbers below 2⁵¹ added to this are rounded, and stand in its lowest bits: vector code has no other way to make
/// integers of 64 bits.
const ROUNDER: f64 = 1.5 * (1_u64 << 52) as f64;
const MOST_QUANTA: f64 = (1_u64 << 51) as f64;

impl<'a> Accumulator<'a> {
    /// An empty accumulator for light of `total_flux` (largest channel) in all; `bins` where glossy surfaces are read from
    /// the pyramid.
    #[must_use]
    pub fn new(layout: &'a Layout, total_flux: f32, bins: Option<DirectionBins>) -> Self {
        // A power of two, so that twice the light gives exactly twice the picture.
        let quantum = (f64::from(total_flux.max(f32::MIN_POSITIVE)).log2().ceil() - QUANTUM_BITS).exp2();
        let cells = layout.levels.iter().map(|level| level.index.len());
        let glossy_cells = cells.clone().take(layout.grid.base() + 1);
        let all_bins = bins.unwrap_or(DirectionBins { elevation: 1, azimuth: 1 });
        Self {
            layout,
            cells: cells.map(|n| (0..n).into_par_iter().map(|_| Default::default()).collect()).collect(),
            glossy: glossy_cells
                .map(|n| {
                    std::iter::repeat_with(Mutex::default).take(if bins.is_some() { n } else { 0 }).collect()
                })
                .collect(),
            bins: all_bins,
            corners: BinCorners::new(all_bins),
            quantum,
            per_quantum: quantum.recip(),
            lost: AtomicU64::new(0),
        }
    }

    /// Adds a photon; gives the cell.
    pub fn deposit(&self, deposit: &Deposit) -> Option<Landing> {
        let place = self.layout.find(deposit.p, self.layout.classes.of(deposit.side));
        self.deposit_at(place, deposit)
    }

    /// Adds photons: one step for [`TOGETHER`] of them before the next, so that the memory is waited for once and not once
    /// per photon.
    pub fn deposit_all(&self, deposits: &[Deposit]) {
        for deposits in deposits.chunks(TOGETHER) {
            let at = |i: usize| deposits.get(i).map(|photon| (photon.p, self.layout.classes.of(photon.side)));
            let places = self.layout.find_all::<TOGETHER>(std::array::from_fn(at));
            self.touch(&places);
            for (deposit, place) in deposits.iter().zip(places) {
                self.deposit_at(place, deposit);
            }
        }
    }

    /// Reads the cells that are about to be added to. Reads wait for memory side by side, atomic sums one after the other.
    fn touch(&self, places: &[Option<(usize, usize)>]) {
        for (level, place) in places.iter().flatten() {
            black_box(self.cells[*level][*place].count.load(Ordering::Relaxed));
        }
    }

    fn deposit_at(&self, place: Option<(usize, usize)>, deposit: &Deposit) -> Option<Landing> {
        let Some((level, place)) = place.filter(|_| deposit.flux.is_finite()) else {
            self.lost.fetch_add(1, Ordering::Relaxed);
            return None;
        };
        let cell = &self.cells[level][place];
        self.add(&cell.flux[deposit.set], deposit.flux, dither(deposit.p.to_array()));
        cell.count.fetch_add(1, Ordering::Relaxed);
        Some(Landing { level, place, set: deposit.set })
    }

    /// Adds what the photon's surface sends in each direction. `at` in [0, 1)² is where in each bin that is asked; a random
    /// place averages over the bin. Refined cells share the bins of the one they refine.
    #[inline(always)]
    pub fn deposit_glossy(&self, landing: Landing, at: [f32; 2], leaving: &impl Leaving) {
        let groups = self.corners.groups();
        let (level, place) = self.layout.unrefined(landing.level, landing.place);
        let frame = Frame::new(self.layout.bins_normal(level, place));
        let per_quantum = self.per_quantum / COARSER;
        let Some(sums) = self.glossy.get(level).and_then(|cells| cells.get(place)) else { return };
        let mut sums = sums.lock().unwrap_or_else(PoisonError::into_inner);
        if sums.is_empty() {
            *sums = vec![[[0; LANES]; 3]; SETS * groups].into_boxed_slice();
        }
        let sums = &mut sums[landing.set * groups..][..groups];
        let dither = dither(at);
        let directions = self.corners.directions(&frame, at);
        for (group, sums) in sums.iter_mut().enumerate() {
            let values = leaving.towards(&directions.group(group));
            for (sums, values) in sums.iter_mut().zip(&values) {
                for i in 0..LANES {
                    sums[i] = sums[i].wrapping_add(quanta(f64::from(values[i]) * per_quantum + dither));
                }
            }
        }
    }

    fn add(&self, sums: &[AtomicI64; 3], values: Rgb, dither: f64) {
        for (sum, value) in sums.iter().zip(values.0) {
            #[expect(clippy::cast_possible_truncation, reason = "quantised on purpose")]
            let quanta = (f64::from(value) * self.per_quantum + dither).round() as i64;
            sum.fetch_add(quanta, Ordering::Relaxed);
        }
    }

    /// Photons added.
    #[must_use]
    pub fn deposited(&self) -> u64 {
        self.cells.iter().flatten().map(|cell| u64::from(cell.count.load(Ordering::Relaxed))).sum()
    }

    /// Photons that found no cell: rounding at slivers, or a flux that was not a number.
    #[must_use]
    pub fn lost(&self) -> u64 {
        self.lost.load(Ordering::Relaxed)
    }

    /// Memory (bytes) that the accumulator of a layout takes at most, and the pyramid that is made of it.
    #[must_use]
    pub fn bytes_for(layout: &Layout, bins: Option<DirectionBins>) -> usize {
        let cell = size_of::<AtomicCell>() + size_of::<CellSum>();
        let cells = layout.cell_count();
        let Some(bins) = bins else { return cells * cell };
        let bin_sums = SETS * bins.count().div_ceil(LANES) * size_of::<[[i64; LANES]; 3]>();
        cells * (cell + size_of::<Mutex<GlossySums>>()) + layout.glossy_cell_count() * 2 * bin_sums
    }

    /// Memory (bytes).
    #[must_use]
    pub fn bytes(&self) -> usize {
        let cells: usize = self.cells.iter().map(Vec::len).sum();
        cells * size_of::<AtomicCell>() + self.bin_bytes()
    }

    /// Memory (bytes) of the direction bins alone.
    #[must_use]
    pub fn bin_bytes(&self) -> usize {
        let glossy = self.glossy.iter().map(|level| {
            let groups = |cell: &Mutex<GlossySums>| cell.lock().unwrap_or_else(PoisonError::into_inner).len();
            level.len() * size_of::<Mutex<GlossySums>>()
                + level.iter().map(groups).sum::<usize>() * size_of::<[[i64; LANES]; 3]>()
        });
        glossy.sum()
    }

    /// By level and place: whether photons landed there.
    pub(super) fn landed(&self) -> Vec<Vec<bool>> {
        let landed = |cell: &AtomicCell| cell.count.load(Ordering::Relaxed) > 0;
        self.cells.iter().map(|cells| cells.par_iter().map(landed).collect()).collect()
    }

    /// What was added to the cells at `places`, by level; in their order.
    pub(super) fn into_sums(mut self, places: &[Vec<u32>]) -> Sums {
        let sum = |cell: &AtomicCell| CellSum {
            flux: cell.flux.each_ref().map(|set| set.each_ref().map(|flux| flux.load(Ordering::Relaxed))),
            count: u64::from(cell.count.load(Ordering::Relaxed)),
        };
        let level = |(cells, places): (&Vec<AtomicCell>, &Vec<u32>)| {
            places.par_iter().map(|&place| sum(&cells[place as usize])).collect()
        };
        let cells = self.cells.iter().zip(places).map(level).collect();
        let count = self.bins.count();
        let by_bin = |sums: &GlossySums| -> Vec<[i64; 3]> {
            let sets = sums.chunks(sums.len() / SETS);
            let bin = |set: &[[[i64; LANES]; 3]], bin: usize| set[bin / LANES].map(|sums| sums[bin % LANES]);
            sets.flat_map(|set| (0..count).map(move |at| bin(set, at))).collect()
        };
        let glossy = self.glossy.iter_mut().zip(places).map(|(level, places)| {
            let mut filled: Vec<(usize, GlossySums)> = Vec::new();
            let places = if level.is_empty() { [].as_slice() } else { places };
            for (number, &place) in places.iter().enumerate() {
                let sums = level[place as usize].get_mut().unwrap_or_else(PoisonError::into_inner);
                if !sums.is_empty() {
                    filled.push((number, std::mem::take(sums)));
                }
            }
            filled.into_par_iter().map(|(place, sums)| (place, by_bin(&sums))).collect()
        });
        Sums {
            cells,
            glossy: glossy.collect(),
            bins: self.bins,
            quantum: self.quantum,
            bin_quantum: self.quantum * COARSER,
        }
    }
}

/// Everything that was added.
pub(super) struct Sums {
    /// By level, by place.
    pub(super) cells: Vec<Vec<CellSum>>,
    /// By level: quanta of each bin of each set of the glossy cells, by place.
    pub(super) glossy: Vec<BTreeMap<usize, Vec<[i64; 3]>>>,
    /// How the hemisphere is cut.
    pub(super) bins: DirectionBins,
    /// Flux of one quantum of a cell, and of one quantum of a bin.
    pub(super) quantum: f64,
    pub(super) bin_quantum: f64,
}

/// A number in [-½, ½) that belongs to the photon, whatever thread it lands on. Added before rounding it keeps the mean of
/// photons fainter than a quantum, such as those of a lamp of 10⁻⁶ W beside one of 10⁶ W.
fn dither<const N: usize>(of: [f32; N]) -> f64 {
    let bits = of.iter().fold(0, |bits, value| hash(bits, u64::from(value.to_bits())));
    f64::from(Rng::new(bits).draw()) - 0.5
}

/// Rounds to an integer, in a way that becomes vector code; what is no number counts nothing.
#[inline(always)]
fn quanta(value: f64) -> i64 {
    let value = if value.abs() < MOST_QUANTA { value } else { 0.0 };
    (value + ROUNDER).to_bits().wrapping_sub(ROUNDER.to_bits()).cast_signed()
}

/// Light of one cell.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct CellSum {
    /// Quanta of each channel.
    pub flux: [[i64; 3]; SETS],
    /// Photons.
    pub count: u64,
}

impl CellSum {
    pub(super) fn add(&mut self, other: &Self) {
        for (sum, flux) in self.flux.as_flattened_mut().iter_mut().zip(other.flux.as_flattened()) {
            *sum += flux;
        }
        self.count += other.count;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quanta_are_rounded_and_no_number_is_none() {
        for value in [0.0, 0.4, 0.6, -0.4, -0.6, 1.5, 12_345.49, -9e9, 2.2e15, -2.2e15] {
            assert_eq!(quanta(value), value.round_ties_even() as i64, "{value}");
        }
        for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e300, MOST_QUANTA] {
            assert_eq!(quanta(value), 0, "{value}");
        }
    }
}

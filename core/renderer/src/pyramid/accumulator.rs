//! Flux while photons land: integer sums, so that the order of photons, threads and machines does not matter.
//!
//! Photons come in two sets that are kept apart, each an estimate of all the light: what two halves of a picture read from
//! different sets differs by the photons' noise too.

use std::collections::BTreeMap;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicI64, AtomicU32, AtomicU64, Ordering};

use glam::Vec3;

use super::bins::DirectionBins;
use super::layout::Layout;
use crate::color::Rgb;
use crate::math::{Frame, Side};

/// Sets of photons.
pub const SETS: usize = 2;

/// Flux and photons of every cell that can receive light directly.
#[derive(Debug)]
pub struct Accumulator<'a> {
    layout: &'a Layout,
    /// By level, by place, by set: red, green, blue in quanta.
    flux: Vec<Vec<[[AtomicI64; 3]; SETS]>>,
    /// By level, by place: photons of all sets.
    count: Vec<Vec<AtomicU32>>,
    /// By level, by place, where there are glossy surfaces at all; filled where the first photon lands on one.
    glossy: Vec<Vec<OnceLock<GlossySums>>>,
    bins: DirectionBins,
    quantum: f64,
    /// 1 / quantum: exact, since both are powers of two.
    per_quantum: f64,
    deposited: AtomicU64,
    lost: AtomicU64,
}

/// Quanta of each channel of each bin, the bins of one set after those of the other.
type GlossySums = Box<[[AtomicI64; 3]]>;

/// The cell a photon was added to.
#[derive(Clone, Copy, Debug)]
pub struct Landing {
    level: usize,
    place: usize,
    set: usize,
}

/// One photon of a billion still is some million quanta, and two thousand times the emitted flux fits in a cell.
const QUANTUM_BITS: f64 = 52.0;

impl<'a> Accumulator<'a> {
    /// An empty accumulator for light of `total_flux` (largest channel) in all; `bins` where glossy surfaces are read from
    /// the pyramid.
    #[must_use]
    pub fn new(layout: &'a Layout, total_flux: f32, bins: Option<DirectionBins>) -> Self {
        // A power of two, so that twice the light gives exactly twice the picture.
        let quantum = (f64::from(total_flux.max(f32::MIN_POSITIVE)).log2().ceil() - QUANTUM_BITS).exp2();
        let cells = layout.levels.iter().map(|level| level.index.len());
        Self {
            layout,
            flux: cells.clone().map(|n| std::iter::repeat_with(Default::default).take(n).collect()).collect(),
            count: cells
                .clone()
                .map(|n| std::iter::repeat_with(Default::default).take(n).collect())
                .collect(),
            glossy: cells
                .map(|n| {
                    std::iter::repeat_with(OnceLock::new).take(if bins.is_some() { n } else { 0 }).collect()
                })
                .collect(),
            bins: bins.unwrap_or(DirectionBins { elevation: 1, azimuth: 1 }),
            quantum,
            per_quantum: quantum.recip(),
            deposited: AtomicU64::new(0),
            lost: AtomicU64::new(0),
        }
    }

    /// Adds a photon of a set that lands at `p` on one side of a surface; gives the cell.
    pub fn deposit(&self, set: usize, p: Vec3, side: Side, flux: Rgb) -> Option<Landing> {
        let class = self.layout.classes.of(side);
        let place = self.layout.find(p, class).filter(|_| flux.is_finite());
        let Some((level, place)) = place else {
            self.lost.fetch_add(1, Ordering::Relaxed);
            return None;
        };
        self.add(&self.flux[level][place][set], flux);
        self.count[level][place].fetch_add(1, Ordering::Relaxed);
        self.deposited.fetch_add(1, Ordering::Relaxed);
        Some(Landing { level, place, set })
    }

    /// Adds what the photon's surface sends in each direction: `leaving` gives flux times BSDF over tint (W·sr⁻¹) towards a
    /// unit vector. `at` in [0, 1)² is where in each bin that is asked; a random place averages over the bin.
    pub fn deposit_glossy(&self, landing: Landing, at: [f32; 2], leaving: impl Fn(Vec3) -> Rgb) {
        let (level, place, count) = (landing.level, landing.place, self.bins.count());
        let empty = || std::iter::repeat_with(Default::default).take(SETS * count).collect();
        let sums = self.glossy[level][place].get_or_init(empty);
        let frame = Frame::new(self.layout.levels[level].surfaces[place].mean_normal());
        for (bin, sum) in sums[landing.set * count..][..count].iter().enumerate() {
            let value = leaving(frame.from_local(self.bins.direction(bin, at)));
            if value.is_finite() && !value.is_black() {
                self.add(sum, value);
            }
        }
    }

    fn add(&self, sums: &[AtomicI64; 3], values: Rgb) {
        for (sum, value) in sums.iter().zip(values.0) {
            #[expect(clippy::cast_possible_truncation, reason = "quantised on purpose")]
            sum.fetch_add((f64::from(value) * self.per_quantum).round() as i64, Ordering::Relaxed);
        }
    }

    /// Photons added.
    #[must_use]
    pub fn deposited(&self) -> u64 {
        self.deposited.load(Ordering::Relaxed)
    }

    /// Photons that found no cell: rounding at slivers, or a flux that was not a number.
    #[must_use]
    pub fn lost(&self) -> u64 {
        self.lost.load(Ordering::Relaxed)
    }

    /// Memory (bytes).
    #[must_use]
    pub fn bytes(&self) -> usize {
        let sums =
            self.flux.iter().map(|level| level.len() * (size_of::<[[i64; 3]; SETS]>() + size_of::<u32>()));
        sums.sum::<usize>() + self.bin_bytes()
    }

    /// Memory (bytes) of the direction bins alone.
    #[must_use]
    pub fn bin_bytes(&self) -> usize {
        let glossy = self.glossy.iter().map(|level| {
            let filled = level.iter().filter(|cell| cell.get().is_some()).count();
            level.len() * size_of::<OnceLock<GlossySums>>()
                + filled * self.bins.count() * size_of::<[[i64; 3]; SETS]>()
        });
        glossy.sum()
    }

    /// What was added, by level and place.
    pub(super) fn into_sums(self) -> Sums {
        let levels = self.flux.into_iter().zip(self.count).map(|(flux, count)| {
            flux.into_iter()
                .zip(count)
                .map(|(flux, count)| CellSum {
                    flux: flux.map(|set| set.map(AtomicI64::into_inner)),
                    count: u64::from(count.into_inner()),
                })
                .collect()
        });
        let plain = |sums: GlossySums| -> Vec<[i64; 3]> {
            sums.into_vec().into_iter().map(|sum| sum.map(AtomicI64::into_inner)).collect()
        };
        let glossy = self.glossy.into_iter().map(|level| {
            let cells = level.into_iter().enumerate();
            cells.filter_map(|(place, cell)| Some((place, plain(cell.into_inner()?)))).collect()
        });
        Sums { cells: levels.collect(), glossy: glossy.collect(), bins: self.bins, quantum: self.quantum }
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
    /// Flux of one quantum.
    pub(super) quantum: f64,
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

//! Flux while photons land: integer sums, so that the order of photons, threads and machines does not matter.

use std::sync::atomic::{AtomicI64, AtomicU32, AtomicU64, Ordering};

use glam::Vec3;

use super::layout::Layout;
use crate::color::Rgb;

/// Flux and photons of every cell that can receive light directly.
#[derive(Debug)]
pub struct Accumulator<'a> {
    layout: &'a Layout,
    /// By level, by place: red, green, blue in quanta.
    flux: Vec<Vec<[AtomicI64; 3]>>,
    count: Vec<Vec<AtomicU32>>,
    quantum: f64,
    deposited: AtomicU64,
    lost: AtomicU64,
}

/// One photon of a billion still is some million quanta, and two thousand times the emitted flux fits in a cell.
const QUANTUM_BITS: f64 = 52.0;

impl<'a> Accumulator<'a> {
    /// An empty accumulator for light of `total_flux` (largest channel) in all.
    #[must_use]
    pub fn new(layout: &'a Layout, total_flux: f32) -> Self {
        // A power of two, so that twice the light gives exactly twice the picture.
        let quantum = (f64::from(total_flux.max(f32::MIN_POSITIVE)).log2().ceil() - QUANTUM_BITS).exp2();
        let cells = layout.levels.iter().map(|level| level.index.len());
        Self {
            layout,
            flux: cells.clone().map(|n| std::iter::repeat_with(Default::default).take(n).collect()).collect(),
            count: cells.map(|n| std::iter::repeat_with(Default::default).take(n).collect()).collect(),
            quantum,
            deposited: AtomicU64::new(0),
            lost: AtomicU64::new(0),
        }
    }

    /// Adds a photon that lands at `p` on the side of a surface whose geometric normal is `normal`.
    pub fn deposit(&self, p: Vec3, normal: Vec3, flux: Rgb) {
        let class = self.layout.classes.of(normal);
        let place = self.layout.find(p, class).filter(|_| flux.is_finite());
        let Some((level, place)) = place else {
            self.lost.fetch_add(1, Ordering::Relaxed);
            return;
        };
        for (sum, value) in self.flux[level][place].iter().zip(flux.0) {
            #[expect(clippy::cast_possible_truncation, reason = "quantised on purpose")]
            sum.fetch_add((f64::from(value) / self.quantum).round() as i64, Ordering::Relaxed);
        }
        self.count[level][place].fetch_add(1, Ordering::Relaxed);
        self.deposited.fetch_add(1, Ordering::Relaxed);
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
        self.flux.iter().map(|level| level.len() * (size_of::<[i64; 3]>() + size_of::<u32>())).sum()
    }

    /// Sums by level and place, and the flux (scene units) of one quantum.
    pub(super) fn into_sums(self) -> (Vec<Vec<CellSum>>, f64) {
        let levels = self.flux.into_iter().zip(self.count).map(|(flux, count)| {
            flux.into_iter()
                .zip(count)
                .map(|(flux, count)| CellSum {
                    flux: flux.map(AtomicI64::into_inner),
                    count: u64::from(count.into_inner()),
                })
                .collect()
        });
        (levels.collect(), self.quantum)
    }
}

/// Light of one cell.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct CellSum {
    /// Quanta of each channel.
    pub flux: [i64; 3],
    /// Photons.
    pub count: u64,
}

impl CellSum {
    pub(super) fn add(&mut self, other: &Self) {
        for c in 0..3 {
            self.flux[c] += other.flux[c];
        }
        self.count += other.count;
    }
}

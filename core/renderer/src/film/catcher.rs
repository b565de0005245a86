//! What shadow catchers leave on the film: no light, but as much alpha as they miss light that they would have without the
//! other objects. Where the film is not transparent, the world shows through them, darkened as much.

use std::sync::{Mutex, PoisonError, RwLock, RwLockReadGuard};

use rayon::prelude::*;

use super::sums::{CHANNELS, Sums, inverse};
use super::{Film, Spread, lock};
use crate::color::Rgb;

/// What one pass finds of a shadow catcher for one pixel, besides its light with all objects.
#[derive(Clone, Copy, Debug, Default)]
pub struct CatcherSample {
    /// Whether the camera sample met a catcher; all else is black if not.
    pub is_caught: bool,
    /// Light from before the catcher.
    pub before: Rgb,
    /// Light of the catcher without the other objects.
    pub without: Rgb,
    /// Light from behind the catcher.
    pub background: Rgb,
}

/// Values of a sample that are summed: what is seen beside catchers as in [`Sums`], light of the catchers without the other
/// objects, and light from behind them.
const CATCHER_CHANNELS: usize = CHANNELS + 6;

type Channels = [f32; CATCHER_CHANNELS];

impl CatcherSample {
    /// What is summed, for a sample of these channels of [`Sums`].
    fn channels(&self, all: &[f32; CHANNELS]) -> Channels {
        let mut channels = [0.0; CATCHER_CHANNELS];
        if self.is_caught {
            channels[..3].copy_from_slice(&self.before.0);
            channels[CHANNELS - 1] = all[CHANNELS - 1];
        } else {
            channels[..CHANNELS].copy_from_slice(all);
        }
        channels[CHANNELS..CHANNELS + 3].copy_from_slice(&self.without.0);
        channels[CHANNELS + 3..].copy_from_slice(&self.background.0);
        channels
    }
}

/// Weighted sums of one pixel over passes.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct CatcherSums {
    /// What is seen beside catchers.
    seen: Sums,
    without: Rgb,
    background: Rgb,
}

impl CatcherSums {
    /// Numbers it is made of.
    pub(super) const VALUES: usize = Sums::VALUES + 6;

    /// The numbers it is made of.
    pub(super) fn values(&self) -> impl Iterator<Item = f32> {
        self.seen.values().into_iter().chain(self.without.0).chain(self.background.0)
    }

    /// From the numbers it is made of.
    pub(super) fn from_values(values: &[f32; Self::VALUES]) -> Self {
        let light = |first: usize| Rgb(std::array::from_fn(|c| values[Sums::VALUES + first + c]));
        let seen = Sums::from_values(values.first_chunk().unwrap_or(&[0.0; Sums::VALUES]));
        Self { seen, without: light(0), background: light(3) }
    }

    fn add(&mut self, weighted: &Channels, gather_rays: f32) {
        let (seen, light) = weighted.split_first_chunk().unwrap_or((&[0.0; CHANNELS], &[]));
        self.seen.add(seen, gather_rays);
        self.without += Rgb(std::array::from_fn(|c| light[c]));
        self.background += Rgb(std::array::from_fn(|c| light[3 + c]));
    }

    /// Both sums together.
    pub(super) fn with(&self, other: &Self) -> Self {
        let (without, background) = (self.without + other.without, self.background + other.background);
        Self { seen: self.seen.with(&other.seen), without, background }
    }

    /// Share of the catchers' light that is left by the other objects, of which `all` are the sums with all light. 1 where
    /// there would be none.
    fn light_left(&self, all: &Sums) -> Rgb {
        let left = all.combined() - self.seen.combined();
        let without = self.without * inverse(self.seen.weight());
        Rgb(std::array::from_fn(|c| if without.0[c] > 0.0 { left.0[c] / without.0[c] } else { 1.0 }))
    }

    /// [`CatcherSums::light_left`], faded to white where the film is transparent.
    pub(super) fn shadow(&self, all: &Sums) -> Rgb {
        Rgb::WHITE.lerp(self.light_left(all), all.alpha())
    }

    /// Radiance and alpha of a pixel of which `all` are the sums with all light.
    pub(super) fn composed(&self, all: &Sums, is_transparent: bool) -> (Rgb, f32) {
        let beside = self.seen.alpha();
        if beside == all.alpha() {
            return (all.combined(), all.alpha());
        }
        let left = self.light_left(all).mean().clamp(0.0, 1.0);
        let alpha = if is_transparent { beside + (all.alpha() - beside) * (1.0 - left) } else { all.alpha() };
        let background = self.background * (inverse(self.seen.weight()) * left);
        (self.seen.combined() + background, alpha)
    }
}

/// What a film keeps where there are shadow catchers.
#[derive(Debug)]
pub(super) struct Catchers {
    pub(super) is_transparent: bool,
    /// Of the pass that is under way, by tile.
    pass: Vec<Mutex<Vec<CatcherSample>>>,
    spread: Mutex<Vec<Channels>>,
    /// Of the passes of either half.
    halves: RwLock<[Vec<CatcherSums>; 2]>,
}

impl Catchers {
    pub(super) fn new(is_transparent: bool, tiles: usize, pixels: usize) -> Self {
        let none = || vec![CatcherSums::default(); pixels];
        Self {
            is_transparent,
            pass: std::iter::repeat_with(Mutex::default).take(tiles).collect(),
            spread: Mutex::default(),
            halves: RwLock::new([none(), none()]),
        }
    }

    /// Memory (bytes) that a pixel takes.
    pub(super) const BYTES_OF_A_PIXEL: u64 =
        (2 * size_of::<CatcherSums>() + size_of::<CatcherSample>() + size_of::<Channels>()) as u64;

    /// Takes the samples of one tile of the pass that is under way, in the order of its pixels. Gives how many were not finite
    /// and are left black.
    pub(super) fn take(&self, tile: usize, mut samples: Vec<CatcherSample>) -> u64 {
        let mut nonfinite = 0;
        for sample in &mut samples {
            if ![sample.before, sample.without, sample.background].iter().all(|light| light.is_finite()) {
                *sample = CatcherSample { is_caught: true, ..CatcherSample::default() };
                nonfinite += 1;
            }
        }
        *lock(&self.pass[tile]) = samples;
        nonfinite
    }

    /// Adds the samples of the pass, which belong to the samples `all` in the order of the picture's pixels, to one half of
    /// the picture.
    pub(super) fn finish_pass(&self, film: &Film, all: &Spread, gather_rays: f32, half: usize) {
        let mut spread = lock(&self.spread);
        spread.clear();
        spread.resize(all.channels.len(), [0.0; CATCHER_CHANNELS]);
        for (rect, tile) in film.tiles.iter().zip(&self.pass) {
            for (i, sample) in std::mem::take(&mut *lock(tile)).iter().enumerate() {
                let at = film.index_in(rect, i);
                spread[at] = sample.channels(&all.channels[at]);
            }
        }
        let mut halves = self.halves.write().unwrap_or_else(PoisonError::into_inner);
        halves[half].par_chunks_mut(film.width.max(1)).enumerate().for_each(|(y, row)| {
            for (x, sums) in row.iter_mut().enumerate() {
                sums.add(&film.around(&spread, &all.weights, [x, y]), gather_rays);
            }
        });
    }

    /// Sums of the passes of either half.
    pub(super) fn halves(&self) -> RwLockReadGuard<'_, [Vec<CatcherSums>; 2]> {
        self.halves.read().unwrap_or_else(PoisonError::into_inner)
    }

    /// Takes the sums of other passes instead.
    pub(super) fn restore(&self, halves: [Vec<CatcherSums>; 2]) {
        *self.halves.write().unwrap_or_else(PoisonError::into_inner) = halves;
    }

    /// The sums of one sample of the pass that is under way, of which `all` are the channels.
    pub(super) fn of_sample(&self, tile: usize, index: usize, all: &[f32; CHANNELS]) -> CatcherSums {
        let mut sums = CatcherSums::default();
        let sample = lock(&self.pass[tile]).get(index).copied().unwrap_or_default();
        sums.add(&sample.channels(all), 1.0);
        sums
    }
}

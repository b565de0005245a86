//! The picture while it is made.
//!
//! One pass gives every pixel one sample at a random place inside it. When the pass is complete, each pixel adds the
//! samples around it, weighted by the pixel filter: neighbours share their samples, which is worth as much as twice the
//! rays. Passes are added in order, so that the sums do not depend on threads or tiles.
//!
//! Passes are kept in two halves that have nothing in common: how far the halves differ tells how far their mean is from
//! the truth.

mod catcher;
mod error;
mod filter;
mod state;
mod sums;

use std::sync::{Mutex, MutexGuard, OnceLock, PoisonError, RwLock};

use rayon::prelude::*;

use crate::color::Rgb;
use crate::settings::FilmSettings;
use crate::stats::PictureError;
pub use catcher::CatcherSample;
use catcher::{CatcherSums, Catchers};
use filter::Filter;
pub use state::FilmState;
use sums::{CHANNELS, Sums};

/// Pixels along an edge of the smallest unit of work; tiles are made of whole blocks, so that the picture does not
/// depend on how it is cut.
pub const BLOCK: u32 = 4;

/// What one pass finds for one pixel.
#[derive(Clone, Copy, Debug, Default)]
pub struct PixelSample {
    /// Where in the pixel, from its centre (pixels).
    pub offset: [f32; 2],
    /// Emission and direct light.
    pub direct: Rgb,
    /// Indirect light, summed over the pass's gather rays.
    pub indirect: Rgb,
    /// Coverage.
    pub alpha: f32,
    /// Whether the pass has been here.
    pub taken: bool,
}

impl PixelSample {
    /// Direct and indirect light, alpha, and 1 for the sample itself: what is summed.
    fn channels(&self) -> [f32; CHANNELS] {
        let ([a, b, c], [d, e, f]) = (self.direct.0, self.indirect.0);
        [a, b, c, d, e, f, self.alpha, 1.0]
    }
}

/// Pixels x, y (from the bottom left), width, height.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TileRect {
    /// Left column.
    pub x: u32,
    /// Bottom row.
    pub y: u32,
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
}

/// The film. Readable at any time: the mean of the complete passes, and before there is one, the samples taken so far.
#[derive(Debug)]
pub struct Film {
    width: usize,
    height: usize,
    filter: Filter,
    exposure: f32,
    tiles: Vec<TileRect>,
    /// Edge of a tile (pixels).
    edge: usize,
    /// Samples of the pass that is under way, by tile.
    pass: Vec<Mutex<Vec<PixelSample>>>,
    spread: Mutex<Spread>,
    halves: RwLock<Halves>,
    nonfinite: Mutex<u64>,
    /// Where the light is known to be wrong; empty where nothing is.
    audit: RwLock<Vec<f32>>,
    /// What is kept where there are shadow catchers, and only there.
    catchers: OnceLock<Catchers>,
}

/// The passes so far.
#[derive(Debug)]
struct Halves {
    /// Of the passes of either half.
    sums: [Vec<Sums>; 2],
    /// How many there are; `None` once one of them was cut short.
    passes: Option<u32>,
}

/// The samples of a pass in the order of the picture's pixels, ready to be added to the pixels around them.
#[derive(Debug, Default)]
struct Spread {
    channels: Vec<[f32; CHANNELS]>,
    /// By sample: its weight along x, then along y, for the pixels from `reach` to the left (below) to `reach` to the
    /// right (above). 0 for samples that were not taken.
    weights: Vec<f32>,
}

impl Film {
    /// A black film, cut into tiles of whole blocks.
    #[must_use]
    pub fn new(width: u32, height: u32, settings: &FilmSettings) -> Self {
        let edge = settings.tile_size.max(1).div_ceil(BLOCK) * BLOCK;
        let mut tiles = Vec::new();
        for y in (0..height).step_by(edge as usize) {
            for x in (0..width).step_by(edge as usize) {
                tiles.push(TileRect { x, y, width: edge.min(width - x), height: edge.min(height - y) });
            }
        }
        let (width, height) = (width as usize, height as usize);
        let black = || vec![Sums::default(); width * height];
        Self {
            width,
            height,
            filter: Filter::new(settings.filter, settings.filter_width),
            exposure: settings.exposure,
            pass: tiles.iter().map(|_| Mutex::default()).collect(),
            tiles,
            edge: edge as usize,
            spread: Mutex::default(),
            halves: RwLock::new(Halves { sums: [black(), black()], passes: Some(0) }),
            nonfinite: Mutex::new(0),
            audit: RwLock::default(),
            catchers: OnceLock::new(),
        }
    }

    /// Memory (bytes) that a film takes, what it copies for its readers included.
    #[must_use]
    pub fn bytes_for(width: u32, height: u32, settings: &FilmSettings) -> u64 {
        let span = 2 * Filter::new(settings.filter, settings.filter_width).reach() + 1;
        let spread = size_of::<[f32; CHANNELS]>() + 2 * span * size_of::<f32>();
        let copy = 4 * size_of::<f32>();
        let pixel = 2 * size_of::<Sums>() + size_of::<PixelSample>() + spread + copy;
        u64::from(width) * u64::from(height) * pixel as u64
    }

    /// Width and height (pixels).
    #[must_use]
    pub const fn size(&self) -> [usize; 2] {
        [self.width, self.height]
    }

    /// The tiles.
    #[must_use]
    pub fn tiles(&self) -> &[TileRect] {
        &self.tiles
    }

    /// Takes the samples of one tile of the pass that is under way: pixel by pixel of the tile, rows from the bottom.
    /// Samples that are not finite are counted and left out.
    pub fn take(&self, tile: usize, mut samples: Vec<PixelSample>) {
        let mut nonfinite = 0;
        for sample in &mut samples {
            if sample.taken && !(sample.direct.is_finite() && sample.indirect.is_finite()) {
                sample.taken = false;
                nonfinite += 1;
            }
        }
        *lock(&self.nonfinite) += nonfinite;
        *lock(&self.pass[tile]) = samples;
    }

    /// Makes room for what shadow catchers leave; whether the film is transparent behind them.
    pub fn expect_catchers(&self, is_transparent: bool) {
        self.catchers
            .get_or_init(|| Catchers::new(is_transparent, self.tiles.len(), self.width * self.height));
    }

    /// Memory (bytes) that shadow catchers take, where there are any.
    #[must_use]
    pub const fn catcher_bytes_for(width: u32, height: u32) -> u64 {
        width as u64 * height as u64 * Catchers::BYTES_OF_A_PIXEL
    }

    /// As [`Film::take`], for what was found of shadow catchers.
    pub fn take_catchers(&self, tile: usize, samples: Vec<CatcherSample>) {
        if let Some(catchers) = self.catchers.get() {
            *lock(&self.nonfinite) += catchers.take(tile, samples);
        }
    }

    /// Adds the samples of the pass, of `gather_rays` rays a pixel, to one half of the picture (0 or 1). A pass that was
    /// cut short, which is not `whole`, adds what it has.
    pub fn finish_pass(&self, gather_rays: u32, half: usize, whole: bool) {
        let mut spread = lock(&self.spread);
        self.prepare(&mut spread);
        let mut halves = self.halves.write().unwrap_or_else(PoisonError::into_inner);
        halves.passes = halves.passes.filter(|_| whole).map(|passes| passes + 1);
        halves.sums[half].par_chunks_mut(self.width.max(1)).enumerate().for_each(|(y, row)| {
            for (x, sums) in row.iter_mut().enumerate() {
                sums.add(&self.around(&spread.channels, &spread.weights, [x, y]), gather_rays as f32);
            }
        });
        if let Some(catchers) = self.catchers.get() {
            catchers.finish_pass(self, &spread, gather_rays as f32, half);
        }
        self.pass.iter().for_each(|tile| lock(tile).clear());
    }

    /// Samples that were left out because they were not finite, over all passes.
    #[must_use]
    pub fn nonfinite(&self) -> u64 {
        *lock(&self.nonfinite)
    }

    /// Red, green, blue (radiance) and alpha of every pixel, rows from the bottom.
    #[must_use]
    pub fn combined(&self) -> Vec<f32> {
        let is_transparent = self.catchers.get().is_some_and(|catchers| catchers.is_transparent);
        self.read(|s, caught| {
            let (light, alpha) =
                caught.map_or_else(|| (s.combined(), s.alpha()), |caught| caught.composed(s, is_transparent));
            let [r, g, b] = (light * self.exposure).0;
            [r, g, b, alpha]
        })
    }

    /// Light that was scattered at least twice: red, green and blue of every pixel, rows from the bottom.
    #[must_use]
    pub fn indirect(&self) -> Vec<f32> {
        self.read(|s, _| (s.indirect() * self.exposure).0)
    }

    /// Share of their light that other objects leave to shadow catchers: red, green and blue of every pixel, rows from the
    /// bottom; 1 where there is no catcher.
    #[must_use]
    pub fn shadow_catcher(&self) -> Vec<f32> {
        self.read(|s, caught| caught.map_or(Rgb::WHITE, |caught| caught.shadow(s)).0)
    }

    /// Standard error of the combined picture, one value per pixel (root mean square of the channels), rows from the
    /// bottom; 0 where only one half knows the pixel.
    #[must_use]
    pub fn error(&self) -> Vec<f32> {
        let halves = self.halves.read().unwrap_or_else(PoisonError::into_inner);
        let [a, b] = &halves.sums;
        a.par_iter().zip(b).map(|(a, b)| self.exposure * error::of_pixel(a, b).sqrt()).collect()
    }

    /// Mean of the whole picture over pixels and channels, before exposure.
    #[must_use]
    pub fn mean(&self) -> f64 {
        let halves = self.halves.read().unwrap_or_else(PoisonError::into_inner);
        let [a, b] = &halves.sums;
        let sum: f64 = a.iter().zip(b).map(|(a, b)| f64::from(a.with(b).combined().mean())).sum();
        sum / (self.width * self.height).max(1) as f64
    }

    /// Keeps what an audit has to show, one value per pixel, rows from the bottom.
    pub fn set_audit(&self, pixels: Option<Vec<f32>>) {
        *self.audit.write().unwrap_or_else(PoisonError::into_inner) = pixels.unwrap_or_default();
    }

    /// Part of each pixel's light that an audit found wrong, rows from the bottom: from -1 (all is missing) to 1 (there
    /// should be none), 0 where nothing is known to be wrong.
    #[must_use]
    pub fn audit(&self) -> Vec<f32> {
        let audit = self.audit.read().unwrap_or_else(PoisonError::into_inner);
        if audit.is_empty() { vec![0.0; self.width * self.height] } else { audit.clone() }
    }

    /// Standard error of the whole picture; `None` before both halves know it.
    #[must_use]
    pub fn picture_error(&self) -> Option<PictureError> {
        let halves = self.halves.read().unwrap_or_else(PoisonError::into_inner);
        let [a, b] = &halves.sums;
        error::of_picture(a, b, self.width)
    }

    fn read<const N: usize>(&self, value: impl Fn(&Sums, Option<CatcherSums>) -> [f32; N]) -> Vec<f32> {
        let catchers = self.catchers.get();
        let halves = self.halves.read().unwrap_or_else(PoisonError::into_inner);
        let [a, b] = &halves.sums;
        if a.iter().any(Sums::is_known) {
            let caught = catchers.map(Catchers::halves);
            let of_pixel = |i: usize| caught.as_ref().map(|halves| halves[0][i].with(&halves[1][i]));
            let pixels = a.iter().zip(b).enumerate();
            return pixels.flat_map(|(i, (a, b))| value(&a.with(b), of_pixel(i))).collect();
        }
        drop(halves);
        let mut pixels = vec![value(&Sums::default(), None); self.width * self.height];
        for (index, (rect, tile)) in self.tiles.iter().zip(&self.pass).enumerate() {
            for (i, sample) in lock(tile).iter().enumerate().filter(|(_, sample)| sample.taken) {
                let (mut sums, channels) = (Sums::default(), sample.channels());
                sums.add(&channels, 1.0);
                let caught = catchers.map(|catchers| catchers.of_sample(index, i, &channels));
                pixels[self.index_in(rect, i)] = value(&sums, caught);
            }
        }
        pixels.into_iter().flatten().collect()
    }

    /// Index in the picture of pixel `index` of a tile.
    const fn index_in(&self, rect: &TileRect, index: usize) -> usize {
        let (x, y) = (index % rect.width as usize, index / rect.width as usize);
        (rect.y as usize + y) * self.width + rect.x as usize + x
    }

    /// Lays out the samples of the pass that is under way.
    fn prepare(&self, spread: &mut Spread) {
        let span = self.span();
        spread.channels.clear();
        spread.channels.resize(self.width * self.height, [0.0; CHANNELS]);
        spread.weights.clear();
        spread.weights.resize(self.width * self.height * 2 * span, 0.0);
        let band = (self.edge * self.width).max(1);
        let bands = spread.channels.par_chunks_mut(band).zip(spread.weights.par_chunks_mut(band * 2 * span));
        let tiles_across = self.width.div_ceil(self.edge).max(1);
        bands.zip(self.tiles.par_chunks(tiles_across)).zip(self.pass.par_chunks(tiles_across)).for_each(
            |(((channels, weights), rects), tiles)| {
                for (rect, tile) in rects.iter().zip(tiles) {
                    for (i, sample) in lock(tile).iter().enumerate().filter(|(_, sample)| sample.taken) {
                        let (x, y) = (i % rect.width as usize, i / rect.width as usize);
                        let at = y * self.width + rect.x as usize + x;
                        channels[at] = sample.channels();
                        let (along_x, along_y) = weights[at * 2 * span..][..2 * span].split_at_mut(span);
                        self.filter.weigh(sample.offset[0], along_x);
                        self.filter.weigh(sample.offset[1], along_y);
                    }
                }
            },
        );
    }

    /// Pixels along which the filter spreads a sample.
    fn span(&self) -> usize {
        2 * self.filter.reach() + 1
    }

    /// Sum of the samples that the filter of a pixel reaches.
    #[inline]
    fn around<const N: usize>(&self, channels: &[[f32; N]], weights: &[f32], [x, y]: [usize; 2]) -> [f32; N] {
        let (reach, span) = (self.filter.reach(), self.span());
        let mut sum = [0.0; N];
        for ny in y.saturating_sub(reach)..(y + reach + 1).min(self.height) {
            for nx in x.saturating_sub(reach)..(x + reach + 1).min(self.width) {
                let index = ny * self.width + nx;
                let weights = &weights[index * 2 * span..][..2 * span];
                let weight = weights[x + reach - nx] * weights[span + y + reach - ny];
                let channels = &channels[index];
                for c in 0..N {
                    sum[c] += weight * channels[c];
                }
            }
        }
        sum
    }
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    // What is behind these locks is only ever replaced whole.
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::PixelFilter;

    fn film(filter: PixelFilter, filter_width: f32) -> Film {
        Film::new(13, 9, &FilmSettings { filter, filter_width, tile_size: 5, ..FilmSettings::default() })
    }

    fn pass(film: &Film, rays: u32, half: usize, mut value: impl FnMut(u32, u32) -> PixelSample) {
        for (index, rect) in film.tiles().iter().enumerate() {
            let pixels =
                (0..rect.width * rect.height).map(|i| (rect.x + i % rect.width, rect.y + i / rect.width));
            film.take(index, pixels.map(|(x, y)| value(x, y)).collect());
        }
        film.finish_pass(rays, half, true);
    }

    #[test]
    fn a_box_of_one_pixel_gives_means_over_passes() {
        let film = film(PixelFilter::Box, 1.0);
        for n in 0..3 {
            pass(&film, 4, n as usize % 2, |x, y| {
                let value = Rgb::splat((x + 100 * y + n) as f32);
                PixelSample {
                    offset: [0.49, -0.5],
                    direct: value,
                    indirect: value * 8.0,
                    alpha: 1.0,
                    taken: true,
                }
            });
        }
        for (i, pixel) in film.combined().chunks(4).enumerate() {
            let mean = (i % 13 + 100 * (i / 13)) as f32 + 1.0;
            assert_eq!(pixel, [3.0 * mean, 3.0 * mean, 3.0 * mean, 1.0]);
        }
        assert_eq!(film.indirect().len(), 13 * 9 * 3);
    }

    #[test]
    fn any_filter_keeps_a_constant() {
        let film = film(PixelFilter::BlackmanHarris, 1.5);
        for n in 0..5_u32 {
            pass(&film, 16, n as usize % 2, |x, y| {
                let offset = [(x * 7 + n * 3) % 10, (y * 3 + n) % 10].map(|v| v as f32 / 10.0 - 0.5);
                let (direct, indirect) = (Rgb::splat(2.0), Rgb::splat(16.0));
                PixelSample { offset, direct, indirect, alpha: 1.0, taken: true }
            });
        }
        assert!(film.combined().chunks(4).all(|p| (p[0] - 3.0).abs() < 1e-6 && (p[3] - 1.0).abs() < 1e-6));
    }

    #[test]
    fn exposure_is_a_factor_of_light_alone() {
        let settings = FilmSettings { exposure: 2.5, ..FilmSettings::default() };
        let film = Film::new(8, 4, &settings);
        for (half, light) in [1.0, 3.0].into_iter().enumerate() {
            pass(&film, 1, half, |_, _| {
                let (direct, indirect) = (Rgb::splat(light), Rgb::splat(2.0));
                PixelSample { direct, indirect, alpha: 0.5, taken: true, ..Default::default() }
            });
        }
        let close = |values: Vec<f32>, expected: f32| values.iter().all(|v| (v - expected).abs() < 1e-5);
        assert!(film.combined().chunks(4).all(|p| (p[0] - 10.0).abs() < 1e-5 && (p[3] - 0.5).abs() < 1e-6));
        assert!(close(film.indirect(), 5.0) && close(film.error(), 2.5));
        assert!((film.picture_error().unwrap().rms_mean - 25.0).abs() < 1e-4, "relative to the picture");
    }

    #[test]
    fn what_is_not_finite_is_left_out_and_counted() {
        let film = film(PixelFilter::BlackmanHarris, 1.5);
        pass(&film, 1, 0, |x, y| PixelSample {
            direct: Rgb::splat(if (x, y) == (3, 3) { f32::NAN } else { 4.0 }),
            taken: true,
            ..Default::default()
        });
        assert_eq!(film.nonfinite(), 1);
        assert!(film.combined().chunks(4).all(|p| (p[0] - 4.0).abs() < 1e-6));
    }

    #[test]
    fn a_pass_under_way_is_seen() {
        let film = film(PixelFilter::BlackmanHarris, 1.5);
        let sample = PixelSample { direct: Rgb::splat(1.0), alpha: 1.0, taken: true, ..Default::default() };
        film.take(0, vec![sample; 64]);
        let seen = film.combined().chunks(4).filter(|p| p[0] == 1.0).count();
        assert_eq!(seen, 64);
    }

    /// Two halves of known difference, and passes of known noise.
    #[test]
    fn the_error_is_that_of_the_mean() {
        let film = film(PixelFilter::Box, 1.0);
        let value = |light: f32| PixelSample {
            direct: Rgb::splat(light),
            alpha: 1.0,
            taken: true,
            ..Default::default()
        };
        pass(&film, 1, 0, |_, _| value(3.0));
        assert_eq!(film.picture_error(), None);
        pass(&film, 1, 1, |_, _| value(5.0));
        // The mean is 4, each half lies 1 from it.
        let error = film.picture_error().unwrap();
        assert!((error.rms_mean - 25.0).abs() < 1e-5 && (error.rms_peak - 25.0).abs() < 1e-5, "{error:?}");
        assert!(film.error().iter().all(|&e| (e - 1.0).abs() < 1e-6));
        // Sixteen passes of uniform noise of width 2 about 4: 2 / sqrt(12) / sqrt(16), in percent of 4.
        let film = Film::new(200, 200, &FilmSettings::default());
        for n in 0..16_u64 {
            let mut rng = crate::sampling::Rng::new(n);
            pass(&film, 1, n as usize % 2, |_, _| {
                let offset = [rng.draw() - 0.5, rng.draw() - 0.5];
                PixelSample { offset, ..value(3.0 + 2.0 * rng.draw()) }
            });
        }
        let picture = film.combined();
        let squares: f64 = picture.chunks(4).map(|p| (f64::from(p[0]) - 4.0).powi(2)).sum();
        let truth = (squares / 40_000.0).sqrt() / 4.0 * 100.0;
        let error = film.picture_error().unwrap().rms_mean;
        assert!((error / truth - 1.0).abs() < 0.05, "{error} against {truth}");
    }
}

//! The picture while it is made.
//!
//! One pass gives every pixel one sample at a random place inside it. When the pass is complete, each pixel adds the
//! samples around it, weighted by the pixel filter: neighbours share their samples, which is worth as much as twice the
//! rays. Passes are added in order, so that the sums do not depend on threads or tiles.

mod filter;

use std::sync::{Mutex, MutexGuard, PoisonError, RwLock};

use rayon::prelude::*;

use crate::color::Rgb;
use crate::settings::FilmSettings;
use filter::Filter;

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

/// Weighted sums of one pixel.
#[derive(Clone, Copy, Debug, Default)]
struct Sums {
    direct: [f64; 3],
    indirect: [f64; 3],
    alpha: f64,
    /// Of the samples.
    weight: f64,
    /// Of the gather rays.
    ray_weight: f64,
}

/// The film. Readable at any time: the mean of the complete passes, and before there is one, the samples taken so far.
#[derive(Debug)]
pub struct Film {
    width: usize,
    height: usize,
    filter: Filter,
    tiles: Vec<TileRect>,
    /// Samples of the pass that is under way, by tile.
    pass: Vec<Mutex<Vec<PixelSample>>>,
    sums: RwLock<Vec<Sums>>,
    nonfinite: Mutex<u64>,
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
        Self {
            width,
            height,
            filter: Filter::new(settings.filter, settings.filter_width),
            pass: tiles.iter().map(|_| Mutex::default()).collect(),
            tiles,
            sums: RwLock::new(vec![Sums::default(); width * height]),
            nonfinite: Mutex::new(0),
        }
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

    /// Adds the samples of the pass, of `gather_rays` rays a pixel, to the picture. A pass that was cut short adds what it
    /// has.
    pub fn finish_pass(&self, gather_rays: u32) {
        let samples = self.samples();
        let reached = self.weights(&samples);
        let mut sums = self.sums.write().unwrap_or_else(PoisonError::into_inner);
        sums.par_chunks_mut(self.width.max(1)).enumerate().for_each(|(y, row)| {
            for (x, sum) in row.iter_mut().enumerate() {
                self.add_around(sum, &samples, &reached, [x, y], f64::from(gather_rays));
            }
        });
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
        self.read(|s| {
            let (per_sample, per_ray) = (inverse(s.weight), inverse(s.ray_weight));
            let channel = |c: usize| to_f32(s.direct[c] * per_sample + s.indirect[c] * per_ray);
            [channel(0), channel(1), channel(2), to_f32(s.alpha * per_sample)]
        })
    }

    /// Light that was scattered at least twice: red, green and blue of every pixel, rows from the bottom.
    #[must_use]
    pub fn indirect(&self) -> Vec<f32> {
        self.read(|s| s.indirect.map(|c| to_f32(c * inverse(s.ray_weight))))
    }

    fn read<const N: usize>(&self, value: impl Fn(&Sums) -> [f32; N]) -> Vec<f32> {
        let sums = self.sums.read().unwrap_or_else(PoisonError::into_inner);
        let begun = sums.iter().any(|sum| sum.weight > 0.0);
        if begun {
            return sums.iter().flat_map(value).collect();
        }
        drop(sums);
        let first = |sample: &PixelSample| {
            let mut sum = Sums::default();
            if sample.taken {
                sum.add(sample, 1.0, 1.0);
            }
            value(&sum)
        };
        self.samples().iter().flat_map(first).collect()
    }

    /// Samples of the pass that is under way, by pixel.
    fn samples(&self) -> Vec<PixelSample> {
        let mut samples = vec![PixelSample::default(); self.width * self.height];
        for (rect, tile) in self.tiles.iter().zip(&self.pass) {
            for (row, pixels) in lock(tile).chunks(rect.width as usize).enumerate() {
                let start = (rect.y as usize + row) * self.width + rect.x as usize;
                samples[start..start + pixels.len()].copy_from_slice(pixels);
            }
        }
        samples
    }

    /// Adds to a pixel the samples its filter reaches. `reached` holds, for each sample, its weight along x and along y for
    /// the pixels `reach` to the left (below) up to `reach` to the right (above).
    fn add_around(
        &self,
        sum: &mut Sums,
        samples: &[PixelSample],
        reached: &[f32],
        [x, y]: [usize; 2],
        rays: f64,
    ) {
        let reach = self.filter.reach();
        let span = 2 * reach + 1;
        for ny in y.saturating_sub(reach)..(y + reach + 1).min(self.height) {
            for nx in x.saturating_sub(reach)..(x + reach + 1).min(self.width) {
                let index = ny * self.width + nx;
                let along = &reached[index * 2 * span..][..2 * span];
                let weight = along[x + reach - nx] * along[span + y + reach - ny];
                if weight > 0.0 {
                    sum.add(&samples[index], f64::from(weight), rays);
                }
            }
        }
    }

    /// See [`Film::add_around`]; samples that were not taken weigh nothing.
    fn weights(&self, samples: &[PixelSample]) -> Vec<f32> {
        let reach = self.filter.reach() as i32;
        let along = |offset: f32, taken: bool| {
            (-reach..=reach)
                .map(move |pixel| if taken { self.filter.weight(offset - pixel as f32) } else { 0.0 })
        };
        let of = |s: &PixelSample| along(s.offset[0], s.taken).chain(along(s.offset[1], s.taken));
        samples.par_iter().flat_map_iter(of).collect()
    }
}

impl Sums {
    fn add(&mut self, sample: &PixelSample, weight: f64, gather_rays: f64) {
        for c in 0..3 {
            self.direct[c] += weight * f64::from(sample.direct.0[c]);
            self.indirect[c] += weight * f64::from(sample.indirect.0[c]);
        }
        self.alpha += weight * f64::from(sample.alpha);
        self.weight += weight;
        self.ray_weight += weight * gather_rays;
    }
}

fn inverse(weight: f64) -> f64 {
    if weight > 0.0 { 1.0 / weight } else { 0.0 }
}

#[expect(clippy::cast_possible_truncation, reason = "the picture is f32")]
fn to_f32(value: f64) -> f32 {
    value as f32
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
        Film::new(13, 9, &FilmSettings { filter, filter_width, tile_size: 5 })
    }

    fn pass(film: &Film, rays: u32, value: impl Fn(u32, u32) -> PixelSample) {
        for (index, rect) in film.tiles().iter().enumerate() {
            let pixels =
                (0..rect.width * rect.height).map(|i| (rect.x + i % rect.width, rect.y + i / rect.width));
            film.take(index, pixels.map(|(x, y)| value(x, y)).collect());
        }
        film.finish_pass(rays);
    }

    #[test]
    fn a_box_of_one_pixel_gives_means_over_passes() {
        let film = film(PixelFilter::Box, 1.0);
        for n in 0..3 {
            pass(&film, 4, |x, y| {
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
            pass(&film, 16, |x, y| {
                let offset = [(x * 7 + n * 3) % 10, (y * 3 + n) % 10].map(|v| v as f32 / 10.0 - 0.5);
                let (direct, indirect) = (Rgb::splat(2.0), Rgb::splat(16.0));
                PixelSample { offset, direct, indirect, alpha: 1.0, taken: true }
            });
        }
        assert!(film.combined().chunks(4).all(|p| (p[0] - 3.0).abs() < 1e-6 && (p[3] - 1.0).abs() < 1e-6));
    }

    #[test]
    fn what_is_not_finite_is_left_out_and_counted() {
        let film = film(PixelFilter::BlackmanHarris, 1.5);
        pass(&film, 1, |x, y| PixelSample {
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
}

//! The picture while it is made: sums per pixel, added pass by pass in a fixed order, tile by tile.

use std::sync::{Mutex, MutexGuard, PoisonError};

use crate::color::Rgb;

/// Pixels along an edge of the smallest unit of work; tiles are made of whole blocks, so that the picture does not
/// depend on how it is cut.
pub const BLOCK: u32 = 4;

/// What one pass adds to one pixel: sums over its camera samples and gather rays.
#[derive(Clone, Copy, Debug, Default)]
pub struct PixelSums {
    /// Emission and direct light, summed over camera samples.
    pub direct: Rgb,
    /// Indirect light, summed over gather rays.
    pub indirect: Rgb,
    /// Coverage, summed over camera samples.
    pub alpha: f32,
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

#[derive(Clone, Copy, Debug, Default)]
struct Accumulated {
    direct: [f64; 3],
    indirect: [f64; 3],
    alpha: f64,
}

#[derive(Debug)]
struct Tile {
    rect: TileRect,
    pixels: Vec<Accumulated>,
    camera_samples: u64,
    gather_rays: u64,
    nonfinite: u64,
}

/// The film. Readable at any time: every tile shows the mean of the passes it has.
#[derive(Debug)]
pub struct Film {
    width: u32,
    height: u32,
    tiles: Vec<Mutex<Tile>>,
}

impl Film {
    /// A black film, cut into tiles of `tile_size` pixels rounded up to whole blocks.
    #[must_use]
    pub fn new(width: u32, height: u32, tile_size: u32) -> Self {
        let edge = tile_size.max(1).div_ceil(BLOCK) * BLOCK;
        let mut tiles = Vec::new();
        for y in (0..height).step_by(edge as usize) {
            for x in (0..width).step_by(edge as usize) {
                let rect = TileRect { x, y, width: edge.min(width - x), height: edge.min(height - y) };
                let pixels = vec![Accumulated::default(); (rect.width * rect.height) as usize];
                tiles.push(Mutex::new(Tile {
                    rect,
                    pixels,
                    camera_samples: 0,
                    gather_rays: 0,
                    nonfinite: 0,
                }));
            }
        }
        Self { width, height, tiles }
    }

    /// Width and height (pixels).
    #[must_use]
    pub const fn size(&self) -> [u32; 2] {
        [self.width, self.height]
    }

    /// Number of tiles.
    #[must_use]
    pub const fn tile_count(&self) -> usize {
        self.tiles.len()
    }

    /// Where tile `index` lies.
    #[must_use]
    pub fn tile(&self, index: usize) -> TileRect {
        self.lock(index).rect
    }

    /// Adds one pass over one tile: `sums` by pixel of the tile, rows from the bottom, of so many camera samples and
    /// gather rays per pixel. Sums that are not finite are counted and left out.
    pub fn add(&self, index: usize, sums: &[PixelSums], camera_samples: u32, gather_rays: u32) {
        let mut tile = self.lock(index);
        let mut nonfinite = 0;
        for (pixel, sum) in tile.pixels.iter_mut().zip(sums) {
            if !(sum.direct.is_finite() && sum.indirect.is_finite()) {
                nonfinite += 1;
                continue;
            }
            for c in 0..3 {
                pixel.direct[c] += f64::from(sum.direct.0[c]);
                pixel.indirect[c] += f64::from(sum.indirect.0[c]);
            }
            pixel.alpha += f64::from(sum.alpha);
        }
        tile.nonfinite += nonfinite;
        tile.camera_samples += u64::from(camera_samples);
        tile.gather_rays += u64::from(gather_rays);
    }

    /// Pixels that were left out, over all passes.
    #[must_use]
    pub fn nonfinite(&self) -> u64 {
        (0..self.tiles.len()).map(|i| self.lock(i).nonfinite).sum()
    }

    /// Red, green, blue (radiance) and alpha of every pixel, rows from the bottom.
    #[must_use]
    pub fn combined(&self) -> Vec<f32> {
        self.read(|pixel, per_sample, per_ray| {
            let channel = |c: usize| to_f32(pixel.direct[c] * per_sample + pixel.indirect[c] * per_ray);
            [channel(0), channel(1), channel(2), to_f32(pixel.alpha * per_sample)]
        })
    }

    /// Light that was scattered at least twice: red, green and blue of every pixel, rows from the bottom.
    #[must_use]
    pub fn indirect(&self) -> Vec<f32> {
        self.read(|pixel, _, per_ray| pixel.indirect.map(|c| to_f32(c * per_ray)))
    }

    fn read<const N: usize>(&self, value: impl Fn(&Accumulated, f64, f64) -> [f32; N]) -> Vec<f32> {
        let mut picture = vec![0.0; self.width as usize * self.height as usize * N];
        for index in 0..self.tiles.len() {
            let tile = self.lock(index);
            let (per_sample, per_ray) = (inverse(tile.camera_samples), inverse(tile.gather_rays));
            for (row, pixels) in tile.pixels.chunks(tile.rect.width as usize).enumerate() {
                let start = ((tile.rect.y as usize + row) * self.width as usize + tile.rect.x as usize) * N;
                for (out, pixel) in picture[start..].chunks_mut(N).zip(pixels) {
                    out.copy_from_slice(&value(pixel, per_sample, per_ray));
                }
            }
        }
        picture
    }

    fn lock(&self, index: usize) -> MutexGuard<'_, Tile> {
        // Sums are only ever added whole; a panic elsewhere leaves them readable.
        self.tiles[index].lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[expect(clippy::cast_precision_loss, reason = "sample counts are far below 2^52")]
fn inverse(count: u64) -> f64 {
    if count == 0 { 0.0 } else { 1.0 / count as f64 }
}

#[expect(clippy::cast_possible_truncation, reason = "the picture is f32")]
fn to_f32(value: f64) -> f32 {
    value as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiles_cover_every_pixel_once_and_means_are_means() {
        let film = Film::new(13, 9, 5);
        for pass in 0..3 {
            for index in 0..film.tile_count() {
                let rect = film.tile(index);
                let sums: Vec<_> = (0..rect.width * rect.height)
                    .map(|i| {
                        let (x, y) = (rect.x + i % rect.width, rect.y + i / rect.width);
                        let value = Rgb::splat((x + 100 * y + pass) as f32);
                        PixelSums { direct: value * 2.0, indirect: value * 8.0, alpha: 2.0 }
                    })
                    .collect();
                film.add(index, &sums, 2, 4);
            }
        }
        for (i, pixel) in film.combined().chunks(4).enumerate() {
            let mean = (i % 13 + 100 * (i / 13)) as f32 + 1.0;
            assert_eq!(pixel, [3.0 * mean, 3.0 * mean, 3.0 * mean, 1.0]);
        }
        assert_eq!(film.indirect().len(), 13 * 9 * 3);
    }

    #[test]
    fn what_is_not_finite_is_left_out_and_counted() {
        let film = Film::new(1, 1, 64);
        film.add(0, &[PixelSums { direct: Rgb::splat(f32::NAN), ..Default::default() }], 1, 1);
        film.add(0, &[PixelSums { direct: Rgb::splat(4.0), indirect: Rgb::BLACK, alpha: 1.0 }], 1, 1);
        assert_eq!(film.nonfinite(), 1);
        assert!(film.combined().iter().all(|v| v.is_finite()));
    }
}

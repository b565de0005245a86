//! Images as textures: pixels, their smaller versions, and looking one up.
//!
//! Within a level texels are interpolated as they are stored and decoded afterwards, as Cycles does. The smaller levels are
//! means of the decoded colors: that is what a blurred view of the texture is.

use std::sync::LazyLock;

use glam::Vec4;
use serde::Deserialize;

/// What lies beyond the edges of an image.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Extension {
    /// The image again.
    Repeat,
    /// The nearest texel of the edge.
    Extend,
    /// Transparent black.
    Clip,
    /// The image mirrored, and again.
    Mirror,
}

/// What lies between the centers of texels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Interpolation {
    /// The nearest texel.
    Closest,
    /// Bilinear.
    Linear,
    /// A cubic B-spline, which blurs: Blender's Cubic and Smart.
    Cubic,
}

/// How stored numbers stand for colors.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Encoding {
    /// As they are.
    Linear,
    /// By the transfer function of sRGB (IEC 61966-2-1); alpha as it is.
    Srgb,
}

/// Texels, red, green, blue and alpha; the color multiplied by alpha.
#[derive(Clone, Debug)]
pub enum Pixels {
    /// 0 to 255 for 0 to 1.
    Bytes(Vec<[u8; 4]>),
    /// Any number.
    Floats(Vec<[f32; 4]>),
}

impl Pixels {
    fn len(&self) -> usize {
        match self {
            Self::Bytes(texels) => texels.len(),
            Self::Floats(texels) => texels.len(),
        }
    }

    #[inline]
    fn get(&self, index: usize) -> Vec4 {
        match self {
            Self::Bytes(texels) => Vec4::from_array(texels[index].map(|c| f32::from(c) * (1.0 / 255.0))),
            Self::Floats(texels) => Vec4::from_array(texels[index]),
        }
    }

    fn bytes(&self) -> usize {
        match self {
            Self::Bytes(texels) => size_of_val(texels.as_slice()),
            Self::Floats(texels) => size_of_val(texels.as_slice()),
        }
    }

    /// As many texels of the same kind from colors.
    fn like(&self, colors: impl Iterator<Item = Vec4>) -> Self {
        match self {
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to a byte")]
            Self::Bytes(_) => Self::Bytes(
                colors
                    .map(|c| (c.clamp(Vec4::ZERO, Vec4::ONE) * 255.0 + 0.5).to_array().map(|c| c as u8))
                    .collect(),
            ),
            Self::Floats(_) => Self::Floats(colors.map(|c| c.to_array()).collect()),
        }
    }
}

#[derive(Clone, Debug)]
struct Level {
    size: [usize; 2],
    pixels: Pixels,
}

/// An image and its smaller versions, each half as wide and high as the one before.
#[derive(Clone, Debug)]
pub struct Texture {
    levels: Vec<Level>,
    encoding: Encoding,
}

impl Texture {
    /// From `size` = [width, height] texels, rows from the bottom.
    ///
    /// # Errors
    /// No texel, or more or fewer than `size` says.
    pub fn new(size: [usize; 2], pixels: Pixels, encoding: Encoding) -> Result<Self, String> {
        let count = size[0].saturating_mul(size[1]);
        if count == 0 || pixels.len() != count {
            return Err(format!("{} texels for an image of {} x {}", pixels.len(), size[0], size[1]));
        }
        let mut levels = vec![Level { size, pixels }];
        while let Some(last) = levels.last().filter(|level| level.size != [1, 1]) {
            let next = halved(last, encoding);
            levels.push(next);
        }
        Ok(Self { levels, encoding })
    }

    /// Width and height in texels.
    #[must_use]
    pub fn size(&self) -> [usize; 2] {
        self.levels[0].size
    }

    /// Memory of all levels.
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.levels.iter().map(|level| level.pixels.bytes()).sum()
    }

    /// The color, linear, at `at` (the image is the unit square, (0, 0) its lower left corner) over a square of edge `width`.
    /// With `unassociate` it is divided by its alpha. Where `at` is not a number it is transparent black.
    #[must_use]
    pub fn color(
        &self,
        at: [f32; 2],
        width: f32,
        extension: Extension,
        interpolation: Interpolation,
        unassociate: bool,
    ) -> Vec4 {
        let [columns, rows] = self.size().map(|n| n as f32);
        // Not a number, or farther out than numbers go: there is no image.
        if !(at[0] * columns + at[1] * rows).is_finite() {
            return Vec4::ZERO;
        }
        let level = &self.levels[self.level_for(width)];
        let mut color = match interpolation {
            Interpolation::Closest => level.texel(level.cell(at, 0.0).0, extension),
            Interpolation::Linear => level.bilinear(at, extension),
            Interpolation::Cubic => level.bicubic(at, extension),
        };
        if unassociate && color.w != 0.0 && color.w != 1.0 {
            color = (color / color.w).truncate().extend(color.w);
        }
        decoded(color, self.encoding)
    }

    /// The level whose texels are as wide as `width`, rather a finer one than a coarser one.
    fn level_for(&self, width: f32) -> usize {
        let [x, y] = self.levels[0].size;
        let texels = width * ((x * y) as f32).sqrt();
        // Not a number and less than 1 ask for the finest: the conversion makes 0 of both.
        (texels.log2() as usize).min(self.levels.len() - 1)
    }
}

impl Level {
    /// Column and row of the texel whose center lies below and left of `at` shifted by `shift` texels, and how far from it
    /// `at` is.
    #[inline]
    fn cell(&self, at: [f32; 2], shift: f32) -> ([i64; 2], [f32; 2]) {
        let mut cell = [0; 2];
        let mut beyond = [0.0; 2];
        for axis in 0..2 {
            let x = at[axis] * self.size[axis] as f32 + shift;
            let floor = x.floor();
            (cell[axis], beyond[axis]) = (floor as i64, x - floor);
        }
        (cell, beyond)
    }

    fn bilinear(&self, at: [f32; 2], extension: Extension) -> Vec4 {
        let ([x, y], [s, t]) = self.cell(at, -0.5);
        let row = |y: i64| {
            let (a, b) = (self.texel([x, y], extension), self.texel([x.saturating_add(1), y], extension));
            a + (b - a) * s
        };
        let (low, high) = (row(y), row(y.saturating_add(1)));
        low + (high - low) * t
    }

    fn bicubic(&self, at: [f32; 2], extension: Extension) -> Vec4 {
        let ([x, y], beyond) = self.cell(at, -0.5);
        let [columns, rows] = beyond.map(spline);
        let mut sum = Vec4::ZERO;
        for (dy, of_row) in (-1..).zip(rows) {
            for (dx, of_column) in (-1..).zip(columns) {
                let texel = self.texel([x.saturating_add(dx), y.saturating_add(dy)], extension);
                sum += texel * (of_row * of_column);
            }
        }
        sum
    }

    #[inline]
    fn texel(&self, cell: [i64; 2], extension: Extension) -> Vec4 {
        let mut place = [0; 2];
        for axis in 0..2 {
            let count = self.size[axis] as i64;
            let index = cell[axis];
            let inside = match extension {
                Extension::Repeat => index.rem_euclid(count),
                Extension::Extend => index.clamp(0, count - 1),
                Extension::Clip if index < 0 || index >= count => return Vec4::ZERO,
                Extension::Clip => index,
                Extension::Mirror => {
                    let index = index.rem_euclid(2 * count);
                    index.min(2 * count - 1 - index)
                }
            };
            place[axis] = inside as usize;
        }
        self.pixels.get(place[1] * self.size[0] + place[0])
    }
}

/// Weights of four points in a row at `t` from the second to the third: the uniform cubic B-spline.
fn spline(t: f32) -> [f32; 4] {
    let (t2, t3) = (t * t, t * t * t);
    [(1.0 - t).powi(3) / 6.0, (3.0 * t3 - 6.0 * t2 + 4.0) / 6.0, (3.0 * (t + t2 - t3) + 1.0) / 6.0, t3 / 6.0]
}

/// Half the size, each texel the mean of those it covers.
fn halved(level: &Level, encoding: Encoding) -> Level {
    let [width, height] = level.size;
    let size = level.size.map(|n| (n / 2).max(1));
    let (columns, rows) = (shares(width, size[0]), shares(height, size[1]));
    let texel = |(row, column): (usize, usize)| {
        let mut sum = Vec4::ZERO;
        for &(y, of_row) in &rows[row] {
            for &(x, of_column) in &columns[column] {
                sum += decoded(level.pixels.get(y * width + x), encoding) * (of_row * of_column);
            }
        }
        encoded(sum, encoding)
    };
    let places = (0..size[1]).flat_map(|row| (0..size[0]).map(move |column| (row, column)));
    Level { size, pixels: level.pixels.like(places.map(texel)) }
}

/// For each of `to` equal parts of a line of `from` texels: the texels it covers and their shares of it.
fn shares(from: usize, to: usize) -> Vec<Vec<(usize, f32)>> {
    let ratio = from as f64 / to as f64;
    let part = |i: usize| {
        let (low, high) = (i as f64 * ratio, (i + 1) as f64 * ratio);
        let covered = low.floor() as usize..(high.ceil() as usize).min(from);
        covered
            .map(|j| (j, ((high.min((j + 1) as f64) - low.max(j as f64)) / ratio) as f32))
            .filter(|&(_, share)| share > 1e-6)
            .collect()
    };
    (0..to).map(part).collect()
}

fn decoded(color: Vec4, encoding: Encoding) -> Vec4 {
    match encoding {
        Encoding::Linear => color,
        Encoding::Srgb => Vec4::new(from_srgb(color.x), from_srgb(color.y), from_srgb(color.z), color.w),
    }
}

fn encoded(color: Vec4, encoding: Encoding) -> Vec4 {
    match encoding {
        Encoding::Linear => color,
        Encoding::Srgb => Vec4::new(to_srgb(color.x), to_srgb(color.y), to_srgb(color.z), color.w),
    }
}

/// Steps of the table that stands for the transfer function between 0 and 1; linear between them it is exact to 10⁻⁷.
const STEPS: usize = 2040;

static FROM_SRGB: LazyLock<Vec<f32>> =
    LazyLock::new(|| (0..=STEPS).map(|i| transfer(i as f32 / STEPS as f32)).collect());

fn from_srgb(c: f32) -> f32 {
    if !(0.0..1.0).contains(&c) {
        return transfer(c);
    }
    let x = c * STEPS as f32;
    let i = x as usize;
    let (low, high) = (FROM_SRGB[i], FROM_SRGB[i + 1]);
    low + (high - low) * (x - i as f32)
}

fn transfer(c: f32) -> f32 {
    if c <= 0.040_45 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
}

fn to_srgb(c: f32) -> f32 {
    if c <= 0.003_130_8 { c * 12.92 } else { 1.055 * c.powf(1.0 / 2.4) - 0.055 }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 2 x 2: 0 and 1 below, 2 and 3 above.
    fn four() -> Texture {
        let pixels = Pixels::Floats([0.0_f32, 1.0, 2.0, 3.0].map(|c| [c, c, c, 1.0]).to_vec());
        Texture::new([2, 2], pixels, Encoding::Linear).expect("four texels")
    }

    fn look(at: [f32; 2], extension: Extension, interpolation: Interpolation) -> f32 {
        four().color(at, 0.0, extension, interpolation, false).x
    }

    #[test]
    fn between_centers_it_is_bilinear() {
        let linear = |at| look(at, Extension::Extend, Interpolation::Linear);
        assert_eq!(linear([0.25, 0.25]), 0.0);
        assert_eq!(linear([0.75, 0.25]), 1.0);
        assert_eq!(linear([0.5, 0.25]), 0.5);
        assert_eq!(linear([0.5, 0.5]), 1.5);
        assert_eq!(linear([0.625, 0.375]), 0.75 + 0.5);
    }

    #[test]
    fn a_spline_keeps_straight_lines_and_blurs_edges() {
        for t in [0.0, 0.3, 0.99] {
            let weights = spline(t);
            let mean: f32 = weights.iter().zip([-1.0, 0.0, 1.0, 2.0]).map(|(weight, x)| weight * x).sum();
            assert!((weights.iter().sum::<f32>() - 1.0).abs() < 1e-6 && (mean - t).abs() < 1e-6);
        }
        // At a texel's center two thirds are its own, in each direction; the edge is repeated.
        let cubic = look([0.25, 0.25], Extension::Extend, Interpolation::Cubic);
        assert!((cubic - (1.0 + 2.0) / 6.0).abs() < 1e-6, "{cubic}");
    }

    #[test]
    fn edges_follow_the_extension() {
        let closest = |x: f32, extension| look([x, 0.1], extension, Interpolation::Closest);
        assert_eq!(closest(1.25, Extension::Repeat), 0.0);
        assert_eq!(closest(-0.25, Extension::Repeat), 1.0);
        assert_eq!(closest(1.25, Extension::Extend), 1.0);
        assert_eq!(closest(-7.0, Extension::Extend), 0.0);
        assert_eq!(closest(1.25, Extension::Mirror), 1.0);
        assert_eq!(closest(1.75, Extension::Mirror), 0.0);
        assert_eq!(closest(-0.75, Extension::Mirror), 1.0);
        let beyond = four().color([1.25, 0.1], 0.0, Extension::Clip, Interpolation::Closest, false);
        assert_eq!(beyond, Vec4::ZERO);
    }

    #[test]
    fn beyond_all_numbers_there_is_no_image() {
        let extensions = [Extension::Repeat, Extension::Extend, Extension::Clip, Extension::Mirror];
        let interpolations = [Interpolation::Closest, Interpolation::Linear, Interpolation::Cubic];
        for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX, f32::MIN] {
            for (at, width) in [([bad, 0.5], 0.0), ([0.5, bad], bad), ([bad, bad], bad)] {
                for (extension, interpolation) in
                    extensions.into_iter().flat_map(|e| interpolations.map(|i| (e, i)))
                {
                    let color = four().color(at, width, extension, interpolation, true);
                    assert_eq!(color, Vec4::ZERO, "at {at:?}, {extension:?}, {interpolation:?}");
                }
            }
        }
    }

    #[test]
    fn smaller_levels_keep_the_mean() {
        let (width, height) = (7, 5);
        let texels: Vec<[f32; 4]> =
            (0..width * height).map(|i| [(i * i % 11) as f32, 1.0, 0.5, 1.0]).collect();
        let mean = texels.iter().map(|texel| texel[0]).sum::<f32>() / texels.len() as f32;
        let texture =
            Texture::new([width, height], Pixels::Floats(texels), Encoding::Linear).expect("texels");
        for level in &texture.levels {
            let count = level.pixels.len();
            let of_level = (0..count).map(|i| level.pixels.get(i).x).sum::<f32>() / count as f32;
            assert!((of_level - mean).abs() < 1e-4, "{of_level} is not {mean}");
        }
        let all = texture.color([0.3, 0.8], 10.0, Extension::Repeat, Interpolation::Linear, false);
        assert!((all.x - mean).abs() < 1e-4 && (all.z - 0.5).abs() < 1e-6);
    }

    #[test]
    fn the_mean_of_encoded_texels_is_that_of_their_light() {
        let pixels = Pixels::Bytes(vec![[0, 0, 0, 255], [255, 255, 255, 255]]);
        let texture = Texture::new([2, 1], pixels, Encoding::Srgb).expect("two texels");
        let far = texture.color([0.5, 0.5], 2.0, Extension::Repeat, Interpolation::Linear, false);
        assert!((far.x - 0.5).abs() < 0.005, "{}", far.x);
        // Near, texels are interpolated as they are stored.
        let near = texture.color([0.5, 0.5], 0.0, Extension::Extend, Interpolation::Linear, false);
        assert!((near.x - 0.214).abs() < 0.001, "{}", near.x);
    }

    #[test]
    fn the_width_chooses_the_level() {
        let texture =
            Texture::new([64, 64], Pixels::Bytes(vec![[9; 4]; 4096]), Encoding::Linear).expect("texels");
        let level = |texels: f32| texture.level_for(texels / 64.0);
        assert_eq!([0.0, 1.0, 1.9, 2.1, 4.1, 63.0, 1e9].map(level), [0, 0, 0, 1, 2, 5, 6]);
        assert_eq!(texture.levels.len(), 7);
        assert_eq!(texture.bytes(), 4 * (4096 + 1024 + 256 + 64 + 16 + 4 + 1));
    }

    #[test]
    fn transparent_colors_can_be_told() {
        let pixels = Pixels::Floats(vec![[0.2, 0.1, 0.0, 0.5]]);
        let texture = Texture::new([1, 1], pixels, Encoding::Linear).expect("a texel");
        let color =
            |unassociate| texture.color([0.5; 2], 0.0, Extension::Repeat, Interpolation::Linear, unassociate);
        assert_eq!(color(false), Vec4::new(0.2, 0.1, 0.0, 0.5));
        assert_eq!(color(true), Vec4::new(0.4, 0.2, 0.0, 0.5));
    }

    #[test]
    fn the_transfer_function_is_exact_at_bytes() {
        for byte in 0..=255_u8 {
            let c = f32::from(byte) / 255.0;
            assert!((from_srgb(c) - transfer(c)).abs() < 1e-6);
            assert!((to_srgb(transfer(c)) - c).abs() < 1e-4);
        }
    }

    #[test]
    fn sizes_must_fit() {
        assert!(Texture::new([2, 2], Pixels::Bytes(vec![[0; 4]; 3]), Encoding::Srgb).is_err());
        assert!(Texture::new([0, 2], Pixels::Bytes(Vec::new()), Encoding::Srgb).is_err());
    }
}

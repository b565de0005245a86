//! Patterns that are computed, not stored.

use glam::{Vec3, Vec4};
use serde::Deserialize;

use super::cell_hash::CellHash;
use super::noise::{self, Fractal, Octaves, Position};
use super::voronoi::{Feature, Found, Metric, Voronoi};

/// Shapes of the Gradient Texture node.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "SCREAMING_SNAKE_CASE")]
#[expect(missing_docs, reason = "the names are Blender's")]
pub enum GradientShape {
    Linear,
    Quadratic,
    Easing,
    Diagonal,
    Radial,
    QuadraticSphere,
    Spherical,
}

/// The Gradient Texture node.
#[must_use]
pub(super) fn gradient(shape: GradientShape, p: Vec3) -> f32 {
    use std::f32::consts::TAU;
    let value = match shape {
        GradientShape::Linear => p.x,
        GradientShape::Quadratic => p.x.max(0.0).powi(2),
        GradientShape::Easing => {
            let t = p.x.clamp(0.0, 1.0);
            t * t * (3.0 - 2.0 * t)
        }
        GradientShape::Diagonal => (p.x + p.y) * 0.5,
        GradientShape::Radial => p.y.atan2(p.x) / TAU + 0.5,
        GradientShape::QuadraticSphere => (0.999_999 - p.length()).max(0.0).powi(2),
        GradientShape::Spherical => (0.999_999 - p.length()).max(0.0),
    };
    value.clamp(0.0, 1.0)
}

/// The Checker Texture node at a scaled point: true for the first color.
#[must_use]
pub(super) fn checker(p: Vec3) -> bool {
    // Off the planes between two cells, where rounding would choose.
    let cell = ((p + 0.000_001) * 0.999_999).floor();
    let odd = |c: f32| c.rem_euclid(2.0) >= 1.0;
    (odd(cell.x) == odd(cell.y)) == odd(cell.z)
}

/// Which way the bands of waves lie.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "SCREAMING_SNAKE_CASE")]
#[expect(missing_docs, reason = "the names are Blender's")]
pub enum WaveDirection {
    X,
    Y,
    Z,
    Diagonal,
    Spherical,
}

/// The shape of a wave.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "SCREAMING_SNAKE_CASE")]
#[expect(missing_docs, reason = "the names are Blender's")]
pub enum WaveProfile {
    Sin,
    Saw,
    Tri,
}

/// A pattern and its options. Its inputs follow the instruction in the order that is given here.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum Pattern {
    /// vector, w, scale, detail, roughness, lacunarity, offset, gain, distortion.
    Noise {
        /// One to four: w alone, x and y, the vector, the vector and w.
        dimensions: u8,
        /// How octaves are put together.
        fractal: Fractal,
        /// Within 0 and 1.
        normalize: bool,
        /// Three noises instead of one.
        color: bool,
    },
    /// vector, w.
    WhiteNoise {
        /// As for noise.
        dimensions: u8,
        /// Three numbers instead of one.
        color: bool,
    },
    /// vector, w, scale, detail, roughness, lacunarity, smoothness, exponent, randomness.
    Voronoi {
        /// As for noise.
        dimensions: u8,
        /// What is asked.
        feature: Feature,
        /// How distance is measured.
        metric: Metric,
        /// Which random numbers cells have.
        hash: CellHash,
        /// Within 0 and 1.
        normalize: bool,
        /// What the result is.
        output: VoronoiOutput,
    },
    /// vector, scale, distortion, detail, detail scale, detail roughness, phase.
    Wave {
        /// Around an axis instead of along it.
        rings: bool,
        /// The axis.
        direction: WaveDirection,
        /// The shape.
        profile: WaveProfile,
    },
    /// vector, scale, distortion.
    Magic {
        /// Number of turns.
        depth: u8,
    },
    /// vector, two colors, mortar, scale, mortar size, mortar smooth, bias, brick width, row height. The result's alpha is the
    /// mortar's share.
    Brick {
        /// Share of a brick by which rows are moved.
        offset: f32,
        /// Every so many rows; 0: none.
        offset_frequency: i32,
        /// Width of bricks in rows that are squashed.
        squash: f32,
        /// Every so many rows; 0: none.
        squash_frequency: i32,
    },
}

/// Outputs of the Voronoi Texture node.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
#[expect(missing_docs, reason = "the names are Blender's")]
pub enum VoronoiOutput {
    Distance,
    Color,
    Position,
    W,
}

impl Pattern {
    /// Number of inputs.
    pub(super) const fn input_count(&self) -> usize {
        match self {
            Self::Noise { .. } | Self::Voronoi { .. } => 9,
            Self::WhiteNoise { .. } => 2,
            Self::Wave { .. } => 7,
            Self::Magic { .. } => 3,
            Self::Brick { .. } => 10,
        }
    }

    /// What is wrong with its options.
    pub(super) fn fault(&self) -> Option<String> {
        match *self {
            Self::Noise { dimensions, .. }
            | Self::WhiteNoise { dimensions, .. }
            | Self::Voronoi { dimensions, .. }
                if !(1..=4).contains(&dimensions) =>
            {
                Some(format!("a pattern has one to four dimensions, not {dimensions}"))
            }
            _ => None,
        }
    }

    /// The color, with the factor as its alpha, for inputs as many as [`Pattern::input_count`].
    pub(super) fn color(&self, inputs: &[Vec4]) -> Vec4 {
        let number = |i: usize| inputs[i].x;
        let vector = inputs[0].truncate();
        match *self {
            Self::Noise { dimensions, fractal, normalize, color } => {
                let octaves = Octaves {
                    fractal,
                    detail: number(3).clamp(0.0, 15.0),
                    roughness: number(4).max(0.0),
                    lacunarity: number(5),
                    offset: number(6),
                    gain: number(7),
                    normalize,
                };
                let p = position(vector * number(2), number(1) * number(2), dimensions);
                if color {
                    let color = noise::distorted_color(p, number(8), &octaves);
                    return color.extend(color.x);
                }
                Vec4::splat(noise::distorted(p, number(8), &octaves))
            }
            Self::WhiteNoise { dimensions, color } => {
                let white = noise::white(position(vector, number(1), dimensions));
                if color { white.extend(white.x) } else { Vec4::splat(white.x) }
            }
            Self::Voronoi { dimensions, feature, metric, hash, normalize, output } => {
                let voronoi = Voronoi {
                    feature,
                    metric,
                    hash,
                    detail: number(3).clamp(0.0, 15.0),
                    roughness: number(4).clamp(0.0, 1.0),
                    lacunarity: number(5),
                    smoothness: (number(6) * 0.5).clamp(0.0, 0.5),
                    exponent: number(7),
                    randomness: number(8).clamp(0.0, 1.0),
                    normalize,
                };
                let scale = number(2);
                let p = position(vector * scale, number(1) * scale, dimensions);
                cells(&voronoi, p, scale, output)
            }
            Self::Wave { rings, direction, profile } => {
                let distortion = WaveDistortion {
                    amount: number(2),
                    detail: number(3),
                    scale: number(4),
                    roughness: number(5),
                };
                let phase = wave_phase(vector * number(1), rings, direction, &distortion) + number(6);
                Vec4::splat(wave(phase, profile))
            }
            Self::Magic { depth } => magic(vector * number(1), depth, number(2)),
            Self::Brick { offset, offset_frequency, squash, squash_frequency } => {
                let rows = Rows { offset, offset_frequency, squash, squash_frequency };
                brick(&rows, vector * number(4), inputs)
            }
        }
    }
}

fn position(vector: Vec3, w: f32, dimensions: u8) -> Position {
    let dimensions = usize::from(dimensions);
    let x = if dimensions == 1 { [w, 0.0, 0.0, 0.0] } else { [vector.x, vector.y, vector.z, w] };
    Position { x, dimensions }
}

/// The Voronoi Texture node at a point that is scaled already.
fn cells(voronoi: &Voronoi, p: Position, scale: f32, output: VoronoiOutput) -> Vec4 {
    let [x, y, z, w] = p.x;
    match p.dimensions {
        1 => cell(&voronoi.find([x]), [3], scale, output),
        2 => cell(&voronoi.find([x, y]), [0, 1], scale, output),
        3 => cell(&voronoi.find([x, y, z]), [0, 1, 2], scale, output),
        _ => cell(&voronoi.find([x, y, z, w]), [0, 1, 2, 3], scale, output),
    }
}

/// What is asked about a cell; `axes` are the channels of x, y, z and w that its numbers belong to.
fn cell<const N: usize>(found: &Found<N>, axes: [usize; N], scale: f32, output: VoronoiOutput) -> Vec4 {
    let position = || {
        let mut position = [0.0; 4];
        for (axis, x) in axes.into_iter().zip(found.position) {
            position[axis] = if scale == 0.0 { 0.0 } else { x / scale };
        }
        Vec4::from_array(position)
    };
    match output {
        VoronoiOutput::Distance => Vec4::splat(found.distance),
        VoronoiOutput::Color => found.color.extend(1.0),
        VoronoiOutput::Position => position().truncate().extend(1.0),
        VoronoiOutput::W => Vec4::splat(position().w),
    }
}

struct WaveDistortion {
    amount: f32,
    detail: f32,
    scale: f32,
    roughness: f32,
}

fn wave_phase(p: Vec3, rings: bool, direction: WaveDirection, distortion: &WaveDistortion) -> f32 {
    let p = (p + 0.000_001) * 0.999_999;
    let phase = if rings {
        let across = match direction {
            WaveDirection::X => Vec3::new(0.0, p.y, p.z),
            WaveDirection::Y => Vec3::new(p.x, 0.0, p.z),
            WaveDirection::Z => Vec3::new(p.x, p.y, 0.0),
            WaveDirection::Diagonal | WaveDirection::Spherical => p,
        };
        across.length() * 20.0
    } else {
        match direction {
            WaveDirection::X => p.x * 20.0,
            WaveDirection::Y => p.y * 20.0,
            WaveDirection::Z => p.z * 20.0,
            WaveDirection::Diagonal | WaveDirection::Spherical => (p.x + p.y + p.z) * 10.0,
        }
    };
    if distortion.amount == 0.0 {
        return phase;
    }
    let octaves = Octaves {
        fractal: Fractal::Fbm,
        detail: distortion.detail.clamp(0.0, 15.0),
        roughness: distortion.roughness.max(0.0),
        lacunarity: 2.0,
        offset: 0.0,
        gain: 0.0,
        normalize: true,
    };
    phase + distortion.amount * (noise::fractal(position(p * distortion.scale, 0.0, 3), &octaves) * 2.0 - 1.0)
}

fn wave(phase: f32, profile: WaveProfile) -> f32 {
    use std::f32::consts::{FRAC_PI_2, TAU};
    match profile {
        WaveProfile::Sin => 0.5 + 0.5 * (phase - FRAC_PI_2).sin(),
        WaveProfile::Saw => {
            let turns = phase / TAU;
            turns - turns.floor()
        }
        WaveProfile::Tri => {
            let turns = phase / TAU;
            (turns - (turns + 0.5).floor()).abs() * 2.0
        }
    }
}

/// The Magic Texture node: each turn replaces one coordinate by a wave of all three.
fn magic(p: Vec3, depth: u8, distortion: f32) -> Vec4 {
    let [mut x, mut y, mut z] = [
        ((p.x + p.y + p.z) * 5.0).sin(),
        ((-p.x + p.y - p.z) * 5.0).cos(),
        -((-p.x - p.y + p.z) * 5.0).cos(),
    ];
    let mut d = distortion;
    if depth > 0 {
        (x, y, z) = (x * d, y * d, z * d);
        y = -(x - y + z).cos() * d;
    }
    for turn in 1..depth.min(10) {
        match turn {
            1 => x = (x - y - z).cos() * d,
            2 => z = (-x - y - z).sin() * d,
            3 => x = -(-x + y - z).cos() * d,
            4 => y = -(-x + y + z).sin() * d,
            5 => y = -(-x + y + z).cos() * d,
            6 => x = (x + y + z).cos() * d,
            7 => z = (x + y - z).sin() * d,
            8 => x = -(-x - y + z).cos() * d,
            _ => y = -(x - y + z).sin() * d,
        }
    }
    if d != 0.0 {
        d *= 2.0;
        (x, y, z) = (x / d, y / d, z / d);
    }
    let color = Vec3::new(0.5 - x, 0.5 - y, 0.5 - z);
    color.extend(color.element_sum() / 3.0)
}

struct Rows {
    offset: f32,
    offset_frequency: i32,
    squash: f32,
    squash_frequency: i32,
}

/// The Brick Texture node at a scaled point.
fn brick(rows: &Rows, p: Vec3, inputs: &[Vec4]) -> Vec4 {
    let number = |i: usize| inputs[i].x;
    let (mortar_size, mortar_smooth, bias) = (number(5), number(6), number(7));
    let (mut width, height) = (number(8), number(9));
    let row = (p.y / height).floor();
    let row_number = row as i32;
    let mut offset = 0.0;
    if rows.offset_frequency != 0 && rows.squash_frequency != 0 {
        width *= if row_number.wrapping_rem(rows.squash_frequency) == 0 { rows.squash } else { 1.0 };
        offset = if row_number.wrapping_rem(rows.offset_frequency) == 0 { width * rows.offset } else { 0.0 };
    }
    let column = ((p.x + offset) / width).floor();
    let (x, y) = (p.x + offset - width * column, p.y - height * row);
    let key = row_number.wrapping_shl(16).wrapping_add(column as i32 & 0xFFFF);
    let tint = (brick_noise(key.cast_unsigned()) + bias).clamp(0.0, 1.0);
    let to_edge = x.min(y).min(width - x).min(height - y);
    let mortar = if to_edge >= mortar_size {
        0.0
    } else if mortar_smooth == 0.0 {
        1.0
    } else {
        let t = ((1.0 - to_edge / mortar_size) / mortar_smooth).clamp(0.0, 1.0);
        t * t * (3.0 - 2.0 * t)
    };
    let stone = inputs[1].truncate().lerp(inputs[2].truncate(), tint);
    stone.lerp(inputs[3].truncate(), mortar).extend(mortar)
}

/// 0 to 1, from a brick's number.
fn brick_noise(number: u32) -> f32 {
    let n = number.wrapping_add(1013) & 0x7fff_ffff;
    let n = (n >> 13) ^ n;
    let inner = n.wrapping_mul(n).wrapping_mul(60_493).wrapping_add(19_990_303);
    let mixed = n.wrapping_mul(inner).wrapping_add(1_376_312_589) & 0x7fff_ffff;
    0.5 * (mixed as f32 / 1_073_741_824.0)
}

//! Random numbers of the lattice cells of the Voronoi Texture node: where a cell's point lies, and its color.

use glam::Vec3;
use serde::Deserialize;

use super::noise::{self, Position, unit_hash};

/// Which random numbers cells have.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum CellHash {
    /// From a cell's numbers as words: Jarzynski and Olano 2020, "Hash Functions for GPU Rendering", pcg2d to pcg4d.
    Words,
    /// From a cell's numbers as floats, as in Blender 4.2: those of the White Noise node.
    Floats,
}

impl CellHash {
    /// Where a cell's point lies within it, 0 to 1.
    pub(super) fn place<const N: usize>(self, cell: [i32; N]) -> [f32; N] {
        let at = float_position(cell);
        let [x, y, z, w] = at.x;
        match (self, N) {
            (_, 1) => [unit_hash(&[x]); N],
            (Self::Words, _) => first(words(cell)),
            (Self::Floats, 4) => first([
                unit_hash(&[x, y, z, w]),
                unit_hash(&[w, x, y, z]),
                unit_hash(&[z, w, x, y]),
                unit_hash(&[y, z, w, x]),
            ]),
            (Self::Floats, _) => first(noise::white(at).extend(0.0).to_array()),
        }
    }

    /// A cell's color.
    pub(super) fn color<const N: usize>(self, cell: [i32; N]) -> Vec3 {
        match self {
            Self::Words if N > 1 => {
                // A cell of the plane has the color of that of space.
                let [x, y, z, _] = if N == 2 { words([cell[0], cell[1], 0]) } else { words(cell) };
                Vec3::new(x, y, z)
            }
            _ => noise::white(float_position(cell)),
        }
    }
}

fn float_position<const N: usize>(cell: [i32; N]) -> Position {
    Position { x: first_of(cell.map(|word| word as f32)), dimensions: N }
}

/// The first of four numbers.
fn first<const N: usize>(numbers: [f32; 4]) -> [f32; N] {
    std::array::from_fn(|i| numbers[i])
}

/// Four numbers: these, and zeros.
fn first_of<const N: usize>(numbers: [f32; N]) -> [f32; 4] {
    std::array::from_fn(|i| numbers.get(i).copied().unwrap_or(0.0))
}

/// Of two to four dimensions, on signed words; zeros follow.
fn words<const N: usize>(cell: [i32; N]) -> [f32; 4] {
    const FACTOR: i32 = 1_664_525;
    let mut v = cell.map(|word| word.wrapping_mul(FACTOR).wrapping_add(1_013_904_223));
    for round in 0..2 {
        // Of x and y alone each takes the other; else each takes the product of two of the others.
        for i in 0..N {
            let other = match N {
                2 => v[1 - i].wrapping_mul(FACTOR),
                3 => v[(i + 1) % 3].wrapping_mul(v[(i + 2) % 3]),
                _ => {
                    let [a, b] = [[1, 3], [2, 0], [0, 1], [1, 2]][i];
                    v[a].wrapping_mul(v[b])
                }
            };
            v[i] = v[i].wrapping_add(other);
        }
        if round == 0 {
            v = v.map(|word| word ^ (word >> 16));
        }
    }
    first_of(v.map(unit))
}

/// 31 bits as a number from 0 to 1.
fn unit(word: i32) -> f32 {
    (word & i32::MAX) as f32 * (1.0 / i32::MAX as f32)
}

//! Directions drawn in proportion to how bright they are: a table over longitude and latitude, constant within a cell.

use std::f32::consts::{FRAC_1_PI, PI, TAU};

use glam::Vec3;
use rayon::prelude::*;

use super::warp;

/// Share of directions drawn evenly over the sphere, so that what the table underestimates is still found.
const EVEN_SHARE: f32 = 0.05;

/// Density over all directions. A cell's probability is its weight times its solid angle.
#[derive(Clone, Debug)]
pub(super) struct DirectionTable {
    columns: usize,
    rows: usize,
    /// Sums of the probabilities of the rows, from 0 to 1: one more than there are rows.
    row_sums: Vec<f32>,
    /// By row: sums of the probabilities of its cells within it.
    cell_sums: Vec<f32>,
}

impl DirectionTable {
    /// From the weight of every cell, row by row from below. `None` where all weigh nothing.
    pub(super) fn new(columns: usize, weights: &[f32]) -> Option<Self> {
        let rows = weights.len() / columns;
        let mut cell_sums = vec![0.0; rows * (columns + 1)];
        let totals: Vec<f64> = (weights.par_chunks(columns))
            .zip(cell_sums.par_chunks_mut(columns + 1))
            .enumerate()
            .map(|(row, (weights, sums))| running_sums(weights, sums) * f64::from(row_area(row, rows)))
            .collect();
        let mut row_sums = vec![0.0; rows + 1];
        let total = running_sums(&totals, &mut row_sums);
        (total > 0.0 && total.is_finite()).then_some(Self { columns, rows, row_sums, cell_sums })
    }

    /// Memory (bytes).
    pub(super) const fn bytes(&self) -> usize {
        (self.row_sums.len() + self.cell_sums.len()) * size_of::<f32>()
    }

    /// A direction and its pdf per solid angle.
    pub(super) fn sample(&self, u: [f32; 2]) -> (Vec3, f32) {
        let direction = if u[0] < EVEN_SHARE {
            warp::sphere([u[0] / EVEN_SHARE, u[1]])
        } else {
            self.choose([(u[0] - EVEN_SHARE) / (1.0 - EVEN_SHARE), u[1]])
        };
        (direction, self.pdf(direction))
    }

    /// Pdf per solid angle of [`DirectionTable::sample`].
    pub(super) fn pdf(&self, direction: Vec3) -> f32 {
        let [x, y] = place(direction);
        let column = ((x * self.columns as f32) as usize).min(self.columns - 1);
        let row = ((y * self.rows as f32) as usize).min(self.rows - 1);
        let sums = self.row(row);
        let probability = (self.row_sums[row + 1] - self.row_sums[row]) * (sums[column + 1] - sums[column]);
        let area = row_area(row, self.rows) / self.columns as f32;
        EVEN_SHARE * 0.25 * FRAC_1_PI + (1.0 - EVEN_SHARE) * probability / area
    }

    fn row(&self, row: usize) -> &[f32] {
        &self.cell_sums[row * (self.columns + 1)..][..=self.columns]
    }

    /// A direction of a cell, even over its solid angle.
    fn choose(&self, u: [f32; 2]) -> Vec3 {
        let (row, v) = find(&self.row_sums, u[1]);
        let (column, h) = find(self.row(row), u[0]);
        let [low, high] = [row, row + 1].map(|edge| height(edge, self.rows));
        let z = (low + (high - low) * v).clamp(-1.0, 1.0);
        let angle = TAU * ((column as f32 + h) / self.columns as f32 - 0.5);
        let radius = (1.0 - z * z).max(0.0).sqrt();
        Vec3::new(radius * angle.cos(), radius * angle.sin(), z)
    }
}

/// The direction at a place of the table, both coordinates from 0 to 1.
pub(super) fn direction([x, y]: [f32; 2]) -> Vec3 {
    let (longitude, latitude) = (TAU * (x - 0.5), PI * (y - 0.5));
    let (sin, cos) = latitude.sin_cos();
    Vec3::new(cos * longitude.cos(), cos * longitude.sin(), sin)
}

/// Place of a direction in the table.
fn place(d: Vec3) -> [f32; 2] {
    [d.y.atan2(d.x) / TAU + 0.5, d.z.atan2(d.x.hypot(d.y)) * FRAC_1_PI + 0.5]
}

/// Height over the equator (the sine of the latitude) of the edge below row `edge`.
fn height(edge: usize, rows: usize) -> f32 {
    (PI * (edge as f32 / rows as f32 - 0.5)).sin()
}

/// Solid angle of a row (sr).
pub(super) fn row_area(row: usize, rows: usize) -> f32 {
    let middle = PI * ((row as f32 + 0.5) / rows as f32 - 0.5);
    // The difference of the heights of its edges, without cancellation.
    TAU * 2.0 * (0.5 * PI / rows as f32).sin() * middle.cos()
}

/// Fills `sums` (one longer) with the running sums of `weights` as shares of their total, which is given back. Where nothing
/// weighs anything, shares are even.
fn running_sums<T: Copy + Into<f64>>(weights: &[T], sums: &mut [f32]) -> f64 {
    let total: f64 = weights.iter().map(|&weight| weight.into()).sum();
    let count = weights.len() as f64;
    let mut sum = 0.0;
    for (&weight, place) in weights.iter().zip(&mut sums[1..]) {
        sum += if total > 0.0 { weight.into() / total } else { 1.0 / count };
        *place = sum.min(1.0) as f32;
    }
    if let Some(last) = sums.last_mut() {
        *last = 1.0;
    }
    total
}

/// The step of running sums that `u` in 0..1 falls into, and where within it, from 0 to 1.
fn find(sums: &[f32], u: f32) -> (usize, f32) {
    let after = sums.partition_point(|&sum| sum <= u).clamp(1, sums.len() - 1);
    let (low, high) = (sums[after - 1], sums[after]);
    (after - 1, ((u - low) / (high - low)).clamp(0.0, 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_direction_is_found_where_it_lies() {
        for i in 0..200 {
            let at = [(i as f32 + 0.5) / 200.0, (i as f32 * 0.618).fract() * 0.98 + 0.01];
            let found = place(direction(at));
            assert!((found[0] - at[0]).abs() < 1e-5 && (found[1] - at[1]).abs() < 1e-5, "{at:?} {found:?}");
        }
    }

    #[test]
    fn the_rows_cover_the_sphere() {
        let sum: f32 = (0..64).map(|row| row_area(row, 64)).sum();
        assert!((sum - 2.0 * TAU).abs() < 1e-4, "{sum}");
    }

    #[test]
    fn nothing_to_choose_from() {
        assert!(DirectionTable::new(4, &[0.0; 8]).is_none());
    }
}

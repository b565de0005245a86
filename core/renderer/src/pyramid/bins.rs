//! Direction bins: light that leaves glossy surfaces, by outgoing direction.
//!
//! The hemisphere about a cell's mean normal is cut into bins of equal solid angle, uniform in cos θ and azimuth (the
//! paper's are uniform in θ, which starves the pole). A bin holds radiance with the surface's tint divided out.

use std::f32::consts::TAU;

use glam::Vec3;

use super::accumulator::SETS;
use crate::color::Rgb;
use crate::math::Frame;

/// How the hemisphere is cut.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DirectionBins {
    /// Rings.
    pub elevation: u32,
    /// Bins of a ring.
    pub azimuth: u32,
}

/// Bins whose directions are asked together.
pub(super) const LANES: usize = 16;

/// A number for each of [`LANES`] bins, by axis or channel.
pub type Lanes = [[f32; LANES]; 3];

impl DirectionBins {
    /// Number of bins.
    #[must_use]
    pub const fn count(self) -> usize {
        (self.elevation * self.azimuth) as usize
    }

    /// Unit direction in bin `bin` (z is the cell's normal) at `at` in [0, 1)² of its ring and azimuth.
    #[must_use]
    pub fn direction(self, bin: usize, at: [f32; 2]) -> Vec3 {
        let (ring, sector) = (bin as u32 / self.azimuth, bin as u32 % self.azimuth);
        let z = (ring as f32 + at[0]) / self.elevation as f32;
        let (sin, cos) = (TAU * (sector as f32 + at[1]) / self.azimuth as f32).sin_cos();
        let r = (1.0 - z * z).max(0.0).sqrt();
        Vec3::new(r * cos, r * sin, z)
    }

    /// The bin a unit direction lies in, shifted by `shift` bins in [-½, ½]²: a random shift blends neighbours linearly.
    /// Directions below the horizon count as on it.
    #[must_use]
    pub fn bin(self, direction: Vec3, shift: [f32; 2]) -> usize {
        let ring = (direction.z.clamp(0.0, 1.0) * self.elevation as f32 + shift[0]).floor();
        let ring = ring.clamp(0.0, self.elevation as f32 - 1.0) as u32;
        let turn = direction.y.atan2(direction.x) / TAU * self.azimuth as f32 + shift[1];
        let sector = (turn.floor() as i32).rem_euclid(self.azimuth as i32) as u32;
        (ring * self.azimuth + sector) as usize
    }

    /// Adds the bins of a cell about `from` to those of one about `to`.
    pub(super) fn add(self, from: &Frame, values: &[[i64; 3]], to: &Frame, sums: &mut [[i64; 3]]) {
        let aligned = from.normal.dot(to.normal) > 1.0 - 1e-6;
        for (bin, sum) in sums.iter_mut().enumerate() {
            let source = if aligned {
                bin
            } else {
                let direction = to.from_local(self.direction(bin, [0.5, 0.5]));
                self.bin(from.to_local(direction), [0.0, 0.0])
            };
            for c in 0..3 {
                sum[c] += values[source][c];
            }
        }
    }
}

/// The first corners of all bins, [`LANES`] together: what the directions of every photon start from.
#[derive(Clone, Debug)]
pub(super) struct BinCorners {
    bins: DirectionBins,
    /// Cosine of the angle to the normal, cosine and sine of the azimuth.
    corners: Vec<Lanes>,
}

impl BinCorners {
    pub(super) fn new(bins: DirectionBins) -> Self {
        let mut corners = vec![[[0.0; LANES]; 3]; bins.count().div_ceil(LANES)];
        for bin in 0..bins.count() {
            let (ring, sector) = (bin as u32 / bins.azimuth, bin as u32 % bins.azimuth);
            let (sin, cos) = (TAU * sector as f32 / bins.azimuth as f32).sin_cos();
            let corner = [ring as f32 / bins.elevation as f32, cos, sin];
            for (lanes, value) in corners[bin / LANES].iter_mut().zip(corner) {
                lanes[bin % LANES] = value;
            }
        }
        Self { bins, corners }
    }

    /// Groups of [`LANES`] bins, the last one padded.
    pub(super) const fn groups(&self) -> usize {
        self.corners.len()
    }

    /// The directions at `at` in [0, 1)² of every bin, in the space of `frame`.
    #[inline(always)]
    pub(super) fn directions(&self, frame: &Frame, at: [f32; 2]) -> BinDirections<'_> {
        let turn = (TAU * at[1] / self.bins.azimuth as f32).sin_cos();
        BinDirections { corners: &self.corners, frame: *frame, up: at[0] / self.bins.elevation as f32, turn }
    }
}

/// [`DirectionBins::direction`] of all bins at the same place in each, turned into a cell's frame.
pub(super) struct BinDirections<'a> {
    corners: &'a [Lanes],
    frame: Frame,
    up: f32,
    turn: (f32, f32),
}

impl BinDirections<'_> {
    /// Of one group of [`LANES`] bins.
    #[inline(always)]
    pub(super) fn group(&self, group: usize) -> Lanes {
        let [corner_z, corner_cos, corner_sin] = &self.corners[group];
        let (Frame { tangent, bitangent, normal }, (sin, cos)) = (self.frame, self.turn);
        let mut directions = [[0.0; LANES]; 3];
        for i in 0..LANES {
            let z = corner_z[i] + self.up;
            let r = (1.0 - z * z).abs().sqrt();
            let x = r * (corner_cos[i] * cos - corner_sin[i] * sin);
            let y = r * (corner_sin[i] * cos + corner_cos[i] * sin);
            directions[0][i] = tangent.x * x + bitangent.x * y + normal.x * z;
            directions[1][i] = tangent.y * x + bitangent.y * y + normal.y * z;
            directions[2][i] = tangent.z * x + bitangent.z * y + normal.z * z;
        }
        directions
    }
}

/// Bins of the cells of a finished pyramid: 16 bits a channel, as a share of the cell's largest value.
#[derive(Clone, Debug)]
pub(super) struct BinStore {
    pub(super) bins: DirectionBins,
    values: Vec<[u16; 3]>,
    /// By cell: the largest value of each set over 65535, and its frame's normal.
    cells: Vec<([f32; SETS], Vec3)>,
}

impl BinStore {
    pub(super) const fn new(bins: DirectionBins) -> Self {
        Self { bins, values: Vec::new(), cells: Vec::new() }
    }

    /// Adds a cell and returns its number. The sums of each set are in units of `unit`.
    pub(super) fn push(&mut self, normal: Vec3, sets: [&[[i64; 3]]; SETS], unit: f64) -> u32 {
        let units = sets.map(|sums| {
            let largest = sums.as_flattened().iter().copied().max().unwrap_or(0).max(1) as f64;
            let share = |value: i64| (value.max(0) as f64 / largest * 65535.0).round() as u16;
            self.values.extend(sums.iter().map(|sum| sum.map(share)));
            (largest * unit / 65535.0) as f32
        });
        self.cells.push((units, normal));
        self.cells.len() as u32 - 1
    }

    /// Radiance of a cell in one set towards the unit vector `direction`; see [`DirectionBins::bin`] for `shift`.
    pub(super) fn radiance(&self, cell: u32, set: usize, direction: Vec3, shift: [f32; 2]) -> Rgb {
        let (units, normal) = self.cells[cell as usize];
        let bin = self.bins.bin(Frame::new(normal).to_local(direction), shift);
        let values = self.values[(cell as usize * SETS + set) * self.bins.count() + bin];
        Rgb(values.map(|v| f32::from(v) * units[set]))
    }

    pub(super) const fn len(&self) -> usize {
        self.cells.len()
    }

    pub(super) const fn bytes(&self) -> usize {
        self.values.len() * size_of::<[u16; 3]>() + self.cells.len() * size_of::<([f32; SETS], Vec3)>()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BINS: DirectionBins = DirectionBins { elevation: 8, azimuth: 16 };

    #[test]
    fn a_direction_lies_in_the_bin_it_was_made_for() {
        for bin in 0..BINS.count() {
            for at in [[0.01, 0.01], [0.5, 0.5], [0.99, 0.99]] {
                assert_eq!(BINS.bin(BINS.direction(bin, at), [0.0, 0.0]), bin);
            }
        }
    }

    /// Equal solid angle: directions uniform over the hemisphere fall into every bin alike.
    #[test]
    fn bins_have_equal_solid_angle() {
        let mut counts = vec![0_u32; BINS.count()];
        let n = 128 * 400;
        for i in 0..n {
            let z = (i as f32 + 0.5) / n as f32;
            let (sin, cos) = (i as f32 * 2.399_963_2).sin_cos();
            let r = (1.0 - z * z).sqrt();
            counts[BINS.bin(Vec3::new(r * cos, r * sin, z), [0.0, 0.0])] += 1;
        }
        assert!(counts.iter().all(|&c| (380..=420).contains(&c)), "{counts:?}");
    }

    #[test]
    fn directions_of_a_group_are_those_of_its_bins() {
        let frame = Frame::new(Vec3::new(0.48, -0.6, 0.64));
        for (elevation, azimuth) in [(8, 16), (2, 4), (3, 7), (1, 1)] {
            let bins = DirectionBins { elevation, azimuth };
            let corners = BinCorners::new(bins);
            assert_eq!(corners.groups(), bins.count().div_ceil(LANES));
            for at in [[0.0, 0.0], [0.3, 0.9], [0.999, 0.001]] {
                let directions = corners.directions(&frame, at);
                for bin in 0..bins.count() {
                    let group = directions.group(bin / LANES);
                    let direction = Vec3::from(group.map(|axis| axis[bin % LANES]));
                    let expected = frame.from_local(bins.direction(bin, at));
                    assert!((direction - expected).length() < 2e-6, "bin {bin}: {direction}, {expected}");
                }
            }
        }
    }

    #[test]
    fn stored_radiance_comes_back() {
        let mut store = BinStore::new(BINS);
        let sums: Vec<[i64; 3]> = (0..128).map(|i| [i * 1000, i * i, 0]).collect();
        let twice: Vec<[i64; 3]> = sums.iter().map(|sum| sum.map(|v| 2 * v)).collect();
        let cell = store.push(Vec3::X, [&sums, &twice], 1e-3);
        let frame = Frame::new(Vec3::X);
        for (set, sums) in [&sums, &twice].into_iter().enumerate() {
            for (bin, sum) in sums.iter().enumerate() {
                let direction = frame.from_local(BINS.direction(bin, [0.5, 0.5]));
                let got = store.radiance(cell, set, direction, [0.0, 0.0]);
                for (got, sum) in got.0.iter().zip(sum) {
                    assert!((got - *sum as f32 * 1e-3).abs() < 254.0 / 65535.0, "bin {bin}");
                }
            }
        }
    }
}

//! The Voronoi Texture node in two and three dimensions: one point in every cell of a lattice, and how far they are.

use glam::{IVec3, Vec3};
use serde::Deserialize;

/// What is asked about the points around.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "SCREAMING_SNAKE_CASE")]
#[expect(missing_docs, reason = "the names are Blender's")]
pub enum Feature {
    F1,
    F2,
    SmoothF1,
    DistanceToEdge,
}

/// How distance is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "SCREAMING_SNAKE_CASE")]
#[expect(missing_docs, reason = "the names are Blender's")]
pub enum Metric {
    Euclidean,
    Manhattan,
    Chebychev,
    Minkowski,
}

/// Options and inputs of the node, its vector already scaled.
#[derive(Clone, Copy, Debug)]
pub(super) struct Voronoi {
    pub(super) feature: Feature,
    pub(super) metric: Metric,
    /// Two dimensions: z is 0 everywhere.
    pub(super) flat: bool,
    pub(super) smoothness: f32,
    pub(super) exponent: f32,
    /// 0: the points are the lattice's own.
    pub(super) randomness: f32,
}

/// What the node finds.
#[derive(Clone, Copy, Debug)]
pub(super) struct Found {
    pub(super) distance: f32,
    pub(super) color: Vec3,
    pub(super) position: Vec3,
}

impl Voronoi {
    /// Looks around `p`.
    pub(super) fn find(&self, p: Vec3) -> Found {
        let p = if self.flat { Vec3::new(p.x, p.y, 0.0) } else { p };
        let floor = p.floor();
        let (cell, local) = (floor.as_ivec3(), p - floor);
        let found = match self.feature {
            Feature::SmoothF1 if self.smoothness > 0.0 => self.smooth(cell, local),
            Feature::F1 | Feature::SmoothF1 => self.nearest(cell, local)[0],
            Feature::F2 => self.nearest(cell, local)[1],
            Feature::DistanceToEdge => {
                let distance = self.edge(cell, local);
                Found { distance, color: Vec3::splat(distance), position: Vec3::ZERO }
            }
        };
        Found { position: found.position + floor, ..found }
    }

    /// The cells around one, up to `reach` away.
    fn around(&self, reach: i32) -> impl Iterator<Item = IVec3> {
        let depth = if self.flat { 0 } else { reach };
        (-depth..=depth).flat_map(move |z| {
            (-reach..=reach).flat_map(move |y| (-reach..=reach).map(move |x| IVec3::new(x, y, z)))
        })
    }

    /// Where the point of the cell `offset` away from `cell` is, seen from the corner of `cell`.
    fn point(&self, cell: IVec3, offset: IVec3) -> Vec3 {
        let at = cell.wrapping_add(offset);
        let random = if self.flat { hash2(at) } else { hash3(at) };
        offset.as_vec3() + random * self.randomness
    }

    fn distance(&self, a: Vec3, b: Vec3) -> f32 {
        let d = (a - b).abs();
        match self.metric {
            Metric::Euclidean => d.length(),
            Metric::Manhattan => d.element_sum(),
            Metric::Chebychev => d.max_element(),
            Metric::Minkowski => d.map(|x| x.powf(self.exponent)).element_sum().powf(1.0 / self.exponent),
        }
    }

    /// The nearest point and the one after it.
    fn nearest(&self, cell: IVec3, local: Vec3) -> [Found; 2] {
        let none = Found { distance: f32::MAX, color: Vec3::ZERO, position: Vec3::ZERO };
        let mut best = [(none, IVec3::ZERO); 2];
        for offset in self.around(1) {
            let position = self.point(cell, offset);
            let distance = self.distance(position, local);
            let found = (Found { distance, color: Vec3::ZERO, position }, offset);
            if distance < best[0].0.distance {
                best = [found, best[0]];
            } else if distance < best[1].0.distance {
                best[1] = found;
            }
        }
        best.map(|(found, offset)| Found { color: hash3(cell.wrapping_add(offset)), ..found })
    }

    /// As the nearest, blended over with those that are little farther away.
    fn smooth(&self, cell: IVec3, local: Vec3) -> Found {
        let mut sum = Found { distance: 0.0, color: Vec3::ZERO, position: Vec3::ZERO };
        let mut is_first = true;
        for offset in self.around(2) {
            let position = self.point(cell, offset);
            let distance = self.distance(position, local);
            let t = (0.5 + 0.5 * (sum.distance - distance) / self.smoothness).clamp(0.0, 1.0);
            let h = if is_first { 1.0 } else { t * t * (3.0 - 2.0 * t) };
            is_first = false;
            let correction = self.smoothness * h * (1.0 - h);
            sum.distance += (distance - sum.distance) * h - correction;
            let correction = Vec3::splat(correction / (1.0 + 3.0 * self.smoothness));
            let color = hash3(cell.wrapping_add(offset));
            sum.color = sum.color.lerp(color, h) - correction;
            sum.position = sum.position.lerp(position, h) - correction;
        }
        if self.flat {
            sum.position.z = 0.0;
        }
        sum
    }

    /// Distance to the nearest plane between two points.
    fn edge(&self, cell: IVec3, local: Vec3) -> f32 {
        let mut to_nearest = Vec3::splat(1e9);
        for offset in self.around(1) {
            let along = self.point(cell, offset) - local;
            if along.length_squared() < to_nearest.length_squared() {
                to_nearest = along;
            }
        }
        let mut least = f32::MAX;
        for offset in self.around(1) {
            let along = self.point(cell, offset) - local;
            let between = along - to_nearest;
            if between.length_squared() > 1e-4 {
                least = least.min(((to_nearest + along) * 0.5).dot(between.normalize()));
            }
        }
        least
    }
}

/// 31 bits as a number from 0 to 1.
fn unit(word: i32) -> f32 {
    (word & i32::MAX) as f32 * (1.0 / i32::MAX as f32)
}

/// Jarzynski and Olano 2020, "Hash Functions for GPU Rendering", pcg3d, on signed words.
fn hash3(cell: IVec3) -> Vec3 {
    let [mut x, mut y, mut z] =
        cell.to_array().map(|v| v.wrapping_mul(1_664_525).wrapping_add(1_013_904_223));
    for round in 0..2 {
        x = x.wrapping_add(y.wrapping_mul(z));
        y = y.wrapping_add(z.wrapping_mul(x));
        z = z.wrapping_add(x.wrapping_mul(y));
        if round == 0 {
            [x, y, z] = [x, y, z].map(|v| v ^ (v >> 16));
        }
    }
    Vec3::new(unit(x), unit(y), unit(z))
}

/// As [`hash3`], pcg2d of x and y.
fn hash2(cell: IVec3) -> Vec3 {
    const FACTOR: i32 = 1_664_525;
    let [mut x, mut y] = [cell.x, cell.y].map(|v| v.wrapping_mul(FACTOR).wrapping_add(1_013_904_223));
    for round in 0..2 {
        x = x.wrapping_add(y.wrapping_mul(FACTOR));
        y = y.wrapping_add(x.wrapping_mul(FACTOR));
        if round == 0 {
            [x, y] = [x, y].map(|v| v ^ (v >> 16));
        }
    }
    Vec3::new(unit(x), unit(y), 0.0)
}

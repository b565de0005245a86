//! The Voronoi Texture node: one point in every cell of a lattice of one to four dimensions, and how far they are.

use glam::Vec3;
use serde::Deserialize;

use super::cell_hash::CellHash;

/// What is asked about the points around.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "SCREAMING_SNAKE_CASE")]
#[expect(missing_docs, reason = "the names are Blender's")]
pub enum Feature {
    F1,
    F2,
    SmoothF1,
    DistanceToEdge,
    NSphereRadius,
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
    pub(super) hash: CellHash,
    pub(super) smoothness: f32,
    pub(super) exponent: f32,
    /// 0: the points are the lattice's own.
    pub(super) randomness: f32,
    /// Number of finer lattices on top of the first; a part of one counts in part.
    pub(super) detail: f32,
    /// How much each lattice counts, compared with the one before.
    pub(super) roughness: f32,
    /// How much finer each lattice is.
    pub(super) lacunarity: f32,
    /// Within 0 and 1.
    pub(super) normalize: bool,
}

/// What the node finds.
#[derive(Clone, Copy, Debug)]
pub(super) struct Found<const N: usize> {
    pub(super) distance: f32,
    pub(super) color: Vec3,
    pub(super) position: [f32; N],
}

impl<const N: usize> Found<N> {
    const fn nothing(distance: f32) -> Self {
        Self { distance, color: Vec3::ZERO, position: [0.0; N] }
    }
}

impl Voronoi {
    /// Looks around `p`.
    pub(super) fn find<const N: usize>(&self, p: [f32; N]) -> Found<N> {
        let is_single = self.detail == 0.0 || self.roughness == 0.0 || self.feature == Feature::NSphereRadius;
        let (found, most) = match (is_single, self.feature) {
            (true, _) => (self.lattice(p), 1.0),
            (false, Feature::DistanceToEdge) => self.edges(p),
            (false, _) => self.layers(p),
        };
        match self.feature {
            Feature::NSphereRadius => found,
            _ if !self.normalize => found,
            // The lattices of edges are measured one by one.
            Feature::DistanceToEdge if !is_single => Found { distance: found.distance / most, ..found },
            _ => {
                let distance = found.distance / (most * self.farthest::<N>());
                Found { distance, color: found.color / most, ..found }
            }
        }
    }

    /// The farthest that a point is expected to be.
    fn farthest<const N: usize>(&self) -> f32 {
        let reach = 0.5 + 0.5 * self.randomness;
        match self.feature {
            Feature::DistanceToEdge => reach,
            Feature::F2 => 2.0 * self.distance([0.0; N], [reach; N]),
            _ => self.distance([0.0; N], [reach; N]),
        }
    }

    /// The sum of lattices, each finer than the one before, and the sum of how much they count.
    fn layers<const N: usize>(&self, p: [f32; N]) -> (Found<N>, f32) {
        let (mut sum, mut most) = (Found::nothing(0.0), 0.0);
        let (mut scale, mut amplitude) = (1.0, 1.0);
        for share in self.shares() {
            let next = self.lattice(p.map(|x| x * scale));
            let counts = amplitude * share;
            most += counts;
            sum.distance += next.distance * counts;
            sum.color += next.color * counts;
            sum.position = mixed(sum.position, next.position.map(|x| x / scale), counts);
            scale *= self.lacunarity;
            amplitude *= self.roughness;
        }
        (sum, most)
    }

    /// The edges of all lattices together, and the farthest that one is expected to be.
    fn edges<const N: usize>(&self, p: [f32; N]) -> (Found<N>, f32) {
        let (mut distance, mut most) = (8.0_f32, self.farthest::<N>());
        let (mut scale, mut amplitude) = (1.0, 1.0);
        for share in self.shares() {
            let nearer = distance.min(self.lattice(p.map(|x| x * scale)).distance / scale);
            let counts = amplitude * share;
            most += (self.farthest::<N>() / scale - most) * counts;
            distance += (nearer - distance) * counts;
            scale *= self.lacunarity;
            amplitude *= self.roughness;
        }
        (Found { color: Vec3::splat(distance), ..Found::nothing(distance) }, most)
    }

    /// For each lattice: 1, or for the last a part of it.
    fn shares(&self) -> impl Iterator<Item = f32> {
        let whole = self.detail as usize + 1;
        let rest = self.detail.fract();
        std::iter::repeat_n(1.0, whole).chain((rest > 0.0).then_some(rest))
    }

    /// Of one lattice.
    fn lattice<const N: usize>(&self, p: [f32; N]) -> Found<N> {
        let floor = p.map(f32::floor);
        let (cell, local) = (floor.map(|x| x as i32), zipped(p, floor, |x, low| x - low));
        let mut found = match self.feature {
            Feature::SmoothF1 if self.smoothness > 0.0 => self.smooth(cell, local),
            Feature::F1 | Feature::SmoothF1 => self.nearest(cell, local)[0],
            Feature::F2 => self.nearest(cell, local)[1],
            Feature::DistanceToEdge | Feature::NSphereRadius => {
                let distance = match self.feature {
                    Feature::NSphereRadius => self.radius(cell, local),
                    _ if N == 1 => self.edge_on_line(cell, local),
                    _ => self.edge(cell, local),
                };
                Found { color: Vec3::splat(distance), ..Found::nothing(distance) }
            }
        };
        found.position = zipped(found.position, floor, |x, low| x + low);
        found
    }

    /// Where the point of the cell `offset` away from `cell` is, seen from the corner of `cell`.
    fn point<const N: usize>(&self, cell: [i32; N], offset: [i32; N]) -> [f32; N] {
        let random = self.hash.place(zipped(cell, offset, i32::wrapping_add));
        zipped(offset, random, |whole, random| whole as f32 + random * self.randomness)
    }

    fn distance<const N: usize>(&self, a: [f32; N], b: [f32; N]) -> f32 {
        let d = zipped(a, b, |a, b| (a - b).abs());
        match self.metric {
            Metric::Euclidean => length(d),
            Metric::Manhattan => sum(d),
            Metric::Chebychev => d.into_iter().fold(0.0, f32::max),
            Metric::Minkowski => sum(d.map(|x| x.powf(self.exponent))).powf(1.0 / self.exponent),
        }
    }

    /// The nearest point and the one after it.
    fn nearest<const N: usize>(&self, cell: [i32; N], local: [f32; N]) -> [Found<N>; 2] {
        let mut best = [(Found::nothing(f32::MAX), [0; N]); 2];
        for offset in around(1) {
            let position = self.point(cell, offset);
            let distance = self.distance(position, local);
            let found = (Found { distance, color: Vec3::ZERO, position }, offset);
            if distance < best[0].0.distance {
                best = [found, best[0]];
            } else if distance < best[1].0.distance {
                best[1] = found;
            }
        }
        best.map(|(found, offset)| Found {
            color: self.hash.color(zipped(cell, offset, i32::wrapping_add)),
            ..found
        })
    }

    /// As the nearest, blended over with those that are little farther away.
    fn smooth<const N: usize>(&self, cell: [i32; N], local: [f32; N]) -> Found<N> {
        let mut sum = Found::nothing(0.0);
        let mut is_first = true;
        for offset in around(2) {
            let position = self.point(cell, offset);
            let distance = self.distance(position, local);
            let t = (0.5 + 0.5 * (sum.distance - distance) / self.smoothness).clamp(0.0, 1.0);
            let h = if is_first { 1.0 } else { t * t * (3.0 - 2.0 * t) };
            is_first = false;
            let correction = self.smoothness * h * (1.0 - h);
            sum.distance += (distance - sum.distance) * h - correction;
            let correction = correction / (1.0 + 3.0 * self.smoothness);
            let color = self.hash.color(zipped(cell, offset, i32::wrapping_add));
            sum.color = sum.color.lerp(color, h) - Vec3::splat(correction);
            sum.position = mixed(sum.position, position, h).map(|x| x - correction);
        }
        sum
    }

    /// Distance to the nearest plane between two points.
    fn edge<const N: usize>(&self, cell: [i32; N], local: [f32; N]) -> f32 {
        let along = |offset| zipped(self.point(cell, offset), local, |x, y| x - y);
        let mut to_nearest = [1e9; N];
        for to_point in around(1).map(along) {
            if dot(to_point, to_point) < dot(to_nearest, to_nearest) {
                to_nearest = to_point;
            }
        }
        let mut least = f32::MAX;
        for to_point in around(1).map(along) {
            let between = zipped(to_point, to_nearest, |x, y| x - y);
            if dot(between, between) > 1e-4 {
                let to_length = 1.0 / length(between);
                let middle = zipped(to_nearest, to_point, |x, y| (x + y) * 0.5);
                least = least.min(dot(middle, between.map(|x| x * to_length)));
            }
        }
        least
    }

    /// On a line: distance to the nearer of the two middles between a cell's point and its neighbors'.
    fn edge_on_line<const N: usize>(&self, cell: [i32; N], local: [f32; N]) -> f32 {
        let [left, own, right] = [-1, 0, 1].map(|offset| self.point(cell, [offset; N])[0]);
        let to_middle = |other: f32| ((own + other) * 0.5 - local[0]).abs();
        to_middle(left).min(to_middle(right))
    }

    /// Half the distance from the nearest point to the one nearest to that.
    fn radius<const N: usize>(&self, cell: [i32; N], local: [f32; N]) -> f32 {
        let apart = |a: [f32; N], b: [f32; N]| length(zipped(a, b, |x, y| x - y));
        let (mut nearest, mut its_cell, mut least) = ([0.0; N], cell, f32::MAX);
        for offset in around(1) {
            let point = self.point(cell, offset);
            let distance = apart(point, local);
            if distance < least {
                (nearest, its_cell, least) = (point, offset, distance);
            }
        }
        let others = around(1).filter(|offset| *offset != [0; N]);
        let to_other = |offset| apart(self.point(cell, zipped(its_cell, offset, i32::wrapping_add)), nearest);
        0.5 * others.map(to_other).fold(f32::MAX, f32::min)
    }
}

/// The cells around one, up to `reach` away; the first number changes fastest.
fn around<const N: usize>(reach: i32) -> impl Iterator<Item = [i32; N]> {
    std::iter::successors(Some([-reach; N]), move |last| {
        let mut next = *last;
        for number in &mut next {
            if *number < reach {
                *number += 1;
                return Some(next);
            }
            *number = -reach;
        }
        None
    })
}

fn zipped<A: Copy, B: Copy, C, const N: usize>(a: [A; N], b: [B; N], f: impl Fn(A, B) -> C) -> [C; N] {
    std::array::from_fn(|i| f(a[i], b[i]))
}

fn sum<const N: usize>(a: [f32; N]) -> f32 {
    a[1..].iter().fold(a[0], |sum, x| sum + x)
}

fn dot<const N: usize>(a: [f32; N], b: [f32; N]) -> f32 {
    sum(zipped(a, b, |x, y| x * y))
}

fn length<const N: usize>(a: [f32; N]) -> f32 {
    dot(a, a).sqrt()
}

/// From `a` at 0 to `b` at 1.
fn mixed<const N: usize>(a: [f32; N], b: [f32; N], t: f32) -> [f32; N] {
    zipped(a, b, |a, b| a * (1.0 - t) + b * t)
}

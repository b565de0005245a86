//! A balanced kd-tree over points, for searches about a point.
//!
//! Bentley's tree with two changes that make it faster: leaves hold sixteen points side by side, whose distances are
//! computed at once, and the splits are an array in order, which needs no pointers. Sixteen points cost 200 bytes.

use glam::Vec3;

/// Points of a leaf.
pub const LEAF: usize = 16;

/// Below this many points a subtree is built on one thread.
const PARALLEL: usize = 8192;

/// Points by coordinate; infinite past the last.
type Leaf = [[f32; LEAF]; 3];

/// The plane between two halves: points of the lower are at most `at` along `axis`, those of the upper at least.
#[derive(Clone, Copy, Debug, Default)]
struct Split {
    at: f32,
    axis: u32,
}

/// The tree. Its points are known by their place, which is their number in the order of the leaves.
#[derive(Debug)]
pub struct KdTree {
    leaves: Vec<Leaf>,
    /// Split `i` lies between the leaves `i` and `i + 1`. Of leaves `a..a + n` the root is the split before leaf
    /// `a + n / 2`.
    splits: Vec<Split>,
}

/// What a search does with the points it meets.
pub trait Visitor {
    /// Squared distance from which on points are of no interest.
    fn bound(&self) -> f32;
    /// Takes a point nearer than the bound.
    fn meet(&mut self, place: usize, squared_distance: f32);
}

impl KdTree {
    /// The tree, and the number of the point at each place. The same points give the same tree.
    pub fn new(points: impl Iterator<Item = Vec3>) -> (Self, Vec<u32>) {
        #[expect(
            clippy::cast_possible_truncation,
            reason = "a photon map of four billion photons fits no machine"
        )]
        let mut items: Vec<(Vec3, u32)> = points.enumerate().map(|(i, p)| (p, i as u32)).collect();
        let count = items.len().div_ceil(LEAF);
        let mut splits = vec![Split::default(); count.saturating_sub(1)];
        halve(&mut items, &mut splits);
        let leaf = |items: &[(Vec3, u32)]| {
            let mut leaf = [[f32::INFINITY; LEAF]; 3];
            for (i, (p, _)) in items.iter().enumerate() {
                (leaf[0][i], leaf[1][i], leaf[2][i]) = (p.x, p.y, p.z);
            }
            leaf
        };
        let tree = Self { leaves: items.chunks(LEAF).map(leaf).collect(), splits };
        (tree, items.into_iter().map(|(_, number)| number).collect())
    }

    /// Where the point at a place is.
    pub fn point(&self, place: usize) -> Vec3 {
        let leaf = &self.leaves[place / LEAF];
        Vec3::new(leaf[0][place % LEAF], leaf[1][place % LEAF], leaf[2][place % LEAF])
    }

    /// Memory (bytes).
    pub const fn bytes(&self) -> usize {
        self.leaves.len() * size_of::<Leaf>() + self.splits.len() * size_of::<Split>()
    }

    /// Shows `visitor` the points about `p`, near parts of the tree first.
    #[inline]
    pub fn search(&self, p: Vec3, visitor: &mut impl Visitor) {
        let mut waiting = [Branch::default(); DEPTH];
        waiting[0].count = self.leaves.len();
        let mut depth = 1;
        while depth > 0 {
            depth -= 1;
            let Branch { mut first, mut count, beyond } = waiting[depth];
            if count == 0 || Vec3::from(beyond).length_squared() >= visitor.bound() {
                continue;
            }
            while count > 1 {
                let half = count / 2;
                let split = self.splits[first + half - 1];
                let axis = split.axis as usize;
                let distance = p[axis] - split.at;
                let mut far = Branch { first, count: half, beyond };
                far.beyond[axis] = distance;
                if distance < 0.0 {
                    (far.first, far.count) = (first + half, count - half);
                    count = half;
                } else {
                    first += half;
                    count -= half;
                }
                waiting[depth] = far;
                depth += 1;
            }
            self.scan(first, p, visitor);
        }
    }

    #[inline]
    fn scan(&self, number: usize, p: Vec3, visitor: &mut impl Visitor) {
        let leaf = &self.leaves[number];
        let mut distances = [0.0; LEAF];
        for (i, distance) in distances.iter_mut().enumerate() {
            let (x, y, z) = (leaf[0][i] - p.x, leaf[1][i] - p.y, leaf[2][i] - p.z);
            *distance = x * x + y * y + z * z;
        }
        for (i, &distance) in distances.iter().enumerate() {
            if distance < visitor.bound() {
                visitor.meet(number * LEAF + i, distance);
            }
        }
    }
}

/// Splits between the root and a leaf, at most: those of four billion points.
const DEPTH: usize = 32;

/// Leaves that wait to be searched.
#[derive(Clone, Copy, Debug, Default)]
struct Branch {
    first: usize,
    count: usize,
    /// How far outside their box the point is along each axis.
    beyond: [f32; 3],
}

/// Sorts `items` so that each half, quarter and so on of the leaves lies on one side of a plane.
fn halve(items: &mut [(Vec3, u32)], splits: &mut [Split]) {
    let count = items.len().div_ceil(LEAF);
    if count < 2 {
        return;
    }
    let empty = (Vec3::INFINITY, Vec3::NEG_INFINITY);
    let (low, high) = items.iter().fold(empty, |(low, high), &(p, _)| (low.min(p), high.max(p)));
    let axis = (high - low).max_position();
    let half = count / 2;
    let by_axis = |a: &(Vec3, u32), b: &(Vec3, u32)| a.0[axis].total_cmp(&b.0[axis]).then(a.1.cmp(&b.1));
    items.select_nth_unstable_by(half * LEAF, by_axis);
    let (lower, upper) = items.split_at_mut(half * LEAF);
    let (lower_splits, rest) = splits.split_at_mut(half - 1);
    #[expect(clippy::cast_possible_truncation, reason = "one of three axes")]
    let split = Split { at: upper[0].0[axis], axis: axis as u32 };
    rest[0] = split;
    let upper_splits = &mut rest[1..];
    if lower.len() + upper.len() < PARALLEL {
        halve(lower, lower_splits);
        halve(upper, upper_splits);
    } else {
        rayon::join(|| halve(lower, lower_splits), || halve(upper, upper_splits));
    }
}

#[cfg(test)]
mod tests {
    use super::super::cloud;
    use super::*;

    struct Within {
        bound: f32,
        places: Vec<usize>,
    }

    impl Visitor for Within {
        fn bound(&self) -> f32 {
            self.bound
        }
        fn meet(&mut self, place: usize, squared_distance: f32) {
            assert!(squared_distance < self.bound);
            self.places.push(place);
        }
    }

    /// Every size round the borders of leaves and halves, also with many points in one place.
    #[test]
    fn all_points_within_a_radius_are_met_once() {
        for count in [0, 1, 15, 16, 17, 31, 33, 48, 100, 1000, 20_000] {
            let mut points = cloud(count, 1);
            points[count / 2..].iter_mut().take(40).for_each(|p| *p = Vec3::splat(0.25));
            let (tree, order) = KdTree::new(points.iter().copied());
            for center in cloud(50, 2) {
                let mut within = Within { bound: 0.05, places: Vec::new() };
                tree.search(center, &mut within);
                let mut found: Vec<u32> = within.places.iter().map(|&place| order[place]).collect();
                found.sort_unstable();
                let near = |&i: &u32| points[i as usize].distance_squared(center) < 0.05;
                let expected: Vec<u32> = (0..count as u32).filter(near).collect();
                assert_eq!(found, expected, "{count} points");
            }
            for (place, &number) in order.iter().enumerate() {
                assert_eq!(tree.point(place), points[number as usize]);
            }
        }
    }
}

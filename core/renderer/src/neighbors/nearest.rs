//! The k nearest points of a search.

use super::kd_tree::Visitor;

/// Collects the `k` nearest. Candidates are sorted out whenever twice as many have come together, which takes less
/// time than a heap.
#[derive(Debug)]
pub struct Nearest {
    k: usize,
    bound: f32,
    candidates: Vec<Candidate>,
}

/// A point that was met.
#[derive(Clone, Copy, Debug)]
pub struct Candidate {
    /// Squared distance (square scene units).
    pub squared_distance: f32,
    /// Place in the tree.
    pub place: u32,
}

impl Nearest {
    /// A search for `k` points (at least one) no farther than `radius`.
    pub fn new(k: usize, radius: f32) -> Self {
        Self { k, bound: radius * radius, candidates: Vec::with_capacity(2 * k) }
    }

    /// The points nearer than the k-th, and the square of its distance, or of the largest allowed where fewer were
    /// found. The k-th itself is left out: n points in a disc that ends at the next one estimate the density without
    /// bias, n + 1 do not.
    pub fn finish(&mut self) -> (&[Candidate], f32) {
        if self.candidates.len() >= self.k {
            self.keep_nearest();
            self.candidates.truncate(self.k - 1);
        }
        (&self.candidates, self.bound)
    }

    fn keep_nearest(&mut self) {
        let by_distance = |a: &Candidate, b: &Candidate| a.squared_distance.total_cmp(&b.squared_distance);
        let (_, kth, _) = self.candidates.select_nth_unstable_by(self.k - 1, by_distance);
        self.bound = kth.squared_distance;
        self.candidates.truncate(self.k);
    }
}

impl Visitor for Nearest {
    #[inline]
    fn bound(&self) -> f32 {
        self.bound
    }

    #[inline]
    fn meet(&mut self, place: usize, squared_distance: f32) {
        #[expect(clippy::cast_possible_truncation, reason = "places were numbered in 32 bits")]
        self.candidates.push(Candidate { squared_distance, place: place as u32 });
        if self.candidates.len() == 2 * self.k {
            self.keep_nearest();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::cloud;
    use super::super::kd_tree::KdTree;
    use super::*;

    #[test]
    fn the_nearest_are_those_of_a_search_through_all() {
        for (count, k) in [(5, 8), (16, 1), (100, 7), (1000, 50), (5000, 333)] {
            let points = cloud(count, 3);
            let (tree, order) = KdTree::new(points.iter().copied());
            for center in cloud(100, 4) {
                let mut nearest = Nearest::new(k, 0.6);
                tree.search(center, &mut nearest);
                let (candidates, bound) = nearest.finish();
                let mut found: Vec<f32> = candidates.iter().map(|c| c.squared_distance).collect();
                found.sort_by(f32::total_cmp);
                let mut all: Vec<f32> = points.iter().map(|p| p.distance_squared(center)).collect();
                all.retain(|&d| d < 0.6 * 0.6);
                all.sort_by(f32::total_cmp);
                let expected_bound = all.get(k - 1).copied().unwrap_or(0.6 * 0.6);
                all.truncate(k - usize::from(all.len() >= k));
                assert_eq!((found, bound), (all, expected_bound), "{k} of {count}");
                for candidate in candidates {
                    let p = points[order[candidate.place as usize] as usize];
                    assert_eq!(p.distance_squared(center), candidate.squared_distance);
                }
            }
        }
    }
}

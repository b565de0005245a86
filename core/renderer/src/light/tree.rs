//! The choice among all that emits, by what each gives at a point: a tree of clusters (Conty Estevez and Kulla 2018) whose
//! leaves hold a few emitters each. One random number goes down the tree.

use std::ops::Range;

use arrayvec::ArrayVec;
use glam::Vec3;

use super::Receiver;
use super::cluster::{Bounds, Cluster};
use super::select::{self, Choice};

/// Emitters of a leaf, at most; each is weighed at the point.
const LEAF: usize = 8;

/// Up to this many emitters, all are weighed at the point: the tree is one leaf.
pub(super) const FEW: usize = 64;

/// Places along an axis at which a cluster may be split.
const BUCKETS: usize = 16;

/// Of the emitters of a leaf, in its order.
pub(super) type Weights = ArrayVec<f32, FEW>;

/// A tree over emitters. They are named by their index in the list it was built from.
#[derive(Debug, Default)]
pub(super) struct Tree {
    /// Depth first: the first child of a node follows it.
    nodes: Vec<Node>,
    /// Emitters in the order of the leaves.
    order: Vec<u32>,
    /// By emitter: its place in `order`.
    place: Vec<u32>,
}

#[derive(Debug)]
struct Node {
    cluster: Cluster,
    /// Its part of the order.
    first: u32,
    end: u32,
    /// Its second child; 0 for a leaf.
    second: u32,
}

impl Tree {
    /// From the bounds of each emitter.
    pub(super) fn build(emitters: &[Bounds]) -> Self {
        let mut order: Vec<u32> = (0..emitters.len() as u32).collect();
        let mut nodes = Vec::new();
        if !emitters.is_empty() {
            // Suns have no place: they are kept apart.
            order.sort_by_key(|&index| emitters[index as usize].distant);
            let near = order.partition_point(|&index| !emitters[index as usize].distant);
            let apart = (near > 0 && near < order.len()).then_some(near);
            Builder { emitters, nodes: &mut nodes }.add(&mut order, 0, apart);
        }
        let mut place = vec![0; order.len()];
        for (at, &index) in order.iter().enumerate() {
            place[index as usize] = at as u32;
        }
        Self { nodes, order, place }
    }

    /// About the irradiance all emitters together give the receiver; `weigh` says it of each emitter of a leaf.
    pub(super) fn irradiance(&self, receiver: &Receiver, weigh: impl Fn(&[u32]) -> Weights) -> f32 {
        match self.children(0) {
            Some(children) => {
                children.map(|child| self.nodes[child].cluster.irradiance(receiver)).iter().sum()
            }
            None => weigh(&self.order).iter().sum(),
        }
    }

    /// Memory (bytes).
    pub(super) fn bytes(&self) -> usize {
        self.nodes.len() * size_of::<Node>() + (self.order.len() + self.place.len()) * size_of::<u32>()
    }

    /// The emitter that `u` in 0..1 chooses; `weigh` says about what irradiance each emitter of a leaf gives the receiver.
    /// `None` where none gives any.
    pub(super) fn choose(
        &self,
        receiver: &Receiver,
        mut u: f32,
        weigh: impl Fn(&[u32]) -> Weights,
    ) -> Option<Choice> {
        let (mut at, mut probability) = (0, 1.0);
        while let Some([first, second]) = self.children(at) {
            let share = self.share(first, second, receiver)?;
            if u < share {
                (at, u, probability) = (first, u / share, probability * share);
            } else {
                (at, u, probability) = (second, (u - share) / (1.0 - share), probability * (1.0 - share));
            }
            u = u.min(select::BELOW_ONE);
        }
        let range = self.nodes.get(at)?.range();
        let chosen = select::choose(&weigh(&self.order[range.clone()]), u)?;
        let index = self.order[range.start + chosen.index] as usize;
        Some(Choice { index, probability: probability * chosen.probability, rest: chosen.rest })
    }

    /// Probability with which [`Tree::choose`] chooses emitter `index`.
    pub(super) fn probability(
        &self,
        receiver: &Receiver,
        index: usize,
        weigh: impl Fn(&[u32]) -> Weights,
    ) -> f32 {
        let place = self.place[index] as usize;
        let (mut at, mut probability) = (0, 1.0);
        while let Some([first, second]) = self.children(at) {
            let Some(share) = self.share(first, second, receiver) else { return 0.0 };
            if self.nodes[first].range().contains(&place) {
                (at, probability) = (first, probability * share);
            } else {
                (at, probability) = (second, probability * (1.0 - share));
            }
        }
        let range = self.nodes[at].range();
        probability * select::probability(&weigh(&self.order[range.clone()]), place - range.start)
    }

    fn children(&self, at: usize) -> Option<[usize; 2]> {
        let second = self.nodes.get(at)?.second as usize;
        (second > 0).then_some([at + 1, second])
    }

    /// Probability of the first of two children; `None` where neither gives light.
    fn share(&self, first: usize, second: usize, receiver: &Receiver) -> Option<f32> {
        let [a, b] = [first, second].map(|child| self.nodes[child].cluster.irradiance(receiver));
        (a + b > 0.0).then(|| a / (a + b))
    }
}

impl Node {
    fn range(&self) -> Range<usize> {
        self.first as usize..self.end as usize
    }
}

struct Builder<'a> {
    emitters: &'a [Bounds],
    nodes: &'a mut Vec<Node>,
}

impl Builder<'_> {
    /// Adds the node of a part of the order that begins at `first`, and all below it. `apart` is where the root must be
    /// split.
    fn add(&mut self, order: &mut [u32], first: usize, apart: Option<usize>) {
        let at = self.nodes.len();
        let bounds = self.bounds(order);
        let (cluster, end) = (Cluster::new(&bounds), (first + order.len()) as u32);
        self.nodes.push(Node { cluster, first: first as u32, end, second: 0 });
        if order.len() <= if at == 0 { FEW } else { LEAF } {
            return;
        }
        let split = apart.unwrap_or_else(|| self.split(order));
        let (left, right) = order.split_at_mut(split);
        self.add(left, first, None);
        self.nodes[at].second = self.nodes.len() as u32;
        self.add(right, first + split, None);
    }

    fn bounds(&self, order: &[u32]) -> Bounds {
        let every = order.iter().map(|&index| self.emitters[index as usize]);
        every.reduce(Bounds::union).expect("no node is empty")
    }

    /// Brings the emitters of the first child to the front; gives their number. Their middles are sorted into buckets along
    /// the longest axis, and the split between buckets of least cost is taken.
    fn split(&self, order: &mut [u32]) -> usize {
        let middle = |index: u32| self.emitters[index as usize].middle();
        let (mut low, mut high) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
        for &index in order.iter() {
            (low, high) = (low.min(middle(index)), high.max(middle(index)));
        }
        let axis = (high - low).max_position();
        let per_bucket = (high - low)[axis] / BUCKETS as f32;
        if per_bucket.is_nan() || per_bucket <= 0.0 {
            return order.len() / 2;
        }
        let bucket = |index: u32| (((middle(index) - low)[axis] / per_bucket) as usize).min(BUCKETS - 1);
        let mut buckets: [Option<Bounds>; BUCKETS] = [None; BUCKETS];
        for &index in order.iter() {
            let held = &mut buckets[bucket(index)];
            let bounds = self.emitters[index as usize];
            *held = Some(held.map_or(bounds, |held| held.union(bounds)));
        }
        let cost = |part: &[Option<Bounds>]| {
            part.iter().flatten().copied().reduce(Bounds::union).map(|bounds| bounds.cost())
        };
        let costs = (1..BUCKETS)
            .filter_map(|split| Some((split, cost(&buckets[..split])? + cost(&buckets[split..])?)));
        let best = costs.min_by(|a, b| a.1.total_cmp(&b.1)).map_or(1, |(split, _)| split);
        order.sort_by_key(|&index| bucket(index) >= best);
        order.partition_point(|&index| bucket(index) < best)
    }
}

//! Aiming the photons of a light infinitely far away: of the four numbers that make one (its place on the disk across its
//! direction, and its direction), those are drawn more often that a pilot found to matter.
//!
//! The density over the unit cube of numbers is a tree of boxes, constant in each leaf (decision 18): the pilot's finds
//! decide how the cube is cut. A part of all photons is left as it was, so that the density is nowhere 0; every photon's flux
//! is divided by it, which keeps the light that arrives the same on average (importance sampling in primary sample space,
//! Guo et al. 2018).

/// Numbers of a photon.
pub(super) const NUMBERS: usize = 4;

/// Share of the photons that is not aimed.
const UNAIMED: f64 = 0.1;

/// Share of the photons that goes where things were found as often as they were found. That is best for light that is read
/// where it lands. Light from around the corner arrives rarely, and then all at once: there the square root is best.
const DIRECT: f64 = 0.5;

/// Finds that a leaf is taken to hold beside those it does.
const UNSEEN: f64 = 0.5;

/// Finds that a box must hold to be cut.
const LEAST_FINDS: usize = 48;

/// Places at which a box may be cut along each axis: one less.
const STEPS: usize = 16;

/// Information (nats, times finds) that a cut must bring: less is chance.
const LEAST_GAIN: f64 = 10.0;

/// Cuts from the whole cube to a leaf, at most.
const DEEPEST: u32 = 48;

/// What the pilot found: the numbers of a photon, and what it would count for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Find {
    /// Which light, among those photons choose from.
    pub(super) light: usize,
    /// The numbers that make the photon.
    pub(super) numbers: [f32; NUMBERS],
    /// How much it matters, in any unit.
    pub(super) weight: f32,
}

impl Find {
    /// The same, counting for so much.
    #[must_use]
    pub const fn weighing(self, weight: f32) -> Self {
        Self { weight, ..self }
    }
}

/// A density over the numbers of a photon.
#[derive(Clone, Debug)]
pub(super) struct Aim {
    /// Depth first: the lower child of a node follows it.
    nodes: Vec<Node>,
}

#[derive(Clone, Copy, Debug)]
enum Node {
    Leaf {
        density: f32,
    },
    Cut {
        axis: usize,
        /// In the coordinates of the cube.
        at: f32,
        /// Probability of the lower child.
        lower: f32,
        upper_child: u32,
    },
}

impl Aim {
    /// From what was found for one light.
    pub(super) fn new(finds: &mut [([f32; NUMBERS], f32)]) -> Self {
        let total: f64 = finds.iter().map(|find| f64::from(find.1)).sum();
        if !(total > 0.0 && total.is_finite()) {
            return Self { nodes: vec![Node::Leaf { density: 1.0 }] };
        }
        let mut builder = Builder { nodes: Vec::new(), leaves: Vec::new(), total };
        builder.add(finds, [[0.0, 1.0]; NUMBERS], 0);
        let Builder { mut nodes, mut leaves, .. } = builder;
        let unseen = UNSEEN / finds.len() as f64;
        let rare = |leaf: &Leaf| ((leaf.found + unseen) * leaf.volume).sqrt();
        let all_rare: f64 = leaves.iter().map(rare).sum();
        let aimed = |leaf: &Leaf| DIRECT * leaf.found + (1.0 - DIRECT) * rare(leaf) / all_rare;
        for leaf in &mut leaves {
            leaf.probability = (1.0 - UNAIMED) * aimed(leaf) + UNAIMED * leaf.volume;
        }
        settle(&mut nodes, 0, &mut leaves.iter());
        Self { nodes }
    }

    /// Memory (bytes).
    pub(super) const fn bytes(&self) -> usize {
        self.nodes.len() * size_of::<Node>()
    }

    /// Turns even numbers into aimed ones; also gives their density.
    pub(super) fn warp(&self, mut u: [f32; NUMBERS]) -> ([f32; NUMBERS], f32) {
        let mut bounds = [[0.0, 1.0]; NUMBERS];
        let mut node = 0;
        loop {
            match self.nodes[node] {
                Node::Leaf { density } => {
                    for (u, [low, high]) in u.iter_mut().zip(bounds) {
                        *u = (low + (high - low) * *u).min(super::select::BELOW_ONE);
                    }
                    return (u, density);
                }
                Node::Cut { axis, at, lower, upper_child } => {
                    if u[axis] < lower {
                        u[axis] /= lower;
                        bounds[axis][1] = at;
                        node += 1;
                    } else {
                        u[axis] = (u[axis] - lower) / (1.0 - lower);
                        bounds[axis][0] = at;
                        node = upper_child as usize;
                    }
                    u[axis] = u[axis].min(super::select::BELOW_ONE);
                }
            }
        }
    }
}

/// Sets the densities of the leaves and, from them, where the numbers are divided at the cuts, from a node down; gives the
/// node's probability. `leaves` come in the order of the nodes.
fn settle(nodes: &mut [Node], node: usize, leaves: &mut std::slice::Iter<'_, Leaf>) -> f64 {
    match nodes[node] {
        Node::Leaf { .. } => {
            let Some(leaf) = leaves.next() else { return 0.0 };
            nodes[node] = Node::Leaf { density: (leaf.probability / leaf.volume) as f32 };
            leaf.probability
        }
        Node::Cut { axis, at, upper_child, .. } => {
            let below = settle(nodes, node + 1, leaves);
            let above = settle(nodes, upper_child as usize, leaves);
            let lower = (below / (below + above)) as f32;
            nodes[node] = Node::Cut { axis, at, lower, upper_child };
            below + above
        }
    }
}

/// A box that is not cut.
struct Leaf {
    /// Share of the weight of all finds.
    found: f64,
    volume: f64,
    /// How often it is to be drawn.
    probability: f64,
}

struct Builder {
    nodes: Vec<Node>,
    /// In the order of the nodes.
    leaves: Vec<Leaf>,
    /// Weight of all finds.
    total: f64,
}

/// Where a box is best cut.
struct Cut {
    axis: usize,
    at: f32,
    gain: f64,
}

impl Builder {
    /// Adds the node of a box and all below it.
    fn add(&mut self, finds: &mut [([f32; NUMBERS], f32)], bounds: [[f32; 2]; NUMBERS], depth: u32) {
        self.nodes.push(Node::Leaf { density: 0.0 });
        let place = self.nodes.len() - 1;
        let cut = best_cut(finds, &bounds).filter(|_| finds.len() >= LEAST_FINDS && depth < DEEPEST);
        let Some(Cut { axis, at, .. }) = cut else {
            let found = finds.iter().map(|find| f64::from(find.1)).sum::<f64>() / self.total;
            let volume = bounds.iter().map(|[low, high]| f64::from(high - low)).product();
            self.leaves.push(Leaf { found, volume, probability: 0.0 });
            return;
        };
        finds.sort_unstable_by(|a, b| a.0[axis].total_cmp(&b.0[axis]));
        let (below, above) = finds.split_at_mut(finds.partition_point(|find| find.0[axis] < at));
        let mut part = bounds;
        part[axis] = [bounds[axis][0], at];
        self.add(below, part, depth + 1);
        let upper_child = self.nodes.len() as u32;
        part[axis] = [at, bounds[axis][1]];
        self.add(above, part, depth + 1);
        self.nodes[place] = Node::Cut { axis, at, lower: 0.5, upper_child };
    }
}

/// The cut after which what was found is least evenly spread over the two parts; `None` where none says more than chance
/// would.
fn best_cut(finds: &[([f32; NUMBERS], f32)], bounds: &[[f32; 2]; NUMBERS]) -> Option<Cut> {
    let total: f64 = finds.iter().map(|find| f64::from(find.1)).sum();
    let squares: f64 = finds.iter().map(|find| f64::from(find.1).powi(2)).sum();
    // As many finds of equal weight would say as much.
    let count = total * total / squares;
    let mut best: Option<Cut> = None;
    for (axis, &[low, high]) in bounds.iter().enumerate() {
        let step = (high - low) / STEPS as f32;
        // Below this, places are no longer told apart.
        if step < 8.0 * f32::EPSILON {
            continue;
        }
        let mut steps = [0.0; STEPS];
        for (numbers, weight) in finds {
            let index = (((numbers[axis] - low) / step) as usize).min(STEPS - 1);
            steps[index] += f64::from(*weight) / total;
        }
        let mut below = 0.0;
        for (i, of_step) in steps.iter().enumerate().take(STEPS - 1) {
            below += of_step;
            let share = (i + 1) as f64 / STEPS as f64;
            let gain = count * (surprise(below, share) + surprise(1.0 - below, 1.0 - share));
            if gain > best.as_ref().map_or(LEAST_GAIN, |cut| cut.gain) {
                best = Some(Cut { axis, at: low + step * (i + 1) as f32, gain });
            }
        }
    }
    best
}

/// What finding a share `p` in a part `q` of the volume says (nats).
fn surprise(p: f64, q: f64) -> f64 {
    if p > 0.0 { p * (p / q).ln() } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Finds in a small box, as a window would make them.
    fn window() -> Vec<([f32; NUMBERS], f32)> {
        let part = |i: usize, step: f32| (i as f32 * step).fract();
        (0..2000)
            .map(|i| {
                let numbers = [
                    0.41 + 0.02 * part(i, 0.618_034),
                    0.7 + 0.03 * part(i, 0.754_878),
                    0.2 + 0.3 * part(i, 0.569_840),
                    part(i, 0.819_173),
                ];
                (numbers, 1.0)
            })
            .collect()
    }

    fn in_window(u: [f32; NUMBERS]) -> bool {
        (0.41..0.43).contains(&u[0]) && (0.7..0.73).contains(&u[1]) && (0.2..0.5).contains(&u[2])
    }

    /// Points of a lattice in the unit cube.
    fn points(count: usize) -> impl Iterator<Item = [f32; NUMBERS]> {
        let steps = [0.856_675, 0.733_892, 0.628_707, 0.538_597];
        (0..count).map(move |i| steps.map(|step: f64| (i as f64 * step).fract() as f32))
    }

    #[test]
    fn most_go_where_things_were_found() {
        let aim = Aim::new(&mut window());
        let count = 20_000;
        let hits = points(count).filter(|&u| in_window(aim.warp(u).0)).count();
        let share = hits as f64 / count as f64;
        assert!(share > 0.4 && share < 0.9, "{share}");
    }

    /// Whatever is integrated over the numbers, the mean of value over density is its integral.
    #[test]
    fn integrals_stay_the_same() {
        let aim = Aim::new(&mut window());
        let count = 400_000;
        let mean = |value: &dyn Fn([f32; NUMBERS]) -> f64| {
            let sum: f64 = points(count)
                .map(|u| {
                    let (warped, density) = aim.warp(u);
                    value(warped) / f64::from(density)
                })
                .sum();
            sum / count as f64
        };
        assert!((mean(&|_| 1.0) - 1.0).abs() < 0.01);
        assert!((mean(&|u| f64::from(u[3]) * 2.0) - 1.0).abs() < 0.01);
        let of_window = mean(&|u| f64::from(u8::from(in_window(u))));
        assert!((of_window / (0.02 * 0.03 * 0.3) - 1.0).abs() < 0.02, "{of_window}");
    }

    #[test]
    fn nowhere_is_left_out() {
        let aim = Aim::new(&mut window());
        for u in points(5000) {
            let (warped, density) = aim.warp(u);
            assert!(density >= UNAIMED as f32 * 0.999, "{density} at {warped:?}");
            assert!(warped.iter().all(|x| (0.0..1.0).contains(x)));
        }
    }

    #[test]
    fn even_finds_change_nothing() {
        let mut even: Vec<_> = points(5000).map(|u| (u, 1.0)).collect();
        assert_eq!(Aim::new(&mut even).nodes.len(), 1);
        assert_eq!(Aim::new(&mut []).warp([0.25; NUMBERS]), ([0.25; NUMBERS], 1.0));
    }
}

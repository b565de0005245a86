//! Choosing one of several things with probability in proportion to a weight.

/// Share of every choice that is spread evenly, so that what a weight underestimates is still found.
const EVEN_SHARE: f64 = 0.1;

/// The largest f32 below 1.
pub(super) const BELOW_ONE: f32 = 1.0 - f32::EPSILON / 2.0;

/// What was chosen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Choice {
    /// Which one.
    pub index: usize,
    /// How likely it was.
    pub probability: f32,
    /// The rest of the random number, again uniform in 0..1.
    pub rest: f32,
}

/// A discrete distribution as a running sum in f64 whose last entry is exactly 1. Entries of weight 0 are never chosen.
#[derive(Clone, Debug, Default)]
pub(super) struct Cdf {
    sums: Vec<f64>,
}

impl Cdf {
    /// From non-negative, finite weights; `None` if none is positive.
    pub(super) fn new(weights: impl IntoIterator<Item = f64>) -> Option<Self> {
        let mut total = 0.0;
        let mut sums: Vec<f64> = weights
            .into_iter()
            .map(|weight| {
                total += weight;
                total
            })
            .collect();
        if !(total > 0.0 && total.is_finite()) {
            return None;
        }
        for sum in &mut sums {
            // Entries behind the last positive one have the same sum and become 1 with it.
            *sum = if *sum == total { 1.0 } else { *sum / total };
        }
        Some(Self { sums })
    }

    /// Memory (bytes).
    pub(super) const fn bytes(&self) -> usize {
        self.sums.len() * size_of::<f64>()
    }

    /// As [`Cdf::new`], with a tenth spread evenly over the entries of positive weight.
    pub(super) fn with_even_share(weights: &[f64]) -> Option<Self> {
        let shares = Shares::of(weights.iter().copied())?;
        Self::new(weights.iter().map(|&weight| shares.probability(weight)))
    }

    /// The entry `u` in 0..1 falls into.
    pub(super) fn choose(&self, u: f32) -> Choice {
        let u = f64::from(u).clamp(0.0, 1.0 - f64::EPSILON);
        // The first sum greater than u: it differs from the one before, so its entry has a positive weight.
        let index = self.sums.partition_point(|&sum| sum <= u);
        let before = if index == 0 { 0.0 } else { self.sums[index - 1] };
        let probability = self.sums[index] - before;
        Choice { index, probability: probability as f32, rest: rest((u - before) / probability) }
    }
}

/// Chooses among a few weights that were made on the spot, with the even share mixed in.
pub(super) fn choose(weights: &[f32], u: f32) -> Option<Choice> {
    let shares = Shares::of(weights.iter().map(|&weight| f64::from(weight)))?;
    let mut left = f64::from(u).clamp(0.0, 1.0 - f64::EPSILON);
    let mut chosen = None;
    for (index, &weight) in weights.iter().enumerate() {
        let probability = shares.probability(f64::from(weight));
        if probability <= 0.0 {
            continue;
        }
        // Kept for when rounding lets u slip past the last one.
        chosen = Some(Choice {
            index,
            probability: probability as f32,
            rest: rest(left.min(probability) / probability),
        });
        if left < probability {
            break;
        }
        left -= probability;
    }
    chosen
}

/// Probability with which [`choose`] returns `index`.
pub(super) fn probability(weights: &[f32], index: usize) -> f32 {
    let shares = Shares::of(weights.iter().map(|&weight| f64::from(weight)));
    shares.map_or(0.0, |shares| shares.probability(f64::from(weights[index])) as f32)
}

/// From weights to probabilities.
struct Shares {
    per_weight: f64,
    even: f64,
}

impl Shares {
    /// `None` if there is nothing to choose from.
    fn of(weights: impl Iterator<Item = f64>) -> Option<Self> {
        let (mut total, mut positive) = (0.0, 0.0);
        for weight in weights {
            total += weight;
            positive += f64::from(u8::from(weight > 0.0));
        }
        (total >= f64::MIN_POSITIVE && total.is_finite())
            .then(|| Self { per_weight: (1.0 - EVEN_SHARE) / total, even: EVEN_SHARE / positive })
    }

    fn probability(&self, weight: f64) -> f64 {
        if weight > 0.0 { weight * self.per_weight + self.even } else { 0.0 }
    }
}

/// Keeps a rescaled random number below 1 once it is f32.
fn rest(u: f64) -> f32 {
    (u as f32).clamp(0.0, BELOW_ONE)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn entries_of_no_weight_are_never_chosen() {
        let cdf = Cdf::new([0.0, 0.0, 3.0, 0.0, 1e-3, 0.0, 0.0]).unwrap();
        for i in 0..=1000 {
            let chosen = cdf.choose(i as f32 / 1000.0);
            assert!(chosen.index == 2 || chosen.index == 4, "{chosen:?}");
            assert!(chosen.probability > 0.0 && (0.0..1.0).contains(&chosen.rest), "{chosen:?}");
        }
        assert_eq!(cdf.choose(1.0).index, 4);
        assert_eq!(*cdf.sums.last().unwrap(), 1.0);
        assert!(Cdf::new([0.0, 0.0]).is_none() && Cdf::new([]).is_none());
    }

    #[test]
    fn probabilities_are_weights_less_the_even_share() {
        let weights = [1.0, 0.0, 3.0];
        for (index, expected) in [0.9 * 0.25 + 0.05, 0.0, 0.9 * 0.75 + 0.05].into_iter().enumerate() {
            assert!((probability(&weights, index) - expected).abs() < 1e-6);
        }
    }

    #[test]
    fn both_ways_of_choosing_agree() {
        let weights = [0.5_f32, 0.0, 2.0, 1.0, 0.0];
        let cdf = Cdf::with_even_share(&weights.map(f64::from)).unwrap();
        for i in 0..1000 {
            let u = (i as f32 + 0.5) / 1000.0;
            let (a, b) = (cdf.choose(u), choose(&weights, u).unwrap());
            assert_eq!(a.index, b.index);
            assert!((a.probability - b.probability).abs() < 1e-6 && (a.rest - b.rest).abs() < 1e-5);
        }
        assert!(choose(&[0.0, 0.0], 0.5).is_none() && choose(&[], 0.5).is_none());
    }

    #[test]
    fn the_rest_of_the_number_is_uniform_again() {
        let cdf = Cdf::new([1.0, 4.0]).unwrap();
        assert!((cdf.choose(0.1).rest - 0.5).abs() < 1e-6);
        assert!((cdf.choose(0.4).rest - 0.25).abs() < 1e-6);
    }
}

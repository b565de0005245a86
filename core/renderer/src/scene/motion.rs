//! What changes while the shutter is open. Times run from 0, when it opens, to 1; the scene's own state is that of the
//! middle, and what moves has steps at even times about it.

use glam::{DAffine3, DMat3, DQuat, DVec3};

/// When everything is where the scene's own arrays say.
pub const MIDDLE: f32 = 0.5;

/// Most steps of one thing, those the host gives and those put between them.
pub(super) const MOST_STEPS: usize = 129;

/// What turns is cut into steps of this angle at most (rad): between steps points go straight.
const LARGEST_TURN: f64 = 0.05;

/// How the shutter opens and closes: the density of time.
#[derive(Clone, Debug, Default)]
pub struct Shutter {
    /// The density at even times, straight between them; empty where it is even.
    curve: Vec<f64>,
    /// Its integral up to each of them, 1 at the last.
    integral: Vec<f64>,
}

impl Shutter {
    /// A shutter that is as open as `curve` says at even times, if at all; without any it is fully open all the time.
    ///
    /// # Errors
    /// Why it is no shutter.
    pub(super) fn new(curve: &[f64]) -> Result<Self, &'static str> {
        if !curve.iter().all(|value| value.is_finite()) {
            return Err("its shutter curve is not a number");
        }
        let curve: Vec<f64> = curve.iter().map(|value| value.max(0.0)).collect();
        if curve.windows(2).all(|pair| pair[0].to_bits() == pair[1].to_bits()) {
            return Ok(Self::default());
        }
        let mut integral = vec![0.0];
        let mut sum = 0.0;
        for pair in curve.windows(2) {
            sum += 0.5 * (pair[0] + pair[1]);
            integral.push(sum);
        }
        if !sum.is_finite() {
            return Err("its shutter curve is larger than numbers go");
        }
        integral.iter_mut().for_each(|value| *value /= sum);
        Ok(Self { curve: curve.iter().map(|value| value / sum).collect(), integral })
    }

    /// The time that a number in [0, 1) names, distributed as the shutter is open.
    #[must_use]
    #[expect(clippy::cast_possible_truncation, reason = "rays have times of f32")]
    pub fn time(&self, u: f32) -> f32 {
        if self.curve.is_empty() {
            return u;
        }
        let u = f64::from(u);
        let last = self.curve.len() - 2;
        let index = (self.integral.partition_point(|&value| value <= u) - 1).min(last);
        let (left, right) = (self.curve[index], self.curve[index + 1]);
        // left · x + (right − left) x² / 2 = the rest of u, solved without cancellation.
        let rest = (u - self.integral[index]).max(0.0);
        let root = (left * left + 2.0 * (right - left) * rest).max(0.0).sqrt();
        let x = if left + root > 0.0 { (2.0 * rest / (left + root)).min(1.0) } else { 0.0 };
        ((index as f64 + x) / (last + 1) as f64) as f32
    }
}

/// The interval of `steps` even ones that holds a time, and how far into it that is.
pub(super) fn interval(time: f32, steps: usize) -> (usize, f64) {
    let at = f64::from(time) * (steps - 1) as f64;
    let index = (at.max(0.0) as usize).min(steps - 2);
    (index, at - index as f64)
}

/// The transform at a time: elements change evenly between steps, as in the ray tracer.
pub(super) fn at(steps: &[DAffine3], time: f32) -> DAffine3 {
    let (index, part) = interval(time, steps.len());
    let (a, b) = (&steps[index], &steps[index + 1]);
    DAffine3 {
        matrix3: a.matrix3 + (b.matrix3 - a.matrix3) * part,
        translation: a.translation.lerp(b.translation, part),
    }
}

/// Steps before the middle, the middle, and as many after it, with more between them where they turn.
pub(super) fn refined(keys: &[DAffine3]) -> Vec<DAffine3> {
    let turns = keys.windows(2).map(|pair| rotation(&pair[0]).angle_between(rotation(&pair[1])));
    let wanted = (turns.fold(0.0, f64::max) / LARGEST_TURN).ceil().max(1.0) as usize;
    let per_key = wanted.min((MOST_STEPS - 1) / (keys.len() - 1));
    let mut steps = Vec::with_capacity((keys.len() - 1) * per_key + 1);
    for pair in keys.windows(2) {
        steps.extend((0..per_key).map(|i| between(&pair[0], &pair[1], i as f64 / per_key as f64)));
    }
    steps.extend(keys.last());
    steps
}

/// A transform between two: the rotation turns evenly, all else changes evenly.
fn between(a: &DAffine3, b: &DAffine3, part: f64) -> DAffine3 {
    if part == 0.0 {
        return *a;
    }
    let [turn_a, turn_b] = [a, b].map(rotation);
    let unturned = |turn: DQuat, matrix: DMat3| DMat3::from_quat(turn.inverse()) * matrix;
    let [rest_a, rest_b] = [unturned(turn_a, a.matrix3), unturned(turn_b, b.matrix3)];
    DAffine3 {
        matrix3: DMat3::from_quat(turn_a.slerp(turn_b, part)) * (rest_a + (rest_b - rest_a) * part),
        translation: a.translation.lerp(b.translation, part),
    }
}

fn rotation(transform: &DAffine3) -> DQuat {
    let axes = transform.matrix3;
    let sign = axes.determinant().signum();
    let z = axes.z_axis.normalize_or(DVec3::Z) * sign;
    let x = (axes.x_axis - z * axes.x_axis.dot(z)).normalize_or(z.any_orthonormal_vector());
    DQuat::from_mat3(&DMat3::from_cols(x, z.cross(x), z)).normalize()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers at even distances fall into each tenth of the shutter as its curve says.
    #[test]
    fn times_are_distributed_as_the_shutter_is_open() {
        let share = |curve: &[f64], tenth: u32| {
            let shutter = Shutter::new(curve).expect("a shutter");
            let times = (0..100_000).map(|i| shutter.time((i as f32 + 0.5) / 100_000.0));
            f64::from(times.filter(|time| (time * 10.0) as u32 == tenth).count() as u32) / 100_000.0
        };
        for tenth in 0..10 {
            let x = f64::from(tenth) / 10.0;
            assert!((share(&[], tenth) - 0.1).abs() < 1e-4);
            assert!((share(&[0.7, 0.7, 0.7], tenth) - 0.1).abs() < 1e-4);
            assert!((share(&[0.0, 1.0], tenth) - (0.01 + 0.2 * x)).abs() < 1e-4);
            let triangle = if tenth < 5 { 0.02 + 0.4 * x } else { 0.02 + 0.4 * (0.9 - x) };
            assert!((share(&[0.0, 3.0, 0.0], tenth) - triangle).abs() < 1e-4);
            let late = if tenth < 5 { 0.0 } else { 0.08 * (x - 0.5) * 10.0 + 0.04 };
            assert!((share(&[0.0, 0.0, 1.0], tenth) - late).abs() < 1e-4);
        }
    }

    #[test]
    fn what_is_no_shutter_is_refused_or_even() {
        assert!(Shutter::new(&[0.0, f64::NAN]).is_err());
        assert!(Shutter::new(&[1e308, 0.0, 1e308, 1e308]).is_err());
        for always_shut in [[0.0, 0.0], [-1.0, -2.0]] {
            assert_eq!(Shutter::new(&always_shut).expect("even").time(0.25).to_bits(), 0.25_f32.to_bits());
        }
    }

    /// A point of something that turns stays on its circle, mirrored and sheared or not.
    #[test]
    fn turning_things_stay_in_shape() {
        let shapes = [DMat3::IDENTITY, DMat3::from_diagonal(DVec3::new(-1.0, 2.0, 0.5))];
        let shear = DMat3::from_cols(DVec3::X, DVec3::new(0.3, 1.0, 0.0), DVec3::Z);
        for shape in shapes.into_iter().chain([shear]) {
            let key = |angle: f64| DAffine3::from_mat3(DMat3::from_rotation_y(angle) * shape);
            let steps = refined(&[key(-1.2), key(0.0), key(1.2)]);
            assert!(steps.len() % 2 == 1 && steps.len() <= MOST_STEPS);
            for i in 0..=20_u8 {
                let time = f32::from(i) / 20.0;
                let expected = key(1.2 * f64::from(2.0 * time - 1.0));
                assert!(at(&steps, time).abs_diff_eq(expected, 4e-4), "{time}");
            }
            assert!(at(&steps, MIDDLE).abs_diff_eq(key(0.0), 0.0), "the middle is exact");
        }
    }

    #[test]
    fn what_only_shifts_needs_no_more_steps() {
        let keys = [0.0, 1.0, 5.0].map(|x| DAffine3::from_translation(DVec3::X * x));
        assert_eq!(refined(&keys).len(), 3);
        assert!((at(&keys, 0.75).translation.x - 3.0).abs() < 1e-12);
    }
}

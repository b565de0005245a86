//! Normal classes: which surfaces inside one cell are kept apart.
//!
//! Six faces of a cube; optionally nine parts of each, the middle one holding what is aligned with the axis. The front of
//! a triangle, where its normal points, and its back are kept apart: the inside of a board thinner than a cell must not
//! count as lit surface of its top. The class only says where light is stored; it is never the frame of the direction bins.

use glam::Vec3;

use crate::math::Side;

/// How many classes there are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NormalClasses {
    /// The faces of a cube.
    Six,
    /// Nine parts of each face.
    FiftyFour,
}

/// Normals this close to a border between classes count as on it, so that rounding does not split a flat surface.
const SNAP: f32 = 1e-3;

/// The first class of a back; those below are fronts.
pub(super) const BACKS: usize = 64;

impl NormalClasses {
    /// As the setting has it: "54", or else "6".
    #[must_use]
    pub fn of_setting(setting: &str) -> Self {
        if setting == "54" { Self::FiftyFour } else { Self::Six }
    }

    /// Class of a side of a surface: its direction, and for backs [`BACKS`] more.
    #[must_use]
    #[inline(always)]
    pub fn of(self, side: Side) -> usize {
        self.direction(side.normal) + usize::from(side.back) * BACKS
    }

    /// Of the front of a surface: the class of the fronts that face it.
    #[must_use]
    pub const fn facing(self, front: usize) -> usize {
        match self {
            Self::Six => front ^ 1,
            // Both ratios change their sign.
            Self::FiftyFour => ((front / 9) ^ 1) * 9 + 8 - front % 9,
        }
    }

    #[inline(always)]
    fn direction(self, normal: Vec3) -> usize {
        // Ties go to the earlier axis. Without branches: which way a hit faces is anyone's guess.
        let a = normal.abs();
        let x = (a.x >= a.y - SNAP) & (a.x >= a.z - SNAP);
        let y = a.y >= a.z - SNAP;
        let axis = (1 - usize::from(x)) * (2 - usize::from(y));
        let negative = normal.is_negative_bitmask() >> axis & 1;
        let face = axis * 2 + negative as usize;
        match self {
            Self::Six => face,
            Self::FiftyFour => {
                let axes = [normal.x, normal.y, normal.z, normal.x, normal.y];
                let middle = axes[axis].abs() * (1.0 / 3.0 + SNAP);
                let part = |v: f32| 1 + usize::from(v > middle) - usize::from(v < -middle);
                face * 9 + part(axes[axis + 1]) * 3 + part(axes[axis + 2])
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn classes_are_in_range_and_opposite_sides_differ() {
        for classes in [NormalClasses::Six, NormalClasses::FiftyFour] {
            let directions = if classes == NormalClasses::Six { 6 } else { 54 };
            let mut used = vec![0; 2 * BACKS];
            for i in 0..20_000 {
                let z = 1.0 - 2.0 * (i as f32 + 0.5) / 20_000.0;
                let (sin, cos) = (i as f32 * 2.399_963).sin_cos();
                let n = Vec3::new(cos * (1.0 - z * z).sqrt(), sin * (1.0 - z * z).sqrt(), z);
                let [front, back] = Side::both(n).map(|side| classes.of(side));
                assert_ne!(front, classes.of(Side { normal: -n, back: false }), "{n}");
                assert_ne!(front, classes.of(Side { normal: n, back: true }), "{n}");
                assert_eq!(classes.facing(front), classes.of(Side { normal: -n, back: false }), "{n}");
                used[front] = 1;
                used[back] = 1;
            }
            assert_eq!(
                [&used[..BACKS], &used[BACKS..]].map(|side| side.iter().sum::<usize>()),
                [directions; 2]
            );
        }
    }

    #[test]
    fn rounding_does_not_split_what_is_flat() {
        for classes in [NormalClasses::Six, NormalClasses::FiftyFour] {
            for n in [
                Vec3::X,
                Vec3::NEG_Z,
                Vec3::new(1.0, 1.0, 0.0),
                Vec3::new(1.0, -1.0, 1.0),
                Vec3::new(0.0, 1.0, -1.0),
            ] {
                let n = n.normalize();
                for noise in [Vec3::new(1e-6, -1e-6, 2e-6), Vec3::new(-3e-6, 1e-6, 1e-6)] {
                    let [exact, rounded] =
                        [n, (n + noise).normalize()].map(|normal| classes.of(Side { normal, back: false }));
                    assert_eq!(exact, rounded, "{n}");
                }
            }
        }
    }
}

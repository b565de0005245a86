//! Intensities of a luminaire, measured from direction to direction, and what lies between them.

use std::f32::consts::PI;

use glam::Vec3;
use serde::Deserialize;

/// A photometric web: intensities over a grid of angles (rad), which do not fall. Vertical angles are counted from -z,
/// horizontal ones around z from -y.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PhotometricWeb {
    /// Horizontal angles.
    pub horizontal: Vec<f32>,
    /// Vertical angles.
    pub vertical: Vec<f32>,
    /// A row for each horizontal angle of a number for each vertical one. Before and after all rows, and all numbers of a
    /// row, is one more: what the cubic at the edge of the grid takes for its fourth point.
    pub intensity: Vec<f32>,
}

impl PhotometricWeb {
    /// What is wrong with it.
    pub(super) fn fault(&self) -> Option<String> {
        let rises = |angles: &[f32]| !angles.is_empty() && angles.windows(2).all(|pair| pair[0] <= pair[1]);
        if !rises(&self.horizontal) || !rises(&self.vertical) {
            return Some("a photometric web needs angles that do not fall".to_owned());
        }
        let [rows, columns] = [self.horizontal.len() + 2, self.vertical.len() + 2];
        let found = self.intensity.len();
        (found != rows * columns)
            .then(|| format!("a photometric web has {found} intensities, not {rows} x {columns}"))
    }

    /// Intensity along a direction from the luminaire, by the cubic of Catmull and Rom in both angles; 0 outside the grid.
    pub(super) fn intensity(&self, direction: Vec3) -> f32 {
        let d = direction.normalize_or_zero();
        let (vertical, horizontal) = ((-d.z).clamp(-1.0, 1.0).acos(), d.x.atan2(d.y) + PI);
        let (Some((i, s)), Some((j, t))) =
            (interval(&self.horizontal, horizontal), interval(&self.vertical, vertical))
        else {
            return 0.0;
        };
        let columns = self.vertical.len() + 2;
        let row = |k: usize| cubic(std::array::from_fn(|l| self.intensity[(i + k) * columns + j + l]), t);
        cubic(std::array::from_fn(row), s).max(0.0)
    }
}

/// The interval that holds an angle, and its place there, 0 to 1.
fn interval(angles: &[f32], angle: f32) -> Option<(usize, f32)> {
    let (&first, &last) = (angles.first()?, angles.last()?);
    if !(first <= angle && angle < last) {
        return None;
    }
    let i = angles.partition_point(|&low| low < angle).saturating_sub(1);
    let span = angles[i + 1] - angles[i];
    Some((i, if span > 0.0 { (angle - angles[i]) / span } else { 0.0 }))
}

/// From the second of four points at 0 to the third at 1: Catmull and Rom 1974, "A Class of Local Interpolating Splines".
fn cubic([a, b, c, d]: [f32; 4], t: f32) -> f32 {
    let (first, second, third) = (c - a, 2.0 * a - 5.0 * b + 4.0 * c - d, d - a + 3.0 * (b - c));
    b + 0.5 * t * (first + t * (second + t * third))
}

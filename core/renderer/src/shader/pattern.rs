//! Patterns that are computed, not stored.

use glam::Vec3;
use serde::Deserialize;

/// Shapes of the Gradient Texture node.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "SCREAMING_SNAKE_CASE")]
#[expect(missing_docs, reason = "the names are Blender's")]
pub enum GradientShape {
    Linear,
    Quadratic,
    Easing,
    Diagonal,
    Radial,
    QuadraticSphere,
    Spherical,
}

/// The Gradient Texture node.
#[must_use]
pub(super) fn gradient(shape: GradientShape, p: Vec3) -> f32 {
    use std::f32::consts::TAU;
    let value = match shape {
        GradientShape::Linear => p.x,
        GradientShape::Quadratic => p.x.max(0.0).powi(2),
        GradientShape::Easing => {
            let t = p.x.clamp(0.0, 1.0);
            t * t * (3.0 - 2.0 * t)
        }
        GradientShape::Diagonal => (p.x + p.y) * 0.5,
        GradientShape::Radial => p.y.atan2(p.x) / TAU + 0.5,
        GradientShape::QuadraticSphere => (0.999_999 - p.length()).max(0.0).powi(2),
        GradientShape::Spherical => (0.999_999 - p.length()).max(0.0),
    };
    value.clamp(0.0, 1.0)
}

/// The Checker Texture node at a scaled point: true for the first color.
#[must_use]
pub(super) fn checker(p: Vec3) -> bool {
    // Off the planes between two cells, where rounding would choose.
    let cell = ((p + 0.000_001) * 0.999_999).floor();
    let odd = |c: f32| c.rem_euclid(2.0) >= 1.0;
    (odd(cell.x) == odd(cell.y)) == odd(cell.z)
}

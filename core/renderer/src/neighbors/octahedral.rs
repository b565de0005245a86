//! Unit vectors in four bytes.

use glam::{Vec2, Vec3};

/// A unit vector, as a point of the unfolded octahedron (Meyer et al. 2010, "On Floating-Point Normal Vectors"), within
/// 0.004°.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Octahedral([i16; 2]);

const STEPS: f32 = 32767.0;

impl From<Vec3> for Octahedral {
    fn from(v: Vec3) -> Self {
        let v = v / v.abs().element_sum();
        let upper = v.truncate();
        let point = if v.z < 0.0 { fold(upper) } else { upper };
        #[expect(clippy::cast_possible_truncation, reason = "quantised on purpose")]
        Self((point * STEPS).round().to_array().map(|c| c as i16))
    }
}

impl From<Octahedral> for Vec3 {
    fn from(packed: Octahedral) -> Self {
        let point = Vec2::from(packed.0.map(f32::from)) / STEPS;
        let z = 1.0 - point.abs().element_sum();
        let upper = if z < 0.0 { fold(point) } else { point };
        upper.extend(z).normalize()
    }
}

/// The lower half of the octahedron lies in the corners of the square, its own inverse.
fn fold(point: Vec2) -> Vec2 {
    let mirrored = Vec2::ONE - Vec2::new(point.y.abs(), point.x.abs());
    Vec2::new(mirrored.x.copysign(point.x), mirrored.y.copysign(point.y))
}

#[cfg(test)]
mod tests {
    use super::super::cloud;
    use super::*;

    #[test]
    fn vectors_come_back() {
        let axes = [Vec3::X, Vec3::Y, Vec3::Z].into_iter().flat_map(|v| [v, -v]);
        for v in cloud(10_000, 5).into_iter().map(Vec3::normalize).chain(axes) {
            let back = Vec3::from(Octahedral::from(v));
            assert!(v.distance(back) < 7e-5, "{v} came back as {back}");
        }
    }
}

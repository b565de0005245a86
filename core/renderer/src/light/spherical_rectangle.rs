//! The solid angle of a rectangle and directions spread evenly over it: Ureña, Fajardo and King 2013, "An
//! Area-Preserving Parametrization for Spherical Rectangles".

use std::f64::consts::TAU;

/// Below this solid angle (sr) its value is lost in rounding, and sampling by area is as good.
const SMALLEST_SOLID_ANGLE: f64 = 1e-4;

/// An axis-aligned rectangle in the plane at `distance` in front of the point that looks at it.
#[derive(Clone, Copy, Debug)]
pub(super) struct SphericalRectangle {
    x: [f64; 2],
    y: [f64; 2],
    distance: f64,
    /// Heights of the great circles through the two sides along x: b0 and b1 of the paper.
    b: [f64; 2],
    /// The paper's k.
    k: f64,
    /// Solid angle (sr).
    pub solid_angle: f64,
}

impl SphericalRectangle {
    /// Bounds relative to the foot of the perpendicular from the point. `None` where the solid angle is too small, or
    /// the point too near the plane, for the formulas to hold.
    pub(super) fn new(x: [f64; 2], y: [f64; 2], distance: f64) -> Option<Self> {
        let height = |side: f64| side / norm(side, distance);
        let [left, right] = x.map(height);
        let [bottom, top] = y.map(height);
        // Angles between the planes through neighbouring sides, from the normals' components along the axis.
        let angle = |a: f64, b: f64| (-a * b).clamp(-1.0, 1.0).acos();
        let k = TAU - angle(top, -left) - angle(-left, -bottom);
        let solid_angle = angle(-bottom, right) + angle(right, top) - k;
        (distance > 0.0 && solid_angle > SMALLEST_SOLID_ANGLE).then_some(Self {
            x,
            y,
            distance,
            b: [-bottom, top],
            k,
            solid_angle,
        })
    }

    /// A point of the rectangle, in the coordinates of its bounds, uniform in solid angle.
    pub(super) fn sample(&self, u: [f32; 2]) -> [f64; 2] {
        let z = -self.distance;
        let [u, v] = u.map(f64::from);
        let (sin, cos) = (self.k + u * self.solid_angle).sin_cos();
        let f = (cos * self.b[0] - self.b[1]) / sin;
        let c = (1.0 / norm(f, self.b[0])).min(1.0).copysign(f);
        let x = (-c * z / (1.0 - c * c).max(1e-30).sqrt()).clamp(self.x[0], self.x[1]);
        let d = norm(x, z);
        let [h0, h1] = self.y.map(|y| y / norm(y, d));
        let h = h0 + v * (h1 - h0);
        let y = (h * d / (1.0 - h * h).max(1e-30).sqrt()).clamp(self.y[0], self.y[1]);
        [x, y]
    }
}

/// Length of (a, b); lengths of the scene's size neither overflow nor vanish, and `hypot`'s care costs much here.
fn norm(a: f64, b: f64) -> f64 {
    (a * a + b * b).sqrt()
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;

    /// Solid angle of the rectangle from 0 to a and 0 to b at distance d: atan(a b / (d √(a² + b² + d²))).
    fn quadrant(a: f64, b: f64, d: f64) -> f64 {
        (a * b / (d * (a * a + b * b + d * d).sqrt())).atan()
    }

    #[test]
    fn solid_angle_matches_its_closed_form() {
        for (x, y, d) in [
            ([-1.0, 2.0], [-0.5, 0.3], 0.7),
            ([1.0, 3.0], [-2.0, -1.0], 2.0),
            ([-1.0, 1.0], [-1.0, 1.0], 1.0),
        ] {
            let corner = |i: usize, k: usize| quadrant(x[i], y[k], d);
            let expected = corner(1, 1) - corner(0, 1) - corner(1, 0) + corner(0, 0);
            let value = SphericalRectangle::new(x, y, d).unwrap().solid_angle;
            assert!((value / expected - 1.0).abs() < 1e-10, "{value} {expected}");
        }
        // A face of a cube around the point; a plane close by.
        let cube = SphericalRectangle::new([-1.0, 1.0], [-1.0, 1.0], 1.0).unwrap();
        assert!((cube.solid_angle - 4.0 * PI / 6.0).abs() < 1e-12);
        let plane = SphericalRectangle::new([-1.0, 1.0], [-1.0, 1.0], 1e-9).unwrap();
        assert!((plane.solid_angle - 2.0 * PI).abs() < 1e-6);
    }

    #[test]
    fn samples_share_the_solid_angle_evenly() {
        // The share of samples in each part of the rectangle is that part's share of the solid angle.
        let (x, y, d) = ([-0.2, 1.3], [0.1, 0.9], 0.15);
        let rectangle = SphericalRectangle::new(x, y, d).unwrap();
        let part = SphericalRectangle::new([0.0, 0.3], [0.1, 0.4], d).unwrap();
        let steps = 1000_u16;
        let mut inside = 0.0;
        for i in 0..steps {
            for k in 0..steps {
                let u = [i, k].map(|c| (f32::from(c) + 0.5) / f32::from(steps));
                let [px, py] = rectangle.sample(u);
                assert!((x[0]..=x[1]).contains(&px) && (y[0]..=y[1]).contains(&py));
                inside += f64::from(u8::from((0.0..=0.3).contains(&px) && py <= 0.4));
            }
        }
        let share = inside / f64::from(steps).powi(2);
        assert!((share - part.solid_angle / rectangle.solid_angle).abs() < 2e-3, "{share}");
    }

    #[test]
    fn what_is_too_small_or_edge_on_is_left_to_area_sampling() {
        assert!(SphericalRectangle::new([-1e-3, 1e-3], [-1e-3, 1e-3], 1.0).is_none());
        assert!(SphericalRectangle::new([1.0, 2.0], [-1.0, 1.0], 0.0).is_none());
        assert!(SphericalRectangle::new([1.0, 2.0], [-1.0, 1.0], 1e-9).is_none());
    }
}

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
        let height = |side: f64| side / side.hypot(distance);
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
        let c = (1.0 / f.hypot(self.b[0])).min(1.0).copysign(f);
        let x = (-c * z / (1.0 - c * c).max(1e-30).sqrt()).clamp(self.x[0], self.x[1]);
        let d = x.hypot(z);
        let [h0, h1] = self.y.map(|y| y / y.hypot(d));
        let h = h0 + v * (h1 - h0);
        let y = (h * d / (1.0 - h * h).max(1e-30).sqrt()).clamp(self.y[0], self.y[1]);
        [x, y]
    }
}

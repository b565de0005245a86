//! Which ray a point of the camera's window stands for. Cameras look along −Z, y upwards.

use glam::{DVec2, DVec3};
use serde::Deserialize;

/// How the image plane is projected. Each has a unit of its own for the window.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum Projection {
    /// Rays leave one point. The window is on the plane at distance 1.
    Perspective,
    /// Rays are parallel. The window is in metres.
    Orthographic,
    /// The window is longitude, to the right of the view axis, and latitude above it (rad).
    Equirectangular,
    /// A cube's face, divided into even angles from its middle. They are the window (rad).
    CubemapFace,
    /// Onto a cylinder of radius 1 about y. The window is longitude (rad) and height.
    Cylindrical,
    /// Angles from the view axis are distances in the window (rad).
    FisheyeEquidistant {
        /// Of all that is seen (rad).
        field_of_view: f64,
    },
    /// Solid angles are areas in the window: twice the sine of half the angle from the view axis is the distance.
    FisheyeEquisolid {
        /// Of all that is seen (rad).
        field_of_view: f64,
    },
    /// Angles from the view axis are a polynomial of the distance in the window, which is in millimetres on the sensor.
    FisheyePolynomial {
        /// Of all that is seen (rad).
        field_of_view: f64,
        /// Of the powers of the distance (rad, rad·mm⁻¹, ...).
        coefficients: [f64; 5],
    },
}

/// The ray of a point of the window, in the camera's space.
#[derive(Clone, Copy, Debug)]
pub struct Sight {
    /// Where it starts (units of the window).
    pub origin: DVec3,
    /// One unit of depth along it; a unit vector for projections that have no depth, but distances.
    pub direction: DVec3,
    /// Angle across a small part of the window over its edge there; 1 for projections that have depth.
    pub spread: f64,
}

impl Projection {
    /// False for panoramas, which have no image plane: their rays start at one point and are measured by distance.
    #[must_use]
    pub const fn has_depth(&self) -> bool {
        matches!(self, Self::Perspective | Self::Orthographic)
    }

    /// Why it is no projection.
    pub(super) fn check(&self) -> Result<(), &'static str> {
        match *self {
            Self::FisheyePolynomial { coefficients, .. } if !coefficients.iter().all(|k| k.is_finite()) => {
                Err("its lens polynomial is not a number")
            }
            Self::FisheyeEquidistant { field_of_view }
            | Self::FisheyeEquisolid { field_of_view }
            | Self::FisheyePolynomial { field_of_view, .. }
                if !(field_of_view > 0.0 && field_of_view.is_finite()) =>
            {
                Err("its field of view is empty")
            }
            _ => Ok(()),
        }
    }

    /// The ray of a point of the window; `None` outside the image circle of a fisheye.
    #[must_use]
    pub fn sight(&self, at: DVec2) -> Option<Sight> {
        let with_depth = |origin, direction| Sight { origin, direction, spread: 1.0 };
        Some(match *self {
            Self::Perspective => with_depth(DVec3::ZERO, at.extend(-1.0)),
            Self::Orthographic => with_depth(at.extend(0.0), DVec3::NEG_Z),
            Self::Equirectangular => {
                let ((sin, cos), (up, level)) = (at.x.sin_cos(), at.y.sin_cos());
                panoramic(DVec3::new(level * sin, up, -level * cos), level)
            }
            Self::CubemapFace => {
                let (x, y) = (at.x.tan(), at.y.tan());
                let direction = DVec3::new(x, y, -1.0);
                let distance = direction.length();
                panoramic(direction / distance, (1.0 + x * x) * (1.0 + y * y) / distance.powi(3))
            }
            Self::Cylindrical => {
                let (sin, cos) = at.x.sin_cos();
                let direction = DVec3::new(sin, at.y, -cos);
                let distance = direction.length();
                panoramic(direction / distance, distance.powi(-3))
            }
            Self::FisheyeEquidistant { field_of_view } => {
                fisheye(at, |r| (r <= 0.5 * field_of_view).then_some((r, 1.0)))?
            }
            Self::FisheyeEquisolid { field_of_view } => {
                let largest = 2.0 * (0.25 * field_of_view).sin();
                let angle =
                    |r: f64| (2.0 * (0.5 * r).asin(), (1.0 - 0.25 * r * r).sqrt().max(MIDDLE).recip());
                fisheye(at, |r| (r <= largest).then(|| angle(r)))?
            }
            Self::FisheyePolynomial { field_of_view, coefficients: [k0, k1, k2, k3, k4] } => {
                let angle = |r: f64| k0 + r * (k1 + r * (k2 + r * (k3 + r * k4)));
                let slope = |r: f64| k1 + r * (2.0 * k2 + r * (3.0 * k3 + r * 4.0 * k4));
                fisheye(at, |r| (angle(r).abs() <= 0.5 * field_of_view).then(|| (angle(r), slope(r))))?
            }
        })
    }

    /// A point of a lens (in its own plane), where it lies in the camera's space: panoramas have a lens that faces each ray.
    #[must_use]
    pub fn lens_point(&self, direction: DVec3, point: DVec2) -> DVec3 {
        if self.has_depth() {
            return point.extend(0.0);
        }
        let [x, y] = lens_axes(direction);
        x * point.x + y * point.y
    }
}

/// The axes of the lens of a panorama, across a unit direction: the first is turned towards the view axis.
fn lens_axes(direction: DVec3) -> [DVec3; 2] {
    let across = DVec3::NEG_Z + direction * direction.z;
    let x = across.try_normalize().unwrap_or_else(|| direction.any_orthonormal_vector());
    [x, direction.cross(x)]
}

/// In a unit direction, where the window has `solid_angle` per area.
fn panoramic(direction: DVec3, solid_angle: f64) -> Sight {
    Sight { origin: DVec3::ZERO, direction, spread: solid_angle.abs().sqrt() }
}

/// As near to the middle or the edge of a fisheye's picture as formulas go that divide by the distance.
const MIDDLE: f64 = 1e-9;

/// At a distance from the middle of the window, `angle` tells the angle from the view axis, and how it grows.
fn fisheye(at: DVec2, angle: impl Fn(f64) -> Option<(f64, f64)>) -> Option<Sight> {
    let r = at.length().max(MIDDLE);
    let (theta, slope) = angle(r)?;
    let (sin, cos) = theta.sin_cos();
    let outward = at.normalize_or(DVec2::Y);
    Some(panoramic((outward * sin).extend(-cos), sin * slope / r))
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};

    use super::Projection::*;
    use super::*;

    const POLYNOMIAL: [f64; 5] = [0.0, 0.2, 0.01, -0.001, 0.000_1];

    fn direction(projection: Projection, x: f64, y: f64) -> DVec3 {
        projection.sight(DVec2::new(x, y)).expect("within the picture").direction
    }

    #[track_caller]
    fn assert_looks(projection: Projection, [x, y]: [f64; 2], expected: [f64; 3]) {
        let found = direction(projection, x, y);
        let expected = DVec3::from(expected).normalize();
        assert!(found.abs_diff_eq(expected, 1e-8), "{projection:?} at {x}, {y}: {found}, not {expected}");
    }

    /// Ahead, to the right, above and behind.
    #[test]
    fn panoramas_look_where_their_names_say() {
        let around = 2.0 * PI;
        let polynomial = FisheyePolynomial { field_of_view: around, coefficients: POLYNOMIAL };
        for projection in [
            Equirectangular,
            CubemapFace,
            Cylindrical,
            FisheyeEquidistant { field_of_view: around },
            FisheyeEquisolid { field_of_view: around },
            polynomial,
        ] {
            assert_looks(projection, [0.0, 0.0], [0.0, 0.0, -1.0]);
        }
        assert_looks(Equirectangular, [FRAC_PI_2, 0.0], [1.0, 0.0, 0.0]);
        assert_looks(Equirectangular, [0.3, FRAC_PI_2], [0.0, 1.0, 0.0]);
        assert_looks(Equirectangular, [-PI, -FRAC_PI_4], [0.0, -1.0, 1.0]);
        assert_looks(CubemapFace, [FRAC_PI_4, FRAC_PI_4], [1.0, 1.0, -1.0]);
        assert_looks(CubemapFace, [0.0, -0.2], [0.0, -(0.2_f64.tan()), -1.0]);
        assert_looks(Cylindrical, [-FRAC_PI_2, 2.0], [-1.0, 2.0, 0.0]);
        assert_looks(FisheyeEquidistant { field_of_view: around }, [FRAC_PI_2, 0.0], [1.0, 0.0, 0.0]);
        assert_looks(FisheyeEquidistant { field_of_view: around }, [0.0, PI], [0.0, 0.0, 1.0]);
        let half = 0.5_f64.sqrt();
        assert_looks(FisheyeEquisolid { field_of_view: around }, [2.0 * half, 0.0], [1.0, 0.0, 0.0]);
        assert_looks(FisheyeEquisolid { field_of_view: around }, [-1.0, -1.0], [-1.0, -1.0, 0.0]);
        let angle: f64 = POLYNOMIAL.iter().sum();
        assert_looks(polynomial, [0.0, -1.0], [0.0, -angle.sin(), -angle.cos()]);
    }

    /// The solid angle of the whole window, summed up over its points, is that of the part of the sphere it shows; and that
    /// of a small square is what lies between the directions of its corners.
    #[test]
    fn windows_hold_the_solid_angle_they_show() {
        const STEPS: u32 = 400;
        let cap = |angle: f64| 2.0 * PI * (1.0 - angle.cos());
        let field_of_view = 2.4;
        let reach = 2.0 * 0.6_f64.sin();
        let polynomial = FisheyePolynomial { field_of_view, coefficients: POLYNOMIAL };
        for (projection, [half_x, half_y], expected) in [
            (Equirectangular, [PI, FRAC_PI_2], 4.0 * PI),
            (CubemapFace, [FRAC_PI_4, FRAC_PI_4], 4.0 * PI / 6.0),
            (Cylindrical, [PI, 1.5], 4.0 * PI * 1.5 / 3.25_f64.sqrt()),
            (FisheyeEquidistant { field_of_view }, [1.2, 1.2], cap(1.2)),
            (FisheyeEquisolid { field_of_view }, [reach, reach], cap(1.2)),
            (FisheyeEquisolid { field_of_view: 2.0 * PI }, [2.0, 2.0], 4.0 * PI),
            (polynomial, [7.0, 7.0], cap(1.2)),
        ] {
            let step = DVec2::new(half_x, half_y) * 2.0 / f64::from(STEPS);
            let mut sum = 0.0;
            for i in 0..STEPS * STEPS {
                let at = (DVec2::new((i % STEPS).into(), (i / STEPS).into()) + 0.5) * step
                    - DVec2::new(half_x, half_y);
                let Some(sight) = projection.sight(at) else { continue };
                assert!((sight.direction.length() - 1.0).abs() < 1e-12 && sight.origin == DVec3::ZERO);
                sum += sight.spread * sight.spread * step.x * step.y;
                let small = 1e-6;
                let across = |by: DVec2| {
                    let [there, back] = [at + by, at - by].map(|at| projection.sight(at));
                    Some((there?.direction - back?.direction) / (2.0 * small))
                };
                if let (Some(x), Some(y)) = (across(DVec2::X * small), across(DVec2::Y * small)) {
                    let area = x.cross(y).length();
                    assert!((area - sight.spread * sight.spread).abs() < 1e-3, "{projection:?} at {at}");
                }
            }
            assert!((sum / expected - 1.0).abs() < 0.003, "{projection:?}: {sum}, not {expected}");
        }
    }

    #[test]
    fn nothing_is_seen_outside_the_image_circle() {
        let sees = |projection: Projection, r: f64| projection.sight(DVec2::new(0.6, -0.8) * r).is_some();
        let field_of_view = 2.0;
        let edge = 2.0 * 0.5_f64.sin();
        let linear = |k: f64| FisheyePolynomial { field_of_view, coefficients: [0.0, k, 0.0, 0.0, 0.0] };
        for (projection, edge) in [
            (FisheyeEquidistant { field_of_view }, 1.0),
            (FisheyeEquisolid { field_of_view }, edge),
            (linear(0.25), 4.0),
            (linear(-0.25), 4.0),
        ] {
            assert!(sees(projection, edge * 0.999) && !sees(projection, edge * 1.001), "{projection:?}");
        }
        assert!(!sees(linear(f64::MAX), 4.0) && !sees(FisheyeEquisolid { field_of_view: 14.0 }, 0.1));
    }

    /// Rays through any point of the lens meet in one point, at the distance of focus; the lens is across the ray.
    #[test]
    fn the_lens_of_a_panorama_faces_each_ray() {
        for [x, y] in [[0.0, 0.0], [2.0, 0.4], [-PI, 0.0], [0.1, -1.5]] {
            let direction = direction(Equirectangular, x, y);
            let [a, b] = [DVec2::X, DVec2::Y].map(|p| Equirectangular.lens_point(direction, p));
            assert!((a.length() - 1.0).abs() < 1e-12 && (b.length() - 1.0).abs() < 1e-12);
            assert!(
                a.dot(b).abs() < 1e-12 && a.dot(direction).abs() < 1e-12 && b.dot(direction).abs() < 1e-12
            );
        }
        let right = direction(Equirectangular, FRAC_PI_2, 0.0);
        assert!(Equirectangular.lens_point(right, DVec2::X).abs_diff_eq(DVec3::NEG_Z, 1e-12));
        assert_eq!(Perspective.lens_point(DVec3::X, DVec2::new(1.0, 2.0)), DVec3::new(1.0, 2.0, 0.0));
    }

    #[test]
    fn what_is_no_projection_is_refused() {
        for field_of_view in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            let coefficients = POLYNOMIAL;
            assert!(FisheyeEquidistant { field_of_view }.check().is_err());
            assert!(FisheyeEquisolid { field_of_view }.check().is_err());
            assert!(FisheyePolynomial { field_of_view, coefficients }.check().is_err());
        }
        let coefficients = [0.0, f64::NAN, 0.0, 0.0, 0.0];
        assert!(FisheyePolynomial { field_of_view: 1.0, coefficients }.check().is_err());
        assert!(FisheyePolynomial { field_of_view: 1.0, coefficients: POLYNOMIAL }.check().is_ok());
    }
}

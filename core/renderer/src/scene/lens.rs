//! The camera's lens. Points off its plane of focus become blurred images of its aperture, a disk or a regular polygon.

use std::f64::consts::PI;

use glam::DVec2;
use serde::Deserialize;

use super::LARGEST;
use crate::sampling::concentric_disk;

/// A thin lens as the host describes it.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LensRecord {
    /// Radius of the circle about the aperture (m).
    pub radius: f64,
    /// Corners of the aperture; it is a disk below three.
    pub blades: u32,
    /// By which the polygon is turned, counter-clockwise in the camera's xy plane (rad).
    pub rotation: f64,
    /// Height of the aperture over its width.
    pub ratio: f64,
    /// Distance of the plane of focus along the view axis (m).
    pub focus_distance: f64,
}

/// A lens in scene space that blurs.
#[derive(Clone, Debug)]
pub struct Lens {
    radius: f64,
    blades: u32,
    rotation: f64,
    ratio: f64,
    focus_distance: f64,
}

impl Lens {
    /// The lens of a record; `None` for a pinhole.
    ///
    /// # Errors
    /// Why it is no lens.
    pub(super) fn new(record: &LensRecord, scale: f64) -> Result<Option<Self>, &'static str> {
        let &LensRecord { radius, blades, rotation, ratio, focus_distance } = record;
        if ![radius, rotation, ratio, focus_distance].iter().all(|v| v.is_finite()) {
            return Err("its lens is not a number");
        }
        let (radius, focus_distance) = (radius * scale, focus_distance * scale);
        if focus_distance <= 0.0 || ratio <= 0.0 {
            return Err("its lens has no plane of focus, or an aperture without height");
        }
        if [radius, radius / ratio, radius / ratio / focus_distance].iter().any(|v| v.abs() > LARGEST) {
            return Err("its lens is larger than numbers go");
        }
        Ok((radius > 0.0).then_some(Self { radius, blades, rotation, ratio, focus_distance }))
    }

    /// A point of the aperture in the camera's xy plane (scene units), uniform over it.
    #[must_use]
    pub fn point(&self, u: [f32; 2]) -> DVec2 {
        let p = if self.blades < 3 {
            concentric_disk(u).as_dvec2()
        } else {
            polygon(u.map(f64::from), f64::from(self.blades), self.rotation)
        };
        DVec2::new(p.x / self.ratio, p.y) * self.radius
    }

    /// Distance of the plane of focus (scene units).
    #[must_use]
    pub const fn focus_distance(&self) -> f64 {
        self.focus_distance
    }

    /// Area of the aperture (square scene units).
    #[must_use]
    pub fn area(&self) -> f64 {
        let blades = f64::from(self.blades);
        let unit = if self.blades < 3 { PI } else { 0.5 * blades * (2.0 * PI / blades).sin() };
        unit * self.radius * self.radius / self.ratio
    }
}

/// Uniform on a regular polygon in the unit circle, the middle of its first side at the angle `rotation`.
fn polygon(u: [f64; 2], corners: f64, rotation: f64) -> DVec2 {
    let side = (u[0] * corners).floor().min(corners - 1.0);
    // Within the triangle between the center and the side.
    let (outward, along) = ((u[0] * corners - side).sqrt(), 2.0 * u[1] - 1.0);
    let half = PI / corners;
    let p = DVec2::new(half.cos(), half.sin() * along) * outward;
    DVec2::from_angle(rotation + 2.0 * half * side).rotate(p)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lens(blades: u32, rotation: f64, ratio: f64) -> Lens {
        let record = LensRecord { radius: 0.5, blades, rotation, ratio, focus_distance: 2.0 };
        Lens::new(&record, 4.0).expect("a lens").expect("not a pinhole")
    }

    /// Random points fill the aperture evenly, and nothing else: counted in cells of a grid against its area.
    #[test]
    fn points_are_uniform_over_the_aperture() {
        const POINTS: u32 = 1_000_000;
        for (blades, ratio) in [(0, 1.0), (3, 1.0), (5, 1.0), (6, 2.0), (8, 0.5)] {
            let lens = lens(blades, 0.3, ratio);
            let cell = lens.area().sqrt() / 25.0;
            let mut counts = std::collections::BTreeMap::new();
            let mut rng = crate::sampling::Rng::new(1);
            for _ in 0..POINTS {
                let p = lens.point(rng.draw2());
                *counts.entry(((p.x / cell).floor() as i32, (p.y / cell).floor() as i32)).or_insert(0_u32) +=
                    1;
            }
            // A cell that lies inside holds its share; those on the edge are inside in part.
            let share = |count: u32| f64::from(count) / f64::from(POINTS) * lens.area() / (cell * cell);
            let covered: f64 = counts.values().map(|&count| share(count)).filter(|&s| s > 0.8).count() as f64;
            assert!(covered * cell * cell > 0.75 * lens.area(), "{blades} blades");
            assert!(counts.values().all(|&count| share(count) < 1.12), "{blades} blades");
        }
    }

    /// The corners lie half a side from where the first side faces; the ratio stretches x.
    #[test]
    fn the_aperture_is_turned_and_stretched() {
        let reach = |lens: &Lens, angle: f64| {
            let axis = DVec2::from_angle(angle);
            let points = (0..90_000).map(|i| lens.point([i % 300, i / 300].map(|v| v as f32 / 299.01)));
            points.map(|p| p.dot(axis)).fold(0.0, f64::max)
        };
        let square = lens(4, 0.0, 1.0);
        assert!((reach(&square, 0.0) - 2.0 * 0.5_f64.sqrt()).abs() < 0.01);
        assert!((reach(&square, PI / 4.0) - 2.0).abs() < 0.02);
        let turned = lens(4, PI / 4.0, 1.0);
        assert!((reach(&turned, 0.0) - 2.0).abs() < 0.02);
        let wide = lens(0, 0.0, 0.5);
        assert!((reach(&wide, 0.0) - 4.0).abs() < 0.01 && (reach(&wide, PI / 2.0) - 2.0).abs() < 0.01);
    }

    #[test]
    fn what_is_no_lens_is_refused() {
        let record = LensRecord { radius: 0.1, blades: 0, rotation: 0.0, ratio: 1.0, focus_distance: 1.0 };
        assert!(Lens::new(&LensRecord { radius: 0.0, ..record.clone() }, 1.0).unwrap().is_none());
        assert!(Lens::new(&LensRecord { focus_distance: 0.0, ..record.clone() }, 1.0).is_err());
        assert!(Lens::new(&LensRecord { radius: f64::NAN, ..record.clone() }, 1.0).is_err());
        assert!(Lens::new(&LensRecord { focus_distance: 1e-300, ..record.clone() }, 1e-300).is_err());
        assert!(Lens::new(&LensRecord { radius: 1e30, ..record.clone() }, 1.0).is_err());
        assert!(Lens::new(&LensRecord { ratio: 1e-30, ..record.clone() }, 1.0).is_err());
        assert!(Lens::new(&LensRecord { ratio: 0.0, ..record }, 1.0).is_err());
    }
}

//! Rectangular and elliptic lamps: one-sided, radiance power / (π area) on the whole, narrowed by [`Spread`].

use std::f32::consts::{FRAC_1_PI, FRAC_PI_4, PI};

use glam::{Vec2, Vec3};

use super::cluster::Bounds;
use super::outline::Outline;
use super::proxy::Hull;
use super::spherical_rectangle::SphericalRectangle;
use super::spread::Spread;
use super::{Crossing, LARGEST_LENGTH, LightSample, Photon, Ray, proxy, warp};
use crate::color::Rgb;
use crate::scene::Lamp;

/// Shorter sides (scene units, the scene filling a unit cube) count as this long.
const SMALLEST_SIDE: f32 = 1e-6;

/// An ellipse whose bounding rectangle covers more than this (sr) is sampled by the rectangle's solid angle, which
/// wastes a fifth of the samples and keeps the rest even close to the lamp; smaller ones are sampled by area.
const WIDE_SOLID_ANGLE: f64 = 0.5;

/// Squared diagonal over squared distance below which a lamp looks flat: sampled by area, at a fraction of the cost, its
/// contributions vary by a factor of two or three.
const FAR_SIZE_SQUARED: f32 = 0.4;

/// An area lamp.
#[derive(Clone, Debug)]
pub(super) struct AreaLamp {
    center: Vec3,
    x_axis: Vec3,
    y_axis: Vec3,
    /// The side that shines.
    normal: Vec3,
    /// Half the sides or diameters.
    half: Vec2,
    round: bool,
    area: f32,
    power: Rgb,
    spread: Spread,
}

/// The part of the lamp's plane that is sampled from one point, in coordinates about the foot of the perpendicular from
/// that point.
enum Region {
    /// By solid angle.
    Spherical(SphericalRectangle),
    /// A rectangle by area: center and half sides.
    Flat(Vec2, Vec2),
    /// The whole ellipse by area.
    Ellipse,
}

impl AreaLamp {
    /// `None` for a lamp without area or direction.
    pub(super) fn new(lamp: &Lamp, size: [f32; 2], spread: f32, round: bool) -> Option<Self> {
        let sides = Vec2::from(size).abs();
        if !(sides.min_element() > 0.0 && sides.max_element() <= LARGEST_LENGTH) {
            return None;
        }
        let sides = sides.max(Vec2::splat(SMALLEST_SIDE));
        let normal = lamp.axis.try_normalize()?;
        // A sheared parent leaves axes that are not at right angles: the normal is kept, the rest follows.
        let x_axis = lamp.x_axis.reject_from_normalized(normal).try_normalize()?;
        Some(Self {
            center: lamp.position,
            x_axis,
            y_axis: normal.cross(x_axis),
            normal,
            half: sides * 0.5,
            round,
            area: sides.x * sides.y * if round { FRAC_PI_4 } else { 1.0 },
            power: lamp.power,
            spread: Spread::new(spread),
        })
    }

    /// False for parallel light, which no ray can meet.
    pub(super) fn has_extent(&self) -> bool {
        self.spread != Spread::Parallel
    }

    /// Emitted flux.
    pub(super) fn flux(&self) -> Rgb {
        self.power
    }

    /// Triangles that hold the lamp: its bounding rectangle.
    pub(super) fn hull(&self) -> Hull {
        let [x, y] = [self.x_axis * self.half.x, self.y_axis * self.half.y];
        let c = self.center;
        proxy::rectangle(c, [c - x - y, c + x - y, c + x + y, c - x + y])
    }

    /// Where its light is and goes.
    pub(super) fn bounds(&self) -> Bounds {
        let extent = (self.x_axis * self.half.x).abs() + (self.y_axis * self.half.y).abs();
        Bounds {
            low: self.center - extent,
            high: self.center + extent,
            axis: self.normal,
            spread: 0.0,
            reach: self.spread.reach().atan(),
            ..Bounds::ball(self.center, 0.0, self.power.mean() * FRAC_1_PI * self.spread.peak())
        }
    }

    /// What the choice among lamps looks at; it lights these sets of objects.
    pub(super) fn outline(&self, receivers: u32) -> Outline {
        Outline {
            center: self.center,
            x_axis: self.x_axis,
            y_axis: self.y_axis,
            normal: self.normal,
            half: self.half,
            reach: self.spread.reach(),
            intensity: self.power.mean() * FRAC_1_PI * self.spread.peak(),
            area: self.area,
            receivers,
        }
    }

    /// A point of the lamp as seen from `p`.
    pub(super) fn sample(&self, p: Vec3, u: [f32; 2]) -> Option<LightSample> {
        let (foot, height) = self.local(p);
        if height <= 0.0 {
            return None;
        }
        if self.spread == Spread::Parallel {
            let radiance_over_pdf = self.power / self.area;
            return self.contains(foot).then_some(LightSample {
                wi: -self.normal,
                distance: height,
                radiance_over_pdf,
                pdf: 1.0,
                is_delta: true,
                point: None,
            });
        }
        let region = self.region(foot, height)?;
        let offset = match &region {
            Region::Spherical(rectangle) => Vec2::from(rectangle.sample(u).map(|c| c as f32)),
            Region::Flat(center, half) => *center + *half * (Vec2::from(u) * 2.0 - 1.0),
            Region::Ellipse => warp::disk(u) * self.half - foot,
        };
        if !self.contains(foot + offset) {
            return None;
        }
        let along = self.x_axis * offset.x + self.y_axis * offset.y - self.normal * height;
        let distance = along.length();
        let pdf = self.pdf(&region, distance, height);
        let radiance = self.radiance(offset, height);
        (pdf > 0.0 && !radiance.is_black()).then(|| LightSample {
            wi: along / distance,
            distance,
            radiance_over_pdf: radiance / pdf,
            pdf,
            is_delta: false,
            point: None,
        })
    }

    /// Where the ray meets the shining side.
    pub(super) fn crossing(&self, ray: &Ray) -> Option<Crossing> {
        let (foot, height) = self.local(ray.from);
        let cos = -ray.wi.dot(self.normal);
        if height <= 0.0 || cos <= 0.0 {
            return None;
        }
        let distance = height / cos;
        let offset = Vec2::new(ray.wi.dot(self.x_axis), ray.wi.dot(self.y_axis)) * distance;
        if !ray.span.contains(&distance) || !self.contains(foot + offset) {
            return None;
        }
        let radiance = self.radiance(offset, height);
        let pdf = self.pdf(&self.region(foot, height)?, distance, height);
        (!radiance.is_black()).then_some(Crossing { radiance, pdf, distance })
    }

    /// Distance from `p` to the lamp's plane along a line that meets it.
    pub(super) fn distance_along(&self, p: Vec3, wi: Vec3) -> f32 {
        self.local(p).1 / -wi.dot(self.normal)
    }

    /// A photon; every one carries the lamp's whole flux.
    pub(super) fn emit(&self, position: [f32; 2], direction: [f32; 2]) -> Photon {
        let unit = if self.round { warp::disk(position) } else { Vec2::from(position) * 2.0 - 1.0 };
        let place = unit * self.half;
        Photon {
            origin: self.center + self.x_axis * place.x + self.y_axis * place.y,
            direction: self.spread.sample(self.normal, direction),
            flux: self.power,
            normal: Some(self.normal),
            lit_from: 0.0,
            point: None,
        }
    }

    /// Density per solid angle with which photons leave at an angle of this cosine to the axis.
    pub(super) fn density(&self, cos: f32) -> f32 {
        if cos <= 0.0 {
            return 0.0;
        }
        self.spread.attenuation((1.0 - cos * cos).max(0.0).sqrt() / cos) * cos * FRAC_1_PI
    }

    /// Of the shining side (square scene units).
    pub(super) fn area(&self) -> f32 {
        self.area
    }

    /// Foot of the perpendicular from `p` in the lamp's axes, and height above the shining side.
    fn local(&self, p: Vec3) -> (Vec2, f32) {
        let v = p - self.center;
        (Vec2::new(v.dot(self.x_axis), v.dot(self.y_axis)), v.dot(self.normal))
    }

    fn contains(&self, place: Vec2) -> bool {
        let unit = place / self.half;
        if self.round { unit.length_squared() <= 1.0 } else { unit.abs().max_element() <= 1.0 }
    }

    /// Radiance towards a point at `height` from the lamp's point `offset` away from its foot.
    fn radiance(&self, offset: Vec2, height: f32) -> Rgb {
        self.power * (FRAC_1_PI / self.area * self.spread.attenuation(offset.length() / height))
    }

    /// What to sample from a point: the lamp, less what the spread hides from there. `None` if it hides everything.
    fn region(&self, foot: Vec2, height: f32) -> Option<Region> {
        let reach = Vec2::splat(self.spread.reach() * height);
        let low = (-self.half - foot).max(-reach);
        let high = (self.half - foot).min(reach);
        let sides = high - low;
        if sides.min_element() <= 0.0 {
            return None;
        }
        let is_part = sides.x * sides.y < self.area;
        let nearest = low.max(-high).max(Vec2::ZERO);
        let distance_squared = nearest.length_squared() + height * height;
        let is_far = sides.length_squared() < FAR_SIZE_SQUARED * distance_squared;
        let spherical = if is_far {
            None
        } else {
            let x = [f64::from(low.x), f64::from(high.x)];
            let y = [f64::from(low.y), f64::from(high.y)];
            SphericalRectangle::new(x, y, f64::from(height))
        };
        Some(match spherical {
            Some(rectangle) if !self.round || is_part || rectangle.solid_angle > WIDE_SOLID_ANGLE => {
                Region::Spherical(rectangle)
            }
            _ if self.round && !is_part => Region::Ellipse,
            _ => Region::Flat(0.5 * (low + high), 0.5 * sides),
        })
    }

    /// Pdf per solid angle with which [`AreaLamp::sample`] finds a point of the region at `distance`.
    fn pdf(&self, region: &Region, distance: f32, height: f32) -> f32 {
        let area = match region {
            Region::Spherical(rectangle) => return (1.0 / rectangle.solid_angle) as f32,
            Region::Flat(_, half) => 4.0 * half.x * half.y,
            Region::Ellipse => PI * self.half.x * self.half.y,
        };
        distance * distance * (distance / height) / area
    }
}

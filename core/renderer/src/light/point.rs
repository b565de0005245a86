//! Point and spot lamps: intensity power / (4π), spread evenly over a sphere, or over a disk that turns towards whoever
//! looks at it (Blender's soft falloff, which stays finite close to the lamp). Both have radiance power / (4π² r²).

use std::f32::consts::{FRAC_1_PI, PI, TAU};

use glam::Vec3;

use super::cluster::Bounds;
use super::proxy::Hull;
use super::spot::SpotCone;
use super::{Crossing, LARGEST_LENGTH, LightSample, Photon, Ray, proxy, warp};
use crate::color::Rgb;
use crate::math::Frame;
use crate::scene::Lamp;

/// Radii below this (scene units, the scene filling a unit cube) are points.
const SMALLEST_RADIUS: f32 = 1e-6;

/// A point or spot lamp.
#[derive(Clone, Debug)]
pub(super) struct PointLamp {
    center: Vec3,
    /// 0 for a true point.
    radius: f32,
    /// A disk facing the receiver; else a sphere.
    soft: bool,
    /// Radiant intensity along the axis (W·sr⁻¹ × squared length scale).
    intensity: Rgb,
    cone: Option<SpotCone>,
}

impl PointLamp {
    /// `None` for a radius that is no length.
    pub(super) fn new(lamp: &Lamp, radius: f32, soft: bool, cone: Option<SpotCone>) -> Option<Self> {
        let intensity = lamp.power * (0.25 * FRAC_1_PI);
        let radius = if radius < SMALLEST_RADIUS { 0.0 } else { radius };
        (radius <= LARGEST_LENGTH).then_some(Self { center: lamp.position, radius, soft, intensity, cone })
    }

    /// False for a true point, which no ray can meet.
    pub(super) fn has_extent(&self) -> bool {
        self.radius > 0.0
    }

    /// Emitted flux.
    pub(super) fn flux(&self) -> Rgb {
        self.intensity * self.cone.map_or(4.0 * PI, |cone| cone.solid_angle())
    }

    /// Triangles that hold the lamp: a cube about the sphere every soft disk lies in.
    pub(super) fn hull(&self) -> Hull {
        proxy::cube(self.center, self.radius)
    }

    /// Where its light is and goes.
    pub(super) fn bounds(&self) -> Bounds {
        let ball = Bounds::ball(self.center, self.radius, self.intensity.mean());
        match &self.cone {
            Some(cone) => Bounds { axis: cone.axis(), spread: 0.0, reach: cone.half_angle(), ..ball },
            None => ball,
        }
    }

    /// About the irradiance at `p`, for choosing between lights; 0 only where there is none.
    pub(super) fn irradiance_estimate(&self, p: Vec3) -> f32 {
        let offset = p - self.center;
        if self.cone.is_some_and(|cone| !cone.may_reach(offset, self.radius)) {
            return 0.0;
        }
        self.intensity.mean() / offset.length_squared().max(self.radius * self.radius).max(1e-12)
    }

    /// A point of the lamp as seen from `p`.
    pub(super) fn sample(&self, p: Vec3, u: [f32; 2]) -> Option<LightSample> {
        let to = self.center - p;
        let sample = if self.radius == 0.0 {
            let distance = to.length();
            let wi = to.try_normalize()?;
            let radiance_over_pdf = self.intensity * self.attenuation(-wi) / (distance * distance);
            LightSample { wi, distance, radiance_over_pdf, pdf: 1.0, is_delta: true, point: None }
        } else if self.is_inside(to) {
            self.sample_inside(to, u)
        } else {
            self.sample_cone(to, u)
        };
        (!sample.radiance_over_pdf.is_black() && sample.radiance_over_pdf.is_finite()).then_some(sample)
    }

    /// From outside, sphere and disk are round: directions are spread evenly over the cone they fill.
    fn sample_cone(&self, to: Vec3, u: [f32; 2]) -> LightSample {
        let visible = self.visible_cone(to.length_squared());
        let (wi, height) = warp::cone(to.try_normalize().unwrap_or(Vec3::Z), visible, u);
        LightSample {
            wi,
            distance: self.distance(to.length(), height),
            radiance_over_pdf: self.radiance() * (self.attenuation(-wi) * TAU * visible),
            pdf: 1.0 / (TAU * visible),
            is_delta: false,
            point: None,
        }
    }

    /// Inside the sphere all directions see it; the cone of a spot does not count there (as in Cycles).
    fn sample_inside(&self, to: Vec3, u: [f32; 2]) -> LightSample {
        let wi = warp::sphere(u);
        LightSample {
            wi,
            distance: self.distance_inside(to, wi),
            radiance_over_pdf: self.radiance() * (4.0 * PI),
            pdf: 0.25 * FRAC_1_PI,
            is_delta: false,
            point: None,
        }
    }

    /// Where the ray meets the lamp.
    pub(super) fn crossing(&self, ray: &Ray) -> Option<Crossing> {
        let to = self.center - ray.from;
        let (distance, attenuation, pdf) = if self.is_inside(to) {
            (self.distance_inside(to, ray.wi), 1.0, 0.25 * FRAC_1_PI)
        } else {
            let visible = self.visible_cone(to.length_squared());
            let height = warp::one_minus_cos(to.try_normalize().unwrap_or(Vec3::Z), ray.wi);
            if height > visible {
                return None;
            }
            (self.distance(to.length(), height), self.attenuation(-ray.wi), 1.0 / (TAU * visible))
        };
        let radiance = self.radiance() * attenuation;
        (ray.span.contains(&distance) && !radiance.is_black()).then_some(Crossing { radiance, pdf, distance })
    }

    /// Distance from `p` to the lamp along a line that meets it but for rounding.
    pub(super) fn distance_along(&self, p: Vec3, wi: Vec3) -> f32 {
        let to = self.center - p;
        if self.is_inside(to) {
            return self.distance_inside(to, wi);
        }
        self.distance(to.length(), warp::one_minus_cos(to.try_normalize().unwrap_or(Vec3::Z), wi))
    }

    /// A photon; it carries the lamp's whole flux, or about it if a stretched cone has to be weighted.
    ///
    /// Far from the lamp, sphere and soft disk both fill every line that passes within r of the center, so photons are
    /// chosen uniformly over directions and over the disk across each. A sphere's photon starts on the sphere. A soft
    /// disk shows less of itself to near receivers: a point at distance d sees lines up to h = r d / √(r² + d²) from the
    /// center, so the line at h is dark until h² / √(r² − h²) past its closest approach.
    pub(super) fn emit(&self, position: [f32; 2], direction: [f32; 2]) -> Photon {
        let (direction, flux) = match &self.cone {
            None => (warp::sphere(direction), self.flux()),
            Some(cone) => {
                let (direction, solid_angle) = cone.sample(direction);
                (direction, self.intensity * solid_angle)
            }
        };
        Photon { flux, ..self.leaving(direction, position) }
    }

    /// A photon in a direction; it carries the lamp's whole flux.
    pub(super) fn leaving(&self, direction: Vec3, position: [f32; 2]) -> Photon {
        let across = warp::disk(position) * self.radius;
        let h_squared = across.length_squared();
        let half_chord = (self.radius * self.radius - h_squared).max(0.0).sqrt();
        let closest = self.center + Frame::new(direction).from_local(across.extend(0.0));
        let (origin, lit_from) = match (self.soft, half_chord > 0.0) {
            _ if self.radius == 0.0 => (closest, 0.0),
            (false, _) => (closest + direction * half_chord, 0.0),
            (true, true) => (closest, h_squared / half_chord),
            (true, false) => (closest, f32::INFINITY),
        };
        Photon { origin, direction, flux: self.flux(), normal: None, lit_from, point: None }
    }

    /// Density per solid angle with which photons leave in a direction.
    pub(super) fn density(&self, direction: Vec3) -> f32 {
        self.cone.map_or(0.25 * FRAC_1_PI, |cone| cone.attenuation(direction) / cone.solid_angle())
    }

    /// Center, and the radius about it (scene units) within which all its light leaves.
    pub(super) fn middle_and_radius(&self) -> (Vec3, f32) {
        (self.center, self.radius)
    }

    fn attenuation(&self, direction: Vec3) -> f32 {
        self.cone.map_or(1.0, |cone| cone.attenuation(direction))
    }

    /// Radiance of sphere or disk.
    fn radiance(&self) -> Rgb {
        self.intensity * (FRAC_1_PI / (self.radius * self.radius))
    }

    /// True inside a sphere; `to` leads to the center.
    fn is_inside(&self, to: Vec3) -> bool {
        !self.soft && to.length_squared() <= self.radius * self.radius
    }

    /// 1 − cos of half the angle under which the lamp is seen from outside: sin = r / d for a sphere, tan = r / d for a
    /// disk.
    fn visible_cone(&self, distance_squared: f32) -> f32 {
        let r_squared = self.radius * self.radius;
        let hypotenuse_squared = if self.soft { distance_squared + r_squared } else { distance_squared };
        let sin_squared = (r_squared / hypotenuse_squared).min(1.0);
        sin_squared / (1.0 + (1.0 - sin_squared).sqrt())
    }

    /// Distance to the lamp at 1 − cos = `height` from its center, which is `to_center` away.
    fn distance(&self, to_center: f32, height: f32) -> f32 {
        if self.soft {
            // No farther than the rim, where rounding of a cosine near 0 would show.
            return (to_center / (1.0 - height)).min(to_center.hypot(self.radius));
        }
        let sin_squared = height * (2.0 - height);
        let half_chord_squared = self.radius * self.radius - to_center * to_center * sin_squared;
        (to_center * (1.0 - height) - half_chord_squared.max(0.0).sqrt()).max(0.0)
    }

    /// Distance from inside the sphere to where `wi` leaves it.
    fn distance_inside(&self, to: Vec3, wi: Vec3) -> f32 {
        let along = to.dot(wi);
        let half_chord_squared = self.radius * self.radius - (to - wi * along).length_squared();
        (along + half_chord_squared.max(0.0).sqrt()).max(0.0)
    }
}

//! Point and spot lamps: intensity power / (4π), spread evenly over a sphere, or over a disk that turns towards whoever
//! looks at it (Blender's soft falloff, which stays finite close to the lamp). Both have radiance power / (4π² r²).

use std::f32::consts::{FRAC_1_PI, PI, TAU};

use glam::Vec3;

use super::proxy::Hull;
use super::spot::SpotCone;
use super::{Crossing, LightSample, Photon, Ray, proxy, warp};
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
    pub(super) fn new(lamp: &Lamp, radius: f32, soft: bool, cone: Option<SpotCone>) -> Self {
        let radius = if radius >= SMALLEST_RADIUS && radius.is_finite() { radius } else { 0.0 };
        Self { center: lamp.position, radius, soft, intensity: lamp.power * (0.25 * FRAC_1_PI), cone }
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
            LightSample { wi, distance, radiance_over_pdf, pdf: 1.0, is_delta: true }
        } else if self.soft {
            self.sample_disk(to, u)
        } else if to.length_squared() > self.radius * self.radius {
            self.sample_cone(to, u)
        } else {
            self.sample_inside(to, u)
        };
        (!sample.radiance_over_pdf.is_black() && sample.radiance_over_pdf.is_finite()).then_some(sample)
    }

    fn sample_disk(&self, to: Vec3, u: [f32; 2]) -> LightSample {
        let facing = to.try_normalize().unwrap_or(Vec3::Z);
        let along = to + Frame::new(facing).from_local((warp::disk(u) * self.radius).extend(0.0));
        let distance = along.length();
        let wi = along / distance;
        let cos = wi.dot(facing);
        let radiance_over_pdf = self.intensity * (self.attenuation(-wi) * cos / (distance * distance));
        LightSample { wi, distance, radiance_over_pdf, pdf: self.disk_pdf(distance, cos), is_delta: false }
    }

    fn sample_cone(&self, to: Vec3, u: [f32; 2]) -> LightSample {
        let distance_to_center = to.length();
        let visible = self.visible_cone(to.length_squared());
        let (wi, height) = warp::cone(to / distance_to_center, visible, u);
        let sin_squared = height * (2.0 - height);
        let half_chord = (self.radius * self.radius - distance_to_center * distance_to_center * sin_squared)
            .max(0.0)
            .sqrt();
        LightSample {
            wi,
            distance: distance_to_center * (1.0 - height) - half_chord,
            radiance_over_pdf: self.radiance() * (self.attenuation(-wi) * TAU * visible),
            pdf: 1.0 / (TAU * visible),
            is_delta: false,
        }
    }

    /// Inside the sphere all directions see it; the cone of a spot does not count there (as in Cycles).
    fn sample_inside(&self, to: Vec3, u: [f32; 2]) -> LightSample {
        let wi = warp::sphere(u);
        let along = to.dot(wi);
        let half_chord = (self.radius * self.radius - (to - wi * along).length_squared()).max(0.0).sqrt();
        LightSample {
            wi,
            distance: along + half_chord,
            radiance_over_pdf: self.radiance() * (4.0 * PI),
            pdf: 0.25 * FRAC_1_PI,
            is_delta: false,
        }
    }

    /// Where the ray meets the lamp.
    pub(super) fn crossing(&self, ray: &Ray) -> Option<Crossing> {
        let to = self.center - ray.from;
        let along = to.dot(ray.wi);
        let r_squared = self.radius * self.radius;
        let (distance, attenuation, pdf) = if self.soft {
            let facing = to.try_normalize().unwrap_or(Vec3::Z);
            let cos = ray.wi.dot(facing);
            let distance = to.length() / cos;
            let misses = cos <= 0.0 || (ray.wi * distance - to).length_squared() > r_squared;
            if misses {
                return None;
            }
            (distance, self.attenuation(-ray.wi), self.disk_pdf(distance, cos))
        } else {
            let half_chord_squared = r_squared - (to - ray.wi * along).length_squared();
            if half_chord_squared < 0.0 {
                return None;
            }
            let half_chord = half_chord_squared.sqrt();
            if to.length_squared() > r_squared {
                let pdf = 1.0 / (TAU * self.visible_cone(to.length_squared()));
                (along - half_chord, self.attenuation(-ray.wi), pdf)
            } else {
                (along + half_chord, 1.0, 0.25 * FRAC_1_PI)
            }
        };
        let radiance = self.radiance() * attenuation;
        (distance > 0.0 && distance <= ray.t_max && !radiance.is_black())
            .then_some(Crossing { radiance, pdf })
    }

    /// A photon; every one carries the lamp's whole flux.
    ///
    /// Far from the lamp, sphere and soft disk both fill every line that passes within r of the center, so photons are
    /// chosen uniformly over directions and over the disk across each. A sphere's photon starts on the sphere. A soft
    /// disk shows less of itself to near receivers: a point at distance d sees lines up to h = r d / √(r² + d²) from the
    /// center, so the line at h is dark until h² / √(r² − h²) past its closest approach.
    pub(super) fn emit(&self, position: [f32; 2], direction: [f32; 2]) -> Photon {
        let direction = self.cone.map_or_else(|| warp::sphere(direction), |cone| cone.sample(direction));
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
        Photon { origin, direction, flux: self.flux(), normal: None, lit_from }
    }

    fn attenuation(&self, direction: Vec3) -> f32 {
        self.cone.map_or(1.0, |cone| cone.attenuation(direction))
    }

    /// Radiance of sphere or disk.
    fn radiance(&self) -> Rgb {
        self.intensity * (FRAC_1_PI / (self.radius * self.radius))
    }

    /// 1 − cos of the half angle under which the sphere is seen from outside.
    fn visible_cone(&self, distance_squared: f32) -> f32 {
        let sin_squared = (self.radius * self.radius / distance_squared).min(1.0);
        sin_squared / (1.0 + (1.0 - sin_squared).sqrt())
    }

    fn disk_pdf(&self, distance: f32, cos: f32) -> f32 {
        distance * distance * FRAC_1_PI / (self.radius * self.radius * cos)
    }
}

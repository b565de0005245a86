//! Photons from infinitely far away: for one direction, they cross a disk that faces it and covers the scene.

use std::f32::consts::PI;

use glam::Vec3;

use super::{Photon, warp};
use crate::color::Rgb;
use crate::math::Frame;

/// A ball that holds every object.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct SceneBall {
    center: Vec3,
    /// 0 for a scene without objects.
    radius: f32,
}

impl SceneBall {
    /// Ball about an axis-aligned box.
    pub(super) fn new(bounds: [Vec3; 2]) -> Self {
        let [low, high] = bounds;
        if !(low.is_finite() && high.is_finite() && low.cmple(high).all()) {
            return Self { center: Vec3::ZERO, radius: 0.0 };
        }
        // A little more than half the diagonal, for rounding.
        Self { center: 0.5 * (low + high), radius: 0.5001 * (high - low).length() }
    }

    /// Area of the disk photons of one direction cross.
    pub(super) fn disk_area(&self) -> f32 {
        PI * self.radius * self.radius
    }

    /// How far the scene reaches from a point.
    pub(super) fn reach_from(&self, p: Vec3) -> f32 {
        (p - self.center).length() + self.radius
    }

    /// The numbers from which [`SceneBall::photon`] makes one along `direction` through `p`.
    pub(super) fn position_through(&self, p: Vec3, direction: Vec3) -> [f32; 2] {
        let across = Frame::new(direction).to_local(p - self.center).truncate();
        warp::from_disk(across / self.radius.max(f32::MIN_POSITIVE))
    }

    /// Where a line through `p` crosses the disk that photons of its direction start from.
    pub(super) fn entered(&self, p: Vec3, direction: Vec3) -> Vec3 {
        p - direction * ((p - self.center).dot(direction) + self.radius)
    }

    /// A photon that travels along `direction` through a place uniform over the disk.
    pub(super) fn photon(&self, direction: Vec3, flux: Rgb, u: [f32; 2]) -> Photon {
        let across = warp::disk(u) * self.radius;
        let origin = self.center + Frame::new(direction).from_local(across.extend(-self.radius));
        Photon { origin, direction, flux, normal: None, lit_from: 0.0, point: None }
    }
}

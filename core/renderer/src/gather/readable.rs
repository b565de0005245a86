//! Hits that need nothing but one look-up in the pyramid: the common end of a gather ray.

use glam::Vec3;

use crate::accel::{Hit, Ray};
use crate::color::Rgb;
use crate::pyramid::View;

use super::Gatherer;

/// A hit on a constant Lambert surface, far enough away to be read from the pyramid.
pub(super) struct Readable {
    t: f32,
    ng: Vec3,
    pub(super) albedo_over_pi: Rgb,
    pub(super) level: usize,
}

impl Readable {
    /// Where the ray that met it is to be looked up: position and normal class.
    #[inline(always)]
    pub(super) fn place(&self, ray: &Ray, pyramid: &View<'_>) -> (Vec3, usize) {
        let facing = if ray.direction.dot(self.ng) > 0.0 { -self.ng } else { self.ng };
        (ray.origin + ray.direction * self.t, pyramid.class(facing))
    }
}

impl Gatherer<'_> {
    /// What to read for a hit; `None` where there is more to it than a look-up. `solid_angle` is what the ray stands for.
    #[inline(always)]
    pub(super) fn readable(&self, hit: &Hit, solid_angle: f32) -> Option<Readable> {
        if self.lit.accel.is_lamp(hit.object) {
            return None;
        }
        let (ng, material) = self.lit.accel.triangle(hit.object, hit.primitive);
        let albedo_over_pi = self.plain[material]?;
        let level = self.pyramid.level_for(solid_angle * hit.t * hit.t);
        let near = hit.t < self.retrace_distance * self.pyramid.nominal_cell_size(level);
        (!near).then_some(Readable { t: hit.t, ng, albedo_over_pi, level })
    }
}

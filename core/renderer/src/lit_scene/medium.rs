//! What rays travel in: the inside of glass and water absorbs light (Beer and Lambert).

use glam::{DVec3, Vec3};

use super::{LitScene, Surface};
use crate::accel::{Hit, Ray};
use crate::color::Rgb;
use crate::effects_plan::{Effect, Meter};
use crate::scene::visibility;

/// Surfaces after which a search for what a point lies in ends.
const MAX_SURFACES: u32 = 256;

/// Where such a search goes: along no axis and no diagonal, so that it meets no edges of boxes.
const OUT: Vec3 = Vec3::new(0.154_303_35, 0.267_261_24, 0.951_189_7);

/// All solids that a ray is inside of, together: those that overlap add up.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Medium {
    /// Absorption coefficient (1 / scene unit). Sums of f32 values are exact in f64, so that nothing is left of a solid that
    /// was entered and left.
    coefficient: DVec3,
}

impl Medium {
    /// What absorbs nothing.
    pub const CLEAR: Self = Self { coefficient: DVec3::ZERO };

    /// True where nothing is absorbed.
    #[must_use]
    #[inline]
    pub fn is_clear(self) -> bool {
        self.coefficient == DVec3::ZERO
    }

    /// Share of light that is left after a distance (scene units), which may be infinite.
    #[must_use]
    #[inline]
    pub fn transmittance(self, distance: f32) -> Rgb {
        if self.is_clear() { Rgb::WHITE } else { self.absorbing(distance) }
    }

    #[expect(clippy::cast_possible_truncation, reason = "a share of light")]
    #[inline(never)]
    fn absorbing(self, distance: f32) -> Rgb {
        let left = |c: f64| if c > 0.0 { (-c * f64::from(distance)).exp() as f32 } else { 1.0 };
        Rgb(self.coefficient.to_array().map(left))
    }

    /// What is behind a surface that bounds `solid`. A solid that is left without having been entered, such as one with a
    /// hole, is none.
    fn across(self, solid: Self, enters: bool) -> Self {
        let coefficient = if enters {
            self.coefficient + solid.coefficient
        } else {
            (self.coefficient - solid.coefficient).max(DVec3::ZERO)
        };
        Self { coefficient }
    }
}

impl Surface<'_> {
    /// What a ray that leaves the surface travels in.
    #[must_use]
    pub fn medium_towards(&self, direction: Vec3) -> Medium {
        let [came_from, goes_to] = [self.bsdf.wo(), direction].map(|d| d.dot(self.ng) > 0.0);
        if came_from == goes_to { self.medium } else { self.medium.across(self.solid, came_from) }
    }
}

impl LitScene<'_> {
    /// What a hit's surface bounds.
    #[must_use]
    pub(super) fn solid(&self, hit: &Hit) -> Medium {
        if !self.plan.absorption {
            return Medium::CLEAR;
        }
        let material = &self.materials[self.accel.material(hit.object, hit.primitive)];
        let per_metre = DVec3::from(material.absorption().0.map(f64::from));
        Medium { coefficient: per_metre / self.accel.scene().space.scale }
    }

    /// What a ray goes on in that passes through the surface it met, whose outward normal is `ng`.
    #[must_use]
    pub fn medium_behind(&self, medium: Medium, ray: &Ray, hit: &Hit, ng: Vec3) -> Medium {
        medium.across(self.solid(hit), ray.direction.dot(ng) < 0.0)
    }

    /// What a point is in, at a time.
    #[must_use]
    #[inline]
    pub fn medium_at(&self, p: Vec3, time: f32, meter: &mut Meter) -> Medium {
        if self.plan.absorption { self.search_medium(p, time, meter) } else { Medium::CLEAR }
    }

    /// Solids that hold a point are left once more than they are entered on the way out of the scene.
    #[inline(never)]
    fn search_medium(&self, p: Vec3, time: f32, meter: &mut Meter) -> Medium {
        let owner = meter.enter(Effect::Absorption);
        let mut left = DVec3::ZERO;
        let mut ray = Ray { origin: p, direction: OUT, mask: !visibility::LAMP, time };
        for _ in 0..MAX_SURFACES {
            meter.count_own(1);
            let Some(hit) = self.accel.intersect(&ray) else { break };
            let ng = self.normal_met(&ray, &hit);
            let solid = self.solid(&hit).coefficient;
            left += if ray.direction.dot(ng) > 0.0 { solid } else { -solid };
            ray = Ray::leaving(ray.origin + ray.direction * hit.t, ng, ray.direction, ray.mask, time);
        }
        meter.back(owner);
        Medium { coefficient: left.max(DVec3::ZERO) }
    }
}

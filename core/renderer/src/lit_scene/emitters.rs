//! Light from the lamps and emissive meshes as the passes ask for it. Lights choose and weigh by what a material typically
//! emits; here what it really emits at the chosen point takes its place, as a ray that meets the point would see it.

use glam::Vec3;

use super::LitScene;
use crate::accel::{Hit, Ray};
use crate::color::Rgb;
use crate::light::{DirectSample, Emission, EmitterPoint, Receiver};
use crate::scene::visibility;

impl LitScene<'_> {
    /// See [`crate::light::Lights::emit`]; at a time while the shutter is open.
    #[inline]
    #[must_use]
    pub fn emit(&self, u: [f32; 5], time: f32) -> Option<Emission> {
        self.lights.emit(u).map(|emission| self.exact(emission, time))
    }

    /// See [`crate::light::Lights::emit_to_casters`]; at a time while the shutter is open.
    #[must_use]
    pub fn emit_to_casters(&self, u: [f32; 6], time: f32) -> Option<Emission> {
        self.lights.emit_to_casters(u).map(|emission| self.exact(emission, time))
    }

    #[inline]
    fn exact(&self, mut emission: Emission, time: f32) -> Emission {
        if let Some(point) = emission.point.filter(|point| self.moves(point.object)) {
            emission = self.moved_emission(emission, point, time);
        }
        if let Some(point) = self.exact_at(emission.point) {
            let radiance = self.radiance(&point, emission.origin, emission.direction, time);
            emission.flux = radiance * point.per_radiance;
        }
        emission
    }

    /// See [`crate::light::Lights::sample_direct`]; at a time while the shutter is open.
    #[inline]
    #[must_use]
    pub fn sample_direct(&self, receiver: Receiver, u: [f32; 3], time: f32) -> Option<DirectSample> {
        let mut sample = self.lights.sample_direct(receiver, u)?;
        if let Some(point) = sample.point.filter(|point| self.moves(point.object)) {
            sample = self.moved_sample(sample, point, receiver, time)?;
        }
        if let Some(point) = self.exact_at(sample.point) {
            let p = receiver.p + sample.wi * sample.distance;
            sample.radiance_over_pdf = self.radiance(&point, p, -sample.wi, time) * point.per_radiance;
        }
        Some(sample)
    }

    /// The point, if what it emits is not what the lights take it for.
    #[inline]
    fn exact_at(&self, point: Option<EmitterPoint>) -> Option<EmitterPoint> {
        point.filter(|point| {
            let material = self.accel.material(point.object, point.primitive);
            self.materials[material].emits_unevenly()
        })
    }

    /// Radiance (W·m⁻²·sr⁻¹) that leaves the point at `p` along the unit vector `direction`, to a surface: what shines on
    /// the camera alone gives none.
    #[inline(never)]
    fn radiance(&self, point: &EmitterPoint, p: Vec3, direction: Vec3, time: f32) -> Rgb {
        let EmitterPoint { object, primitive, barycentric, .. } = *point;
        let ray = Ray { origin: p + direction, direction: -direction, mask: visibility::DIFFUSE, time };
        let hit = Hit { t: 1.0, barycentric, object, primitive };
        self.surface(&ray, hit, 0.0).bsdf.emission
    }
}

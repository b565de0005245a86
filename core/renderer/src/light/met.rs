//! Lights that rays meet by chance: what is seen, and how likely the other way of finding it was.

use std::ops::Range;

use glam::Vec3;

use super::caustic::Sight;
use super::lamp_shader::Look;
use super::shape::Shape;
use super::{Lights, Ray, Receiver};
use crate::color::Rgb;

impl Lights {
    /// True where rays that are drawn from surfaces do not meet the light of an object.
    #[must_use]
    pub fn is_left_to_sampling(&self, object: u32) -> bool {
        let light = self.light_of_object.get(object as usize).copied().flatten();
        light.is_some_and(|light| self.lights[light].is_left_to_sampling())
    }

    /// Pdf per solid angle with which [`Lights::sample_direct`] from `from` finds the direction `wi`, whose ray meets
    /// triangle `primitive` of `object` at distance `t`. 0 where the triangle does not emit.
    #[must_use]
    pub fn emitter_pdf(
        &self,
        from: impl Into<Receiver>,
        object: u32,
        primitive: u32,
        wi: Vec3,
        t: f32,
    ) -> f32 {
        let Some(index) = self.light_of_object.get(object as usize).copied().flatten() else { return 0.0 };
        let Shape::Mesh(mesh) = &self.lights[index].shape else { return 0.0 };
        let Some(which) = mesh.which(primitive) else { return 0.0 };
        let emitter = self.first_emitter[index] + which;
        mesh.triangle(which).pdf(wi, t) * self.choice_probability(&from.into(), emitter)
    }

    /// Probability with which [`Lights::sample_direct`] from `from` chooses triangle `primitive` of `object`.
    #[must_use]
    pub fn emitter_choice(&self, from: Receiver, object: u32, primitive: u32) -> f32 {
        let Some(index) = self.light_of_object.get(object as usize).copied().flatten() else { return 0.0 };
        let Shape::Mesh(mesh) = &self.lights[index].shape else { return 0.0 };
        let which = mesh.which(primitive);
        which.map_or(0.0, |which| self.choice_probability(&from, self.first_emitter[index] + which))
    }

    /// Calls back, for each lamp the ray meets at a distance in `span`, with its radiance, the pdf per solid angle with which
    /// [`Lights::sample_direct`] from `from` finds this direction, and the distance. The pdf is infinite where rays that are
    /// drawn from surfaces do not meet the lamp. Lamps do not block. Those hidden from the ray's kind and those that do not light the
    /// receiver are skipped, as are suns and lamps that no ray meets.
    pub fn lamps_crossed(
        &self,
        from: impl Into<Receiver>,
        wi: Vec3,
        span: Range<f32>,
        sight: impl Into<Sight>,
        each: &mut dyn FnMut(Rgb, f32, f32),
    ) {
        let (receiver, sight) = (from.into(), sight.into());
        let ray = Ray { from: receiver.p, wi, span };
        for (index, light) in self.lights.iter().enumerate() {
            let is_seen = light.visibility & sight.kind != 0 && light.receivers & receiver.sets != 0;
            if !is_seen || !light.can_be_met() {
                continue;
            }
            let crossing = match &light.shape {
                Shape::Point(lamp) => lamp.crossing(&ray),
                Shape::Area(lamp) => lamp.crossing(&ray),
                Shape::Sun(_) | Shape::Mesh(_) => None,
            };
            if let Some(crossing) = crossing {
                let distance = crossing.distance;
                let look = Look { from: ray.from, wi, distance, before: sight.moved };
                let radiance = light.shown(crossing.radiance, &look);
                let pdf = self.pdf_against(&receiver, index, crossing.pdf);
                each(radiance * self.share(index, sight), pdf, distance);
            }
        }
    }

    /// Pdf with which direct sampling finds what a ray met of a lamp that is not of many parts.
    fn pdf_against(&self, receiver: &Receiver, light: usize, pdf: f32) -> f32 {
        if self.lights[light].is_left_to_sampling() {
            return f32::INFINITY;
        }
        pdf * self.choice_probability(receiver, self.first_emitter[light])
    }

    /// As [`Lights::lamps_crossed`], for the suns a ray that leaves the scene sees.
    pub fn suns(
        &self,
        from: impl Into<Receiver>,
        wi: Vec3,
        sight: impl Into<Sight>,
        each: &mut dyn FnMut(Rgb, f32),
    ) {
        let (receiver, sight) = (from.into(), sight.into());
        for &index in &self.suns {
            let light = &self.lights[index];
            let Shape::Sun(lamp) = &light.shape else { continue };
            if light.visibility & sight.kind == 0 || light.receivers & receiver.sets == 0 {
                continue;
            }
            if let Some(crossing) = lamp.crossing(wi) {
                let distance = crossing.distance;
                let look = Look { from: receiver.p, wi, distance, before: sight.moved };
                let radiance = light.shown(crossing.radiance, &look);
                each(radiance * self.share(index, sight), self.pdf_against(&receiver, index, crossing.pdf));
            }
        }
    }
}

//! Lights that are infinitely far away: the world as surfaces and rays see it, and how the photons of suns and the world are
//! aimed.

use glam::Vec3;

use super::aim::{Aim, Find};
use super::caustic::Sight;
use super::select::Cdf;
use super::shape::Shape;
use super::{DirectSample, Lights, Receiver};
use crate::color::Rgb;
use crate::scene::visibility;

impl Lights {
    /// What a ray that leaves the scene sees of the world, suns aside, and the pdf per solid angle with which
    /// [`Lights::sample_direct`] from `from` finds this direction: 0 where it never does.
    #[must_use]
    pub fn world_seen(&self, from: impl Into<Receiver>, wi: Vec3, sight: impl Into<Sight>) -> (Rgb, f32) {
        let sight = sight.into();
        let sampled = self.world.sampled().filter(|sampled| sampled.sampled() & sight.kind != 0);
        let pdf = sampled.map_or(0.0, |sampled| sampled.pdf(wi) * self.world_share(&from.into()));
        (self.world.seen(wi, sight.kind) * self.share(self.lights.len(), sight), pdf)
    }

    /// Probability with which the world is sampled and not another light: its share of the irradiance, about.
    pub(super) fn world_share(&self, receiver: &Receiver) -> f32 {
        const BOUNDS: [f32; 2] = [0.1, 0.9];
        let Some(environment) = self.world.sampled() else { return 0.0 };
        if self.emitters.is_empty() {
            return 1.0;
        }
        // Half of what comes from all sides is above the surface, and that at a mean cosine of a half.
        let of_world = 0.25 * environment.fluence().mean();
        let share = of_world
            / (of_world + self.tree.irradiance(receiver, |emitters| self.irradiances(receiver, emitters)));
        if share.is_finite() { share.clamp(BOUNDS[0], BOUNDS[1]) } else { 0.5 }
    }

    pub(super) fn sample_world(&self, probability: f32, u: [f32; 2]) -> Option<DirectSample> {
        let environment = self.world.sampled()?;
        let sample = environment.sample(u);
        Some(DirectSample {
            wi: sample.wi,
            distance: sample.distance,
            radiance_over_pdf: sample.radiance_over_pdf / probability,
            pdf_solid_angle: sample.pdf * probability,
            is_delta: false,
            blockers: visibility::SHADOW,
            visibility: environment.sampled(),
            point: None,
            is_mapped: self.is_mapped(self.lights.len()),
        })
    }

    /// Numbers of the lights that are infinitely far away and give light, the world among them.
    #[must_use]
    pub fn distant(&self) -> Vec<usize> {
        let is_distant = |&light: &usize| {
            self.photon_weights[light] > 0.0
                && self.lights.get(light).is_none_or(|light| matches!(light.shape, Shape::Sun(_)))
        };
        (0..self.photon_weights.len()).filter(is_distant).collect()
    }

    /// Flux of a light.
    #[must_use]
    pub fn flux_of(&self, light: usize) -> Rgb {
        self.lights.get(light).map_or_else(|| self.world.flux(&self.ball), |light| light.flux(&self.ball))
    }

    /// A photon from far away that travels through `p`, and the direction it comes from: `u[0]` chooses the light, evenly,
    /// `u[1..3]` the direction. Its weight is 1.
    #[must_use]
    pub fn photon_through(&self, p: Vec3, [choice, d0, d1]: [f32; 3]) -> Option<(Vec3, Find)> {
        let distant = self.distant();
        let light = *distant.get((choice * distant.len() as f32) as usize)?;
        let direction = self.emit_from(light, [0.5, 0.5, d0, d1]).direction;
        let [x, y] = self.ball.position_through(p, direction);
        Some((-direction, Find { light, numbers: [x, y, d0, d1], weight: 1.0 }))
    }

    /// Aims the photons of a light at what was found for it.
    pub fn aim(&mut self, light: usize, finds: &[Find]) {
        let of_light = finds.iter().filter(|find| find.light == light && find.weight > 0.0);
        let mut found: Vec<_> = of_light.map(|find| (find.numbers, find.weight)).collect();
        self.aims[light] = Some(Aim::new(&mut found));
    }

    /// Lets photons choose a light by this flux.
    pub fn weigh(&mut self, light: usize, flux: f64) {
        self.photon_weights[light] = flux;
        self.by_weight = Cdf::with_even_share(&self.photon_weights);
    }

    /// Memory (bytes) of how photons are aimed.
    #[must_use]
    pub fn aim_bytes(&self) -> usize {
        self.aims.iter().flatten().map(Aim::bytes).sum()
    }
}

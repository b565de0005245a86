//! The lights whose photons come from far away, suns and the world, and how they are aimed.

use glam::Vec3;

use super::Lights;
use super::aim::{Aim, Find};
use super::select::Cdf;
use super::shape::Shape;
use crate::color::Rgb;

impl Lights {
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

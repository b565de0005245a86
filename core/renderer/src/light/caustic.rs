//! Photons for caustics: which lights send them, and how they are aimed at mirrors and glass.
//!
//! A light that is small as mirrors and glass see it is rarely met by a ray that was drawn without knowing of it: its
//! caustics come from photons alone. A wide one is met often, and photons would blur what rays show sharp (decision 21).

use std::f32::consts::{PI, TAU};

use glam::Vec3;

use super::casters::Casters;
use super::select::{BELOW_ONE, Cdf};
use super::shape::{Light, Shape};
use super::{Emission, Lights, Receiver};
use crate::color::Rgb;
use crate::sampling::PhotonSampler;
use crate::scene::visibility;

/// Share of the photons that is aimed; the rest leaves as the light shines, for lights that shine only one way.
const AIMED: f32 = 0.75;

/// Photons of each light that are tried to see how much of it goes where they are aimed.
const TRIED: u64 = 64;

/// Lights whose caustics are made of photons, and what these are aimed at.
pub(super) struct CausticLights {
    casters: Casters,
    /// By light, and then of the world.
    is_mapped: Vec<bool>,
    /// How photons choose among them: by the flux towards the casters. `None` where there is none.
    choice: Option<Cdf>,
}

/// What a ray that meets lights is for.
#[derive(Clone, Copy, Debug)]
pub struct Sight {
    /// Kind of the ray, a bit of [`visibility`].
    pub kind: u32,
    /// What lights count whose caustics are made of photons: less than 1 where these have brought it already.
    pub mapped: Rgb,
    /// Distance from where the ray began to where it is traced from, which nodes of lamps may ask about.
    pub moved: f32,
}

impl From<u32> for Sight {
    fn from(kind: u32) -> Self {
        Self { kind, mapped: Rgb::WHITE, moved: 0.0 }
    }
}

impl Lights {
    /// Leaves the caustics of lights that `casters` see under less than `small` (sr) to photons, which are aimed there.
    pub fn map_caustics(&mut self, casters: Casters, small: f32) {
        let is_mapped: Vec<bool> =
            (0..self.photon_weights.len()).map(|light| self.solid_angle(light, &casters) < small).collect();
        let tried = |light: usize| {
            if !is_mapped[light] {
                return 0.0;
            }
            let flux = |id: u64| {
                let mut sampler = PhotonSampler::new(id, 0);
                let [choice, aim, numbers @ ..] = std::array::from_fn::<f32, 6, _>(|_| sampler.draw());
                self.towards(light, choice, aim, numbers, &casters).map_or(0.0, |e| f64::from(e.flux.mean()))
            };
            (0..TRIED).map(flux).filter(|flux| flux.is_finite()).sum()
        };
        let weights: Vec<f64> = (0..is_mapped.len()).map(tried).collect();
        self.caustic = Some(CausticLights { casters, choice: Cdf::with_even_share(&weights), is_mapped });
    }

    /// True where caustics of some lights are made of photons.
    #[must_use]
    pub fn has_mapped(&self) -> bool {
        self.caustic.as_ref().is_some_and(|caustic| caustic.choice.is_some())
    }

    /// True where the caustics of a light are made of photons.
    pub(super) fn is_mapped(&self, light: usize) -> bool {
        self.caustic.as_ref().is_some_and(|caustic| caustic.is_mapped[light])
    }

    /// What the light of an emissive mesh counts at a receiver.
    #[must_use]
    pub fn share_of_mesh(&self, from: Receiver, object: u32, sight: Sight) -> Rgb {
        match self.light_of_object.get(object as usize).copied().flatten() {
            Some(light) if self.lights[light].receivers & from.sets == 0 => Rgb::BLACK,
            Some(light) => self.share(light, sight),
            None => Rgb::WHITE,
        }
    }

    /// What a light counts.
    pub(super) fn share(&self, light: usize, sight: Sight) -> Rgb {
        if self.is_mapped(light) { sight.mapped } else { Rgb::WHITE }
    }

    /// A photon towards mirrors and glass, of a light whose caustics are made of photons: `u[0]` chooses the light, `u[1]` what
    /// it is aimed at, `u[2..4]` the place, `u[4..6]` the direction. `None` for one that would meet neither.
    #[must_use]
    pub fn emit_to_casters(&self, u: [f32; 6]) -> Option<Emission> {
        let caustic = self.caustic.as_ref()?;
        let [choice, aim, numbers @ ..] = u;
        let chosen = caustic.choice.as_ref()?.choose(choice);
        let emission = self.towards(chosen.index, chosen.rest, aim, numbers, &caustic.casters)?;
        Some(emission.over(chosen.probability))
    }

    /// A photon of one light, or `None` where it passes all casters. Places (of light from far away) or directions (of all
    /// other) are drawn in two ways, which are weighted by the balance heuristic.
    fn towards(
        &self,
        index: usize,
        choice: f32,
        aim: f32,
        numbers: [f32; 4],
        casters: &Casters,
    ) -> Option<Emission> {
        let plain = self.unaimed(index, choice, numbers);
        let [x, y, d0, d1] = numbers;
        let aimed = (aim < AIMED).then(|| (aim / AIMED).min(BELOW_ONE));
        let (emission, own, of_casters) = match self.lights.get(index).map(|light| &light.shape) {
            None | Some(Shape::Sun(_)) => {
                let direction = plain.direction;
                let through = aimed.map(|choice| casters.place_across(direction, choice, [x, y]));
                let origin = through.map_or(plain.origin, |p| self.ball.entered(p, direction));
                let of_casters = casters.density_across(origin, direction);
                (Emission { origin, ..plain }, 1.0 / self.ball.disk_area(), of_casters)
            }
            Some(Shape::Area(lamp)) if !lamp.has_extent() => return Some(plain),
            Some(shape) => {
                let (apex, extra) = match shape {
                    Shape::Point(lamp) => lamp.middle_and_radius(),
                    _ => (plain.origin, 0.0),
                };
                let view = casters.view(apex, extra);
                let emission = match aimed {
                    Some(choice) => self.turned(&plain, shape, view.direction(choice, [d0, d1]), [x, y]),
                    None => plain,
                };
                let direction = emission.direction;
                (emission, density(shape, &emission, direction), view.density(direction))
            }
        };
        let drawn = (1.0 - AIMED) * own + AIMED * of_casters;
        (of_casters > 0.0 && own > 0.0).then(|| emission.over(drawn / own))
    }

    /// The same photon in another direction, of the light's whole flux.
    fn turned(&self, plain: &Emission, shape: &Shape, direction: Vec3, position: [f32; 2]) -> Emission {
        match shape {
            Shape::Point(lamp) => {
                let photon = lamp.leaving(direction, position);
                let (origin, lit_from) = (photon.origin, photon.lit_from);
                Emission { origin, direction, flux: photon.flux, lit_from, ..*plain }
            }
            Shape::Mesh(_) => {
                let turned = |normal: Vec3| if normal.dot(direction) < 0.0 { -normal } else { normal };
                Emission { direction, normal: plain.normal.map(turned), ..*plain }
            }
            Shape::Area(_) | Shape::Sun(_) => Emission { direction, ..*plain },
        }
    }

    /// How large mirrors and glass see a light (sr), about.
    fn solid_angle(&self, index: usize, casters: &Casters) -> f32 {
        let Some(light) = self.lights.get(index) else {
            let sees = visibility::GLOSSY | visibility::TRANSMISSION;
            let environment = self.world.sampled().filter(|found| found.sampled() & sees == sees);
            return environment.map_or(4.0 * PI, super::Environment::solid_angle);
        };
        let area = match &light.shape {
            Shape::Sun(lamp) => return lamp.solid_angle(),
            Shape::Point(lamp) => PI * lamp.middle_and_radius().1.powi(2),
            Shape::Area(lamp) if lamp.has_extent() => lamp.area(),
            Shape::Area(_) => 0.0,
            Shape::Mesh(mesh) => mesh.mean_shadow(),
        };
        if area > 0.0 { area / casters.distance(middle(light)).powi(2) } else { 0.0 }
    }
}

/// Middle of the box that holds a light.
fn middle(light: &Light) -> Vec3 {
    let bounds = light.bounds().into_iter().reduce(super::cluster::Bounds::union);
    bounds.map_or(Vec3::ZERO, |bounds| bounds.middle())
}

/// Density per solid angle with which the light of a point goes in a direction.
fn density(shape: &Shape, emission: &Emission, direction: Vec3) -> f32 {
    let cos = emission.normal.map_or(1.0, |normal| normal.dot(direction));
    match shape {
        Shape::Point(lamp) => lamp.density(direction),
        Shape::Area(lamp) => lamp.density(cos),
        Shape::Mesh(_) => cos.max(0.0) / TAU,
        Shape::Sun(_) => 0.0,
    }
}

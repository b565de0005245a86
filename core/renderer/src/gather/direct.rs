//! Next-event estimation: light that comes straight from a lamp or an emissive mesh.

use std::f32::consts::FRAC_1_PI;

use crate::accel::{OFFSET, Ray};
use crate::bsdf::LobeSet;
use crate::color::Rgb;
use crate::effects_plan::{Effect, Meter};
use crate::light::DirectSample;
use crate::lit_scene::{LitScene, Medium, Surface, lobes_lit};
use crate::sampling::power_heuristic;
use crate::scene::visibility;

use super::deferred::Traces;
use super::lambert::LambertLanes;

/// Transparent surfaces a shadow ray passes before it counts as blocked.
const MAX_TRANSPARENT: u32 = 64;

/// How many directions two competing techniques draw: lights sampled, and directions of the BSDF.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shares {
    /// Directions towards lights.
    pub(super) light: f32,
    /// Directions of the BSDF.
    pub(super) bsdf: f32,
}

impl Shares {
    /// One of each.
    pub(super) const EVEN: Self = Self { light: 1.0, bsdf: 1.0 };

    /// Weight of light met by a BSDF sample of density `pdf`, which next-event estimation finds with `pdf_light`.
    #[must_use]
    pub(super) fn of_bsdf(self, pdf: f32, pdf_light: f32) -> f32 {
        power_heuristic(self.bsdf * pdf, self.light * pdf_light)
    }
}

/// A shadow ray and what arrives if nothing blocks it.
#[derive(Clone, Copy, Debug)]
pub(super) struct ShadowRay {
    /// From the surface to the light.
    pub(super) ray: Ray,
    /// Where the light is.
    pub(super) t_far: f32,
    /// Radiance towards the viewer if the light is seen, weighted against BSDF samples.
    pub(super) radiance: Rgb,
    /// What it starts in.
    medium: Medium,
}

impl ShadowRay {
    /// True where light arrives as it left, or not at all.
    pub(super) fn is_all_or_nothing(&self, lit: &LitScene<'_>) -> bool {
        self.can_be_blocked() && !lit.plan.transparency && self.medium.is_clear()
    }

    /// False where the light passes through everything.
    const fn can_be_blocked(&self) -> bool {
        self.ray.mask != 0
    }
}

/// The shadow ray for a light sample; `None` where the surface does not send this light to the viewer. Directions of the
/// BSDF are drawn from `lobes`; the light of those that are `counted`, all or some of them, is asked for.
#[must_use]
pub(super) fn shadow_ray(
    surface: &Surface<'_>,
    sample: &DirectSample,
    lobes: LobeSet,
    counted: LobeSet,
    shares: Shares,
) -> Option<ShadowRay> {
    let bsdf = &surface.bsdf;
    let lit = counted.and(lobes_lit(sample.visibility));
    let (f, pdf_lit) = bsdf.eval_with_pdf(sample.wi, lit);
    if f.is_black() {
        return None;
    }
    let weight = if sample.is_delta {
        1.0
    } else {
        let pdf_bsdf = if bsdf.has(lobes.without(lit)) { bsdf.pdf(sample.wi, lobes) } else { pdf_lit };
        power_heuristic(shares.light * sample.pdf_solid_angle, shares.bsdf * pdf_bsdf)
    };
    let cos = sample.wi.dot(bsdf.frame.ns).abs();
    let radiance = f * sample.radiance_over_pdf * (cos * weight);
    let ray = surface.leaving(sample.wi, sample.blockers);
    Some(ShadowRay { ray, t_far: reach(sample), radiance, medium: surface.medium_towards(sample.wi) })
}

/// As [`shadow_ray`], for a camera sample on a constant Lambert surface; the radiance is what the camera sees.
pub(super) fn lambert_shadow_ray(
    lanes: &LambertLanes,
    lane: usize,
    sample: &DirectSample,
    shares: Shares,
) -> Option<ShadowRay> {
    let cos = sample.wi.dot(lanes.ns[lane]);
    let above = cos > 0.0 && sample.wi.dot(lanes.ng[lane]) > 0.0;
    if !above || sample.visibility & visibility::DIFFUSE == 0 {
        return None;
    }
    let pdf = cos * FRAC_1_PI;
    let weight = if sample.is_delta {
        1.0
    } else {
        power_heuristic(shares.light * sample.pdf_solid_angle, shares.bsdf * pdf)
    };
    let radiance = lanes.weight[lane] * sample.radiance_over_pdf * (pdf * weight);
    let ray = Ray::leaving(lanes.p[lane], lanes.ng[lane], sample.wi, sample.blockers, lanes.time[lane]);
    Some(ShadowRay { ray, t_far: reach(sample), radiance, medium: Medium::CLEAR })
}

/// A shadow ray ends before the light's own surface, as far above it however flat it comes in: it starts beside the point
/// from which the light was sampled, and would else end in the surface.
fn reach(sample: &DirectSample) -> f32 {
    let cos = sample.point.map_or(1.0, |point| point.cos);
    (sample.distance * (1.0 - 1e-5) - 4.0 * OFFSET / cos).max(0.0)
}

/// Share of light that reaches the end of a shadow ray through transparent surfaces, and through what absorbs it.
#[must_use]
pub(super) fn transmittance<P>(lit: &LitScene<'_>, shadow: &ShadowRay, traces: &mut Traces<P>) -> Rgb {
    if !shadow.can_be_blocked() {
        return Rgb::WHITE;
    }
    traces.meter.count_own(1);
    if !lit.plan.transparency {
        let absorbed = shadow.medium.transmittance(shadow.t_far);
        traces.rays.shadow += 1;
        return if lit.accel.occluded(&shadow.ray, shadow.t_far) { Rgb::BLACK } else { absorbed };
    }
    let owner = traces.meter.owner();
    let through = transparencies(lit, shadow, &mut traces.rays.shadow, &mut traces.meter);
    traces.meter.back(owner);
    through
}

/// Product of the transparencies along a shadow ray, and of what is left between them.
fn transparencies(lit: &LitScene<'_>, shadow: &ShadowRay, rays: &mut u64, meter: &mut Meter) -> Rgb {
    let (mut ray, mut left, mut through) = (shadow.ray, shadow.t_far, Rgb::WHITE);
    let mut medium = shadow.medium;
    for _ in 0..MAX_TRANSPARENT {
        *rays += 1;
        let Some(hit) = lit.accel.intersect(&ray).filter(|hit| hit.t < left) else {
            return through * medium.transmittance(left);
        };
        let mut surface = lit.surface(&ray, hit, 0.0);
        surface.medium = medium;
        through *= medium.transmittance(hit.t) * surface.bsdf.transparency;
        if through.is_black() {
            return through;
        }
        meter.enter(Effect::AlphaTransparency);
        meter.count(Effect::AlphaTransparency, 1);
        left -= hit.t;
        medium = surface.medium_towards(ray.direction);
        ray = surface.leaving(ray.direction, ray.mask);
    }
    Rgb::BLACK
}

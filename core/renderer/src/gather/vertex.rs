//! Camera samples on surfaces that are more than a constant Lambert reflector, and the gather rays that leave them.

use glam::Vec3;

use crate::bsdf::{LobeSet, TransportMode};
use crate::color::Rgb;
use crate::lit_scene::{Surface, ray_kind};
use crate::math::Frame;
use crate::sampling::{UNIFORM_HEMISPHERE_PDF, uniform_hemisphere};
use crate::scene::visibility;
use crate::settings::GatherSampling;

/// Where a camera sample is shaded.
pub(super) struct Vertex<'a> {
    pub(super) surface: Surface<'a>,
    /// Share of its light that reaches the camera.
    pub(super) throughput: Rgb,
}

/// What a gather ray counts for.
#[derive(Clone, Copy)]
pub(super) struct GatherRay {
    /// f · cos / pdf, times the share of light that reaches the camera.
    pub(super) weight: Rgb,
    /// Density per solid angle; `None` for mirrors and glass.
    pub(super) pdf: Option<f32>,
    /// Kind of the ray, bits of [`visibility`].
    pub(super) kind: u32,
    /// From a lobe too sharp for what it meets to be read from the pyramid.
    pub(super) sharp: bool,
}

impl GatherRay {
    /// One that leaves a diffuse surface.
    #[inline]
    pub(super) const fn diffuse(weight: Rgb, pdf: Option<f32>) -> Self {
        Self { weight, pdf, kind: visibility::DIFFUSE, sharp: false }
    }
}

impl Vertex<'_> {
    /// A gather ray and its direction; `None` where the sampled direction gives nothing.
    pub(super) fn gather_ray(
        &self,
        u: [f32; 2],
        u_lobe: f32,
        sampling: GatherSampling,
    ) -> Option<(GatherRay, Vec3)> {
        let bsdf = &self.surface.bsdf;
        if sampling == GatherSampling::Uniform && !bsdf.has(LobeSet::FOLLOWED | LobeSet::TRANSLUCENT) {
            let direction = Frame::new(bsdf.frame.ns).from_local(uniform_hemisphere(u));
            let f = bsdf.eval(direction, LobeSet::ALL, TransportMode::Radiance);
            let weight = f * (direction.dot(bsdf.frame.ns).abs() / UNIFORM_HEMISPHERE_PDF);
            let ray = GatherRay::diffuse(self.throughput * weight, Some(UNIFORM_HEMISPHERE_PDF));
            return (!f.is_black()).then_some((ray, direction));
        }
        let sample = bsdf.sample(u_lobe, u, LobeSet::ALL, TransportMode::Radiance)?;
        let ray = GatherRay {
            weight: self.throughput * sample.weight,
            pdf: (!sample.is_delta).then_some(sample.pdf_solid_angle),
            kind: ray_kind(&sample),
            sharp: (LobeSet::SHARP | LobeSet::DELTA).intersects(sample.class),
        };
        Some((ray, sample.wi))
    }
}

/// A pixel's own additive recurrence with the golden ratio: evenly spread in one dimension.
pub(super) fn rotate(key: u64, index: u32) -> f32 {
    let golden = index.wrapping_mul(0x9E37_79B9);
    (((key as u32) ^ 0x5bd1_e995).wrapping_add(golden) >> 8) as f32 * (1.0 / 16_777_216.0)
}

//! One lobe: a shape of scattering with its weight, class and directional albedo.

use std::f32::consts::FRAC_1_PI;

use glam::Vec3;

use super::anisotropy::Anisotropic;
use super::oren_nayar::{Facets, LEAST_ROUGHNESS};
use super::sheen::Sheen;
use super::{LobeSet, ShadingFrame, fresnel, ggx};
use crate::color::Rgb;
use crate::math::Frame;
use crate::sampling::cosine_hemisphere;

/// GGX alpha from which on a reflection counts as [`LobeSet::ROUGH`] and is read from direction bins.
pub const ROUGH_ALPHA: f32 = 0.25;

/// GGX alpha up to which a lobe is [`LobeSet::DELTA`] (Blender's roughness 0.01). It spreads light by about 0.006°, a
/// tenth of a pixel of a 1080p picture; sharper lobes have peaks beyond 10⁸ that f32 directions cannot resolve.
pub const DELTA_ALPHA: f32 = 1e-4;

/// The class of a reflection of this alpha.
pub(super) fn reflection_class(alpha: f32) -> LobeSet {
    if alpha <= DELTA_ALPHA {
        LobeSet::DELTA
    } else if alpha < ROUGH_ALPHA {
        LobeSet::SHARP
    } else {
        LobeSet::ROUGH
    }
}

/// The class of a transmission of this alpha and index ratio. Matched indices bend nothing however rough the surface:
/// the spread of the refracted light is alpha times the index step.
pub(super) fn transmission_class(alpha: f32, eta: f32) -> LobeSet {
    let step = eta.max(1.0 / eta) - 1.0;
    if alpha * step.min(1.0) <= DELTA_ALPHA { LobeSet::DELTA } else { LobeSet::SHARP }
}

/// How light scatters.
#[derive(Clone, Copy, Debug)]
pub(super) enum Shape {
    /// Lambert reflection.
    Lambert,
    /// Diffuse reflection from rough facets.
    OrenNayar(Facets),
    /// Lambert transmission.
    Translucent,
    /// Reflection from fibers.
    Sheen(Sheen),
    /// GGX reflection.
    Reflection { alpha: f32 },
    /// GGX reflection whose alpha is not the same in all directions.
    Anisotropic(Anisotropic),
    /// GGX reflection mirrored to the far side: transmission that bends nothing.
    Mirrored { alpha: f32 },
    /// GGX refraction; `eta` is the index on the far side over that on the viewer's side.
    Transmission { alpha: f32, eta: f32 },
}

/// How much a microfacet reflects or, in a transmission, lets through.
#[derive(Clone, Copy, Debug)]
pub(super) enum Fresnel {
    /// All of it.
    Full,
    /// A dielectric whose value at normal incidence is `f0` instead of the one of `eta`.
    Dielectric { f0: Rgb, eta: f32 },
    /// See [`fresnel::metal`].
    Metal { f0: Rgb, dip: Rgb },
}

/// One lobe, for a fixed direction to the viewer.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lobe {
    /// Shape.
    pub(super) shape: Shape,
    /// Fresnel factor at the microfacets.
    pub(super) fresnel: Fresnel,
    /// Factor on everything: color, share, energy compensation, dimming by the layers above.
    pub(super) weight: Rgb,
    /// What stands for light of many bounces between microfacets. Of GGX lobes it is a part of `weight` that depends on the
    /// viewer, of [`Shape::OrenNayar`] what [`Facets::bounced`] says.
    pub(super) gain: Rgb,
    /// Share of light arriving uniformly from everywhere that is sent to the viewer.
    pub(super) albedo: Rgb,
    /// A single bit.
    pub(super) class: LobeSet,
    /// The same number for the same part of the same material, whatever the viewer.
    pub(super) slot: u8,
    /// Number of the normal it scatters about, one above its place in [`super::normals::Normals`]; 0 is that of the hit's
    /// frame.
    pub(super) normal: u8,
}

impl Lobe {
    /// Lambert reflection of `albedo`.
    pub(super) fn lambert(albedo: Rgb, slot: u8) -> Self {
        let (shape, fresnel) = (Shape::Lambert, Fresnel::Full);
        Self {
            shape,
            fresnel,
            weight: albedo,
            gain: Rgb::WHITE,
            albedo,
            class: LobeSet::DIFFUSE,
            slot,
            normal: 0,
        }
    }

    /// Diffuse reflection of `albedo` where nothing is lost between facets of `color`, towards a viewer at `cos` from the
    /// normal.
    pub(super) fn diffuse(albedo: Rgb, color: Rgb, roughness: f32, cos: f32, slot: u8) -> Self {
        let lambert = Self::lambert(albedo, slot);
        if roughness < LEAST_ROUGHNESS {
            return lambert;
        }
        let facets = Facets::new(roughness);
        let bounced = facets.bounced(color);
        let albedo = albedo * facets.albedo(bounced, cos);
        Self { shape: Shape::OrenNayar(facets), gain: bounced, albedo, ..lambert }
    }

    /// Lambert transmission of `albedo`.
    pub(super) fn translucent(albedo: Rgb, slot: u8) -> Self {
        Self { shape: Shape::Translucent, class: LobeSet::TRANSLUCENT, ..Self::lambert(albedo, slot) }
    }

    /// Sheen of `color` and Blender's roughness, towards a viewer at `cos` from the normal.
    pub(super) fn sheen(color: Rgb, roughness: f32, cos: f32, slot: u8) -> Self {
        let (sheen, albedo) = Sheen::new(roughness, cos);
        Self { shape: Shape::Sheen(sheen), ..Self::lambert(color * albedo, slot) }
    }

    /// What irradiance over π is multiplied with where only that is known. Facets return more of light at a slant: photons
    /// bring that along, see [`super::Bsdf::lambert_factor`], and what leaves is taken to do so evenly.
    pub(super) fn read_albedo(&self) -> Rgb {
        match self.shape {
            Shape::OrenNayar(facets) => self.weight * facets.mean_albedo(self.gain),
            _ => self.albedo,
        }
    }

    /// True for lobes on the side away from the viewer.
    pub(super) fn is_transmission(&self) -> bool {
        matches!(self.shape, Shape::Mirrored { .. } | Shape::Transmission { .. } | Shape::Translucent)
    }

    /// Index on the far side over that on the viewer's, where the light crosses; 1 where it stays.
    pub(super) fn eta(&self) -> f32 {
        if let Shape::Transmission { eta, .. } = self.shape { eta } else { 1.0 }
    }

    /// Fresnel factor times weight at a microfacet `cos` from the viewer.
    fn factor(&self, cos: f32) -> Rgb {
        let reflected = match self.fresnel {
            Fresnel::Full => return self.weight,
            Fresnel::Dielectric { f0, eta } => f0.lerp(Rgb::WHITE, fresnel::dielectric_rise(cos, eta)),
            Fresnel::Metal { f0, dip } => fresnel::metal(cos, f0, dip),
        };
        let share = if self.is_transmission() { Rgb::WHITE - reflected } else { reflected };
        share * self.weight
    }

    /// Value of the BSDF (no cosine) and density of [`Lobe::sample`] (per solid angle), towards `wi`; the caller has
    /// made sure that `wi` is on the right side of both normals and that the lobe is no delta.
    pub(super) fn eval(&self, frame: &ShadingFrame, wo: Vec3, wi: Vec3) -> (Rgb, f32) {
        // Floors keep grazing pairs finite; their cosine takes them out of any integral.
        let (cos_o, cos_i) = (wo.dot(frame.ns).max(1e-6), wi.dot(frame.ns).abs().max(1e-6));
        match self.shape {
            Shape::Lambert | Shape::Translucent => (self.weight * FRAC_1_PI, cos_i * FRAC_1_PI),
            Shape::OrenNayar(facets) => {
                let value = facets.value(self.gain, [cos_o, cos_i], wo.dot(wi));
                (self.weight * value, cos_i * FRAC_1_PI)
            }
            Shape::Sheen(sheen) => {
                let density = sheen.density(frame, wo, wi);
                (self.weight * (density / cos_i), density)
            }
            Shape::Reflection { alpha } | Shape::Mirrored { alpha } => {
                let wi = if self.is_transmission() { mirrored(wi, frame.ns) } else { wi };
                let h = (wo + wi).normalize_or(frame.ns);
                let cos_h = wo.dot(h).clamp(0.0, 1.0);
                let d = ggx::distribution(alpha, frame.ns.cross(h).length_squared().min(1.0));
                let (lambda_o, lambda_i) = (ggx::lambda(alpha, cos_o), ggx::lambda(alpha, cos_i));
                let value = d / (4.0 * cos_o * cos_i * (1.0 + lambda_o + lambda_i));
                (self.factor(cos_h) * value, d / (4.0 * cos_o * (1.0 + lambda_o)))
            }
            Shape::Anisotropic(facets) => {
                let (value, density) = facets.value(frame.ns, [wo, wi], [cos_o, cos_i]);
                let cos_h = wo.dot((wo + wi).normalize_or(frame.ns)).clamp(0.0, 1.0);
                (self.factor(cos_h) * value, density)
            }
            Shape::Transmission { alpha, eta } => {
                let sum = wo + wi * eta;
                let h = sum.normalize_or(frame.ns);
                let h = if h.dot(frame.ns) < 0.0 { -h } else { h };
                let (ho, hi) = (wo.dot(h), -wi.dot(h));
                if ho <= 0.0 || hi <= 0.0 {
                    return (Rgb::BLACK, 0.0);
                }
                let d = ggx::distribution(alpha, frame.ns.cross(h).length_squared().min(1.0));
                let (lambda_o, lambda_i) = (ggx::lambda(alpha, cos_o), ggx::lambda(alpha, cos_i));
                let jacobian = eta * eta * hi / sum.length_squared();
                let common = d * ho * jacobian / cos_o;
                let value = common / (cos_i * (1.0 + lambda_o + lambda_i));
                (self.factor(ho.min(1.0)) * value, common / (1.0 + lambda_o))
            }
        }
    }

    /// A direction of this lobe. For a delta lobe it is the only one.
    pub(super) fn sample(&self, frame: &ShadingFrame, wo: Vec3, u: [f32; 2]) -> Option<Vec3> {
        let reflected = |h: Vec3| Some((h * (2.0 * wo.dot(h)) - wo).normalize());
        let microfacet = |alpha: f32| {
            if self.class == LobeSet::DELTA {
                return frame.ns;
            }
            let basis = Frame::new(frame.ns);
            basis.from_local(ggx::sample_visible_normal([alpha; 2], basis.to_local(wo), u))
        };
        match self.shape {
            Shape::Lambert | Shape::OrenNayar(_) => {
                Some(Frame::new(frame.ns).from_local(cosine_hemisphere(u)))
            }
            Shape::Translucent => Some(-Frame::new(frame.ns).from_local(cosine_hemisphere(u))),
            Shape::Sheen(sheen) => Some(sheen.sample(frame, wo, u)),
            Shape::Reflection { alpha } => reflected(microfacet(alpha)),
            Shape::Anisotropic(facets) => reflected(facets.sample_visible_normal(frame.ns, wo, u)),
            Shape::Mirrored { alpha } => reflected(microfacet(alpha)).map(|wi| mirrored(wi, frame.ns)),
            Shape::Transmission { alpha, eta } => fresnel::refract(wo, microfacet(alpha), eta),
        }
    }

    /// Of a delta lobe: radiance towards the viewer over radiance arriving.
    pub(super) fn delta_factor(&self, frame: &ShadingFrame, wo: Vec3) -> Rgb {
        self.factor(wo.dot(frame.ns).clamp(0.0, 1.0))
    }
}

/// `direction` on the other side of the plane with the unit normal `ns`.
fn mirrored(direction: Vec3, ns: Vec3) -> Vec3 {
    direction - ns * (2.0 * direction.dot(ns))
}

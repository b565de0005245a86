//! Microfacets with wider slopes along one direction of the surface than across it, as those of brushed metal: GGX with
//! an alpha for each (Heitz 2014, see [`super::ggx`]).
//!
//! As in Cycles, tables of energy and of layers are asked for the geometric mean of both alphas. Slopes that differ return
//! less than that says: white loses up to 0.14 at alphas of 0.6 and 0.2, up to 0.4 at 1 and 0.1. It gains at most 0.04, at
//! grazing, and nothing on the mean over all directions.

use std::f32::consts::{PI, TAU};

use glam::Vec3;

use super::ggx;
use super::lobe::{DELTA_ALPHA, Lobe, Shape};
use crate::math::Frame;

/// Least alpha of a pair: half of it is a mirror's.
const LEAST_ALPHA: f32 = 2.0 * DELTA_ALPHA;

/// Steps of an azimuth around the circle: finer than the narrowest slopes.
const AZIMUTHS: f32 = 65536.0;

/// The alphas along the tangent and across it, `factors` times that of a roughness; `None` where they are the same.
pub(super) fn alphas(alpha: f32, factors: [f32; 2]) -> Option<[f32; 2]> {
    let [along, across] = factors.map(|factor| (alpha * factor).clamp(LEAST_ALPHA, 1.0));
    (alpha > 0.0 && along != across).then_some([along, across])
}

/// Factors of alpha along the tangent and across it, for Anisotropic of Principled (0 to 1; Burley 2012, "Physically-Based
/// Shading at Disney").
pub(super) fn principled_factors(anisotropic: f32) -> [f32; 2] {
    let aspect = (1.0 - 0.9 * anisotropic).sqrt();
    [1.0 / aspect, aspect]
}

/// The same for Anisotropy of Glossy: wider across for 0 to 1, wider along for -1 to 0; Cycles keeps it from either end.
pub(super) fn glossy_factors(anisotropy: f32) -> [f32; 2] {
    let narrow = 1.0 - anisotropy.abs().min(0.99);
    if narrow > 1.0 - 1e-4 {
        [1.0; 2]
    } else if anisotropy < 0.0 {
        [1.0 / narrow, narrow]
    } else {
        [narrow, 1.0 / narrow]
    }
}

/// Of a closure at a hit: its alphas and where they lie.
#[derive(Clone, Copy, Debug)]
pub(super) struct Anisotropy {
    /// GGX alpha along the tangent and across it.
    pub(super) alpha: [f32; 2],
    /// Turns of the tangent about the normal on the viewer's side.
    pub(super) rotation: f32,
    /// Any vector but one along the normal.
    pub(super) tangent: Vec3,
}

impl Anisotropy {
    /// Turns reflections about a normal into those of two alphas, where they are to be.
    pub(super) fn lay(self, lobes: &mut [Lobe], normal: Vec3, is_its: impl Fn(&Lobe) -> bool) {
        let Some(facets) = self.about(normal) else { return };
        for lobe in lobes.iter_mut().filter(|lobe| is_its(lobe)) {
            if let Shape::Reflection { .. } = lobe.shape {
                lobe.shape = Shape::Anisotropic(facets);
            }
        }
    }

    /// The microfacets about a normal; `None` where the tangent has no direction along the surface.
    fn about(self, normal: Vec3) -> Option<Anisotropic> {
        let along = self.tangent.try_normalize()?.reject_from_normalized(normal);
        let is_direction = along.length_squared() > 1e-10;
        let local = Frame::new(normal).to_local(along);
        let turns = local.y.atan2(local.x) / TAU + self.rotation;
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "wraps around the circle"
        )]
        let azimuth = (turns.rem_euclid(1.0) * AZIMUTHS) as u32 as u16;
        is_direction.then_some(Anisotropic { alpha: self.alpha, azimuth })
    }
}

/// The microfacets of a lobe.
#[derive(Clone, Copy, Debug)]
pub(super) struct Anisotropic {
    alpha: [f32; 2],
    /// Of the tangent in the frame of the lobe's normal ([`Frame::new`]): lobes are copied too often for a vector.
    azimuth: u16,
}

impl Anisotropic {
    /// The tangent, what is across it, and the normal.
    fn frame(self, normal: Vec3) -> Frame {
        let (sin, cos) = (f32::from(self.azimuth) * (TAU / AZIMUTHS)).sin_cos();
        let Frame { tangent, bitangent, .. } = Frame::new(normal);
        Frame { tangent: tangent * cos + bitangent * sin, bitangent: bitangent * cos - tangent * sin, normal }
    }

    /// D G / (4 cos_o cos_i) towards `wi`, and the density of directions mirrored by visible normals (per solid angle), about
    /// a normal that has cosines `cos` to `wo` and `wi`, floored.
    pub(super) fn value(self, normal: Vec3, [wo, wi]: [Vec3; 2], [cos_o, cos_i]: [f32; 2]) -> (f32, f32) {
        let frame = self.frame(normal);
        let h = (wo + wi).normalize_or(normal);
        let d = self.distribution(frame.to_local(h));
        let lambda_o = self.lambda(frame.to_local(wo), cos_o);
        let lambda_i = self.lambda(frame.to_local(wi), cos_i);
        (d / (4.0 * cos_o * cos_i * (1.0 + lambda_o + lambda_i)), d / (4.0 * cos_o * (1.0 + lambda_o)))
    }

    /// Density of microfacet normals per projected area, at the unit vector `h` of the local frame.
    fn distribution(self, h: Vec3) -> f32 {
        let [x, y] = self.alpha;
        let stretched = Vec3::new(h.x / x, h.y / y, h.z).length_squared();
        1.0 / (PI * x * y * stretched * stretched)
    }

    /// Smith's auxiliary function Λ of a direction of the local frame whose cosine is `cos`.
    fn lambda(self, direction: Vec3, cos: f32) -> f32 {
        let [x, y] = [direction.x * self.alpha[0], direction.y * self.alpha[1]];
        0.5 * ((1.0 + (x * x + y * y) / (cos * cos)).sqrt() - 1.0)
    }

    /// As [`ggx::sample_visible_normal`], about `normal` in scene space.
    pub(super) fn sample_visible_normal(self, normal: Vec3, wo: Vec3, u: [f32; 2]) -> Vec3 {
        let frame = self.frame(normal);
        frame.from_local(ggx::sample_visible_normal(self.alpha, frame.to_local(wo), u))
    }

    /// D G / (4 cos_o cos_i) of light from `wo` towards unit vectors by axis at cosines `cos_i`; see
    /// [`super::rough`]. `half` is |wo + wi|².
    #[inline(always)]
    pub(super) fn values<const N: usize>(
        self,
        normal: Vec3,
        wo: Vec3,
        wi: &[[f32; N]; 3],
        half: &[f32; N],
    ) -> [f32; N] {
        let frame = self.frame(normal);
        let o = frame.to_local(wo);
        let cos_o = o.z.max(1e-6);
        let lambda_o = self.lambda(o, cos_o);
        std::array::from_fn(|i| {
            let i_local = frame.to_local(Vec3::new(wi[0][i], wi[1][i], wi[2][i]));
            let cos_i = i_local.z.max(1e-6);
            let d = self.distribution((o + i_local) * half[i].sqrt().recip());
            d / (4.0 * cos_o * cos_i * (1.0 + lambda_o + self.lambda(i_local, cos_i)))
        })
    }
}

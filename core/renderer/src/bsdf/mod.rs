//! Surface scattering. The contract, for everything that traces rays:
//!
//! - `wo` is known and points to where the ray came from; `wi` is sampled. Both leave the surface, are unit vectors and
//!   live in scene space. A [`Bsdf`] is made for one `wo` and keeps it.
//! - `eval` gives the BSDF f (sr⁻¹) without the cosine; `sample` gives weight = f · |cos| / pdf.
//! - `ng` is the geometric normal, `ns` the shading normal; in a [`ShadingFrame`] both are on the side of `wo`. Cosines are
//!   with `ns`; nothing is reflected below `ng` or refracted above it. Where lobes have normals of their own (see `normals`),
//!   the frame's `ns` is `ng`, and values are for the cosine to that all the same.
//! - Lobes fall into classes, see [`LobeSet`]; every question can be put to some of them.
//! - Every simple material returns what it returns in Cycles (Blender 4.2 to 5.2; measured with 5.0.1) within 0.5 % on the
//!   mean over all angles, and within 1 % at each but grazing ones from inside rough glass (2 %). Not followed: Cycles estimates
//!   how much a layer dims what lies below, and makes light from nothing where the estimate is low (by up to 1.5 % at
//!   grazing; an opaque Principled BSDF of index 0.8 returns 1.1 on the mean there and 0.87 here); colors above 1 are clamped.
//! - Radiance is what Cycles calls radiance: inside a medium of index n it is divided by n². It does not change where light
//!   is refracted, and closed glass looks right from outside. In [`TransportMode::Importance`] (photons; `wo` is where the
//!   photon came from) values are the exact adjoint, f(wi, wo): a photon's flux is divided by η² on entering and multiplied
//!   on leaving, so that irradiance stored anywhere is what the radiance mode would gather. Shading normals get Veach's
//!   correction (1997, section 5.3.2) for the same reason.

mod anisotropy;
mod closure;
mod dielectric;
mod energy_table;
mod fresnel;
mod ggx;
mod lobe;
mod material;
mod normals;
mod oren_nayar;
mod photon;
mod principled;
mod reflection;
mod rough;
mod sanitize;
mod sheen;
mod sheen_table;
mod sheet;
mod table;
mod varying;

use std::ops::{BitOr, Deref};
use std::sync::Arc;

use glam::{Quat, Vec2, Vec3};
use smallvec::SmallVec;

use crate::color::Rgb;
use crate::math::Side;
use lobe::Lobe;
pub use lobe::{DELTA_ALPHA, ROUGH_ALPHA};
pub use material::PreparedMaterial;
pub use table::MaterialTable;
pub use varying::Varying;

/// Most lobes at one hit.
const MAX_LOBES: usize = 18;

/// Most surfaces have one lobe or two; a hit is copied around too often to carry room for all.
type LobeList = SmallVec<[Lobe; 2]>;

/// A set of lobe classes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LobeSet(u8);

impl LobeSet {
    /// No class.
    pub const EMPTY: Self = Self(0);
    /// Diffuse reflection, smooth or rough, and sheen: read from irradiance by its albedo, exact where it is followed.
    pub const DIFFUSE: Self = Self(1);
    /// GGX reflection with alpha of [`ROUGH_ALPHA`] and above: read from direction bins.
    pub const ROUGH: Self = Self(2);
    /// GGX reflection below [`ROUGH_ALPHA`], and rough transmission.
    pub const SHARP: Self = Self(4);
    /// Mirror reflection and smooth refraction.
    pub const DELTA: Self = Self(8);
    /// Lambert transmission: what arrives on one side leaves the other.
    pub const TRANSLUCENT: Self = Self(16);
    /// Diffuse reflection, Lambert transmission, and sheen.
    pub const LAMBERT: Self = Self(17);
    /// Every class with a finite density.
    pub const NON_DELTA: Self = Self(23);
    /// Classes whose light can be read where a gather ray ends.
    pub const READ: Self = Self(19);
    /// Classes that are followed and never read: mirrors, refraction and sharp glossy lobes.
    pub const FOLLOWED: Self = Self(12);
    /// Every class.
    pub const ALL: Self = Self(31);

    /// True when the sets have a class in common.
    #[must_use]
    pub const fn intersects(self, other: Self) -> bool {
        self.0 & other.0 != 0
    }

    /// The classes that are in both sets.
    #[must_use]
    pub const fn and(self, other: Self) -> Self {
        Self(self.0 & other.0)
    }

    /// The classes of this set that are not in `other`.
    #[must_use]
    pub const fn without(self, other: Self) -> Self {
        Self(self.0 & !other.0)
    }
}

impl BitOr for LobeSet {
    type Output = Self;
    fn bitor(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }
}

/// What travels along the path, from `wi` to `wo` or from `wo` to `wi`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TransportMode {
    /// Radiance arrives from `wi`: paths from the camera.
    Radiance,
    /// Flux arrives from `wo`: photons.
    Importance,
}

/// Normals at a hit, on the side of `wo`.
#[derive(Clone, Copy, Debug)]
pub struct ShadingFrame {
    /// Shading normal. Where lobes depend on the viewer it is bent, if needed, so that `wo` is above it.
    pub ns: Vec3,
    /// Geometric normal.
    pub ng: Vec3,
    /// True when `wo` is on the front side, so that light going through enters the object.
    pub entering: bool,
}

impl ShadingFrame {
    /// The side of the surface that `wo` is on.
    #[must_use]
    pub const fn side(&self) -> Side {
        Side { normal: self.ng, back: !self.entering }
    }

    /// Turns both normals to the side of `wo` that the geometric one says.
    #[must_use]
    pub fn new(wo: Vec3, ng: Vec3, ns: Vec3) -> Self {
        let entering = wo.dot(ng) >= 0.0;
        let sign = if entering { 1.0 } else { -1.0 };
        let (ng, ns) = (ng * sign, ns * sign);
        let cos_normals = ns.dot(ng);
        Self { ns: if cos_normals > 0.0 { ns } else { ng }, ng, entering }
    }

    /// The frame with a shading normal that `wo` is above.
    #[must_use]
    fn bent_below(self, wo: Vec3) -> Self {
        const GRAZING: f32 = 0.01;
        let (cos, least) = (wo.dot(self.ns), wo.dot(self.ng).min(GRAZING));
        if cos >= least {
            return self;
        }
        Self { ns: (self.ns + wo * (least - cos)).normalize(), ..self }
    }

    /// The frame with a shading normal that mirrors `wo` to above the surface: turned towards the geometric one until it does,
    /// as in Cycles. Without it, smooth mirrors and glass are black where they are seen at a slant.
    ///
    /// With `wo` at an angle φ from the geometric normal in the plane of both normals, where its length is ρ, a normal at an
    /// angle θ mirrors it to the height ρ cos(2θ - φ).
    #[must_use]
    fn mirroring_above(self, wo: Vec3) -> Self {
        const LEAST: f32 = 0.01;
        let (cos, cos_g) = (wo.dot(self.ns), wo.dot(self.ng));
        let least = LEAST.min(0.9 * cos_g);
        if 2.0 * cos * self.ns.dot(self.ng) - cos_g >= least {
            return self;
        }
        let across = self.ns.reject_from_normalized(self.ng).normalize_or_zero();
        let in_plane = Vec2::new(cos_g, wo.dot(across));
        let theta = 0.5 * (in_plane.to_angle() + (least / in_plane.length()).clamp(-1.0, 1.0).acos());
        let ns = (self.ng * theta.cos() + across * theta.sin()).normalize_or(self.ng);
        Self { ns, ..self }
    }

    /// Flux of a photon from `wo` times this is what to store for an irradiance that belongs to the shading normal, as
    /// radiance paths see it: wo·ns / wo·ng, and nothing from below the shading normal.
    #[must_use]
    pub fn irradiance_factor(&self, wo: Vec3) -> f32 {
        let (cos_s, cos_g) = (wo.dot(self.ns), wo.dot(self.ng));
        (cos_s * cos_g.signum()).max(0.0) / cos_g.abs().max(1e-3)
    }

    /// The normals as they were before turning them.
    fn unturned(&self) -> [Vec3; 2] {
        if self.entering { [self.ng, self.ns] } else { [-self.ng, -self.ns] }
    }
}

/// A sampled direction.
#[derive(Clone, Copy, Debug)]
pub struct BsdfSample {
    /// The direction.
    pub wi: Vec3,
    /// f · |cos| / pdf, over every lobe asked for that could have made `wi`.
    pub weight: Rgb,
    /// Density per solid angle; the chance of its lobe where that is a delta.
    pub pdf_solid_angle: f32,
    /// Class of the lobe that was chosen, a single bit.
    pub class: LobeSet,
    /// True when the direction comes from a delta lobe: `eval` and `pdf` know nothing of it.
    pub is_delta: bool,
    /// True when `wi` is on the other side of the surface.
    pub is_transmission: bool,
    /// Squared index on the side of `wi` over that on the side of `wo`; 1 for reflection. The product along a photon's path
    /// times its weight is free of the η² of refraction: decide on Russian roulette by that.
    pub eta_squared: f32,
}

/// A material of the scene, or one that holds at one hit alone.
#[derive(Clone, Debug)]
enum MaterialRef<'a> {
    Shared(&'a PreparedMaterial),
    Own(Arc<PreparedMaterial>),
}

impl Deref for MaterialRef<'_> {
    type Target = PreparedMaterial;

    #[inline]
    fn deref(&self) -> &PreparedMaterial {
        match self {
            Self::Shared(material) => material,
            Self::Own(material) => material,
        }
    }
}

/// The BSDF at one hit for one `wo`, made by [`PreparedMaterial::bsdf`].
#[derive(Clone, Debug)]
pub struct Bsdf<'a> {
    material: MaterialRef<'a>,
    wo: Vec3,
    lobes: LobeList,
    /// Radiance emitted towards `wo` (W·m⁻²·sr⁻¹).
    pub emission: Rgb,
    /// Share of light that passes straight through.
    pub transparency: Rgb,
    /// Normals.
    pub frame: ShadingFrame,
}

impl Bsdf<'_> {
    fn lobes(&self, set: LobeSet) -> impl Iterator<Item = &Lobe> {
        self.lobes.iter().filter(move |lobe| lobe.class.intersects(set))
    }

    /// Unit vector to where the ray came from.
    #[must_use]
    pub fn wo(&self) -> Vec3 {
        self.wo
    }

    /// The same, of a surface that was turned, with where the ray came from.
    #[must_use]
    pub fn turned(self, rotation: Quat) -> Self {
        let (wo, material) = (rotation * self.wo, self.material.turned(rotation));
        if material.is_anisotropic() {
            // Lobes keep tangents in frames that depend on where the normal points.
            let [ng, ns] = self.frame.unturned().map(|normal| rotation * normal);
            return material.bsdf(wo, ng, ns);
        }
        let frame = &self.frame;
        let frame = ShadingFrame { ns: rotation * frame.ns, ng: rotation * frame.ng, ..*frame };
        Self { material, wo, frame, ..self }
    }

    /// Shading normal of the side that light must come from to reach `wo`; `None` where it may come through.
    #[must_use]
    pub fn lit_side(&self) -> Option<Vec3> {
        (!self.lobes.iter().any(Lobe::is_transmission)).then_some(self.frame.ns)
    }

    /// True when a lobe of `set` is there.
    #[must_use]
    pub fn has(&self, set: LobeSet) -> bool {
        self.lobes(set).next().is_some()
    }

    /// Share of light arriving uniformly from everywhere that the lobes of `set` send to `wo`.
    #[must_use]
    pub fn albedo(&self, set: LobeSet) -> Rgb {
        self.lobes(set).map(|lobe| lobe.albedo).sum()
    }

    /// Share of a camera ray that is a hole in the picture.
    #[must_use]
    pub fn holdout(&self) -> f32 {
        self.material.holdout()
    }

    /// Color at normal incidence of the lobes of class [`LobeSet::ROUGH`], at least 0.02. Direction bins hold radiance
    /// divided by it.
    #[must_use]
    pub fn specular_tint(&self) -> Rgb {
        self.material.specular_tint()
    }

    /// What irradiance (W·m⁻²) on this side, divided by π, is multiplied with to get the radiance towards `wo` of the
    /// diffuse lobes.
    #[must_use]
    pub fn diffuse_albedo(&self) -> Rgb {
        self.lobes(LobeSet::DIFFUSE).map(Lobe::read_albedo).sum()
    }

    /// The BSDF (sr⁻¹) of the lobes of `set` for `wi`, without the cosine; delta lobes give nothing.
    #[must_use]
    pub fn eval(&self, wi: Vec3, set: LobeSet, mode: TransportMode) -> Rgb {
        match mode {
            TransportMode::Radiance => self.eval_with_pdf(wi, set).0,
            TransportMode::Importance => self.eval_adjoint(wi, set),
        }
    }

    /// Density per solid angle of `sample` restricted to `set`, at `wi`; delta lobes count as not being `wi`.
    #[must_use]
    pub fn pdf(&self, wi: Vec3, set: LobeSet) -> f32 {
        self.eval_with_pdf(wi, set).1
    }

    /// [`Bsdf::eval`] in radiance mode and [`Bsdf::pdf`], for little more than one of them.
    #[must_use]
    pub fn eval_with_pdf(&self, wi: Vec3, set: LobeSet) -> (Rgb, f32) {
        let (side_s, side_g) = (wi.dot(self.frame.ns), wi.dot(self.frame.ng));
        let (above, below) = (side_s > 0.0 && side_g > 0.0, side_s < 0.0 && side_g < 0.0);
        let (mut value, mut pdf, mut total) = (Rgb::BLACK, 0.0, 0.0);
        let is_seen = self.material.is_plain() || self.wo.dot(self.frame.ns) > 0.0;
        if !(above || below) || !is_seen {
            return (value, pdf);
        }
        for lobe in self.lobes(set) {
            let chance = lobe.albedo.mean();
            total += chance;
            if lobe.class != LobeSet::DELTA && lobe.is_transmission() == below {
                let (f, p) = match lobe.normal {
                    0 => lobe.eval(&self.frame, self.wo, wi),
                    _ => self.eval_own(lobe, wi),
                };
                value += f;
                pdf += p * chance;
            }
        }
        (value, if total > 0.0 { pdf / total } else { 0.0 })
    }

    /// A direction of the lobes of `set`: `u_lobe` in [0, 1) chooses the lobe by albedo, `u` in [0, 1)² the direction. `None`
    /// where there is no such lobe or the direction falls on the wrong side, which is part of the estimate: its value is 0.
    #[must_use]
    pub fn sample(&self, u_lobe: f32, u: [f32; 2], set: LobeSet, mode: TransportMode) -> Option<BsdfSample> {
        if mode == TransportMode::Importance {
            return self.sample_photon(u_lobe, u, set);
        }
        let total = self.chances(set);
        let (lobe, chance) = self.choose(u_lobe * total, set)?;
        let own = (lobe.normal != 0).then(|| self.own_frame(lobe));
        let frame = own.as_ref().unwrap_or(&self.frame);
        let wi = sample_on_side(lobe, frame, self.wo, u)?;
        if lobe.class == LobeSet::DELTA {
            let chance = chance / total;
            return sample_of(lobe, wi, lobe.delta_factor(frame, self.wo) / chance, chance);
        }
        let (value, pdf) = self.eval_with_pdf(wi, set);
        sample_of(lobe, wi, value * (wi.dot(self.frame.ns).abs() / pdf), pdf)
    }

    /// What the chances of the lobes of `set` are shares of.
    fn chances(&self, set: LobeSet) -> f32 {
        self.lobes(set).map(|lobe| lobe.albedo.mean()).sum()
    }

    /// The lobe of `set` whose interval of summed albedos holds `position`, and the interval's length.
    fn choose(&self, position: f32, set: LobeSet) -> Option<(&Lobe, f32)> {
        let mut last = None;
        let mut below = 0.0;
        for lobe in self.lobes(set) {
            let chance = lobe.albedo.mean();
            if chance > 0.0 {
                last = Some((lobe, chance));
                below += chance;
                if position < below {
                    break;
                }
            }
        }
        last
    }
}

/// A direction of `lobe` about the normal of `frame`, if it is on the side of both normals that the lobe sends light to.
fn sample_on_side(lobe: &Lobe, frame: &ShadingFrame, wo: Vec3, u: [f32; 2]) -> Option<Vec3> {
    let wi = lobe.sample(frame, wo, u)?;
    let is_transmission = lobe.is_transmission();
    let is_on_side = |normal: Vec3| (wi.dot(normal) < 0.0) == is_transmission;
    (is_on_side(frame.ns) && is_on_side(frame.ng)).then_some(wi)
}

/// The direction `wi` of `lobe`, if it is of use.
fn sample_of(lobe: &Lobe, wi: Vec3, weight: Rgb, pdf_solid_angle: f32) -> Option<BsdfSample> {
    let usable = weight.is_finite() && !weight.is_black() && pdf_solid_angle > 0.0;
    usable.then(|| BsdfSample {
        wi,
        weight,
        pdf_solid_angle,
        class: lobe.class,
        is_delta: lobe.class == LobeSet::DELTA,
        is_transmission: lobe.is_transmission(),
        eta_squared: lobe.eta() * lobe.eta(),
    })
}

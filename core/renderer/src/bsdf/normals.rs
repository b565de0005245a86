//! Materials whose closures have shading normals of their own: bumps and normal maps, a clean coat over a bumped base, a mix
//! of a bumped and a smooth shader.
//!
//! Every lobe of such a material scatters about a normal of its own. The frame of its [`Bsdf`] has the geometric normal for
//! shading normal too, and the BSDF is given for the cosine to that: a lobe's value is multiplied with the cosine to its own
//! normal over the one to the frame's. So whoever multiplies with the frame's cosine gets what the lobe sends, light from
//! above the surface and below the shading normal of some lobe is not lost, and nothing leaves below the surface.
//!
//! Where a normal leans away from the surface's own, diffuse lobes get darker towards the horizon instead of ending at a
//! sharp edge, by the shadowing that a microfacet surface of as steep slopes would have (Estevez, Lecocq, Stein 2019, *A
//! Microfacet-Based Shadowing Function to Solve the Bump Terminator Problem*), as in Cycles from Blender 5.0 on.

use glam::{Quat, Vec3};
use smallvec::{SmallVec, smallvec};

use super::closure::PreparedClosure;
use super::lobe::{Lobe, Shape};
use super::{Bsdf, LobeSet, ShadingFrame, ggx};
use crate::color::Rgb;
use crate::scene::MaterialProgram;
use crate::scene::record::{ClosureRecord, Input, NormalRecord, WeightedClosure};
use crate::shader::Register;

/// Something of each layer of a Principled BSDF that may have a normal of its own. Other closures are all base.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Layers<T> {
    pub(super) base: T,
    pub(super) coat: T,
    pub(super) sheen: T,
}

impl<T: Copy> Layers<T> {
    /// The same for all.
    #[inline]
    pub(super) const fn all(value: T) -> Self {
        Self { base: value, coat: value, sheen: value }
    }
}

/// Which result of a program is the normal of which closure.
#[derive(Clone, Debug)]
pub(super) struct Assignment {
    /// All that are used, once each, the surface's own first; `None` is the mesh's.
    pub(super) registers: SmallVec<[Option<Register>; 2]>,
    /// By closure, see [`Lobe::normal`]; empty where all have the surface's.
    closures: SmallVec<[Layers<u8>; 2]>,
}

impl Assignment {
    pub(super) fn new(closures: &[WeightedClosure], program: &MaterialProgram) -> Self {
        let mut registers: SmallVec<[Option<Register>; 2]> = smallvec![program.normal];
        let mut number = |closure: usize, coat: bool| {
            let is_its = |record: &&NormalRecord| record.closure == closure && record.coat == coat;
            let register =
                program.normals.iter().find(is_its).map(|record| record.register).or(program.normal);
            let found = registers.iter().position(|known| *known == register);
            let place = found.unwrap_or_else(|| {
                registers.push(register);
                registers.len() - 1
            });
            // Beyond what can be counted, which no mix that is kept needs, the first serves.
            u8::try_from(place + 1).unwrap_or(1)
        };
        let mut layers = SmallVec::new();
        for (index, part) in closures.iter().enumerate() {
            layers.push(if !scatters(&part.closure) {
                Layers::default()
            } else if has_coat(&part.closure, index, program) {
                let (base, coat) = (number(index, false), number(index, true));
                Layers { base, coat, sheen: base }
            } else {
                Layers::all(number(index, false))
            });
        }
        if registers.len() == 1 {
            layers.clear();
        }
        Self { registers, closures: layers }
    }

    /// The normals at a hit, where the `registers` hold `vectors`.
    pub(super) fn at(&self, vectors: &[Vec3]) -> Normals {
        if self.closures.is_empty() {
            return Normals::default();
        }
        Normals { vectors: vectors.into(), closures: self.closures.clone() }
    }
}

fn scatters(closure: &ClosureRecord) -> bool {
    use ClosureRecord::{Emission, Holdout, Transparent};
    !matches!(closure, Transparent { .. } | Emission { .. } | Holdout)
}

/// True for closures that have a coat somewhere.
fn has_coat(closure: &ClosureRecord, index: usize, program: &MaterialProgram) -> bool {
    let varies = || program.outputs.iter().any(|o| o.closure == index && o.input == Input::CoatWeight);
    matches!(closure, ClosureRecord::Principled(record) if record.coat_weight > 0.0 || varies())
}

/// The normals of a material at one hit; none where all closures share the one of the frame.
#[derive(Clone, Debug, Default)]
pub(super) struct Normals {
    /// Unit vectors, on the mesh's own side; the first is the surface's own.
    vectors: SmallVec<[Vec3; 4]>,
    /// By closure, see [`Lobe::normal`].
    closures: SmallVec<[Layers<u8>; 2]>,
}

impl Normals {
    /// True where all closures share the normal of the frame.
    #[inline]
    pub(super) fn is_shared(&self) -> bool {
        self.closures.is_empty()
    }

    /// Those of the closure that is number `index`. Sheen lies on what is most of what is below: its normal is turned from the
    /// base's to the coat's by the coat's weight, as in Cycles.
    pub(super) fn of_closure(&mut self, index: usize, closure: &PreparedClosure) -> Layers<u8> {
        let Some(&layers) = self.closures.get(index) else { return Layers::default() };
        let PreparedClosure::Principled(principled) = closure else { return layers };
        match principled.sheen_on_coat() {
            Some(share) if layers.coat != layers.base => {
                let [base, coat] = [layers.base, layers.coat].map(|normal| self.vector(normal));
                self.vectors.push(base.lerp(coat, share).normalize_or(base));
                Layers { sheen: u8::try_from(self.vectors.len()).unwrap_or(layers.base), ..layers }
            }
            _ => layers,
        }
    }

    /// Those of a surface that was turned.
    pub(super) fn turned(&self, rotation: Quat) -> Self {
        let vectors = self.vectors.iter().map(|&vector| rotation * vector).collect();
        Self { vectors, closures: self.closures.clone() }
    }

    fn vector(&self, normal: u8) -> Vec3 {
        self.vectors[usize::from(normal) - 1]
    }

    /// The frame about a normal.
    fn frame(&self, normal: u8, wo: Vec3, frame: &ShadingFrame) -> ShadingFrame {
        ShadingFrame::new(wo, frame.unturned()[0], self.vector(normal))
    }

    /// What reflections of a normal are about, see [`Bsdf::own_frame`].
    pub(super) fn reflecting(&self, normal: u8, wo: Vec3, frame: &ShadingFrame) -> Vec3 {
        if normal == 0 { frame.ns } else { self.frame(normal, wo, frame).mirroring_above(wo).ns }
    }

    /// Cosines of the viewer to the normals of a closure.
    pub(super) fn cosines(&self, layers: Layers<u8>, wo: Vec3, frame: &ShadingFrame) -> Layers<f32> {
        let cos = |frame: ShadingFrame| wo.dot(frame.ns).clamp(0.0, 1.0);
        let [base, coat, sheen] =
            [layers.base, layers.coat, layers.sheen].map(|normal| self.frame(normal, wo, frame));
        Layers {
            base: cos(base.mirroring_above(wo)),
            coat: cos(coat.mirroring_above(wo)),
            sheen: cos(sheen.bent_below(wo)),
        }
    }

    /// Share of light from `wi` that arrives at a diffuse lobe about the normal `ns`, see the module.
    fn unshadowed(&self, ns: Vec3, wi: Vec3) -> f32 {
        let (leaning, cos) = (self.vectors[0].dot(ns), self.vectors[0].dot(wi));
        if leaning * cos * wi.dot(ns) <= 0.0 {
            return 0.0;
        }
        let slope2 = (1.0 - leaning * leaning).max(0.0) / (leaning * leaning);
        let alpha = (0.125 * slope2).min(1.0).sqrt();
        1.0 / (1.0 + ggx::lambda(alpha, cos))
    }
}

impl Bsdf<'_> {
    /// The frame of a lobe that has a normal of its own. What is as bright from everywhere needs no viewer above it; mirrors
    /// are bent for themselves alone.
    pub(super) fn own_frame(&self, lobe: &Lobe) -> ShadingFrame {
        let normals = self.material.normals();
        let own = || normals.frame(lobe.normal, self.wo, &self.frame);
        match lobe.shape {
            Shape::Lambert | Shape::OrenNayar(_) | Shape::Translucent => {
                let outward = normals.vector(lobe.normal);
                let ns = if self.frame.entering { outward } else { -outward };
                ShadingFrame { ns, ..self.frame }
            }
            Shape::Sheen(_) => own().bent_below(self.wo),
            Shape::Reflection { .. }
            | Shape::Anisotropic(_)
            | Shape::Mirrored { .. }
            | Shape::Transmission { .. } => own().mirroring_above(self.wo),
        }
    }

    /// As [`Lobe::eval`], of a lobe that has a normal of its own, for the cosine to the frame's.
    #[inline(never)]
    pub(super) fn eval_own(&self, lobe: &Lobe, wi: Vec3) -> (Rgb, f32) {
        let frame = self.own_frame(lobe);
        let cos = wi.dot(frame.ns);
        if cos == 0.0 || (cos < 0.0) != lobe.is_transmission() {
            return (Rgb::BLACK, 0.0);
        }
        let (value, pdf) = lobe.eval(&frame, self.wo, wi);
        let arriving = match lobe.shape {
            Shape::Reflection { .. }
            | Shape::Anisotropic(_)
            | Shape::Mirrored { .. }
            | Shape::Transmission { .. } => 1.0,
            _ => self.material.normals().unshadowed(frame.ns, wi),
        };
        (value * (arriving * cos.abs() / wi.dot(self.frame.ns).abs().max(1e-6)), pdf)
    }

    /// Flux over the area of the surface times this is the irradiance that lobes of [`LobeSet::LAMBERT`] see which have other
    /// normals than the frame's, or return more of light at a slant: their mean by albedo.
    #[must_use]
    #[inline]
    pub fn lambert_factor(&self) -> Rgb {
        let is_rough = |lobe: &Lobe| matches!(lobe.shape, Shape::OrenNayar(_));
        let is_even = self.material.normals().is_shared() && !self.lobes.iter().any(is_rough);
        if is_even { Rgb::WHITE } else { self.own_lambert_factor() }
    }

    /// Irradiance on a diffuse lobe that has a normal of its own, of a photon's flux over the area of the surface.
    fn arriving(&self, lobe: &Lobe) -> f32 {
        let frame = self.own_frame(lobe);
        self.material.normals().unshadowed(frame.ns, self.wo) * frame.irradiance_factor(self.wo)
    }

    #[inline(never)]
    fn own_lambert_factor(&self) -> Rgb {
        let (mut seen, mut total) = (Rgb::BLACK, Rgb::BLACK);
        for lobe in self.lobes(LobeSet::LAMBERT) {
            let arriving = if lobe.normal == 0 { 1.0 } else { self.arriving(lobe) };
            seen += lobe.albedo * arriving;
            total += lobe.read_albedo();
        }
        Rgb([0, 1, 2].map(|c| if total.0[c] > 0.0 { seen.0[c] / total.0[c] } else { 1.0 }))
    }
}

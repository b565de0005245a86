//! Closures made ready for the render: each makes its lobes.

use super::anisotropy::Anisotropy;
use super::dielectric::{self, Glass};
use super::lobe::{Lobe, transmission_class};
use super::normals::Layers;
use super::oren_nayar::LEAST_ROUGHNESS;
use super::principled::{self, Principled};
use super::reflection::{self, Roughness};
use super::{LobeList, LobeSet};
use crate::color::Rgb;
use crate::scene::record::ClosureRecord;

/// A closure of a material.
#[derive(Clone, Debug)]
pub(super) struct Part {
    /// Its share in the surface.
    pub(super) weight: Rgb,
    /// What is shared.
    pub(super) closure: PreparedClosure,
    /// The normals it scatters about, see [`super::lobe::Lobe::normal`].
    pub(super) normals: Layers<u8>,
    /// What of its reflections differs along the surface, where its tangent is known.
    pub(super) anisotropy: Option<Anisotropy>,
}

/// What a closure does besides scattering.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Unscattered {
    /// Radiance emitted towards the viewer (W·m⁻²·sr⁻¹).
    pub(super) emission: Rgb,
    /// Share of light that passes straight through.
    pub(super) straight: Rgb,
}

/// A closure that makes lobes; transparency, constant emission and Lambert about the frame's normal are merged in the material.
#[derive(Clone, Debug)]
pub(super) enum PreparedClosure {
    Diffuse {
        color: Rgb,
        roughness: f32,
    },
    Glossy {
        color: Rgb,
        rough: Roughness,
        /// Of the tangent (turns).
        rotation: f32,
    },
    Glass(Glass),
    Refraction {
        rough: Roughness,
        ior: f32,
    },
    /// Its color is in the weight.
    Translucent,
    /// Its color is in the weight.
    Sheen {
        roughness: f32,
    },
    Principled(Box<Principled>),
}

impl PreparedClosure {
    /// Adds the lobes towards a viewer at `cos` from the normals; returns what else comes from there.
    pub(super) fn push(
        &self,
        lobes: &mut LobeList,
        weight: Rgb,
        entering: bool,
        cos: Layers<f32>,
        slot: u8,
    ) -> Unscattered {
        match self {
            Self::Diffuse { color, roughness } => {
                lobes.push(Lobe::diffuse(weight * *color, *color, *roughness, cos.base, slot));
            }
            Self::Glossy { color, rough, .. } => {
                lobes.push(reflection::constant(weight * *color, *color, *rough, cos.base, slot));
            }
            Self::Glass(glass) => glass.push(lobes, weight, entering, cos.base, slot),
            Self::Refraction { rough, ior } => {
                let eta = if entering { *ior } else { 1.0 / ior };
                dielectric::push_refraction(lobes, weight, *rough, eta, cos.base, slot);
            }
            Self::Translucent => lobes.push(Lobe::translucent(weight, slot)),
            Self::Sheen { roughness } => lobes.push(Lobe::sheen(weight, *roughness, cos.sheen, slot)),
            Self::Principled(principled) => {
                return principled.push(lobes, weight, entering, cos, slot);
            }
        }
        Unscattered::default()
    }

    /// True when what is emitted below a coat depends on the direction.
    pub(super) fn dims_its_emission(&self) -> bool {
        matches!(self, Self::Principled(principled) if principled.dims_its_emission())
    }

    /// The alphas of its reflections along a tangent and across it, where they differ, and the turns of the tangent.
    pub(super) fn anisotropy(&self) -> Option<([f32; 2], f32)> {
        match self {
            Self::Glossy { rough, rotation, .. } => rough.pair.map(|alpha| (alpha, *rotation)),
            Self::Principled(principled) => principled.anisotropy(),
            _ => None,
        }
    }

    /// True for the slots of lobes that are anisotropic where the closure is.
    pub(super) fn is_anisotropic(&self, slot: u8) -> bool {
        !matches!(self, Self::Principled(_)) || principled::is_anisotropic(slot)
    }

    pub(super) fn classes(&self) -> LobeSet {
        match self {
            Self::Glossy { rough, .. } => rough.reflection_class(),
            Self::Glass(glass) => glass.classes(),
            Self::Refraction { rough, ior } => transmission_class(rough.alpha, *ior),
            Self::Translucent => LobeSet::TRANSLUCENT,
            Self::Diffuse { .. } | Self::Sheen { .. } => LobeSet::DIFFUSE,
            Self::Principled(principled) => principled.classes(),
        }
    }

    /// True when light is refracted, or spread by what it passes.
    pub(super) fn transmits(&self) -> bool {
        match self {
            Self::Diffuse { .. } | Self::Glossy { .. } | Self::Translucent | Self::Sheen { .. } => false,
            Self::Glass(_) | Self::Refraction { .. } => true,
            Self::Principled(principled) => principled.transmits(),
        }
    }

    pub(super) fn rough_tint(&self) -> Rgb {
        match self {
            Self::Glossy { color, rough, .. } if rough.reflection_class() == LobeSet::ROUGH => *color,
            Self::Glass(glass) if glass.rough.reflection_class() == LobeSet::ROUGH => {
                glass.f0 * glass.reflection_tint
            }
            Self::Principled(principled) => principled.rough_tint(),
            _ => Rgb::BLACK,
        }
    }

    pub(super) fn etas(&self) -> impl Iterator<Item = f32> {
        let own = match self {
            Self::Glass(glass) => Some(glass.ior),
            Self::Refraction { ior, .. } => Some(*ior),
            _ => None,
        };
        let principled = if let Self::Principled(p) = self { Some(p.etas()) } else { None };
        own.into_iter().chain(principled.into_iter().flatten())
    }
}

/// Most lobes `closure` can make. Lambert's is none where it `is_merged` in the material.
pub(super) fn most_lobes(closure: &ClosureRecord, is_merged: bool) -> usize {
    match closure {
        ClosureRecord::Glossy { .. }
        | ClosureRecord::Refraction { .. }
        | ClosureRecord::Translucent { .. }
        | ClosureRecord::Sheen { .. } => 1,
        ClosureRecord::Glass { .. } => 2,
        ClosureRecord::Principled(_) => principled::LOBES,
        ClosureRecord::Diffuse { roughness, .. } => usize::from(!is_merged || *roughness >= LEAST_ROUGHNESS),
        _ => 0,
    }
}

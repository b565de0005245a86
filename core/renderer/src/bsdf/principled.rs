//! Blender's Principled BSDF (Blender 4.0 and later) as a stack of lobes, from the top: sheen, coat, metal, glass, specular
//! layer, diffuse. Every layer dims those below by an estimate of what it reflects.

use super::closure::Unscattered;
use super::dielectric::Glass;
use super::lobe::Lobe;
use super::normals::Layers;
use super::oren_nayar::LEAST_ROUGHNESS;
use super::reflection::{Layer, Metal, Roughness};
use super::sheet::Sheet;
use super::{LobeList, LobeSet, anisotropy, fresnel};
use crate::color::Rgb;
use crate::scene::record::PrincipledRecord;

/// Shares below this are left out, as in Cycles.
const NEGLIGIBLE: f32 = 1e-5;

/// Most lobes one Principled BSDF makes.
pub(super) const LOBES: usize = 8;

/// Which of its lobes, by their slots, are coat and sheen.
const COAT: u8 = 0;
const SHEEN: u8 = 6;

/// Those whose microfacets may have two alphas.
const METAL: u8 = 1;
const SPECULAR: u8 = 4;

/// True for the slots of lobes that are anisotropic where the BSDF is.
pub(super) const fn is_anisotropic(slot: u8) -> bool {
    matches!(slot, METAL | SPECULAR)
}

/// The slot of what of the diffuse base leaves on the other side.
const TRANSLUCENT: u8 = 7;

/// What of the `layers` belongs to the lobe of a slot.
pub(super) const fn layer(layers: Layers<u8>, slot: u8) -> u8 {
    match slot {
        COAT => layers.coat,
        SHEEN => layers.sheen,
        _ => layers.base,
    }
}

/// A Principled BSDF without its alpha, its parameters checked and converted.
#[derive(Clone, Debug)]
pub(super) struct Principled {
    /// Radiance, as seen through the coat.
    pub(super) emission: Rgb,
    base_color: Rgb,
    diffuse_roughness: f32,
    sheen: Option<SheenLayer>,
    coat: Option<Coat>,
    metallic: f32,
    metal: Metal,
    /// Of metal and specular layer.
    rough: Roughness,
    /// Of the tangent (turns).
    rotation: f32,
    transmission: f32,
    glass: Glass,
    /// What takes the place of glass in thin walls.
    sheet: Option<Sheet>,
    /// Share of the diffuse base that leaves on the other side.
    translucency: f32,
    /// `None` where the index is exactly 1.
    specular: Option<Layer>,
}

/// Fibers on top of all.
#[derive(Clone, Copy, Debug)]
struct SheenLayer {
    /// Share times tint.
    color: Rgb,
    roughness: f32,
}

/// The coat and the tint of what is seen through it.
#[derive(Clone, Debug)]
struct Coat {
    weight: f32,
    ior: f32,
    layer: Option<Layer>,
    tint: Rgb,
}

impl Principled {
    /// From sockets already within their ranges.
    pub(super) fn new(record: &PrincipledRecord) -> Self {
        let plain = Roughness::new(record.roughness, record.multiscatter);
        let rough = plain.stretched(anisotropy::principled_factors(record.anisotropic));
        let ior = record.ior;
        let plain_f0 = fresnel::f0_from_ior(ior);
        let (mut f0, mut eta) = (plain_f0, ior);
        if (record.specular_ior_level - 0.5).abs() > f32::EPSILON {
            f0 *= 2.0 * record.specular_ior_level;
            eta = fresnel::ior_from_f0(f0);
            if ior < 1.0 {
                eta = 1.0 / eta;
            }
        }
        let tinted = |f0: f32| (record.specular_tint * f0).map(|c| c.min(1.0));
        let coat_layer = Layer {
            eta: record.coat_ior,
            f0: Rgb::splat(fresnel::f0_from_ior(record.coat_ior)),
            // The distribution is that of what lies below: coats lose nothing.
            rough: Roughness::new(record.coat_roughness, true),
        };
        Self {
            emission: record.emission_color * record.emission_strength,
            base_color: record.base_color,
            diffuse_roughness: record.diffuse_roughness,
            sheen: (record.sheen_weight > NEGLIGIBLE).then(|| SheenLayer {
                color: record.sheen_tint * record.sheen_weight,
                roughness: record.sheen_roughness,
            }),
            coat: (record.coat_weight > NEGLIGIBLE).then(|| Coat {
                weight: record.coat_weight,
                ior: record.coat_ior,
                layer: (record.coat_ior > 1.0).then_some(coat_layer),
                tint: record.coat_tint,
            }),
            metallic: record.metallic,
            metal: Metal {
                f0: record.base_color,
                dip: fresnel::metal_dip(record.base_color, record.specular_tint.map(|c| c.min(1.0))),
            },
            rough,
            rotation: record.anisotropic_rotation,
            transmission: record.transmission_weight,
            glass: Glass {
                ior,
                f0: tinted(plain_f0),
                reflection_tint: Rgb::WHITE,
                transmission_tint: record.base_color.map(f32::sqrt),
                rough: plain,
            },
            sheet: record.thin_wall.then(|| {
                let tint = record.specular_tint.map(|c| c.min(1.0));
                Sheet::new(ior, tinted(plain_f0), record.base_color, tint, record.roughness)
            }),
            translucency: match record.thin_wall {
                true => record.subsurface_weight * 0.5 * (1.0 + record.subsurface_anisotropy),
                false => 0.0,
            },
            specular: (eta != 1.0).then(|| Layer { eta, f0: tinted(f0), rough }),
        }
    }

    /// True when light is refracted, or spread by what it passes.
    pub(super) fn transmits(&self) -> bool {
        let is_clear = self.sheet.is_some_and(|sheet| sheet.is_clear());
        self.metallic < 1.0 && self.transmission > NEGLIGIBLE && !is_clear
    }

    /// The albedo where nothing but Lambert's lobe is left.
    pub(super) fn lambert(&self) -> Option<Rgb> {
        let bare = self.coat.is_none()
            && self.sheen.is_none()
            && self.metallic <= NEGLIGIBLE
            && self.transmission <= NEGLIGIBLE
            && self.diffuse_roughness < LEAST_ROUGHNESS
            && self.translucency == 0.0;
        (bare && self.specular.is_none()).then_some(self.base_color)
    }

    /// True when what is emitted below coat and sheen depends on the direction.
    pub(super) fn dims_its_emission(&self) -> bool {
        (self.coat.is_some() || self.sheen.is_some()) && !self.emission.is_black()
    }

    /// The alphas along a tangent and across it, where they differ, and the turns of the tangent.
    pub(super) fn anisotropy(&self) -> Option<([f32; 2], f32)> {
        self.rough.pair.map(|alpha| (alpha, self.rotation))
    }

    /// Shares of metal, glass and the layered diffuse base, without the coat.
    fn shares(&self) -> [f32; 3] {
        let rest = 1.0 - self.metallic;
        [self.metallic, rest * self.transmission, rest * (1.0 - self.transmission)]
    }

    /// How far the sheen's normal is turned to the coat's; `None` without sheen.
    pub(super) fn sheen_on_coat(&self) -> Option<f32> {
        self.sheen.is_some().then(|| self.coat.as_ref().map_or(0.0, |coat| coat.weight))
    }

    /// Classes that can occur.
    pub(super) fn classes(&self) -> LobeSet {
        let mut set = if self.sheen.is_some() { LobeSet::DIFFUSE } else { LobeSet::EMPTY };
        if let Some(layer) = self.coat.as_ref().and_then(|coat| coat.layer) {
            set = set | layer.rough.reflection_class();
        }
        let [metal, glass, base] = self.shares();
        if metal > NEGLIGIBLE {
            set = set | self.rough.reflection_class();
        }
        if glass > NEGLIGIBLE {
            set = set | self.sheet.map_or_else(|| self.glass.classes(), |sheet| sheet.classes());
        }
        if base > NEGLIGIBLE {
            if let Some(layer) = self.specular {
                set = set | layer.rough.reflection_class();
            }
            if !self.base_color.is_black() {
                set = set | self.diffuse_classes();
            }
        }
        set
    }

    /// Classes of the diffuse base.
    fn diffuse_classes(&self) -> LobeSet {
        let reflected = if self.translucency < 1.0 { LobeSet::DIFFUSE } else { LobeSet::EMPTY };
        if self.translucency > 0.0 { reflected | LobeSet::TRANSLUCENT } else { reflected }
    }

    /// Indices of refraction the energy tables will be asked for.
    pub(super) fn etas(&self) -> impl Iterator<Item = f32> {
        let coat = self.coat.as_ref().and_then(|coat| coat.layer).map(|layer| layer.eta);
        let specular = self.specular.map(|layer| layer.eta);
        let glass = (self.transmission > NEGLIGIBLE && self.sheet.is_none()).then_some(self.glass.ior);
        [coat, specular, glass].into_iter().flatten()
    }

    /// Colors at normal incidence of the rough reflections, weighted by their shares.
    pub(super) fn rough_tint(&self) -> Rgb {
        let mut tint = Rgb::BLACK;
        if let Some((coat, layer)) = self.coat.as_ref().and_then(|coat| Some((coat, coat.layer?)))
            && layer.rough.reflection_class() == LobeSet::ROUGH
        {
            tint += layer.f0 * coat.weight;
        }
        let [metal, glass, base] = self.shares();
        if self.glass.rough.reflection_class() == LobeSet::ROUGH {
            let transmitting = self.sheet.map_or(self.glass.f0, |sheet| sheet.reflectance());
            tint += transmitting * glass;
        }
        if self.rough.reflection_class() == LobeSet::ROUGH {
            tint += self.metal.f0 * metal;
            tint += self.specular.map_or(Rgb::BLACK, |layer| layer.f0 * base);
        }
        tint
    }

    /// Adds the lobes; returns what else leaves towards the viewer at `cos` from the normals.
    pub(super) fn push(
        &self,
        lobes: &mut LobeList,
        weight: Rgb,
        entering: bool,
        cos: Layers<f32>,
        slot: u8,
    ) -> Unscattered {
        let below_sheen = self.push_sheen(lobes, weight, cos.sheen, slot + SHEEN);
        let below_coat = self.push_coat(lobes, weight * below_sheen, cos.coat, slot + COAT) * below_sheen;
        let cos = cos.base;
        let [metal, glass, base] = self.shares();
        let weight = weight * below_coat;
        let mut unscattered = Unscattered { emission: weight * self.emission, straight: Rgb::BLACK };
        if metal > NEGLIGIBLE {
            self.metal.push(lobes, weight * metal, self.rough, cos, slot + METAL);
        }
        if glass > NEGLIGIBLE {
            match &self.sheet {
                Some(sheet) => unscattered.straight = sheet.push(lobes, weight * glass, cos, slot + 2),
                None => self.glass.push(lobes, weight * glass, entering, cos, slot + 2),
            }
        }
        if base > NEGLIGIBLE {
            let through = match self.specular {
                Some(layer) => layer.push(lobes, weight * base, 1.0, cos, slot + SPECULAR),
                None => 1.0,
            };
            if !self.base_color.is_black() {
                self.push_diffuse(lobes, weight * self.base_color * (base * through), cos, slot);
            }
        }
        unscattered
    }

    /// Adds the diffuse base. What of it leaves on the other side does so evenly, however rough it is.
    fn push_diffuse(&self, lobes: &mut LobeList, albedo: Rgb, cos: f32, slot: u8) {
        if self.translucency < 1.0 {
            let reflected = albedo * (1.0 - self.translucency);
            lobes.push(Lobe::diffuse(reflected, self.base_color, self.diffuse_roughness, cos, slot + 5));
        }
        if self.translucency > 0.0 {
            lobes.push(Lobe::translucent(albedo * self.translucency, slot + TRANSLUCENT));
        }
    }

    /// Adds the sheen, and returns what part of the light passes it.
    fn push_sheen(&self, lobes: &mut LobeList, weight: Rgb, cos: f32, slot: u8) -> f32 {
        let Some(SheenLayer { color, roughness }) = self.sheen else { return 1.0 };
        let lobe = Lobe::sheen(color, roughness, cos, slot);
        lobes.push(Lobe { weight: weight * lobe.weight, albedo: weight * lobe.albedo, ..lobe });
        1.0 - lobe.albedo.max_channel()
    }

    /// Adds the coat, and returns what part of the light reaches what lies below and comes back tinted. The path through
    /// the coat follows Beer's law along the refracted view direction, normalized to normal incidence.
    fn push_coat(&self, lobes: &mut LobeList, weight: Rgb, cos: f32, slot: u8) -> Rgb {
        let Some(coat) = &self.coat else { return Rgb::WHITE };
        let through = match coat.layer {
            Some(layer) => layer.push(lobes, weight, coat.weight, cos, slot),
            None => 1.0,
        };
        let depth = 1.0 / fresnel::cos_refracted(cos, coat.ior).map_or(1e-3, |c| c.max(1e-3));
        Rgb::WHITE.lerp(coat.tint.map(|c| c.powf(depth)), coat.weight) * through
    }
}

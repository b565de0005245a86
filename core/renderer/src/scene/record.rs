//! Records a host hands over: world space, metres and watts, one per Blender thing. They are plain data; what is wrong
//! with them is found by [`super::SceneBuilder`].

use glam::DMat4;
use serde::Deserialize;

use crate::color::Rgb;
use crate::shader::{Instruction, Register};

pub use super::lamp::{LampProgramRecord, LampRecord, LampShape};
pub use super::lens::LensRecord;
pub use super::links::{LightLinks, ObjectLinks};
pub use super::object_info::{ObjectAttribute, ObjectInfo};
pub use super::projection::Projection;

/// Ray kinds an object can be hidden from; the bits are Embree's ray mask.
pub mod visibility {
    /// Rays from the camera.
    pub const CAMERA: u32 = 1;
    /// Rays that left a diffuse surface, and photons.
    pub const DIFFUSE: u32 = 2;
    /// Rays that left a glossy surface by reflection.
    pub const GLOSSY: u32 = 4;
    /// Rays that passed through a surface.
    pub const TRANSMISSION: u32 = 8;
    /// Shadow rays.
    pub const SHADOW: u32 = 16;
    /// Proxy geometry of lamps: never set by the host.
    pub const LAMP: u32 = 32;
    /// No kind of ray: camera rays see a hole in the picture where the object is.
    pub const HOLDOUT: u32 = 64;
    /// No kind of ray: the camera sees what is missing of the object's light, and lamps that have it are there without
    /// the other objects too.
    pub const CATCHER: u32 = 1 << 31;
    /// Everything a mesh object may be seen by.
    pub const ALL: u32 = CAMERA | DIFFUSE | GLOSSY | TRANSMISSION | SHADOW;
    /// Sets of objects that only some lights are blocked by.
    pub const BLOCKER_SETS: u32 = 24;
    /// Shadow rays of lights that are not blocked by everything: a bit for each set. Never set by the host.
    pub const BLOCKERS: u32 = ((1 << BLOCKER_SETS) - 1) << FIRST_BLOCKER;
    const FIRST_BLOCKER: u32 = 7;

    /// True for rays that a glossy surface sent on, by reflection or refraction.
    #[must_use]
    pub const fn is_glossy(kinds: u32) -> bool {
        kinds & GLOSSY != 0 || kinds & (DIFFUSE | TRANSMISSION) == TRANSMISSION
    }

    /// True for rays that left a surface on the side on which they met it.
    #[must_use]
    pub const fn is_reflection(kinds: u32) -> bool {
        kinds & (DIFFUSE | GLOSSY) != 0 && kinds & TRANSMISSION == 0
    }

    /// The bit of a blocker set.
    #[must_use]
    pub const fn blocker(set: u32) -> u32 {
        1 << (FIRST_BLOCKER + set)
    }
}

/// One closure of a surface shader: what remains of a node tree once its constants are folded.
#[derive(Clone, Debug, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum ClosureRecord {
    /// Diffuse reflection (Blender's Diffuse BSDF): Lambert's, or that of Oren and Nayar.
    Diffuse {
        /// Albedo of a smooth surface, and of facets where it is rough.
        color: Rgb,
        /// Blender's roughness; 0 is Lambert's.
        #[serde(default)]
        roughness: f32,
    },
    /// GGX reflection with constant reflectance (Blender's Glossy BSDF).
    Glossy {
        /// Reflectance.
        color: Rgb,
        /// Blender's roughness, the square root of GGX alpha.
        roughness: f32,
        /// Blender's anisotropy, -1 to 1: alpha is larger along the tangent below 0, across it above.
        #[serde(default)]
        anisotropy: f32,
        /// Turns of the tangent about the normal.
        #[serde(default)]
        rotation: f32,
        /// Whether light that bounces between microfacets leaves in the end (Blender's Multiscatter GGX) or is lost (GGX).
        #[serde(default = "is_multiscatter")]
        multiscatter: bool,
    },
    /// Reflection and refraction by Fresnel's equations (Blender's Glass BSDF).
    Glass {
        /// Tint of both.
        color: Rgb,
        /// Blender's roughness.
        roughness: f32,
        /// Index of refraction, inside over outside.
        ior: f32,
        /// As of [`ClosureRecord::Glossy`].
        #[serde(default = "is_multiscatter")]
        multiscatter: bool,
    },
    /// Refraction alone (Blender's Refraction BSDF).
    Refraction {
        /// Tint.
        color: Rgb,
        /// Blender's roughness.
        roughness: f32,
        /// Index of refraction.
        ior: f32,
    },
    /// Lambertian transmission: what arrives on one side leaves the other (Blender's Translucent BSDF).
    Translucent {
        /// Albedo.
        color: Rgb,
    },
    /// Reflection from fibers (Blender's Sheen BSDF, Microfiber).
    Sheen {
        /// Tint.
        color: Rgb,
        /// Blender's roughness.
        roughness: f32,
    },
    /// Rays from the camera see a hole in the picture; nothing is scattered.
    Holdout,
    /// Light passes straight through, tinted.
    Transparent {
        /// Transmittance.
        color: Rgb,
    },
    /// Light emitted from both sides.
    Emission {
        /// Radiance (W·m⁻²·sr⁻¹): Blender's colour times strength.
        radiance: Rgb,
    },
    /// Blender's Principled BSDF, the sockets of Blender 4.0 and later.
    Principled(PrincipledRecord),
}

/// Blender's default distribution of microfacets is Multiscatter GGX.
const fn is_multiscatter() -> bool {
    true
}

/// Sockets of Blender's Principled BSDF, their meaning and ranges Blender's own.
#[derive(Clone, Debug, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[expect(missing_docs, reason = "the names are Blender's socket names")]
pub struct PrincipledRecord {
    pub base_color: Rgb,
    pub metallic: f32,
    pub roughness: f32,
    pub multiscatter: bool,
    pub anisotropic: f32,
    pub anisotropic_rotation: f32,
    pub diffuse_roughness: f32,
    pub ior: f32,
    pub alpha: f32,
    pub specular_ior_level: f32,
    pub specular_tint: Rgb,
    pub transmission_weight: f32,
    pub thin_wall: bool,
    /// Counts in thin walls alone.
    pub subsurface_weight: f32,
    pub subsurface_anisotropy: f32,
    pub coat_weight: f32,
    pub coat_roughness: f32,
    pub coat_ior: f32,
    pub coat_tint: Rgb,
    pub emission_color: Rgb,
    pub emission_strength: f32,
    pub sheen_weight: f32,
    pub sheen_roughness: f32,
    pub sheen_tint: Rgb,
}

impl PrincipledRecord {
    fn input_mut(&mut self, input: Input) -> Option<InputMut<'_>> {
        use InputMut::{Color, Number};
        Some(match input {
            Input::BaseColor => Color(&mut self.base_color),
            Input::Metallic => Number(&mut self.metallic),
            Input::Roughness => Number(&mut self.roughness),
            Input::Anisotropic => Number(&mut self.anisotropic),
            Input::AnisotropicRotation => Number(&mut self.anisotropic_rotation),
            Input::DiffuseRoughness => Number(&mut self.diffuse_roughness),
            Input::Ior => Number(&mut self.ior),
            Input::Alpha => Number(&mut self.alpha),
            Input::SpecularIorLevel => Number(&mut self.specular_ior_level),
            Input::SpecularTint => Color(&mut self.specular_tint),
            Input::TransmissionWeight => Number(&mut self.transmission_weight),
            Input::SubsurfaceWeight => Number(&mut self.subsurface_weight),
            Input::SubsurfaceAnisotropy => Number(&mut self.subsurface_anisotropy),
            Input::CoatWeight => Number(&mut self.coat_weight),
            Input::CoatRoughness => Number(&mut self.coat_roughness),
            Input::CoatIor => Number(&mut self.coat_ior),
            Input::CoatTint => Color(&mut self.coat_tint),
            Input::EmissionColor => Color(&mut self.emission_color),
            Input::EmissionStrength => Number(&mut self.emission_strength),
            Input::SheenWeight => Number(&mut self.sheen_weight),
            Input::SheenRoughness => Number(&mut self.sheen_roughness),
            Input::SheenTint => Color(&mut self.sheen_tint),
            Input::Weight | Input::Color | Input::Radiance | Input::Anisotropy | Input::Rotation => {
                return None;
            }
        })
    }
}

impl Default for PrincipledRecord {
    fn default() -> Self {
        Self {
            base_color: Rgb::splat(0.8),
            metallic: 0.0,
            roughness: 0.5,
            multiscatter: true,
            anisotropic: 0.0,
            anisotropic_rotation: 0.0,
            diffuse_roughness: 0.0,
            ior: 1.5,
            alpha: 1.0,
            specular_ior_level: 0.5,
            specular_tint: Rgb::WHITE,
            transmission_weight: 0.0,
            thin_wall: false,
            subsurface_weight: 0.0,
            subsurface_anisotropy: 0.0,
            coat_weight: 0.0,
            coat_roughness: 0.03,
            coat_ior: 1.5,
            coat_tint: Rgb::WHITE,
            emission_color: Rgb::WHITE,
            emission_strength: 0.0,
            sheen_weight: 0.0,
            sheen_roughness: 0.5,
            sheen_tint: Rgb::WHITE,
        }
    }
}

/// A closure and its share in the surface: Mix and Add Shader multiplied out.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WeightedClosure {
    /// Share, per channel.
    pub weight: Rgb,
    /// What is shared.
    pub closure: ClosureRecord,
}

/// A surface shader.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MaterialRecord {
    /// Blender's name, for messages.
    pub name: String,
    /// Weighted sum of closures; empty is a black surface. Inputs that vary hold a typical value.
    pub closures: Vec<WeightedClosure>,
    /// What computes the inputs that vary.
    #[serde(default)]
    pub program: Option<ProgramRecord>,
    /// What light loses on its way through the solid that the surface bounds (1/m).
    #[serde(default)]
    pub absorption: Rgb,
}

/// Inputs of closures that differ from point to point, and how they are computed.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ProgramRecord {
    /// What is computed; operands name earlier instructions.
    pub instructions: Vec<Instruction>,
    /// Which results are inputs.
    pub outputs: Vec<OutputRecord>,
    /// The result that is the shading normal (world space) of what has none of its own.
    pub normal: Option<Register>,
    /// Closures with a shading normal of their own.
    #[serde(default)]
    pub normals: Vec<NormalRecord>,
    /// Tangents of closures that are anisotropic.
    #[serde(default)]
    pub tangents: Vec<TangentRecord>,
}

/// A result that is the shading normal (world space) of one closure.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NormalRecord {
    /// Index of the closure.
    pub closure: usize,
    /// True: of its coat alone; false: of all but its coat.
    pub coat: bool,
    /// The result.
    pub register: Register,
}

/// A result that is the tangent (world space, of any length) that the reflections of a closure are anisotropic about; they are
/// isotropic where it is 0 or along the normal.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TangentRecord {
    /// Index of the closure.
    pub closure: usize,
    /// The result.
    pub register: Register,
}

/// A result that is an input of a closure.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct OutputRecord {
    /// Index of the closure.
    pub closure: usize,
    /// Which of its inputs.
    pub input: Input,
    /// The result.
    pub register: Register,
}

/// Inputs of closures.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
#[expect(missing_docs, reason = "the names are those of the fields of the closures")]
pub enum Input {
    Weight,
    Color,
    Radiance,
    Roughness,
    Anisotropy,
    Rotation,
    Anisotropic,
    AnisotropicRotation,
    DiffuseRoughness,
    Ior,
    BaseColor,
    Metallic,
    Alpha,
    SpecularIorLevel,
    SpecularTint,
    TransmissionWeight,
    SubsurfaceWeight,
    SubsurfaceAnisotropy,
    CoatWeight,
    CoatRoughness,
    CoatIor,
    CoatTint,
    EmissionColor,
    EmissionStrength,
    SheenWeight,
    SheenRoughness,
    SheenTint,
}

impl WeightedClosure {
    /// The input's value, as a color or a number; `None` where the closure has no such input.
    pub fn input_mut(&mut self, input: Input) -> Option<InputMut<'_>> {
        use ClosureRecord as C;
        use InputMut::{Color, Number};
        if input == Input::Weight {
            return Some(Color(&mut self.weight));
        }
        match (&mut self.closure, input) {
            (
                C::Diffuse { color, .. }
                | C::Translucent { color }
                | C::Transparent { color }
                | C::Glossy { color, .. }
                | C::Sheen { color, .. }
                | C::Glass { color, .. }
                | C::Refraction { color, .. },
                Input::Color,
            ) => Some(Color(color)),
            (C::Emission { radiance }, Input::Radiance) => Some(Color(radiance)),
            (
                C::Diffuse { roughness, .. }
                | C::Glossy { roughness, .. }
                | C::Glass { roughness, .. }
                | C::Refraction { roughness, .. }
                | C::Sheen { roughness, .. },
                Input::Roughness,
            ) => Some(Number(roughness)),
            (C::Glossy { anisotropy, .. }, Input::Anisotropy) => Some(Number(anisotropy)),
            (C::Glossy { rotation, .. }, Input::Rotation) => Some(Number(rotation)),
            (C::Glass { ior, .. } | C::Refraction { ior, .. }, Input::Ior) => Some(Number(ior)),
            (C::Principled(record), _) => record.input_mut(input),
            _ => None,
        }
    }
}

/// An input of a closure.
#[derive(Debug)]
pub enum InputMut<'a> {
    /// A color.
    Color(&'a mut Rgb),
    /// A number.
    Number(&'a mut f32),
}

impl MaterialRecord {
    /// Blender's surface for objects without a material.
    #[must_use]
    pub fn default_gray() -> Self {
        let closure = ClosureRecord::Diffuse { color: Rgb::splat(0.8), roughness: 0.0 };
        let closures = vec![WeightedClosure { weight: Rgb::WHITE, closure }];
        Self { name: "Default".into(), closures, program: None, absorption: Rgb::BLACK }
    }
}

/// A camera.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CameraRecord {
    /// Blender's name, for messages.
    pub name: String,
    /// Projection.
    pub projection: Projection,
    /// Camera to world, looking along −Z; scale is ignored.
    pub world_from_camera: [[f64; 4]; 4],
    /// Left, right, bottom, top of the full frame, in the unit of its projection.
    pub window: [f64; 4],
    /// Pixels of the full frame, width and height.
    pub resolution: [u32; 2],
    /// Part of the frame that is rendered: x, y (from the bottom left), width, height.
    pub region: [u32; 4],
    /// Near and far clip distance along the view axis, or along each ray of a panorama (m).
    pub clip: [f64; 2],
    /// Its lens; without one it is a pinhole.
    #[serde(default)]
    pub lens: Option<LensRecord>,
    /// What else it is at even times while the shutter is open, the middle left out; empty where it stays the same.
    #[serde(default)]
    pub steps: Vec<CameraStep>,
    /// How open the shutter is at even times, from when it opens until it is shut; empty where that is all the same.
    #[serde(default)]
    pub shutter: Vec<f64>,
}

/// A camera at one time.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CameraStep {
    /// See [`CameraRecord`].
    pub world_from_camera: [[f64; 4]; 4],
    /// See [`CameraRecord`].
    pub window: [f64; 4],
}

/// Light from everywhere outside.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct WorldRecord {
    /// Blender's name, for messages.
    pub name: String,
    /// Radiance of the background (W·m⁻²·sr⁻¹); a typical value where it varies.
    pub radiance: Rgb,
    /// What computes the radiance where it varies.
    pub program: Option<WorldProgramRecord>,
    /// Ray kinds that see the background.
    pub visibility: u32,
    /// True: camera rays that leave the scene give alpha 0.
    pub film_transparent: bool,
}

/// What computes the radiance of a world from a direction. Positions are unit vectors towards where the light comes from.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WorldProgramRecord {
    /// What is computed; operands name earlier instructions.
    pub instructions: Vec<Instruction>,
    /// The result that is the radiance.
    pub radiance: Register,
}

/// Row-major 4×4 rows to a matrix acting on column vectors.
#[must_use]
pub fn matrix(rows: &[[f64; 4]; 4]) -> DMat4 {
    DMat4::from_cols_array_2d(rows).transpose()
}

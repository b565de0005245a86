//! Lamps as the host hands them over, and the programs that compute their light.

use glam::DAffine3;
use serde::Deserialize;

use super::record::{LightLinks, ObjectInfo};
use crate::color::Rgb;
use crate::shader::{Instruction, Program, Register};

/// Shape of a lamp and what depends on it. Emission is along local −Z, as Blender's lamps are.
#[derive(Clone, Debug, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum LampShape {
    /// Blender's point light.
    Point {
        /// Radius (m); 0 is a true point.
        radius: f32,
        /// True: a disk turned towards whoever looks at it; false: a sphere.
        soft_falloff: bool,
    },
    /// Blender's spot light.
    Spot {
        /// Radius (m).
        radius: f32,
        /// As for the point light.
        soft_falloff: bool,
        /// Full cone angle (rad).
        cone_angle: f32,
        /// Blender's blend, 0 to 1.
        blend: f32,
    },
    /// Light from infinitely far away.
    Sun {
        /// Angular diameter (rad).
        angle: f32,
    },
    /// One-sided rectangle in the local xy plane.
    Rectangle {
        /// Sides (m), before the object's scale.
        size: [f32; 2],
        /// Full spread angle (rad), π for a Lambertian lamp.
        spread: f32,
    },
    /// One-sided ellipse in the local xy plane.
    Ellipse {
        /// Diameters (m), before the object's scale.
        size: [f32; 2],
        /// Full spread angle (rad).
        spread: f32,
    },
}

/// A lamp.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LampRecord {
    /// Blender's name, for messages.
    pub name: String,
    /// Shape.
    pub shape: LampShape,
    /// Blender's power × colour × 2^exposure: watts per channel, for a sun irradiance (W·m⁻²). Where nodes give a constant it
    /// holds that too.
    pub power: Rgb,
    /// What computes a factor of the power, where its nodes give more than a constant.
    #[serde(default)]
    pub program: Option<LampProgramRecord>,
    /// What the program may ask about the lamp.
    #[serde(default)]
    pub info: ObjectInfo,
    /// Local to world; columns as Blender's `matrix_world`, row-major in the record.
    pub world_from_lamp: [[f64; 4]; 4],
    /// Ray kinds that see the lamp's own shape.
    pub visibility: u32,
    /// False: its light passes through everything.
    pub casts_shadow: bool,
    /// What it lights.
    #[serde(default)]
    pub links: LightLinks,
}

/// What computes the light of a lamp, from a point of it and the direction in which it leaves.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LampProgramRecord {
    /// What is computed; operands name earlier instructions.
    pub instructions: Vec<Instruction>,
    /// The result that the power is multiplied with.
    pub factor: Register,
}

/// The part of a lamp's light that differs from point to point, or from direction to direction.
#[derive(Clone, Debug)]
pub struct LampProgram {
    /// What is computed.
    pub program: Program,
    /// The result that the power is multiplied with.
    pub factor: Register,
    /// What it may ask about the lamp.
    pub info: ObjectInfo,
    /// World space (m) to the lamp's own.
    pub lamp_from_world: DAffine3,
}

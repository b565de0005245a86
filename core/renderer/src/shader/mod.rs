//! Programs: what is left of a material's node tree once everything constant is folded, run at every hit.
//!
//! A program is a flat list of instructions, each with one result. It is checked once, when the scene is made: operands
//! come before their use and tables and textures exist, so that running it can neither fail nor end up elsewhere. It knows
//! no scene: what it asks of the point it is run for goes through [`Point`].
//!
//! Every value carries the width over which it is meant: the footprint of the ray, followed through the arithmetic. It
//! chooses the level of the textures.

mod arithmetic;
mod cell_hash;
mod instruction;
mod noise;
mod panorama;
mod pattern;
mod photometry;
mod run;
mod surface;
mod texture;
mod voronoi;

use glam::Vec4;
use smallvec::SmallVec;

pub use arithmetic::{BlendMode, MathFunction, VectorFunction};
pub use cell_hash::CellHash;
pub use instruction::{Aside, Axis, Instruction, MOST_INSTRUCTIONS, NormalSpace, Quantity, Register, Tile};
pub use noise::Fractal;
pub use panorama::{Projection, around};
pub use pattern::{GradientShape, Pattern, VoronoiOutput, WaveDirection, WaveProfile};
pub use photometry::PhotometricWeb;
pub use texture::{Encoding, Extension, Interpolation, Pixels, Texture};
pub use voronoi::{Feature, Metric};

use crate::color::Rgb;

/// A result: a color with alpha, a vector, or a number in every channel.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Value {
    /// The channels.
    pub v: Vec4,
    /// How far `v` changes across the footprint of the ray.
    pub width: f32,
}

impl Value {
    /// A number, sharp.
    #[must_use]
    pub const fn number(x: f32) -> Self {
        Self { v: Vec4::splat(x), width: 0.0 }
    }

    /// A vector or color, sharp; its alpha is 1.
    #[must_use]
    pub const fn vector(v: glam::Vec3) -> Self {
        Self { v: Vec4::new(v.x, v.y, v.z, 1.0), width: 0.0 }
    }

    /// The first three channels.
    #[must_use]
    pub fn rgb(&self) -> Rgb {
        Rgb([self.v.x, self.v.y, self.v.z])
    }
}

/// Results of a program, by register.
pub type Registers = SmallVec<[Value; 24]>;

/// What a program asks of the point it is run for.
pub trait Point {
    /// A layer of values at the corners of the mesh, interpolated; 0 where there is none.
    fn attribute(&self, attribute: u32, aside: Aside) -> Value;

    /// A value of the object or lamp; 0 where it has none, as in the world.
    fn object_attribute(&self, _attribute: u32) -> Vec4 {
        Vec4::ZERO
    }

    /// Something about the point.
    fn geometry(&self, quantity: Quantity, aside: Aside) -> Value;

    /// The vectors to the two places so many widths of the ray aside (m), see [`Aside`].
    fn steps(&self, widths: f32) -> [glam::Vec3; 2];

    /// Unit vectors along u and v of a UV map, and the shading normal as modelled, in the object's space; `None` where the map
    /// has no direction.
    fn tangents(&self, attribute: u32) -> Option<[glam::Vec3; 3]>;

    /// A normal of the object's space in world space, of length 1 and on the viewer's side.
    fn world_normal(&self, normal: glam::Vec3) -> glam::Vec3;
}

/// A checked list of instructions.
#[derive(Clone, Debug, PartialEq)]
pub struct Program(Vec<Instruction>);

impl Program {
    /// Checks `instructions`; `textures` is how many there are.
    ///
    /// # Errors
    /// What is wrong with them.
    pub fn new(instructions: Vec<Instruction>, textures: usize) -> Result<Self, String> {
        if instructions.len() > MOST_INSTRUCTIONS {
            return Err(format!(
                "{} instructions; at most {MOST_INSTRUCTIONS} are allowed",
                instructions.len()
            ));
        }
        let fault = instructions.iter().enumerate().find_map(|(index, step)| step.fault(index, textures));
        fault.map_or(Ok(Self(instructions)), Err)
    }

    /// Number of registers.
    #[must_use]
    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// True where something asked of the point is one of `quantities`.
    #[must_use]
    pub fn asks(&self, quantities: &[Quantity]) -> bool {
        let is_asked = |step: &Instruction| matches!(step, Instruction::Geometry { quantity, .. } if quantities.contains(quantity));
        self.0.iter().any(is_asked)
    }

    /// In how many columns a panorama must be divided to show all details: those of the widest texture, or about four across
    /// a sun; 0 without either.
    #[must_use]
    pub fn columns(&self, textures: &[Texture]) -> usize {
        let width = |step: &Instruction| match *step {
            Instruction::Image { texture, .. } | Instruction::BoxImage { texture, .. } => {
                textures[texture as usize].size()[0]
            }
            Instruction::TiledImage { ref tiles, .. } => {
                tiles.iter().map(|tile| textures[tile.texture as usize].size()[0]).max().unwrap_or(0)
            }
            Instruction::SunDisk { radius, .. } => (4.0 * std::f32::consts::PI / radius.max(1e-6)) as usize,
            _ => 0,
        };
        self.0.iter().map(width).max().unwrap_or(0)
    }

    /// True where nothing is computed.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }
}

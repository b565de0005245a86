//! The instructions of a program and the check that makes them safe to run.

use serde::Deserialize;
use smallvec::{SmallVec, smallvec};

use super::arithmetic::{BlendMode, MathFunction, VectorFunction};
use super::panorama::Projection;
use super::pattern::{GradientShape, Pattern};
use super::photometry::PhotometricWeb;
use super::texture::{Extension, Interpolation};

/// Number of an instruction, whose result it names.
pub type Register = u16;

/// Most instructions of a program.
pub const MOST_INSTRUCTIONS: usize = 4096;

/// Furthest aside, in widths of the ray.
const MOST_WIDTHS: f32 = 1e3;

/// Where on the surface a quantity is asked for: so many widths of the ray away from the point, along one and the other
/// tangent. Bumps are differences between three such places.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize)]
pub struct Aside(pub [f32; 2]);

impl Aside {
    /// At the point itself.
    pub const HERE: Self = Self([0.0; 2]);
}

/// A texture and the unit square of the plane that it fills.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Tile {
    /// Its lowest x.
    pub column: u32,
    /// Its lowest y.
    pub row: u32,
    /// The texture.
    pub texture: u32,
}

/// What a program asks of the point it is run for. Vectors are in world space where nothing else is said.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Quantity {
    /// Position (m).
    Position,
    /// Position in the object's space.
    ObjectPosition,
    /// Shading normal, on the viewer's side.
    Normal,
    /// The same in the object's space.
    ObjectNormal,
    /// Geometric normal, on the viewer's side.
    TrueNormal,
    /// Unit vector towards the viewer.
    Incoming,
    /// The same in the object's space, turned and stretched as normals are.
    ObjectIncoming,
    /// The viewing direction mirrored at the shading normal.
    Reflection,
    /// Barycentric coordinates.
    Parametric,
    /// 1 where the back is seen.
    Backfacing,
    /// Object's origin (m).
    ObjectLocation,
    /// The object's color in the viewport.
    ObjectColor,
    /// The object's pass index.
    ObjectIndex,
    /// A random number of the object, 0 to 1.
    ObjectRandom,
    /// How far it is seen from (m); known of lamps alone.
    RayLength,
    /// 1 for rays from the camera.
    IsCamera,
    /// 1 for shadow rays.
    IsShadow,
    /// 1 for rays that left a diffuse surface.
    IsDiffuse,
    /// 1 for rays that left a glossy surface, to either side.
    IsGlossy,
    /// 1 for rays that were reflected.
    IsReflection,
    /// 1 for rays that passed through a surface.
    IsTransmission,
}

/// An axis of an object.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
#[expect(missing_docs, reason = "axes have no other names")]
pub enum Axis {
    X,
    Y,
    Z,
}

/// The space of a normal map's colors.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum NormalSpace {
    /// The tangents of a UV map.
    Tangent,
    /// The object's.
    Object,
    /// The world's.
    World,
}

/// One step of a program. Its result is the register of its own number; operands are registers of earlier ones. A number
/// is held in all four channels, so that it serves as a vector or color too.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(tag = "op", rename_all = "snake_case", deny_unknown_fields)]
#[expect(missing_docs, reason = "operands are named after the sockets of Blender's nodes")]
pub enum Instruction {
    /// A constant.
    Constant { value: [f32; 4] },
    /// A layer of values at the corners of the mesh, interpolated; 0 where the mesh has none.
    Attribute { attribute: u32, aside: Aside },
    /// A value of the object or lamp; 0 where it has none.
    ObjectAttribute { attribute: u32 },
    /// Something about the point.
    Geometry { quantity: Quantity, aside: Aside },
    /// `rows` × (x, y, z, 1).
    Transform { vector: Register, rows: [[f32; 4]; 3] },
    /// Blender's mapping of points with inputs that vary.
    Mapping { vector: Register, location: Register, rotation: Register, scale: Register },
    /// A vector of length 1.
    Normalize { vector: Register },
    /// A texture at `vector`'s x and y. `unassociate`: the color is divided by its alpha.
    Image {
        texture: u32,
        vector: Register,
        extension: Extension,
        interpolation: Interpolation,
        unassociate: bool,
    },
    /// One of several textures at `vector`'s x and y, each for one unit square of the plane (UDIM); magenta where there is none.
    TiledImage {
        tiles: Vec<Tile>,
        vector: Register,
        extension: Extension,
        interpolation: Interpolation,
        unassociate: bool,
    },
    /// Where a direction or point lies in a picture that is laid around it.
    Panorama { vector: Register, projection: Projection },
    /// The disk of a sun of an angular radius (rad) in the direction `towards`, seen along `vector`: colors at its lowest and
    /// highest points, darker towards the limb; black around it and below a height (sine).
    SunDisk { vector: Register, towards: [f32; 3], radius: f32, bottom: [f32; 3], top: [f32; 3], lowest: f32 },
    /// The intensity of a luminaire along a direction.
    PhotometricWeb { vector: Register, web: Box<PhotometricWeb> },
    /// A texture projected along the object's three axes, by the normal; `vector` in the object's space.
    BoxImage {
        texture: u32,
        vector: Register,
        normal: Register,
        blend: f32,
        extension: Extension,
        interpolation: Interpolation,
        unassociate: bool,
    },
    /// The fourth channel.
    Alpha { of: Register },
    /// One channel: 0, 1 or 2.
    Channel { of: Register, channel: u8 },
    /// A vector of three numbers.
    Combine { x: Register, y: Register, z: Register },
    /// The luminance of a color (Rec. 709).
    Luminance { of: Register },
    /// The mean of a vector's channels.
    Mean { of: Register },
    /// An operation on numbers.
    Math { function: MathFunction, a: Register, b: Register, c: Register },
    /// An operation on vectors.
    VectorMath { function: VectorFunction, a: Register, b: Register, c: Register },
    /// Linear from `a` to `b`, channel by channel.
    Mix { factor: Register, a: Register, b: Register },
    /// A blend of two colors.
    Blend { mode: BlendMode, factor: Register, a: Register, b: Register },
    /// Each channel kept within two numbers.
    Clamp { value: Register, low: Register, high: Register },
    /// The color with each channel to the power of a number; what is not above 0 stays.
    Gamma { color: Register, gamma: Register },
    /// Gain and offset, negative results cut off.
    BrightContrast { color: Register, bright: Register, contrast: Register },
    /// Changes hue (0.5: nothing), saturation and value.
    HueSaturation { color: Register, hue: Register, saturation: Register, value: Register },
    /// HSV to RGB.
    RgbFromHsv { color: Register },
    /// RGB to HSV.
    HsvFromRgb { color: Register },
    /// HSL to RGB.
    RgbFromHsl { color: Register },
    /// RGB to HSL.
    HslFromRgb { color: Register },
    /// The color of a table at a number from 0 to 1.
    Ramp { factor: Register, table: Vec<[f32; 4]>, stepped: bool },
    /// Each channel through its own column of a table, whose first and last row lie at `low` and `high`; beyond them straight on.
    Curves { color: Register, table: Vec<[f32; 4]>, low: f32, high: f32 },
    /// Share reflected by an interface of index `ior` seen at the normal.
    Fresnel { ior: Register, normal: Register },
    /// Blender's Layer Weight: its Fresnel (`facing` false) or Facing output.
    LayerWeight { blend: Register, normal: Register, facing: bool },
    /// The direction around an axis of the object along the surface, from the place within the object's box (0 to 1).
    Tangent { generated: Register, axis: Axis },
    /// The direction along u of a UV map; 0 where it has none.
    UvTangent { attribute: u32 },
    /// A normal from the color of a normal map; `attribute` is the UV map of a tangent space.
    NormalMap { color: Register, strength: Register, space: NormalSpace, attribute: u32 },
    /// A normal tilted by a height (m) that is known here and `filter_width` widths of the ray aside.
    Bump {
        strength: Register,
        distance: Register,
        height: Register,
        height_x: Register,
        height_y: Register,
        normal: Register,
        invert: bool,
        filter_width: f32,
    },
    /// Two colors in turn; the result's alpha is the factor.
    Checker { vector: Register, color1: Register, color2: Register, scale: Register },
    /// A gradient over the vector's x, or around or from the origin.
    Gradient { vector: Register, shape: GradientShape },
    /// Any other pattern.
    Pattern { pattern: Pattern, inputs: Vec<Register> },
}

impl Instruction {
    /// The registers it reads.
    pub(super) fn operands(&self) -> SmallVec<[Register; 8]> {
        match *self {
            Self::Constant { .. }
            | Self::Attribute { .. }
            | Self::ObjectAttribute { .. }
            | Self::UvTangent { .. }
            | Self::Geometry { .. } => smallvec![],
            Self::Transform { vector, .. }
            | Self::Normalize { vector }
            | Self::Panorama { vector, .. }
            | Self::SunDisk { vector, .. }
            | Self::PhotometricWeb { vector, .. }
            | Self::Image { vector, .. }
            | Self::TiledImage { vector, .. }
            | Self::Gradient { vector, .. } => smallvec![vector],
            Self::Mapping { vector, location, rotation, scale } => {
                smallvec![vector, location, rotation, scale]
            }
            Self::BoxImage { vector, normal, .. } => smallvec![vector, normal],
            Self::Alpha { of } | Self::Channel { of, .. } | Self::Luminance { of } | Self::Mean { of } => {
                smallvec![of]
            }
            Self::Combine { x, y, z } => smallvec![x, y, z],
            Self::Math { a, b, c, .. } | Self::VectorMath { a, b, c, .. } => smallvec![a, b, c],
            Self::Mix { factor, a, b } | Self::Blend { factor, a, b, .. } => smallvec![factor, a, b],
            Self::Clamp { value, low, high } => smallvec![value, low, high],
            Self::Gamma { color, gamma } => smallvec![color, gamma],
            Self::BrightContrast { color, bright, contrast } => smallvec![color, bright, contrast],
            Self::HueSaturation { color, hue, saturation, value } => {
                smallvec![color, hue, saturation, value]
            }
            Self::RgbFromHsv { color }
            | Self::HsvFromRgb { color }
            | Self::RgbFromHsl { color }
            | Self::HslFromRgb { color }
            | Self::Curves { color, .. } => smallvec![color],
            Self::Ramp { factor, .. } => smallvec![factor],
            Self::Fresnel { ior, normal } => smallvec![ior, normal],
            Self::Tangent { generated, .. } => smallvec![generated],
            Self::LayerWeight { blend, normal, .. } => smallvec![blend, normal],
            Self::NormalMap { color, strength, .. } => smallvec![color, strength],
            Self::Bump { strength, distance, height, height_x, height_y, normal, .. } => {
                smallvec![strength, distance, height, height_x, height_y, normal]
            }
            Self::Checker { vector, color1, color2, scale } => smallvec![vector, color1, color2, scale],
            Self::Pattern { ref inputs, .. } => inputs.iter().copied().collect(),
        }
    }

    /// What is wrong with instruction number `index` of a program; `textures` is how many there are.
    pub(super) fn fault(&self, index: usize, textures: usize) -> Option<String> {
        if let Some(register) = self.operands().into_iter().find(|&register| register as usize >= index) {
            return Some(format!("instruction {index} reads register {register}, which is not known yet"));
        }
        match *self {
            Self::Attribute { aside: Aside(widths), .. } | Self::Geometry { aside: Aside(widths), .. }
                if !widths.iter().all(|width| (0.0..=MOST_WIDTHS).contains(width)) =>
            {
                Some(format!("instruction {index} is {widths:?} widths aside"))
            }
            Self::Bump { filter_width, .. } if !(0.0..=MOST_WIDTHS).contains(&filter_width) => {
                Some(format!("instruction {index} has a filter width of {filter_width}"))
            }
            Self::Image { texture, .. } | Self::BoxImage { texture, .. } if texture as usize >= textures => {
                Some(format!("instruction {index} reads texture {texture} of {textures}"))
            }
            Self::TiledImage { ref tiles, .. } => {
                let bad = tiles.iter().find(|tile| tile.texture as usize >= textures)?;
                Some(format!("instruction {index} reads texture {} of {textures}", bad.texture))
            }
            Self::Channel { channel, .. } if channel > 2 => {
                Some(format!("instruction {index} takes channel {channel} of three"))
            }
            Self::Ramp { ref table, .. } | Self::Curves { ref table, .. } if table.len() < 2 => {
                Some(format!("instruction {index} has a table of {} rows; it needs two", table.len()))
            }
            Self::Pattern { ref pattern, ref inputs } if inputs.len() != pattern.input_count() => Some(
                format!("instruction {index} has {} inputs, not {}", inputs.len(), pattern.input_count()),
            ),
            Self::Pattern { ref pattern, .. } => pattern.fault(),
            Self::PhotometricWeb { ref web, .. } => web.fault(),
            _ => None,
        }
    }
}

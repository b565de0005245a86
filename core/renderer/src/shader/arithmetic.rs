//! The arithmetic of Blender's value, vector and color nodes. Every function is total: what has no result is 0, as in
//! Blender.

use glam::{Vec3, Vec4, Vec4Swizzles};
use serde::Deserialize;

/// Operations of the Math node.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "SCREAMING_SNAKE_CASE")]
#[expect(missing_docs, reason = "the names are Blender's")]
pub enum MathFunction {
    Add,
    Subtract,
    Multiply,
    Divide,
    MultiplyAdd,
    Power,
    Logarithm,
    Sqrt,
    InverseSqrt,
    Absolute,
    Exponent,
    Minimum,
    Maximum,
    LessThan,
    GreaterThan,
    Sign,
    Compare,
    SmoothMin,
    SmoothMax,
    Round,
    Floor,
    Ceil,
    Trunc,
    Fract,
    Modulo,
    FlooredModulo,
    Wrap,
    Snap,
    Pingpong,
    Sine,
    Cosine,
    Tangent,
    Arcsine,
    Arccosine,
    Arctangent,
    Arctan2,
    Sinh,
    Cosh,
    Tanh,
    Radians,
    Degrees,
}

/// The Math node.
#[must_use]
pub(super) fn math(function: MathFunction, a: f32, b: f32, c: f32) -> f32 {
    use MathFunction as F;
    match function {
        F::Add => a + b,
        F::Subtract => a - b,
        F::Multiply => a * b,
        F::Divide => divide(a, b),
        F::MultiplyAdd => a * b + c,
        F::Power => power(a, b),
        F::Logarithm if a > 0.0 && b > 0.0 && b != 1.0 => a.ln() / b.ln(),
        F::Sqrt => a.max(0.0).sqrt(),
        F::InverseSqrt if a > 0.0 => 1.0 / a.sqrt(),
        F::Logarithm | F::InverseSqrt => 0.0,
        F::Absolute => a.abs(),
        F::Exponent => a.min(88.0).exp(),
        F::Minimum => a.min(b),
        F::Maximum => a.max(b),
        F::LessThan => f32::from(u8::from(a < b)),
        F::GreaterThan => f32::from(u8::from(a > b)),
        F::Sign => f32::from(i8::from(a > 0.0) - i8::from(a < 0.0)),
        F::Compare => f32::from(u8::from((a - b).abs() <= c.max(1e-5))),
        F::SmoothMin => smooth_min(a, b, c),
        F::SmoothMax => -smooth_min(-a, -b, c),
        F::Round => (a + 0.5).floor(),
        F::Floor => a.floor(),
        F::Ceil => a.ceil(),
        F::Trunc => a.trunc(),
        F::Fract => a - a.floor(),
        F::Modulo if b != 0.0 => a % b,
        F::FlooredModulo if b != 0.0 => a - b * (a / b).floor(),
        F::Modulo | F::FlooredModulo => 0.0,
        F::Wrap => wrap(a, b, c),
        F::Snap => divide(a, b).floor() * b,
        F::Pingpong if b != 0.0 => (wrap(a - b, 2.0 * b, 0.0) - b).abs(),
        F::Pingpong => 0.0,
        F::Sine => a.sin(),
        F::Cosine => a.cos(),
        F::Tangent => a.tan(),
        F::Arcsine if a.abs() <= 1.0 => a.asin(),
        F::Arccosine if a.abs() <= 1.0 => a.acos(),
        F::Arcsine | F::Arccosine => 0.0,
        F::Arctangent => a.atan(),
        F::Arctan2 => a.atan2(b),
        F::Sinh => a.sinh(),
        F::Cosh => a.cosh(),
        F::Tanh => a.tanh(),
        F::Radians => a.to_radians(),
        F::Degrees => a.to_degrees(),
    }
}

fn divide(a: f32, b: f32) -> f32 {
    if b == 0.0 { 0.0 } else { a / b }
}

fn power(a: f32, b: f32) -> f32 {
    if a < 0.0 && b != b.trunc() { 0.0 } else { a.powf(b) }
}

fn wrap(value: f32, high: f32, low: f32) -> f32 {
    let span = high - low;
    if span == 0.0 { low } else { value - span * ((value - low) / span).floor() }
}

/// Minimum with a rounded corner of width `c` (Quilez's cubic).
fn smooth_min(a: f32, b: f32, c: f32) -> f32 {
    if c == 0.0 {
        return a.min(b);
    }
    let h = (c - (a - b).abs()).max(0.0) / c;
    a.min(b) - h * h * h * c * (1.0 / 6.0)
}

/// Operations of the Vector Math node.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "SCREAMING_SNAKE_CASE")]
#[expect(missing_docs, reason = "the names are Blender's")]
pub enum VectorFunction {
    Add,
    Subtract,
    Multiply,
    Divide,
    MultiplyAdd,
    CrossProduct,
    Project,
    Reflect,
    Refract,
    Faceforward,
    DotProduct,
    Distance,
    Length,
    Scale,
    Normalize,
    Absolute,
    Power,
    Sign,
    Minimum,
    Maximum,
    Floor,
    Ceil,
    Fraction,
    Modulo,
    Wrap,
    Snap,
    Sine,
    Cosine,
    Tangent,
}

/// The Vector Math node; numbers (Scale's factor, Refract's index) are the first channel of `c`, results that are numbers in
/// every channel.
#[must_use]
pub(super) fn vector_math(function: VectorFunction, a: Vec3, b: Vec3, c: Vec3) -> Vec3 {
    use MathFunction as F;
    use VectorFunction as V;
    let each = |function: F| {
        Vec3::new(math(function, a.x, b.x, c.x), math(function, a.y, b.y, c.y), math(function, a.z, b.z, c.z))
    };
    match function {
        V::Add => a + b,
        V::Subtract => a - b,
        V::Multiply => a * b,
        V::Divide => each(F::Divide),
        V::MultiplyAdd => a * b + c,
        V::CrossProduct => a.cross(b),
        V::Project => {
            let squared = b.length_squared();
            if squared == 0.0 { Vec3::ZERO } else { b * (a.dot(b) / squared) }
        }
        V::Reflect => {
            let n = b.normalize_or_zero();
            a - n * (2.0 * a.dot(n))
        }
        V::Refract => {
            let (n, eta) = (b.normalize_or_zero(), c.x);
            let along = n.dot(a);
            let k = 1.0 - eta * eta * (1.0 - along * along);
            if k < 0.0 { Vec3::ZERO } else { a * eta - n * (eta * along + k.sqrt()) }
        }
        V::Faceforward => {
            if c.dot(b) < 0.0 {
                a
            } else {
                -a
            }
        }
        V::DotProduct => Vec3::splat(a.dot(b)),
        V::Distance => Vec3::splat(a.distance(b)),
        V::Length => Vec3::splat(a.length()),
        V::Scale => a * c.x,
        V::Normalize => a.normalize_or_zero(),
        V::Absolute => a.abs(),
        V::Power => each(F::Power),
        V::Sign => each(F::Sign),
        V::Minimum => a.min(b),
        V::Maximum => a.max(b),
        V::Floor => a.floor(),
        V::Ceil => a.ceil(),
        V::Fraction => a - a.floor(),
        V::Modulo => each(F::Modulo),
        V::Wrap => each(F::Wrap),
        V::Snap => each(F::Snap),
        V::Sine => each(F::Sine),
        V::Cosine => each(F::Cosine),
        V::Tangent => each(F::Tangent),
    }
}

/// Blend types of the Mix node for colors.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "SCREAMING_SNAKE_CASE")]
#[expect(missing_docs, reason = "the names are Blender's")]
pub enum BlendMode {
    Mix,
    Darken,
    Multiply,
    Burn,
    Lighten,
    Screen,
    Dodge,
    Add,
    Overlay,
    SoftLight,
    LinearLight,
    Difference,
    Exclusion,
    Subtract,
    Divide,
    Hue,
    Saturation,
    Color,
    Value,
}

/// The Mix node for colors; the alpha is `a`'s.
#[must_use]
pub(super) fn blend(mode: BlendMode, factor: f32, a: Vec4, b: Vec4) -> Vec4 {
    let mixed = match mode {
        BlendMode::Hue | BlendMode::Saturation | BlendMode::Color | BlendMode::Value => {
            blend_hsv(mode, factor, a.xyz(), b.xyz())
        }
        _ => Vec3::from_array(std::array::from_fn(|i| blend_channel(mode, factor, a[i], b[i]))),
    };
    mixed.extend(a.w)
}

fn blend_channel(mode: BlendMode, t: f32, a: f32, b: f32) -> f32 {
    let s = 1.0 - t;
    match mode {
        BlendMode::Darken => a.min(b) * t + a * s,
        BlendMode::Multiply => a * (s + t * b),
        BlendMode::Burn => {
            let left = s + t * b;
            if left <= 0.0 { 0.0 } else { (1.0 - (1.0 - a) / left).clamp(0.0, 1.0) }
        }
        BlendMode::Lighten => a.max(b) * t + a * s,
        BlendMode::Screen => 1.0 - (s + t * (1.0 - b)) * (1.0 - a),
        BlendMode::Dodge => {
            let left = 1.0 - t * b;
            if a == 0.0 {
                0.0
            } else if left <= 0.0 {
                1.0
            } else {
                (a / left).min(1.0)
            }
        }
        BlendMode::Add => a + t * b,
        BlendMode::Overlay if a < 0.5 => a * (s + 2.0 * t * b),
        BlendMode::Overlay => 1.0 - (s + 2.0 * t * (1.0 - b)) * (1.0 - a),
        BlendMode::SoftLight => {
            let screen = 1.0 - (1.0 - b) * (1.0 - a);
            s * a + t * ((1.0 - a) * b * a + a * screen)
        }
        BlendMode::LinearLight => a + t * (2.0 * (b - 0.5)),
        BlendMode::Difference => s * a + t * (a - b).abs(),
        BlendMode::Exclusion => (s * a + t * (a + b - 2.0 * a * b)).max(0.0),
        BlendMode::Subtract => a - t * b,
        BlendMode::Divide if b == 0.0 => a,
        BlendMode::Divide => s * a + t * a / b,
        _ => s * a + t * b,
    }
}

fn blend_hsv(mode: BlendMode, t: f32, a: Vec3, b: Vec3) -> Vec3 {
    let (of_a, of_b) = (hsv_from_rgb(a), hsv_from_rgb(b));
    match mode {
        BlendMode::Hue if of_b.y != 0.0 => a.lerp(rgb_from_hsv(Vec3::new(of_b.x, of_a.y, of_a.z)), t),
        BlendMode::Color if of_b.y != 0.0 => a.lerp(rgb_from_hsv(Vec3::new(of_b.x, of_b.y, of_a.z)), t),
        BlendMode::Saturation if of_a.y != 0.0 => {
            rgb_from_hsv(Vec3::new(of_a.x, of_a.y + (of_b.y - of_a.y) * t, of_a.z))
        }
        BlendMode::Value => rgb_from_hsv(Vec3::new(of_a.x, of_a.y, of_a.z + (of_b.z - of_a.z) * t)),
        _ => a,
    }
}

/// Hue, saturation and value.
#[must_use]
pub(super) fn hsv_from_rgb(rgb: Vec3) -> Vec3 {
    let (high, low) = (rgb.max_element(), rgb.min_element());
    let delta = high - low;
    let saturation = if high == 0.0 { 0.0 } else { delta / high };
    Vec3::new(if saturation == 0.0 { 0.0 } else { hue(rgb, high, delta) }, saturation, high)
}

fn hue(rgb: Vec3, high: f32, delta: f32) -> f32 {
    let c = (Vec3::splat(high) - rgb) / delta;
    let sixths = if rgb.x == high {
        c.z - c.y
    } else if rgb.y == high {
        2.0 + c.x - c.z
    } else {
        4.0 + c.y - c.x
    };
    (sixths / 6.0).rem_euclid(1.0)
}

/// Red, green and blue of hue, saturation and value.
#[must_use]
pub(super) fn rgb_from_hsv(hsv: Vec3) -> Vec3 {
    pure_hue(hsv.x).map(|c| (1.0 - hsv.y + hsv.y * c) * hsv.z)
}

fn pure_hue(hue: f32) -> Vec3 {
    let h = hue.rem_euclid(1.0) * 6.0;
    Vec3::new((h - 3.0).abs() - 1.0, 2.0 - (h - 2.0).abs(), 2.0 - (h - 4.0).abs())
        .clamp(Vec3::ZERO, Vec3::ONE)
}

/// Hue, saturation and lightness.
#[must_use]
pub(super) fn hsl_from_rgb(rgb: Vec3) -> Vec3 {
    let (high, low) = (rgb.max_element(), rgb.min_element());
    let (delta, lightness) = (high - low, ((high + low) * 0.5).min(1.0));
    if delta == 0.0 {
        return Vec3::new(0.0, 0.0, lightness);
    }
    let saturation = if lightness > 0.5 { delta / (2.0 - high - low) } else { delta / (high + low) };
    Vec3::new(hue(rgb, high, delta), saturation, lightness)
}

/// Red, green and blue of hue, saturation and lightness.
#[must_use]
pub(super) fn rgb_from_hsl(hsl: Vec3) -> Vec3 {
    let chroma = (1.0 - (2.0 * hsl.z - 1.0).abs()) * hsl.y;
    pure_hue(hsl.x).map(|c| (c - 0.5) * chroma + hsl.z)
}

/// The Hue/Saturation/Value node at factor 1.
#[must_use]
pub(super) fn hue_saturation(color: Vec3, hue: f32, saturation: f32, value: f32) -> Vec3 {
    let hsv = hsv_from_rgb(color);
    let changed = Vec3::new((hsv.x + hue + 0.5).fract(), (hsv.y * saturation).clamp(0.0, 1.0), hsv.z * value);
    rgb_from_hsv(changed).max(Vec3::ZERO)
}

/// Relative luminance of a linear Rec. 709 color (ITU-R BT.709).
#[must_use]
pub(super) fn luminance(color: Vec3) -> f32 {
    color.dot(Vec3::new(0.2126, 0.7152, 0.0722))
}

/// Rotation by Euler angles in the order X, Y, Z, of a point that is scaled before and moved after: the Mapping node.
#[must_use]
pub(super) fn mapped(p: Vec3, location: Vec3, rotation: Vec3, scale: Vec3) -> Vec3 {
    let rotation = glam::Quat::from_euler(glam::EulerRot::ZYX, rotation.z, rotation.y, rotation.x);
    rotation * (p * scale) + location
}

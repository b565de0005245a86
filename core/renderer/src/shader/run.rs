//! Running a program at a point.

use glam::{Vec3, Vec4, Vec4Swizzles};
use smallvec::SmallVec;

use super::arithmetic::{self, BlendMode, MathFunction, VectorFunction};
use super::instruction::{Instruction, Register, Tile};
use super::surface::{self, BumpHeights};
use super::texture::Texture;
use super::{Point, Program, Registers, Value, panorama, pattern};

/// What is seen where a tiled image has no tile, as in Cycles.
const NO_TILE: Vec4 = Vec4::new(1.0, 0.0, 1.0, 1.0);

impl Program {
    /// Every register at `point`.
    #[must_use]
    pub fn run(&self, point: &impl Point, textures: &[Texture]) -> Registers {
        let mut registers = Registers::with_capacity(self.0.len());
        for instruction in &self.0 {
            let value = execute(instruction, &registers, point, textures);
            registers.push(value);
        }
        registers
    }
}

/// Results so far, by the register an operand names.
struct Operands<'a>(&'a [Value]);

impl Operands<'_> {
    #[inline]
    fn value(&self, register: Register) -> Value {
        self.0[register as usize]
    }

    #[inline]
    fn vector(&self, register: Register) -> Vec3 {
        self.value(register).v.xyz()
    }

    #[inline]
    fn number(&self, register: Register) -> f32 {
        self.value(register).v.x
    }

    #[inline]
    fn width(&self, register: Register) -> f32 {
        self.value(register).width
    }
}

fn execute(
    instruction: &Instruction,
    registers: &[Value],
    point: &impl Point,
    textures: &[Texture],
) -> Value {
    let r = Operands(registers);
    match *instruction {
        Instruction::Constant { value } => Value { v: Vec4::from_array(value), width: 0.0 },
        Instruction::Attribute { attribute, aside } => point.attribute(attribute, aside),
        Instruction::ObjectAttribute { attribute } => {
            Value { v: point.object_attribute(attribute), width: 0.0 }
        }
        Instruction::Geometry { quantity, aside } => point.geometry(quantity, aside),
        Instruction::Image { texture, vector, extension, interpolation, unassociate } => {
            let at = r.value(vector);
            let texture = &textures[texture as usize];
            let v = texture.color([at.v.x, at.v.y], at.width, extension, interpolation, unassociate);
            Value { v, width: 0.0 }
        }
        Instruction::TiledImage { ref tiles, vector, extension, interpolation, unassociate } => {
            let at = r.value(vector);
            let (column, row) = (at.v.x.floor(), at.v.y.floor());
            let holds = |tile: &&Tile| tile.column as f32 == column && tile.row as f32 == row;
            let color = |tile: &Tile| {
                let texture = &textures[tile.texture as usize];
                let place = [at.v.x - column, at.v.y - row];
                texture.color(place, at.width, extension, interpolation, unassociate)
            };
            Value { v: tiles.iter().find(holds).map_or(NO_TILE, color), width: 0.0 }
        }
        Instruction::BoxImage { texture, vector, normal, blend, extension, interpolation, unassociate } => {
            let at = r.value(vector);
            let texture = &textures[texture as usize];
            let color = |at2: [f32; 2]| texture.color(at2, at.width, extension, interpolation, unassociate);
            Value { v: surface::box_projected(at.v.xyz(), r.vector(normal), blend, color), width: 0.0 }
        }
        Instruction::Math { function, a, b, c } => math(function, &r, [a, b, c]),
        Instruction::VectorMath { function, a, b, c } => vector_math(function, &r, [a, b, c]),
        Instruction::Mix { factor, a, b } => {
            let (t, a, b) = (r.value(factor).v, r.value(a), r.value(b));
            Value { v: a.v + (b.v - a.v) * t, width: a.width.max(b.width) }
        }
        Instruction::Blend { mode, factor, a, b } => {
            blended(mode, r.number(factor), &r.value(a), &r.value(b))
        }
        Instruction::Transform { .. }
        | Instruction::Mapping { .. }
        | Instruction::Normalize { .. }
        | Instruction::Panorama { .. }
        | Instruction::SunDisk { .. }
        | Instruction::PhotometricWeb { .. }
        | Instruction::Combine { .. }
        | Instruction::Alpha { .. }
        | Instruction::Channel { .. }
        | Instruction::Luminance { .. }
        | Instruction::Mean { .. } => vectors(instruction, &r),
        Instruction::Fresnel { .. }
        | Instruction::LayerWeight { .. }
        | Instruction::Tangent { .. }
        | Instruction::UvTangent { .. }
        | Instruction::NormalMap { .. }
        | Instruction::Bump { .. } => at_surface(instruction, &r, point),
        _ => colors(instruction, &r),
    }
}

/// Instructions that take vectors apart or move them.
fn vectors(instruction: &Instruction, r: &Operands<'_>) -> Value {
    match *instruction {
        Instruction::Transform { vector, rows } => {
            let p = r.vector(vector).extend(1.0);
            let rows = rows.map(Vec4::from_array);
            let v = Vec3::from_array(rows.map(|row| row.dot(p)));
            let scale = (rows.iter().map(|row| row.xyz().length_squared()).sum::<f32>() / 3.0).sqrt();
            Value { v: v.extend(1.0), width: r.width(vector) * scale }
        }
        Instruction::Mapping { vector, location, rotation, scale } => {
            let size = r.vector(scale);
            let v = arithmetic::mapped(r.vector(vector), r.vector(location), r.vector(rotation), size);
            Value { v: v.extend(1.0), width: r.width(vector) * size.abs().max_element() }
        }
        Instruction::Normalize { vector } => Value::vector(r.vector(vector).normalize_or_zero()),
        Instruction::Panorama { vector, projection } => panorama::place(r.value(vector), projection),
        Instruction::SunDisk { vector, towards, radius, bottom, top, lowest } => {
            let disk = panorama::SunDisk { towards, radius, bottom, top, lowest };
            disk.seen(r.value(vector))
        }
        Instruction::PhotometricWeb { vector, ref web } => Value::number(web.intensity(r.vector(vector))),
        Instruction::Combine { x, y, z } => {
            let v = Vec3::new(r.number(x), r.number(y), r.number(z));
            Value { v: v.extend(1.0), width: r.width(x).max(r.width(y)).max(r.width(z)) }
        }
        Instruction::Alpha { of } => Value::number(r.value(of).v.w),
        Instruction::Channel { of, channel } => {
            Value { v: Vec4::splat(r.vector(of)[usize::from(channel)]), width: r.width(of) }
        }
        Instruction::Luminance { of } => Value::number(arithmetic::luminance(r.vector(of))),
        Instruction::Mean { of } => {
            Value { v: Vec4::splat(r.vector(of).element_sum() / 3.0), width: r.width(of) }
        }
        _ => Value::default(),
    }
}

/// Instructions on colors.
fn colors(instruction: &Instruction, r: &Operands<'_>) -> Value {
    let (v, alpha) = match *instruction {
        Instruction::Clamp { value, low, high } => {
            let x = r.value(value);
            return Value { v: x.v.max(r.value(low).v).min(r.value(high).v), width: x.width };
        }
        Instruction::Ramp { factor, ref table, stepped } => {
            return Value { v: ramp(r.number(factor), table, stepped), width: 0.0 };
        }
        Instruction::Checker { vector, color1, color2, scale } => {
            let first = pattern::checker(r.vector(vector) * r.number(scale));
            let color = r.vector(if first { color1 } else { color2 });
            (color, f32::from(u8::from(first)))
        }
        Instruction::Gradient { vector, shape } => {
            return Value::number(pattern::gradient(shape, r.vector(vector)));
        }
        Instruction::Pattern { ref pattern, ref inputs } => {
            let inputs: SmallVec<[Vec4; 10]> = inputs.iter().map(|&register| r.value(register).v).collect();
            return Value { v: pattern.color(&inputs), width: 0.0 };
        }
        Instruction::Gamma { color, gamma } => {
            let power = r.number(gamma);
            (r.vector(color).map(|c| if c > 0.0 { c.powf(power) } else { c }), r.value(color).v.w)
        }
        Instruction::BrightContrast { color, bright, contrast } => {
            let contrast = r.number(contrast);
            let offset = r.number(bright) - contrast * 0.5;
            ((r.vector(color) * (1.0 + contrast) + offset).max(Vec3::ZERO), r.value(color).v.w)
        }
        Instruction::HueSaturation { color, hue, saturation, value } => {
            let changes = [r.number(hue), r.number(saturation), r.number(value)];
            (
                arithmetic::hue_saturation(r.vector(color), changes[0], changes[1], changes[2]),
                r.value(color).v.w,
            )
        }
        Instruction::RgbFromHsv { color } => (arithmetic::rgb_from_hsv(r.vector(color)), 1.0),
        Instruction::HsvFromRgb { color } => (arithmetic::hsv_from_rgb(r.vector(color)), 1.0),
        Instruction::RgbFromHsl { color } => (arithmetic::rgb_from_hsl(r.vector(color)), 1.0),
        Instruction::HslFromRgb { color } => (arithmetic::hsl_from_rgb(r.vector(color)), 1.0),
        Instruction::Curves { color, ref table, low, high } => {
            let color = r.vector(color);
            (Vec3::from_array(std::array::from_fn(|i| curve(color[i], table, i, low, high))), 1.0)
        }
        _ => (Vec3::ZERO, 1.0),
    };
    Value { v: v.extend(alpha), width: 0.0 }
}

/// Instructions that look at the surface.
fn at_surface(instruction: &Instruction, r: &Operands<'_>, point: &impl Point) -> Value {
    match *instruction {
        Instruction::Fresnel { ior, normal } => {
            Value::number(surface::fresnel(point, r.number(ior), r.vector(normal)))
        }
        Instruction::LayerWeight { blend, normal, facing } => {
            Value::number(surface::layer_weight(point, r.number(blend), r.vector(normal), facing))
        }
        Instruction::Tangent { generated, axis } => {
            Value::vector(surface::tangent(point, r.vector(generated), axis))
        }
        Instruction::UvTangent { attribute } => Value::vector(surface::uv_tangent(point, attribute)),
        Instruction::NormalMap { color, strength, space, attribute } => {
            Value::vector(surface::normal_map(point, r.vector(color), r.number(strength), space, attribute))
        }
        Instruction::Bump {
            strength,
            distance,
            height,
            height_x,
            height_y,
            normal,
            invert,
            filter_width,
        } => {
            let heights = BumpHeights {
                here: r.number(height),
                aside: [r.number(height_x), r.number(height_y)],
                filter_width,
                distance: if invert { -r.number(distance) } else { r.number(distance) },
            };
            Value::vector(surface::bump(point, &heights, r.number(strength), r.vector(normal)))
        }
        _ => Value::default(),
    }
}

fn math(function: MathFunction, r: &Operands<'_>, [a, b, c]: [Register; 3]) -> Value {
    let (x, y, z) = (r.number(a), r.number(b), r.number(c));
    let (of_x, of_y) = (r.width(a), r.width(b));
    let width = match function {
        MathFunction::Multiply => (x * of_y).abs() + (y * of_x).abs(),
        MathFunction::MultiplyAdd => (x * of_y).abs() + (y * of_x).abs() + r.width(c),
        MathFunction::Divide if y != 0.0 => (of_x / y).abs(),
        MathFunction::Add | MathFunction::Subtract => of_x + of_y,
        _ => of_x.max(of_y),
    };
    Value { v: Vec4::splat(arithmetic::math(function, x, y, z)), width }
}

fn vector_math(function: VectorFunction, r: &Operands<'_>, [a, b, c]: [Register; 3]) -> Value {
    let (x, y, z) = (r.vector(a), r.vector(b), r.vector(c));
    let (of_x, of_y) = (r.width(a), r.width(b));
    let most = |v: Vec3| v.abs().max_element();
    let width = match function {
        VectorFunction::Multiply => most(x) * of_y + most(y) * of_x,
        VectorFunction::MultiplyAdd => most(x) * of_y + most(y) * of_x + r.width(c),
        VectorFunction::Divide if y.abs().min_element() > 0.0 => of_x / y.abs().min_element(),
        VectorFunction::Scale => of_x * z.x.abs(),
        VectorFunction::Normalize if x.length() > 0.0 => of_x / x.length(),
        _ => of_x.max(of_y),
    };
    Value { v: arithmetic::vector_math(function, x, y, z).extend(1.0), width }
}

fn blended(mode: BlendMode, factor: f32, a: &Value, b: &Value) -> Value {
    Value { v: arithmetic::blend(mode, factor, a.v, b.v), width: a.width.max(b.width) }
}

/// The color of `table` at `factor`, which is kept within 0 and 1.
fn ramp(factor: f32, table: &[[f32; 4]], stepped: bool) -> Vec4 {
    let last = table.len() - 1;
    let x = factor.clamp(0.0, 1.0) * last as f32;
    let i = (x as usize).min(last);
    let low = Vec4::from_array(table[i]);
    if stepped || i == last {
        return low;
    }
    low + (Vec4::from_array(table[i + 1]) - low) * (x - i as f32)
}

/// One column of `table` between `low` and `high`, and straight on beyond.
fn curve(x: f32, table: &[[f32; 4]], column: usize, low: f32, high: f32) -> f32 {
    let last = table.len() - 1;
    let t = (x - low) / (high - low) * last as f32;
    let i = (t.max(0.0) as usize).min(last - 1);
    table[i][column] + (table[i + 1][column] - table[i][column]) * (t - i as f32)
}

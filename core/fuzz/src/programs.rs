//! Programs, the textures they read and the points they are run for.

use ciborium::Value as Cbor;
use glam::{Vec3, Vec4};
use rgp_renderer::shader::{Aside, Encoding, Instruction, Pixels, Point, Quantity, Texture, Value};

use crate::draw::Draw;
use crate::records::{Known, read, value};
use crate::shapes::INSTRUCTION;

/// Up to `most` instructions as records, whose operands nearly always come before them.
pub fn instruction_records(draw: &mut Draw<'_>, most: usize, textures: usize) -> Vec<Cbor> {
    let mut registers = 0;
    draw.list(most, |draw| {
        registers += 1;
        value(draw, INSTRUCTION, Known { registers: registers - 1, textures })
    })
}

/// The same, read.
pub fn instructions(draw: &mut Draw<'_>, most: usize, textures: usize) -> Vec<Instruction> {
    instruction_records(draw, most, textures).iter().map(read).collect()
}

/// An image of up to 6 × 6 texels, sometimes more or fewer than its size says.
///
/// # Errors
/// The renderer's own.
pub fn texture(draw: &mut Draw<'_>) -> Result<Texture, String> {
    let odd = draw.byte();
    let size = match odd {
        255 => [usize::MAX, 2],
        254 => [1 << 32, 1 << 32],
        _ => [draw.below(7), draw.below(7)],
    };
    let count = if odd > 250 { draw.below(40) } else { size[0] * size[1] };
    let encoding = *draw.choice(&[Encoding::Linear, Encoding::Srgb]);
    let pixels = if draw.flag() {
        Pixels::Floats((0..count).map(|_| draw.singles()).collect())
    } else {
        Pixels::Bytes((0..count).map(|_| draw.bytes()).collect())
    };
    Texture::new(size, pixels, encoding)
}

/// Answers every question with one of few values.
#[derive(Debug)]
pub struct Anywhere {
    answers: [Value; 4],
    steps: [Vec3; 2],
    tangents: Option<[Vec3; 3]>,
}

impl Anywhere {
    /// A point of drawn values.
    pub fn new(draw: &mut Draw<'_>) -> Self {
        let vector = |draw: &mut Draw<'_>| Vec3::from_array(draw.singles());
        Self {
            answers: std::array::from_fn(|_| Value {
                v: Vec4::from_array(draw.singles()),
                width: draw.single(),
            }),
            steps: [vector(draw), vector(draw)],
            tangents: draw.flag().then(|| [vector(draw), vector(draw), vector(draw)]),
        }
    }
}

impl Anywhere {
    fn answer(&self, number: usize, Aside([x, y]): Aside) -> Value {
        let place = usize::from(x > 0.0) + 2 * usize::from(y > 0.0);
        self.answers[(number + place) % self.answers.len()]
    }
}

impl Point for Anywhere {
    fn attribute(&self, attribute: u32, aside: Aside) -> Value {
        self.answer(attribute as usize, aside)
    }

    fn geometry(&self, quantity: Quantity, aside: Aside) -> Value {
        self.answer(quantity as usize, aside)
    }

    fn steps(&self, _widths: f32) -> [Vec3; 2] {
        self.steps
    }

    fn tangents(&self, _attribute: u32) -> Option<[Vec3; 3]> {
        self.tangents
    }

    fn world_normal(&self, normal: Vec3) -> Vec3 {
        normal
    }
}

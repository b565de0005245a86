//! Every program is refused with a message, or runs to its end at any point.
#![no_main]

use libfuzzer_sys::fuzz_target;
use rgp_fuzz::draw::Draw;
use rgp_fuzz::programs::{Anywhere, instructions, texture};
use rgp_renderer::shader::{Program, Texture};

fuzz_target!(|bytes: &[u8]| {
    let mut draw = Draw(bytes);
    let point = Anywhere::new(&mut draw);
    let textures: Vec<Texture> = draw.list(2, texture).into_iter().flatten().collect();
    let instructions = instructions(&mut draw, 12, textures.len());
    let count = instructions.len();
    let Ok(program) = Program::new(instructions, textures.len()) else { return };
    assert_eq!(program.run(&point, &textures).len(), count);
    let _ = program.columns(&textures);
});

//! Every image is refused with a message, or has a color anywhere: one of its own range where its texels have one.
#![no_main]

use libfuzzer_sys::fuzz_target;
use rgp_fuzz::draw::Draw;
use rgp_renderer::shader::{Encoding, Extension, Interpolation, Pixels, Texture};

const EXTENSIONS: [Extension; 4] = [Extension::Repeat, Extension::Extend, Extension::Clip, Extension::Mirror];
const INTERPOLATIONS: [Interpolation; 3] =
    [Interpolation::Closest, Interpolation::Linear, Interpolation::Cubic];

fuzz_target!(|bytes: &[u8]| {
    let mut draw = Draw(bytes);
    let encoding = *draw.choice(&[Encoding::Linear, Encoding::Srgb]);
    let (size, is_odd) = size(&mut draw);
    let count = if is_odd { draw.below(40) } else { size[0] * size[1] };
    let is_bytes = draw.flag();
    let pixels = if is_bytes {
        Pixels::Bytes((0..count).map(|_| draw.bytes()).collect())
    } else {
        Pixels::Floats((0..count).map(|_| draw.singles()).collect())
    };
    let Ok(texture) = Texture::new(size, pixels, encoding) else { return };
    assert!(texture.bytes() <= 2 * count * size_of::<[f32; 4]>() + size_of::<[f32; 4]>());
    for _ in 0..4 {
        let (at, width) = (draw.singles::<2>(), draw.single());
        let (extension, interpolation) = (*draw.choice(&EXTENSIONS), *draw.choice(&INTERPOLATIONS));
        let unassociate = draw.flag();
        let color = texture.color(at, width, extension, interpolation, unassociate);
        if is_bytes && !unassociate && at.iter().all(|x| x.is_finite()) {
            let is_within = color.to_array().iter().all(|c| (-1e-6..=1.000_01).contains(c));
            assert!(is_within, "{color} at {at:?}, {width} wide, {extension:?}, {interpolation:?}");
        }
    }
});

/// Width and height, and whether the count of texels should be another.
fn size(draw: &mut Draw<'_>) -> ([usize; 2], bool) {
    match draw.byte() {
        255 => ([usize::MAX, 2], true),
        254 => ([1 << 32, 1 << 32], true),
        250..254 => ([draw.below(7), draw.below(7)], true),
        _ => ([draw.below(13), draw.below(13)], false),
    }
}

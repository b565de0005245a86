//! Every scene is refused with a message, or keeps what a scene promises.
#![no_main]

use libfuzzer_sys::fuzz_target;
use rgp_fuzz::draw::Draw;
use rgp_fuzz::scenes::scene;
use rgp_fuzz::sound::assert_sound;

fuzz_target!(|bytes: &[u8]| {
    if let Ok(scene) = scene(&mut Draw(bytes)) {
        assert_sound(&scene);
    }
});

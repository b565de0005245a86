//! What decides a picture, as one number.

use std::fmt::{self, Write};
use std::hash::{DefaultHasher, Hasher};
use std::sync::Arc;

use rustc_hash::FxHashMap;

use crate::scene::{Mesh, Object, Scene};
use crate::settings::RenderSettings;

/// A number that is the same for two renders only if they make the same picture, passes that are left out aside. It changes
/// with the version of this crate too.
#[must_use]
pub fn fingerprint(scene: &Scene, settings: &RenderSettings) -> u64 {
    let mut settings = settings.clone();
    // What only decides how a picture is made, or how soon it ends.
    settings.render.threads = 0;
    settings.film.tile_size = 0;
    settings.gather.audit = 0;
    settings.gather.time_limit = 0.0;
    settings.gather.error_target = 0.0;

    let Scene { space, objects, materials, textures, lamps, camera, world, bounds, problems: _ } = scene;
    let mut printed = Printed(DefaultHasher::new());
    printed.add(&(env!("CARGO_PKG_VERSION"), settings, space, materials, textures));
    printed.add(&(lamps, camera, world, bounds));
    // Each mesh once, however many instances there are of it.
    let mut numbers: FxHashMap<*const Mesh, usize> = FxHashMap::default();
    for object in objects {
        let Object {
            name,
            mesh,
            scene_from_mesh,
            motion,
            object_from_scene,
            info,
            materials,
            visibility,
            receiver,
            links,
        } = object;
        printed.add(&(name, scene_from_mesh, motion, object_from_scene, info, materials));
        printed.add(&(visibility, receiver, links));
        let count = numbers.len();
        let number = *numbers.entry(Arc::as_ptr(mesh)).or_insert(count);
        printed.add(&number);
        if number == count {
            printed.add(mesh);
        }
    }
    printed.0.finish()
}

/// Hashes what is printed: every field of everything, and every number to its last bit.
struct Printed(DefaultHasher);

impl Printed {
    fn add(&mut self, value: &impl fmt::Debug) {
        // Nothing that is hashed can fail to be written.
        let _ = write!(self, "{value:?}");
    }
}

impl Write for Printed {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        self.0.write(text.as_bytes());
        Ok(())
    }
}

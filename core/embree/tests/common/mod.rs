//! What the tests share: a device on the Embree library that the `embreex` package carries.
#![allow(dead_code, reason = "each test file uses a part of this module")]

use std::path::{Path, PathBuf};
use std::process::Command;

use rgp_embree::{BuildQuality, CommittedScene, Device, Library, Ray, SceneBuilder};

/// The library named by `RGP_EMBREE_LIBRARY`, else the one of the `embreex` package of the `python3` on the
/// path.
pub(crate) fn library_path() -> PathBuf {
    if let Some(path) = std::env::var_os("RGP_EMBREE_LIBRARY") {
        return path.into();
    }
    let script = "import glob, os, embreex; d = os.path.dirname(embreex.__file__); \
                  print((glob.glob(d + '.libs/*embree4*') + glob.glob(d + '/.dylibs/*embree4*') + [''])[0])";
    let output = Command::new("python3").args(["-c", script]).output();
    let found =
        output.map(|output| String::from_utf8_lossy(&output.stdout).trim().to_owned()).unwrap_or_default();
    assert!(
        Path::new(&found).is_file(),
        "These tests need Embree 4: `pip install embreex`, or set RGP_EMBREE_LIBRARY to the library file."
    );
    found.into()
}

/// The library, opened.
pub(crate) fn library() -> Library {
    Library::open(&library_path()).expect("the Embree library opens")
}

/// A device on two threads.
pub(crate) fn device() -> Device {
    Device::new(&library(), 2).expect("a device")
}

/// A scene of one mesh with id `id`, seen by all rays.
pub(crate) fn mesh_scene(
    device: &Device,
    id: u32,
    positions: &[[f32; 3]],
    triangles: &[[u32; 3]],
) -> CommittedScene {
    let mut builder = SceneBuilder::new(device, BuildQuality::Medium).expect("a builder");
    builder.add_triangles(id, positions, triangles, u32::MAX).expect("a valid mesh");
    commit(builder)
}

/// The committed scene, built without interruption.
pub(crate) fn commit(builder: SceneBuilder) -> CommittedScene {
    builder.commit(&|_| true).expect("a scene")
}

/// A ray seen by everything, without end.
pub(crate) fn ray(origin: [f32; 3], direction: [f32; 3]) -> Ray {
    Ray { origin, direction, t_near: 0.0, t_far: f32::INFINITY, mask: u32::MAX, time: 0.0 }
}

/// Whether a number is the expected one but for its last places: Embree divides by a reciprocal that processors estimate
/// differently, and valgrind differently again.
pub(crate) fn is_close(found: f32, expected: f32) -> bool {
    (found - expected).abs() <= 2.0 * f32::EPSILON * expected.abs()
}

/// A small generator of even random numbers, the same on every machine.
pub(crate) struct Random(pub(crate) u64);

impl Random {
    /// The next number in [-1, 1).
    pub(crate) fn signed(&mut self) -> f32 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 40) as f32 / (1 << 23) as f32 - 1.0
    }

    /// Three of them.
    pub(crate) fn vector(&mut self) -> [f32; 3] {
        [self.signed(), self.signed(), self.signed()]
    }

    /// `count` triangles with corners up to `size` from centers in [-1, 1)³.
    pub(crate) fn soup(&mut self, count: u32, size: f32) -> (Vec<[f32; 3]>, Vec<[u32; 3]>) {
        let mut positions = Vec::new();
        for _ in 0..count {
            let center = self.vector();
            for _ in 0..3 {
                let offset = self.vector();
                positions.push([0, 1, 2].map(|axis| center[axis] + size * offset[axis]));
            }
        }
        (positions, (0..count).map(|index| [3 * index, 3 * index + 1, 3 * index + 2]).collect())
    }
}

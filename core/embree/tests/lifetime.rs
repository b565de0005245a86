//! Handles are given back. Alone in its file, and so in its process, because it watches the process's memory.
#![cfg(target_os = "linux")]

mod common;

use common::{Random, commit, library, mesh_scene};
use rgp_embree::{BuildQuality, Device, SceneBuilder};

/// Memory the process holds, in bytes.
fn resident_bytes() -> usize {
    let status = std::fs::read_to_string("/proc/self/statm").expect("Linux tells");
    let pages = status.split(' ').nth(1).and_then(|pages| pages.parse::<usize>().ok());
    pages.expect("the second number is the resident set") * 4096
}

#[test]
fn scenes_and_devices_come_and_go_without_leaking() {
    let library = library();
    let (positions, triangles) = Random(6).soup(2000, 0.1);
    let identity = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0];
    let cycle = || {
        let device = Device::new(&library, 1).unwrap();
        let mesh = mesh_scene(&device, 0, &positions, &triangles);
        let mut builder = SceneBuilder::new(&device, BuildQuality::Medium).unwrap();
        builder.add_instance(0, &mesh, &identity, u32::MAX).unwrap();
        drop(commit(builder));
    };
    (0..200).for_each(|_| cycle());
    let before = resident_bytes();
    (0..1000).for_each(|_| cycle());
    let grown = resident_bytes().saturating_sub(before);
    // The positions alone of 1000 leaked scenes are 72 MB.
    assert!(grown < 20_000_000, "{grown} bytes more after 1000 scenes");
}

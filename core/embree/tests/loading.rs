//! Opening the library: what it says about itself, and what it says when it cannot be opened.

mod common;

use std::path::{Path, PathBuf};
use std::process::Command;

use common::{device, library, library_path, mesh_scene, ray};
use rgp_embree::{Device, EmbreeError, Library};

#[test]
fn the_library_tells_its_version() {
    let (major, minor, _) = library().version();
    assert!(major == 4 && minor >= 3, "{major}.{minor}");
}

#[test]
fn a_missing_file_is_named() {
    let path = Path::new("no-such-folder/libembree4.so");
    let error = Library::open(path).map(drop).unwrap_err();
    assert!(matches!(&error, EmbreeError::Missing { path: named, .. } if named == path), "{error:?}");
    assert!(error.to_string().contains("no-such-folder"), "{error}");
}

#[test]
fn a_file_that_is_no_library_is_refused() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("Cargo.toml");
    assert!(matches!(Library::open(&path).map(drop), Err(EmbreeError::Missing { .. })));
}

#[test]
fn a_library_that_is_not_embree_is_refused() {
    let folder = library_path().parent().unwrap().to_owned();
    let tbb = std::fs::read_dir(&folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .find(|path| path.file_name().unwrap().to_string_lossy().contains("tbb"))
        .expect("TBB lies beside Embree");
    let error = Library::open(&tbb).map(drop).unwrap_err();
    assert!(matches!(error, EmbreeError::NotEmbree { symbol: "rtcNewDevice", .. }), "{error:?}");
    assert!(error.to_string().ends_with("is not an Embree 4 library: it has no `rtcNewDevice`."), "{error}");
}

/// Makes a library with Embree's entry points that says it is `version` and can do nothing else.
fn impostor(version: [isize; 3]) -> PathBuf {
    const OTHERS: &str = "ReleaseDevice GetDeviceError SetDeviceErrorFunction NewGeometry ReleaseGeometry \
        CommitGeometry SetGeometryMask SetNewGeometryBuffer SetGeometryInstancedScene \
        SetGeometryTransform SetGeometryTimeStepCount NewScene ReleaseScene SetSceneFlags \
        SetSceneBuildQuality AttachGeometryByID SetSceneProgressMonitorFunction CommitScene GetSceneBounds \
        Intersect1 Occluded1 Intersect16 Occluded16";
    let [major, minor, patch] = version;
    let mut source = format!(
        "#![allow(non_snake_case)]
        #[unsafe(no_mangle)] extern \"C\" fn rtcNewDevice() -> usize {{ 1 }}
        #[unsafe(no_mangle)] extern \"C\" fn rtcGetDeviceProperty(_: usize, property: i32) -> isize {{
            [0, {major}, {minor}, {patch}][property as usize]
        }}"
    );
    for name in OTHERS.split_whitespace() {
        source += &format!("#[unsafe(no_mangle)] extern \"C\" fn rtc{name}() -> usize {{ 0 }}\n");
    }
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let (code, library) =
        (folder.join(format!("v{major}{minor}.rs")), folder.join(format!("v{major}{minor}.bin")));
    std::fs::write(&code, source).expect("the target folder can be written");
    let arguments = ["--edition=2024", "--crate-type=cdylib", "-o"];
    let status = Command::new("rustc").args(arguments).args([&library, &code]).status().expect("rustc runs");
    assert!(status.success());
    library
}

#[test]
fn other_versions_of_embree_are_refused() {
    for version in [[3, 13, 5], [4, 2, 0], [5, 0, 0]] {
        let path = impostor(version);
        let error = Library::open(&path).map(drop).unwrap_err();
        let EmbreeError::WrongVersion { path: named, found } = &error else { panic!("{error:?}") };
        assert_eq!((named, [found.0, found.1, found.2]), (&path, version.map(|number| number as u32)));
        assert!(error.to_string().ends_with("needs Embree 4.3 or a later 4.x."), "{error}");
    }
    assert_eq!(Library::open(&impostor([4, 3, 0])).map(|library| library.version()).unwrap(), (4, 3, 0));
}

#[test]
fn libraries_and_devices_live_side_by_side() {
    let devices = [Device::new(&library(), 0).unwrap(), Device::new(&library(), 1).unwrap(), device()];
    for device in &devices {
        let scene = mesh_scene(device, 0, &[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], &[[0, 1, 2]]);
        assert!(scene.occluded(&ray([0.25, 0.25, 1.0], [0.0, 0.0, -1.0])));
    }
}

//! Building scenes: what is refused, what is endured, and that builds can be stopped.

mod common;

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use common::{Random, commit, device, is_close, mesh_scene, ray};
use rgp_embree::{BuildQuality, CommittedScene, Device, EmbreeError, Library, SceneBuilder};

const CORNERS: [[f32; 3]; 3] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];

/// A build long enough to be stopped.
fn big_builder(device: &Device) -> SceneBuilder {
    let (positions, triangles) = Random(1).soup(200_000, 0.01);
    let mut builder = SceneBuilder::new(device, BuildQuality::High).expect("a builder");
    builder.add_triangles(0, &positions, &triangles, u32::MAX).expect("a valid mesh");
    builder
}

#[test]
fn indices_beyond_the_positions_are_refused() {
    let mut builder = SceneBuilder::new(&device(), BuildQuality::Medium).unwrap();
    for triangles in [[[0, 1, 3]], [[u32::MAX, 0, 1]]] {
        let refused = builder.add_triangles(0, &CORNERS, &triangles, u32::MAX).unwrap_err();
        assert!(refused.to_string().contains("there are only 3"), "{refused}");
    }
    builder.add_triangles(0, &CORNERS, &[[0, 1, 2]], u32::MAX).expect("the refused mesh did not take the id");
}

#[test]
fn ids_are_taken_once_and_bounded() {
    let mut builder = SceneBuilder::new(&device(), BuildQuality::Medium).unwrap();
    builder.add_triangles(5, &CORNERS, &[[0, 1, 2]], u32::MAX).unwrap();
    for id in [5, 1 << 26, u32::MAX] {
        let refused = builder.add_triangles(id, &CORNERS, &[[0, 1, 2]], u32::MAX);
        assert!(matches!(refused, Err(EmbreeError::InvalidInput(_))), "{id}: {refused:?}");
    }
}

#[test]
fn a_scene_without_triangles_is_empty() {
    let device = device();
    let nothing = commit(SceneBuilder::new(&device, BuildQuality::High).unwrap());
    let empty_mesh = mesh_scene(&device, 0, &CORNERS, &[]);
    for scene in [nothing, empty_mesh] {
        assert_eq!(scene.intersect(&ray([0.1, 0.1, 1.0], [0.0, 0.0, -1.0])), None);
        assert_eq!(scene.bounds(), [[f32::INFINITY; 3], [f32::NEG_INFINITY; 3]]);
    }
}

#[test]
fn triangles_that_are_not_numbers_are_not_hit_and_spare_the_others() {
    let device = device();
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 1e30] {
        let mut positions = CORNERS.to_vec();
        positions.extend([[bad, 0.0, 1.0], [1.0, bad, 1.0], [0.0, 1.0, bad]]);
        let scene = mesh_scene(&device, 0, &positions, &[[3, 4, 5], [0, 1, 2], [0, 1, 5]]);
        let hit = scene.intersect(&ray([0.25, 0.25, 9.0], [0.0, 0.0, -1.0])).expect("the sound triangle");
        assert_eq!(hit.primitive, 1);
        assert!(is_close(hit.t, 9.0), "{}", hit.t);
        assert_eq!(scene.bounds(), [[0.0; 3], [1.0, 1.0, 0.0]]);
        assert_eq!(mesh_scene(&device, 0, &[[bad; 3]; 3], &[[0, 1, 2]]).bounds()[0], [f32::INFINITY; 3]);
    }
}

#[test]
fn a_build_reports_its_progress() {
    let fractions = Mutex::new(Vec::new());
    big_builder(&device())
        .commit(&|fraction| {
            fractions.lock().unwrap().push(fraction);
            true
        })
        .unwrap();
    let fractions = fractions.into_inner().unwrap();
    assert!(fractions.iter().all(|fraction| (0.0..=1.0).contains(fraction)));
    assert!(
        fractions.iter().any(|&fraction| fraction < 0.2) && fractions.iter().any(|&fraction| fraction > 0.8)
    );
}

#[test]
fn a_build_stops_when_asked_and_the_device_goes_on() {
    let device = device();
    let whole = AtomicUsize::new(0);
    big_builder(&device).commit(&|_| whole.fetch_add(1, Ordering::Relaxed) < usize::MAX).unwrap();
    let calls = AtomicUsize::new(0);
    let stopped = big_builder(&device).commit(&|fraction| {
        calls.fetch_add(1, Ordering::Relaxed);
        fraction < 0.25
    });
    assert!(matches!(stopped.map(drop), Err(EmbreeError::Cancelled)));
    let (calls, whole) = (calls.into_inner(), whole.into_inner());
    assert!(calls < whole * 3 / 4, "{calls} of {whole} steps");
    let after = mesh_scene(&device, 0, &CORNERS, &[[0, 1, 2]]);
    assert!(after.occluded(&ray([0.25, 0.25, 9.0], [0.0, 0.0, -1.0])));
}

#[test]
fn a_panic_in_the_progress_callback_reaches_the_caller() {
    let device = device();
    let builder = big_builder(&device);
    let outcome = catch_unwind(AssertUnwindSafe(|| builder.commit(&|_| panic!("stop here")).map(drop)));
    assert_eq!(outcome.unwrap_err().downcast_ref::<&str>(), Some(&"stop here"));
    big_builder(&device).commit(&|_| true).expect("the panicking build left no error behind");
}

#[test]
fn builds_on_several_threads_keep_their_errors_apart() {
    let device = device();
    std::thread::scope(|scope| {
        for index in 0..8 {
            let device = &device;
            scope.spawn(move || {
                for _ in 0..3 {
                    let stop = index % 2 == 0;
                    let outcome = big_builder(device).commit(&|_| !stop).map(drop);
                    assert_eq!(matches!(outcome, Err(EmbreeError::Cancelled)), stop, "{outcome:?}");
                    assert_eq!(outcome.is_ok(), !stop);
                }
            });
        }
    });
}

#[test]
fn a_scene_keeps_what_it_needs_alive() {
    let scene = {
        let device = device();
        let mesh = mesh_scene(&device, 0, &CORNERS, &[[0, 1, 2]]);
        let mut builder = SceneBuilder::new(&device, BuildQuality::Medium).unwrap();
        let identity = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0];
        builder.add_instance(0, &mesh, &identity, u32::MAX).unwrap();
        commit(builder)
    };
    let scene = std::thread::spawn(move || scene.clone()).join().unwrap();
    assert!(scene.occluded(&ray([0.25, 0.25, 9.0], [0.0, 0.0, -1.0])));
}

#[test]
fn handles_may_cross_threads() {
    fn shared<T: Send + Sync + Clone>() {}
    fn sent<T: Send>() {}
    shared::<Library>();
    shared::<Device>();
    shared::<CommittedScene>();
    sent::<SceneBuilder>();
}

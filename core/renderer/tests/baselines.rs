//! The baselines against closed forms, against each other, and bit for bit against themselves.

mod support;

use std::f64::consts::PI;

use glam::{DVec3, Vec3};
use rgp_renderer::scene::{Scene, SceneBuilder};
use rgp_renderer::settings::{EstimatorKind, RenderSettings};
use support::*;

const ALL: [EstimatorKind; 7] = [
    EstimatorKind::Pyramid,
    EstimatorKind::Pyramid2006,
    EstimatorKind::PhotonMap,
    EstimatorKind::PrecomputedIrradiance,
    EstimatorKind::UniformGrid,
    EstimatorKind::ReversePhotonMap,
    EstimatorKind::Path,
];

fn by(estimator: EstimatorKind, photons: u64, rays: u32) -> RenderSettings {
    let mut settings = settings(photons, 32, rays);
    settings.gather.estimator = estimator;
    settings
}

/// A sphere of albedo 0.6 with a lamp off its center: E = ρ Φ / ((1 − ρ) A), and no edge to be wrong at. Photons per
/// disk are 50 of a million, a disk a hundredth of the radius wide.
#[test]
fn sphere_with_a_lamp_off_its_center() {
    let (albedo, flux) = (0.6, 10.0);
    let ball = sphere(5, 1.0, Vec3::ZERO);
    let exact = albedo / PI * albedo * flux / ((1.0 - albedo) * area(&ball));
    let mut builder = SceneBuilder::default();
    place(&mut builder, ball, &[diffuse(albedo as f32)]);
    builder.add_lamp(point_lamp(flux as f32, DVec3::new(0.3, 0.1, 0.55)));
    builder.set_camera(camera(DVec3::new(-0.4, 0.1, 0.0), DVec3::X, 2.0, 24));
    let scene = builder.finish().expect("a scene");
    for (estimator, tolerance, noise) in [
        (EstimatorKind::Path, 0.005, 0.09),
        (EstimatorKind::PhotonMap, 0.005, 0.03),
        (EstimatorKind::PrecomputedIrradiance, 0.005, 0.03),
        (EstimatorKind::ReversePhotonMap, 0.005, 0.03),
    ] {
        let pixels = render(&scene, &by(estimator, 400_000, 256)).indirect_radiance();
        let (mean, rms) = (mean(&pixels) / exact - 1.0, spread(&pixels, exact));
        assert!(mean.abs() < tolerance && rms < noise, "{estimator:?}: mean {mean:+.4}, rms {rms:.4}");
    }
}

/// A box whose walls emit 1 and reflect half: L = 2 everywhere. Disks that reach round an edge lose light there, cells
/// of the published pyramid that a wall fills in part are dark, and the grid sees both walls of an edge.
#[test]
fn furnace_of_albedo_one_half() {
    let mut builder = SceneBuilder::default();
    let closed = cuboid(Vec3::new(-1.0, -0.7, 0.0), Vec3::new(1.0, 0.7, 1.2));
    place(&mut builder, closed, &[emitter(0.5, 1.0)]);
    builder.set_camera(camera(DVec3::new(-0.8, -0.5, 0.2), DVec3::new(1.0, 0.6, 0.6), 1.5, 24));
    let scene = builder.finish().expect("a scene");
    for (estimator, lowest, highest) in [
        (EstimatorKind::Path, -0.003, 0.003),
        (EstimatorKind::PhotonMap, -0.01, 0.001),
        (EstimatorKind::PrecomputedIrradiance, -0.01, 0.001),
        (EstimatorKind::ReversePhotonMap, -0.01, 0.001),
        (EstimatorKind::UniformGrid, 0.0, 0.03),
        (EstimatorKind::Pyramid2006, -0.1, -0.01),
    ] {
        let error = mean(&render(&scene, &by(estimator, 400_000, 64)).radiance()) / 2.0 - 1.0;
        assert!((lowest..highest).contains(&error), "{estimator:?}: {error:+.4}");
    }
}

/// The floor of `known_answers.rs` that is lit from height ½ and seen from height 1. It fills its cells but at the rim,
/// and shares none with another surface: no method has an excuse.
#[test]
fn one_bounce_off_a_floor() {
    let corner = |i: u32| {
        let (sin, cos) = (std::f32::consts::TAU * i as f32 / 256.0).sin_cos();
        Vec3::new(2.0 * cos, 2.0 * sin, 0.0)
    };
    let mut builder = SceneBuilder::default();
    let disk = soup("disk", (0..256).map(|i| [Vec3::ZERO, corner(i), corner(i + 1)]));
    place(&mut builder, disk, &[diffuse(0.5)]);
    place(&mut builder, floor(0.01, 1.0), &[diffuse(0.8)]);
    builder.add_lamp(point_lamp(4.0 * PI as f32, DVec3::new(0.0, 0.0, 0.5)));
    let receiver = DVec3::new(0.0, 0.0, 1.0);
    builder.set_camera(parallel_camera(receiver - DVec3::Z * 0.1, receiver, 0.005, 24));
    let scene = builder.finish().expect("a scene");
    for estimator in ALL {
        let mut settings = by(estimator, 1_000_000, 256);
        settings.pyramid.finest_resolution = 128;
        let found = mean(&render(&scene, &settings).indirect_radiance());
        let error = found / (0.8 / PI * 0.385_608_62) - 1.0;
        assert!(error.abs() < 0.01, "{estimator:?}: {error:+.4}");
    }
}

/// A plate lit from above, seen from below in the light of its underside: there is none. The grid knows no sides.
#[test]
fn light_does_not_leak_through_a_plate() {
    let mut builder = SceneBuilder::default();
    place(&mut builder, floor(1.0, 0.0), &[diffuse(0.8)]);
    place(&mut builder, floor(0.05, -0.1), &[diffuse(0.8)]);
    builder.add_lamp(point_lamp(10.0, DVec3::new(0.0, 0.0, 0.1)));
    let receiver = DVec3::new(0.0, 0.0, -0.1);
    builder.set_camera(parallel_camera(receiver + DVec3::Z * 0.05, receiver, 0.04, 8));
    let scene = builder.finish().expect("a scene");
    for estimator in ALL {
        let light = mean(&render(&scene, &by(estimator, 100_000, 16)).indirect_radiance());
        assert_eq!(light > 0.0, estimator == EstimatorKind::UniformGrid, "{estimator:?}: {light}");
    }
}

fn room(ball: rgp_renderer::scene::record::MaterialRecord) -> Scene {
    Room { ball, ..Room::default() }.builder().finish().expect("a scene")
}

/// Checks the indirect light of a scene, mean over the picture, against that of paths followed to their end.
fn assert_against_paths(scene: &Scene, allowed: &[(EstimatorKind, f64, f64)]) {
    let indirect = |estimator, rays| mean(&render(scene, &by(estimator, 400_000, rays)).indirect_radiance());
    let truth = indirect(EstimatorKind::Path, 1024);
    for &(estimator, lowest, highest) in allowed {
        let error = indirect(estimator, 128) / truth - 1.0;
        assert!((lowest..highest).contains(&error), "{estimator:?}: {error:+.4}");
    }
}

/// Coarse cells of a grid without normals hold the light of both walls of an edge, and more of a slanted surface than
/// their face; those of the published pyramid are dark where a wall fills them in part.
#[test]
fn all_agree_with_paths_in_a_room() {
    assert_against_paths(
        &room(diffuse(0.5)),
        &[
            (EstimatorKind::Pyramid, -0.01, 0.01),
            (EstimatorKind::PhotonMap, -0.01, 0.01),
            (EstimatorKind::PrecomputedIrradiance, -0.01, 0.01),
            (EstimatorKind::ReversePhotonMap, -0.01, 0.01),
            (EstimatorKind::UniformGrid, 0.02, 0.1),
            (EstimatorKind::Pyramid2006, -0.1, -0.01),
        ],
    );
}

/// Methods that hold directions follow the glossy ball, the others treat it as diffuse.
#[test]
fn all_agree_with_paths_in_a_room_with_a_glossy_ball() {
    assert_against_paths(
        &room(glossy(0.8, 0.7)),
        &[
            (EstimatorKind::Pyramid, -0.01, 0.01),
            (EstimatorKind::PhotonMap, -0.01, 0.01),
            (EstimatorKind::PrecomputedIrradiance, -0.02, 0.02),
            (EstimatorKind::ReversePhotonMap, -0.02, 0.02),
            (EstimatorKind::Pyramid2006, -0.1, -0.01),
        ],
    );
}

/// Seven threads on tiles of 20 pixels against one thread on tiles of 64.
#[test]
fn the_same_bits_for_any_number_of_threads() {
    let scene = Room { ball: glossy(0.8, 0.7), pixels: 37, ..Room::default() }.builder().finish();
    let scene = scene.expect("a scene");
    for estimator in ALL {
        let picture = |threads: u32, tile_size: u32| {
            let mut settings = by(estimator, 50_000, 32);
            settings.render.threads = threads;
            settings.film.tile_size = tile_size;
            render(&scene, &settings)
        };
        let (one, other) = (picture(1, 64), picture(7, 20));
        assert_eq!(one.combined, other.combined, "{estimator:?}");
        assert_eq!(one.stats.rays, other.stats.rays, "{estimator:?}");
        assert_eq!(one.stats.photons, other.stats.photons, "{estimator:?}");
    }
}

/// The same photons for all, and a name and a size for each.
#[test]
fn statistics_tell_them_apart() {
    let scene = room(glossy(0.8, 0.7));
    let photons = |estimator| render(&scene, &by(estimator, 50_000, 8)).stats;
    let pyramid = photons(EstimatorKind::Pyramid);
    assert_eq!((pyramid.estimator.name, pyramid.estimator.bytes), ("pyramid", pyramid.pyramid.bytes));
    for estimator in ALL {
        let stats = photons(estimator);
        let name = serde_json::to_value(estimator).expect("a word");
        assert_eq!(name, stats.estimator.name);
        if estimator == EstimatorKind::Path {
            assert_eq!((stats.rays.photon, stats.estimator.bytes), (0, 0));
            continue;
        }
        assert_eq!(stats.rays.photon, pyramid.rays.photon, "{estimator:?}");
        assert_eq!(stats.photons, pyramid.photons, "{estimator:?}");
        assert!(stats.estimator.bytes > 0 && stats.estimator.seconds > 0.0);
    }
    // 28 bytes a photon, and half a byte of tree.
    let map = photons(EstimatorKind::PhotonMap);
    let per_photon = map.estimator.bytes as f64 / map.photons.deposited as f64;
    assert!((28.0..29.0).contains(&per_photon), "{per_photon}");
}

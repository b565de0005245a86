//! Single rays whose answers are known beforehand.

mod common;

use common::{Random, commit, device, is_close, mesh_scene, ray};
use rgp_embree::{BuildQuality, Ray, SceneBuilder};

const TRIANGLE: [[f32; 3]; 3] = [[0.0, 0.0, 2.0], [4.0, 0.0, 2.0], [0.0, 8.0, 2.0]];

/// A unit square at height `z`, as two triangles.
fn square(z: f32) -> ([[f32; 3]; 4], [[u32; 3]; 2]) {
    ([[0.0, 0.0, z], [1.0, 0.0, z], [1.0, 1.0, z], [0.0, 1.0, z]], [[0, 1, 2], [0, 2, 3]])
}

#[test]
fn a_hit_reports_distance_barycentrics_normal_and_ids() {
    let scene = mesh_scene(&device(), 7, &TRIANGLE, &[[0, 1, 2]]);
    let hit = scene.intersect(&ray([1.0, 2.0, -1.0], [0.0, 0.0, 0.5])).expect("the ray meets the triangle");
    for (found, expected) in [(hit.t, 6.0), (hit.u, 0.25), (hit.v, 0.25)] {
        assert!(is_close(found, expected), "{found} for {expected}");
    }
    assert_eq!(hit.normal, [0.0, 0.0, 32.0]);
    assert_eq!((hit.primitive, hit.object), (0, 7));
}

#[test]
fn the_normal_does_not_turn_towards_the_ray() {
    let scene = mesh_scene(&device(), 0, &TRIANGLE, &[[0, 1, 2]]);
    let hit = scene.intersect(&ray([1.0, 1.0, 5.0], [0.0, 0.0, -1.0])).expect("seen from behind, too");
    assert_eq!(hit.normal, [0.0, 0.0, 32.0]);
}

#[test]
fn rays_that_pass_by_or_away_miss() {
    let scene = mesh_scene(&device(), 0, &TRIANGLE, &[[0, 1, 2]]);
    for miss in [ray([3.0, 7.0, 0.0], [0.0, 0.0, 1.0]), ray([1.0, 1.0, 0.0], [0.0, 0.0, -1.0])] {
        assert_eq!(scene.intersect(&miss), None);
        assert!(!scene.occluded(&miss));
    }
    assert!(scene.occluded(&ray([1.0, 1.0, 0.0], [0.0, 0.0, 1.0])));
}

#[test]
fn only_the_part_between_near_and_far_counts() {
    let scene = mesh_scene(&device(), 0, &TRIANGLE, &[[0, 1, 2]]);
    let up = ray([1.0, 1.0, 0.0], [0.0, 0.0, 1.0]);
    for (t_near, t_far, seen) in [(0.0, 1.9, false), (2.1, 9.0, false), (1.9, 2.1, true)] {
        let part = Ray { t_near, t_far, ..up };
        assert_eq!(scene.intersect(&part).is_some(), seen, "{t_near} to {t_far}");
        assert_eq!(scene.occluded(&part), seen, "{t_near} to {t_far}");
    }
}

#[test]
fn the_nearest_mesh_and_the_right_triangle_are_reported() {
    let mut builder = SceneBuilder::new(&device(), BuildQuality::High).unwrap();
    for (id, z) in [(3, 5.0), (9, 1.0), (4, 3.0)] {
        let (positions, triangles) = square(z);
        builder.add_triangles(id, &positions, &triangles, u32::MAX).unwrap();
    }
    let scene = commit(builder);
    let hit = scene.intersect(&ray([0.25, 0.75, 0.0], [0.0, 0.0, 1.0])).unwrap();
    assert_eq!((hit.object, hit.primitive), (9, 1));
    assert!(is_close(hit.t, 1.0), "{}", hit.t);
    assert_eq!(scene.bounds(), [[0.0, 0.0, 1.0], [1.0, 1.0, 5.0]]);
}

#[test]
fn a_mesh_is_seen_by_rays_that_share_a_mask_bit() {
    let mut builder = SceneBuilder::new(&device(), BuildQuality::Medium).unwrap();
    for (id, z, mask) in [(0, 1.0, 0b001), (1, 2.0, 0b110), (2, 3.0, 1 << 31)] {
        let (positions, triangles) = square(z);
        builder.add_triangles(id, &positions, &triangles, mask).unwrap();
    }
    let scene = commit(builder);
    let up = ray([0.5, 0.25, 0.0], [0.0, 0.0, 1.0]);
    let cases = [(0b001, Some(0)), (0b011, Some(0)), (0b010, Some(1)), (0b100, Some(1)), (1 << 31, Some(2))];
    for (mask, expected) in cases.into_iter().chain([(0b1000, None), (0, None)]) {
        let masked = Ray { mask, ..up };
        assert_eq!(scene.intersect(&masked).map(|hit| hit.object), expected, "mask {mask:b}");
        assert_eq!(scene.occluded(&masked), expected.is_some(), "mask {mask:b}");
    }
}

#[test]
fn no_ray_slips_through_the_seams_of_a_mesh() {
    const SIDE: u32 = 65;
    let mut random = Random(5);
    let mut positions = Vec::new();
    let mut triangles = Vec::new();
    for index in 0..SIDE * SIDE {
        let (column, row) = (index % SIDE, index / SIDE);
        positions.push([column as f32, row as f32, random.signed()]);
        if column + 1 < SIDE && row + 1 < SIDE {
            triangles.extend([[index, index + 1, index + SIDE + 1], [index, index + SIDE + 1, index + SIDE]]);
        }
    }
    let scene = mesh_scene(&device(), 0, &positions, &triangles);
    for _ in 0..200_000 {
        // Down from far above, to a point of an edge inside the mesh.
        let cell = |value: f32| 1 + (value.abs() * (SIDE - 2) as f32) as u32;
        let from = cell(random.signed()) + SIDE * cell(random.signed());
        let [start, end] = [positions[from as usize], positions[(from - 1) as usize]];
        let along = random.signed().abs();
        let target = [0, 1, 2].map(|axis| start[axis] + along * (end[axis] - start[axis]));
        let [x, y, _] = random.vector();
        let origin = [target[0] + 100.0 * x, target[1] + 100.0 * y, 1000.0];
        let query = ray(origin, [0, 1, 2].map(|axis| target[axis] - origin[axis]));
        assert!(scene.intersect(&query).is_some() && scene.occluded(&query), "{query:?}");
    }
}

#[test]
fn rays_that_are_not_numbers_hit_nothing() {
    let (positions, triangles) = Random(1).soup(1000, 0.1);
    let scene = mesh_scene(&device(), 0, &positions, &triangles);
    for bad in [f32::NAN, f32::INFINITY] {
        for broken in [ray([bad; 3], [0.0, 0.0, 1.0]), ray([0.0; 3], [bad; 3]), ray([bad; 3], [bad; 3])] {
            assert_eq!(scene.intersect(&broken), None, "{broken:?}");
        }
    }
    assert_eq!(scene.intersect(&ray([0.0; 3], [0.0; 3])), None);
}

#[test]
fn one_scene_answers_many_threads_alike() {
    let (positions, triangles) = Random(2).soup(5000, 0.2);
    let scene = mesh_scene(&device(), 0, &positions, &triangles);
    let trace = || {
        let mut random = Random(3);
        (0..5000).map(|_| scene.intersect(&ray(random.vector(), random.vector()))).collect::<Vec<_>>()
    };
    let alone = trace();
    assert!(alone.iter().filter(|hit| hit.is_some()).count() > 2500);
    std::thread::scope(|scope| {
        let others: Vec<_> = (0..8).map(|_| scope.spawn(trace)).collect();
        for other in others {
            assert_eq!(other.join().unwrap(), alone);
        }
    });
}

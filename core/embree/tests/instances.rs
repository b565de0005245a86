//! Instances: a ray through an instance meets what it would meet if the triangles had been moved.

mod common;

use common::{Random, commit, device, mesh_scene, ray};
use rgp_embree::{BuildQuality, EmbreeError, MOST_STEPS, Ray, SceneBuilder};

const TRIANGLE: [[f32; 3]; 3] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.5]];
const FACE: [[u32; 3]; 1] = [[0, 1, 2]];

const IDENTITY: [f32; 12] = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0];
/// Scale (2, 3, 0.5), then 30° about z, then the translation (5, -7, 11); by columns.
const MOVED: [f32; 12] = [1.732_050_8, 1.0, 0.0, -1.5, 2.598_076, 0.0, 0.0, 0.0, 0.5, 5.0, -7.0, 11.0];

fn apply(columns: &[f32; 12], point: [f32; 3]) -> [f32; 3] {
    [0, 1, 2].map(|row| {
        let [x, y, z] = point;
        columns[row] * x + columns[3 + row] * y + columns[6 + row] * z + columns[9 + row]
    })
}

#[test]
fn an_instance_answers_like_moved_triangles() {
    let device = device();
    let mesh = mesh_scene(&device, 3, &TRIANGLE, &FACE);
    let mut builder = SceneBuilder::new(&device, BuildQuality::Medium).unwrap();
    builder.add_instance(42, &mesh, &MOVED, u32::MAX).unwrap();
    let instanced = commit(builder);
    let corners = TRIANGLE.map(|corner| apply(&MOVED, corner));
    let moved = mesh_scene(&device, 42, &corners, &FACE);

    let mut random = Random(11);
    for _ in 0..1000 {
        let (u, v) = (0.1 + 0.35 * random.signed().abs(), 0.1 + 0.35 * random.signed().abs());
        let target = apply(&MOVED, [u, v, 0.5 * v]);
        let side = if random.signed() < 0.0 { -4.0 } else { 4.0 };
        let [x, y, _] = random.vector();
        let origin = [target[0] + x, target[1] + y, target[2] + side];
        let query = ray(origin, [0, 1, 2].map(|axis| target[axis] - origin[axis]));
        let through_instance = instanced.intersect(&query).expect("aimed at the inside of the triangle");
        let direct = moved.intersect(&query).expect("aimed at the inside of the triangle");
        for hit in [through_instance, direct] {
            assert!((hit.t - 1.0).abs() < 1e-5, "{}", hit.t);
            assert!(
                (hit.u - u).abs() < 1e-5 && (hit.v - v).abs() < 1e-5,
                "({}, {}) for ({u}, {v})",
                hit.u,
                hit.v
            );
            assert_eq!((hit.object, hit.primitive), (42, 0));
        }
        let [x, y, z] = through_instance.normal;
        assert!(
            x.abs().max((y + 0.5).abs()).max((z - 1.0).abs()) < 1e-5,
            "not in the instance's own space: {x} {y} {z}"
        );
        assert!(instanced.occluded(&query));
    }
    let [low, high] = instanced.bounds();
    for corner in corners {
        assert!((0..3).all(|axis| low[axis] <= corner[axis] && corner[axis] <= high[axis]));
    }
}

#[test]
fn instances_share_a_mesh_and_are_told_apart() {
    let device = device();
    let mesh = mesh_scene(&device, 0, &TRIANGLE, &FACE);
    let mut builder = SceneBuilder::new(&device, BuildQuality::Medium).unwrap();
    for id in 0..100_u16 {
        let mut columns = IDENTITY;
        columns[9] = 2.0 * f32::from(id);
        builder.add_instance(u32::from(id), &mesh, &columns, u32::MAX).unwrap();
    }
    builder.add_triangles(100, &TRIANGLE.map(|[x, y, z]| [x - 2.0, y, z]), &FACE, u32::MAX).unwrap();
    drop(mesh);
    let scene = commit(builder);
    for id in 0..100_u16 {
        let hit = scene.intersect(&ray([2.0 * f32::from(id) + 0.25, 0.25, 9.0], [0.0, 0.0, -1.0])).unwrap();
        assert_eq!(hit.object, u32::from(id));
    }
    let hit = scene.intersect(&ray([-1.75, 0.25, 9.0], [0.0, 0.0, -1.0])).unwrap();
    assert_eq!(hit.object, 100, "a mesh beside the instances keeps its own id");
}

#[test]
fn an_instance_hides_from_rays_without_its_mask() {
    let device = device();
    let mesh = mesh_scene(&device, 0, &TRIANGLE, &FACE);
    let mut builder = SceneBuilder::new(&device, BuildQuality::Medium).unwrap();
    builder.add_instance(0, &mesh, &IDENTITY, 0b10).unwrap();
    let scene = commit(builder);
    let down = ray([0.25, 0.25, 9.0], [0.0, 0.0, -1.0]);
    assert!(scene.intersect(&Ray { mask: 0b10, ..down }).is_some());
    assert!(scene.intersect(&Ray { mask: 0b01, ..down }).is_none());
    assert!(!scene.occluded(&Ray { mask: 0b01, ..down }));
}

#[test]
fn what_cannot_be_instanced_is_refused() {
    let device = device();
    let mesh = mesh_scene(&device, 0, &TRIANGLE, &FACE);
    let mut builder = SceneBuilder::new(&device, BuildQuality::Medium).unwrap();
    let mut broken = IDENTITY;
    broken[4] = f32::NAN;
    let elsewhere = mesh_scene(&common::device(), 0, &TRIANGLE, &FACE);
    for (id, scene, columns) in
        [(0, &mesh, &broken), (1, &elsewhere, &IDENTITY), (u32::MAX, &mesh, &IDENTITY)]
    {
        let refused = builder.add_instance(id, scene, columns, u32::MAX);
        assert!(matches!(refused, Err(EmbreeError::InvalidInput(_))), "{refused:?}");
    }
    builder.add_instance(0, &mesh, &IDENTITY, u32::MAX).unwrap();
    let one_level = commit(builder);
    let mut outer = SceneBuilder::new(&device, BuildQuality::Medium).unwrap();
    let refused = outer.add_instance(0, &one_level, &IDENTITY, u32::MAX);
    assert!(matches!(refused, Err(EmbreeError::InvalidInput(_))), "{refused:?}");
}

#[test]
fn instances_that_are_flat_or_empty_do_no_harm() {
    let device = device();
    let mesh = mesh_scene(&device, 0, &TRIANGLE, &FACE);
    let empty = mesh_scene(&device, 0, &[], &[]);
    let mut builder = SceneBuilder::new(&device, BuildQuality::High).unwrap();
    let flat = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    builder.add_instance(0, &mesh, &flat, u32::MAX).unwrap();
    builder.add_instance(1, &mesh, &[0.0; 12], u32::MAX).unwrap();
    builder.add_instance(2, &empty, &IDENTITY, u32::MAX).unwrap();
    let mut aside = IDENTITY;
    aside[9] = 10.0;
    builder.add_instance(3, &mesh, &aside, u32::MAX).unwrap();
    let scene = commit(builder);
    let mut random = Random(4);
    for _ in 0..1000 {
        scene.intersect(&ray(random.vector(), random.vector()));
    }
    assert_eq!(scene.intersect(&ray([10.25, 0.25, 9.0], [0.0, 0.0, -1.0])).map(|hit| hit.object), Some(3));
}

/// Halfway between two steps everything is halfway, and the bounds hold it at all times.
#[test]
fn what_moves_is_where_it_is_at_the_time_of_the_ray() {
    let device = device();
    let mesh = mesh_scene(&device, 0, &TRIANGLE, &FACE);
    let shifted = |x: f32| {
        let mut columns = IDENTITY;
        columns[9] = x;
        columns
    };
    let lifted = |x: f32| TRIANGLE.map(|[px, y, z]| [px + x, y + 10.0, z]);
    let mut builder = SceneBuilder::new(&device, BuildQuality::High).unwrap();
    builder.add_moving_instance(0, &mesh, &[shifted(0.0), shifted(4.0), shifted(0.0)], u32::MAX).unwrap();
    builder.add_moving_triangles(1, &[&lifted(0.0), &lifted(8.0)], &FACE, u32::MAX).unwrap();
    let scene = commit(builder);
    for (time, [x, lifted_x]) in
        [(0.0, [0.0, 0.0]), (0.25, [2.0, 2.0]), (0.75, [2.0, 6.0]), (1.0, [0.0, 8.0])]
    {
        for (id, place, y) in [(0, x, 0.25), (1, lifted_x, 10.25)] {
            let down = |x: f32| Ray { time, ..ray([x, y, 9.0], [0.0, 0.0, -1.0]) };
            assert_eq!(scene.intersect(&down(place + 0.25)).map(|hit| hit.object), Some(id), "{time}");
            assert!(scene.occluded(&down(place + 0.25)) && !scene.occluded(&down(place + 1.25)));
        }
    }
    let [low, high] = scene.bounds();
    assert!(low[0] <= 0.0 && high[0] >= 9.0 && high[1] >= 11.0, "{low:?} {high:?}");
}

#[test]
fn steps_that_do_not_fit_are_refused() {
    let device = device();
    let mesh = mesh_scene(&device, 0, &TRIANGLE, &FACE);
    let mut builder = SceneBuilder::new(&device, BuildQuality::Medium).unwrap();
    let refused = |outcome: Result<(), EmbreeError>| matches!(outcome, Err(EmbreeError::InvalidInput(_)));
    assert!(refused(builder.add_moving_instance(0, &mesh, &[], 1)));
    assert!(refused(builder.add_moving_instance(0, &mesh, &vec![IDENTITY; MOST_STEPS + 1], 1)));
    assert!(refused(builder.add_moving_triangles(0, &[&TRIANGLE, &TRIANGLE[..2]], &FACE, 1)));
    assert!(builder.add_moving_instance(0, &mesh, &vec![IDENTITY; MOST_STEPS], 1).is_ok());
}

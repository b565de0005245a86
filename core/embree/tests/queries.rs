//! Rays whose answers are known beforehand.

mod common;

use common::{device, mesh_scene, ray};

const TRIANGLE: [[f32; 3]; 3] = [[0.0, 0.0, 2.0], [4.0, 0.0, 2.0], [0.0, 8.0, 2.0]];

#[test]
fn a_hit_reports_distance_barycentrics_normal_and_ids() {
    let scene = mesh_scene(&device(), 7, &TRIANGLE, &[[0, 1, 2]]);
    let hit = scene.intersect(&ray([1.0, 2.0, -1.0], [0.0, 0.0, 0.5])).expect("the ray meets the triangle");
    assert_eq!((hit.t, hit.u, hit.v), (6.0, 0.25, 0.25));
    assert_eq!(hit.normal, [0.0, 0.0, 32.0]);
    assert_eq!((hit.primitive, hit.object), (0, 7));
}

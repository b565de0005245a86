//! Lamps as triangles for the ray tracer. They only say which rays may meet a lamp; what is seen there is computed from
//! the lamp itself.

use glam::Vec3;

/// Proxies are larger than their lamps by this factor, for rounding.
const GROWTH: f32 = 1.001;

/// Triangles that hold one lamp.
#[derive(Clone, Debug, PartialEq)]
pub struct LampProxy {
    /// Index into [`crate::scene::Scene::lamps`].
    pub lamp: usize,
    /// Corners in scene space.
    pub positions: Vec<Vec3>,
    /// Indices of corners; both sides count.
    pub triangles: Vec<[u32; 3]>,
    /// Ray kinds that see the lamp.
    pub visibility: u32,
}

/// Positions and triangles of a proxy.
pub(super) type Hull = (Vec<Vec3>, Vec<[u32; 3]>);

/// Two triangles over a rectangle given by its corners, in order, about `center`.
pub(super) fn rectangle(center: Vec3, corners: [Vec3; 4]) -> Hull {
    (corners.map(|p| center + (p - center) * GROWTH).to_vec(), vec![[0, 1, 2], [0, 2, 3]])
}

/// A closed cube around a ball.
pub(super) fn cube(center: Vec3, radius: f32) -> Hull {
    let side = |bit: u32| if bit == 0 { -GROWTH } else { GROWTH };
    let corner = |i: u32| center + Vec3::new(side(i & 1), side(i & 2), side(i & 4)) * radius;
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = faces.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    ((0..8).map(corner).collect(), triangles)
}

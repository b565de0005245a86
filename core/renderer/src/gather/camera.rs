//! Rays from the camera.

use glam::{DVec2, DVec3};

use crate::accel::Ray;
use crate::lit_scene::LitScene;
use crate::scene::{Camera, Projection, visibility};

/// A ray from the camera, from where it enters the scene.
pub(super) struct CameraRay {
    pub(super) ray: Ray,
    /// Distance at which the far clip plane ends it.
    pub(super) far: f32,
    /// Distance from the camera to where it starts.
    pub(super) travelled: f32,
}

/// The ray through `position` of the full frame (pixels from its bottom left).
#[must_use]
pub(super) fn camera_ray(camera: &Camera, lit: &LitScene<'_>, position: DVec2) -> CameraRay {
    let [left, right, bottom, top] = camera.window;
    let at = position / DVec2::new(f64::from(camera.resolution[0]), f64::from(camera.resolution[1]));
    let plane = DVec2::new(left + (right - left) * at.x, bottom + (top - bottom) * at.y);
    // One unit of depth along the ray.
    let (origin, direction) = match camera.projection {
        Projection::Perspective => (DVec3::ZERO, plane.extend(-1.0)),
        Projection::Orthographic => (plane.extend(0.0), DVec3::NEG_Z),
    };
    let [near, far] = camera.clip.map(f64::from);
    let to_scene = &camera.scene_from_camera;
    let start = to_scene.transform_point3(origin + direction * near.max(0.0));
    let direction = to_scene.transform_vector3(direction);
    let length = direction.length();
    let (ray, moved) =
        lit.entering(start, (direction / length).as_vec3(), visibility::CAMERA | lit.accel.camera_lamp_bit());
    #[expect(clippy::cast_possible_truncation, reason = "rays are traced in f32")]
    let [reach, skipped] = [(far - near.max(0.0)) * length, near.max(0.0) * length].map(|d| d as f32);
    CameraRay { ray, far: (reach - moved).max(0.0), travelled: skipped + moved }
}

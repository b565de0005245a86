//! Rays from the camera.

use glam::{DVec2, DVec3};

use crate::accel::Ray;
use crate::lit_scene::LitScene;
use crate::scene::{Camera, Lens, Projection, visibility};

use super::Width;

/// A ray from the camera.
#[derive(Clone, Copy, Debug)]
pub(super) struct CameraRay {
    pub(super) ray: Ray,
    /// Distance along the ray at which the far clip plane ends it.
    pub(super) reach: f32,
    /// How far from the lens it starts.
    pub(super) start: f32,
}

/// The ray through `position` of the full frame (pixels from its bottom left), and through a point of the lens if there is
/// one.
#[must_use]
pub(super) fn camera_ray(
    camera: &Camera,
    lit: &LitScene<'_>,
    position: DVec2,
    lens: Option<(&Lens, DVec2)>,
) -> CameraRay {
    let [left, right, bottom, top] = camera.window;
    let at = position / DVec2::new(f64::from(camera.resolution[0]), f64::from(camera.resolution[1]));
    let plane = DVec2::new(left + (right - left) * at.x, bottom + (top - bottom) * at.y);
    // One unit of depth along the ray.
    let (mut origin, mut direction) = match camera.projection {
        Projection::Perspective => (DVec3::ZERO, plane.extend(-1.0)),
        Projection::Orthographic => (plane.extend(0.0), DVec3::NEG_Z),
    };
    if let Some((lens, point)) = lens {
        // All rays of one position meet in the plane of focus.
        origin += point.extend(0.0);
        direction -= (point / lens.focus_distance()).extend(0.0);
    }
    let [near, far] = camera.clip.map(f64::from);
    let near = near.max(0.0);
    let to_scene = &camera.scene_from_camera;
    let start = to_scene.transform_point3(origin + direction * near);
    let direction = to_scene.transform_vector3(direction);
    let length = direction.length();
    let (ray, moved) =
        lit.entering(start, (direction / length).as_vec3(), visibility::CAMERA | lit.accel.camera_lamp_bit());
    #[expect(clippy::cast_possible_truncation, reason = "rays are traced in f32")]
    let [reach, start] = [((far - near) * length) as f32 - moved, (near * length) as f32 + moved];
    CameraRay { ray, reach: reach.max(0.0), start }
}

/// The width of a camera sample: the area of a pixel, and that of its blur, dealt out to the samples.
#[expect(clippy::cast_possible_truncation, reason = "widths need no more than f32")]
pub(super) fn camera_width(camera: &Camera, lens: Option<&Lens>, camera_samples: u32) -> Width {
    let share = 1.0 / f64::from(camera_samples).sqrt();
    let [left, right, ..] = camera.window;
    let pixel = ((right - left).abs() / f64::from(camera.resolution[0]) * share) as f32;
    let (start, spread) = match camera.projection {
        Projection::Perspective => (0.0, pixel),
        Projection::Orthographic => (pixel, 0.0),
    };
    let blur = lens.map_or(0.0, |lens| lens.area().sqrt() * share);
    let blur_spread = lens.map_or(0.0, |lens| -blur / lens.focus_distance());
    Width { start, spread, blur: blur as f32, blur_spread: blur_spread as f32 }
}

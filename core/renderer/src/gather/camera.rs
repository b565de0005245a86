//! Rays from the camera.

use glam::DVec2;

use crate::accel::Ray;
use crate::lit_scene::LitScene;
use crate::scene::{Camera, Lens, Projection, Sight, visibility};

use super::Width;

/// A ray from the camera.
#[derive(Clone, Copy, Debug)]
pub(super) struct CameraRay {
    pub(super) ray: Ray,
    /// Distance along the ray at which the far clip plane ends it.
    pub(super) reach: f32,
    /// How far from the lens it starts.
    pub(super) start: f32,
    /// How far that is from the near clip plane.
    pub(super) moved: f32,
    /// Angle across a small part of the window over its edge there, see [`Sight`].
    pub(super) spread: f32,
}

/// The ray through `position` of the full frame (pixels from its bottom left), and through a point of the lens if there is
/// one, at a time while the shutter is open. `None` where the camera has no picture.
#[must_use]
pub(super) fn camera_ray(
    camera: &Camera,
    lit: &LitScene<'_>,
    position: DVec2,
    lens: Option<(&Lens, DVec2)>,
    time: f32,
) -> Option<CameraRay> {
    let (to_scene, [left, right, bottom, top]) = camera.at(time);
    let at = position / DVec2::new(f64::from(camera.resolution[0]), f64::from(camera.resolution[1]));
    let plane = DVec2::new(left + (right - left) * at.x, bottom + (top - bottom) * at.y);
    let Sight { mut origin, mut direction, spread } = camera.projection.sight(plane)?;
    if let Some((lens, point)) = lens {
        // All rays of one position meet in the plane of focus, or at the distance of focus.
        let point = camera.projection.lens_point(direction, point);
        origin += point;
        direction -= point / lens.focus_distance();
        if !camera.projection.has_depth() {
            direction = direction.normalize();
        }
    }
    let [near, far] = camera.clip.map(f64::from);
    let near = near.max(0.0);
    let start = to_scene.transform_point3(origin + direction * near);
    let direction = to_scene.transform_vector3(direction);
    let length = direction.length();
    let mask = visibility::CAMERA | lit.accel.camera_lamp_bit();
    let (ray, moved) = lit.entering(start, (direction / length).as_vec3(), mask, time);
    #[expect(clippy::cast_possible_truncation, reason = "rays are traced in f32")]
    let [reach, start] = [((far - near) * length) as f32 - moved, (near * length) as f32 + moved];
    #[expect(clippy::cast_possible_truncation, reason = "widths need no more than f32")]
    Some(CameraRay { ray, reach: reach.max(0.0), start, moved, spread: spread as f32 })
}

/// The width of a camera sample: the area of a pixel, and that of its blur, dealt out to the samples. Rays of panoramas
/// spread as each tells.
#[expect(clippy::cast_possible_truncation, reason = "widths need no more than f32")]
pub(super) fn camera_width(camera: &Camera, lens: Option<&Lens>, camera_samples: u32) -> Width {
    let share = 1.0 / f64::from(camera_samples).sqrt();
    let [left, right, bottom, top] = camera.window;
    let [across, up] = [(right - left).abs(), (top - bottom).abs()];
    let [across, up] = [across / f64::from(camera.resolution[0]), up / f64::from(camera.resolution[1])];
    let pixel = if camera.projection.has_depth() { across } else { (across * up).sqrt() };
    let pixel = (pixel * share) as f32;
    let (start, spread) =
        if camera.projection == Projection::Orthographic { (pixel, 0.0) } else { (0.0, pixel) };
    let blur = lens.map_or(0.0, |lens| lens.area().sqrt() * share);
    let blur_spread = lens.map_or(0.0, |lens| -blur / lens.focus_distance());
    Width { start, spread, blur: blur as f32, blur_spread: blur_spread as f32 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::SceneBuilder;
    use crate::scene::record::{CameraRecord, LensRecord};

    fn record(projection: Projection, lens: Option<LensRecord>) -> CameraRecord {
        CameraRecord {
            name: "camera".into(),
            projection,
            world_from_camera: glam::DMat4::IDENTITY.to_cols_array_2d(),
            window: [-1.0, 1.0, -1.0, 1.0],
            resolution: [200, 200],
            region: [0, 0, 200, 200],
            clip: [0.0, 100.0],
            lens,
            steps: Vec::new(),
            shutter: Vec::new(),
        }
    }

    fn placed(record: CameraRecord) -> Camera {
        let mut builder = SceneBuilder::default();
        builder.set_camera(record);
        builder.finish().expect("a camera suffices").camera
    }

    /// Wide as the pixel in the plane of focus; elsewhere wider by the blur, also behind a mirror that the ray met before.
    #[test]
    fn camera_rays_are_as_wide_as_what_they_stand_for() {
        let (focus, radius, pixel, samples) = (2.0, 0.1, 0.01, 4);
        let lens = LensRecord { radius, blades: 0, rotation: 0.0, ratio: 1.0, focus_distance: focus };
        let camera = placed(record(Projection::Perspective, Some(lens)));
        let width = camera_width(&camera, camera.lens.as_ref(), samples);
        for depth in [0.5, 2.0, 3.0, 7.0] {
            let blur = std::f64::consts::PI.sqrt() * radius * (1.0 - depth / focus).abs();
            let expected = (pixel * depth + blur) / f64::from(samples).sqrt();
            let depth = depth as f32;
            for found in [width.at(depth), width.after(0.4).at(depth - 0.4)] {
                assert!((f64::from(found) - expected).abs() < 1e-6, "{found} is not {expected}");
            }
            let sharp = camera_width(&camera, None, samples).at(depth);
            assert!((f64::from(sharp) - pixel * f64::from(depth) / 2.0).abs() < 1e-7);
        }
    }
    /// A pixel of a panorama is as wide as the solid angle it covers, whatever the window's units and shape.
    #[test]
    fn pixels_of_panoramas_are_as_wide_as_what_they_cover() {
        let record = record(Projection::Equirectangular, None);
        let camera = placed(CameraRecord { window: [-3.0, 3.0, -1.0, 1.0], ..record });
        let pixel = |latitude: f64| (6.0 / 200.0 * 2.0 / 200.0 * latitude.cos()).sqrt() / 2.0;
        let width = camera_width(&camera, None, 4);
        for latitude in [0.0, 0.9] {
            let sight = camera.projection.sight(DVec2::new(0.3, latitude)).expect("there is no circle");
            let found = width.spread_by(sight.spread as f32).at(5.0);
            assert!((f64::from(found) / (5.0 * pixel(latitude)) - 1.0).abs() < 1e-6, "{latitude}: {found}");
        }
    }
}

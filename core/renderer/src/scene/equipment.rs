//! Cameras and lamps on their way into scene space.

use glam::{DAffine3, DVec3};

use super::builder::Problems;
use super::mesh::is_step_count;
use super::record::{CameraRecord, LampRecord, LampShape, matrix, visibility};
use super::{Camera, LARGEST, Lamp, Lens, Projection, SceneSpace, Shutter, motion};
use crate::error::RenderError;

pub(super) fn place_camera(record: &CameraRecord, space: &SceneSpace) -> Result<Camera, RenderError> {
    let fault = |what: &str| RenderError::Scene(format!("camera '{}': {what}", record.name));
    let length = match record.projection {
        Projection::Orthographic => space.scale,
        _ => 1.0,
    };
    record.projection.check().map_err(fault)?;
    let place = |world_from_camera, window| camera_view(world_from_camera, window, length, space);
    let (scene_from_camera, window) = place(&record.world_from_camera, &record.window).map_err(fault)?;
    if !is_step_count(record.steps.len()) {
        return Err(fault("its steps are not two or more, in pairs"));
    }
    let steps = record.steps.iter().map(|step| place(&step.world_from_camera, &step.window));
    let (mut keys, mut windows): (Vec<_>, Vec<_>) =
        steps.collect::<Result<Vec<_>, _>>().map_err(fault)?.into_iter().unzip();
    if !keys.is_empty() {
        let middle = keys.len() / 2;
        keys.insert(middle, scene_from_camera);
        windows.insert(middle, window);
    }
    let [frame_w, frame_h] = record.resolution;
    let [rx, ry, rw, rh] = record.region;
    if rw == 0 || rh == 0 || rx.saturating_add(rw) > frame_w || ry.saturating_add(rh) > frame_h {
        return Err(fault("the part of the frame to render is empty or outside the frame"));
    }
    if record.clip.iter().any(|d| d.is_nan()) {
        return Err(fault("its clip distances are not numbers"));
    }
    #[expect(clippy::cast_possible_truncation, reason = "clip distances need no more than f32")]
    let clip = record.clip.map(|d| (d * space.scale).clamp(-LARGEST, LARGEST) as f32);
    let lens = match &record.lens {
        Some(lens) => Lens::new(lens, space.scale).map_err(fault)?,
        None => None,
    };
    Ok(Camera {
        name: record.name.clone(),
        projection: record.projection,
        scene_from_camera,
        window,
        resolution: record.resolution,
        region: record.region,
        clip,
        lens,
        motion: if keys.is_empty() { keys } else { motion::refined(&keys) },
        windows,
        shutter: Shutter::new(&record.shutter).map_err(fault)?,
    })
}

/// Camera to scene without scale, and the window in scene units.
fn camera_view(
    world_from_camera: &[[f64; 4]; 4],
    window: &[f64; 4],
    length: f64,
    space: &SceneSpace,
) -> Result<(DAffine3, [f64; 4]), &'static str> {
    let matrix = DAffine3::from_mat4(matrix(world_from_camera));
    if !matrix.is_finite() {
        return Err("its transform is not a number");
    }
    let axes = matrix.matrix3;
    let [x, y, z] = [axes.x_axis, axes.y_axis, axes.z_axis].map(DVec3::try_normalize);
    let (Some(x), Some(y), Some(z)) = (x, y, z) else { return Err("its scale is zero") };
    let [left, right, bottom, top] = *window;
    if !window.iter().all(|v| v.is_finite()) || left == right || bottom == top {
        return Err("its field of view is empty");
    }
    let origin = space.scene_from_world().transform_point3(matrix.translation);
    let window = window.map(|v| v * length);
    if !origin.to_array().iter().chain(&window).all(|v| v.abs() <= LARGEST) {
        return Err("it is farther away, or sees farther to its sides, than numbers go");
    }
    Ok((DAffine3::from_cols(x, y, z, origin), window))
}

pub(super) fn place_lamp(record: LampRecord, space: &SceneSpace, problems: &mut Problems) -> Option<Lamp> {
    let transform = DAffine3::from_mat4(matrix(&record.world_from_lamp));
    if !transform.is_finite() || !record.power.is_finite() {
        problems.add(&record.name, "its transform or power is not a number; the lamp is left out", 1);
        return None;
    }
    if record.power.0.iter().any(|&c| c < 0.0) {
        problems.add(&record.name, "its power is negative; zero is used", 1);
    }
    let power = record.power.map(|c| c.max(0.0));
    if power.is_black() {
        return None;
    }
    let axes = transform.matrix3;
    let scales = DVec3::new(axes.x_axis.length(), axes.y_axis.length(), axes.z_axis.length());
    let z = axes.z_axis.try_normalize();
    let Some(z) = z else {
        problems.add(&record.name, "its scale is zero; the lamp is left out", 1);
        return None;
    };
    let fallback = z.any_orthonormal_pair();
    let x = axes.x_axis.try_normalize().unwrap_or(fallback.0);
    let y = axes.y_axis.try_normalize().unwrap_or(fallback.1);
    let shape = match record.shape {
        LampShape::Point { radius, soft_falloff } => {
            LampShape::Point { radius: length(radius, space.scale), soft_falloff }
        }
        LampShape::Spot { radius, soft_falloff, cone_angle, blend } => {
            LampShape::Spot { radius: length(radius, space.scale), soft_falloff, cone_angle, blend }
        }
        LampShape::Sun { angle } => LampShape::Sun { angle },
        LampShape::Rectangle { size, spread } => {
            LampShape::Rectangle { size: lamp_size(size, scales, space.scale), spread }
        }
        LampShape::Ellipse { size, spread } => {
            LampShape::Ellipse { size: lamp_size(size, scales, space.scale), spread }
        }
    };
    if let LampShape::Rectangle { size, .. } | LampShape::Ellipse { size, .. } = shape
        && !(size[0] > 0.0 && size[1] > 0.0)
    {
        problems.add(&record.name, "its size is zero; the lamp is left out", 1);
        return None;
    }
    if matches!(shape, LampShape::Spot { .. }) && scales.x.min(scales.y) <= 0.0 {
        problems.add(&record.name, "its scale is zero across its cone; the lamp is left out", 1);
        return None;
    }
    let is_sun = matches!(shape, LampShape::Sun { .. });
    #[expect(clippy::cast_possible_truncation, reason = "the factor is a power of two")]
    let power = if is_sun { power } else { power * (space.scale * space.scale) as f32 };
    let lamp = Lamp {
        name: record.name,
        shape,
        power,
        program: None,
        position: space.scene_from_world().transform_point3(transform.translation).as_vec3(),
        x_axis: x.as_vec3(),
        y_axis: y.as_vec3(),
        axis: -z.as_vec3(),
        stretch: [scales.x, scales.y].map(|length| (length / scales.z) as f32),
        visibility: record.visibility & (visibility::ALL | visibility::CATCHER),
        casts_shadow: record.casts_shadow,
        links: record.links,
    };
    if !is_within_numbers(&lamp) {
        let what = "its size, distance or power is larger than numbers go; the lamp is left out";
        problems.add(&lamp.name, what, 1);
        return None;
    }
    (!lamp.power.is_black()).then_some(lamp)
}

/// Whether everything about a lamp can be worked with in f32.
fn is_within_numbers(lamp: &Lamp) -> bool {
    let shape = match lamp.shape {
        LampShape::Point { radius, .. } => [radius, 0.0, 0.0],
        LampShape::Spot { radius, cone_angle, blend, .. } => [radius, cone_angle, blend],
        LampShape::Sun { angle } => [angle, 0.0, 0.0],
        LampShape::Rectangle { size, spread } | LampShape::Ellipse { size, spread } => {
            [size[0], size[1], spread]
        }
    };
    let place = lamp.position.to_array();
    let numbers = shape.iter().chain(&place).chain(&lamp.stretch);
    lamp.power.is_finite() && numbers.into_iter().all(|&v| f64::from(v.abs()) <= LARGEST)
}

#[expect(clippy::cast_possible_truncation, reason = "lengths in scene space are near one")]
fn length(metres: f32, scale: f64) -> f32 {
    (f64::from(metres) * scale).max(0.0) as f32
}

#[expect(clippy::cast_possible_truncation, reason = "lengths in scene space are near one")]
fn lamp_size(size: [f32; 2], scales: DVec3, scale: f64) -> [f32; 2] {
    [(f64::from(size[0]) * scales.x * scale) as f32, (f64::from(size[1]) * scales.y * scale) as f32]
}

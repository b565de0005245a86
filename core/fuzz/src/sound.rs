//! What every finished scene promises those that read it: they check nothing again.

use rgp_renderer::scene::{Object, Scene};

const TIMES: [f32; 4] = [0.0, 0.5, 0.75, 1.0];

/// Asks a scene everything that the passes ask.
///
/// # Panics
/// It breaks a promise.
pub fn assert_sound(scene: &Scene) {
    assert!(scene.space.center.is_finite() && scene.space.scale.is_normal(), "{:?}", scene.space);
    assert!(scene.bounds.iter().all(|corner| corner.is_finite()), "bounds {:?}", scene.bounds);
    scene.objects.iter().for_each(|object| assert_object_sound(scene, object));
    for lamp in &scene.lamps {
        let vectors = [lamp.position, lamp.x_axis, lamp.y_axis, lamp.axis];
        assert!(vectors.iter().all(|v| v.is_finite()) && lamp.power.is_finite(), "{lamp:?}");
        assert!(lamp.stretch.iter().all(|v| v.is_finite()), "{lamp:?}");
    }
    let camera = &scene.camera;
    for time in TIMES.map(|u| camera.shutter.time(u * 0.999)) {
        assert!((0.0..=1.0).contains(&time), "the shutter is open at {time}");
        let (place, window) = camera.at(time);
        assert!(place.is_finite() && window.iter().all(|v| v.is_finite()), "{camera:?}");
        let [left, right, bottom, top] = window;
        for at in [[left, bottom], [right, top], [0.5 * (left + right), 0.5 * (bottom + top)]] {
            let Some(sight) = camera.projection.sight(at.into()) else { continue };
            assert!(
                sight.direction.is_finite() && sight.direction != glam::DVec3::ZERO,
                "{camera:?}: {sight:?}"
            );
            assert!(!sight.spread.is_nan(), "{camera:?}: {sight:?}");
        }
    }
    if let Some(lens) = &camera.lens {
        assert!(lens.point([0.3, 0.9]).is_finite() && lens.focus_distance() > 0.0, "{lens:?}");
    }
    let _ = (scene.without_objects(), scene.motion_bytes(), scene.world.is_black());
}

fn assert_object_sound(scene: &Scene, object: &Object) {
    let mesh = &object.mesh;
    assert!(!mesh.triangles.is_empty() && object.object_from_scene.is_finite(), "{object:?}");
    for index in 0..mesh.triangles.len() {
        assert!(object.material(index) < scene.materials.len(), "{object:?}");
        let times = TIMES.map(|time| object.corners_at(index, time));
        for corners in times.into_iter().chain([object.corners(index)]) {
            assert!(corners.iter().all(|corner| corner.is_finite()), "{object:?}");
        }
        for layer in &mesh.layers {
            let _ = layer.corners(index);
        }
    }
    let normals = &mesh.corner_normals;
    assert!(normals.is_empty() || normals.len() == mesh.triangles.len(), "{object:?}");
    assert!(normals.iter().flatten().all(|normal| normal.is_finite()), "{object:?}");
}

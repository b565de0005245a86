//! Motion against closed forms: what crosses a row of pixels at even speed covers each for a share of the shutter's time that
//! is a trapezoid, and all else about it is a matter of where it is when.

mod support;

use glam::{DMat4, DQuat, DVec3, Vec3};
use rgp_renderer::scene::record::{CameraRecord, CameraStep};
use rgp_renderer::scene::{MeshArrays, SceneBuilder, visibility};
use rgp_renderer::settings::{RenderSettings, Switch};
use support::*;

const RADIANCE: f64 = 2.0;
const PIXELS: u32 = 16;
/// Half of a square of four pixels, on a picture that shows four metres.
const HALF: f64 = 0.5;

fn sharp_settings() -> RenderSettings {
    let mut settings = settings(1, 4, 1);
    settings.gather.camera_samples = 1024;
    settings
}

/// Parallel rays from above, at four metres of the xy plane.
fn view() -> CameraRecord {
    parallel_camera(DVec3::Z * 3.0, DVec3::ZERO, 2.0, PIXELS)
}

fn shifted(x: f64) -> DMat4 {
    DMat4::from_translation(DVec3::X * x)
}

/// Adds a shining mesh, and gives the numbers of mesh and object.
fn shine(builder: &mut SceneBuilder, mesh: MeshArrays, place: DMat4) -> (usize, usize) {
    let material = builder.add_material(emitter(0.0, RADIANCE as f32)) as u32;
    let mesh = builder.add_mesh(mesh).expect("a mesh");
    let object = builder.add_object("Ball", mesh, place, vec![material], visibility::ALL);
    (mesh, object.expect("a mesh that exists"))
}

/// A square that is at `from` when the shutter opens and at `to` when it is shut, seen by a camera.
fn moving_square(from: f64, to: f64, camera: CameraRecord) -> Picture {
    let mut builder = SceneBuilder::default();
    let (_, object) = shine(&mut builder, floor(HALF as f32, 0.0), shifted(0.5 * (from + to)));
    builder.set_object_motion(object, &[shifted(from), shifted(to)]).expect("two steps");
    builder.set_camera(camera);
    finish_and_render(builder, &sharp_settings())
}

/// The light of each column, over that of the square: the mean of the four rows that the square crosses.
fn row(picture: &Picture) -> Vec<f64> {
    middle_rows(picture, 4)
}

fn middle_rows(picture: &Picture, count: usize) -> Vec<f64> {
    let radiance = picture.radiance();
    let width = PIXELS as usize;
    let rows = (width - count) / 2..(width + count) / 2;
    let light = |column: usize| rows.clone().map(|row| radiance[row * width + column]).sum::<f64>();
    (0..width).map(|column| light(column) / (count as f64 * RADIANCE)).collect()
}

/// How long each column is covered by a square that is at `place(time)`, weighted by how open the shutter is.
fn coverage(place: impl Fn(f64) -> f64, shutter: impl Fn(f64) -> f64) -> Vec<f64> {
    const TIMES: u32 = 4000;
    let pixel = 4.0 / f64::from(PIXELS);
    let times: Vec<f64> = (0..TIMES).map(|i| (f64::from(i) + 0.5) / f64::from(TIMES)).collect();
    let open: f64 = times.iter().map(|&time| shutter(time)).sum();
    let column = |column: u32| {
        let low = f64::from(column) * pixel - 2.0;
        let covered = |time: f64| {
            let (left, right) = (place(time) - HALF, place(time) + HALF);
            ((low + pixel).min(right) - low.max(left)).max(0.0) / pixel
        };
        times.iter().map(|&time| shutter(time) * covered(time)).sum::<f64>() / open
    };
    (0..PIXELS).map(column).collect()
}

#[track_caller]
fn assert_rows(found: &[f64], expected: &[f64], tolerance: f64) {
    for (column, (found, expected)) in found.iter().zip(expected).enumerate() {
        assert!((found - expected).abs() < tolerance, "column {column}: {found} is not {expected}");
    }
}

#[test]
fn a_square_that_crosses_the_picture_leaves_a_trapezoid() {
    let found = row(&moving_square(-1.0, 1.0, view()));
    // Two metres in a time of one: the middle is covered for half of it.
    assert!((found[PIXELS as usize / 2] - 0.5).abs() < 0.01, "{found:?}");
    assert_rows(&found, &coverage(|time| 2.0 * time - 1.0, |_| 1.0), 0.02);
}

#[test]
fn the_shutter_curve_weighs_the_times() {
    let curve = vec![0.0, 0.5, 1.0];
    let found = row(&moving_square(-1.0, 1.0, CameraRecord { shutter: curve, ..view() }));
    assert_rows(&found, &coverage(|time| 2.0 * time - 1.0, |time| time), 0.02);
}

/// A camera that moves sees what it would see if it stood and everything moved the other way.
#[test]
fn a_moving_camera_is_a_world_that_moves_the_other_way() {
    let base = view();
    let at = |x: f64| CameraStep {
        world_from_camera: rows(shifted(x) * DMat4::from_translation(DVec3::Z * 3.0)),
        window: base.window,
    };
    let mut builder = SceneBuilder::default();
    shine(&mut builder, floor(HALF as f32, 0.0), shifted(0.0));
    let world_from_camera = at(0.0).world_from_camera;
    builder.set_camera(CameraRecord { steps: vec![at(-1.0), at(1.0)], world_from_camera, ..base.clone() });
    let camera_moves = finish_and_render(builder, &sharp_settings());
    assert_eq!(reason(&camera_moves), "'camera' moves");
    let square_moves = moving_square(1.0, -1.0, base);
    assert_eq!(reason(&square_moves), "'Ball' moves");
    assert_rows(&row(&camera_moves), &row(&square_moves), 0.02);
}

/// A zoom: the square is seen at half of its size when the shutter opens, and at one and a half when it is shut.
#[test]
fn a_zoom_is_blurred() {
    let base = view();
    let step = |width: f64| CameraStep {
        world_from_camera: base.world_from_camera,
        window: base.window.map(|side| side * width),
    };
    let mut builder = SceneBuilder::default();
    shine(&mut builder, floor(HALF as f32, 0.0), DMat4::IDENTITY);
    builder.set_camera(CameraRecord { steps: vec![step(1.5), step(0.5)], ..base.clone() });
    let found = middle_rows(&finish_and_render(builder, &sharp_settings()), 2);
    // Column edges at x of the window's half are covered while x · width < HALF.
    for (column, light) in found.iter().enumerate().skip(8) {
        let middle = (column as f64 - 7.5) * 0.25;
        let covered = (1.5 - (HALF / middle)).clamp(0.0, 1.0);
        assert!((light - (1.0 - covered)).abs() < 0.07, "column {column}: {light} is not {}", 1.0 - covered);
    }
}

/// What turns by a right angle covers each place as long as it would on its arcs, though only three times are given.
#[test]
fn what_turns_stays_on_its_arcs() {
    let turned = |angle: f64| DMat4::from_quat(DQuat::from_rotation_z(angle));
    let mut builder = SceneBuilder::default();
    let bar = floor(0.4, 0.0);
    let positions = bar.positions.iter().map(|[x, y, z]| [1.5 + x, *y, *z]).collect();
    let (_, object) = shine(&mut builder, MeshArrays { positions, ..bar }, turned(0.0));
    let right = std::f64::consts::FRAC_PI_2;
    builder.set_object_motion(object, &[turned(-right), turned(right)]).expect("two steps");
    builder.set_camera(view());
    let picture = finish_and_render(builder, &sharp_settings());
    let pixel = 4.0 / f64::from(PIXELS);
    let (mut light, mut radius) = (0.0, 0.0);
    for (index, radiance) in picture.radiance().into_iter().enumerate() {
        let at = |index: u32| (f64::from(index) + 0.5) * pixel - 2.0;
        let (x, y) = (at(index as u32 % PIXELS), at(index as u32 / PIXELS));
        light += radiance * pixel * pixel;
        radius += radiance * pixel * pixel * (x * x + y * y);
    }
    assert_close(light, RADIANCE * 0.64, 0.03);
    // Mean square of the distance from the axis: of the square itself, and of the pixels.
    assert_close(radius / light, 1.5 * 1.5 + 0.32 / 3.0 + pixel * pixel / 6.0, 0.01);
}

/// A square whose corners move is one that moves; instances of it do so each in its own place.
#[test]
fn what_changes_its_shape_is_blurred() {
    let mut builder = SceneBuilder::default();
    let square = floor(HALF as f32, 0.0);
    let step = |x: f32| square.positions.iter().map(|[px, y, z]| [px + x, *y, *z]).collect::<Vec<_>>();
    let steps = vec![Some(step(-1.0)), Some(step(1.0))];
    let (mesh, _) = shine(&mut builder, square, DMat4::IDENTITY);
    builder.set_mesh_motion(mesh, steps).expect("two steps");
    builder.set_camera(view());
    let picture = finish_and_render(builder, &sharp_settings());
    assert_eq!(reason(&picture), "'Ball' changes its shape");
    assert_rows(&row(&picture), &coverage(|time| 2.0 * time - 1.0, |_| 1.0), 0.02);
}

fn reason(picture: &Picture) -> &str {
    let blur = picture.stats.effects.iter().find(|effect| effect.name == "motion_blur");
    blur.map_or("", |effect| &effect.because)
}

/// A room with a ball in it, which moves by `shift` to either side while the shutter is open.
fn room(shift: Vec3, material: rgp_renderer::scene::record::MaterialRecord, switch: Switch) -> Picture {
    let room = Room { ball: material, ..Room::default() };
    let mut builder = room.equipment();
    let [walls, (ball, material)] = room.meshes();
    place(&mut builder, walls.0, &[walls.1]);
    let material = builder.add_material(material) as u32;
    let mesh = builder.add_mesh(ball).expect("a mesh");
    let object =
        builder.add_object("Ball", mesh, DMat4::IDENTITY, vec![material], visibility::ALL).expect("a mesh");
    if shift != Vec3::ZERO {
        let steps = [-shift, shift].map(|shift| DMat4::from_translation(shift.as_dvec3()));
        builder.set_object_motion(object, &steps).expect("two steps");
    }
    let mut settings = settings(60_000, 16, 64);
    settings.gather.camera_samples = 64;
    settings.effects.motion_blur = switch;
    finish_and_render(builder, &settings)
}

/// Where nothing moves, the switch changes no bit; where something does, off shows it as it is in the middle of the time.
#[test]
fn nothing_is_blurred_where_nothing_moves() {
    let bits = |picture: &Picture| picture.combined.iter().map(|v| v.to_bits()).collect::<Vec<_>>();
    let still = room(Vec3::ZERO, diffuse(0.5), Switch::Auto);
    assert_eq!(bits(&still), bits(&room(Vec3::ZERO, diffuse(0.5), Switch::On)));
    assert_eq!(reason(&still), "nothing in the scene asks for it");
    let off = room(Vec3::X * 0.3, diffuse(0.5), Switch::Off);
    let blurred = room(Vec3::X * 0.3, diffuse(0.5), Switch::Auto);
    let difference = |a: &Picture, b: &Picture| {
        let pairs = a.radiance().into_iter().zip(b.radiance());
        pairs.map(|(a, b)| (a - b).abs()).sum::<f64>() / a.radiance().iter().sum::<f64>()
    };
    let (same, other) = (difference(&still, &off), difference(&still, &blurred));
    assert!(same < 0.005 && other > 0.02, "{same} {other}");
}

/// In a closed room of radiance L/(1 − albedo), whatever moves in it shines as all the rest: light is neither lost nor made
/// where it is stored at one time and read at another.
#[test]
fn a_furnace_stays_even_whatever_moves_in_it() {
    let albedo = 0.5_f32;
    let mut builder = SceneBuilder::default();
    let shines = emitter(albedo, 0.5);
    place(&mut builder, cuboid(Vec3::splat(-1.0), Vec3::splat(1.0)), std::slice::from_ref(&shines));
    let material = builder.add_material(shines) as u32;
    let mesh = builder.add_mesh(sphere(3, 0.4, Vec3::ZERO)).expect("a mesh");
    let object =
        builder.add_object("Ball", mesh, DMat4::IDENTITY, vec![material], visibility::ALL).expect("a mesh");
    let step = |side: f64| {
        DMat4::from_translation(DVec3::new(0.0, 0.4, 0.3) * side) * DMat4::from_rotation_y(0.8 * side)
    };
    builder.set_object_motion(object, &[step(-1.0), step(1.0)]).expect("two steps");
    builder.set_camera(camera(DVec3::new(-0.9, 0.0, 0.0), DVec3::ZERO, 0.9, 16));
    let mut settings = settings(400_000, 16, 64);
    settings.gather.camera_samples = 32;
    let picture = finish_and_render(builder, &settings);
    let radiance = picture.radiance();
    assert_close(mean(&radiance), 1.0, 0.01);
    assert!(spread(&radiance, 1.0) < 0.05, "{}", spread(&radiance, 1.0));
}

/// A small lamp made of a mesh that sweeps over a floor lights it as the mean of the places it is at.
#[test]
fn what_shines_and_moves_lights_from_where_it_is() {
    let build = |places: &[f64], moves: bool| {
        let mut builder = SceneBuilder::default();
        place(&mut builder, floor(2.0, 0.0), &[diffuse(0.8)]);
        let down = || {
            quad(
                [(-1.0, -1.0), (-1.0, 1.0), (1.0, 1.0), (1.0, -1.0)]
                    .map(|(x, y)| Vec3::new(0.2 * x, 0.2 * y, 1.0)),
            )
        };
        for &x in places {
            let (_, object) = shine(&mut builder, down(), shifted(x));
            if moves {
                builder.set_object_motion(object, &[shifted(-1.0), shifted(1.0)]).expect("two steps");
            }
        }
        let mut above = view();
        above.clip[0] = 2.5;
        builder.set_camera(above);
        let mut settings = settings(1, 4, 256);
        settings.gather.camera_samples = 256;
        settings.effects.indirect_diffuse = Switch::Off;
        finish_and_render(builder, &settings).radiance()
    };
    let found = build(&[0.0], true);
    let mut expected = vec![0.0; found.len()];
    for i in 0..8 {
        let still = build(&[(f64::from(i) + 0.5) / 4.0 - 1.0], false);
        expected.iter_mut().zip(still).for_each(|(sum, light)| *sum += light / 8.0);
    }
    assert_close(mean(&found), mean(&expected), 0.01);
    let bound = 0.1 * mean(&found);
    for (found, expected) in found.iter().zip(&expected) {
        assert!((found - expected).abs() < bound, "{found} is not {expected}");
    }
}

#[test]
fn steps_that_do_not_fit_are_refused_or_reported() {
    let mut builder = SceneBuilder::default();
    let (mesh, object) = shine(&mut builder, floor(0.5, 0.0), DMat4::IDENTITY);
    assert!(builder.set_object_motion(object, &[shifted(1.0)]).is_err());
    assert!(builder.set_object_motion(object + 1, &[shifted(1.0), shifted(2.0)]).is_err());
    assert!(builder.set_mesh_motion(mesh, vec![None, Some(vec![[0.0; 3]; 3])]).is_err());
    assert!(builder.set_mesh_motion(mesh + 1, Vec::new()).is_err());
    let nowhere = DMat4::from_translation(DVec3::splat(f64::NAN));
    builder.set_object_motion(object, &[shifted(1.0), nowhere]).expect("reported, not refused");
    let mut other = SceneBuilder::default();
    let (mesh, _) = shine(&mut other, floor(0.5, 0.0), DMat4::IDENTITY);
    let bad = vec![Some(vec![[f32::INFINITY; 3]; 6]), None];
    other.set_mesh_motion(mesh, bad).expect("reported, not refused");
    for mut builder in [builder, other] {
        builder.set_camera(view());
        let scene = builder.finish().expect("a scene");
        assert!(scene.problems.iter().any(|problem| problem.message.contains("is not blurred")));
        assert!(!scene.objects[0].moves());
    }
}

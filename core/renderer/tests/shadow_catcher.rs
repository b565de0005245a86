//! Shadow catchers: alpha is the share of their light that the other objects take. Closed forms as in `known_answers.rs`.

mod support;

use glam::{DMat4, DVec3, Vec3};
use rgp_renderer::color::Rgb;
use rgp_renderer::effects_plan::Effect;
use rgp_renderer::film::{CatcherSample, Film, PixelSample};
use rgp_renderer::scene::record::{ClosureRecord, LampRecord, MaterialRecord, WorldRecord};
use rgp_renderer::scene::{LampShape, MeshArrays, SceneBuilder, visibility};
use rgp_renderer::settings::{FilmSettings, PixelFilter, RenderSettings, Switch};
use support::*;

const PIXELS: u32 = 16;
const CATCHER: u32 = visibility::ALL | visibility::CATCHER;
/// Seen by all but the camera.
const UNSEEN: u32 = visibility::ALL & !visibility::CAMERA;

fn add(builder: &mut SceneBuilder, mesh: MeshArrays, material: &MaterialRecord, visible_to: u32) {
    let material = builder.add_material(material.clone()) as u32;
    let mesh = builder.add_mesh(mesh).expect("arrays that fit together");
    builder.add_object("object", mesh, DMat4::IDENTITY, vec![material], visible_to).expect("a mesh");
}

/// A lamp that is there without the other objects too.
fn lamp_above(power: f32) -> LampRecord {
    LampRecord { visibility: UNSEEN | visibility::CATCHER, ..point_lamp(power, DVec3::Z) }
}

/// A floor that catches, seen from above two metres wide.
fn floor_below() -> SceneBuilder {
    let mut builder = SceneBuilder::default();
    add(&mut builder, floor(8.0, 0.0), &diffuse(0.5), CATCHER);
    builder.set_camera(parallel_camera(DVec3::Z * 2.0, DVec3::ZERO, 1.0, PIXELS));
    builder
}

fn few_rays() -> RenderSettings {
    settings(20_000, 16, 64)
}

fn transparent(world: WorldRecord) -> WorldRecord {
    WorldRecord { film_transparent: true, ..world }
}

/// Half of a pixel is an object, half a catcher that has lost half of its light, before a world of 4.
#[test]
fn a_pixel_is_what_is_beside_catchers_and_their_shadow() {
    for (is_transparent, expected) in [(true, [1.0, 0.75]), (false, [2.0, 1.0])] {
        let settings =
            FilmSettings { filter: PixelFilter::Box, filter_width: 1.0, ..FilmSettings::default() };
        let film = Film::new(1, 1, &settings);
        film.expect_catchers(is_transparent);
        for (half, (direct, is_caught)) in [(2.0, false), (0.25, true)].into_iter().enumerate() {
            let light = |value: f32| Rgb::splat(if is_caught { value } else { 0.0 });
            let background = light(if is_transparent { 0.0 } else { 4.0 });
            let caught = CatcherSample { is_caught, before: Rgb::BLACK, without: light(0.5), background };
            let seen =
                PixelSample { direct: Rgb::splat(direct), alpha: 1.0, taken: true, ..PixelSample::default() };
            film.take_catchers(0, vec![caught]);
            film.take(0, vec![seen]);
            film.finish_pass(1, half, true);
        }
        let [light, alpha] = expected;
        assert_eq!(film.combined(), [light, light, light, alpha]);
        assert_eq!(film.shadow_catcher(), [0.5; 3]);
    }
}

/// Half of a pixel is nothing, half a catcher that has lost half of its light.
#[test]
fn half_a_pixel_of_a_catcher_is_half_as_much_shadow() {
    let film = Film::new(
        1,
        1,
        &FilmSettings { filter: PixelFilter::Box, filter_width: 1.0, ..FilmSettings::default() },
    );
    film.expect_catchers(true);
    for (half, (share, is_caught)) in [(0.0, false), (1.0, true)].into_iter().enumerate() {
        let (direct, without) = (Rgb::splat(0.25 * share), Rgb::splat(0.5 * share));
        film.take_catchers(0, vec![CatcherSample { is_caught, without, ..CatcherSample::default() }]);
        film.take(0, vec![PixelSample { direct, alpha: share, taken: true, ..PixelSample::default() }]);
        film.finish_pass(1, half, true);
    }
    assert_eq!(film.combined(), [0.0, 0.0, 0.0, 0.25]);
    assert_eq!(film.shadow_catcher(), [0.75; 3]);
}

/// A screen over the half x > 0, black and unseen.
fn add_screen(builder: &mut SceneBuilder) {
    let p = |x: f32, y: f32| Vec3::new(x, y, 0.5);
    let screen = quad([p(0.0, -4.0), p(4.0, -4.0), p(4.0, 4.0), p(0.0, 4.0)]);
    add(builder, screen, &diffuse(0.0), UNSEEN);
}

/// A screen below a point lamp.
fn half_in_shadow(world: WorldRecord) -> Picture {
    let mut builder = floor_below();
    add_screen(&mut builder);
    builder.add_lamp(lamp_above(10.0));
    builder.set_world(world);
    finish_and_render(builder, &few_rays())
}

/// The left and the right half of each row, without the two columns at the edge of the shadow.
fn halves(picture: &Picture) -> [Vec<[f32; 4]>; 2] {
    let pixels: Vec<[f32; 4]> =
        picture.combined.chunks(4).map(|p| p.try_into().expect("four channels")).collect();
    let middle = PIXELS as usize / 2;
    let row = |row: &[[f32; 4]]| [row[..middle - 1].to_vec(), row[middle + 1..].to_vec()];
    let rows: Vec<_> = pixels.chunks(PIXELS as usize).map(row).collect();
    [0, 1].map(|side| rows.iter().flat_map(|row| row[side].clone()).collect())
}

#[test]
fn alpha_is_one_in_full_shadow_and_zero_in_full_light() {
    // A world that the camera would see, were the film not transparent.
    let seen = WorldRecord { visibility: visibility::CAMERA, ..world(0.25) };
    let [light, shadow] = halves(&half_in_shadow(transparent(seen)));
    assert!(light.iter().all(|pixel| *pixel == [0.0; 4]), "{light:?}");
    assert!(shadow.iter().all(|pixel| *pixel == [0.0, 0.0, 0.0, 1.0]), "{shadow:?}");
}

#[test]
fn the_world_behind_is_darkened_where_the_film_is_not_transparent() {
    let seen = WorldRecord { visibility: visibility::CAMERA, ..world(0.25) };
    let [light, shadow] = halves(&half_in_shadow(seen));
    assert!(light.iter().all(|pixel| *pixel == [0.25, 0.25, 0.25, 1.0]), "{light:?}");
    assert!(shadow.iter().all(|pixel| *pixel == [0.0, 0.0, 0.0, 1.0]), "{shadow:?}");
}

/// A floor that sends as much light of its own as of a sun, behind a pane that shines and lets half through: in the shadow half
/// of the floor's light is left, and half of half of the world behind it is seen.
#[test]
fn what_shines_before_a_catcher_and_what_it_emits() {
    const OWN: f32 = 0.5 * std::f32::consts::FRAC_1_PI;
    const PANE: f32 = 1.0;
    const WORLD: f32 = 0.25;
    let mut builder = SceneBuilder::default();
    add(&mut builder, floor(8.0, 0.0), &emitter(0.5, OWN), CATCHER);
    builder.set_camera(parallel_camera(DVec3::Z * 2.0, DVec3::ZERO, 1.0, PIXELS));
    add_screen(&mut builder);
    let pane = material(&[
        ClosureRecord::Transparent { color: Rgb::splat(0.5) },
        ClosureRecord::Emission { radiance: Rgb::splat(PANE) },
    ]);
    add(&mut builder, floor(8.0, 1.0), &pane, visibility::CAMERA);
    let sun = lamp(LampShape::Sun { angle: 0.0 }, 1.0, DVec3::ZERO);
    builder.add_lamp(LampRecord { visibility: UNSEEN | visibility::CATCHER, ..sun });
    builder.set_world(WorldRecord { visibility: visibility::CAMERA, ..world(WORLD) });
    let mut settings = few_rays();
    // The pane is met by chance.
    (settings.gather.rays, settings.gather.camera_samples) = (256, 256);
    let picture = finish_and_render(builder, &settings);
    for (half, left) in halves(&picture).iter().zip([1.0, 0.5]) {
        let seen: Vec<f64> = half.iter().map(|pixel| f64::from(pixel[0])).collect();
        assert_close(mean(&seen), f64::from(PANE + 0.5 * WORLD * left), 0.005);
        assert!(half.iter().all(|pixel| pixel[3] == 1.0));
    }
}

/// From anywhere on the floor, an endless wall hides half of the light of an even sky.
#[test]
fn a_wall_takes_half_of_the_sky() {
    let mut builder = floor_below();
    let wall = cuboid(Vec3::new(1.0, -800.0, 0.0), Vec3::new(1.1, 800.0, 800.0));
    add(&mut builder, wall, &diffuse(0.0), UNSEEN);
    builder.set_world(transparent(world(1.0)));
    let picture = finish_and_render(builder, &few_rays());
    let alpha: Vec<f64> = picture.combined.chunks(4).map(|pixel| f64::from(pixel[3])).collect();
    assert_close(mean(&alpha), 0.5, 0.01);
    assert!(spread(&alpha, 0.5) < 0.1, "rms {}", spread(&alpha, 0.5));
}

/// In a closed room of catchers most light has come by way of its walls, with other objects and without.
#[test]
fn catchers_light_each_other() {
    let room = Room { pixels: PIXELS, ..Room::default() };
    let mut builder = SceneBuilder::default();
    add(&mut builder, cuboid(Vec3::splat(-1.0), Vec3::splat(1.0)), &diffuse(Room::WALLS), CATCHER);
    add(&mut builder, floor(0.01, 0.0), &diffuse(0.0), UNSEEN);
    builder.add_lamp(LampRecord {
        visibility: UNSEEN | visibility::CATCHER,
        ..point_lamp(10.0, DVec3::new(0.0, 0.0, 0.5))
    });
    builder.set_camera(room.camera());
    let (film, _) = expose(&builder.finish().expect("a room"), &settings(200_000, 32, 256));
    let left: Vec<f64> = film.shadow_catcher().iter().map(|&share| f64::from(share)).collect();
    assert_close(mean(&left), 1.0, 0.01);
}

/// What is no catcher looks as it did; a lamp that belongs to the other objects makes no shadow and no light.
#[test]
fn other_objects_and_their_lamps_are_no_shadow() {
    let ball = || sphere(3, 0.4, Vec3::new(0.0, 0.0, 0.4));
    let picture = |visible_to: u32, lamp: u32| {
        let mut builder = floor_below();
        add(&mut builder, ball(), &diffuse(0.8), visible_to);
        builder.add_lamp(LampRecord {
            visibility: UNSEEN | lamp,
            ..point_lamp(10.0, DVec3::new(2.0, 0.0, 4.0))
        });
        builder.set_world(transparent(WorldRecord::default()));
        finish_and_render(builder, &few_rays())
    };
    let all_ordinary = |lamp: u32| {
        let mut settings = few_rays();
        settings.effects.shadow_catcher = Switch::Off;
        let mut builder = floor_below();
        add(&mut builder, ball(), &diffuse(0.8), visibility::ALL);
        builder.add_lamp(LampRecord {
            visibility: UNSEEN | lamp,
            ..point_lamp(10.0, DVec3::new(2.0, 0.0, 4.0))
        });
        builder.set_world(transparent(WorldRecord::default()));
        finish_and_render(builder, &settings)
    };
    let center = ((PIXELS / 2 * PIXELS + PIXELS / 2) * 4) as usize;
    for lamp in [visibility::CATCHER, 0] {
        let (seen, ordinary) = (picture(visibility::ALL, lamp), all_ordinary(lamp));
        assert_eq!(seen.combined[center..center + 4], ordinary.combined[center..center + 4]);
        assert_eq!(seen.combined[..4], [0.0; 4], "in the light");
        let shadows =
            seen.combined.chunks(4).filter(|pixel| pixel[..3] == [0.0; 3] && pixel[3] > 0.5).count();
        assert_eq!(shadows > 0, lamp != 0, "{shadows} pixels in shadow");
    }
    assert!(picture(UNSEEN, 0).combined.iter().all(|value| *value == 0.0));
}

/// The plan names the catcher, and knows what it cost; switched off, or without one, there is no trace of it.
#[test]
fn it_costs_where_it_is_called_for() {
    let mut settings = few_rays();
    let plan = |settings: &RenderSettings, visible_to: u32| {
        let mut builder = SceneBuilder::default();
        add(&mut builder, floor(1.0, 0.0), &diffuse(0.5), visible_to);
        builder.add_lamp(lamp_above(10.0));
        builder.set_camera(parallel_camera(DVec3::Z * 2.0, DVec3::ZERO, 1.0, 64));
        let picture = finish_and_render(builder, settings);
        (picture.stats.effects[Effect::ShadowCatcher as usize].clone(), picture.combined)
    };
    let (on, _) = plan(&settings, CATCHER);
    assert_eq!(on.because, "'object' is a shadow catcher");
    assert!(on.computed && on.bytes > 0 && on.rays > 64 * 64 && on.seconds > 0.0, "{on:?}");
    let (none, ordinary) = plan(&settings, visibility::ALL);
    assert!(!none.computed && none.bytes == 0 && none.rays == 0, "{none:?}");
    settings.effects.shadow_catcher = Switch::Off;
    let (off, as_it_is) = plan(&settings, CATCHER);
    assert!(off.called_for && !off.computed && off.bytes == 0 && off.rays == 0, "{off:?}");
    assert_eq!(as_it_is, ordinary);
    settings.effects.shadow_catcher = Switch::On;
    let (without_one, picture) = plan(&settings, visibility::ALL);
    assert!(without_one.bytes == 0 && without_one.rays == 0, "{without_one:?}");
    assert_eq!(picture, ordinary);
}

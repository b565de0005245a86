//! The effects plan: its classes of light paths are a partition, nothing is paid for what is not called for, and what is
//! paid is told.

mod support;

use glam::{DMat4, DVec3, Vec3};
use rgp_renderer::color::Rgb;
use rgp_renderer::effects_plan::Effect;
use rgp_renderer::scene::record::{CameraRecord, ClosureRecord, LensRecord, MaterialRecord};
use rgp_renderer::scene::{Scene, SceneBuilder, visibility};
use rgp_renderer::settings::{EffectSettings, RenderSettings, Switch};
use rgp_renderer::stats::EffectStats;
use support::*;

const PATH_CLASSES: [Effect; 4] =
    [Effect::DirectLight, Effect::IndirectDiffuse, Effect::IndirectGlossy, Effect::Caustics];

/// A room with a ball, and its equipment.
fn room(ball: ClosureRecord) -> Room {
    Room { ball: material(&[ball]), pixels: 32, ..Room::default() }
}

fn glass() -> ClosureRecord {
    ClosureRecord::Glass { color: Rgb::WHITE, roughness: 0.0, ior: 1.5, multiscatter: true }
}

/// Everything there is: a diffuse room, a glass ball, a glossy and a mirror-like one, a panel that lets light through, a
/// lamp, a surface that shines, a world that is seen through a hole, and a camera with a lens. Diffuse and glossy colors are multiplied by `shade`.
fn builder_of_everything(pixels: u32, shade: f32) -> SceneBuilder {
    let room = Room { pixels, ..room(glass()) };
    let mut builder = room.equipment();
    let [_, (ball, glass)] = room.meshes();
    let walls = diffuse(Room::WALLS * shade);
    let low = Vec3::splat(-1.0);
    place(&mut builder, cuboid(low, Vec3::new(1.0, 1.0, -0.95)), std::slice::from_ref(&walls));
    place(&mut builder, cuboid(Vec3::new(-1.0, 0.95, -1.0), Vec3::splat(1.0)), &[walls]);
    let absorption = Rgb([0.5, 1.0, 2.0]);
    place(&mut builder, ball, &[MaterialRecord { absorption, ..glass }]);
    let steps = [-0.02, 0.02].map(|x| DMat4::from_translation(DVec3::X * x));
    builder.set_object_motion(2, &steps).expect("two steps of the ball");
    place(&mut builder, sphere(3, 0.3, Vec3::new(0.8, 0.1, -0.6)), &[glossy(0.8 * shade, 0.7)]);
    place(&mut builder, sphere(3, 0.2, Vec3::new(-0.3, 0.5, -0.7)), &[glossy(0.9, 0.0)]);
    let panel = [
        ClosureRecord::Transparent { color: Rgb::splat(0.5) },
        ClosureRecord::Diffuse { color: Rgb::splat(0.3 * shade), roughness: 0.0 },
    ];
    place(&mut builder, cuboid(Vec3::new(0.2, -0.3, -0.9), Vec3::new(0.3, 0.1, 0.2)), &[material(&panel)]);
    place(
        &mut builder,
        cuboid(Vec3::new(-0.9, 0.4, -0.9), Vec3::new(-0.6, 0.7, -0.6)),
        &[emitter(0.5 * shade, 2.0)],
    );
    builder.set_world(world(0.3));
    let lens = LensRecord { radius: 0.01, blades: 6, rotation: 0.2, ratio: 1.0, focus_distance: 1.0 };
    builder.set_camera(CameraRecord { lens: Some(lens), ..room.camera() });
    builder
}

fn everything(pixels: u32, shade: f32) -> Scene {
    builder_of_everything(pixels, shade).finish().expect("a scene with a camera")
}

/// The same with a shadow catcher, of which the picture holds a ratio of lights and not their sum.
fn everything_and_a_catcher(pixels: u32) -> Scene {
    let mut builder = builder_of_everything(pixels, 1.0);
    let block = cuboid(Vec3::new(-0.3, -0.2, -0.94), Vec3::new(0.1, 0.2, -0.7));
    let mesh = builder.add_mesh(block).expect("arrays that fit together");
    let material = builder.add_material(diffuse(0.5)) as u32;
    let visible_to = visibility::ALL | visibility::CATCHER;
    builder.add_object("catcher", mesh, DMat4::IDENTITY, vec![material], visible_to).expect("a mesh");
    builder.finish().expect("a scene with a camera")
}

/// Settings in which the switches of some effects are set.
fn switched(switch: Switch, effects: &[Effect]) -> RenderSettings {
    let mut settings = settings(40_000, 24, 64);
    let names = effects.iter().map(|effect| (effect.name().to_owned(), serde_json::json!(switch)));
    settings.effects =
        serde_json::from_value::<EffectSettings>(names.collect()).expect("effects are settings");
    settings
}

fn of(picture: &Picture, effect: Effect) -> &EffectStats {
    let found = picture.stats.effects.iter().find(|stats| stats.name == effect.name());
    found.expect("every effect is reported")
}

fn bits(picture: &Picture) -> Vec<u32> {
    picture.combined.iter().chain(&picture.indirect).map(|v| v.to_bits()).collect()
}

/// All classes together, and each of them alone on top of what is always seen: the lights themselves, as in a scene whose
/// diffuse and glossy surfaces are black.
#[test]
fn classes_of_light_paths_are_a_partition() {
    let scene = everything(32, 1.0);
    let all = render(&scene, &switched(Switch::Auto, &[]));
    let none = render(&scene, &switched(Switch::Off, &PATH_CLASSES));
    let black = render(&everything(32, 0.0), &switched(Switch::Auto, &[]));
    assert_same_light("none", &none.combined, &black.combined);
    let mut sum = none.combined.clone();
    for class in PATH_CLASSES {
        let others: Vec<_> = PATH_CLASSES.into_iter().filter(|&other| other != class).collect();
        let alone = render(&scene, &switched(Switch::Off, &others));
        let own: f64 =
            alone.radiance().iter().zip(none.radiance()).map(|(alone, none)| alone - none).sum::<f64>();
        let share = own / all.radiance().iter().sum::<f64>();
        assert!(share > 0.001, "{class:?} is {share} of the light");
        for (sum, (alone, none)) in sum.iter_mut().zip(alone.combined.iter().zip(&none.combined)) {
            *sum += alone - none;
        }
    }
    assert_same_light("sum", &sum, &all.combined);
}

/// Equal but for rounding.
#[track_caller]
fn assert_same_light(name: &str, found: &[f32], expected: &[f32]) {
    for (index, (found, expected)) in found.iter().zip(expected).enumerate() {
        let error = (found - expected).abs();
        assert!(error <= 1e-5 * expected.abs().max(1.0), "{name}, number {index}: {found} is not {expected}");
    }
}

/// A picture is the sum of the pictures by each light; photons and light samples are drawn anew, so within noise.
#[test]
fn lights_are_a_partition() {
    let scene = everything(32, 1.0);
    let lights = [Effect::EnvironmentLight, Effect::EmissiveMeshes];
    let light = |off: &[Effect]| {
        let mut settings = switched(Switch::Off, off);
        settings.photon_pass.photon_count = 400_000;
        mean(&render(&scene, &settings).radiance())
    };
    let lamp = light(&lights);
    let [world, mesh] = lights.map(|off| light(&lights.map(|_| off)));
    assert_close(world + mesh - lamp, light(&[]), 0.005);
    assert!(lamp < 0.9 * world && lamp < 0.9 * mesh);
}

/// Forcing on what nothing calls for changes no bit, traces no ray and takes no memory.
#[test]
fn on_changes_nothing_where_nothing_calls_for_it() {
    let scenes = [
        ("diffuse", room(ClosureRecord::Diffuse { color: Rgb::splat(0.5), roughness: 0.0 }).builder()),
        (
            "glossy",
            room(ClosureRecord::Glossy {
                color: Rgb::splat(0.8),
                roughness: 0.7,
                anisotropy: 0.0,
                rotation: 0.0,
                multiscatter: true,
            })
            .builder(),
        ),
        ("glass", room(glass()).builder()),
        ("one mirror in the world", {
            let mut builder = Room { lamps: 0, pixels: 16, ..Room::default() }.equipment();
            place(&mut builder, sphere(2, 0.5, Vec3::ZERO), &[glossy(0.9, 0.0)]);
            builder.set_world(world(1.0));
            builder
        }),
        ("no light", {
            let mut builder = Room { lamps: 0, pixels: 16, ..Room::default() }.equipment();
            place(&mut builder, sphere(2, 0.5, Vec3::ZERO), &[diffuse(0.5)]);
            builder
        }),
    ];
    for (name, builder) in scenes {
        let scene = builder.finish().expect("a scene with a camera");
        let auto = render(&scene, &switched(Switch::Auto, &[]));
        let idle: Vec<_> = Effect::ALL.into_iter().filter(|&e| !of(&auto, e).called_for).collect();
        assert!(idle.len() >= 4, "{name}");
        let forced = render(&scene, &switched(Switch::On, &idle));
        assert_eq!(bits(&auto), bits(&forced), "{name}");
        for effect in idle {
            assert!(of(&forced, effect).computed);
            let nothing = of(&auto, effect);
            assert_eq!((nothing.computed, nothing.rays, nothing.bytes), (false, 0, 0), "{name}, {effect:?}");
            assert_eq!(nothing.seconds.to_bits(), 0, "{name}, {effect:?}");
        }
    }
}

/// The diffuse room: no bins, no chains, no caustics, no rays behind transparent surfaces.
#[test]
fn a_diffuse_room_pays_for_nothing_else() {
    let picture = finish_and_render(Room::default().builder(), &switched(Switch::Auto, &[]));
    let called_for = Effect::ALL.map(|effect| of(&picture, effect).called_for);
    assert_eq!(
        called_for,
        [true, true, false, false, false, false, false, false, false, false, false, false]
    );
    assert_eq!((picture.stats.pyramid.bins, picture.stats.pyramid.glossy_cells), (0, 0));
    let rays = picture.stats.rays;
    let own: u64 = picture.stats.effects.iter().map(|effect| effect.rays).sum();
    assert_eq!(own, rays.gather + rays.shadow + rays.photon, "each ray is counted for one effect");
}

/// What is off is neither traced nor stored, and the scene still says who asked for it.
#[test]
fn off_leaves_out() {
    let scene = everything_and_a_catcher(32);
    let all = render(&scene, &switched(Switch::Auto, &[]));
    for effect in Effect::ALL {
        let off = render(&scene, &switched(Switch::Off, &[effect]));
        let (with, without) = (of(&all, effect), of(&off, effect));
        assert!(with.computed && !without.computed && without.called_for, "{effect:?}");
        assert_eq!(with.because, without.because);
        let traced_or_stored = (without.rays, without.bytes, without.seconds.to_bits());
        let also_follows = effect == Effect::IndirectDiffuse;
        assert!(also_follows || traced_or_stored == (0, 0, 0), "{effect:?}: {traced_or_stored:?}");
        assert_ne!(bits(&off), bits(&all), "{effect:?}");
        let brings_light = !matches!(
            effect,
            Effect::Absorption | Effect::DepthOfField | Effect::MotionBlur | Effect::ShadowCatcher
        );
        assert!(!brings_light || mean(&off.radiance()) < mean(&all.radiance()), "{effect:?} brings light");
    }
    let bare = render(&scene, &switched(Switch::Off, &Effect::ALL));
    let rays = bare.stats.rays;
    assert_eq!((rays.gather, rays.shadow, rays.photon), (0, 0, 0));
    assert_eq!((bare.stats.photons.emitted, bare.stats.pyramid.cells), (0, 0));
}

/// Reasons name what asks.
#[test]
fn reasons_are_named() {
    let picture = render(&everything(32, 1.0), &switched(Switch::Auto, &[]));
    let because = |effect| of(&picture, effect).because.as_str();
    assert_eq!(because(Effect::DirectLight), "lamp 'lamp'");
    assert_eq!(because(Effect::Caustics), "glass on 'object' (material 'material')");
    assert_eq!(because(Effect::EnvironmentLight), "color of world 'World'");
    let diffuse = finish_and_render(Room::default().builder(), &switched(Switch::Auto, &[]));
    assert_eq!(of(&diffuse, Effect::Caustics).because, "nothing in the scene asks for it");
}

/// Seconds and bytes are those of the passes, each counted once.
#[test]
fn costs_add_up() {
    let mut settings = switched(Switch::Auto, &[]);
    settings.gather.rays = 256;
    settings.photon_pass.photon_count = 200_000;
    let stats = render(&everything_and_a_catcher(96), &settings).stats;
    let sum: f64 = stats.effects.iter().map(|effect| effect.seconds).sum();
    let passes = stats.seconds.photon_pass + stats.seconds.pyramid + stats.seconds.gather;
    // All of the photon pass and of the pyramid belongs to effects; of the gather all but camera rays.
    let photons = stats.seconds.photon_pass + stats.seconds.pyramid;
    assert!(sum < passes && sum > 0.9 * photons, "{sum} s of {passes} s");
    for effect in &stats.effects {
        assert!(effect.seconds > 0.0, "{}", effect.name);
    }
    let bytes = |effect: Effect| stats.effects[effect as usize].bytes;
    assert!(bytes(Effect::IndirectGlossy) > 128 * 6 * stats.pyramid.glossy_cells);
    assert!(bytes(Effect::IndirectDiffuse) > 0 && bytes(Effect::EmissiveMeshes) >= 12 * 12);
}

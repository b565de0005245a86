//! What the render tests share: shapes, materials, lamps and cameras for scenes made in code, and how to render and
//! measure them.
#![allow(dead_code, reason = "each test file uses a part of this module")]

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

use glam::{DMat4, DVec3, Vec3};
use rgp_renderer::color::Rgb;
use rgp_renderer::film::Film;
use rgp_renderer::progress::Progress;
use rgp_renderer::render;
use rgp_renderer::scene::record::{
    CameraRecord, ClosureRecord, LampRecord, MaterialRecord, WeightedClosure, WorldRecord,
};
use rgp_renderer::scene::{
    LampShape, LightLinks, MeshArrays, ObjectInfo, Projection, Scene, SceneBuilder, visibility,
};
use rgp_renderer::settings::{PixelFilter, RenderSettings};
use rgp_renderer::stats::Stats;

/// The Embree library named by `RGP_EMBREE_LIBRARY`, else the one of the `embreex` package of the `python3` on the path.
pub(crate) fn library() -> &'static Path {
    static LIBRARY: OnceLock<PathBuf> = OnceLock::new();
    LIBRARY.get_or_init(|| {
        if let Some(path) = std::env::var_os("RGP_EMBREE_LIBRARY") {
            return path.into();
        }
        let script = "import glob, os, embreex; d = os.path.dirname(embreex.__file__); \
                      print((glob.glob(d + '.libs/*embree4*') + glob.glob(d + '/.dylibs/*embree4*') + [''])[0])";
        let output = Command::new("python3").args(["-c", script]).output();
        let found = output.map(|o| String::from_utf8_lossy(&o.stdout).trim().to_owned()).unwrap_or_default();
        assert!(
            Path::new(&found).is_file(),
            "These tests need Embree 4: `pip install embreex`, or set RGP_EMBREE_LIBRARY to the library file."
        );
        found.into()
    })
}

/// A sphere of 8 · 4ⁿ triangles, vertices at distance `radius` from `center`; edges lie along the coordinate planes.
pub(crate) fn sphere(subdivisions: u32, radius: f32, center: Vec3) -> MeshArrays {
    let mut faces = Vec::new();
    for x in [Vec3::X, Vec3::NEG_X] {
        for y in [Vec3::Y, Vec3::NEG_Y] {
            for z in [Vec3::Z, Vec3::NEG_Z] {
                faces.push(if x.cross(y).dot(z) > 0.0 { [x, y, z] } else { [x, z, y] });
            }
        }
    }
    for _ in 0..subdivisions {
        let split = |[a, b, c]: [Vec3; 3]| {
            let [ab, bc, ca] = [(a + b).normalize(), (b + c).normalize(), (c + a).normalize()];
            [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
        };
        faces = faces.into_iter().flat_map(split).collect();
    }
    soup("sphere", faces.into_iter().map(|face| face.map(|p| center + p * radius)))
}

/// A box of 12 triangles.
pub(crate) fn cuboid(low: Vec3, high: Vec3) -> MeshArrays {
    let quads = walls(low, high).map(|corners| {
        let [a, b, c, d] = corners;
        [[a, b, c], [a, c, d]]
    });
    soup("box", quads.into_iter().flatten())
}

/// The corners of a box's sides −x, +x, −y, +y, −z, +z, counter-clockwise seen from outside.
pub(crate) fn walls(low: Vec3, high: Vec3) -> [[Vec3; 4]; 6] {
    let p = |x: bool, y: bool, z: bool| {
        Vec3::new(
            if x { high.x } else { low.x },
            if y { high.y } else { low.y },
            if z { high.z } else { low.z },
        )
    };
    let (o, i) = (false, true);
    [
        [p(o, o, o), p(o, o, i), p(o, i, i), p(o, i, o)],
        [p(i, o, o), p(i, i, o), p(i, i, i), p(i, o, i)],
        [p(o, o, o), p(i, o, o), p(i, o, i), p(o, o, i)],
        [p(o, i, o), p(o, i, i), p(i, i, i), p(i, i, o)],
        [p(o, o, o), p(o, i, o), p(i, i, o), p(i, o, o)],
        [p(o, o, i), p(i, o, i), p(i, i, i), p(o, i, i)],
    ]
}

/// A quad of two triangles.
pub(crate) fn quad([a, b, c, d]: [Vec3; 4]) -> MeshArrays {
    soup("quad", [[a, b, c], [a, c, d]].into_iter())
}

/// A horizontal square about the point (0, 0, `z`), facing up.
pub(crate) fn floor(half: f32, z: f32) -> MeshArrays {
    let p = |x: f32, y: f32| Vec3::new(x * half, y * half, z);
    quad([p(-1.0, -1.0), p(1.0, -1.0), p(1.0, 1.0), p(-1.0, 1.0)])
}

/// A mesh of separate triangles.
pub(crate) fn soup(name: &str, triangles: impl Iterator<Item = [Vec3; 3]>) -> MeshArrays {
    let positions: Vec<[f32; 3]> = triangles.flatten().map(|p| p.to_array()).collect();
    let triangles = (0..positions.len() as u32 / 3).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    MeshArrays { name: name.into(), positions, triangles, ..MeshArrays::default() }
}

/// Surface of a mesh (m²).
pub(crate) fn area(mesh: &MeshArrays) -> f64 {
    let corner = |v: u32| Vec3::from(mesh.positions[v as usize]).as_dvec3();
    let areas = mesh.triangles.iter().map(|t| {
        let [a, b, c] = t.map(corner);
        0.5 * (b - a).cross(c - a).length()
    });
    areas.sum()
}

/// A material that is a sum of closures.
pub(crate) fn material(closures: &[ClosureRecord]) -> MaterialRecord {
    let weighted = |closure: &ClosureRecord| WeightedClosure { weight: Rgb::WHITE, closure: closure.clone() };
    MaterialRecord {
        name: "material".into(),
        closures: closures.iter().map(weighted).collect(),
        program: None,
        absorption: Rgb::BLACK,
    }
}

/// Lambert's reflector.
pub(crate) fn diffuse(albedo: f32) -> MaterialRecord {
    material(&[ClosureRecord::Diffuse { color: Rgb::splat(albedo), roughness: 0.0 }])
}

/// Lambert's reflector that emits `radiance` from both sides.
pub(crate) fn emitter(albedo: f32, radiance: f32) -> MaterialRecord {
    material(&[
        ClosureRecord::Diffuse { color: Rgb::splat(albedo), roughness: 0.0 },
        ClosureRecord::Emission { radiance: Rgb::splat(radiance) },
    ])
}

/// A GGX reflector.
pub(crate) fn glossy(color: f32, roughness: f32) -> MaterialRecord {
    material(&[ClosureRecord::Glossy {
        color: Rgb::splat(color),
        roughness,
        anisotropy: 0.0,
        rotation: 0.0,
        multiscatter: true,
    }])
}

/// A lamp at `position` that shines down.
pub(crate) fn lamp(shape: LampShape, power: f32, position: DVec3) -> LampRecord {
    LampRecord {
        name: "lamp".into(),
        shape,
        power: Rgb::splat(power),
        program: None,
        info: ObjectInfo::default(),
        world_from_lamp: rows(DMat4::from_translation(position)),
        visibility: visibility::ALL & !visibility::CAMERA,
        casts_shadow: true,
        links: LightLinks::ALL,
    }
}

/// A point lamp without size.
pub(crate) fn point_lamp(power: f32, position: DVec3) -> LampRecord {
    lamp(LampShape::Point { radius: 0.0, soft_falloff: false }, power, position)
}

/// A uniform world seen by everything.
pub(crate) fn world(radiance: f32) -> WorldRecord {
    let (radiance, visibility) = (Rgb::splat(radiance), visibility::ALL);
    WorldRecord { name: "World".into(), radiance, visibility, ..WorldRecord::default() }
}

/// Row-major rows of a matrix.
pub(crate) fn rows(matrix: DMat4) -> [[f64; 4]; 4] {
    matrix.transpose().to_cols_array_2d()
}

/// A camera of `pixels` × `pixels` at `from` that looks at `at`; `half_width` is the tangent of half its angle.
pub(crate) fn camera(from: DVec3, at: DVec3, half_width: f64, pixels: u32) -> CameraRecord {
    let direction = (at - from).normalize();
    let up = if direction.z.abs() > 0.9 { DVec3::Y } else { DVec3::Z };
    let x = direction.cross(up).normalize();
    let y = x.cross(direction);
    let [x, y, z] = [x, y, -direction].map(|axis| axis.extend(0.0));
    CameraRecord {
        name: "camera".into(),
        projection: Projection::Perspective,
        world_from_camera: rows(DMat4::from_cols(x, y, z, from.extend(1.0))),
        window: [-half_width, half_width, -half_width, half_width],
        resolution: [pixels, pixels],
        region: [0, 0, pixels, pixels],
        clip: [0.0, 1e12],
        lens: None,
        steps: Vec::new(),
        shutter: Vec::new(),
    }
}

/// The same with parallel rays; `half_width` in metres.
pub(crate) fn parallel_camera(from: DVec3, at: DVec3, half_width: f64, pixels: u32) -> CameraRecord {
    CameraRecord { projection: Projection::Orthographic, ..camera(from, at, half_width, pixels) }
}

/// Adds a mesh in place, with one material for each of its slots.
pub(crate) fn place(builder: &mut SceneBuilder, mesh: MeshArrays, materials: &[MaterialRecord]) {
    place_at(builder, mesh, materials, DMat4::IDENTITY);
}

/// Adds a mesh, moved by `world_from_object`.
pub(crate) fn place_at(
    builder: &mut SceneBuilder,
    mesh: MeshArrays,
    materials: &[MaterialRecord],
    world_from_object: DMat4,
) {
    let materials = materials.iter().map(|m| builder.add_material(m.clone()) as u32).collect();
    let mesh = builder.add_mesh(mesh).expect("arrays that fit together");
    builder
        .add_object("object", mesh, world_from_object, materials, visibility::ALL)
        .expect("indices that exist");
}

/// A closed room with a ball in it, lit by a square lamp: two metres wide about `shift` at a `scale` of one.
#[derive(Clone, Debug)]
pub(crate) struct Room {
    pub(crate) ball: MaterialRecord,
    pub(crate) scale: f64,
    pub(crate) shift: DVec3,
    /// Of all its lamps together (W).
    pub(crate) power: f32,
    /// Lamps, all at the same place.
    pub(crate) lamps: u32,
    pub(crate) pixels: u32,
}

impl Default for Room {
    fn default() -> Self {
        Self { ball: diffuse(0.5), scale: 1.0, shift: DVec3::ZERO, power: 10.0, lamps: 1, pixels: 24 }
    }
}

impl Room {
    pub(crate) const WALLS: f32 = 0.7;

    pub(crate) fn meshes(&self) -> [(MeshArrays, MaterialRecord); 2] {
        let ball = sphere(3, 0.4, Vec3::new(0.2, 0.3, -0.5));
        [(cuboid(Vec3::splat(-1.0), Vec3::splat(1.0)), diffuse(Self::WALLS)), (ball, self.ball.clone())]
    }

    /// Where the room's own coordinates lie in the world.
    pub(crate) fn placement(&self) -> DMat4 {
        DMat4::from_translation(self.shift) * DMat4::from_scale(DVec3::splat(self.scale))
    }

    /// All but the meshes.
    pub(crate) fn equipment(&self) -> SceneBuilder {
        let mut builder = SceneBuilder::default();
        let place = |x, y, z| self.placement().transform_point3(DVec3::new(x, y, z));
        let size = [(0.5 * self.scale) as f32; 2];
        for _ in 0..self.lamps {
            let shape = LampShape::Rectangle { size, spread: std::f32::consts::PI };
            builder.add_lamp(lamp(shape, self.power / self.lamps as f32, place(0.0, 0.0, 0.95)));
        }
        builder.set_camera(self.camera());
        builder
    }

    /// In a corner of the room.
    pub(crate) fn camera(&self) -> CameraRecord {
        let place = |x: f64, y: f64, z: f64| self.placement().transform_point3(DVec3::new(x, y, z));
        camera(place(-0.8, -0.7, 0.3), place(0.3, 0.3, -0.3), 0.9, self.pixels)
    }

    pub(crate) fn builder(&self) -> SceneBuilder {
        let mut builder = self.equipment();
        for (mesh, material) in self.meshes() {
            place_at(&mut builder, mesh, &[material], self.placement());
        }
        builder
    }
}

/// Settings of a small picture: box filter, so that each pixel is its own square.
pub(crate) fn settings(photons: u64, resolution: u32, rays: u32) -> RenderSettings {
    let mut settings = RenderSettings::default();
    settings.photon_pass.photon_count = photons;
    settings.pyramid.finest_resolution = resolution;
    settings.gather.rays = rays;
    settings.gather.camera_samples = 4;
    settings.film.filter = PixelFilter::Box;
    settings.film.filter_width = 1.0;
    settings
}

/// What a render gives.
#[derive(Debug)]
pub(crate) struct Picture {
    /// Red, green, blue and alpha.
    pub(crate) combined: Vec<f32>,
    /// Light scattered at least twice: red, green, blue.
    pub(crate) indirect: Vec<f32>,
    pub(crate) stats: Stats,
}

/// Renders a scene that must render.
pub(crate) fn render(scene: &Scene, settings: &RenderSettings) -> Picture {
    let (film, stats) = expose(scene, settings);
    Picture { combined: film.combined(), indirect: film.indirect(), stats }
}

/// The film of a scene that must render.
pub(crate) fn expose(scene: &Scene, settings: &RenderSettings) -> (Film, Stats) {
    let [_, _, width, height] = scene.camera.region;
    let film = Film::new(width, height, &settings.film);
    let mut stats = Stats::default();
    render::render(scene, settings, library(), &film, &Progress::default(), &mut stats)
        .expect("the scene renders");
    assert_eq!(stats.nonfinite_pixels, 0);
    (film, stats)
}

/// Renders what a builder holds.
pub(crate) fn finish_and_render(builder: SceneBuilder, settings: &RenderSettings) -> Picture {
    render(&builder.finish().expect("a scene with a camera"), settings)
}

impl Picture {
    /// Green of the whole light of each pixel.
    pub(crate) fn radiance(&self) -> Vec<f64> {
        self.combined.chunks(4).map(|pixel| f64::from(pixel[1])).collect()
    }

    /// Green of the indirect light of each pixel.
    pub(crate) fn indirect_radiance(&self) -> Vec<f64> {
        self.indirect.chunks(3).map(|pixel| f64::from(pixel[1])).collect()
    }
}

/// Mean of some pixels.
pub(crate) fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// Root of the mean squared deviation from `exact`, as a part of it.
pub(crate) fn spread(values: &[f64], exact: f64) -> f64 {
    (values.iter().map(|v| (v / exact - 1.0).powi(2)).sum::<f64>() / values.len() as f64).sqrt()
}

/// Fails unless `value` is `expected` to a part of `tolerance`.
#[track_caller]
pub(crate) fn assert_close(value: f64, expected: f64, tolerance: f64) {
    let error = (value / expected - 1.0).abs();
    assert!(error <= tolerance, "{value} is not {expected}: off by {error:.2e}, allowed are {tolerance:.1e}");
}

//! Scenes, quadrature and random numbers the light tests share.
#![allow(dead_code, reason = "each test file uses some of it")]

use std::sync::Arc;

use glam::{DAffine3, DMat3, DVec3, Vec3};
use rgp_renderer::color::Rgb;
use rgp_renderer::light::Lights;
use rgp_renderer::scene::{
    Camera, Lamp, LampProgram, LampShape, LightLinks, Material, Mesh, Object, ObjectInfo, Projection, Scene,
    SceneSpace, Shutter, World, visibility,
};
use rgp_renderer::shader::{Aside, Instruction, Program, Quantity, VectorFunction};

/// A ray kind for look-ups: any one bit.
pub(crate) const KIND: u32 = visibility::DIFFUSE;

/// A lamp at `position` that shines along −Z, its power the same in each channel.
pub(crate) fn lamp(shape: LampShape, power: f32, position: Vec3) -> Lamp {
    Lamp {
        name: "lamp".into(),
        shape,
        power: Rgb::splat(power),
        program: None,
        position,
        x_axis: Vec3::X,
        y_axis: Vec3::NEG_Y,
        axis: Vec3::NEG_Z,
        stretch: [1.0, 1.0],
        visibility: visibility::ALL,
        casts_shadow: true,
        links: LightLinks::ALL,
    }
}

/// The lamp turned by an arbitrary rotation about its position.
pub(crate) fn turned(mut lamp: Lamp) -> Lamp {
    let rotation = glam::Quat::from_euler(glam::EulerRot::XYZ, 0.4, -0.3, 1.1);
    lamp.x_axis = rotation * lamp.x_axis;
    lamp.y_axis = rotation * lamp.y_axis;
    lamp.axis = rotation * lamp.axis;
    lamp
}

/// The lamp with nodes that compute a factor of its power: the last of these instructions.
pub(crate) fn with_nodes(mut lamp: Lamp, instructions: Vec<Instruction>) -> Lamp {
    let axes = DMat3::from_cols(lamp.x_axis.as_dvec3(), lamp.y_axis.as_dvec3(), -lamp.axis.as_dvec3());
    let world_from_lamp = DAffine3::from_mat3_translation(axes, lamp.position.as_dvec3());
    let factor = instructions.len() as u16 - 1;
    let program = Program::new(instructions, 0).expect("the instructions fit together");
    let lamp_from_world = world_from_lamp.inverse();
    lamp.program = Some(LampProgram { program, factor, info: ObjectInfo::default(), lamp_from_world });
    lamp
}

/// What a program asks of the point it is run for.
pub(crate) fn asked(quantity: Quantity) -> Instruction {
    Instruction::Geometry { quantity, aside: Aside::HERE }
}

/// The channels of two results, multiplied or added.
pub(crate) fn vector_math(function: VectorFunction, a: u16, b: u16) -> Instruction {
    Instruction::VectorMath { function, a, b, c: 0 }
}

/// A mesh object in one material slot per triangle.
pub(crate) fn object(
    positions: &[Vec3],
    triangles: &[[u32; 3]],
    materials: Vec<u32>,
    place: Option<DAffine3>,
) -> Object {
    let slots = (0..triangles.len() as u16).collect();
    let mesh =
        Mesh { positions: positions.to_vec(), triangles: triangles.to_vec(), slots, ..Mesh::default() };
    Object {
        name: "object".into(),
        mesh: Arc::new(mesh),
        scene_from_mesh: place,
        motion: Vec::new(),
        object_from_scene: DAffine3::IDENTITY,
        info: ObjectInfo::default(),
        materials,
        visibility: visibility::ALL,
        receiver: 1,
        links: LightLinks::ALL,
    }
}

/// A scene in the unit cube; its camera is never used.
pub(crate) fn scene(lamps: Vec<Lamp>, objects: Vec<Object>, world_radiance: f32) -> Scene {
    let material =
        Material { name: "material".into(), closures: Vec::new(), program: None, absorption: Rgb::BLACK };
    Scene {
        space: SceneSpace { center: DVec3::ZERO, scale: 1.0 },
        objects,
        materials: vec![material; 8],
        textures: Vec::new().into(),
        lamps,
        camera: Camera {
            name: "camera".into(),
            lens: None,
            projection: Projection::Perspective,
            scene_from_camera: DAffine3::IDENTITY,
            window: [-1.0, 1.0, -1.0, 1.0],
            resolution: [8, 8],
            region: [0, 0, 8, 8],
            clip: [0.1, 10.0],
            motion: Vec::new(),
            windows: Vec::new(),
            shutter: Shutter::default(),
        },
        world: World {
            radiance: Rgb::splat(world_radiance),
            visibility: visibility::ALL,
            ..World::default()
        },
        bounds: [Vec3::splat(-0.5), Vec3::splat(0.5)],
        problems: Vec::new(),
    }
}

/// Lights of a scene with this one lamp.
pub(crate) fn one_lamp(lamp: Lamp) -> Lights {
    Lights::build(&scene(vec![lamp], Vec::new(), 0.0), &[])
}

/// Irradiance at `p` on a surface of normal `n`, first channel, from `sample_direct` on a grid of `steps`² places; the
/// choice of light and triangle takes `choices` steps.
pub(crate) fn irradiance(lights: &Lights, p: Vec3, n: Vec3, choices: usize, steps: usize) -> f64 {
    let mid = |i: usize, count: usize| (i as f32 + 0.5) / count as f32;
    let mut sum = 0.0;
    for c in 0..choices {
        for i in 0..steps * steps {
            let u = [mid(c, choices), mid(i % steps, steps), mid(i / steps, steps)];
            if let Some(sample) = lights.sample_direct(p, u) {
                sum += f64::from(sample.radiance_over_pdf.0[0]) * f64::from(sample.wi.dot(n).max(0.0));
            }
        }
    }
    sum / (choices * steps * steps) as f64
}

/// Lambert's formula: irradiance at `p` from a polygon of radiance 1, all of it above the surface of normal `n`.
/// Corners are counter-clockwise seen from `p`.
pub(crate) fn polygon_irradiance(p: DVec3, n: DVec3, corners: &[DVec3]) -> f64 {
    let towards: Vec<DVec3> = corners.iter().map(|&c| (c - p).normalize()).collect();
    let edges = towards.iter().zip(towards.iter().cycle().skip(1));
    0.5 * edges.map(|(a, b)| a.angle_between(*b) * n.dot(b.cross(*a).normalize())).sum::<f64>()
}

/// Fails unless `value` is within the relative error `tolerance` of `expected`.
#[track_caller]
pub(crate) fn assert_close(value: f64, expected: f64, tolerance: f64) {
    assert!(
        (value - expected).abs() <= tolerance * expected.abs(),
        "{value} is not {expected}: ratio {}",
        value / expected
    );
}

/// SplitMix64: enough for tests.
pub(crate) struct Random(pub(crate) u64);

impl Random {
    /// Uniform in 0..1, with the 24 bits of an f32.
    pub(crate) fn uniform(&mut self) -> f32 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 40) as f32 / (1 << 24) as f32
    }

    /// Several at once.
    pub(crate) fn uniforms<const N: usize>(&mut self) -> [f32; N] {
        std::array::from_fn(|_| self.uniform())
    }

    /// A direction, uniform over the sphere.
    pub(crate) fn direction(&mut self) -> Vec3 {
        let [a, b] = self.uniforms();
        let z = 1.0 - 2.0 * a;
        let (sin, cos) = (std::f32::consts::TAU * b).sin_cos();
        let radius = (1.0 - z * z).max(0.0).sqrt();
        Vec3::new(radius * cos, radius * sin, z).normalize()
    }
}

/// Distance along a ray at which it meets a triangle (Möller and Trumbore).
pub(crate) fn meets(from: Vec3, wi: Vec3, corners: [DVec3; 3]) -> Option<f64> {
    let [a, b, c] = corners;
    let (wi, s) = (wi.as_dvec3(), from.as_dvec3() - a);
    let across = wi.cross(c - a);
    let scale = 1.0 / (b - a).dot(across);
    let u = s.dot(across) * scale;
    let q = s.cross(b - a);
    let v = wi.dot(q) * scale;
    let t = (c - a).dot(q) * scale;
    (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t > 0.0).then_some(t)
}

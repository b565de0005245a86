//! Materials that vary over their surface: a program of constants changes nothing, and a texture is seen as it is.

mod support;

use glam::{DVec3, Vec3};
use rgp_renderer::color::Rgb;
use rgp_renderer::scene::record::{ClosureRecord, Input, MaterialRecord, OutputRecord, ProgramRecord};
use rgp_renderer::scene::{CornerLayer, SceneBuilder};
use rgp_renderer::shader::{
    Aside, Encoding, Extension, Instruction, Interpolation, Pixels, Quantity, Texture, VectorFunction,
};
use support::*;

/// A material whose program sets inputs of its first closure to constants.
fn programmed(closure: ClosureRecord, inputs: &[(Input, f32)]) -> MaterialRecord {
    let mut record = material(&[closure]);
    let constant = |&(_, value): &(Input, f32)| Instruction::Constant { value: [value, value, value, 1.0] };
    let output = |(register, &(input, _)): (usize, &(Input, f32))| OutputRecord {
        closure: 0,
        input,
        register: register as u16,
    };
    record.program = Some(ProgramRecord {
        instructions: inputs.iter().map(constant).collect(),
        outputs: inputs.iter().enumerate().map(output).collect(),
        normal: None,
    });
    record
}

#[track_caller]
fn same_picture(constant: MaterialRecord, varying: MaterialRecord) {
    let picture = |ball: MaterialRecord| {
        let room = Room { ball, ..Room::default() };
        render(&room.builder().finish().expect("a scene"), &settings(50_000, 32, 16)).radiance()
    };
    let (expected, found) = (picture(constant), picture(varying));
    let differing = expected.iter().zip(&found).filter(|(a, b)| (*a / *b - 1.0).abs() > 1e-3).count();
    // Rounding may turn a roulette here and there.
    assert!(differing * 50 < expected.len(), "{differing} of {} pixels differ", expected.len());
    assert_close(mean(&found), mean(&expected), 1e-3);
}

#[test]
fn a_program_of_constants_changes_no_lambert_surface() {
    let varying = programmed(ClosureRecord::Diffuse { color: Rgb::splat(0.9) }, &[(Input::Color, 0.3)]);
    same_picture(diffuse(0.3), varying);
}

#[test]
fn a_program_of_constants_changes_no_glossy_surface() {
    let typical = ClosureRecord::Glossy { color: Rgb::splat(0.1), roughness: 0.2 };
    let varying = programmed(typical, &[(Input::Color, 0.8), (Input::Roughness, 0.7)]);
    same_picture(glossy(0.8, 0.7), varying);
}

#[test]
fn a_program_of_constants_changes_no_share() {
    let clear = ClosureRecord::Transparent { color: Rgb::WHITE };
    let mut constant = material(&[ClosureRecord::Diffuse { color: Rgb::splat(0.5) }, clear.clone()]);
    let mut varying = constant.clone();
    for part in &mut constant.closures {
        part.weight = Rgb::splat(0.5);
    }
    let output = |closure| OutputRecord { closure, input: Input::Weight, register: 0 };
    varying.program = Some(ProgramRecord {
        instructions: vec![Instruction::Constant { value: [0.5; 4] }],
        outputs: vec![output(0), output(1)],
        normal: None,
    });
    same_picture(constant, varying);
}

/// A square with texture coordinates from (0, 0) to (1, 1), and a material of 2 x 2 albedos.
fn textured_floor(builder: &mut SceneBuilder, albedos: [f32; 4], interpolation: Interpolation) {
    let texels = albedos.map(|albedo| [albedo, albedo, albedo, 1.0]).to_vec();
    let texture = Texture::new([2, 2], Pixels::Floats(texels), Encoding::Linear).expect("four texels");
    let texture = builder.add_texture(texture) as u32;
    let mut record = diffuse(0.5);
    let extension = Extension::Repeat;
    record.program = Some(ProgramRecord {
        instructions: vec![
            Instruction::Attribute { attribute: 3, aside: Aside::Here },
            Instruction::Image { texture, vector: 0, extension, interpolation, unassociate: false },
        ],
        outputs: vec![OutputRecord { closure: 0, input: Input::Color, register: 1 }],
        normal: None,
    });
    let mut mesh = floor(1.0, 0.0);
    let uv = |corner: Vec3| [(corner.x + 1.0) * 0.5, (corner.y + 1.0) * 0.5];
    let corner = |&v: &u32| uv(Vec3::from(mesh.positions[v as usize]));
    let values = mesh.triangles.iter().flatten().flat_map(corner).collect();
    mesh.layers = vec![CornerLayer { attribute: 3, channels: 2, values }];
    place(builder, mesh, &[record]);
}

/// Under an even sky a surface is as bright as its albedo.
#[test]
fn each_texel_is_seen_in_its_place() {
    let albedos = [0.1, 0.3, 0.6, 0.9];
    let mut builder = SceneBuilder::default();
    textured_floor(&mut builder, albedos, Interpolation::Closest);
    builder.set_world(world(1.0));
    builder.set_camera(parallel_camera(DVec3::Z * 2.0, DVec3::ZERO, 1.0, 8));
    let picture = finish_and_render(builder, &settings(1000, 16, 64));
    for (i, radiance) in picture.radiance().iter().enumerate() {
        let (column, row) = (i % 8 / 4, i / 8 / 4);
        assert_close(*radiance, f64::from(albedos[2 * row + column]), 0.02);
    }
    assert_eq!((picture.stats.textures.images, picture.stats.textures.bytes), (1, 5 * 16));
}

/// What a gather ray sees of a texture as wide as it is, is the texture's mean.
#[test]
fn indirect_light_has_the_mean_color_of_a_texture() {
    let wall = |albedos: Option<[f32; 4]>| {
        let mut builder = SceneBuilder::default();
        match albedos {
            Some(albedos) => textured_floor(&mut builder, albedos, Interpolation::Linear),
            None => place(&mut builder, floor(1.0, 0.0), &[diffuse(0.5)]),
        }
        place(&mut builder, floor(1.0, 1.0), &[diffuse(0.8)]);
        builder.add_lamp(point_lamp(10.0, DVec3::new(0.0, 0.0, 0.9)));
        let receiver = DVec3::new(0.0, 0.0, 1.0);
        builder.set_camera(parallel_camera(receiver - DVec3::Z * 0.05, receiver, 0.05, 8));
        mean(&finish_and_render(builder, &settings(200_000, 64, 128)).indirect_radiance())
    };
    assert_close(wall(Some([0.2, 0.8, 0.8, 0.2])), wall(None), 0.01);
}

/// A normal that a program makes may have any length: under an even sky a surface is as bright as its albedo.
#[test]
fn the_length_of_a_normal_does_not_matter() {
    for length in [0.2, 5.0] {
        let mut record = diffuse(0.5);
        record.program = Some(ProgramRecord {
            instructions: vec![
                Instruction::Geometry { quantity: Quantity::Normal, aside: Aside::Here },
                Instruction::Constant { value: [length; 4] },
                Instruction::VectorMath { function: VectorFunction::Scale, a: 0, b: 0, c: 1 },
            ],
            outputs: Vec::new(),
            normal: Some(2),
        });
        let mut builder = SceneBuilder::default();
        place(&mut builder, floor(1.0, 0.0), &[record]);
        builder.set_world(world(1.0));
        builder.set_camera(parallel_camera(DVec3::Z * 2.0, DVec3::ZERO, 1.0, 8));
        for radiance in finish_and_render(builder, &settings(1000, 16, 64)).radiance() {
            assert_close(radiance, 0.5, 0.02);
        }
    }
}

/// A mask may be dark where it is typical and bright elsewhere: it lights the scene all the same.
#[test]
fn what_may_emit_is_a_light() {
    let dark = ClosureRecord::Emission { radiance: Rgb::BLACK };
    let mut builder = SceneBuilder::default();
    place(&mut builder, floor(1.0, 1.0), &[programmed(dark, &[(Input::Radiance, 2.0)])]);
    place(&mut builder, floor(1.0, 0.0), &[diffuse(0.5)]);
    builder.set_camera(parallel_camera(DVec3::Z * 0.5, DVec3::ZERO, 0.5, 8));
    let picture = finish_and_render(builder, &settings(10_000, 16, 64));
    assert!(mean(&picture.radiance()) > 0.1, "the floor is lit");
    let called_for = |name| picture.stats.effects.iter().any(|e| e.name == name && e.called_for);
    assert!(called_for("emissive_meshes") && called_for("direct_light"));
}

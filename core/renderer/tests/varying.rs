//! Materials that vary over their surface: a program of constants changes nothing, and a texture is seen as it is.

mod support;

use glam::{DVec3, Vec3};
use rgp_renderer::color::Rgb;
use rgp_renderer::scene::record::{
    ClosureRecord, Input, MaterialRecord, OutputRecord, ProgramRecord, WorldProgramRecord, WorldRecord,
};
use rgp_renderer::scene::{CornerLayer, MeshArrays, SceneBuilder};
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
        normals: Vec::new(),
        tangents: Vec::new(),
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
    let varying =
        programmed(ClosureRecord::Diffuse { color: Rgb::splat(0.9), roughness: 0.0 }, &[(Input::Color, 0.3)]);
    same_picture(diffuse(0.3), varying);
}

#[test]
fn a_program_of_constants_changes_no_glossy_surface() {
    let typical = ClosureRecord::Glossy {
        color: Rgb::splat(0.1),
        roughness: 0.2,
        anisotropy: 0.0,
        rotation: 0.0,
        multiscatter: true,
    };
    let varying = programmed(typical, &[(Input::Color, 0.8), (Input::Roughness, 0.7)]);
    same_picture(glossy(0.8, 0.7), varying);
}

#[test]
fn a_program_of_constants_changes_no_rough_diffuse_surface() {
    let rough = |roughness| ClosureRecord::Diffuse { color: Rgb::splat(0.7), roughness };
    same_picture(material(&[rough(0.9)]), programmed(rough(0.0), &[(Input::Roughness, 0.9)]));
}

#[test]
fn a_program_of_constants_changes_no_share() {
    let clear = ClosureRecord::Transparent { color: Rgb::WHITE };
    let mut constant =
        material(&[ClosureRecord::Diffuse { color: Rgb::splat(0.5), roughness: 0.0 }, clear.clone()]);
    let mut varying = constant.clone();
    for part in &mut constant.closures {
        part.weight = Rgb::splat(0.5);
    }
    let output = |closure| OutputRecord { closure, input: Input::Weight, register: 0 };
    varying.program = Some(ProgramRecord {
        instructions: vec![Instruction::Constant { value: [0.5; 4] }],
        outputs: vec![output(0), output(1)],
        normal: None,
        normals: Vec::new(),
        tangents: Vec::new(),
    });
    same_picture(constant, varying);
}

/// 2 x 2 texels.
fn four_texels(grays: [f32; 4]) -> Texture {
    let texels = grays.map(|gray| [gray, gray, gray, 1.0]).to_vec();
    Texture::new([2, 2], Pixels::Floats(texels), Encoding::Linear).expect("four texels")
}

/// A program that sets one input of the first closure to a texture.
fn texture_program(
    builder: &mut SceneBuilder,
    texture: Texture,
    interpolation: Interpolation,
    input: Input,
) -> Option<ProgramRecord> {
    let texture = builder.add_texture(texture) as u32;
    let extension = Extension::Repeat;
    Some(ProgramRecord {
        instructions: vec![
            Instruction::Attribute { attribute: 3, aside: Aside::HERE },
            Instruction::Image { texture, vector: 0, extension, interpolation, unassociate: false },
        ],
        outputs: vec![OutputRecord { closure: 0, input, register: 1 }],
        normal: None,
        normals: Vec::new(),
        tangents: Vec::new(),
    })
}

/// A square in the plane z, with texture coordinates from (0, 0) to (1, 1).
fn square_with_coordinates(half: f32, z: f32) -> MeshArrays {
    let mut mesh = floor(half, z);
    let uv = |corner: Vec3| [(corner.x / half + 1.0) * 0.5, (corner.y / half + 1.0) * 0.5];
    let corner = |&v: &u32| uv(Vec3::from(mesh.positions[v as usize]));
    let values = mesh.triangles.iter().flatten().flat_map(corner).collect();
    mesh.layers = vec![CornerLayer { attribute: 3, channels: 2, values }];
    mesh
}

/// A square with texture coordinates from (0, 0) to (1, 1), and a material of 2 x 2 albedos.
fn textured_floor(builder: &mut SceneBuilder, albedos: [f32; 4], interpolation: Interpolation) {
    let mut record = diffuse(0.5);
    record.program = texture_program(builder, four_texels(albedos), interpolation, Input::Color);
    place(builder, square_with_coordinates(1.0, 0.0), &[record]);
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
                Instruction::Geometry { quantity: Quantity::Normal, aside: Aside::HERE },
                Instruction::Constant { value: [length; 4] },
                Instruction::VectorMath { function: VectorFunction::Scale, a: 0, b: 0, c: 1 },
            ],
            outputs: Vec::new(),
            normal: Some(2),
            normals: Vec::new(),
            tangents: Vec::new(),
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

/// A panel above a floor and below a ceiling, its left half bright, its right half dark: one square with a texture of
/// emission, or two rectangles. Mean light of the left and the right half of the floor: direct, indirect.
fn below_a_panel(is_textured: bool) -> [[f64; 2]; 2] {
    let radiances = [8.0, 1.0];
    let mut builder = SceneBuilder::default();
    if is_textured {
        let typical = ClosureRecord::Emission { radiance: Rgb::splat(4.5) };
        let mut record =
            material(&[typical, ClosureRecord::Diffuse { color: Rgb::splat(0.5), roughness: 0.0 }]);
        let [bright, dark] = radiances;
        let texels = four_texels([bright, dark, bright, dark]);
        record.program = texture_program(&mut builder, texels, Interpolation::Closest, Input::Radiance);
        place(&mut builder, square_with_coordinates(0.5, 0.3), &[record]);
    } else {
        for (i, radiance) in radiances.into_iter().enumerate() {
            let left = i as f32 * 0.5 - 0.5;
            let corner = |x: f32, y: f32| Vec3::new(left + x, y, 0.3);
            let half = quad([corner(0.0, -0.5), corner(0.5, -0.5), corner(0.5, 0.5), corner(0.0, 0.5)]);
            place(&mut builder, half, &[emitter(0.5, radiance)]);
        }
    }
    place(&mut builder, floor(1.0, 0.0), &[diffuse(0.5)]);
    place(&mut builder, floor(1.0, 0.6), &[diffuse(0.8)]);
    builder.set_camera(parallel_camera(DVec3::Z * 0.25, DVec3::ZERO, 0.5, 16));
    let picture = finish_and_render(builder, &settings(400_000, 64, 256));
    let indirect = picture.indirect_radiance();
    let direct: Vec<f64> = picture.radiance().iter().zip(&indirect).map(|(all, part)| all - part).collect();
    [direct, indirect].map(|values| {
        [0, 1].map(|side| {
            let of_side = values.iter().enumerate().filter(|(i, _)| i % 16 / 8 == side);
            mean(&of_side.map(|(_, value)| *value).collect::<Vec<_>>())
        })
    })
}

/// Direct light and photons are what the texture emits where they start, not its mean.
#[test]
fn a_textured_emitter_shines_as_its_parts_would() {
    let (parts, textured) = (below_a_panel(false), below_a_panel(true));
    for (parts, textured) in parts.into_iter().flatten().zip(textured.into_iter().flatten()) {
        assert_close(textured, parts, 0.01);
    }
}

/// Direct light counts that the world could have been chosen instead of the panel.
#[test]
fn a_panel_of_constant_emission_beside_an_uneven_sky() {
    let picture = |panel: MaterialRecord| {
        let mut builder = SceneBuilder::default();
        place(&mut builder, floor(0.5, 0.3), &[panel]);
        place(&mut builder, floor(1.0, 0.0), &[diffuse(0.5)]);
        let instructions = vec![
            Instruction::Geometry { quantity: Quantity::Position, aside: Aside::HERE },
            Instruction::VectorMath { function: VectorFunction::Absolute, a: 0, b: 0, c: 0 },
        ];
        let program = Some(WorldProgramRecord { instructions, radiance: 1 });
        builder.set_world(WorldRecord { program, ..world(1.0) });
        builder.set_camera(parallel_camera(DVec3::Z * 0.25, DVec3::ZERO, 0.5, 16));
        finish_and_render(builder, &settings(50_000, 32, 64)).radiance()
    };
    let constant = material(&[ClosureRecord::Emission { radiance: Rgb::splat(3.0) }]);
    let typical = ClosureRecord::Emission { radiance: Rgb::splat(2.0) };
    let varying = programmed(typical, &[(Input::Radiance, 3.0)]);
    assert_close(mean(&picture(varying)), mean(&picture(constant)), 0.01);
}

/// Seen from far outside the scene, a texture is as wide as it is from within: a pixel shows the mean of what it covers.
#[test]
fn a_texture_far_from_the_camera_is_seen_at_the_width_of_a_pixel() {
    let mut builder = SceneBuilder::default();
    let texels: Vec<_> = (0..256 * 256_u32)
        .map(|i| {
            let gray = if (i.wrapping_mul(2_654_435_761) >> 16) & 1 == 0 { 0.2 } else { 0.8 };
            [gray, gray, gray, 1.0]
        })
        .collect();
    let texture = Texture::new([256, 256], Pixels::Floats(texels), Encoding::Linear).expect("texels");
    let mut record = diffuse(0.5);
    record.program = texture_program(&mut builder, texture, Interpolation::Linear, Input::Color);
    place(&mut builder, square_with_coordinates(1.0, 0.0), &[record]);
    builder.set_world(world(1.0));
    builder.set_camera(camera(DVec3::Z * 50.0, DVec3::ZERO, 0.02, 8));
    let mut settings = settings(1000, 16, 64);
    settings.gather.camera_samples = 1;
    let radiance = finish_and_render(builder, &settings).radiance();
    assert!(spread(&radiance, 0.5) < 0.08, "pixels differ by {}", spread(&radiance, 0.5));
}

/// Taken over a step e, the slope of x² is 2x ± e, and the mean of its normal's x component between -1/2 and 1/2 is half the
/// difference of two square roots.
#[test]
fn the_slope_of_a_bump_is_taken_over_its_filter_width() {
    for filter_width in [0.1, 4.0] {
        let mut record = material(&[ClosureRecord::Emission { radiance: Rgb::WHITE }]);
        let position = |aside| Instruction::Geometry { quantity: Quantity::Position, aside: Aside(aside) };
        let squared = |a| Instruction::VectorMath { function: VectorFunction::Multiply, a, b: a, c: a };
        let x = |of| Instruction::Channel { of, channel: 0 };
        let instructions = vec![
            position([0.0; 2]),
            position([filter_width, 0.0]),
            position([0.0, filter_width]),
            squared(0),
            squared(1),
            squared(2),
            x(3),
            x(4),
            x(5),
            Instruction::Geometry { quantity: Quantity::Normal, aside: Aside::HERE },
            Instruction::Constant { value: [1.0; 4] },
            Instruction::Bump {
                strength: 10,
                distance: 10,
                height: 6,
                height_x: 7,
                height_y: 8,
                normal: 9,
                invert: false,
                filter_width,
            },
            Instruction::VectorMath { function: VectorFunction::Add, a: 11, b: 10, c: 10 },
            x(12),
        ];
        let output = OutputRecord { closure: 0, input: Input::Radiance, register: 13 };
        record.program = Some(ProgramRecord {
            instructions,
            outputs: vec![output],
            normal: None,
            normals: Vec::new(),
            tangents: Vec::new(),
        });
        let mut builder = SceneBuilder::default();
        place(&mut builder, floor(1.0, 0.0), &[record]);
        builder.set_camera(parallel_camera(DVec3::Z, DVec3::ZERO, 0.5, 16));
        let mut settings = settings(1000, 16, 16);
        settings.gather.camera_samples = 64;
        let found = mean(&finish_and_render(builder, &settings).radiance()) - 1.0;
        let e = f64::from(filter_width) / 16.0 / 8.0;
        let expected = (1.0_f64.hypot(1.0 + e) - 1.0_f64.hypot(1.0 - e)) / 2.0;
        assert!((found.abs() - expected).abs() < 0.05 * expected + 5e-4, "{found}, not ±{expected}");
    }
}

//! Whatever a program is, it is refused with a message or runs to its end.

use std::f32::consts::{PI, TAU};

use glam::{Vec3, Vec4};
use proptest::prelude::{ProptestConfig, Strategy, prop, prop_assert, prop_assert_eq, prop_oneof, proptest};
use rgp_renderer::shader::{
    Aside, Encoding, Extension, Instruction, Interpolation, MOST_INSTRUCTIONS, NormalSpace, PhotometricWeb,
    Pixels, Point, Program, Quantity, Texture, Tile, Value,
};
use serde_json::{Value as Json, json};

/// Answers every question with the same numbers.
struct Anywhere(Vec4);

impl Point for Anywhere {
    fn attribute(&self, _attribute: u32, _aside: Aside) -> Value {
        Value { v: self.0, width: self.0.w }
    }

    fn geometry(&self, _quantity: Quantity, _aside: Aside) -> Value {
        Value { v: self.0, width: self.0.w }
    }

    fn steps(&self, _widths: f32) -> [Vec3; 2] {
        [Vec3::X * self.0.x, Vec3::Y]
    }

    fn tangents(&self, attribute: u32) -> Option<[Vec3; 3]> {
        (attribute > 0).then_some([Vec3::X, Vec3::Y, Vec3::Z])
    }

    fn world_normal(&self, normal: Vec3) -> Vec3 {
        normal
    }
}

fn textures() -> Vec<Texture> {
    let texels = (0..15).map(|i| [i as f32, 1.0, f32::MAX, 0.5]).collect();
    vec![Texture::new([5, 3], Pixels::Floats(texels), Encoding::Linear).expect("fifteen texels")]
}

/// Instructions of every kind, their operands drawn from `r`.
fn any_instruction(kind: usize, r: [u16; 10], x: [f32; 4]) -> Instruction {
    let extension = ["repeat", "extend", "clip", "mirror"][r[1] as usize % 4];
    let image = |op: &str, more: Json| {
        let mut all = json!({"op": op, "texture": r[8] % 2, "vector": r[0], "extension": extension, "interpolation": "linear", "unassociate": true});
        all.as_object_mut().expect("an object").extend(more.as_object().expect("an object").clone());
        all
    };
    let maths =
        ["POWER", "DIVIDE", "MODULO", "WRAP", "PINGPONG", "LOGARITHM", "SMOOTH_MIN", "SNAP", "TANGENT"];
    let vectors = ["REFRACT", "PROJECT", "NORMALIZE", "MODULO", "WRAP", "DISTANCE", "DIVIDE", "POWER"];
    let blends = ["BURN", "DODGE", "DIVIDE", "HUE", "SATURATION", "COLOR", "VALUE", "OVERLAY"];
    let pick = |names: &[&str]| names[r[9] as usize % names.len()].to_owned();
    let dimensions = r[8] % 6;
    let patterns = [
        (
            json!({"kind": "noise", "dimensions": dimensions, "fractal": pick(&["FBM", "RIDGED_MULTIFRACTAL",
            "HYBRID_MULTIFRACTAL", "MULTIFRACTAL", "HETERO_TERRAIN"]), "normalize": true, "color": true}),
            9,
        ),
        (json!({"kind": "white_noise", "dimensions": dimensions, "color": true}), 2),
        (
            json!({"kind": "voronoi", "dimensions": dimensions, "hash": pick(&["words", "floats"]),
            "feature": pick(&["F1", "F2", "SMOOTH_F1", "DISTANCE_TO_EDGE", "N_SPHERE_RADIUS"]),
            "metric": pick(&["EUCLIDEAN", "MINKOWSKI"]), "normalize": true, "output": "position"}),
            9,
        ),
        (json!({"kind": "wave", "rings": true, "direction": "Z", "profile": "SAW"}), 7),
        (json!({"kind": "magic", "depth": r[8] % 256}), 3),
        (
            json!({"kind": "brick", "offset": 0.5, "offset_frequency": r[8] % 3, "squash": 0.5,
            "squash_frequency": r[7] % 3}),
            10,
        ),
    ];
    let (pattern, inputs) = &patterns[r[9] as usize % patterns.len()];
    let record = match kind {
        0 => json!({"op": "attribute", "attribute": r[0], "aside": [0.1, 0.0]}),
        1 => json!({"op": "mapping", "vector": r[0], "location": r[1], "rotation": r[2], "scale": r[3]}),
        2 => image("image", json!({})),
        3 => image("box_image", json!({"normal": r[2], "blend": 0.3})),
        4 => json!({"op": "channel", "of": r[0], "channel": r[1] % 4}),
        5 => json!({"op": "math", "function": pick(&maths), "a": r[0], "b": r[1], "c": r[2]}),
        6 => json!({"op": "vector_math", "function": pick(&vectors), "a": r[0], "b": r[1], "c": r[2]}),
        7 => json!({"op": "blend", "mode": pick(&blends), "factor": r[0], "a": r[1], "b": r[2]}),
        8 => json!({"op": "clamp", "value": r[0], "low": r[1], "high": r[2]}),
        9 => {
            json!({"op": "ramp", "factor": r[0], "table": vec![[0.5; 4]; r[1] as usize % 4], "stepped": r[2] > 2})
        }
        10 => {
            json!({"op": "curves", "color": r[0], "table": vec![[0.5; 4]; r[1] as usize % 4], "low": 0.0, "high": 0.0})
        }
        11 => json!({"op": "hue_saturation", "color": r[0], "hue": r[1], "saturation": r[2], "value": r[3]}),
        12 => json!({"op": "bump", "strength": r[0], "distance": r[1], "height": r[2], "height_x": r[3],
            "height_y": r[4], "normal": r[5], "invert": true,
            "filter_width": 0.1}),
        13 => json!({"op": "layer_weight", "blend": r[0], "normal": r[1], "facing": r[2] > 2}),
        14 => json!({"op": "checker", "vector": r[0], "color1": r[1], "color2": r[2], "scale": r[3]}),
        15 => json!({"op": "hsv_from_rgb", "color": r[0]}),
        16 => json!({"op": "rgb_from_hsl", "color": r[0]}),
        17 => json!({"op": "pattern", "pattern": pattern, "inputs": &r[..*inputs]}),
        18 => {
            let space = NormalSpace::Tangent;
            return Instruction::NormalMap { color: r[0], strength: r[1], space, attribute: r[2].into() };
        }
        19 => json!({"op": "tangent", "generated": r[0], "axis": pick(&["x", "y", "z"])}),
        20 => {
            json!({"op": "panorama", "vector": r[0], "projection": pick(&["sphere", "tube", "mirror_ball"])})
        }
        21 => {
            let [horizontal, vertical] = [r[1], r[2]].map(|count| vec![x[0]; count as usize % 4]);
            let web = PhotometricWeb { horizontal, vertical, intensity: vec![x[1]; 9] };
            return Instruction::PhotometricWeb { vector: r[0], web: Box::new(web) };
        }
        _ => return Instruction::Constant { value: x },
    };
    serde_json::from_value(record).expect("a record of an instruction")
}

fn any_number() -> impl Strategy<Value = f32> {
    prop_oneof![
        -2.0_f32..2.0,
        prop::sample::select(vec![0.0, 1.0, -1.0, 1e30, -1e30, f32::NAN, f32::INFINITY, f32::MIN_POSITIVE]),
    ]
}

/// Kind, operands and numbers of each instruction.
fn any_steps() -> impl Strategy<Value = Vec<(usize, [u16; 10], [f32; 4])>> {
    let step = (0_usize..24, prop::array::uniform10(0_u16..8), prop::array::uniform4(any_number()));
    prop::collection::vec(step, 1..12)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn no_program_fails(steps in any_steps(), at in prop::array::uniform4(any_number())) {
        // Every program begins with constants, so that many are valid.
        let first = (0..7).map(|i| Instruction::Constant { value: [at[i % 4], at[(i + 1) % 4], 0.5, 1.0] });
        let rest = steps.into_iter().map(|(kind, r, x)| any_instruction(kind, r, x));
        let instructions: Vec<_> = first.chain(rest).collect();
        let count = instructions.len();
        match Program::new(instructions, 1) {
            Ok(program) => prop_assert_eq!(program.run(&Anywhere(at.into()), &textures()).len(), count),
            Err(message) => prop_assert!(["instruction", "dimensions", "web"].iter().any(|word| message.contains(word))),
        }
    }
}

#[test]
fn a_register_must_be_known_before_it_is_read() {
    let constant = Instruction::Constant { value: [0.0; 4] };
    let mean = |of| Instruction::Mean { of };
    assert!(Program::new(vec![constant.clone(), mean(0)], 0).is_ok());
    assert!(
        Program::new(vec![constant.clone(), mean(1)], 0).is_err_and(|message| message.contains("register 1"))
    );
    assert!(Program::new(vec![mean(7), constant], 0).is_err_and(|message| message.contains("register 7")));
}

#[test]
fn textures_and_tables_must_exist() {
    let constant = Instruction::Constant { value: [0.0; 4] };
    let (extension, interpolation) = (Extension::Repeat, Interpolation::Linear);
    let image =
        |texture| Instruction::Image { texture, vector: 0, extension, interpolation, unassociate: false };
    assert!(Program::new(vec![constant.clone(), image(0)], 1).is_ok());
    assert!(
        Program::new(vec![constant.clone(), image(1)], 1)
            .is_err_and(|message| message.contains("texture 1 of 1"))
    );
    let tiles = vec![Tile { column: 0, row: 0, texture: 0 }, Tile { column: 1, row: 0, texture: 3 }];
    let tiled = Instruction::TiledImage { tiles, vector: 0, extension, interpolation, unassociate: false };
    assert!(
        Program::new(vec![constant.clone(), tiled], 1)
            .is_err_and(|message| message.contains("texture 3 of 1"))
    );
    let ramp = Instruction::Ramp { factor: 0, table: vec![[0.0; 4]], stepped: false };
    assert!(
        Program::new(vec![constant.clone(), ramp], 0).is_err_and(|message| message.contains("table of 1"))
    );
    assert!(
        Program::new(vec![constant; MOST_INSTRUCTIONS + 1], 0)
            .is_err_and(|message| message.contains("at most"))
    );
}

#[test]
fn each_square_of_the_plane_has_its_own_tile() {
    let flat = |value: u8| {
        Texture::new([1, 1], Pixels::Bytes(vec![[value; 4]]), Encoding::Linear)
            .expect("a texture of one texel")
    };
    let textures = [flat(51), flat(102)];
    let tiles = vec![Tile { column: 0, row: 0, texture: 0 }, Tile { column: 2, row: 1, texture: 1 }];
    let image = Instruction::TiledImage {
        tiles,
        vector: 0,
        extension: Extension::Repeat,
        interpolation: Interpolation::Linear,
        unassociate: false,
    };
    let seen = |x: f32, y: f32| {
        let place = Instruction::Constant { value: [x, y, 0.0, 1.0] };
        let program = Program::new(vec![place, image.clone()], textures.len()).expect("a program");
        program.run(&Anywhere(Vec4::ZERO), &textures)[1].v
    };
    assert!((seen(0.4, 0.7) - Vec4::splat(0.2)).abs().max_element() < 1e-6);
    assert!((seen(2.9, 1.1) - Vec4::splat(0.4)).abs().max_element() < 1e-6);
    for (x, y) in [(1.5, 0.5), (2.5, 0.5), (-0.5, 0.5)] {
        assert_eq!(seen(x, y), Vec4::new(1.0, 0.0, 1.0, 1.0), "there is no tile at {x}, {y}");
    }
}

#[test]
fn widths_follow_the_arithmetic() {
    let texel = |x: f32| Instruction::Constant { value: [x; 4] };
    let step = Instruction::Attribute { attribute: 0, aside: Aside::HERE };
    let rows = [[4.0, 0.0, 0.0, 0.0], [0.0, 4.0, 0.0, 0.0], [0.0, 0.0, 4.0, 0.0]];
    let program = vec![
        step,
        texel(3.0),
        Instruction::Transform { vector: 0, rows },
        Instruction::Mapping { vector: 0, location: 1, rotation: 1, scale: 1 },
    ];
    let program = Program::new(program, 0).expect("a program");
    let found = program.run(&Anywhere(Vec4::new(0.5, 0.5, 0.5, 0.125)), &[]);
    assert_eq!(found[1].width, 0.0);
    assert!((found[2].width - 0.5).abs() < 1e-6 && (found[3].width - 0.375).abs() < 1e-6);
}

/// A floor, seen from above or from below.
struct Floor {
    back: bool,
}

impl Point for Floor {
    fn attribute(&self, _attribute: u32, _aside: Aside) -> Value {
        Value::default()
    }

    fn geometry(&self, quantity: Quantity, _aside: Aside) -> Value {
        match quantity {
            Quantity::Normal => Value { v: if self.back { -Vec4::Z } else { Vec4::Z }, width: 0.0 },
            Quantity::Backfacing => Value { v: Vec4::splat(f32::from(u8::from(self.back))), width: 0.0 },
            _ => Value::default(),
        }
    }

    fn steps(&self, _widths: f32) -> [Vec3; 2] {
        [Vec3::X, Vec3::Y]
    }

    fn tangents(&self, _attribute: u32) -> Option<[Vec3; 3]> {
        None
    }

    fn world_normal(&self, normal: Vec3) -> Vec3 {
        if self.back { -normal } else { normal }
    }
}

/// Of a slope that rises with x by one in one: what is a hill from above is a hollow from below.
#[test]
fn a_bump_is_the_same_surface_from_both_sides() {
    let number = |x: f32| Instruction::Constant { value: [x; 4] };
    let normal = Instruction::Geometry { quantity: Quantity::Normal, aside: Aside::HERE };
    let bump = |invert| Instruction::Bump {
        strength: 1,
        distance: 1,
        height: 0,
        height_x: 1,
        height_y: 0,
        normal: 2,
        invert,
        filter_width: 1.0,
    };
    for (invert, slope) in [(false, 1.0), (true, -1.0)] {
        let instructions = vec![number(0.0), number(1.0), normal.clone(), bump(invert)];
        let program = Program::new(instructions, 0).expect("a program");
        let outward = Vec3::new(-slope, 0.0, 1.0).normalize();
        for (back, expected) in [(false, outward), (true, -outward)] {
            let found = program.run(&Floor { back }, &[])[3].v.truncate();
            assert!((found - expected).length() < 1e-6, "{found} from behind: {back}");
        }
    }
}

/// The intensity that a program finds along a direction.
fn seen(web: &PhotometricWeb, direction: Vec3) -> f32 {
    let towards = Instruction::Constant { value: direction.extend(1.0).into() };
    let look = Instruction::PhotometricWeb { vector: 0, web: Box::new(web.clone()) };
    let program = Program::new(vec![towards, look], 0).expect("a program");
    program.run(&Anywhere(Vec4::ZERO), &[])[1].v.x
}

/// At angles (rad): vertical ones from -z, horizontal ones around z from -y over -x.
fn direction(horizontal: f32, vertical: f32) -> Vec3 {
    let (sin, cos) = horizontal.sin_cos();
    Vec3::new(-sin * vertical.sin(), -cos * vertical.sin(), -vertical.cos())
}

/// A cubic of Catmull and Rom through evenly spaced points of a parabola is the parabola.
#[test]
fn a_photometric_web_of_parabolas_is_exact_between_its_angles() {
    let (steps, wide, high) = ([8_u16, 6], TAU / 8.0, PI / 6.0);
    let intensity = |h: f32, v: f32| 1.0 + 0.3 * h + 0.2 * (h - 2.0) * (h - 2.0) + v * (PI - v) * (0.5 + h);
    let angles = |count: u16, step: f32| (0..=count).map(|i| f32::from(i) * step).collect::<Vec<_>>();
    let rows = (0..steps[0] + 3).map(|i| (f32::from(i) - 1.0) * wide);
    let grid = rows.flat_map(|h| (0..steps[1] + 3).map(move |j| intensity(h, (f32::from(j) - 1.0) * high)));
    let (horizontal, vertical) = (angles(steps[0], wide), angles(steps[1], high));
    let web = PhotometricWeb { horizontal, vertical, intensity: grid.collect() };
    for i in 1..40_u16 {
        let (h, v) = (f32::from(i) * TAU / 40.0, f32::from(i * 7 % 40) * PI / 40.0 + 0.01);
        let (found, expected) = (seen(&web, 3.0 * direction(h, v)), intensity(h, v));
        assert!((found - expected).abs() < 1e-4 * expected, "{found}, not {expected}, at {h}, {v}");
    }
}

#[test]
fn beyond_its_angles_a_photometric_web_is_dark() {
    let web =
        PhotometricWeb { horizontal: vec![0.0, PI], vertical: vec![0.5, 1.0], intensity: vec![2.0; 16] };
    assert!((seen(&web, direction(1.0, 0.7)) - 2.0).abs() < 1e-6);
    for (h, v) in [(1.0, 0.4), (1.0, 1.1), (4.0, 0.7)] {
        assert_eq!(seen(&web, direction(h, v)), 0.0, "at {h}, {v}");
    }
}

#[test]
fn a_photometric_web_needs_rising_angles_and_all_its_numbers() {
    let web = |vertical: Vec<f32>, count: usize| {
        let web =
            Box::new(PhotometricWeb { horizontal: vec![0.0, TAU], vertical, intensity: vec![1.0; count] });
        let towards = Instruction::Constant { value: [0.0; 4] };
        Program::new(vec![towards, Instruction::PhotometricWeb { vector: 0, web }], 0)
    };
    assert!(web(vec![0.0, 1.0, PI], 20).is_ok());
    assert!(web(vec![0.0, 1.0, PI], 19).is_err_and(|message| message.contains("19 intensities, not 4 x 5")));
    for angles in [vec![], vec![0.0, 2.0, 1.0], vec![0.0, f32::NAN, 1.0]] {
        let count = 4 * (angles.len() + 2);
        assert!(web(angles, count).is_err_and(|message| message.contains("do not fall")));
    }
}

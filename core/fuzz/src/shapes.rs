//! The fields of every record. A field or name that the renderer does not know ends the first run with a message.

use rgp_renderer::scene::record::Input;
use rgp_renderer::shader::{
    Axis, BlendMode, CellHash, Extension, Feature, Fractal, GradientShape, Interpolation, MathFunction,
    Metric, NormalSpace, Projection, Quantity, VectorFunction, VoronoiOutput, WaveDirection, WaveProfile,
};

use crate::records::Kind::{
    Below, Flag, List, Matrix, Maybe, MaybeWhole, Name, Number, Numbers, One, Record, Register, Registers,
    Row, Rows, Signed, Table, Texture, Whole, Word,
};
use crate::records::{Fields, Kind, words};

const EXTENSION: (&str, Kind) = ("extension", Word(words::<Extension>));
const INTERPOLATION: (&str, Kind) = ("interpolation", Word(words::<Interpolation>));
const UNASSOCIATE: (&str, Kind) = ("unassociate", Flag);
const ASIDE: (&str, Kind) = ("aside", Numbers(2));
const DIMENSIONS: (&str, Kind) = ("dimensions", Below(6));

const PATTERN: Kind = One(
    "kind",
    &[
        ("noise", &[DIMENSIONS, ("fractal", Word(words::<Fractal>)), ("normalize", Flag), ("color", Flag)]),
        ("white_noise", &[DIMENSIONS, ("color", Flag)]),
        (
            "voronoi",
            &[
                DIMENSIONS,
                ("feature", Word(words::<Feature>)),
                ("metric", Word(words::<Metric>)),
                ("hash", Word(words::<CellHash>)),
                ("normalize", Flag),
                ("output", Word(words::<VoronoiOutput>)),
            ],
        ),
        (
            "wave",
            &[
                ("rings", Flag),
                ("direction", Word(words::<WaveDirection>)),
                ("profile", Word(words::<WaveProfile>)),
            ],
        ),
        ("magic", &[("depth", Below(256))]),
        (
            "brick",
            &[
                ("offset", Number),
                ("offset_frequency", Signed),
                ("squash", Number),
                ("squash_frequency", Signed),
            ],
        ),
    ],
);

const IMAGE: Fields = &[("texture", Texture), ("vector", Register), EXTENSION, INTERPOLATION, UNASSOCIATE];

const WEB: Fields = &[("horizontal", Row(4)), ("vertical", Row(4)), ("intensity", Row(36))];

const TILE: Fields = &[("column", Whole(3)), ("row", Whole(3)), ("texture", Texture)];

/// An instruction of a program.
pub const INSTRUCTION: Kind = One("op", INSTRUCTIONS);

/// Instructions by name.
pub const INSTRUCTIONS: &[(&str, Fields)] = &[
    ("constant", &[("value", Numbers(4))]),
    ("attribute", &[("attribute", Whole(3)), ASIDE]),
    ("object_attribute", &[("attribute", Whole(3))]),
    ("geometry", &[("quantity", Word(words::<Quantity>)), ASIDE]),
    ("transform", &[("vector", Register), ("rows", Rows(3, 4))]),
    ("mapping", &[("vector", Register), ("location", Register), ("rotation", Register), ("scale", Register)]),
    ("normalize", &[("vector", Register)]),
    ("image", IMAGE),
    ("tiled_image", &[("tiles", List(3, TILE)), ("vector", Register), EXTENSION, INTERPOLATION, UNASSOCIATE]),
    ("panorama", &[("vector", Register), ("projection", Word(words::<Projection>))]),
    (
        "sun_disk",
        &[
            ("vector", Register),
            ("towards", Numbers(3)),
            ("radius", Number),
            ("bottom", Numbers(3)),
            ("top", Numbers(3)),
            ("lowest", Number),
        ],
    ),
    ("photometric_web", &[("vector", Register), ("web", Record(WEB))]),
    (
        "box_image",
        &[
            ("texture", Texture),
            ("vector", Register),
            ("normal", Register),
            ("blend", Number),
            EXTENSION,
            INTERPOLATION,
            UNASSOCIATE,
        ],
    ),
    ("alpha", &[("of", Register)]),
    ("channel", &[("of", Register), ("channel", Below(5))]),
    ("combine", &[("x", Register), ("y", Register), ("z", Register)]),
    ("luminance", &[("of", Register)]),
    ("mean", &[("of", Register)]),
    ("math", &[("function", Word(words::<MathFunction>)), ("a", Register), ("b", Register), ("c", Register)]),
    (
        "vector_math",
        &[("function", Word(words::<VectorFunction>)), ("a", Register), ("b", Register), ("c", Register)],
    ),
    ("mix", &[("factor", Register), ("a", Register), ("b", Register)]),
    ("blend", &[("mode", Word(words::<BlendMode>)), ("factor", Register), ("a", Register), ("b", Register)]),
    ("clamp", &[("value", Register), ("low", Register), ("high", Register)]),
    ("gamma", &[("color", Register), ("gamma", Register)]),
    ("bright_contrast", &[("color", Register), ("bright", Register), ("contrast", Register)]),
    (
        "hue_saturation",
        &[("color", Register), ("hue", Register), ("saturation", Register), ("value", Register)],
    ),
    ("rgb_from_hsv", &[("color", Register)]),
    ("hsv_from_rgb", &[("color", Register)]),
    ("rgb_from_hsl", &[("color", Register)]),
    ("hsl_from_rgb", &[("color", Register)]),
    ("ramp", &[("factor", Register), ("table", Table(4)), ("stepped", Flag)]),
    ("curves", &[("color", Register), ("table", Table(4)), ("low", Number), ("high", Number)]),
    ("fresnel", &[("ior", Register), ("normal", Register)]),
    ("layer_weight", &[("blend", Register), ("normal", Register), ("facing", Flag)]),
    ("tangent", &[("generated", Register), ("axis", Word(words::<Axis>))]),
    ("uv_tangent", &[("attribute", Whole(3))]),
    (
        "normal_map",
        &[
            ("color", Register),
            ("strength", Register),
            ("space", Word(words::<NormalSpace>)),
            ("attribute", Whole(3)),
        ],
    ),
    (
        "bump",
        &[
            ("strength", Register),
            ("distance", Register),
            ("height", Register),
            ("height_x", Register),
            ("height_y", Register),
            ("normal", Register),
            ("invert", Flag),
            ("filter_width", Number),
        ],
    ),
    ("checker", &[("vector", Register), ("color1", Register), ("color2", Register), ("scale", Register)]),
    ("gradient", &[("vector", Register), ("shape", Word(words::<GradientShape>))]),
    ("pattern", &[("pattern", PATTERN), ("inputs", Registers(11))]),
];

const COLOR: (&str, Kind) = ("color", Numbers(3));
const ROUGHNESS: (&str, Kind) = ("roughness", Number);
const MULTISCATTER: (&str, Kind) = ("multiscatter", Flag);
const IOR: (&str, Kind) = ("ior", Number);

const PRINCIPLED: Fields = &[
    ("base_color", Numbers(3)),
    ("metallic", Number),
    ROUGHNESS,
    MULTISCATTER,
    ("anisotropic", Number),
    ("anisotropic_rotation", Number),
    ("diffuse_roughness", Number),
    IOR,
    ("alpha", Number),
    ("specular_ior_level", Number),
    ("specular_tint", Numbers(3)),
    ("transmission_weight", Number),
    ("thin_wall", Flag),
    ("subsurface_weight", Number),
    ("subsurface_anisotropy", Number),
    ("coat_weight", Number),
    ("coat_roughness", Number),
    ("coat_ior", Number),
    ("coat_tint", Numbers(3)),
    ("emission_color", Numbers(3)),
    ("emission_strength", Number),
    ("sheen_weight", Number),
    ("sheen_roughness", Number),
    ("sheen_tint", Numbers(3)),
];

/// Closures by name.
pub const CLOSURES: &[(&str, Fields)] = &[
    ("diffuse", &[COLOR, ROUGHNESS]),
    ("glossy", &[COLOR, ROUGHNESS, ("anisotropy", Number), ("rotation", Number), MULTISCATTER]),
    ("glass", &[COLOR, ROUGHNESS, IOR, MULTISCATTER]),
    ("refraction", &[COLOR, ROUGHNESS, IOR]),
    ("translucent", &[COLOR]),
    ("sheen", &[COLOR, ROUGHNESS]),
    ("holdout", &[]),
    ("transparent", &[COLOR]),
    ("emission", &[("radiance", Numbers(3))]),
    ("principled", PRINCIPLED),
];

/// A share of a surface.
pub const CLOSURE: Fields = &[("weight", Numbers(3)), ("closure", One("kind", CLOSURES))];

/// A result that is an input of a closure.
pub const OUTPUT: Fields = &[("closure", Below(3)), ("input", Word(words::<Input>)), ("register", Register)];

/// A result that is a normal.
pub const NORMAL: Fields = &[("closure", Below(3)), ("coat", Flag), ("register", Register)];

/// A result that is a tangent.
pub const TANGENT: Fields = &[("closure", Below(3)), ("register", Register)];

const LINKS: Fields = &[("receivers", Whole(4)), ("blockers", MaybeWhole(4))];

/// What an object is to lights that are linked.
pub const OBJECT_LINKS: Fields =
    &[("receiver_set", Whole(33)), ("blocker_set", Whole(25)), ("light", Record(LINKS))];

/// What materials may ask about an object.
pub const OBJECT_INFO: Fields = &[
    ("color", Numbers(4)),
    ("index", Number),
    ("random", Number),
    ("attributes", List(3, &[("attribute", Whole(3)), ("value", Numbers(4))])),
];

const RADIUS: (&str, Kind) = ("radius", Number);
const SOFT: (&str, Kind) = ("soft_falloff", Flag);

/// Shapes of lamps by name.
pub const LAMP_SHAPES: &[(&str, Fields)] = &[
    ("point", &[RADIUS, SOFT]),
    ("spot", &[RADIUS, SOFT, ("cone_angle", Number), ("blend", Number)]),
    ("sun", &[("angle", Number)]),
    ("rectangle", &[("size", Numbers(2)), ("spread", Number)]),
    ("ellipse", &[("size", Numbers(2)), ("spread", Number)]),
];

/// A lamp.
pub const LAMP: Fields = &[
    ("name", Name),
    ("shape", One("kind", LAMP_SHAPES)),
    ("power", Numbers(3)),
    ("info", Record(OBJECT_INFO)),
    ("world_from_lamp", Matrix),
    ("visibility", Whole(32)),
    ("casts_shadow", Flag),
    ("links", Record(LINKS)),
];

const LENS: Fields =
    &[RADIUS, ("blades", Whole(8)), ("rotation", Number), ("ratio", Number), ("focus_distance", Number)];

const CAMERA_STEP: Fields = &[("world_from_camera", Matrix), ("window", Numbers(4))];

const FIELD_OF_VIEW: (&str, Kind) = ("field_of_view", Number);

const PROJECTIONS: &[(&str, Fields)] = &[
    ("perspective", &[]),
    ("orthographic", &[]),
    ("equirectangular", &[]),
    ("cubemap_face", &[]),
    ("cylindrical", &[]),
    ("fisheye_equidistant", &[FIELD_OF_VIEW]),
    ("fisheye_equisolid", &[FIELD_OF_VIEW]),
    ("fisheye_polynomial", &[FIELD_OF_VIEW, ("coefficients", Numbers(5))]),
];

/// A camera.
pub const CAMERA: Fields = &[
    ("name", Name),
    ("projection", One("kind", PROJECTIONS)),
    ("world_from_camera", Matrix),
    ("window", Numbers(4)),
    ("clip", Numbers(2)),
    ("lens", Maybe(LENS)),
    ("steps", List(4, CAMERA_STEP)),
    ("shutter", Row(4)),
];

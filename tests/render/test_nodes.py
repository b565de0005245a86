"""What nodes compute, against Cycles in the same process: an emitter whose color is the node's output, on a plane that
an orthographic camera sees."""

from collections.abc import Callable, Mapping
from typing import Any

import bpy
import numpy as np
import pytest

from tests.blender import build
from tests.render import pictures

pytestmark = pytest.mark.slow

SIZE = 16
SAMPLES = 64
# Of the mean. What is smooth differs by less than 0.1 %; edges of texels and patterns by their noise.
SMOOTH, EDGES = 0.002, 0.03

# A value that varies, for inputs of nodes under test.
IMAGE = "image"


def noise_image(color_space: str = "Non-Color", alpha: bool = False) -> Any:
    """8 x 8 texels of random bytes."""
    b_image = bpy.data.images.new("Noise", 8, 8, alpha=alpha)
    b_image.colorspace_settings.name = color_space
    texels = np.random.default_rng(1).random((64, 4), np.float32)
    if not alpha:
        texels[:, 3] = 1.0
    b_image.pixels.foreach_set(texels.ravel())
    b_image.pack()
    return b_image


def node_scene(make: Callable[[Any], Any], *, is_mirrored: bool = False) -> bpy.types.Scene:
    """A tilted plane that shows 2 + a quarter of the output `make` gives, so that negative values show too."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.resolution_x = scene.render.resolution_y = SIZE
    b_camera = build.add_camera((0, 0, 5))
    b_camera.data.type, b_camera.data.ortho_scale = "ORTHO", 1.0
    b_material, b_tree, b_output = build.material()
    b_emission = b_tree.nodes.new("ShaderNodeEmission")
    b_raised = b_tree.nodes.new("ShaderNodeVectorMath")
    b_raised.operation = "MULTIPLY_ADD"
    b_raised.inputs[1].default_value, b_raised.inputs[2].default_value = (0.25,) * 3, (2.0,) * 3
    b_tree.links.new(make(b_tree), b_raised.inputs[0])
    build.connect(b_tree, b_raised, b_emission, "Color")
    build.connect(b_tree, b_emission, b_output, "Surface")
    b_mesh = build.quad(size=1.5)
    b_mesh.uv_layers.new(name="UVMap").uv.foreach_set(
        "vector", np.array([0, 0, 2, 0, 2, 1, 0, 1], np.float32)
    )
    b_mesh.materials.append(b_material)
    b_object = build.add_object("Plane", b_mesh)
    b_object.rotation_euler = (0.5, 0.3, 0.2)
    b_object.scale = (-0.9 if is_mirrored else 0.9, 1.0, 1.2)
    b_object.color, b_object.pass_index = (0.2, 0.4, 0.6, 0.5), 3
    return scene


def difference(make: Callable[[Any], Any], *, is_mirrored: bool = False) -> float:
    """RMS difference between both engines' pictures, over the mean."""
    scene = node_scene(make, is_mirrored=is_mirrored)
    settings = {"film.filter": "box", "film.filter_width": 1.0, "photon_pass.photon_count": 1000}
    samples = {"gather.rays": SAMPLES, "gather.camera_samples": SAMPLES, "gather.light_samples": 1}
    pictures.use_rgp(scene, {**settings, **samples})
    ours = pictures.render(scene)["Combined"]
    scene.render.engine = "CYCLES"
    scene.cycles.samples, scene.cycles.use_denoising, scene.cycles.use_adaptive_sampling = (
        SAMPLES,
        False,
        False,
    )
    scene.cycles.pixel_filter_type, scene.cycles.filter_width = "BOX", 1.0
    theirs = pictures.render(scene)["Combined"]
    return float(np.sqrt(((ours - theirs) ** 2).mean()) / theirs.mean())


def output_of(
    kind: str, output: str | int = 0, inputs: Mapping[Any, Any] | None = None, **properties: Any
) -> Callable[[Any], Any]:
    """Makes a node; inputs are values, IMAGE, or a kind of node and its output."""

    def make(b_tree: Any) -> Any:
        b_node = b_tree.nodes.new(f"ShaderNode{kind}")
        for name, value in properties.items():
            setattr(b_node, name, value)
        for name, value in (inputs or {}).items():
            if isinstance(name, str) and name not in b_node.inputs:
                continue  # not an input in this mode of the node
            if isinstance(value, str):
                b_source = b_tree.nodes.new("ShaderNodeTexImage" if value == IMAGE else f"ShaderNode{value}")
                if value == IMAGE:
                    b_source.image = noise_image()
                b_tree.links.new(b_source.outputs["UV" if value == "TexCoord" else 0], b_node.inputs[name])
            else:
                b_node.inputs[name].default_value = value
        return b_node.outputs[output]

    return make


@pytest.mark.parametrize("extension", ["REPEAT", "EXTEND", "CLIP", "MIRROR"])
@pytest.mark.parametrize("interpolation", ["Linear", "Closest"])
def test_image_texture(extension: str, interpolation: str) -> None:
    def make(b_tree: Any) -> Any:
        b_image = b_tree.nodes.new("ShaderNodeTexImage")
        b_image.image, b_image.extension, b_image.interpolation = (
            noise_image("sRGB"),
            extension,
            interpolation,
        )
        b_mapping = b_tree.nodes.new("ShaderNodeMapping")
        b_mapping.inputs["Location"].default_value = (-0.6, 0.2, 0.0)
        b_mapping.inputs["Rotation"].default_value = (0.1, 0.2, 0.5)
        b_tree.links.new(b_tree.nodes.new("ShaderNodeUVMap").outputs[0], b_mapping.inputs[0])
        b_tree.links.new(b_mapping.outputs[0], b_image.inputs[0])
        return b_image.outputs["Color"]

    assert difference(make) < (SMOOTH if interpolation == "Linear" and extension != "CLIP" else EDGES)


@pytest.mark.parametrize("uses_alpha", [True, False])
def test_image_with_alpha(uses_alpha: bool) -> None:
    def make(b_tree: Any) -> Any:
        b_image = b_tree.nodes.new("ShaderNodeTexImage")
        b_image.image = noise_image("sRGB", alpha=True)
        if not uses_alpha:
            return b_image.outputs["Color"]
        b_sum = b_tree.nodes.new("ShaderNodeVectorMath")
        b_tree.links.new(b_image.outputs["Color"], b_sum.inputs[0])
        b_tree.links.new(b_image.outputs["Alpha"], b_sum.inputs[1])
        return b_sum.outputs[0]

    assert difference(make) < SMOOTH


@pytest.mark.parametrize(
    ("kind", "output"),
    [
        *(("TexCoord", name) for name in ("Generated", "Normal", "UV", "Object", "Camera", "Reflection")),
        *(
            ("NewGeometry", name)
            for name in ("Position", "Normal", "True Normal", "Incoming", "Parametric", "Backfacing")
        ),
        *(("ObjectInfo", name) for name in ("Location", "Color", "Object Index", "Random")),
        ("Fresnel", 0),
        ("LayerWeight", 0),
        ("LayerWeight", 1),
    ],
)
def test_what_is_known_at_a_hit(kind: str, output: str | int) -> None:
    assert difference(output_of(kind, output)) < SMOOTH


@pytest.mark.parametrize("vector_type", ["POINT", "TEXTURE", "VECTOR", "NORMAL"])
@pytest.mark.parametrize("varies", [False, True])
def test_mapping(vector_type: str, varies: bool) -> None:
    inputs = {"Vector": "TexCoord", "Rotation": (0.1, 0.2, 0.3), "Scale": (1.0, 2.0, 3.0)}
    if varies:
        if vector_type == "TEXTURE":
            pytest.skip("a texture mapping whose inputs vary is reported, not rendered")
        inputs["Rotation"] = IMAGE
    assert difference(output_of("Mapping", inputs=inputs, vector_type=vector_type)) < SMOOTH


@pytest.mark.parametrize(
    "operation",
    [
        "ADD",
        "DIVIDE",
        "POWER",
        "LOGARITHM",
        "SINE",
        "PINGPONG",
        "SMOOTH_MIN",
        "SMOOTH_MAX",
        "ARCTAN2",
        "MODULO",
    ],
)
def test_math(operation: str) -> None:
    assert difference(output_of("Math", inputs={0: IMAGE, 1: 0.3, 2: 0.1}, operation=operation)) < SMOOTH


@pytest.mark.parametrize(
    "operation",
    ["CROSS_PRODUCT", "PROJECT", "REFLECT", "REFRACT", "FACEFORWARD", "SCALE", "NORMALIZE", "MODULO"],
)
def test_vector_math(operation: str) -> None:
    inputs = {0: IMAGE, 1: (0.3, 0.5, 0.2), 2: (0.1, 0.2, 0.3)}
    assert difference(output_of("VectorMath", inputs=inputs, operation=operation)) < SMOOTH


@pytest.mark.parametrize(
    "blend_type",
    [b_item.identifier for b_item in bpy.types.ShaderNodeMixRGB.bl_rna.properties["blend_type"].enum_items],
)
def test_mix(blend_type: str) -> None:
    inputs = {"Fac": 0.7, 1: IMAGE, 2: (0.3, 0.5, 0.2, 1.0)}
    assert difference(output_of("MixRGB", inputs=inputs, blend_type=blend_type)) < SMOOTH


@pytest.mark.parametrize("interpolation", ["LINEAR", "STEPPED", "SMOOTHSTEP", "SMOOTHERSTEP"])
def test_map_range(interpolation: str) -> None:
    inputs = {0: IMAGE, 1: 0.2, 2: 0.7, 3: 0.1, 4: 0.9}
    assert difference(output_of("MapRange", inputs=inputs, interpolation_type=interpolation)) < SMOOTH


@pytest.mark.parametrize("interpolation", ["LINEAR", "SMOOTHSTEP"])
@pytest.mark.parametrize("data_type", ["FLOAT", "FLOAT_VECTOR"])
def test_map_range_of_nothing(interpolation: str, data_type: str) -> None:
    suffix = "_FLOAT3" if data_type == "FLOAT_VECTOR" else ""

    def make(b_tree: Any) -> Any:
        b_node = b_tree.nodes.new("ShaderNodeMapRange")
        b_node.data_type, b_node.interpolation_type, b_node.clamp = data_type, interpolation, False
        b_image = b_tree.nodes.new("ShaderNodeTexImage")
        b_image.image = noise_image()
        build.connect(b_tree, b_image, b_node, "Vector" if suffix else "Value")
        ends = (("From Min", 0.5), ("From Max", 0.5), ("To Min", 1.0), ("To Max", 3.0))
        for name, value in ends:
            identifier = name.replace(" ", "_") + suffix if suffix else name
            build.socket(b_node.inputs, identifier).default_value = (value,) * 3 if suffix else value
        return build.socket(b_node.outputs, "Vector" if suffix else "Result")

    assert difference(make) < SMOOTH


@pytest.mark.parametrize("extend", ["HORIZONTAL", "EXTRAPOLATED"])
def test_curves_beyond_their_ends(extend: str) -> None:
    def make(b_tree: Any) -> Any:
        b_image = b_tree.nodes.new("ShaderNodeTexImage")
        b_image.image = noise_image()
        b_wide = b_tree.nodes.new("ShaderNodeVectorMath")
        b_wide.operation = "MULTIPLY_ADD"
        b_wide.inputs[1].default_value, b_wide.inputs[2].default_value = (3.0,) * 3, (-1.0,) * 3
        b_tree.links.new(b_image.outputs[0], b_wide.inputs[0])
        b_curves = b_tree.nodes.new("ShaderNodeRGBCurve")
        b_curves.mapping.extend = extend
        b_curves.mapping.curves[3].points.new(0.5, 0.7)
        b_curves.mapping.update()
        build.connect(b_tree, b_wide, b_curves, "Color")
        return b_curves.outputs[0]

    assert difference(make) < SMOOTH


@pytest.mark.parametrize(
    ("kind", "output", "inputs", "properties"),
    [
        ("ValToRGB", 0, {0: IMAGE}, {}),
        ("RGBCurve", 0, {1: IMAGE}, {}),
        ("HueSaturation", 0, {"Color": IMAGE, "Hue": 0.6, "Saturation": 1.3, "Value": 0.8, "Fac": 0.9}, {}),
        ("Gamma", 0, {0: IMAGE, 1: 2.2}, {}),
        ("Invert", 0, {0: 0.8, 1: IMAGE}, {}),
        ("BrightContrast", 0, {0: IMAGE, 1: 0.1, 2: 0.3}, {}),
        ("SeparateColor", 0, {0: IMAGE}, {"mode": "HSV"}),
        ("SeparateColor", 1, {0: IMAGE}, {"mode": "HSL"}),
        ("CombineColor", 0, {0: IMAGE, 1: 0.5, 2: 0.4}, {"mode": "HSV"}),
        ("CombineColor", 0, {0: IMAGE, 1: 0.5, 2: 0.4}, {"mode": "HSL"}),
        ("RGBToBW", 0, {0: IMAGE}, {}),
    ],
)
def test_colors(kind: str, output: int, inputs: dict[Any, Any], properties: dict[str, Any]) -> None:
    # Where hues wrap around there is an edge.
    bound = EDGES if "mode" in properties else SMOOTH
    assert difference(output_of(kind, output, inputs, **properties)) < bound


@pytest.mark.parametrize(
    "gradient_type",
    ["LINEAR", "QUADRATIC", "EASING", "DIAGONAL", "RADIAL", "QUADRATIC_SPHERE", "SPHERICAL"],
)
def test_gradient(gradient_type: str) -> None:
    assert difference(output_of("TexGradient", gradient_type=gradient_type)) < SMOOTH


@pytest.mark.parametrize("dimensions", ["1D", "2D", "3D", "4D"])
@pytest.mark.parametrize("output", ["Fac", "Color"])
def test_noise(dimensions: str, output: str) -> None:
    inputs = {"W": 0.7, "Scale": 3.0, "Detail": 2.5, "Roughness": 0.6, "Lacunarity": 2.2, "Distortion": 0.4}
    assert difference(output_of("TexNoise", output, inputs, noise_dimensions=dimensions)) < SMOOTH


@pytest.mark.skipif(bpy.app.version < (4, 2), reason="Musgrave was a node of its own")
@pytest.mark.parametrize(
    "kind", ["MULTIFRACTAL", "RIDGED_MULTIFRACTAL", "HYBRID_MULTIFRACTAL", "HETERO_TERRAIN"]
)
def test_musgrave(kind: str) -> None:
    inputs = {"Scale": 3.0, "Detail": 2.5, "Offset": 0.7, "Gain": 0.9}
    assert difference(output_of("TexNoise", "Fac", inputs, noise_type=kind)) < SMOOTH


@pytest.mark.parametrize("dimensions", ["1D", "2D", "3D", "4D"])
def test_white_noise(dimensions: str) -> None:
    def make(b_tree: Any) -> Any:
        b_whole = b_tree.nodes.new("ShaderNodeVectorMath")
        b_whole.operation, b_whole.inputs[1].default_value = "SNAP", (0.5, 0.5, 0.5)
        b_tree.links.new(b_tree.nodes.new("ShaderNodeUVMap").outputs[0], b_whole.inputs[0])
        b_noise = b_tree.nodes.new("ShaderNodeTexWhiteNoise")
        b_noise.noise_dimensions = dimensions
        build.socket(b_noise.inputs, "W").default_value = 0.3
        b_tree.links.new(b_whole.outputs[0], build.socket(b_noise.inputs, "Vector"))
        return b_noise.outputs["Color"]

    assert difference(make) < EDGES


@pytest.mark.parametrize("dimensions", ["2D", "3D"])
@pytest.mark.parametrize("feature", ["F1", "F2", "SMOOTH_F1", "DISTANCE_TO_EDGE"])
@pytest.mark.parametrize("metric", ["EUCLIDEAN", "MINKOWSKI"])
def test_voronoi_distance(dimensions: str, feature: str, metric: str) -> None:
    inputs = {"Scale": 3.0, "Smoothness": 0.6, "Exponent": 0.7, "Randomness": 0.8}
    options = {"voronoi_dimensions": dimensions, "feature": feature, "distance": metric}
    assert difference(output_of("TexVoronoi", "Distance", inputs, **options)) < SMOOTH


@pytest.mark.parametrize("output", ["Color", "Position"])
@pytest.mark.parametrize("feature", ["F1", "F2", "SMOOTH_F1"])
def test_voronoi_cells(output: str, feature: str) -> None:
    assert difference(output_of("TexVoronoi", output, {"Scale": 3.0}, feature=feature)) < EDGES


@pytest.mark.parametrize(
    ("kind", "direction", "profile"),
    [
        ("BANDS", "X", "SIN"),
        ("BANDS", "DIAGONAL", "TRI"),
        ("RINGS", "Z", "SIN"),
        ("RINGS", "SPHERICAL", "TRI"),
    ],
)
def test_wave(kind: str, direction: str, profile: str) -> None:
    inputs = {"Scale": 1.5, "Distortion": 1.2, "Detail": 1.5, "Detail Scale": 1.1, "Phase Offset": 0.3}
    options = {"wave_type": kind, f"{kind.lower()}_direction": direction, "wave_profile": profile}
    assert difference(output_of("TexWave", "Color", inputs, **options)) < SMOOTH


@pytest.mark.parametrize("depth", [0, 1, 2, 5, 10])
def test_magic(depth: int) -> None:
    inputs = {"Scale": 2.0, "Distortion": 1.2}
    assert difference(output_of("TexMagic", "Color", inputs, turbulence_depth=depth)) < SMOOTH


@pytest.mark.parametrize("output", ["Color", "Fac"])
def test_brick(output: str) -> None:
    inputs = {"Scale": 3.0, "Mortar Smooth": 0.4, "Bias": 0.1, "Mortar Size": 0.05}
    options = {"offset": 0.3, "offset_frequency": 2, "squash": 0.6, "squash_frequency": 3}
    assert difference(output_of("TexBrick", output, inputs, **options)) < EDGES


def test_bump() -> None:
    inputs = {"Strength": 0.7, "Distance": 0.4, "Height": "TexNoise"}
    assert difference(output_of("Bump", inputs=inputs)) < SMOOTH


@pytest.mark.parametrize("space", ["TANGENT", "OBJECT", "WORLD"])
@pytest.mark.parametrize("is_mirrored", [False, True])
def test_normal_map(space: str, is_mirrored: bool) -> None:
    make = output_of("NormalMap", inputs={"Strength": 0.8, "Color": IMAGE}, space=space)
    assert difference(make, is_mirrored=is_mirrored) < SMOOTH


def test_checker() -> None:
    assert difference(output_of("TexChecker")) < EDGES

"""What nodes compute, as tiny scenes: an emitter whose color is the node's output, on a plane that an orthographic
camera sees.

Left out: the Mapping node of type Texture with inputs that vary, which is reported and not rendered.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import bpy
import numpy as np

from scenes import common
from tests.blender import build

SIZE = 16
# Largest RMS difference, of the mean: edges of texels and patterns have noise.
SMOOTH, EDGES = 0.005, 0.03

# A value that varies, for inputs of nodes.
IMAGE = "image"

Make = Callable[[Any], Any]
"""Adds nodes to a tree and returns the output that is shown."""


@dataclass(frozen=True)
class NodeCase:
    """A node's output, and how closely both engines must agree."""

    make: Make
    bound: float = SMOOTH
    is_mirrored: bool = False
    """Of the plane."""
    has_perspective: bool = False
    """Of the camera, which is shifted then, and its picture twice as wide as high."""
    has_islands: bool = False
    """The plane is in two halves that do not hang together."""


def noise_image(color_space: str = "Non-Color", alpha: bool = False, seed: int = 1) -> Any:
    """8 x 8 texels of random bytes."""
    b_image = bpy.data.images.new("Noise", 8, 8, alpha=alpha)
    b_image.colorspace_settings.name = color_space
    texels = np.random.default_rng(seed).random((64, 4), np.float32)
    if not alpha:
        texels[:, 3] = 1.0
    b_image.pixels.foreach_set(texels.ravel())
    b_image.pack()
    return b_image


def node_scene(case: NodeCase) -> bpy.types.Scene:
    """A tilted plane that shows a half + a quarter of the output, so that negative values show too."""
    scene = common.start_empty_file()
    scene.render.resolution_x = scene.render.resolution_y = SIZE
    b_camera = build.add_camera((0, 0, 5))
    if case.has_perspective:
        scene.render.resolution_x, scene.render.pixel_aspect_y = 2 * SIZE, 1.5
        b_camera.data.angle, b_camera.data.shift_x = 0.2, 0.1
    else:
        b_camera.data.type, b_camera.data.ortho_scale = "ORTHO", 1.0
    b_material, b_tree, b_output = build.material()
    b_emission = b_tree.nodes.new("ShaderNodeEmission")
    b_raised = _scaled(b_tree, case.make(b_tree), 0.25, 0.5)
    build.connect(b_tree, b_raised, b_emission, "Color")
    build.connect(b_tree, b_emission, b_output, "Surface")
    b_mesh = _two_quads() if case.has_islands else build.quad(size=1.5)
    faces = len(b_mesh.polygons)
    uvs = np.tile(np.array([0, 0, 2, 0, 2, 1, 0, 1], np.float32), faces)
    b_mesh.uv_layers.new(name="UVMap").uv.foreach_set("vector", uvs)
    b_paint = b_mesh.attributes.new("Paint", "FLOAT_COLOR", "CORNER")
    b_paint.data.foreach_set("color", np.tile(np.linspace(0.0, 1.0, 16, dtype=np.float32), faces))
    b_mesh.materials.append(b_material)
    b_object = build.add_object("Plane", b_mesh)
    b_object.rotation_euler = (0.5, 0.3, 0.2)
    b_object.scale = (-0.9 if case.is_mirrored else 0.9, 1.0, 1.2)
    b_object.color, b_object.pass_index = (0.2, 0.4, 0.6, 0.5), 3
    return scene


def _two_quads() -> Any:
    """The right half of the plane, and the left one."""
    halves = [
        (x, y, 0.0)
        for low in (0.0, -1.5)
        for x, y in ((low, -1.5), (low + 1.5, -1.5), (low + 1.5, 1.5), (low, 1.5))
    ]
    return build.mesh("Halves", halves, [(0, 1, 2, 3), (4, 5, 6, 7)])


def output_of(
    kind: str, output: str | int = 0, inputs: Mapping[Any, Any] | None = None, **properties: Any
) -> Make:
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


def _scaled(b_tree: Any, b_output: Any, factor: float, offset: float) -> Any:
    """A node that gives factor times an output plus offset."""
    b_node = b_tree.nodes.new("ShaderNodeVectorMath")
    b_node.operation = "MULTIPLY_ADD"
    b_node.inputs[1].default_value, b_node.inputs[2].default_value = (factor,) * 3, (offset,) * 3
    b_tree.links.new(b_output, b_node.inputs[0])
    return b_node


def _image(extension: str, interpolation: str) -> Make:
    def make(b_tree: Any) -> Any:
        b_image = b_tree.nodes.new("ShaderNodeTexImage")
        b_image.image = noise_image("sRGB")
        b_image.extension, b_image.interpolation = extension, interpolation
        b_mapping = b_tree.nodes.new("ShaderNodeMapping")
        b_mapping.inputs["Location"].default_value = (-0.6, 0.2, 0.0)
        b_mapping.inputs["Rotation"].default_value = (0.1, 0.2, 0.5)
        b_tree.links.new(b_tree.nodes.new("ShaderNodeUVMap").outputs[0], b_mapping.inputs[0])
        b_tree.links.new(b_mapping.outputs[0], b_image.inputs[0])
        return b_image.outputs["Color"]

    return make


def _saved(name: str, seed: int) -> str:
    """The path of a picture that is written to Blender's own folder for what is there for a moment."""
    b_image = noise_image("sRGB", seed=seed)
    b_image.filepath_raw, b_image.file_format = str(Path(bpy.app.tempdir) / name), "PNG"
    b_image.save()
    path = str(b_image.filepath_raw)
    bpy.data.images.remove(b_image)
    return path


def _sequence(**settings: Any) -> Make:
    """Six pictures, one for each frame; the scene is at frame 1."""

    def make(b_tree: Any) -> Any:
        first, *_ = [_saved(f"rgp_sequence_{number:03d}.png", number) for number in range(1, 7)]
        b_texture = b_tree.nodes.new("ShaderNodeTexImage")
        b_texture.image = bpy.data.images.load(first)
        b_texture.image.source = "SEQUENCE"
        for name, value in settings.items():
            setattr(b_texture.image_user, name, value)
        return b_texture.outputs["Color"]

    return make


def _tiled(numbers: tuple[int, ...], packed: bool = False) -> Make:
    """A picture for each tile; the plane lies on 1001 and 1002. Of those that are packed no file is left."""

    def make(b_tree: Any) -> Any:
        files = [_saved(f"rgp_tiles_{len(numbers)}.{number}.png", number) for number in numbers]
        folder = Path(bpy.app.tempdir)
        b_texture = b_tree.nodes.new("ShaderNodeTexImage")
        b_texture.image = bpy.data.images.load(str(folder / f"rgp_tiles_{len(numbers)}.{numbers[0]}.png"))
        b_texture.image.source = "TILED"
        b_texture.image.filepath = str(folder / f"rgp_tiles_{len(numbers)}.<UDIM>.png")
        b_texture.image.reload()
        if packed:
            b_texture.image.pack()
            for file in files:
                Path(file).unlink()
        return b_texture.outputs["Color"]

    return make


def _pictured(make: Make) -> Make:
    """The image of noise for the node that is made."""

    def make_with_image(b_tree: Any) -> Any:
        b_output = make(b_tree)
        b_output.node.image = noise_image("sRGB")
        return b_output

    return make_with_image


def _image_with_alpha(uses_alpha: bool) -> Make:
    def make(b_tree: Any) -> Any:
        b_image = b_tree.nodes.new("ShaderNodeTexImage")
        b_image.image = noise_image("sRGB", alpha=True)
        if not uses_alpha:
            return b_image.outputs["Color"]
        b_sum = b_tree.nodes.new("ShaderNodeVectorMath")
        b_tree.links.new(b_image.outputs["Color"], b_sum.inputs[0])
        b_tree.links.new(b_image.outputs["Alpha"], b_sum.inputs[1])
        return b_sum.outputs[0]

    return make


def _white_noise(dimensions: str) -> Make:
    def make(b_tree: Any) -> Any:
        b_whole = b_tree.nodes.new("ShaderNodeVectorMath")
        b_whole.operation, b_whole.inputs[1].default_value = "SNAP", (0.5, 0.5, 0.5)
        b_tree.links.new(b_tree.nodes.new("ShaderNodeUVMap").outputs[0], b_whole.inputs[0])
        b_noise = b_tree.nodes.new("ShaderNodeTexWhiteNoise")
        b_noise.noise_dimensions = dimensions
        build.socket(b_noise.inputs, "W").default_value = 0.3
        b_tree.links.new(b_whole.outputs[0], build.socket(b_noise.inputs, "Vector"))
        return b_noise.outputs["Color"]

    return make


def _map_range_of_nothing(interpolation: str, data_type: str) -> Make:
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

    return make


def _curves_beyond_their_ends(extend: str) -> Make:
    def make(b_tree: Any) -> Any:
        b_image = b_tree.nodes.new("ShaderNodeTexImage")
        b_image.image = noise_image()
        b_curves = b_tree.nodes.new("ShaderNodeRGBCurve")
        b_curves.mapping.extend = extend
        b_curves.mapping.curves[3].points.new(0.5, 0.7)
        b_curves.mapping.update()
        build.connect(b_tree, _scaled(b_tree, b_image.outputs[0], 3.0, -1.0), b_curves, "Color")
        return b_curves.outputs[0]

    return make


def _surface_nodes() -> Iterator[tuple[str, NodeCase]]:
    """Nodes that look at the hit."""
    for output in ("Generated", "Normal", "UV", "Object", "Camera", "Window", "Reflection"):
        yield f"Texture Coordinate/{output}", NodeCase(output_of("TexCoord", output))
    outputs = (
        "Position",
        "Normal",
        "True Normal",
        "Incoming",
        "Parametric",
        "Backfacing",
        "Random Per Island",
    )
    for output in outputs:
        yield f"Geometry/{output}", NodeCase(output_of("NewGeometry", output))
    tangent = NodeCase(output_of("NewGeometry", "Tangent"))
    yield "Geometry/Tangent", tangent
    yield "Geometry/Tangent mirrored", replace(tangent, is_mirrored=True)
    window = output_of("TexCoord", "Window")
    yield "Texture Coordinate/Window in perspective", NodeCase(window, has_perspective=True)
    island = output_of("NewGeometry", "Random Per Island")
    yield "Geometry/Random Per Island of two", NodeCase(island, EDGES, has_islands=True)
    for output in ("Location", "Color", "Object Index", "Random"):
        yield f"Object Info/{output}", NodeCase(output_of("ObjectInfo", output))
    yield "UV Map", NodeCase(output_of("UVMap"))
    yield "Color Attribute", NodeCase(output_of("VertexColor", layer_name="Paint"))
    yield "Attribute", NodeCase(output_of("Attribute", "Vector", attribute_name="Paint"))
    for output in ("Is Camera Ray", "Is Shadow Ray", "Is Diffuse Ray"):
        yield f"Light Path/{output}", NodeCase(output_of("LightPath", output))
    yield "Fresnel", NodeCase(output_of("Fresnel"))
    yield "Layer Weight/Fresnel", NodeCase(output_of("LayerWeight", 0))
    yield "Layer Weight/Facing", NodeCase(output_of("LayerWeight", 1))
    bump = {"Strength": 0.7, "Distance": 0.4, "Height": "TexNoise"}
    yield "Bump", NodeCase(output_of("Bump", inputs=bump))
    for space in ("TANGENT", "OBJECT", "WORLD"):
        make = output_of("NormalMap", inputs={"Strength": 0.8, "Color": IMAGE}, space=space)
        yield f"Normal Map/{space}", NodeCase(make)
        yield f"Normal Map/{space} mirrored", NodeCase(make, is_mirrored=True)


def _value_nodes() -> Iterator[tuple[str, NodeCase]]:
    """Nodes that compute with numbers and vectors."""
    places = {"Vector": "TexCoord", "Rotation": (0.1, 0.2, 0.3), "Scale": (1.0, 2.0, 3.0)}
    for kind in ("POINT", "TEXTURE", "VECTOR", "NORMAL"):
        yield f"Mapping/{kind}", NodeCase(output_of("Mapping", inputs=places, vector_type=kind))
    for kind in ("POINT", "VECTOR", "NORMAL"):
        make = output_of("Mapping", inputs={**places, "Rotation": IMAGE}, vector_type=kind)
        yield f"Mapping/{kind} varying", NodeCase(make)
    functions = ("ADD", "DIVIDE", "POWER", "LOGARITHM", "SINE", "PINGPONG", "SMOOTH_MIN", "SMOOTH_MAX")
    for function in (*functions, "ARCTAN2", "MODULO"):
        make = output_of("Math", inputs={0: IMAGE, 1: 0.3, 2: 0.1}, operation=function)
        yield f"Math/{function}", NodeCase(make)
    vectors = {0: IMAGE, 1: (0.3, 0.5, 0.2), 2: (0.1, 0.2, 0.3)}
    functions = ("CROSS_PRODUCT", "PROJECT", "REFLECT", "REFRACT", "FACEFORWARD", "SCALE", "NORMALIZE")
    for function in (*functions, "MODULO"):
        make = output_of("VectorMath", inputs=vectors, operation=function)
        yield f"Vector Math/{function}", NodeCase(make)
    ends = {0: IMAGE, 1: 0.2, 2: 0.7, 3: 0.1, 4: 0.9}
    for kind in ("LINEAR", "STEPPED", "SMOOTHSTEP", "SMOOTHERSTEP"):
        yield f"Map Range/{kind}", NodeCase(output_of("MapRange", inputs=ends, interpolation_type=kind))
    for kind in ("LINEAR", "SMOOTHSTEP"):
        for data_type in ("FLOAT", "FLOAT_VECTOR"):
            yield f"Map Range/{kind} {data_type} of nothing", NodeCase(_map_range_of_nothing(kind, data_type))
    for channel in range(3):
        yield f"Separate XYZ/{'XYZ'[channel]}", NodeCase(output_of("SeparateXYZ", channel, {0: IMAGE}))
    yield "Combine XYZ", NodeCase(output_of("CombineXYZ", 0, {0: IMAGE, 1: 0.5, 2: 0.4}))
    yield "Vector Curves", NodeCase(output_of("VectorCurve", inputs={1: IMAGE}))
    yield "Float Curve", NodeCase(output_of("FloatCurve", inputs={1: IMAGE}))
    yield "Clamp", NodeCase(output_of("Clamp", inputs={0: IMAGE, 1: 0.3, 2: 0.6}))


def _color_nodes() -> Iterator[tuple[str, NodeCase]]:
    """Nodes that compute with colors."""
    for item in bpy.types.ShaderNodeMixRGB.bl_rna.properties["blend_type"].enum_items:
        inputs = {"Fac": 0.7, 1: IMAGE, 2: (0.3, 0.5, 0.2, 1.0)}
        yield (
            f"Mix/{item.identifier}",
            NodeCase(output_of("MixRGB", inputs=inputs, blend_type=item.identifier)),
        )
    yield "Color Ramp", NodeCase(output_of("ValToRGB", inputs={0: IMAGE}))
    yield "RGB Curves", NodeCase(output_of("RGBCurve", inputs={1: IMAGE}))
    for extend in ("HORIZONTAL", "EXTRAPOLATED"):
        yield f"RGB Curves/{extend}", NodeCase(_curves_beyond_their_ends(extend))
    hue = {"Color": IMAGE, "Hue": 0.6, "Saturation": 1.3, "Value": 0.8, "Fac": 0.9}
    yield "Hue Saturation Value", NodeCase(output_of("HueSaturation", inputs=hue))
    yield "Gamma", NodeCase(output_of("Gamma", inputs={0: IMAGE, 1: 2.2}))
    yield "Invert Color", NodeCase(output_of("Invert", inputs={0: 0.8, 1: IMAGE}))
    yield "Brightness Contrast", NodeCase(output_of("BrightContrast", inputs={0: IMAGE, 1: 0.1, 2: 0.3}))
    yield "RGB to BW", NodeCase(output_of("RGBToBW", inputs={0: IMAGE}))
    # Where hues wrap around there is an edge.
    for mode, channel in (("HSV", 0), ("HSL", 1)):
        make = output_of("SeparateColor", channel, {0: IMAGE}, mode=mode)
        yield f"Separate Color/{mode}", NodeCase(make, EDGES)
        make = output_of("CombineColor", 0, {0: IMAGE, 1: 0.5, 2: 0.4}, mode=mode)
        yield f"Combine Color/{mode}", NodeCase(make, EDGES)


def _textures() -> Iterator[tuple[str, NodeCase]]:
    """Images, and patterns of one kind of feature."""
    for extension in ("REPEAT", "EXTEND", "CLIP", "MIRROR"):
        for interpolation in ("Linear", "Closest", "Cubic"):
            is_smooth = interpolation != "Closest" and (interpolation, extension) != ("Linear", "CLIP")
            bound = SMOOTH if is_smooth else EDGES
            case = NodeCase(_image(extension, interpolation), bound)
            yield f"Image Texture/{extension} {interpolation}", case
    for uses_alpha in (True, False):
        name = "with alpha" if uses_alpha else "without its alpha"
        yield f"Image Texture/{name}", NodeCase(_image_with_alpha(uses_alpha))
    for projection in ("SPHERE", "TUBE", "BOX"):
        make = output_of("TexImage", inputs={0: "TexCoord"}, projection=projection)
        yield f"Image Texture/{projection}", NodeCase(_pictured(make), EDGES)
    sequences = {
        "sequence": {"frame_duration": 6, "frame_offset": 2},
        "sequence, its end": {"frame_duration": 4, "frame_start": -20},
        "sequence, cyclic": {
            "frame_duration": 4,
            "frame_start": -5,
            "use_cyclic": True,
            "use_auto_refresh": True,
        },
    }
    for name, settings in sequences.items():
        yield f"Image Texture/{name}", NodeCase(_sequence(**settings))
    yield "Image Texture/UDIM tiles", NodeCase(_tiled((1001, 1002)), EDGES)
    yield "Image Texture/UDIM tiles, packed", NodeCase(_tiled((1001, 1002), packed=True), EDGES)
    yield "Image Texture/UDIM with a tile missing", NodeCase(_tiled((1001,)), EDGES)
    kinds = ("LINEAR", "QUADRATIC", "EASING", "DIAGONAL", "RADIAL", "QUADRATIC_SPHERE", "SPHERICAL")
    for kind in kinds:
        yield f"Gradient Texture/{kind}", NodeCase(output_of("TexGradient", gradient_type=kind))
    for dimensions in ("1D", "2D", "3D", "4D"):
        yield f"White Noise Texture/{dimensions}", NodeCase(_white_noise(dimensions), EDGES)
    for depth in (0, 1, 2, 5, 10):
        inputs = {"Scale": 2.0, "Distortion": 1.2}
        make = output_of("TexMagic", "Color", inputs, turbulence_depth=depth)
        yield f"Magic Texture/depth {depth}", NodeCase(make)
    bricks = {"Scale": 3.0, "Mortar Smooth": 0.4, "Bias": 0.1, "Mortar Size": 0.05}
    offsets = {"offset": 0.3, "offset_frequency": 2, "squash": 0.6, "squash_frequency": 3}
    for output in ("Color", "Fac"):
        yield f"Brick Texture/{output}", NodeCase(output_of("TexBrick", output, bricks, **offsets), EDGES)
    yield "Checker Texture", NodeCase(output_of("TexChecker"), EDGES)


def _noises() -> Iterator[tuple[str, NodeCase]]:
    """Noise and waves."""
    octaves = {"W": 0.7, "Scale": 3.0, "Detail": 2.5, "Roughness": 0.6, "Lacunarity": 2.2, "Distortion": 0.4}
    for dimensions in ("1D", "2D", "3D", "4D"):
        for output in ("Fac", "Color"):
            make = output_of("TexNoise", output, octaves, noise_dimensions=dimensions)
            yield f"Noise Texture/{dimensions} {output}", NodeCase(make)
    musgrave = {"Scale": 3.0, "Detail": 2.5, "Offset": 0.7, "Gain": 0.9}
    for kind in ("MULTIFRACTAL", "RIDGED_MULTIFRACTAL", "HYBRID_MULTIFRACTAL", "HETERO_TERRAIN"):
        make = output_of("TexNoise", "Fac", musgrave, noise_type=kind)
        yield f"Noise Texture/{kind}", NodeCase(make)
    waves = {"Scale": 1.5, "Distortion": 1.2, "Detail": 1.5, "Detail Scale": 1.1, "Phase Offset": 0.3}
    bands = (("BANDS", "X", "SIN"), ("BANDS", "DIAGONAL", "TRI"))
    for kind, direction, profile in (*bands, ("RINGS", "Z", "SIN"), ("RINGS", "SPHERICAL", "TRI")):
        options = {"wave_type": kind, f"{kind.lower()}_direction": direction, "wave_profile": profile}
        make = output_of("TexWave", "Color", waves, **options)
        yield f"Wave Texture/{kind} {direction} {profile}", NodeCase(make)


def _cells() -> Iterator[tuple[str, NodeCase]]:
    """Voronoi's cells."""
    cells = {"W": IMAGE, "Scale": 3.0, "Smoothness": 0.6, "Exponent": 0.7, "Randomness": 0.8}
    for dimensions in ("1D", "2D", "3D", "4D"):
        space = {"voronoi_dimensions": dimensions}
        for feature in ("F1", "F2", "SMOOTH_F1", "DISTANCE_TO_EDGE"):
            for metric in ("EUCLIDEAN", "MINKOWSKI") if dimensions in ("2D", "3D") else ("EUCLIDEAN",):
                options = {**space, "feature": feature, "distance": metric}
                make = output_of("TexVoronoi", "Distance", cells, **options)
                yield f"Voronoi Texture/{dimensions} {feature} {metric}", NodeCase(make)
        make = output_of("TexVoronoi", "Radius", cells, feature="N_SPHERE_RADIUS", **space)
        yield f"Voronoi Texture/{dimensions} N-Sphere Radius", NodeCase(make, EDGES)
        for output in ("Color", "W" if dimensions in ("1D", "4D") else "Position"):
            make = output_of("TexVoronoi", output, cells, **space)
            yield f"Voronoi Texture/{dimensions} {output}", NodeCase(make, EDGES)
    for feature in ("F2", "SMOOTH_F1"):
        make = output_of("TexVoronoi", "Color", {"Scale": 3.0}, feature=feature)
        yield f"Voronoi Texture/{feature} Color", NodeCase(make, EDGES)
    yield from _lattices({**cells, "Detail": 2.5, "Roughness": 0.6, "Lacunarity": 2.2})


def _lattices(inputs: Mapping[Any, Any]) -> Iterator[tuple[str, NodeCase]]:
    """Voronoi's cells with finer ones on top."""
    features = (
        ("1D", "DISTANCE_TO_EDGE"),
        ("2D", "F1"),
        ("2D", "DISTANCE_TO_EDGE"),
        ("3D", "F2"),
        ("4D", "F1"),
    )
    for normalize in (True, False):
        how = "normalized" if normalize else "as it is"
        for dimensions, feature in features:
            options = {"voronoi_dimensions": dimensions, "feature": feature, "normalize": normalize}
            make = output_of("TexVoronoi", "Distance", inputs, **options)
            yield f"Voronoi Texture/{dimensions} {feature} Detail, {how}", NodeCase(make)
        for output in ("Color", "Position"):
            make = output_of("TexVoronoi", output, inputs, normalize=normalize)
            yield f"Voronoi Texture/{output} Detail, {how}", NodeCase(make, EDGES)


NODES: dict[str, NodeCase] = dict(
    case
    for part in (_surface_nodes, _value_nodes, _color_nodes, _textures, _noises, _cells)
    for case in part()
)
"""By the node's name and what is special."""

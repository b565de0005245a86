"""What nodes compute: cases of every node, those of textures in `texture_cases.py`
and `luminaire_cases.py`.

Left out: the Mapping node of type Texture with inputs that vary, which is reported and not rendered.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import bpy

from tests.blender import build
from tests.render.luminaire_cases import LUMINAIRES
from tests.render.node_scene import EDGES, IMAGE, SMOOTH, Make, NodeCase, noise_image, output_of, scaled
from tests.render.texture_cases import TEXTURES


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


def _temperatures(b_tree: Any) -> Any:
    """From below to above all temperatures that the node knows."""
    b_image, b_blackbody = (b_tree.nodes.new(f"ShaderNode{kind}") for kind in ("TexImage", "Blackbody"))
    b_image.image = noise_image()
    build.connect(b_tree, scaled(b_tree, b_image.outputs[0], 13000.0, 500.0), b_blackbody, "Temperature")
    return b_blackbody.outputs[0]


def _curves_beyond_their_ends(extend: str) -> Make:
    def make(b_tree: Any) -> Any:
        b_image = b_tree.nodes.new("ShaderNodeTexImage")
        b_image.image = noise_image()
        b_curves = b_tree.nodes.new("ShaderNodeRGBCurve")
        b_curves.mapping.extend = extend
        b_curves.mapping.curves[3].points.new(0.5, 0.7)
        b_curves.mapping.update()
        build.connect(b_tree, scaled(b_tree, b_image.outputs[0], 3.0, -1.0), b_curves, "Color")
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
    for output in ("Location", "Color", "Object Index", "Material Index", "Random"):
        yield f"Object Info/{output}", NodeCase(output_of("ObjectInfo", output))
    yield "UV Map", NodeCase(output_of("UVMap"))
    yield "Color Attribute", NodeCase(output_of("VertexColor", layer_name="Paint"))
    yield "Attribute", NodeCase(output_of("Attribute", "Vector", attribute_name="Paint"))
    yield from _attributes_of_objects()
    for output in ("Is Camera Ray", "Is Shadow Ray", "Is Diffuse Ray"):
        yield f"Light Path/{output}", NodeCase(output_of("LightPath", output))
    yield "Fresnel", NodeCase(output_of("Fresnel"))
    yield "Layer Weight/Fresnel", NodeCase(output_of("LayerWeight", 0))
    yield "Layer Weight/Facing", NodeCase(output_of("LayerWeight", 1))
    bump = {"Strength": 0.7, "Distance": 0.4, "Height": "TexNoise"}
    yield "Bump", NodeCase(output_of("Bump", inputs=bump))
    # Slopes are taken over steps along the surface, which both engines choose by themselves.
    # A bump the wrong way is 10 % off.
    yield "Bump from behind", NodeCase(output_of("Bump", inputs=bump), 2.0 * SMOOTH, is_turned=True)
    for space in ("TANGENT", "OBJECT", "WORLD"):
        make = output_of("NormalMap", inputs={"Strength": 0.8, "Color": IMAGE}, space=space)
        yield f"Normal Map/{space}", NodeCase(make)
        yield f"Normal Map/{space} mirrored", NodeCase(make, is_mirrored=True)


def _attributes_of_objects() -> Iterator[tuple[str, NodeCase]]:
    """Attributes by name of objects, what shows them, and the view layer."""

    def of(kind: str, name: str, output: str = "Color") -> Make:
        return output_of("Attribute", output, attribute_type=kind, attribute_name=name)

    for output in ("Color", "Fac", "Alpha"):
        yield f"Attribute/of an object, {output}", NodeCase(of("OBJECT", "Tint", output))
        yield f"Attribute/of a view layer, {output}", NodeCase(of("VIEW_LAYER", "Tint", output))
    for name in ("Shade", "location", "data.texspace_size", "nothing"):
        yield f"Attribute/of an object, {name}", NodeCase(of("OBJECT", name))
    for name in ("Mood", "render.resolution_x"):
        yield f"Attribute/of a view layer, {name}", NodeCase(of("VIEW_LAYER", name))
    # Blender 4.2 does not hand out what geometry nodes say of instances.
    of_instances = ("place", "inner", "outer") if bpy.app.version >= (4, 5) else ()
    for name in (*of_instances, "Own", "Tint", "nothing"):
        for what, how in _SCATTERED.items():
            case = NodeCase(of("INSTANCER", name), scattered=how)
            yield f"Attribute/of an instancer of {what}, {name}", case
    yield "Attribute/of an object without instancer", NodeCase(of("INSTANCER", "Tint"))


_SCATTERED = {
    "objects": {"as_instance": True},
    "meshes": {"as_instance": False},
    "meshes beside others": {"as_instance": False, "joined": True, "has_ids": True},
}
"""What geometry nodes show."""


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
    constants = {0: (0.9, 0.2, 0.5), 1: (0.3, 0.5, 0.2)}
    yield (
        "Vector Math/of constants",
        NodeCase(output_of("VectorMath", 0, constants, operation="CROSS_PRODUCT")),
    )
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
    constants = {"Fac": 0.7, 1: (0.8, 0.3, 0.1, 1.0), 2: (0.3, 0.5, 0.2, 1.0)}
    yield "Mix/HUE of constants", NodeCase(output_of("MixRGB", inputs=constants, blend_type="HUE"))
    yield "Color Ramp", NodeCase(output_of("ValToRGB", inputs={0: IMAGE}))
    yield "RGB Curves", NodeCase(output_of("RGBCurve", inputs={1: IMAGE}))
    for extend in ("HORIZONTAL", "EXTRAPOLATED"):
        yield f"RGB Curves/{extend}", NodeCase(_curves_beyond_their_ends(extend))
    hue = {"Color": IMAGE, "Hue": 0.6, "Saturation": 1.3, "Value": 0.8, "Fac": 0.9}
    yield "Hue Saturation Value", NodeCase(output_of("HueSaturation", inputs=hue))
    yield "Gamma", NodeCase(output_of("Gamma", inputs={0: IMAGE, 1: 2.2}))
    yield "Invert Color", NodeCase(output_of("Invert", inputs={0: 0.8, 1: IMAGE}))
    yield "Brightness Contrast", NodeCase(output_of("BrightContrast", inputs={0: IMAGE, 1: 0.1, 2: 0.3}))
    yield "Blackbody", NodeCase(_temperatures)
    yield "RGB to BW", NodeCase(output_of("RGBToBW", inputs={0: IMAGE}))
    # Where hues wrap around there is an edge.
    for mode, channel in (("HSV", 0), ("HSL", 1)):
        make = output_of("SeparateColor", channel, {0: IMAGE}, mode=mode)
        yield f"Separate Color/{mode}", NodeCase(make, EDGES)
        make = output_of("CombineColor", 0, {0: IMAGE, 1: 0.5, 2: 0.4}, mode=mode)
        yield f"Combine Color/{mode}", NodeCase(make, EDGES)


NODES: dict[str, NodeCase] = {
    **dict(case for part in (_surface_nodes, _value_nodes, _color_nodes) for case in part()),
    **TEXTURES,
    **LUMINAIRES,
}
"""By the node's name and what is special."""

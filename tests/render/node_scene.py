"""One node as a tiny scene: an emitter that shows the node's output on a plane, seen by an orthographic camera."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import bpy
import numpy as np

from scenes import common
from tests.blender import build
from tests.blender.scatter import scatter

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
    is_turned: bool = False
    """The camera sees the plane's back."""
    scattered: Mapping[str, bool] | None = None
    """Geometry nodes show the plane, small, four times, and this is said of how."""


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
    b_material.pass_index = 2
    b_emission = b_tree.nodes.new("ShaderNodeEmission")
    b_raised = scaled(b_tree, case.make(b_tree), 0.25, 0.5)
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
    b_object.rotation_euler = (0.5 + np.pi if case.is_turned else 0.5, 0.3, 0.2)
    b_object.scale = (-0.9 if case.is_mirrored else 0.9, 1.0, 1.2)
    b_object.color, b_object.pass_index = (0.2, 0.4, 0.6, 0.5), 3
    b_object["Tint"], b_mesh["Shade"] = (0.3, 0.6, 0.9, 0.7), 0.4
    scene.view_layers[0]["Tint"], scene["Mood"] = (0.2, 0.5), 2
    if case.scattered is not None:
        b_object.hide_render = True
        scatter(b_object, **case.scattered)["Own"] = (0.1, 0.2, 0.3)
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


def scaled(b_tree: Any, b_output: Any, factor: float, offset: float) -> Any:
    """A node that gives factor times an output plus offset."""
    b_node = b_tree.nodes.new("ShaderNodeVectorMath")
    b_node.operation = "MULTIPLY_ADD"
    b_node.inputs[1].default_value, b_node.inputs[2].default_value = (factor,) * 3, (offset,) * 3
    b_tree.links.new(b_output, b_node.inputs[0])
    return b_node

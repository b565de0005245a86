"""A closed room in which every surface emits just what it fails to reflect: the same radiance everywhere.

A surface of albedo rho that emits (1 - rho) L and is surrounded by radiance L sends out (1 - rho) L + rho L = L. So the
picture is L in every pixel, in corners and at edges too, whatever the albedos are and however the light gets there.
"""

from __future__ import annotations

import math

from scenes import common

RADIANCE = 0.5
"""L, the radiance of every surface in every channel (W/m2/sr)."""
ALBEDOS = {
    "Left": (0.8, 0.2, 0.2),
    "Right": (0.2, 0.8, 0.2),
    "Front": (0.5, 0.5, 0.5),
    "Back": (0.7, 0.6, 0.3),
    "Floor": (0.6, 0.6, 0.6),
    "Ceiling": (0.75, 0.75, 0.75),
}
BLOCK_ALBEDO = (0.3, 0.4, 0.8)


def furnace_material(name: str, albedo: common.Color) -> common.bpy.types.Material:
    """Lambertian, and emitting what it absorbs."""
    material, tree, surface = common.new_material(name)
    diffuse = tree.nodes.new("ShaderNodeBsdfDiffuse")
    diffuse.inputs["Color"].default_value = (*albedo, 1.0)
    emission = tree.nodes.new("ShaderNodeEmission")
    emission.inputs["Color"].default_value = (*(1.0 - channel for channel in albedo), 1.0)
    emission.inputs["Strength"].default_value = RADIANCE
    add = tree.nodes.new("ShaderNodeAddShader")
    tree.links.new(diffuse.outputs["BSDF"], add.inputs[0])
    tree.links.new(emission.outputs["Emission"], add.inputs[1])
    tree.links.new(add.outputs["Shader"], surface)
    return material


def build() -> None:
    """A room of 2 m x 3 m x 2 m with a turned block on its floor; the camera is inside."""
    common.start_empty_file()
    faces = common.box_faces((-1.0, -1.5, 0.0), (1.0, 1.5, 2.0))
    materials = [furnace_material(name, albedo) for name, albedo in ALBEDOS.items()]
    common.add_polygons("Room", [list(reversed(face)) for face in faces], materials, range(6))
    block = common.box_faces((-0.35, -0.35, 0.0), (0.35, 0.35, 0.9))
    stand = common.add_polygons("Block", [*block[:4], block[5]], [furnace_material("Block", BLOCK_ALBEDO)])
    stand.location = (-0.15, 0.5, 0.0)
    stand.rotation_euler = (0.0, 0.0, math.radians(25.0))
    common.add_camera((0.1, -1.4, 1.1), (math.radians(86.0), 0.0, 0.0), math.radians(75.0), (256, 256))


def known_answer() -> dict[str, object]:
    """The radiance of every pixel and channel."""
    return {"radiance": RADIANCE}

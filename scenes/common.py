"""What the scene scripts share: an empty file, polygons, plain materials, a camera, clean settings, saving."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path

import bpy

Point = tuple[float, float, float]
Color = tuple[float, float, float]

SCENES = Path(__file__).resolve().parent


def start_empty_file() -> bpy.types.Scene:
    """Factory settings, nothing in the scene, a black world."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    world = bpy.data.worlds.new("Black")
    shader_tree(world).nodes["Background"].inputs["Color"].default_value = (0.0, 0.0, 0.0, 1.0)
    scene.world = world
    set_clean_settings(scene)
    return scene


def set_clean_settings(scene: bpy.types.Scene, samples: int = 1024) -> None:
    """Cycles on the CPU with nothing that trades truth for speed, and a view transform that does not restyle."""
    scene.render.engine = "CYCLES"
    cycles = scene.cycles
    cycles.device = "CPU"
    cycles.samples = samples
    cycles.use_adaptive_sampling = False
    cycles.use_denoising = False
    cycles.sample_clamp_direct = 0.0
    cycles.sample_clamp_indirect = 0.0
    cycles.light_sampling_threshold = 0.0
    cycles.blur_glossy = 0.0
    cycles.caustics_reflective = True
    cycles.caustics_refractive = True
    cycles.pixel_filter_type = "BLACKMAN_HARRIS"
    cycles.filter_width = 1.5
    for limit in ("max", "diffuse", "glossy", "transmission", "transparent_max"):
        setattr(cycles, f"{limit}_bounces", 64)
    scene.view_settings.view_transform = "Standard"
    scene.render.filepath = "//"
    scene.render.resolution_percentage = 100


def add_polygons(
    name: str,
    polygons: Sequence[Sequence[Point]],
    materials: Sequence[bpy.types.Material],
    slots: Sequence[int] = (),
) -> bpy.types.Object:
    """A mesh object of flat polygons (corners in metres) that share no vertex; `slots` is one material per polygon."""
    mesh = bpy.data.meshes.new(name)
    vertices = [corner for polygon in polygons for corner in polygon]
    faces = []
    for polygon in polygons:
        first = faces[-1][-1] + 1 if faces else 0
        faces.append(tuple(range(first, first + len(polygon))))
    mesh.from_pydata(vertices, [], faces)
    for material in materials:
        mesh.materials.append(material)
    if slots:
        mesh.polygons.foreach_set("material_index", slots)
    return add_object(name, mesh)


def box_faces(low: Point, high: Point) -> list[list[Point]]:
    """The six faces of an axis-aligned box: -x, +x, -y, +y, -z, +z, normals outwards."""
    (x0, y0, z0), (x1, y1, z1) = low, high
    return [
        [(x0, y0, z0), (x0, y0, z1), (x0, y1, z1), (x0, y1, z0)],
        [(x1, y0, z0), (x1, y1, z0), (x1, y1, z1), (x1, y0, z1)],
        [(x0, y0, z0), (x1, y0, z0), (x1, y0, z1), (x0, y0, z1)],
        [(x0, y1, z0), (x0, y1, z1), (x1, y1, z1), (x1, y1, z0)],
        [(x0, y0, z0), (x0, y1, z0), (x1, y1, z0), (x1, y0, z0)],
        [(x0, y0, z1), (x1, y0, z1), (x1, y1, z1), (x0, y1, z1)],
    ]


def add_object(name: str, data: bpy.types.ID) -> bpy.types.Object:
    """Links an object that shows `data` into the scene."""
    thing = bpy.data.objects.new(name, data)
    bpy.context.scene.collection.objects.link(thing)
    return thing


def new_material(name: str) -> tuple[bpy.types.Material, bpy.types.NodeTree, bpy.types.NodeSocket]:
    """A material whose tree holds only its output node; the socket is the output's Surface."""
    material = bpy.data.materials.new(name)
    tree = shader_tree(material)
    tree.nodes.clear()
    return material, tree, tree.nodes.new("ShaderNodeOutputMaterial").inputs["Surface"]


def shader_tree(data: bpy.types.Material | bpy.types.World) -> bpy.types.NodeTree:
    """The node tree of a new material or world, which Blender 4 makes only when asked to."""
    if data.node_tree is None:
        data.use_nodes = True
    return data.node_tree


def diffuse_material(name: str, albedo: Color) -> bpy.types.Material:
    """A Lambertian surface."""
    material, tree, surface = new_material(name)
    shader = tree.nodes.new("ShaderNodeBsdfDiffuse")
    shader.inputs["Color"].default_value = (*albedo, 1.0)
    tree.links.new(shader.outputs["BSDF"], surface)
    return material


def principled_material(name: str, **sockets: float | Color) -> bpy.types.Material:
    """A Principled BSDF; sockets by name with underscores for spaces, the rest as Blender sets them."""
    material, tree, surface = new_material(name)
    shader = tree.nodes.new("ShaderNodeBsdfPrincipled")
    for socket, value in sockets.items():
        shader.inputs[socket.replace("_", " ")].default_value = (
            (*value, 1.0) if isinstance(value, tuple) else value
        )
    tree.links.new(shader.outputs["BSDF"], surface)
    return material


def add_area_lamp(
    name: str, size: tuple[float, float], radiance: Color, location: Point, rotation: Point = (0.0, 0.0, 0.0)
) -> bpy.types.Object:
    """A rectangular lamp shining along its -Z; size in metres. Blender's power of a Lambertian lamp is pi A L."""
    strongest = max(radiance)
    light = bpy.data.lights.new(name, "AREA")
    light.shape = "RECTANGLE"
    light.size, light.size_y = size
    light.color = tuple(channel / strongest for channel in radiance)
    light.energy = math.pi * size[0] * size[1] * strongest
    lamp = add_object(name, light)
    lamp.location, lamp.rotation_euler = location, rotation
    return lamp


def add_camera(
    location: Point, rotation: Point, field_of_view: float, resolution: tuple[int, int]
) -> bpy.types.Object:
    """The scene's camera: Euler angles and the field of view over the longer side in radians."""
    scene = bpy.context.scene
    camera = bpy.data.cameras.new("Camera")
    camera.lens_unit = "FOV"
    camera.angle = field_of_view
    scene.camera = add_object("Camera", camera)
    scene.camera.location, scene.camera.rotation_euler = location, rotation
    scene.render.resolution_x, scene.render.resolution_y = resolution
    return scene.camera


def save(name: str, folder: Path = SCENES) -> Path:
    """Saves the file as `<name>.blend`, compressed, without backups of older versions."""
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / f"{name}.blend"
    bpy.context.preferences.filepaths.save_version = 0
    bpy.ops.wm.save_as_mainfile(filepath=str(path), compress=True)
    return path

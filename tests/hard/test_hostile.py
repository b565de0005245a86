"""Input that nobody meant, through the public doors: a message or a picture of numbers, never a crash.

`RGP_EXAMPLES` sets how many inputs each test draws; `make fuzz` draws many.
"""

import contextlib
import os

import bpy
import numpy as np
import pytest
import rgp_core
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import rgp_engine
from rgp_engine.export.ies import IesError, read
from rgp_engine.report import last_outcome
from tests.blender import build
from tests.hard import scenes

EXAMPLES = settings(
    max_examples=int(os.environ.get("RGP_EXAMPLES", "40")),
    deadline=None,
    suppress_health_check=list(HealthCheck),
)
NUMBERS = st.one_of(
    st.floats(width=32),
    st.sampled_from([0.0, -0.0, 1.0, -1.0, float("nan"), float("inf"), -float("inf"), 1e-45, 3e38, 1e-20]),
)
JUNK = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=8),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=8), inner, max_size=3),
    max_leaves=8,
)
FEW = scenes.settings(photon_pass__photon_count=500, pyramid__finest_resolution=8, gather__rays=4)
KNOBS = rgp_core.settings_schema()


def array(shape, elements=NUMBERS, dtype=np.float32):
    count = int(np.prod(shape))
    values = st.lists(elements, min_size=count, max_size=count)
    return values.map(lambda v: np.array(v, np.float64).astype(dtype).reshape(shape))


@st.composite
def meshes(draw):
    """Arrays that fit together or not."""
    vertices, triangles = draw(st.integers(0, 6)), draw(st.integers(0, 6))
    more = {}
    if draw(st.booleans()):
        more["corner_normals"] = draw(array((triangles, 3, 3)))
    if draw(st.booleans()):
        more["layers"] = [(0, draw(array((triangles, 3, draw(st.integers(1, 4))))))]
    if draw(st.booleans()):
        more["slots"] = draw(array((triangles,), st.integers(0, 3), np.uint16))
    indices = st.integers(0, max(0, vertices - 1 + draw(st.integers(0, 1))))
    return draw(array((vertices, 3))), draw(array((triangles, 3), indices, np.uint32)), more


@EXAMPLES
@given(meshes(), array((4, 4), dtype=np.float64), array((4, 4), dtype=np.float64), NUMBERS, NUMBERS, NUMBERS)
def test_scene_builder(mesh, matrix, lamp, power, radius, color):
    positions, triangles, more = mesh
    scene = scenes.Scene()
    scene.look((0, 0, 3), (0, 0, 0), 0.5, pixels=(4, 4))
    try:
        with np.errstate(all="ignore"):
            material = scene.material([scenes.closure("glass", color=color, roughness=radius, ior=power)])
            index = scene.builder.add_mesh("Mesh", positions, triangles, **more)
            scene.builder.add_object("Object", index, matrix, [material], 31)
            scene.builder.add_object("Twin", index, np.eye(4), [], 31)
            scene.lamp(power, lamp, "spot", radius=radius, cone_angle=color, blend=power)
            scene.lamp(power, lamp, "rectangle", size=[radius, color], spread=power)
            built = scene.builder.finish()
    except (rgp_core.RenderError, TypeError, ValueError):
        return
    picture = scenes.render(built, FEW)
    assert np.isfinite(picture.combined).all()


@EXAMPLES
@given(st.dictionaries(st.text(max_size=12), JUNK, max_size=4))
def test_records(record):
    builder = rgp_core.SceneBuilder()
    for door in (builder.add_material, builder.add_lamp, builder.set_camera, builder.set_world):
        try:
            door(record)
        except (rgp_core.RenderError, TypeError, ValueError):
            continue


@EXAMPLES
@given(st.data())
def test_settings(data):
    knob = data.draw(st.sampled_from(KNOBS))
    group = data.draw(st.sampled_from([knob["group"], "", "gather"]))
    value = data.draw(JUNK | st.just(knob["default"]) | st.text(alphabet="0123456789x.-", max_size=12))
    try:
        rgp_core.check_settings({group: {knob["name"]: value}})
    except (rgp_core.SettingsError, TypeError):
        return


@EXAMPLES
@given(st.data())
def test_textures(data):
    shape = data.draw(st.tuples(st.integers(0, 5), st.integers(0, 5), st.integers(0, 5)))
    kind = data.draw(st.sampled_from([np.uint8, np.float32, np.float64, np.int32]))
    elements = NUMBERS if kind in (np.float32, np.float64) else st.integers(0, 255)
    pixels = data.draw(array(shape, elements, kind))
    try:
        rgp_core.SceneBuilder().add_texture(
            "Image", pixels, data.draw(st.sampled_from(["srgb", "linear", ""]))
        )
    except (rgp_core.RenderError, TypeError, ValueError):
        return


def shader_nodes() -> list[str]:
    """Every kind of node a material can hold."""
    names = [name for name in dir(bpy.types) if name.startswith("ShaderNode")]
    left_out = (
        "ShaderNode",
        "ShaderNodeTree",
        "ShaderNodeGroup",
        "ShaderNodeCustomGroup",
        "ShaderNodeScript",
    )
    return [name for name in names if name not in left_out]


def set_inputs(data, b_node) -> None:
    for b_socket in b_node.inputs:
        value = getattr(b_socket, "default_value", None)
        if isinstance(value, float):
            b_socket.default_value = data.draw(NUMBERS)
        elif value is not None and hasattr(value, "__len__") and not isinstance(value, str):
            for i in range(len(value)):
                value[i] = data.draw(NUMBERS)


@pytest.mark.parametrize("of", ["material", "lamp"])
@EXAMPLES
@given(st.data())
def test_node_compiler(of, data):
    """Nodes of any kind, any numbers in them, linked at random, circles included."""
    if not hasattr(bpy.types.Scene, "rgp"):
        rgp_engine.register()
    bpy.ops.wm.read_factory_settings(use_empty=True)
    b_scene = bpy.context.scene
    b_scene.render.engine = "RGP"
    b_scene.render.resolution_x, b_scene.render.resolution_y = 8, 6
    b_scene.rgp.photon_pass.photon_count, b_scene.rgp.pyramid.finest_resolution = 500, 8
    b_scene.rgp.gather.rays, b_scene.rgp.gather.camera_samples = 4, 1
    build.lit_room()
    if of == "material":
        b_material, b_tree, b_output = build.material()
        bpy.data.objects["Floor"].data.materials.append(b_material)
    else:
        b_tree = build.shader_tree(bpy.data.lights["Lamp"])
        b_output = b_tree.nodes.new("ShaderNodeOutputLight")
    b_nodes = []
    for kind in data.draw(st.lists(st.sampled_from(shader_nodes()), min_size=1, max_size=6)):
        try:
            b_nodes.append(b_tree.nodes.new(kind))
        except RuntimeError:
            continue  # kinds that this Blender only lists
        set_inputs(data, b_nodes[-1])
    b_from = [b_socket for b_node in b_nodes for b_socket in b_node.outputs]
    b_to = [b_socket for b_node in [*b_nodes, b_output] for b_socket in b_node.inputs]
    for _ in range(data.draw(st.integers(1, 10)) if b_from else 0):
        b_tree.links.new(data.draw(st.sampled_from(b_from)), data.draw(st.sampled_from(b_to)))
    bpy.ops.render.render()  # raises what the artist would be told as an error
    assert last_outcome().error == ""
    assert last_outcome().stats["nonfinite_pixels"] == 0


LUMINAIRE = (
    b"IESNA91\nTILT=INCLUDE\n1 2 0 90 1 0.5\n1 -1 1 3 2 1 1 0 0 0\n1 1 50\n0 45 90\n0 90\n5 3 1 4 2 0\n"
)
WORDS = st.sampled_from(
    [b"0", b"1", b"2", b"3", b"-90", b"90", b"180", b"1e38", b"-1", b"nan", b"99999999999", b"x"]
)


def shining(web):
    """A floor that shines as a luminaire does, seen from above."""
    scene = scenes.Scene()
    scene.look((0, 0, 3), (0, 0, 0), 0.5, pixels=(4, 4))
    towards = {"op": "geometry", "quantity": "object_incoming", "aside": [0.0, 0.0]}
    look = {"op": "photometric_web", "vector": 0, "web": web.record()}
    outputs = [{"closure": 0, "input": "radiance", "register": 1}]
    program = {"instructions": [towards, look], "outputs": outputs, "normal": None, "normals": []}
    scene.place(
        scene.mesh(scenes.quad(1.0)),
        scene.material([scenes.closure("emission", radiance=[1.0] * 3)], program),
    )
    return scene


@EXAMPLES
@given(
    st.binary(max_size=200), st.lists(st.tuples(st.integers(0, 40), WORDS), max_size=8), st.integers(0, 200)
)
def test_ies_files(junk, changes, end):
    words = LUMINAIRE.split(b" ")
    for place, word in changes:
        words[place % len(words)] = word
    for content in (junk, b"TILT=" + junk, b" ".join(words)[:end], b" ".join(words)):
        with contextlib.suppress(IesError):
            web = read(content)
            assert web.mean >= 0.0
            assert np.isfinite(shining(web).render(FEW).combined).all()

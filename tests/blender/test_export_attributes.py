"""Attribute nodes of objects, instancers and view layers, and the values they find. What a name leads to is what Cycles
finds: `tests/render/node_cases.py` compares pictures of the commonest."""

import bpy
import pytest

from rgp_engine.export.named_values import property_value
from tests.blender import build
from tests.blender.scatter import scatter


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("one", (0.5, 0.5, 0.5, 1.0)),
        ("whole", (3.0, 3.0, 3.0, 1.0)),
        ("flag", (1.0, 1.0, 1.0, 1.0)),
        ("two", (0.5, 0.25, 0.0, 1.0)),
        ("wholes", (1.0, 2.0, 3.0, 1.0)),
        ("four", (0.5, 0.25, 0.125, 0.75)),
        ("color", (7.0, 7.0, 7.0, 1.0)),
        ("location", (1.0, 2.0, 3.0, 1.0)),
        ("pass_index", (4.0, 4.0, 4.0, 1.0)),
        ("hide_render", (0.0, 0.0, 0.0, 1.0)),
        ('["one"]', (0.5, 0.5, 0.5, 1.0)),
        ("data.auto_texspace", (1.0, 1.0, 1.0, 1.0)),
        *((name, None) for name in ("five", "flags", "text", "group", "location[0]", "location.x", "name")),
        *(
            (name, None)
            for name in ("matrix_world", "lock_location", "data", "modifiers", "nothing", "[", "")
        ),
    ],
)
def test_a_name_is_a_property_or_a_path(scene, name, expected):
    b_object = build.add_object("Cube", build.cube(), (1.0, 2.0, 3.0))
    b_object.pass_index = 4
    values = {"one": 0.5, "whole": 3, "flag": True, "text": "0.5", "color": 7.0, "group": {"one": 0.5}}
    arrays = {"two": (0.5, 0.25), "wholes": (1, 2, 3), "four": (0.5, 0.25, 0.125, 0.75), "five": (0.5,) * 5}
    for key, value in {**values, **arrays, "flags": (True, False)}.items():
        b_object[key] = value
    assert property_value(b_object, name) == expected


def reading(kind, name, output="Color"):
    """A material whose color is what an Attribute node reads."""
    b_material, b_tree, b_output = build.material()
    b_shader, b_attribute = b_tree.nodes.new("ShaderNodeBsdfDiffuse"), b_tree.nodes.new("ShaderNodeAttribute")
    b_attribute.attribute_type, b_attribute.attribute_name = kind, name
    build.connect(b_tree, b_attribute, b_shader, "Color", output)
    build.connect(b_tree, b_shader, b_output, "Surface")
    return b_material


def shown(b_material, name="Cube"):
    b_mesh = build.cube(name)
    b_mesh.materials.append(b_material)
    return build.add_object(name, b_mesh)


def values(recording, name):
    """The first values of the objects of that name, rounded."""
    attributes = [record["info"]["attributes"] for record in recording.objects_of(name)]
    return [tuple(round(x, 4) for x in found[0]["value"]) if found else None for found in attributes]


def test_an_object_has_its_own_value_else_its_data_s(scene, export, problems):
    build.add_camera()
    b_material = reading("OBJECT", "Shade")
    for name, owner in (("Own", "object"), ("Of data", "data"), ("None", "")):
        b_object = shown(b_material, name)
        if owner:
            (b_object if owner == "object" else b_object.data)["Shade"] = 0.5
    recording = export()
    assert values(recording, "Own") == values(recording, "Of data") == [(0.5, 0.5, 0.5, 1.0)]
    assert values(recording, "None") == [None]
    assert 'None: its nodes read "Shade", which the object does not have; 0 is used' in problems()
    program = recording.material_of("Material")["program"]
    assert [step["op"] for step in program["instructions"]] == ["object_attribute"]


@pytest.mark.parametrize(
    ("name", "output", "color"),
    [
        ("Tint", "Color", (0.25, 0.5, 0.0)),
        ("Tint", "Vector", (0.25, 0.5, 0.0)),
        ("Tint", "Fac", (0.25,) * 3),
        ("Tint", "Alpha", (1.0,) * 3),
        ("Mood", "Color", (2.0,) * 3),
        ("Air", "Fac", (0.5,) * 3),
        ("nothing", "Alpha", (0.0,) * 3),
    ],
)
def test_values_of_the_view_layer_are_constants(scene, export, problems, name, output, color):
    build.add_camera()
    scene.world = bpy.data.worlds.new("World")
    for b_owner, values_of_owner in (
        (scene.view_layers[0], {"Tint": (0.25, 0.5)}),
        (scene, {"Mood": 2, "Tint": 9.0}),
        (scene.world, {"Air": 0.5, "Mood": 9}),
    ):
        for key, value in values_of_owner.items():
            b_owner[key] = value
    shown(reading("VIEW_LAYER", name, output))
    record = export().material_of("Material")
    assert record.get("program") is None
    assert record["closures"][0]["closure"]["color"] == pytest.approx(list(color))
    assert not [text for text in problems() if "Attribute" in text]


QUARTERS = {(-0.25, -0.25), (-0.25, 0.25), (0.25, -0.25), (0.25, 0.25)}


@pytest.mark.skipif(
    bpy.app.version < (4, 5), reason="Blender 4.2 does not tell of the attributes of instances"
)
@pytest.mark.parametrize("axis", ["inner", "outer"])
@pytest.mark.parametrize(("joined", "has_ids"), [(False, False), (True, True)])
@pytest.mark.parametrize("as_instance", [True, False])
def test_instances_of_geometry_nodes_have_attributes(scene, export, as_instance, joined, has_ids, axis):
    build.add_camera()
    b_cube = shown(reading("INSTANCER", axis))
    b_cube.hide_render = True
    b_scatter = scatter(b_cube, as_instance=as_instance, joined=joined, has_ids=has_ids)
    b_scatter[axis] = b_cube[axis] = 7.0
    recording = export()
    name = "Cube" if as_instance else "Scatter"
    objects = [record for record in recording.objects_of(name) if "info" in record]
    found = {}
    for record in objects:
        matrix = record["world_from_object"]
        [attribute] = record["info"]["attributes"]
        found[round(matrix[0, 3], 4), round(matrix[1, 3], 4)] = round(attribute["value"][0], 4)
    assert set(found) == QUARTERS
    assert found == {place: place[0 if axis == "inner" else 1] for place in QUARTERS}


@pytest.mark.skipif(bpy.app.version >= (4, 5), reason="later Blenders tell of the attributes of instances")
def test_attributes_of_instances_that_blender_keeps_are_reported(scene, export, problems):
    build.add_camera()
    b_cube = shown(reading("INSTANCER", "inner"))
    scatter(b_cube, as_instance=True)["inner"] = 0.5
    assert values(export(), "Cube")[-1] == (0.5, 0.5, 0.5, 1.0)
    message = 'attributes of its instances, such as "inner", cannot be read before Blender 4.5'
    assert f"Scatter: {message}; properties of objects are used" in problems()


def test_what_shows_an_object_comes_before_the_object(scene, export):
    build.add_camera()
    b_cube = shown(reading("INSTANCER", "Shade"))
    b_cube["Shade"] = 0.25
    b_collection = bpy.data.collections.new("Shown")
    b_collection.objects.link(b_cube)
    for i, shade in enumerate((0.5, None)):
        b_empty = build.add_object(f"Empty{i}", None, (i, 0, 0))
        b_empty.instance_type, b_empty.instance_collection = "COLLECTION", b_collection
        if shade is not None:
            b_empty["Shade"] = shade
    found = values(export(), "Cube")
    assert sorted(found) == [(0.25, 0.25, 0.25, 1.0)] * 2 + [(0.5, 0.5, 0.5, 1.0)]


def test_particles_have_the_values_of_their_settings(scene, export):
    build.add_camera()
    b_cube = shown(reading("INSTANCER", "Shade"))
    b_emitter = build.add_object("Emitter", build.quad())
    b_emitter.modifiers.new("Particles", "PARTICLE_SYSTEM")
    b_settings = b_emitter.particle_systems[0].settings
    b_settings.count, b_settings.frame_end, b_settings.lifetime = 3, 1.0, 100.0
    b_settings.render_type, b_settings.instance_object = "OBJECT", b_cube
    b_settings["Shade"], b_emitter["Shade"], b_cube["Shade"] = 0.75, 0.5, 0.25
    scene.frame_set(2)
    assert sorted(values(export(), "Cube")) == [(0.25, 0.25, 0.25, 1.0)] + [(0.75, 0.75, 0.75, 1.0)] * 3


def test_the_world_is_no_object(scene, export):
    build.add_camera()
    scene.world = bpy.data.worlds.new("World")
    b_tree = build.shader_tree(scene.world)
    b_background, b_attribute = (
        b_tree.nodes.new(f"ShaderNode{kind}") for kind in ("Background", "Attribute")
    )
    b_attribute.attribute_type, b_attribute.attribute_name = "OBJECT", "Shade"
    scene.world["Shade"] = 0.5
    build.connect(b_tree, b_attribute, b_background, "Color", "Alpha")
    build.connect(b_tree, b_background, b_tree.nodes.new("ShaderNodeOutputWorld"), "Surface")
    steps = export().world["program"]["instructions"]
    assert "object_attribute" not in [step["op"] for step in steps]
    assert [0.0, 0.0, 0.0, 1.0] in [step.get("value") for step in steps]

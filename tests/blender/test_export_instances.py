"""Objects and instances: what is exported, how often, where, with which materials."""

import bpy
import numpy as np
import pytest

from tests.blender import build

ALL, HOLDOUT, CATCHER = 31, 64, 1 << 31


def names(recording):
    return sorted(record["name"] for record in recording.objects)


def matrices(recording, name):
    return [record["world_from_object"] for record in recording.objects_of(name)]


def test_objects_that_share_a_mesh_share_its_triangles(scene, export):
    build.add_camera()
    b_mesh = build.cube()
    for x in range(3):
        build.add_object(f"Cube{x}", b_mesh, (x, 0, 0))
    recording = export()
    assert len(recording.meshes) == 1
    assert [record["mesh"] for record in recording.objects] == [0, 0, 0]
    assert sorted(m[0][3] for m in (r["world_from_object"] for r in recording.objects)) == [0, 1, 2]


def test_a_modifier_makes_a_mesh_of_its_own(scene, export):
    build.add_camera()
    b_mesh = build.cube()
    build.add_object("Plain", b_mesh)
    b_smooth = build.add_object("Subdivided", b_mesh)
    b_modifier = b_smooth.modifiers.new("Subdivision", "SUBSURF")
    b_modifier.render_levels, b_modifier.levels = 2, 0
    recording = export()
    counts = {o["name"]: len(recording.meshes[o["mesh"]]["triangles"]) for o in recording.objects}
    # The render level counts: each quad becomes 16.
    assert counts == {"Plain": 12, "Subdivided": 12 * 16}


def test_collection_instances(scene, export):
    build.add_camera()
    b_collection = bpy.data.collections.new("Trees")
    b_tree = bpy.data.objects.new("Tree", build.cube("Trunk"))
    b_tree.location = (1, 0, 0)
    b_collection.objects.link(b_tree)
    for x in (10, 20):
        b_empty = build.add_object(f"Instance{x}", None, (x, 0, 0))
        b_empty.instance_type, b_empty.instance_collection = "COLLECTION", b_collection
    recording = export()
    assert names(recording) == ["Tree", "Tree"]
    assert len(recording.meshes) == 1
    assert sorted(m[0, 3] for m in matrices(recording, "Tree")) == [11.0, 21.0]


@pytest.mark.parametrize("shows_parent", [True, False])
def test_face_instances_hide_their_emitter(scene, export, shows_parent):
    build.add_camera()
    b_parent = build.add_object("Parent", build.cube("Instancer"))
    b_child = build.add_object("Child", build.quad())
    b_child.parent = b_parent
    b_parent.instance_type = "FACES"
    b_parent.show_instancer_for_render = shows_parent
    recording = export()
    assert names(recording) == ["Child"] * 6 + ["Parent"] * shows_parent
    assert len(recording.meshes) == 1 + shows_parent


def test_nested_instances(scene, export):
    build.add_camera()
    inner, outer = (bpy.data.collections.new(name) for name in ("Inner", "Outer"))
    inner.objects.link(bpy.data.objects.new("Leaf", build.quad()))
    for y in (0, 5):
        b_branch = bpy.data.objects.new(f"Branch{y}", None)
        b_branch.location = (0, y, 0)
        b_branch.instance_type, b_branch.instance_collection = "COLLECTION", inner
        outer.objects.link(b_branch)
    for x in (0, 7):
        b_tree = build.add_object(f"Tree{x}", None, (x, 0, 0))
        b_tree.instance_type, b_tree.instance_collection = "COLLECTION", outer
    recording = export()
    found = sorted((m[0, 3], m[1, 3]) for m in matrices(recording, "Leaf"))
    assert found == [(0, 0), (0, 5), (7, 0), (7, 5)]
    assert len(recording.meshes) == 1


def add_instancing_nodes(b_object, materials):
    """Geometry nodes that put a cube and a sphere, each of its material, on the object's points."""
    b_tree = build.nodes_group("Scatter")
    b_in, b_out = b_tree.nodes.new("NodeGroupInput"), b_tree.nodes.new("NodeGroupOutput")
    b_join = b_tree.nodes.new("GeometryNodeJoinGeometry")
    for kind, b_material in zip(("GeometryNodeMeshCube", "GeometryNodeMeshUVSphere"), materials, strict=True):
        b_set = b_tree.nodes.new("GeometryNodeSetMaterial")
        b_set.inputs["Material"].default_value = b_material
        b_instances = b_tree.nodes.new("GeometryNodeInstanceOnPoints")
        b_tree.links.new(b_tree.nodes.new(kind).outputs["Mesh"], b_set.inputs["Geometry"])
        b_tree.links.new(b_in.outputs[0], b_instances.inputs["Points"])
        b_tree.links.new(b_set.outputs["Geometry"], b_instances.inputs["Instance"])
        b_tree.links.new(b_instances.outputs["Instances"], b_join.inputs["Geometry"])
    b_tree.links.new(b_join.outputs["Geometry"], b_out.inputs[0])
    b_object.modifiers.new("Nodes", "NODES").node_group = b_tree


def test_geometry_nodes_instances_are_told_apart_by_their_geometry(scene, export):
    """All of them bear the name of the object that has the modifier."""
    build.add_camera()
    materials = [build.surface("ShaderNodeBsdfDiffuse", name) for name in ("Red", "Blue")]
    b_object = build.add_object("Scatter", build.quad(size=3.0))
    add_instancing_nodes(b_object, materials)
    recording = export()
    assert len(recording.objects) == 8
    assert len(recording.meshes) == 2
    used = {}
    for record in recording.objects:
        arrays = recording.meshes[record["mesh"]]
        (slot,) = np.unique(0 if arrays["slots"] is None else arrays["slots"])
        used[len(arrays["triangles"])] = recording.materials[record["materials"][slot]]["name"]
    assert used[12] == "Red"
    assert [name for count, name in used.items() if count > 12] == ["Blue"]


def test_particle_instances(scene, export):
    build.add_camera()
    b_emitter = build.add_object("Emitter", build.quad(size=3.0))
    b_leaf = build.add_object("Leaf", build.quad("LeafMesh", 0.1), (50, 0, 0))
    b_emitter.modifiers.new("Particles", "PARTICLE_SYSTEM")
    b_settings = b_emitter.particle_systems[0].settings
    b_settings.count, b_settings.frame_start, b_settings.frame_end, b_settings.lifetime = 5, 1, 1, 100
    b_settings.render_type, b_settings.instance_object = "OBJECT", b_leaf
    scene.frame_set(2)
    recording = export()
    assert len(recording.objects_of("Leaf")) == 6
    assert len(recording.meshes) == 2


def test_hidden_objects_are_left_out(scene, export):
    build.add_camera()
    b_hidden = build.add_object("Hidden", build.quad())
    b_hidden.hide_render = True
    build.add_object("Shown", build.quad()).hide_viewport = True
    b_collection = bpy.data.collections.new("Off")
    scene.collection.children.link(b_collection)
    b_collection.objects.link(bpy.data.objects.new("InHiddenCollection", build.quad()))
    b_collection.hide_render = True
    assert names(export()) == ["Shown"]


def test_only_the_view_layer_that_is_rendered(scene, export):
    build.add_camera()
    b_collection = bpy.data.collections.new("Second only")
    scene.collection.children.link(b_collection)
    b_collection.objects.link(bpy.data.objects.new("Extra", build.quad()))
    build.add_object("Always", build.quad())
    scene.view_layers.new("Second")
    scene.view_layers[0].layer_collection.children[0].exclude = True
    # Layers are rendered in order: the last recording is the second's.
    assert names(export()) == ["Always", "Extra"]
    scene.view_layers["Second"].use = False
    assert names(export()) == ["Always"]


@pytest.mark.parametrize(
    ("flag", "bit"),
    [
        ("visible_camera", 1),
        ("visible_diffuse", 2),
        ("visible_glossy", 4),
        ("visible_transmission", 8),
        ("visible_shadow", 16),
    ],
)
def test_ray_visibility(scene, export, flag, bit):
    build.add_camera()
    setattr(build.add_object("Quad", build.quad()), flag, False)
    assert export().objects[0]["visibility"] == ALL - bit


def test_an_instance_is_seen_by_what_sees_it_and_its_instancer(scene, export):
    build.add_camera()
    b_collection = bpy.data.collections.new("Collection")
    b_leaf = bpy.data.objects.new("Leaf", build.quad())
    b_leaf.visible_glossy = False
    b_collection.objects.link(b_leaf)
    b_empty = build.add_object("Empty", None)
    b_empty.instance_type, b_empty.instance_collection = "COLLECTION", b_collection
    b_empty.visible_camera = False
    assert export().objects[0]["visibility"] == ALL - 4 - 1


def test_indirect_only_collections_are_hidden_from_the_camera(scene, export):
    build.add_camera()
    b_collection = bpy.data.collections.new("Indirect")
    scene.collection.children.link(b_collection)
    b_collection.objects.link(bpy.data.objects.new("Quad", build.quad()))
    bpy.context.view_layer.layer_collection.children[0].indirect_only = True
    assert export().objects[0]["visibility"] == ALL - 1


@pytest.mark.parametrize("kind", ["CURVE", "FONT", "META", "SURFACE"])
def test_everything_that_can_be_a_mesh_is(scene, export, kind):
    build.add_camera()
    if kind == "FONT":
        b_data = bpy.data.curves.new("Text", "FONT")
        b_data.body = "RGP"
        build.add_object("Thing", b_data)
    elif kind == "CURVE":
        b_data = bpy.data.curves.new("Curve", "CURVE")
        b_data.dimensions, b_data.bevel_depth = "3D", 0.1
        b_spline = b_data.splines.new("POLY")
        b_spline.points.add(2)
        for index, b_point in enumerate(b_spline.points):
            b_point.co = (index, index**2, 0, 1)
        build.add_object("Thing", b_data)
    elif kind == "META":
        b_data = bpy.data.metaballs.new("Ball")
        b_data.elements.new().co = (0, 0, 0)
        build.add_object("Thing", b_data)
    else:
        bpy.ops.surface.primitive_nurbs_surface_sphere_add()
        bpy.context.object.name = "Thing"
    recording = export()
    assert names(recording) == ["Thing"]
    assert len(recording.meshes[0]["triangles"]) > 10


def test_curves_of_one_data_with_different_modifiers(scene, export):
    build.add_camera()
    b_data = bpy.data.curves.new("Text", "FONT")
    b_data.body, b_data.extrude = "A", 0.1
    build.add_object("Plain", b_data)
    b_many = build.add_object("Many", b_data)
    b_many.modifiers.new("Array", "ARRAY").count = 3
    recording = export()
    counts = {o["name"]: len(recording.meshes[o["mesh"]]["triangles"]) for o in recording.objects}
    assert counts["Many"] == 3 * counts["Plain"] > 0


def test_material_slots_of_object_and_mesh(scene, export):
    build.add_camera()
    mesh_material, object_material = (
        build.surface("ShaderNodeBsdfDiffuse", name) for name in ("OfMesh", "OfObject")
    )
    b_mesh = build.cube()
    b_mesh.materials.append(mesh_material)
    b_mesh.materials.append(None)
    b_mesh.polygons[3].material_index = 1
    build.add_object("First", b_mesh)
    b_second = build.add_object("Second", b_mesh)
    b_second.material_slots[0].link = "OBJECT"
    b_second.material_slots[0].material = object_material
    recording = export()
    used = {o["name"]: [recording.materials[i]["name"] for i in o["materials"]] for o in recording.objects}
    assert used == {"First": ["OfMesh", "(no material)"], "Second": ["OfObject", "(no material)"]}
    slots = recording.meshes[0]["slots"]
    assert (np.bincount(slots) == [10, 2]).all()


def test_text_has_the_material_of_its_object(scene, export):
    build.add_camera()
    b_data = bpy.data.curves.new("Text", "FONT")
    b_data.body = "R"
    b_data.materials.append(build.surface("ShaderNodeBsdfDiffuse", "OfData"))
    build.add_object("First", b_data)
    b_second = build.add_object("Second", b_data)
    b_second.material_slots[0].link = "OBJECT"
    b_second.material_slots[0].material = build.surface("ShaderNodeBsdfDiffuse", "OfObject")
    recording = export()
    used = {o["name"]: [recording.materials[i]["name"] for i in o["materials"]] for o in recording.objects}
    assert used == {"First": ["OfData"], "Second": ["OfObject"]}


def test_text_in_an_instanced_collection(scene, export):
    build.add_camera()
    b_collection = bpy.data.collections.new("Signs")
    b_data = bpy.data.curves.new("Text", "FONT")
    b_data.body = "R"
    b_collection.objects.link(bpy.data.objects.new("Sign", b_data))
    for x in (1, 2):
        b_empty = build.add_object(f"Empty{x}", None, (x, 0, 0))
        b_empty.instance_type, b_empty.instance_collection = "COLLECTION", b_collection
    recording = export()
    assert sorted(m[0, 3] for m in matrices(recording, "Sign")) == [1.0, 2.0]
    assert len(recording.meshes) == 1


def test_no_slot_is_default_grey(scene, export):
    build.add_camera()
    build.add_object("Quad", build.quad())
    recording = export()
    assert recording.objects[0]["materials"] == [0]
    closure = recording.materials[0]["closures"][0]["closure"]
    assert closure == {"kind": "diffuse", "color": [0.8, 0.8, 0.8]}


def test_material_override(scene, export):
    build.add_camera()
    b_mesh = build.quad()
    b_mesh.materials.append(build.surface("ShaderNodeBsdfDiffuse", "Own"))
    build.add_object("Quad", b_mesh)
    scene.view_layers[0].material_override = build.surface("ShaderNodeBsdfDiffuse", "Clay")
    assert [record["name"] for record in export().materials] == ["Clay"]


def test_animated_object_and_setting(scene, export, recorded):
    build.add_camera()
    b_object = build.add_object("Quad", build.quad())
    for frame, x in ((1, 0.0), (11, 10.0)):
        b_object.location.x = x
        b_object.keyframe_insert("location", index=0, frame=frame)
        scene.rgp.gather.rays = 10 + frame
        scene.keyframe_insert("rgp.gather.rays", frame=frame)
    scene.frame_set(11)
    recording = export()
    assert recording.objects[0]["world_from_object"][0, 3] == pytest.approx(10.0)
    assert recorded.settings["gather"]["rays"] == 21


def test_names_may_change_between_renders(scene, export):
    build.add_camera()
    b_object = build.add_object("Before", build.quad())
    assert names(export()) == ["Before"]
    b_object.name = "After"
    build.add_object("Before", build.cube())
    assert names(export()) == ["After", "Before"]


def test_hair_is_reported(scene, export, problems):
    build.add_camera()
    b_object = build.add_object("Head", build.quad())
    b_object.modifiers.new("Fur", "PARTICLE_SYSTEM")
    b_object.particle_systems[0].settings.type = "HAIR"
    b_object.particle_systems[0].name = "Fur"
    export()
    assert 'Head: hair "Fur" is not supported yet; left out' in problems()


def test_hidden_emitter_of_hair_is_left_out(scene, export):
    """Blender goes through it all the same, for the sake of its hair."""
    build.add_camera()
    b_object = build.add_object("Head", build.quad())
    b_object.modifiers.new("Fur", "PARTICLE_SYSTEM")
    b_object.particle_systems[0].settings.type = "HAIR"
    b_object.show_instancer_for_render = False
    assert names(export()) == []


def test_curves_objects_are_reported(scene, export, problems):
    build.add_camera()
    build.add_object("Hair", bpy.data.hair_curves.new("Hair"))
    export()
    assert any(text.startswith("Hair: objects of type") for text in problems())


@pytest.mark.parametrize("of_collection", [False, True])
def test_holdout_is_a_hole_for_the_camera(scene, export, of_collection):
    build.add_camera()
    b_object = build.add_object("Quad", build.quad())
    b_collection = bpy.data.collections.new("Holes")
    scene.collection.children.link(b_collection)
    b_collection.objects.link(b_object)
    scene.collection.objects.unlink(b_object)
    if of_collection:
        bpy.context.view_layer.layer_collection.children["Holes"].holdout = True
    else:
        b_object.is_holdout = True
    build.add_object("Other", build.quad())
    exported = export()
    assert [record["visibility"] for record in exported.objects_of("Quad")] == [ALL | HOLDOUT]
    assert [record["visibility"] for record in exported.objects_of("Other")] == [ALL]


@pytest.mark.parametrize("is_instancer", [False, True])
def test_shadow_catchers_and_instances_by_one(scene, export, is_instancer):
    build.add_camera()
    b_collection = bpy.data.collections.new("Floor")
    b_quad = bpy.data.objects.new("Quad", build.quad())
    b_collection.objects.link(b_quad)
    b_empty = build.add_object("Empty", None)
    b_empty.instance_type, b_empty.instance_collection = "COLLECTION", b_collection
    (b_empty if is_instancer else b_quad).is_shadow_catcher = True
    build.add_object("Other", build.quad())
    exported = export()
    assert [record["visibility"] for record in exported.objects_of("Quad")] == [ALL | CATCHER]
    assert [record["visibility"] for record in exported.objects_of("Other")] == [ALL]

"""Light linking, as the core is told of it."""

import bpy
import pytest

from tests.blender import build

ALL = (1 << 32) - 1


@pytest.fixture
def things(scene):
    """Three quads and a lamp, before a camera."""
    build.add_camera()
    for name in "ABC":
        build.add_object(name, build.quad(name))
    return build.add_light("POINT")


def linked(which, state="INCLUDE", name="Linked"):
    """A collection that includes or excludes some objects."""
    b_collection = bpy.data.collections.new(name)
    for object_name in which:
        b_collection.objects.link(bpy.data.objects[object_name])
    for b_settings in b_collection.collection_objects:
        b_settings.light_linking.link_state = state
    return b_collection


def lit(exported, links):
    """Names of the objects that an emitter lights."""
    return "".join(
        record["name"]
        for record in exported.objects
        if 1 << record["links"]["receiver_set"] & links["receivers"]
    )


def blocking(exported, links):
    """Names of the objects that block an emitter."""
    sets = ALL if links["blockers"] is None else links["blockers"]
    return "".join(
        record["name"] for record in exported.objects if 1 << record["links"]["blocker_set"] & sets
    )


def test_without_links_nothing_is_said(things, export):
    exported = export()
    assert "links" not in exported.lamps[0]
    assert all("links" not in record for record in exported.objects)


@pytest.mark.parametrize(
    ("which", "state", "expected"),
    [("AB", "INCLUDE", "AB"), ("AB", "EXCLUDE", "C"), ("", "INCLUDE", "ABC")],
)
def test_a_lamp_lights_what_its_collection_means(things, export, problems, which, state, expected):
    things.light_linking.receiver_collection = linked(which, state)
    exported = export()
    links = exported.lamps[0]["links"]
    assert lit(exported, links) == expected
    assert links["blockers"] is None
    assert problems() == []


@pytest.mark.parametrize(("state", "expected"), [("INCLUDE", "AB"), ("EXCLUDE", "C")])
def test_a_lamp_is_blocked_by_what_its_collection_means(things, export, state, expected):
    things.light_linking.blocker_collection = linked("AB", state)
    exported = export()
    links = exported.lamps[0]["links"]
    assert blocking(exported, links) == expected
    assert links["receivers"] == ALL


def test_a_collection_of_collections(things, export):
    inner, outer = linked("A", name="Inner"), linked("BC", name="Outer")
    outer.children.link(inner)
    outer.collection_children[0].light_linking.link_state = "INCLUDE"
    outer.collection_objects[1].light_linking.link_state = "EXCLUDE"
    things.light_linking.receiver_collection = outer
    exported = export()
    assert lit(exported, exported.lamps[0]["links"]) == "AB"


def test_emissive_objects_and_several_lights(things, export):
    bpy.data.objects["C"].light_linking.receiver_collection = linked("A", name="First")
    things.light_linking.receiver_collection = linked("AB", name="Second")
    exported = export()
    assert lit(exported, exported.lamps[0]["links"]) == "AB"
    emitter = exported.objects_of("C")[0]["links"]["light"]
    assert lit(exported, emitter) == "A"
    assert exported.objects_of("A")[0]["links"]["light"] == {"receivers": ALL, "blockers": None}


def test_instances_are_what_their_instancer_is(things, export):
    b_collection = bpy.data.collections.new("Copies")
    b_collection.objects.link(bpy.data.objects.new("Copied", build.quad("Copied")))
    b_empty = build.add_object("Empty", None)
    b_empty.instance_type, b_empty.instance_collection = "COLLECTION", b_collection
    things.light_linking.receiver_collection = linked(["Empty"])
    exported = export()
    assert lit(exported, exported.lamps[0]["links"]) == "Copied"


def test_more_sets_than_can_be_told_apart_are_reported(things, export, problems):
    for number in range(40):
        b_lamp = build.add_light("POINT", f"Lamp{number}")
        build.add_object(f"Quad{number}", build.quad())
        b_lamp.light_linking.receiver_collection = linked([f"Quad{number}"], name=f"Linked{number}")
    exported = export()
    assert max(record["links"]["receiver_set"] for record in exported.objects) == 31
    assert [text for text in problems() if "more than 32 sets" in text]

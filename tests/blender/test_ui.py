"""Panels are drawn without error for every kind of thing. A layout that records stands in for the window."""

from types import SimpleNamespace

import bpy
import pytest

from rgp_engine import report, ui
from rgp_engine.accuracy import background
from rgp_engine.report import Outcome, Problem
from rgp_engine.ui import accuracy, camera, effects, light, material, problems, render, scene_parts
from tests.blender import build

MODULES = (accuracy, camera, effects, light, material, problems, render, scene_parts)


class Layout:
    """Takes every call of a Blender layout, and checks that properties exist."""

    def __init__(self):
        self.texts = []
        self.names = set()

    def prop(self, b_data, name, text=None, **_):
        assert name in b_data.bl_rna.properties, f"{b_data} has no {name}"
        self.names.add(name)
        self.texts.append(text if text is not None else b_data.bl_rna.properties[name].name)

    def separator(self):
        pass

    def label(self, text="", **_):
        self.texts.append(text)

    def progress(self, text="", factor=0.0, **_):
        assert 0.0 <= factor <= 1.0
        self.texts.append(text)

    def operator(self, name, **_):
        group, _, function = name.partition(".")
        assert hasattr(getattr(bpy.ops, group), function)
        return SimpleNamespace()

    def menu(self, name, **_):
        assert hasattr(bpy.types, name)

    def template_curve_mapping(self, b_data, name):
        assert name in b_data.bl_rna.properties

    def template_list(self, name, *_, **__):
        assert hasattr(bpy.types, name)

    def template_ID(self, b_data, name, **_):  # noqa: N802 (Blender's)
        assert b_data is None or name in b_data.bl_rna.properties

    def template_node_view(self, _b_tree, b_node, b_socket):
        assert b_socket.node == b_node
        self.texts.append(f"nodes of {b_socket.name}")

    def _part(self, *_, **__):
        return self

    row = column = split = box = _part


def draw(cls, **context):
    """Texts a panel shows in a context; None where it is not shown."""
    # Blender's panels cannot be made by hand, so the functions are called on a plain object.
    shown = SimpleNamespace(engine="RGP", **context)
    panel = SimpleNamespace(layout=Layout())
    poll = getattr(cls, "poll", None)
    if poll is not None and not poll(shown):
        return None
    if hasattr(cls, "draw_header"):
        cls.draw_header(panel, shown)
    cls.draw(panel, shown)
    return panel.layout.texts


def test_every_setting_has_a_button(scene):
    shown = [text for cls in render.CLASSES for text in draw(cls, scene=scene)]
    for group in ("photon_pass", "pyramid", "gather", "film", "render"):
        for b_property in getattr(scene.rgp, group).bl_rna.properties:
            if b_property.identifier not in ("rna_type", "name", "bins"):
                assert (b_property.name in shown) != b_property.is_hidden
    assert {"Bins Elevation", "Azimuth", "Transparent"} <= set(shown)


@pytest.mark.parametrize("kind", ["POINT", "SPOT", "SUN", "AREA"])
def test_light_panels(scene, kind):
    b_light = build.add_light(kind).data
    shown = draw(light.RGP_PT_light, light=b_light)
    assert "Power" in shown or "Strength" in shown
    assert (draw(light.RGP_PT_light_beam, light=b_light) is not None) == (kind in ("SPOT", "AREA"))
    build.connect(
        build.shader_tree(b_light),
        b_light.node_tree.nodes.new("ShaderNodeEmission"),
        b_light.node_tree.nodes.new("ShaderNodeOutputLight"),
        "Surface",
    )
    assert "nodes of Surface" in draw(light.RGP_PT_light_nodes, light=b_light)
    assert draw(light.RGP_PT_light, light=None) is None


def test_area_light_of_two_sizes(scene):
    b_light = build.add_light("AREA", shape="RECTANGLE").data
    assert {"Size X", "Y"} <= set(draw(light.RGP_PT_light, light=b_light))


def test_material_panels(scene):
    b_object = build.add_object("Quad", build.quad())
    b_material = build.surface("ShaderNodeBsdfDiffuse")
    b_object.data.materials.append(b_material)
    b_object.data.materials.append(None)
    context = {"object": b_object, "active_object": b_object, "material": b_material}
    assert (
        draw(material.RGP_PT_context_material, material_slot=b_object.material_slots[0], **context)
        is not None
    )
    assert "nodes of Surface" in draw(material.RGP_PT_material_surface, **context)
    b_material.node_tree.nodes.clear()
    assert "No output node" in draw(material.RGP_PT_material_surface, **context)


def test_world_object_and_view_layer_panels(scene):
    b_world = bpy.data.worlds.new("World")
    b_tree = build.shader_tree(b_world)
    b_tree.nodes.new("ShaderNodeOutputWorld")
    assert "nodes of Surface" in draw(scene_parts.RGP_PT_world_surface, world=b_world)
    b_object = build.add_object("Quad", build.quad())
    assert "Shadow" in draw(scene_parts.RGP_PT_object_visibility, object=b_object)
    assert draw(scene_parts.RGP_PT_object_visibility, object=None) is None
    assert draw(scene_parts.RGP_PT_view_layer_passes, view_layer=scene.view_layers[0]) == [
        "Indirect",
        "Shadow Catcher",
        "Error",
        "Audit",
    ]
    assert draw(scene_parts.RGP_PT_view_layer_override, view_layer=scene.view_layers[0]) == [
        "Material Override"
    ]


def test_problems_and_statistics(scene, monkeypatch):
    monkeypatch.setattr(report, "_last", None)
    assert draw(problems.RGP_PT_problems) == ["Nothing rendered yet"]
    assert draw(problems.RGP_PT_statistics) == ["No statistics yet"]
    report.publish(Outcome())
    assert draw(problems.RGP_PT_problems) == ["None in the last render"]
    many = [Problem(f"Cube{n}", "is bent", 1) for n in range(60)]
    report.publish(Outcome([Problem("Lamp", "is odd", 3), *many], {"seconds": {"total": 2.0}}))
    shown = draw(problems.RGP_PT_problems)
    assert "Lamp: is odd (3 times)" in shown
    assert shown[-1] == "and 11 more"
    assert draw(problems.RGP_PT_statistics) == ["Total time", "2.00 s"]
    report.publish(Outcome(error="There is no camera."))
    assert "There is no camera." in draw(problems.RGP_PT_problems)


def planned(name, because, **changes):
    """An effect as the core reports it; on by itself if something asks for it."""
    asked = because is not None
    cost = {"pass": "gather", "seconds": 0.0, "bytes": 0, "rays": 0}
    why = because or "nothing in the scene asks for it"
    return {
        "name": name, "switch": "auto", "called_for": asked, "computed": asked, "because": why, **cost, **changes
    }  # fmt: skip


def test_effects_of_the_last_render(scene, monkeypatch):
    monkeypatch.setattr(report, "_last", None)
    assert draw(effects.RGP_PT_effect_costs) is None
    report.publish(Outcome(error="There is no camera."))
    assert draw(effects.RGP_PT_effect_costs) is None
    direct = planned("direct_light", "lamp 'Sun'", seconds=1.5)
    glossy = planned("indirect_glossy", "glossy surface on 'Table'", seconds=0.5, bytes=3 << 19)
    caustics = planned("caustics", None)
    report.publish(Outcome(stats={"seconds": {}, "effects": [caustics, direct, glossy]}))
    assert draw(effects.RGP_PT_effect_costs) == [
        "Direct light", "1.50 s", "Indirect glossy", "0.50 s", "", "1.5 MiB",
    ]  # fmt: skip


def test_every_effect_has_a_switch_and_the_last_render_says_why(scene, monkeypatch):
    monkeypatch.setattr(report, "_last", None)
    switches = draw(effects.RGP_PT_effects, scene=scene)
    assert switches[:4] == ["Direct Light", "Indirect Diffuse", "Indirect Glossy", "Caustics"]
    assert len(switches) == 12
    glass = "glass on 'Bottle'"
    chosen = planned("mirrors_and_glass", glass, switch="off", computed=False)
    report.publish(Outcome(stats={"seconds": {}, "effects": [planned("caustics", glass), chosen]}))
    shown = draw(effects.RGP_PT_effects, scene=scene)
    assert shown[3:7] == ["Caustics", f"on, {glass}", "Mirrors and Glass", f"off by choice, {glass}"]


def test_error_of_the_last_render(scene, monkeypatch):
    monkeypatch.setattr(background, "_last", None)
    shown = {"scene": scene, "window_manager": bpy.context.window_manager}
    report.publish(Outcome(stats={"seconds": {"total": 12.34}, "error": None}))
    assert draw(accuracy.RGP_PT_accuracy, **shown) == []
    report.publish(
        Outcome(
            stats={
                "seconds": {"total": 12.34},
                "error": {"rms_clipped": 0.8123, "rms_mean": 3.0, "rms_peak": 0.1},
            }
        )
    )
    assert draw(accuracy.RGP_PT_accuracy, **shown) == ["Last render: 0.81 % in 12.3 s"]


def test_panels_are_hidden_for_other_engines(scene):
    things = dict.fromkeys(("active_object", "object", "camera", "light", "material", "world"), None)
    for cls in (cls for module in MODULES for cls in module.CLASSES if issubclass(cls, bpy.types.Panel)):
        assert not cls.poll(SimpleNamespace(engine="CYCLES", **things))


def test_every_panel_is_registered():
    classes = [cls for module in MODULES for cls in module.CLASSES]
    assert all(cls.is_registered for cls in classes)
    assert ui.register is not None


def test_every_panorama_has_its_settings(scene):
    """Those of Blender's own panel, which it draws for Cycles alone."""
    b_camera = build.add_camera().data
    assert draw(camera.RGP_PT_panorama, camera=b_camera) is None
    assert draw(camera.RGP_PT_panorama, camera=None) is None
    b_camera.type = "PANO"
    for b_item in b_camera.bl_rna.properties["panorama_type"].enum_items:
        b_camera.panorama_type = b_item.identifier
        names = []
        for b_panel, engine in ((camera.RGP_PT_panorama, "RGP"), (bpy.types.DATA_PT_lens, "CYCLES")):
            layout = Layout()
            context = SimpleNamespace(engine=engine, camera=b_camera)
            b_panel.draw(SimpleNamespace(layout=layout), context)
            names.append(layout.names - {"type", "shift_x", "shift_y", "clip_start", "clip_end"})
        assert names[0] == names[1]

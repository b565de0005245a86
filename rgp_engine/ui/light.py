"""Light properties. Blender's own light panels belong to the engines that come with it."""

from typing import Any

from bpy.types import Panel

from .base import ClosedEnginePanel, EnginePanel, draw_node_input, draw_settings, draw_use_nodes


class _LightPanel(EnginePanel):
    bl_context = "data"

    @classmethod
    def poll(cls, context: Any) -> bool:
        """True for a light."""
        return bool(context.light) and super().poll(context)


class RGP_PT_light(_LightPanel, Panel):
    """Power, color and shape."""

    bl_label = "Light"

    def draw(self, context: Any) -> None:
        """Draws the panel."""
        layout, b_light = self.layout, context.light
        layout.row().prop(b_light, "type", expand=True)
        layout.use_property_split = True
        layout.use_property_decorate = False
        _draw_color(layout.column(), b_light)
        _draw_power(layout.column(), b_light)
        _draw_shape(layout.column(), b_light)
        layout.prop(b_light, "use_shadow", text="Shadow")


# Temperature, exposure and normalization came with Blender 4.5.


def _draw_color(column: Any, b_light: Any) -> None:
    has_temperature = hasattr(b_light, "use_temperature")
    if has_temperature:
        column.prop(b_light, "use_temperature", text="Use Temperature")
    if has_temperature and b_light.use_temperature:
        column.prop(b_light, "temperature")
        column.prop(b_light, "color", text="Tint")
    else:
        column.prop(b_light, "color")


def _draw_power(column: Any, b_light: Any) -> None:
    column.prop(b_light, "energy", text="Strength" if b_light.type == "SUN" else "Power")
    for name in ("exposure", "normalize"):
        if hasattr(b_light, name):
            column.prop(b_light, name)


def _draw_shape(column: Any, b_light: Any) -> None:
    if b_light.type == "SUN":
        column.prop(b_light, "angle")
    elif b_light.type == "AREA":
        column.prop(b_light, "shape")
        if b_light.shape in ("RECTANGLE", "ELLIPSE"):
            column.prop(b_light, "size", text="Size X")
            column.prop(b_light, "size_y", text="Y")
        else:
            column.prop(b_light, "size")
    else:
        column.prop(b_light, "use_soft_falloff")
        column.prop(b_light, "shadow_soft_size", text="Radius")


class RGP_PT_light_beam(_LightPanel, Panel):
    """How wide a spot or area light shines."""

    bl_label = "Beam Shape"
    bl_parent_id = "RGP_PT_light"

    @classmethod
    def poll(cls, context: Any) -> bool:
        """True for lights with a beam."""
        return super().poll(context) and context.light.type in ("SPOT", "AREA")

    def draw(self, context: Any) -> None:
        """Draws the panel."""
        is_spot = context.light.type == "SPOT"
        names = ("spot_size", "spot_blend", "show_cone") if is_spot else ("spread",)
        draw_settings(self.layout, context.light, *names)


class RGP_PT_light_nodes(_LightPanel, ClosedEnginePanel, Panel):
    """Nodes."""

    bl_label = "Nodes"
    bl_parent_id = "RGP_PT_light"

    def draw(self, context: Any) -> None:
        """Draws the panel."""
        if draw_use_nodes(self.layout, context.light):
            draw_node_input(self.layout, context.light, "Surface")


CLASSES = (RGP_PT_light, RGP_PT_light_beam, RGP_PT_light_nodes)

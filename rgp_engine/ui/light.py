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
        b_light = context.light
        self.layout.row().prop(b_light, "type", expand=True)
        # Blender 4.5 brought the second half of these.
        names = ["color", "use_temperature", "temperature", "energy", "exposure", "normalize"]
        names += {
            "POINT": ["use_soft_falloff", "shadow_soft_size"],
            "SPOT": ["use_soft_falloff", "shadow_soft_size"],
            "SUN": ["angle"],
            "AREA": ["shape", "size"],
        }[b_light.type]
        if b_light.type == "AREA" and b_light.shape in ("RECTANGLE", "ELLIPSE"):
            names += ["size_y"]
        names += ["use_shadow"]
        draw_settings(self.layout, b_light, *(name for name in names if hasattr(b_light, name)))


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

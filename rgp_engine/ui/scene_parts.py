"""World, object and view layer properties."""

from typing import Any

from bpy.types import Panel

from .base import ClosedEnginePanel, EnginePanel, draw_node_input, draw_settings, draw_use_nodes


class RGP_PT_world_surface(EnginePanel, Panel):
    """Light from outside."""

    bl_label = "Surface"
    bl_context = "world"

    @classmethod
    def poll(cls, context: Any) -> bool:
        """True for a world."""
        return bool(context.world) and super().poll(context)

    def draw(self, context: Any) -> None:
        """Draws the panel."""
        if draw_use_nodes(self.layout, context.world):
            draw_node_input(self.layout, context.world, "Surface")
        else:
            self.layout.prop(context.world, "color")


class RGP_PT_object_visibility(ClosedEnginePanel, Panel):
    """What sees the object."""

    bl_label = "Visibility"
    bl_context = "object"

    @classmethod
    def poll(cls, context: Any) -> bool:
        """True for an object that can be seen."""
        kinds = ("MESH", "CURVE", "SURFACE", "FONT", "META", "LIGHT", "EMPTY")
        return bool(context.object) and context.object.type in kinds and super().poll(context)

    def draw(self, context: Any) -> None:
        """Draws the panel."""
        b_object = context.object
        draw_settings(self.layout, b_object, "hide_select", "hide_viewport", "hide_render")
        column = self.layout.column(heading="Rays")
        column.prop(b_object, "visible_camera", text="Camera")
        column.prop(b_object, "visible_diffuse", text="Diffuse")
        column.prop(b_object, "visible_glossy", text="Glossy")
        column.prop(b_object, "visible_transmission", text="Transmission")
        if b_object.type != "LIGHT":
            column.prop(b_object, "visible_shadow", text="Shadow")
            self.layout.prop(b_object, "is_holdout")
        self.layout.prop(b_object, "is_shadow_catcher")


class RGP_PT_view_layer_passes(EnginePanel, Panel):
    """Passes."""

    bl_label = "Passes"
    bl_context = "view_layer"

    def draw(self, context: Any) -> None:
        """Draws the panel."""
        names = ("use_pass_indirect", "use_pass_shadow_catcher", "use_pass_error", "use_pass_audit")
        draw_settings(self.layout, context.view_layer.rgp, *names)


class RGP_PT_view_layer_checkpoint(ClosedEnginePanel, Panel):
    """A picture that is not finished."""

    bl_label = "Checkpoint"
    bl_context = "view_layer"

    def draw(self, context: Any) -> None:
        """Draws the panel."""
        draw_settings(self.layout, context.view_layer.rgp, "checkpoint")


class RGP_PT_view_layer_override(ClosedEnginePanel, Panel):
    """Override."""

    bl_label = "Override"
    bl_context = "view_layer"

    def draw(self, context: Any) -> None:
        """Draws the panel."""
        draw_settings(self.layout, context.view_layer, "material_override")


CLASSES = (
    RGP_PT_world_surface,
    RGP_PT_object_visibility,
    RGP_PT_view_layer_passes,
    RGP_PT_view_layer_checkpoint,
    RGP_PT_view_layer_override,
)

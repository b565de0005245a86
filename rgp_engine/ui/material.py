"""Material properties: slots and surface."""

from typing import Any, ClassVar

from bpy.types import Panel

from .base import EnginePanel, draw_node_input, draw_use_nodes


class RGP_PT_context_material(EnginePanel, Panel):
    """Material slots of the active object."""

    bl_label = ""
    bl_context = "material"
    bl_options: ClassVar = {"HIDE_HEADER"}

    @classmethod
    def poll(cls, context: Any) -> bool:
        """True when there is a material or an object that can have one."""
        if context.active_object and context.active_object.type == "GREASEPENCIL":
            return False
        return bool(context.object or context.material) and super().poll(context)

    def draw(self, context: Any) -> None:
        """Draws the panel."""
        layout, b_object = self.layout, context.object
        if b_object is None:
            layout.template_ID(context.space_data, "pin_id")
            return
        row = layout.row()
        row.template_list(
            "MATERIAL_UL_matslots", "", b_object, "material_slots", b_object, "active_material_index"
        )
        column = row.column(align=True)
        column.operator("object.material_slot_add", icon="ADD", text="")
        column.operator("object.material_slot_remove", icon="REMOVE", text="")
        column.menu("MATERIAL_MT_context_menu", icon="DOWNARROW_HLT", text="")
        if len(b_object.material_slots) > 1:
            column.operator("object.material_slot_move", icon="TRIA_UP", text="").direction = "UP"
            column.operator("object.material_slot_move", icon="TRIA_DOWN", text="").direction = "DOWN"
        layout.template_ID(b_object, "active_material", new="material.new")
        if context.material_slot:
            layout.row().prop(context.material_slot, "link", text="")
        if b_object.mode == "EDIT":
            row = layout.row(align=True)
            row.operator("object.material_slot_assign", text="Assign")
            row.operator("object.material_slot_select", text="Select")
            row.operator("object.material_slot_deselect", text="Deselect")


class RGP_PT_material_surface(EnginePanel, Panel):
    """Surface shader."""

    bl_label = "Surface"
    bl_context = "material"

    @classmethod
    def poll(cls, context: Any) -> bool:
        """True for a material."""
        return bool(context.material) and super().poll(context)

    def draw(self, context: Any) -> None:
        """Draws the panel."""
        b_material = context.material
        if draw_use_nodes(self.layout, b_material):
            draw_node_input(self.layout, b_material, "Surface")
        else:
            self.layout.prop(b_material, "diffuse_color", text="Color")


CLASSES = (RGP_PT_context_material, RGP_PT_material_surface)

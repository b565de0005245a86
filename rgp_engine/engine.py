"""The render engine as Blender sees it. Its callbacks only pass on."""

from typing import Any

import bpy

from .properties import ENGINE_ID
from .session import RenderSession


class RGPRenderEngine(bpy.types.RenderEngine):
    """Final gathering over a Radiance Grid Pyramid."""

    bl_idname = ENGINE_ID
    bl_label = "RGP Engine"
    bl_use_preview = False
    bl_use_eevee_viewport = True
    bl_use_shading_nodes_custom = False

    def update(self, data: Any = None, depsgraph: Any = None) -> None:
        """Exports the scene, while Blender keeps it locked."""
        self.session = RenderSession(self, depsgraph)
        self.session.export()

    def render(self, depsgraph: Any) -> None:
        """Renders what `update` exported, while the user works on."""
        self.session.render()

    def update_render_passes(self, scene: Any = None, renderlayer: Any = None) -> None:
        """Names the passes, for the compositor and the Image Editor."""
        self.register_pass(scene, renderlayer, "Combined", 4, "RGBA", "COLOR")
        if renderlayer.rgp.use_pass_indirect:
            self.register_pass(scene, renderlayer, "Indirect", 3, "RGB", "COLOR")
        if renderlayer.rgp.use_pass_shadow_catcher:
            self.register_pass(scene, renderlayer, "Shadow Catcher", 3, "RGB", "COLOR")
        if renderlayer.rgp.use_pass_error:
            self.register_pass(scene, renderlayer, "Error", 1, "X", "VALUE")
        if renderlayer.rgp.use_pass_audit:
            self.register_pass(scene, renderlayer, "Audit", 1, "X", "VALUE")


register, unregister = bpy.utils.register_classes_factory((RGPRenderEngine,))

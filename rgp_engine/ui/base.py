"""What all panels of the engine share."""

from typing import Any, ClassVar

from bpy_extras.node_utils import find_node_input

from ..properties import ENGINE_ID


class EnginePanel:
    """A panel of the Properties editor that is shown for this engine only."""

    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    COMPAT_ENGINES = frozenset((ENGINE_ID,))

    @classmethod
    def poll(cls, context: Any) -> bool:
        """True when the scene is rendered by this engine."""
        return bool(context.engine in cls.COMPAT_ENGINES)


class ClosedEnginePanel(EnginePanel):
    """One that is closed until the user opens it."""

    bl_options: ClassVar = {"DEFAULT_CLOSED"}


def draw_settings(layout: Any, b_group: Any, *names: str) -> None:
    """One line for each setting of a group, in Blender's two-column style."""
    layout.use_property_split = True
    layout.use_property_decorate = False
    column = layout.column()
    for name in names:
        column.prop(b_group, name)


def draw_node_input(layout: Any, b_id: Any, socket: str) -> None:
    """The nodes that feed a socket of the output node, as a tree of buttons."""
    b_tree = b_id.node_tree
    b_output = b_tree.get_output_node("ALL") if b_tree else None
    b_input = find_node_input(b_output, socket) if b_output else None
    if b_input:
        layout.template_node_view(b_tree, b_output, b_input)
    elif b_tree:
        layout.label(text="No output node")


def draw_use_nodes(layout: Any, b_id: Any) -> bool:
    """The switch for nodes where this Blender has one. True when the nodes count."""
    b_use_nodes = b_id.bl_rna.properties.get("use_nodes")
    if b_use_nodes is None or getattr(b_use_nodes, "is_deprecated", False):
        return True
    layout.prop(b_id, "use_nodes", icon="NODETREE")
    return bool(b_id.use_nodes)

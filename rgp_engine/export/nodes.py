"""Finding one's way in a node tree: through reroutes, muted nodes and nested groups."""

from typing import Any, NamedTuple


class Input(NamedTuple):
    """An input socket, and the group nodes it lies within, outermost first."""

    b_socket: Any
    groups: tuple[Any, ...]


class Output(NamedTuple):
    """An output socket of a node that computes something, and the group nodes it lies within."""

    b_node: Any
    b_socket: Any
    groups: tuple[Any, ...]

    def input(self, identifier: str) -> Input:
        """The node's input with that identifier; labels and names change between versions of Blender."""
        entry = self.find(identifier)
        if entry is None:
            raise KeyError(f"{self.b_node.bl_idname} has no input {identifier!r}")
        return entry

    @property
    def key(self) -> tuple[Any, ...]:
        """The same for the same output of the same node within the same groups."""
        groups = tuple(b_group.as_pointer() for b_group in self.groups)
        return (self.b_node.as_pointer(), self.b_socket.identifier, groups)

    def find(self, identifier: str) -> Input | None:
        """As `input`, None where this version of Blender has no such input."""
        for b_socket in self.b_node.inputs:
            if b_socket.identifier == identifier:
                return Input(b_socket, self.groups)
        return None


def node_tree(b_id: Any) -> Any | None:
    """Node tree of a material, lamp or world; None where it has none or does not use it."""
    b_use_nodes = b_id.bl_rna.properties.get("use_nodes")
    # From Blender 5.0 on more and more of them always use nodes; reading the old switch warns.
    if b_use_nodes is None or getattr(b_use_nodes, "is_deprecated", False) or b_id.use_nodes:
        return b_id.node_tree
    return None


def output_node(b_tree: Any, kind: str) -> Any | None:
    """The tree's active output node of a kind (OUTPUT_MATERIAL): one for all engines, else Cycles', else EEVEE's."""
    for target in ("ALL", "CYCLES", "EEVEE"):
        b_node = b_tree.get_output_node(target)
        # Trees that scripts made may hold outputs of other kinds.
        if b_node is not None and b_node.type == kind:
            return b_node
    return None


def origin(entry: Input) -> Input | Output:
    """What an input gets its value from: a node's output, or the input whose own value counts."""
    b_link = _link(entry.b_socket)
    if b_link is None:
        return entry
    b_node = b_link.from_node
    before = _behind(b_node, b_link.from_socket, entry.groups)
    if before is None:
        return Output(b_node, b_link.from_socket, entry.groups)
    found = origin(before)
    # A reroute that nothing feeds has no value of its own.
    if found == before and b_node.type == "REROUTE":
        return entry
    return found


def _link(b_socket: Any) -> Any | None:
    if not b_socket.is_linked:
        return None
    for b_link in b_socket.links:
        if b_link.is_valid and not b_link.is_muted:
            return b_link
    return None


def _behind(b_node: Any, b_output: Any, groups: tuple[Any, ...]) -> Input | None:
    """The input that a node only passes on to one of its outputs; None when it computes something."""
    if b_node.type == "REROUTE":
        return Input(b_node.inputs[0], groups)
    if b_node.mute:
        for b_link in b_node.internal_links:
            if b_link.to_socket == b_output:
                return Input(b_link.from_socket, groups)
        return None
    if b_node.type == "GROUP" and b_node.node_tree is not None:
        for b_inner in b_node.node_tree.nodes:
            if b_inner.type == "GROUP_OUTPUT" and b_inner.is_active_output:
                return _with_identifier(b_inner.inputs, b_output, (*groups, b_node))
    if b_node.type == "GROUP_INPUT" and groups:
        return _with_identifier(groups[-1].inputs, b_output, groups[:-1])
    return None


def _with_identifier(b_sockets: Any, b_like: Any, groups: tuple[Any, ...]) -> Input | None:
    for b_socket in b_sockets:
        if b_socket.identifier == b_like.identifier:
            return Input(b_socket, groups)
    return None

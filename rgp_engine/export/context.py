"""What every part of the export works with."""

import time
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from ..report import ProblemLog
from .geometry_instances import GeometryInstances
from .linking import Linking

if TYPE_CHECKING:
    import rgp_core

_TICK_SECONDS = 0.1


class Cancelled(Exception):
    """The user pressed Esc during the export."""


@dataclass
class ExportContext:
    """The scene being built, what is in it already, and where problems go."""

    engine: Any
    b_depsgraph: Any
    builder: "rgp_core.SceneBuilder"
    log: ProblemLog
    meshes: dict[tuple[int, frozenset[str]], int | None] = field(default_factory=dict)
    """Index in the builder of each evaluated mesh, by its address and the layers that are read; None for those
    without triangles."""
    materials: dict[int | None, int] = field(default_factory=dict)
    """Index in the builder of each evaluated material, by its address; None is no material."""
    textures: dict[str, int | None] = field(default_factory=dict)
    """Index in the builder of each image, by its full name; None for those that cannot be read."""
    layers_read: dict[int, frozenset[str]] = field(default_factory=dict)
    """Layers of the mesh that each material reads, by its index in the builder."""
    asking_objects: dict[int, frozenset[str]] = field(default_factory=dict)
    """Values of objects that materials ask for, by index in the builder, for those that ask about their object."""
    attributes: dict[str, int] = field(default_factory=dict)
    """The core's number of each layer's name."""
    emits: bool = False
    """True once anything in the scene can give light."""
    linking: Linking = field(init=False)
    """Which lights light what."""
    geometry_instances: GeometryInstances = field(default_factory=GeometryInstances)
    """What geometry nodes say of the instances they make."""
    _next_tick: float = 0.0

    def __post_init__(self) -> None:
        self.linking = Linking(self.b_depsgraph, self.log)

    def attribute_number(self, name: str) -> int:
        """The core's number of a layer: "uv", "uv:NAME", "color", "attribute:NAME", "generated" or "island"; or of an
        object's value: "object:NAME" or "instancer:NAME"."""
        return self.attributes.setdefault(name, len(self.attributes))

    def tick(self, doing: str) -> None:
        """To be called in every long loop: shows what is exported, raises Cancelled after Esc."""
        now = time.monotonic()
        if now < self._next_tick:
            return
        self._next_tick = now + _TICK_SECONDS
        if self.engine.test_break():
            raise Cancelled
        self.engine.update_stats("", f"Exporting {doing}")

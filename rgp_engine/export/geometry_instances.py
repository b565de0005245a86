"""Attributes of the instances that geometry nodes make, which Blender hands out from version 4.5 on.

An instance of the depsgraph bears the ids of the instances it lies within (`persistent_id`), innermost first. Following
them from the outermost leads to its place in the geometry of each level.
"""

from collections.abc import Iterator
from functools import cached_property
from typing import Any

import bpy
import numpy as np
import numpy.typing as npt

from .layers import ATTRIBUTE_TYPES
from .named_values import Rgba

_NO_ID = (1 << 31) - 1
# What a geometry shows by itself, and the types of objects that show it themselves.
_PARTS = {
    "mesh": ("MESH",),
    "volume": ("VOLUME",),
    "curves": ("CURVES", "CURVE", "FONT"),
    "pointcloud": ("POINTCLOUD",),
    "grease_pencil": ("GREASEPENCIL",),
}


class GeometryInstances:
    """What instancers know of their instances, read when it is first asked for."""

    def __init__(self) -> None:
        self._levels: dict[int, _Level] = {}
        """By the instancer's address."""

    @staticmethod
    def are_known(b_instancer: Any) -> bool:
        """False where geometry nodes make instances of which this Blender does not tell more."""
        makes = any(b_modifier.type == "NODES" for b_modifier in b_instancer.modifiers)
        return not makes or hasattr(b_instancer, "evaluated_geometry")

    def value(self, b_instance: Any, name: str) -> Rgba | None:
        """An attribute of an instance, or of one it lies within, as a color; None where none of them has it."""
        values = [level.value(place, name) for level, place in self._way(b_instance)]
        return next((value for value in reversed(values) if value is not None), None)

    def _way(self, b_instance: Any) -> "Iterator[tuple[_Level, int]]":
        """The levels of instances it lies within, outermost first, and its place in each."""
        b_instancer = b_instance.parent
        level = self._levels.setdefault(b_instancer.as_pointer(), _Level.of_object(b_instancer))
        skips = level.part_count > 0
        for identifier in (i for i in reversed(b_instance.persistent_id) if i != _NO_ID):
            if skips:
                if identifier < level.part_count:
                    return
                skips = False
                continue
            place = level.places.get(identifier)
            if place is None:
                return
            yield level, place
            level = level.behind(place)
            skips = level.part_count > 0


class _Level:
    """The instances directly within one geometry."""

    def __init__(self, b_geometry: Any, own_type: str = "") -> None:
        """`own_type`: of the object that shows this part of the geometry itself."""
        names = [name for name, types in _PARTS.items() if own_type not in types]
        self.part_count = sum(getattr(b_geometry, name, None) is not None for name in names)
        """Parts that are shown besides the instances, and counted before them."""
        self._b_geometry = b_geometry
        self._b_points: Any = None if b_geometry is None else b_geometry.instances_pointcloud()
        self._values: dict[str, npt.NDArray[Any] | None] = {}
        self._behind: dict[int, _Level] = {}

    @classmethod
    def of_object(cls, b_object: Any) -> "_Level":
        """What an object instances; nothing where Blender does not tell."""
        try:
            return cls(b_object.evaluated_geometry(), b_object.type)
        except (AttributeError, TypeError):
            return cls(
                None
            )  # before Blender 4.5; objects without geometry, such as those that show a collection

    @cached_property
    def places(self) -> dict[int, int]:
        """Place of each instance by its id."""
        if self._b_points is None:
            return {}
        ids = self._column("id", np.int32)
        if ids is None:
            return {place: place for place in range(len(self._references))}
        return {int(identifier): place for place, identifier in reversed(list(enumerate(ids[:, 0])))}

    @cached_property
    def _references(self) -> list[int]:
        """What is instanced, for each instance."""
        references = self._column(".reference_index", np.int32)
        return [] if references is None else [int(index) for index in references[:, 0]]

    def behind(self, place: int) -> "_Level":
        """The instances within an instance."""
        index = self._references[place]
        if index not in self._behind:
            b_reference = self._b_geometry.instance_references()[index]
            is_object = isinstance(b_reference, bpy.types.Object)
            is_geometry = hasattr(b_reference, "instances_pointcloud")
            self._behind[index] = (
                _Level.of_object(b_reference) if is_object else _Level(b_reference if is_geometry else None)
            )
        return self._behind[index]

    def value(self, place: int, name: str) -> Rgba | None:
        """An attribute of the instance at a place."""
        if name not in self._values:
            self._values[name] = self._column(name)
        column = self._values[name]
        if column is None:
            return None
        row = [float(x) for x in column[place]]
        if len(row) == 1:
            return (row[0], row[0], row[0], 1.0)
        red, green, blue, alpha = row + [0.0, 0.0, 0.0, 1.0][len(row) :]
        return red, green, blue, alpha

    def _column(self, name: str, kind: type[Any] = np.float32) -> npt.NDArray[Any] | None:
        b_attribute = self._b_points.attributes.get(name)
        if b_attribute is None or b_attribute.data_type not in ATTRIBUTE_TYPES:
            return None
        prop, channels = ATTRIBUTE_TYPES[b_attribute.data_type]
        values = np.empty((len(b_attribute.data), channels), kind)
        b_attribute.data.foreach_get(prop, values.reshape(-1))
        return values

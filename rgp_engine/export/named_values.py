"""Values that objects and view layers have by name, as Attribute nodes of these types read them in Cycles: a custom
property of that name, else what it leads to as an RNA path, such as "location" or "data.texspace_size"."""

from typing import Any

import bpy

Rgba = tuple[float, float, float, float]

_OPAQUE = (0.0, 0.0, 0.0, 1.0)


def property_value(b_owner: Any, name: str) -> Rgba | None:
    """The value of a property as a color; None where there is none that is one number, or two to four."""
    if name in b_owner:
        return _rgba(b_owner[name])
    try:
        b_property = b_owner.path_resolve(name, False)  # noqa: FBT003 - it takes no keywords
    except ValueError:
        return None
    # One element of an array, such as "location[0]" or "location.x", is none to Blender.
    return _rgba(b_owner.path_resolve(name)) if isinstance(b_property, bpy.types.bpy_prop) else None


def view_layer_value(b_depsgraph: Any, name: str) -> Rgba:
    """The value of a view layer, else of its scene, else of the scene's world; 0 where none has it."""
    b_scene = b_depsgraph.scene_eval
    owners = (b_depsgraph.view_layer_eval, b_scene, b_scene.world)
    values = (property_value(b_owner, name) for b_owner in owners if b_owner is not None)
    return next((value for value in values if value is not None), (0.0, 0.0, 0.0, 0.0))


def _rgba(value: Any) -> Rgba | None:
    if isinstance(value, int | float):
        return (float(value), float(value), float(value), 1.0)
    if isinstance(value, str) or not hasattr(value, "__len__") or not 0 < len(value) <= 4:
        return None
    if any(isinstance(x, bool) or not isinstance(x, int | float) for x in value):
        return None
    red, green, blue, alpha = (*map(float, value), *_OPAQUE[len(value) :])
    return red, green, blue, alpha

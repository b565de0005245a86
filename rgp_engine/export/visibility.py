"""Which rays see an object."""

from typing import Any

from .context import ExportContext

CAMERA, DIFFUSE, GLOSSY, TRANSMISSION, SHADOW = 1, 2, 4, 8, 16
HOLDOUT = 64
CATCHER = 1 << 31
ALL = CAMERA | DIFFUSE | GLOSSY | TRANSMISSION | SHADOW

_FLAGS = (
    ("visible_camera", CAMERA),
    ("visible_diffuse", DIFFUSE),
    ("visible_glossy", GLOSSY),
    ("visible_transmission", TRANSMISSION),
    ("visible_shadow", SHADOW),
)


def instance_bits(context: ExportContext, b_instance: Any) -> int:
    """The core's visibility bits of an instance: its object's and its instancer's together, and if it is a hole or a
    shadow catcher. A lamp is one, unless it belongs to the other objects."""
    bits = object_bits(b_instance.object)
    b_owner = owner(b_instance)
    if b_owner != b_instance.object:
        bits &= object_bits(b_owner)
    b_view_layer = context.b_depsgraph.view_layer_eval
    if b_owner.indirect_only_get(view_layer=b_view_layer):
        bits &= ~CAMERA
    if b_instance.object.is_holdout or b_owner.holdout_get(view_layer=b_view_layer):
        bits |= HOLDOUT if bits & CAMERA else 0
    if b_instance.object.is_shadow_catcher or b_owner.is_shadow_catcher:
        bits |= CATCHER if bits else 0
    return bits


def owner(b_instance: Any) -> Any:
    """The object that is really in the scene: the instancer of an instance, else the object itself."""
    is_instance = b_instance.is_instance and b_instance.parent is not None
    return b_instance.parent if is_instance else b_instance.object


def object_bits(b_object: Any) -> int:
    """The visibility bits set on one object."""
    return sum(bit for name, bit in _FLAGS if getattr(b_object, name))


def world_bits(b_world: Any) -> int:
    """The visibility bits of the background. They are Cycles' and gone when its add-on is disabled."""
    b_rays = getattr(b_world, "cycles_visibility", None)
    if b_rays is None:
        return ALL
    hidden = (
        (CAMERA, not b_rays.camera),
        (DIFFUSE, not b_rays.diffuse),
        (GLOSSY, not b_rays.glossy),
        (TRANSMISSION, not b_rays.transmission),
    )
    return ALL & ~sum(bit for bit, is_hidden in hidden if is_hidden)

"""What nodes may ask about an object."""

from collections.abc import Iterable
from typing import Any

from .context import ExportContext
from .hashing import name_hash
from .named_values import Rgba, property_value


def object_info(context: ExportContext, b_instance: Any, names: Iterable[str]) -> dict[str, Any]:
    """What the node Object Info says, and values of these names (see `ExportContext.attribute_number`)."""
    b_object = b_instance.object
    random = b_instance.random_id if b_instance.is_instance else name_hash(b_object.name)
    return {
        "color": [float(channel) for channel in b_object.color],
        "index": float(b_object.pass_index),
        "random": random % (1 << 32) / float((1 << 32) - 1),
        "attributes": [
            {"attribute": context.attribute_number(name), "value": list(value)}
            for name in sorted(names)
            if (value := _value(context, b_instance, name)) is not None
        ],
    }


def _value(context: ExportContext, b_instance: Any, name: str) -> Rgba | None:
    """As Cycles looks for it; what is not found is reported."""
    kind, _, which = name.partition(":")
    value = _of_instancer(context, b_instance, which) if kind == "instancer" else None
    b_object = b_instance.object
    for b_owner in (b_object, b_object.data):
        if value is None and b_owner is not None:
            value = property_value(b_owner, which)
    if value is None:
        context.log.add(b_object.name, f'its nodes read "{which}", which the {kind} does not have; 0 is used')
    return value


def _of_instancer(context: ExportContext, b_instance: Any, name: str) -> Rgba | None:
    b_instancer = b_instance.parent
    if not b_instance.is_instance or b_instancer is None:
        return None
    b_particles = b_instance.particle_system
    value = None if b_particles is None else property_value(b_particles.settings, name)
    if value is None and b_particles is None:
        value = context.geometry_instances.value(b_instance, name)
        if value is None and not context.geometry_instances.are_known(b_instancer):
            message = f'attributes of its instances, such as "{name}", cannot be read before Blender 4.5'
            context.log.add(b_instancer.name, f"{message}; properties of objects are used")
    return property_value(b_instancer, name) if value is None else value

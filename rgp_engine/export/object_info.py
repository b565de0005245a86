"""What nodes may ask about an object."""

from typing import Any

from .hashing import name_hash


def object_info(b_instance: Any) -> dict[str, Any]:
    """What the node Object Info says."""
    b_object = b_instance.object
    random = b_instance.random_id if b_instance.is_instance else name_hash(b_object.name)
    return {
        "color": [float(channel) for channel in b_object.color],
        "index": float(b_object.pass_index),
        "random": random % (1 << 32) / float((1 << 32) - 1),
    }

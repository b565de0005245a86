"""From the property groups to the core's settings, and back."""

from typing import Any

# Blender gives every property group these two.
_BLENDERS_OWN = ("rna_type", "name")


def setting_names(b_group: Any) -> list[str]:
    """Names of a property group's settings, or of the groups in it."""
    return [name for name in b_group.bl_rna.properties.keys() if name not in _BLENDERS_OWN]  # noqa: SIM118 (no dict)


def core_settings(b_scene: Any) -> dict[str, dict[str, Any]]:
    """Settings of an evaluated scene as the core takes them: {group: {name: value}}."""
    groups = {group: getattr(b_scene.rgp, group) for group in setting_names(b_scene.rgp)}
    return {
        group: {name: _core_value(getattr(b_group, name)) for name in setting_names(b_group)}
        for group, b_group in groups.items()
    }


def _core_value(value: Any) -> bool | int | float | str:
    """A property's value for the core: a pair of whole numbers becomes text such as "8x16"."""
    if isinstance(value, bool | int | float | str):
        return value
    return "x".join(str(part) for part in value)


def set_core_value(b_group: Any, name: str, value: Any) -> None:
    """Sets a property to a value of the core's: text such as "8x16" becomes a pair of whole numbers."""
    is_pair = getattr(b_group.bl_rna.properties[name], "is_array", False)
    setattr(b_group, name, tuple(map(int, value.split("x"))) if is_pair else value)

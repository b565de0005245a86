"""`--set GROUP.NAME=VALUE`: text to a property, with an answer that lists what exists when it does not fit."""

import math
from typing import Any

from ..settings import setting_names
from . import CommandError

_NOT_ALLOWED = 2


def assign(b_scene: Any, assignment: str) -> None:
    """Sets one property of `scene.rgp`, or of `scene.cycles` for GROUP cycles. Raises CommandError."""
    name, separator, text = assignment.partition("=")
    group_name, dot, setting = name.strip().partition(".")
    if not (separator and dot):
        raise CommandError(f"{assignment!r} is not of the form GROUP.NAME=VALUE", _NOT_ALLOWED)
    b_group = _group(b_scene, group_name)
    names = setting_names(b_group)
    if setting not in names:
        known = ", ".join(f"{group_name}.{known}" for known in sorted(names))
        raise CommandError(f"there is no setting {name}; there are {known}", _NOT_ALLOWED)
    b_property = b_group.bl_rna.properties[setting]
    value = _parse(b_property, text.strip())
    if value is not None:
        setattr(b_group, setting, value)
    # Blender clamps without a word.
    kept = getattr(b_group, setting)
    if value is None or not _is_same(kept, value):
        nearest = f" (nearest: {_text(kept)})" if value is not None else ""
        allowed = f"allowed is {_allowed(b_property)}{nearest}"
        raise CommandError(f"{name} is {text}; {allowed}", _NOT_ALLOWED)


def _group(b_scene: Any, name: str) -> Any:
    groups = {group: getattr(b_scene.rgp, group) for group in setting_names(b_scene.rgp)}
    if hasattr(b_scene, "cycles"):
        groups["cycles"] = b_scene.cycles
    if name not in groups:
        known = ", ".join(groups)
        raise CommandError(f"there is no group of settings {name}; there are {known}", _NOT_ALLOWED)
    return groups[name]


def _parse(b_property: Any, text: str) -> Any:
    """The property's value in the text; None when it holds none."""
    kind = b_property.type
    try:
        if kind in ("INT", "FLOAT"):
            number = _whole if kind == "INT" else _real
            if b_property.is_array:
                values = tuple(number(part) for part in text.split("x"))
                return values if len(values) == b_property.array_length else None
            return number(text)
    except ValueError:
        return None
    if kind == "BOOLEAN":
        return {"true": True, "1": True, "false": False, "0": False}.get(text.lower())
    if kind == "ENUM":
        return text if text in {item.identifier for item in b_property.enum_items} else None
    return text if kind == "STRING" else None


def _whole(text: str) -> int:
    value = int(text)
    if not -(2**31) <= value < 2**31:
        raise ValueError("Blender has no room for it, and may even crash on it")
    return value


def _real(text: str) -> float:
    value = float(text)
    if math.isnan(value):
        raise ValueError("Blender takes it, and nothing can be done with it")
    return value


def _is_same(found: Any, value: Any) -> bool:
    if isinstance(value, tuple):
        return bool(tuple(found) == value)
    if isinstance(value, float):
        return bool(abs(found - value) <= 1e-6 * max(1.0, abs(value)))
    return bool(found == value)


def _text(value: Any) -> str:
    return str(value) if isinstance(value, bool | int | float | str) else "x".join(map(str, value))


def _allowed(b_property: Any) -> str:
    kind = b_property.type
    if kind == "ENUM":
        return "one of " + ", ".join(item.identifier for item in b_property.enum_items)
    if kind == "BOOLEAN":
        return "true or false"
    if kind not in ("INT", "FLOAT"):
        return "text"
    whole, form = ("whole ", "d") if kind == "INT" else ("", ".7g")
    limits = f"from {b_property.hard_min:{form}} to {b_property.hard_max:{form}}"
    if b_property.is_array:
        example = "x".join(format(part, form) for part in b_property.default_array)
        return f"{whole}numbers {limits} such as {example}"
    return f"a {whole}number {limits}"

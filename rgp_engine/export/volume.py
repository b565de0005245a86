"""Volume shaders as what light loses on its way through a solid."""

from .arithmetic import BLACK, Color, clamp, scale
from .fold import Folder, Varying
from .nodes import Input, Output, origin

_NEGLIGIBLE = 1e-6


def absorption(folder: Folder, entry: Input, weight: float = 1.0) -> Color:
    """Absorption coefficient (1/m) of the solid that a material's surface bounds. What scatters light or gives light is
    left out and reported; what varies within the solid has a typical value everywhere."""
    source = origin(entry)
    if isinstance(source, Input) or source.b_node.mute or weight < _NEGLIGIBLE:
        return BLACK
    folder.meet_shader()
    kind = source.b_node.type
    if kind in ("MIX_SHADER", "ADD_SHADER"):
        weights = (weight, weight)
        if kind == "MIX_SHADER":
            factor = clamp(_number(folder, source, "Fac"))
            weights = (weight * (1.0 - factor), weight * factor)
        names = ("Shader", "Shader_001")
        first, second = (absorption(folder, source.input(name), w) for name, w in zip(names, weights))
        return (first[0] + second[0], first[1] + second[1], first[2] + second[2])
    if kind == "VOLUME_ABSORPTION":
        density = weight * max(_number(folder, source, "Density"), 0.0)
        kept = _color(folder, source, "Color")
        return scale((_absorbed(kept[0]), _absorbed(kept[1]), _absorbed(kept[2])), density)
    if kind == "VOLUME_COEFFICIENTS":
        for name in ("Scatter Coefficients", "Emission Coefficients"):
            if _color(folder, source, name) != BLACK:
                folder.report_node(source.b_node, f"{name} are not supported yet; left out")
        return scale(_color(folder, source, "Absorption Coefficients"), weight)
    folder.report_node(source.b_node, "as a volume this is not supported yet; left out")
    return BLACK


def _number(folder: Folder, source: Output, name: str) -> float:
    value = folder.value(source.input(name))
    if isinstance(value, Varying):
        _report_varying(folder, source, name)
        return value.number
    return value


def _color(folder: Folder, source: Output, name: str) -> Color:
    color = folder.color(source.input(name))
    if not isinstance(color, Varying):
        return color
    _report_varying(folder, source, name)
    typical = color.typical
    return (typical, typical, typical) if isinstance(typical, float) else typical


def _report_varying(folder: Folder, source: Output, name: str) -> None:
    folder.report_node(source.b_node, f"volumes are even for now; a typical value is used for {name}")


def _absorbed(kept: float) -> float:
    """No light comes of a color above 1."""
    return max(1.0 - kept, 0.0)

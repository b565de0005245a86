"""Shader nodes as weighted closures: Mix and Add Shader multiplied out, inputs constant or, for a compiler, varying."""

from collections.abc import Callable
from typing import Any

from .arithmetic import BLACK, WHITE, Color
from .fold import Folder, Value, Varying
from .nodes import Input, Output, origin

Closure = dict[str, Any]
WeightedClosure = dict[str, Any]
Part = tuple[Value | Varying, Closure, Output]
"""A share, the closure that has it, and the shader that is behind it."""

_NEGLIGIBLE = 1e-6
# Principled inputs the core has under the same name in snake case: identifier and whether it is a color.
_PRINCIPLED = (
    ("Base Color", True),
    ("Metallic", False),
    ("Roughness", False),
    ("Anisotropic", False),
    ("Anisotropic Rotation", False),
    ("IOR", False),
    ("Alpha", False),
    ("Specular IOR Level", False),
    ("Specular Tint", True),
    ("Transmission Weight", False),
    ("Coat Weight", False),
    ("Coat Roughness", False),
    ("Coat IOR", False),
    ("Coat Tint", True),
    ("Emission Color", True),
    ("Emission Strength", False),
    ("Sheen Weight", False),
    ("Sheen Roughness", False),
    ("Sheen Tint", True),
)
# Inputs that are left out, and do nothing at 0.
_LEFT_OUT = ("Thin Film Thickness",)

_SUBSURFACE = "subsurface scattering is approximated: light leaves where it enters, as from Diffuse"


def closures(folder: Folder, entry: Input) -> tuple[list[WeightedClosure], list[dict[str, Any]]]:
    """The closures a shader input stands for, each with its share; empty for black. Inputs that vary hold a typical
    value and are listed as the core's OutputRecords."""
    outputs: list[dict[str, Any]] = []
    records = []
    for index, (share, closure, source) in enumerate(_parts(folder, entry, 1.0)):
        folder.note_normals(index, source)
        if closure.get("anisotropy", closure.get("anisotropic", 0.0)) != 0.0:
            folder.note_tangent(index, source)
        record = {}
        for name, value in (("weight", share), *closure.items()):
            if isinstance(value, Varying):
                outputs.append({"closure": index, "input": name, "register": value.register})
                value = value.typical
            record[name] = list(value) if isinstance(value, tuple) else value
        weight = record.pop("weight")
        records.append({"weight": weight if isinstance(weight, list) else [weight] * 3, "closure": record})
    return records, outputs


def emissions(folder: Folder, entry: Input) -> list[Value | Varying]:
    """What each emission that a shader input stands for gives; all else gives nothing."""
    parts = _parts(folder, entry, 1.0)
    return [folder.product(share, part["radiance"]) for share, part, _ in parts if part["kind"] == "emission"]


def _parts(folder: Folder, entry: Input, weight: float | Varying) -> list[Part]:
    source = origin(entry)
    if isinstance(source, Input) or source.b_node.mute:
        return []
    if not isinstance(weight, Varying) and weight < _NEGLIGIBLE:
        return []
    folder.meet_shader()
    kind = source.b_node.type
    if kind == "MIX_SHADER":
        factor = folder.unit(folder.value(source.input("Fac")))
        first = _parts(folder, source.input("Shader"), _share(folder, weight, folder.complement(factor)))
        return first + _parts(folder, source.input("Shader_001"), _share(folder, weight, factor))
    if kind == "ADD_SHADER":
        first = _parts(folder, source.input("Shader"), weight)
        return first + _parts(folder, source.input("Shader_001"), weight)
    _report_left_out(folder, source)
    record, share = _closure(folder, source)
    return [(folder.product(share, weight), record, source)] if record else []


def _share(folder: Folder, weight: float | Varying, factor: float | Varying) -> float | Varying:
    product = folder.product(weight, factor)
    if isinstance(product, Varying | float):
        return product
    raise TypeError("a share is a number")


def _closure(folder: Folder, source: Output) -> tuple[Closure | None, Color]:
    """One shader node as a closure, and its tint; no closure for black."""
    b_node = source.b_node
    convert = _SHADERS.get(b_node.type)
    if convert is not None:
        return convert(folder, source), WHITE
    entry = source.find("Color") or source.find("Base Color")
    if entry is None or source.b_socket.identifier == "Volume":
        folder.report_node(b_node, "this shader is not supported; black is used instead")
        return None, BLACK
    folder.report_node(b_node, "this shader is not supported yet; Diffuse is used instead")
    return {"kind": "diffuse", "color": folder.color(entry)}, WHITE


def _report_left_out(folder: Folder, source: Output) -> None:
    """Inputs that would change the picture but are not rendered yet."""
    for identifier in _LEFT_OUT:
        entry = source.find(identifier)
        if entry is not None and folder.constant_value(entry) != 0.0:
            folder.report_node(source.b_node, f"{identifier} is not supported yet; left out")


def _diffuse(folder: Folder, source: Output) -> Closure:
    roughness = folder.unit(folder.value(source.input("Roughness")))
    return {"kind": "diffuse", "color": folder.color(source.input("Color")), "roughness": roughness}


def _rough(kind: str, *more: str) -> Callable[[Folder, Output], Closure]:
    """A closure of color, roughness and further numbers."""

    def convert(folder: Folder, source: Output) -> Closure:
        numbers = {name.lower(): folder.value(source.input(name)) for name in more}
        roughness = folder.unit(folder.value(source.input("Roughness")))
        # Blender 4.1 and before had perfect mirrors as a distribution of their own.
        if source.b_node.distribution == "SHARP":
            roughness = 0.0
        color = folder.color(source.input("Color"))
        record = {"kind": kind, "color": color, "roughness": roughness, **numbers}
        multiscatter = _multiscatter(folder, source, roughness)
        # Refraction always loses what bounces between microfacets.
        return record if kind == "refraction" else {**record, "multiscatter": multiscatter}

    return convert


def _multiscatter(folder: Folder, source: Output, roughness: float | Varying) -> bool:
    """Whether light that bounces between microfacets leaves in the end. Their distribution is always GGX."""
    b_node = source.b_node
    if b_node.distribution in ("BECKMANN", "ASHIKHMIN_SHIRLEY") and roughness != 0.0:
        folder.report_node(
            b_node, f"the distribution {b_node.distribution} is not supported yet; GGX is used"
        )
    return bool(b_node.distribution == "MULTI_GGX")


def _colored(kind: str) -> Callable[[Folder, Output], Closure]:
    """A closure of a color alone."""
    return lambda folder, source: {"kind": kind, "color": folder.color(source.input("Color"))}


def _sheen(folder: Folder, source: Output) -> Closure:
    if source.b_node.distribution != "MICROFIBER":
        folder.report_node(source.b_node, "the distribution Ashikhmin is not supported; Microfiber is used")
    roughness = folder.unit(folder.value(source.input("Roughness")))
    return {"kind": "sheen", "color": folder.color(source.input("Color")), "roughness": roughness}


def _holdout(_folder: Folder, _source: Output) -> Closure:
    return {"kind": "holdout"}


def _subsurface(folder: Folder, source: Output) -> Closure:
    folder.report_node(source.b_node, _SUBSURFACE)
    return {"kind": "diffuse", "color": folder.color(source.input("Color"))}


def _emission(folder: Folder, source: Output) -> Closure:
    color = folder.color(source.input("Color"))
    return {"kind": "emission", "radiance": folder.product(color, folder.value(source.input("Strength")))}


def _principled(folder: Folder, source: Output) -> Closure:
    record: Closure = {"kind": "principled"}
    thin_wall = source.find("Thin Wall")  # not before Blender 5.2
    if thin_wall is not None and folder.constant_value(thin_wall) != 0.0:
        record["thin_wall"] = True
        for identifier in ("Subsurface Weight", "Subsurface Anisotropy"):
            record[identifier.lower().replace(" ", "_")] = folder.value(source.input(identifier))
    elif folder.constant_value(source.input("Subsurface Weight")) != 0.0:
        folder.report_node(source.b_node, _SUBSURFACE)
    for identifier, is_color in _PRINCIPLED:
        entry = source.input(identifier)
        name = identifier.lower().replace(" ", "_")
        record[name] = folder.color(entry) if is_color else folder.value(entry)
    diffuse_roughness = source.find("Diffuse Roughness")
    if diffuse_roughness is not None:  # not in Blender 4.2
        record["diffuse_roughness"] = folder.value(diffuse_roughness)
    record["multiscatter"] = _multiscatter(folder, source, record["roughness"])
    return record


def _metallic(folder: Folder, source: Output) -> Closure:
    if source.b_node.fresnel_type != "F82":
        folder.report_node(source.b_node, "physical conductors are not supported yet; F82 is used")
    roughness = folder.value(source.input("Roughness"))
    return {
        "kind": "principled",
        "metallic": 1.0,
        "base_color": folder.color(source.input("Base Color")),
        "specular_tint": folder.color(source.input("Edge Tint")),
        "roughness": roughness,
        "multiscatter": _multiscatter(folder, source, roughness),
        "anisotropic": folder.value(source.input("Anisotropy")),
        "anisotropic_rotation": folder.value(source.input("Rotation")),
    }


_SHADERS: dict[str, Callable[[Folder, Output], Closure]] = {
    "BSDF_DIFFUSE": _diffuse,
    "BSDF_GLOSSY": _rough("glossy", "Anisotropy", "Rotation"),
    "BSDF_GLASS": _rough("glass", "IOR"),
    "BSDF_REFRACTION": _rough("refraction", "IOR"),
    "BSDF_TRANSPARENT": _colored("transparent"),
    "BSDF_TRANSLUCENT": _colored("translucent"),
    "BSDF_SHEEN": _sheen,
    "SUBSURFACE_SCATTERING": _subsurface,
    "HOLDOUT": _holdout,
    "EMISSION": _emission,
    "BACKGROUND": _emission,
    "BSDF_PRINCIPLED": _principled,
    "BSDF_METALLIC": _metallic,
}
"""How each shader node is rendered, by Blender's `node.type`."""

"""Blender's materials as the core's MaterialRecord."""

from typing import Any

from .closures import closures
from .compiler import MOST_INSTRUCTIONS, Compiler, displace
from .context import ExportContext
from .fold import TOO_DEEP
from .nodes import Input, Output, node_tree, origin, output_node
from .volume import absorption

_DEFAULT = {"weight": [1.0] * 3, "closure": {"kind": "diffuse", "color": [0.8] * 3}}

_CLEAR = {"weight": [1.0] * 3, "closure": {"kind": "transparent", "color": [1.0] * 3}}
"""Where there is a volume and no surface."""


def material_index(context: ExportContext, b_material: Any | None) -> int:
    """Index of an evaluated material in the builder, added when it is met first; None is Blender's default grey."""
    key = None if b_material is None else b_material.as_pointer()
    if key not in context.materials:
        name = "(no material)" if b_material is None else b_material.name
        compiler = Compiler(context, name)
        record = _default_record() if b_material is None else _record_or_default(compiler, b_material)
        context.emits |= emits(record)
        index = context.builder.add_material(record)
        context.materials[key] = index
        context.layers_read[index] = frozenset(compiler.attributes)
        if compiler.asks_object:
            context.asking_objects[index] = frozenset(compiler.object_values)
    return context.materials[key]


def _record_or_default(compiler: Compiler, b_material: Any) -> dict[str, Any]:
    try:
        return material_record(compiler, b_material)
    except TOO_DEEP:
        compiler.report("its nodes form a circle, or too long a chain; Blender's default gray is used")
        return _default_record()


def material_record(compiler: Compiler, b_material: Any) -> dict[str, Any]:
    """The surface of a material, and what its volume absorbs."""
    name = b_material.name
    compiler.material_index = b_material.pass_index
    b_tree = node_tree(b_material)
    if b_tree is None:
        color = list(b_material.diffuse_color[:3])
        closure = {"kind": "diffuse", "color": color}
        return {"name": name, "closures": [{"weight": [1.0] * 3, "closure": closure}]}
    b_output = output_node(b_tree, "OUTPUT_MATERIAL")
    if b_output is None:
        compiler.report("it has no Material Output node; black is used")
        return {"name": name, "closures": []}
    displacement = Input(b_output.inputs["Displacement"], ())
    if isinstance(origin(displacement), Output) and not displace(compiler, displacement):
        compiler.report("this Displacement is not supported yet; left out")
    elif compiler.normal is not None and getattr(b_material, "displacement_method", "BUMP") != "BUMP":
        compiler.report("its Displacement is rendered as a bump")
    surface, volume = (Input(b_output.inputs[name], ()) for name in ("Surface", "Volume"))
    has_volume = isinstance(origin(volume), Output)
    records, outputs = closures(compiler, surface)
    if has_volume and isinstance(origin(surface), Input):
        records = [_CLEAR]
    if compiler.normals and not _softens_bumps(b_material):
        compiler.report("Bump Map Correction cannot be switched off")
    record: dict[str, Any] = {"name": name, "closures": records}
    if has_volume:
        record["absorption"] = list(absorption(compiler, volume))
    has_directions = compiler.normals or compiler.tangents or compiler.normal is not None
    if not outputs and not has_directions:
        return record
    if len(compiler.instructions) > MOST_INSTRUCTIONS:
        compiler.report("its nodes are too many; what varies is replaced by a typical value")
        return record
    record["program"] = {
        "instructions": compiler.instructions,
        "outputs": outputs,
        "normal": None if compiler.normal is None else compiler.normal.index,
        "normals": compiler.normals,
        "tangents": compiler.tangents,
    }
    return record


def _softens_bumps(b_material: Any) -> bool:
    """Cycles' Bump Map Correction; True where Cycles is not there to ask."""
    return bool(getattr(getattr(b_material, "cycles", None), "use_bump_map_correction", True))


def _default_record() -> dict[str, Any]:
    return {"name": "(no material)", "closures": [_DEFAULT]}


def emits(record: dict[str, Any]) -> bool:
    """True for a material that may give light somewhere: what its program computes may be anything."""
    outputs = record.get("program", {}).get("outputs", ())
    varying = {(output["closure"], output["input"]) for output in outputs}

    def is_lit(index: int, name: str, value: Any) -> bool:
        return (index, name) in varying or (any(value) if isinstance(value, list) else value > 0.0)

    factors = {"emission": ("radiance",), "principled": ("emission_color", "emission_strength")}
    for index, weighted in enumerate(record["closures"]):
        closure = weighted["closure"]
        names = factors.get(closure["kind"], ())
        if names and all(is_lit(index, name, closure.get(name, 0.0)) for name in names):
            return True
    return False

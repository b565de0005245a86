"""Where textures are looked up: the Mapping node, and the mapping that texture nodes have in themselves."""

from typing import TYPE_CHECKING, Any

from mathutils import Euler, Matrix

from ..nodes import Output

if TYPE_CHECKING:
    from .compiler import Compiler, Operand, Register


def texture_vector(c: "Compiler", source: Output) -> "Register":
    """Where a pattern is looked up; unlinked it follows the mesh's generated coordinates."""
    vector = c.input(source, "Vector") if c.linked(source, "Vector") else c.generated()
    return own_mapping(c, source.b_node, vector)


def own_mapping(c: "Compiler", b_node: Any, vector: "Register") -> "Register":
    """The mapping that old files have in the texture node itself."""
    b_mapping = b_node.texture_mapping
    location, rotation, scale = (
        tuple(v) for v in (b_mapping.translation, b_mapping.rotation, b_mapping.scale)
    )
    if (location, rotation, scale) == ((0.0,) * 3, (0.0,) * 3, (1.0,) * 3):
        return vector
    return c.transformed(vector, _matrix(location, rotation, scale)[:3])


def _matrix(location: Any, rotation: Any, scale: Any) -> Any:
    return Matrix.LocRotScale(location, Euler(rotation), scale)


def mapping(c: "Compiler", source: Output) -> "Operand | None":
    """The Mapping node: a matrix where its inputs are constant."""
    kind = source.b_node.vector_type
    vector = c.input(source, "Vector")
    names = ("Location", "Rotation", "Scale")
    entries = [source.find(name) for name in names]
    values = [(0.0, 0.0, 0.0) if entry is None else c.color(entry) for entry in entries]
    if all(isinstance(value, tuple) and len(value) == 3 for value in values):
        return _constant_mapping(c, kind, vector, values)
    if kind == "TEXTURE":
        return None
    location, rotation, scale = (
        c.register(0.0) if entry is None else c.input(source, name) for name, entry in zip(names, entries)
    )
    zero, one = c.register(0.0), c.register(1.0)
    if kind == "NORMAL":
        shrunk = c.vector_math("DIVIDE", vector, scale)
        turned = c.emit("mapping", vector=shrunk, location=zero, rotation=rotation, scale=one)
        return c.emit("normalize", vector=turned)
    moved = location if kind == "POINT" else zero
    return c.emit("mapping", vector=vector, location=moved, rotation=rotation, scale=scale)


def _constant_mapping(c: "Compiler", kind: str, vector: "Register", values: list[Any]) -> "Register":
    location, rotation, scale = values
    if kind == "TEXTURE":
        return c.transformed(vector, _matrix(location, rotation, scale).inverted_safe()[:3])
    if kind == "POINT":
        return c.transformed(vector, _matrix(location, rotation, scale)[:3])
    if kind == "VECTOR":
        return c.transformed(vector, _matrix((0.0, 0.0, 0.0), rotation, scale)[:3])
    inverse = [1.0 / x if x else 0.0 for x in scale]
    return c.emit("normalize", vector=c.transformed(vector, _matrix((0.0, 0.0, 0.0), rotation, inverse)[:3]))

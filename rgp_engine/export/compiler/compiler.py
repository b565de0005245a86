"""Walks a material's, world's or lamp's nodes backwards from what is asked for, and writes down what has to be
computed at every hit.

Whatever is constant stays a constant: only nodes behind which something differs from point to point become
instructions, and those whose constant only the core can compute.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from .. import arithmetic
from ..arithmetic import Color, clamp
from ..fold import Folder, Value, Varying, as_color, as_number, converted
from ..nodes import Input, Output, origin
from .registry import NODES, SOURCES

if TYPE_CHECKING:
    from ..context import ExportContext

MOST_INSTRUCTIONS = 4096
"""Of the core: programs with more are refused."""


@dataclass(frozen=True)
class Register:
    """A result of the program."""

    index: int


Operand = Value | Register


class Compiler(Folder):
    """Folds what is constant and compiles the rest, for one material, world or lamp."""

    of_world = False
    """True for a world: positions are directions, and there is no mesh."""
    of_lamp = False
    """True for a lamp: there is no mesh, and it is known how far away it is seen from."""
    is_sun = False
    """True for a lamp that is infinitely far away."""
    material_index = 0
    """Of Blender's Object Info."""

    def __init__(self, context: "ExportContext", subject: str) -> None:
        super().__init__(subject, context.log, context.b_depsgraph)
        self.context = context
        self.instructions: list[dict[str, Any]] = []
        self.attributes: set[str] = set()
        """Layers of the mesh that the program reads."""
        self.asks_object = False
        """True when the program asks about the object."""
        self.object_values: set[str] = set()
        """Values of the object that it asks for."""
        self.aside = (0.0, 0.0)
        """Where on the surface things are asked for, while the slope of a bump is compiled: widths of the ray along two
        tangents."""
        self.normal: Register | None = None
        """The register that is the shading normal of what has none of its own."""
        self.normals: list[dict[str, Any]] = []
        """The core's NormalRecords: closures with a shading normal of their own."""
        self.tangents: list[dict[str, int]] = []
        """The core's TangentRecords: of closures that are anisotropic."""
        self._silent = Folder(subject, b_depsgraph=context.b_depsgraph)
        self._known: dict[tuple[Any, ...], Operand] = {}
        self._numbers: dict[str, Register] = {}
        self._varies: dict[tuple[Any, ...], bool] = {}

    # What a shader asks for.

    def color(self, entry: Input) -> Color | Varying:
        """The color of an input: a constant, or what computes it and a typical value."""
        found = self.compile(entry)
        if isinstance(found, Register):
            return Varying(found.index, self._silent.constant_color(entry))
        return as_color(found)

    def value(self, entry: Input) -> float | Varying:
        """As `color`, for a number."""
        found = self.compile(entry)
        if isinstance(found, Register):
            return Varying(found.index, self._silent.constant_value(entry))
        return as_number(found, entry.b_socket.type)

    def product(self, a: Value | Varying, b: Value | Varying) -> Value | Varying:
        """Channel by channel."""
        if not isinstance(a, Varying) and not isinstance(b, Varying):
            return super().product(a, b)
        typical = arithmetic.product(_typical(a), _typical(b))
        return Varying(self.vector_math("MULTIPLY", _operand(a), _operand(b)).index, typical)

    def complement(self, a: float | Varying) -> float | Varying:
        """1 - a."""
        if not isinstance(a, Varying):
            return super().complement(a)
        return Varying(self.math("SUBTRACT", 1.0, _operand(a)).index, 1.0 - a.number)

    def unit(self, a: float | Varying) -> float | Varying:
        """Clamped to 0 and 1."""
        if not isinstance(a, Varying):
            return super().unit(a)
        return Varying(self.clamped(_operand(a)).index, clamp(a.number))

    def note_normals(self, closure: int, source: Output) -> None:
        """Remembers the normals a closure's shader asks for."""
        self._note_normal(closure, source, "Normal", of_coat=False)
        if source.find("Coat Normal") is not None and self.value(source.input("Coat Weight")) != 0.0:
            self._note_normal(closure, source, "Coat Normal", of_coat=True)

    def _note_normal(self, closure: int, source: Output, identifier: str, of_coat: bool) -> None:
        if not self.linked(source, identifier):
            return
        found = self.compile(source.input(identifier))
        if isinstance(found, Register):
            self.normals.append({"closure": closure, "coat": of_coat, "register": found.index})
        else:
            message = f"a constant {identifier} is not supported; the surface's own is used instead"
            self.report_node(source.b_node, message)

    def note_tangent(self, closure: int, source: Output) -> None:
        """Remembers the tangent of a closure that is anisotropic; unlinked, it leads around the object's z axis."""
        is_linked = self.linked(source, "Tangent")
        tangent = self.input(source, "Tangent") if is_linked else self.radial_tangent("z")
        self.tangents.append({"closure": closure, "register": tangent.index})

    # What the nodes are made of.

    def compile(self, entry: Input) -> Operand:
        """What an input stands for, in the form of its own type."""
        source = origin(entry)
        if isinstance(source, Input) or source.b_node.mute or not self.varies(source):
            return self.fold(entry)
        key = (*source.key, self.aside)
        if key not in self._known:
            self._known[key] = self._emit_node(source)
        return self._converted(self._known[key], source.b_socket.type, entry.b_socket.type)

    def varies(self, source: Output) -> bool:
        """True when a node gives another result from point to point."""
        key = source.key
        if key not in self._varies:
            self._varies[key] = False  # should the tree run in a circle
            self._varies[key] = self._looks_varying(source)
        return self._varies[key]

    def _looks_varying(self, source: Output) -> bool:
        kind = source.b_node.type
        if kind in SOURCES:
            return bool(SOURCES[kind](self, source))
        if kind not in NODES:
            return False
        behind = (origin(Input(b_socket, source.groups)) for b_socket in source.b_node.inputs)
        if any(isinstance(found, Output) and self.varies(found) for found in behind):
            return True
        # What is constant and cannot be computed here is left to the core.
        return not self._silent.folds(source)

    def _emit_node(self, source: Output) -> Operand:
        try:
            found = NODES[source.b_node.type](self, source)
        except (ValueError, OverflowError):
            found = None  # beyond all numbers, where there is no result
        if found is not None:
            return found
        default = self._silent.typical(source)
        self.report_node(
            source.b_node, "this use of it is not supported yet; a typical value is used instead"
        )
        return default

    def _converted(self, operand: Operand, from_type: str, to_type: str) -> Operand:
        if not isinstance(operand, Register):
            return converted(operand, from_type, to_type)
        if to_type in ("RGBA", "VECTOR") or from_type not in ("RGBA", "VECTOR"):
            return operand
        return self.emit("luminance" if from_type == "RGBA" else "mean", of=operand)

    def emit(self, op: str, **fields: Any) -> Register:
        """The register of an instruction; the same instruction is never there twice."""
        record = {"op": op, **{name: self._field(value) for name, value in fields.items()}}
        key = repr(record)
        if key not in self._numbers:
            self._numbers[key] = Register(len(self.instructions))
            self.instructions.append(record)
        return self._numbers[key]

    def _field(self, value: Any) -> Any:
        return value.index if isinstance(value, Register) else value

    def register(self, operand: Operand) -> Register:
        """The register that holds an operand."""
        if isinstance(operand, Register):
            return operand
        values = [operand] * 4 if isinstance(operand, float) else [*operand, 1.0]
        return self.emit("constant", value=[float(value) for value in values])

    def input(self, source: Output, identifier: str) -> Register:
        """The register of a node's input."""
        return self.register(self.compile(source.input(identifier)))

    def linked(self, source: Output, identifier: str) -> bool:
        """True when something feeds that input."""
        entry = source.find(identifier)
        return entry is not None and isinstance(origin(entry), Output)

    def math(self, function: str, a: Operand, b: Operand = 0.0, c: Operand = 0.0) -> Register:
        """An operation on numbers."""
        a, b, c = self.register(a), self.register(b), self.register(c)
        return self.emit("math", function=function, a=a, b=b, c=c)

    def vector_math(self, function: str, a: Operand, b: Operand = 0.0, c: Operand = 0.0) -> Register:
        """An operation on vectors."""
        a, b, c = self.register(a), self.register(b), self.register(c)
        return self.emit("vector_math", function=function, a=a, b=b, c=c)

    def clamped(self, value: Operand, low: Operand = 0.0, high: Operand = 1.0) -> Register:
        """A value kept within two numbers."""
        value, low, high = self.register(value), self.register(low), self.register(high)
        return self.emit("clamp", value=value, low=low, high=high)

    def mixed(self, factor: Operand, a: Operand, b: Operand) -> Register:
        """From a at 0 to b at 1."""
        factor, a, b = self.register(factor), self.register(a), self.register(b)
        return self.emit("mix", factor=factor, a=a, b=b)

    def quantity(self, name: str) -> Register:
        """Something about the hit."""
        return self.emit("geometry", quantity=name, aside=self.aside)

    def attribute(self, name: str) -> Register:
        """A layer of the mesh."""
        self.attributes.add(name)
        return self.emit("attribute", attribute=self.context.attribute_number(name), aside=self.aside)

    def object_value(self, name: str) -> Register:
        """A value of the object, "object:NAME", or of its instancer, "instancer:NAME"; the world has none."""
        if self.of_world:
            return self.register((0.0, 0.0, 0.0))
        self.asks_object = True
        self.object_values.add(name)
        return self.emit("object_attribute", attribute=self.context.attribute_number(name))

    def generated(self) -> Register:
        """Where textures are looked up if nothing else is said."""
        return self.quantity("position") if self.of_world else self.attribute("generated")

    def radial_tangent(self, axis: str) -> Register:
        """The direction around an axis of the object along the surface."""
        return self.emit("tangent", generated=self.generated(), axis=axis)

    def transformed(self, vector: Register, rows: Iterable[Iterable[float]]) -> Register:
        """A matrix (3 x 4) times a point."""
        return self.emit("transform", vector=vector, rows=[[float(x) for x in row] for row in rows])


def _operand(value: Value | Varying) -> Operand:
    return Register(value.register) if isinstance(value, Varying) else value


def _typical(value: Value | Varying) -> Value:
    return value.typical if isinstance(value, Varying) else value

"""Cases of the IES Texture: every type of file and every symmetry, and every way to name one and a direction."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import bpy
import numpy as np

from tests.blender import build
from tests.render.node_scene import EDGES, SMOOTH, Make, NodeCase

TYPE_A, TYPE_B, TYPE_C = 3, 2, 1
ROUND = (0, 20, 45, 70, 90, 120, 150, 180)
"""Vertical angles of type C, in degrees."""
FRONT = (-90, -40, 0, 30, 90)
"""Angles of types A and B on both sides."""
HALF_FRONT = (0, 25, 60, 90)


def ies_text(
    horizontal: Sequence[float], vertical: Sequence[float] = ROUND, kind: int = TYPE_C, tilt: str = "NONE"
) -> str:
    """A file of random intensities, 8 to 40 cd, at the given angles (degrees)."""
    candela = np.random.default_rng(4).uniform(4.0, 20.0, (len(horizontal), len(vertical)))
    if horizontal[-1] == 360:
        candela[-1] = candela[0]
    lines = [
        "IESNA:LM-63-2002",
        "[TEST] random",
        f"TILT={tilt}",
        f"1 1000 2.0 {len(vertical)} {len(horizontal)} {kind} 2 0.1 0.1 0",
        "1.0 1.0 60",
    ]
    rows = [" ".join(f"{number:g}" for number in row) for row in (vertical, horizontal, *candela)]
    return "\n".join([*lines, *rows, ""])


def _text(content: str) -> Any:
    b_text = bpy.data.texts.new("Luminaire")
    b_text.write(content)
    return b_text


def _saved(content: str) -> str:
    """The path of a file that is written to Blender's own folder for what is there for a moment."""
    path = Path(bpy.app.tempdir) / "rgp_luminaire.ies"
    path.write_text(content)
    return str(path)


def _around(b_tree: Any) -> Any:
    """Nearly half of all directions, below the horizon and above it."""
    return _directions(b_tree, Location=(0.05, 0.1, -0.2), Rotation=(0.5, 0.7, 0.3))


def _below(b_tree: Any) -> Any:
    """Directions all around the one straight down."""
    return _directions(b_tree, Location=(0.05, 0.1, -0.4))


def _directions(b_tree: Any, **turned: Any) -> Any:
    b_mapping = build.node(b_tree, "ShaderNodeMapping", **turned)
    b_tree.links.new(b_tree.nodes.new("ShaderNodeTexCoord").outputs["Object"], b_mapping.inputs["Vector"])
    return b_mapping.outputs[0]


def _linked(kind: str, output: str) -> Make:
    return lambda b_tree: b_tree.nodes.new(kind).outputs[output]


def luminaire(content: str | None, vector: Make | None = None, file: str = "", strength: float = 1.0) -> Make:
    """An IES Texture of a text, or of a file where there is no text; its Vector may be linked."""

    def make(b_tree: Any) -> Any:
        b_node = b_tree.nodes.new("ShaderNodeTexIES")
        b_node.mode = "EXTERNAL" if content is None else "INTERNAL"
        if content is None:
            b_node.filepath = file
        else:
            b_node.ies = _text(content)
        b_node.inputs["Strength"].default_value = strength
        if vector is not None:
            b_tree.links.new(vector(b_tree), b_node.inputs["Vector"])
        return b_node.outputs[0]

    return make


def _file(b_tree: Any) -> Any:
    return luminaire(None, _around, _saved(ies_text((0, 90, 180, 270, 360))))(b_tree)


def _cases() -> Iterator[tuple[str, NodeCase]]:
    planes = {
        "one plane": (0,),
        "a quarter": (0, 30, 90),
        "a half": (0, 45, 90, 180),
        "a half from 90": (90, 135, 200, 270),
        "all planes": (0, 45, 90, 180, 200, 300, 360),
        "the last plane missing": (0, 90, 180, 270),
        "a part": (30, 100, 200),
    }
    for name, horizontal in planes.items():
        bound = EDGES if name == "a part" else SMOOTH
        yield f"type C, {name}", NodeCase(luminaire(ies_text(horizontal), _around), bound)
    for name, vertical in (("below", (0, 30, 90)), ("above", (90, 120, 180))):
        content = ies_text((0, 90, 180, 270, 360), vertical)
        yield f"type C, {name} the horizon", NodeCase(luminaire(content, _around), EDGES)
    for letter, kind in (("A", TYPE_A), ("B", TYPE_B)):
        for name, horizontal in (("both sides", FRONT), ("one side", HALF_FRONT)):
            for name_v, vertical in (("all heights", FRONT), ("half the heights", HALF_FRONT)):
                content = ies_text(horizontal, vertical, kind)
                case = NodeCase(luminaire(content, _around), EDGES)
                yield f"type {letter}, {name}, {name_v}", case
    whole = ies_text((0, 45, 90, 180, 200, 300, 360))
    coarse = ies_text((0, 90, 180, 270, 360), (0, 60, 120, 180))
    yield "type C, straight down", NodeCase(luminaire(coarse, _below, strength=9.0))
    yield "Strength", NodeCase(luminaire(whole, _around, strength=0.3))
    yield "tilt", NodeCase(luminaire(ies_text((0, 90), tilt="INCLUDE\n1\n2\n0 180\n1 0.5"), _around))
    yield "file", NodeCase(_file)
    yield "no file", NodeCase(luminaire(None, file="//nowhere.ies", strength=0.1))
    yield "Geometry Normal", NodeCase(luminaire(whole, _linked("ShaderNodeNewGeometry", "Normal")))
    yield "Geometry Incoming", NodeCase(luminaire(whole, _linked("ShaderNodeNewGeometry", "Incoming")))
    for name, more in (("", {}), (", mirrored", {"is_mirrored": True}), (", turned", {"is_turned": True})):
        yield f"towards the viewer{name}", NodeCase(luminaire(whole), has_perspective=True, **more)


LUMINAIRES: dict[str, NodeCase] = {f"IES Texture/{name}": case for name, case in _cases()}
"""By the node's name and what is special."""

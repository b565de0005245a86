"""IES files: what is read of them against closed forms, how they are named, and what is said of broken ones."""

import math

import bpy
import numpy as np
import pytest

from rgp_engine.export.fold import Folder
from rgp_engine.export.ies import IesError, read
from rgp_engine.export.nodes import Input
from rgp_engine.report import ProblemLog
from tests.blender import build

WATTS = 4.0 * math.pi / 177.83
"""Of a lamp of 1 cd to all sides."""
LAMBERT = range(0, 91, 5)
TYPE_C, TYPE_B, TYPE_A = 1, 2, 3


def ies(
    vertical, horizontal, candela, *, kind=TYPE_C, tilt="TILT=NONE", factors=(1, 1, 1), title="IESNA91\n"
):
    """The bytes of a file; `candela` of a horizontal and a vertical angle (degrees)."""
    multiplier, ballast, lamp = factors
    rows = [vertical, horizontal, *([candela(h, v) for v in vertical] for h in horizontal)]
    header = f"1 -1 {multiplier} {len(vertical)} {len(horizontal)} {kind} 2 0 0 0\n{ballast} {lamp} 50\n"
    table = "\n".join(" ".join(f"{number:.9g}" for number in row) for row in rows)
    return f"{title}{tilt}\n{header}{table}\n".encode()


def cosine(_h, v):
    return math.cos(math.radians(v))


def places(h, v):
    """A number that tells from which angles of the file it comes."""
    return 1000 + 10 * h + 0.01 * v


def test_intensities_at_the_angles_of_a_file_are_those_of_the_file():
    web = read(ies(LAMBERT, [0], cosine, factors=(100, 0.9, 0.5)))
    assert np.degrees(web.vertical) == pytest.approx(list(LAMBERT), abs=1e-5)
    assert np.degrees(web.horizontal) == pytest.approx([0, 360], abs=1e-4)
    expected = 45.0 * WATTS * np.cos(np.radians(LAMBERT))
    assert web.intensity == pytest.approx(np.array([expected, expected]), rel=1e-6, abs=1e-6)


def test_the_mean_is_the_flux_through_all_directions():
    assert read(ies([0, 90, 180], [0], lambda h, v: 3.0)).mean == pytest.approx(3.0 * WATTS, rel=1e-6)
    # The integral of a cosine over half of all directions is pi.
    assert read(ies(range(91), [0], cosine)).mean == pytest.approx(0.25 * WATTS, rel=1e-4)


@pytest.mark.parametrize(
    ("kind", "horizontal", "around", "sources"),
    [
        (TYPE_C, [0], [0, 360], [0, 0]),
        (TYPE_C, [0, 30, 90], [0, 30, 90, 150, 180, 210, 270, 330, 360], [0, 30, 90, 30, 0, 30, 90, 30, 0]),
        (TYPE_C, [0, 60, 180], [0, 60, 180, 300, 360], [0, 60, 180, 60, 0]),
        (TYPE_C, [90, 150, 270], [0, 60, 180, 300, 360], [90, 150, 270, 150, 90]),
        (TYPE_C, [0, 100, 360], [0, 100, 360], [0, 100, 360]),
        (TYPE_C, [0, 90, 180, 270], [0, 90, 180, 270, 360], [0, 90, 180, 270, 0]),
        (TYPE_C, [0, 100, 200], [0, 100, 200], [0, 100, 200]),
        (TYPE_A, [-90, 0, 45], [135, 180, 270], [45, 0, -90]),
        (TYPE_A, [0, 45, 90], [90, 135, 180, 225, 270], [90, 45, 0, 45, 90]),
    ],
)
def test_angles_that_symmetry_leaves_out_are_filled_in(kind, horizontal, around, sources):
    web = read(ies([0, 90], horizontal, places, kind=kind))
    assert np.degrees(web.horizontal) == pytest.approx(around, abs=1e-4)
    assert np.degrees(web.vertical) == pytest.approx([90, 180] if kind == TYPE_A else [0, 90], abs=1e-4)
    expected = [[places(h, v) for v in (0, 90)] for h in sources]
    assert web.intensity / WATTS == pytest.approx(np.array(expected), rel=1e-6)


def test_type_b_is_turned_on_its_axis():
    web = read(ies([-90, 0, 90], [0, 30, 90], places, kind=TYPE_B))
    assert np.degrees(web.horizontal) == pytest.approx([0, 90, 180], abs=1e-4)
    assert np.degrees(web.vertical) == pytest.approx([0, 60, 90, 120, 180], abs=1e-4)
    expected = [[places(h, v) for h in (90, 30, 0, 30, 90)] for v in (-90, 0, 90)]
    assert web.intensity / WATTS == pytest.approx(np.array(expected), rel=1e-6)


def test_every_kind_of_title_and_tilt_is_passed_over():
    plain = read(ies([0, 90], [0, 90], places))
    tilt = "TILT=INCLUDE\n1\n3\n0 90 180\n1.0 0.9 0.8"
    for file in (
        ies([0, 90], [0, 90], places, title=""),
        ies([0, 90], [0, 90], places, title="IESNA:LM-63-1995\r\n[MORE] TILT=\r\n"),
        ies([0, 90], [0, 90], places, tilt=tilt),
        ies([0, 90], [0, 90], places, tilt="TILT=lamp.tlt"),
        ies([0, 90], [0, 90], places).replace(b" ", b", ").replace(b"\n", b"\r\n"),
        ies([0, 90], [0, 90], places) + b"and what else there is",
    ):
        assert all(np.array_equal(a, b) for a, b in zip(read(file), plain))


def test_beyond_the_edges_is_what_cycles_takes():
    record = read(ies([0, 60, 180], [0, 100, 360], places)).record()
    grid = np.array(record["intensity"]).reshape(5, 5) / WATTS
    expected = [[places(h, v) for v in (60, 0, 60, 180, 180)] for h in (0, 0, 100, 360, 100)]
    assert grid == pytest.approx(np.array(expected), rel=1e-6)
    from_the_horizon = read(ies([90, 120, 180], [0], places)).record()["intensity"]
    assert np.array(from_the_horizon[:3]) / WATTS == pytest.approx([1000.9, 1000.9, 1001.2], rel=1e-6)


GOOD = ies([0, 90], [0], cosine)


@pytest.mark.parametrize(
    ("content", "why"),
    [
        (b"", 'no line that begins with "TILT="'),
        (b"\x00\xff\xfe", 'no line that begins with "TILT="'),
        (b"TILT=NONE", "ends too early"),
        (GOOD[:-14], "ends too early"),
        (GOOD.replace(b"1 -1 1", b"1 lots 1"), '"lots" is no number'),
        (GOOD.replace(b"1 -1 1", b"1 nan 1"), '"nan" is no number'),
        (GOOD.replace(b"1 -1 1 2 1 ", b"1 -1 1 999999999999 999999999999 "), "has 1e+12 vertical"),
        (GOOD.replace(b"1 -1 1 2 1 ", b"1 -1 1 1e300 1 "), "has 1e+300 vertical and 1 horizontal angles"),
        (GOOD.replace(b"1 -1 1 2 1 ", b"1 -1 1 900000 1 "), "ends too early"),
        (GOOD.replace(b"1 -1 1 2 1 ", b"1 -1 1 -2 1 "), "has -2 vertical and 1 horizontal angles"),
        (GOOD.replace(b"1 -1 1 2 1 ", b"1 -1 1 2.5 1 "), "2.5 is no whole number"),
        (GOOD.replace(b" 1 2 0 0 0", b" 4 2 0 0 0"), "photometric type is 4"),
        (GOOD.replace(b"1 -1 1 ", b"1 -1 1e300 "), "beyond all numbers"),
        (ies([90, 0], [0], cosine), "angles do not rise"),
        (ies([0, 90], [0, 1e30], cosine), "angles do not rise"),
        (GOOD.replace(b"NONE", b"INCLUDE\n1\n1e18\n"), "ends too early"),
        (GOOD + b" " * (1 << 24), "too large"),
    ],
)
def test_what_is_wrong_with_a_file_is_said(content, why):
    with pytest.raises(IesError) as found:
        read(content)
    assert why in str(found.value)


@pytest.fixture
def lamp_material(scene):
    """A material that emits as its IES Texture says, and the node."""
    b_material, b_tree, b_output = build.material("Lamp")
    b_emission, b_node = (b_tree.nodes.new(f"ShaderNode{kind}") for kind in ("Emission", "TexIES"))
    b_node.inputs["Strength"].default_value = 2.0
    build.connect(b_tree, b_node, b_emission, "Strength")
    build.connect(b_tree, b_emission, b_output, "Surface")
    return b_material, b_node


def instruction(record, op):
    return next(step for step in record["program"]["instructions"] if step["op"] == op)


def test_a_text_becomes_a_table_seen_towards_the_viewer(lamp_material, exported, problems):
    b_material, b_node = lamp_material
    b_node.ies = bpy.data.texts.new("Luminaire")
    b_node.ies.write(GOOD.decode())
    record = exported(b_material)
    assert problems() == []
    web = instruction(record, "photometric_web")
    assert web["web"] == read(GOOD).record()
    steps = record["program"]["instructions"]
    assert steps[web["vector"]] == {"op": "geometry", "quantity": "object_incoming", "aside": (0.0, 0.0)}
    assert steps[instruction(record, "math")["a"]]["value"][0] == 2.0


def test_a_file_is_found_beside_the_blend_file(lamp_material, exported, problems, tmp_path):
    b_material, b_node = lamp_material
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "lamps.blend"))
    (tmp_path / "lamp.ies").write_bytes(GOOD)
    b_node.mode, b_node.filepath = "EXTERNAL", "//lamp.ies"
    assert instruction(exported(b_material), "photometric_web")["web"] == read(GOOD).record()
    assert problems() == []


@pytest.mark.parametrize(
    ("mode", "file", "why"),
    [
        ("INTERNAL", None, "it has no text"),
        ("EXTERNAL", None, "it has no file"),
        ("EXTERNAL", "missing", 'the file "{path}" cannot be read'),
        ("EXTERNAL", "folder", 'the file "{path}" cannot be read'),
        ("EXTERNAL", b"TILT=NONE\n1 2 3", 'the file "{path}" cannot be read: it ends too early'),
        (
            "INTERNAL",
            b"hello",
            'the text "Luminaire" cannot be read: it has no line that begins with "TILT="',
        ),
    ],
)
def test_a_file_that_cannot_be_read_is_named_once(
    lamp_material, exported, problems, tmp_path, mode, file, why
):
    b_material, b_node = lamp_material
    b_node.mode = mode
    path = tmp_path / "lamp.ies"
    if file == "folder":
        path.mkdir()
    if isinstance(file, bytes):
        path.write_bytes(file)
    if mode == "EXTERNAL" and file is not None:
        b_node.filepath = str(path)
    elif isinstance(file, bytes):
        b_node.ies = bpy.data.texts.new("Luminaire")
        b_node.ies.write(file.decode())
    record = exported(b_material)
    assert instruction(record, "math")["function"] == "MULTIPLY"
    used = "an intensity of 100 is used instead, as in Cycles"
    assert problems() == [f'Lamp: node "IES Texture": {why.format(path=path)}; {used}']


@pytest.mark.parametrize(("content", "intensity"), [(GOOD, None), (b"hello", 100.0)])
def test_one_value_stands_for_it_where_one_is_asked_for(scene, content, intensity):
    b_light = bpy.data.lights.new("Spot", "SPOT")
    b_tree = build.shader_tree(b_light)
    b_emission, b_node, b_output = (
        b_tree.nodes.new(f"ShaderNode{kind}") for kind in ("Emission", "TexIES", "OutputLight")
    )
    b_node.inputs["Strength"].default_value = 2.0
    b_node.ies = bpy.data.texts.new("Luminaire")
    b_node.ies.write(content.decode())
    build.connect(b_tree, b_node, b_emission, "Strength")
    build.connect(b_tree, b_emission, b_output, "Surface")
    log = ProblemLog()
    value = Folder("Spot", log).constant_value(Input(b_emission.inputs["Strength"], ()))
    assert value == pytest.approx(2.0 * (read(content).mean if intensity is None else intensity))
    message = log.problems[0].message
    assert message.startswith('node "IES Texture": ')
    assert ("only its average" in message) == (intensity is None)

"""Scales, ticks and drawings with answers known beforehand."""

import math
import xml.etree.ElementTree as ET

import numpy as np
import pytest

from rgp_engine.plot import (
    Axis,
    Chart,
    Drawing,
    Label,
    Level,
    Series,
    Text,
    draw_chart,
    number_text,
    rasterize,
    text_width,
    to_svg,
)
from rgp_engine.plot.drawing import Box, Disc, Line
from rgp_engine.plot.raster import dashes
from rgp_engine.plot.scale import Scale, linear_ticks, log_ticks, scale_of

BLACK, WHITE, RED = (0, 0, 0), (255, 255, 255), (255, 0, 0)
SVG = "{http://www.w3.org/2000/svg}"


@pytest.mark.parametrize(
    ("low", "high", "ticks"),
    [
        (0.3, 40.0, [0.5, 1.0, 2.0, 5.0, 10.0, 20.0]),
        (1.0, 100.0, [1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0]),
        (0.5, 2e4, [1.0, 10.0, 100.0, 1e3, 1e4]),
        (6.0, 12.0, [6.0, 7.0, 8.0, 9.0, 10.0, 11.0, 12.0]),
    ],
)
def test_logarithmic_ticks(low, high, ticks):
    assert log_ticks(low, high) == pytest.approx(ticks)


@pytest.mark.parametrize(
    ("low", "high", "ticks"),
    [
        (0.0, 10.0, [0.0, 2.0, 4.0, 6.0, 8.0, 10.0]),
        (0.0, 0.3, [0.0, 0.05, 0.1, 0.15, 0.2, 0.25, 0.3]),
        (-1.0, 1.0, [-1.0, -0.5, 0.0, 0.5, 1.0]),
        (3.0, 900.0, [200.0, 400.0, 600.0, 800.0]),
    ],
)
def test_linear_ticks(low, high, ticks):
    assert linear_ticks(low, high) == pytest.approx(ticks, abs=1e-12)


def test_places_on_a_scale():
    assert [Scale(1.0, 100.0, is_log=True).place(v) for v in (1.0, 10.0, 100.0)] == pytest.approx([0, 0.5, 1])
    assert [Scale(2.0, 6.0, is_log=False).place(v) for v in (2.0, 3.0, 6.0)] == pytest.approx([0, 0.25, 1])


def test_scales_hold_their_values():
    found = scale_of([0.5, 8.0], is_log=True)
    assert (found.low * found.high, found.low < 0.5, found.high > 8.0) == (pytest.approx(4.0), True, True)
    assert scale_of([3.0], is_log=True).place(3.0) == pytest.approx(0.5)
    assert scale_of([2.0, 5.0], is_log=False).low == 0.0
    below = scale_of([-3.0, 5.0], is_log=False)
    assert below.low < -3.0
    assert below.high > 5.0


@pytest.mark.parametrize(
    ("value", "text"),
    [(0.05, "0.05"), (256, "256"), (1024, "1024"), (15625, "15.6 k"), (4_000_000, "4 M"), (2.5e9, "2.5 G")],
)
def test_numbers(value, text):
    assert number_text(value) == text


def drawn(*items, size=(20, 20), scale=1.0):
    return rasterize(Drawing(*size, WHITE, list(items)), scale).astype(float)


def darkness(pixels):
    """Pixels that are black, counting partly black ones in part."""
    return float((255.0 - pixels[..., 0]).sum() / 255.0)


def test_a_line_covers_its_width():
    pixels = drawn(Line(((5.0, 10.0), (15.0, 10.0)), BLACK, 2.0))
    assert (pixels[9:11, 6:14] == 0).all()
    assert (pixels[[8, 11], 6:14] == 255).all()
    half = drawn(Line(((5.0, 10.5), (15.0, 10.5)), BLACK, 2.0))
    assert half[10, 10, 0] == 0.0
    assert half[[9, 11], 10, 0] == pytest.approx([128, 128], abs=1)


@pytest.mark.parametrize("scale", [1.0, 2.0])
def test_a_disc_has_its_area(scale):
    area = darkness(drawn(Disc((9.3, 10.6), 6.0, BLACK), scale=scale))
    assert area == pytest.approx(math.pi * (6.0 * scale) ** 2, rel=0.01)


def test_items_are_cut_at_the_edge():
    assert darkness(drawn(Disc((0.0, 10.0), 4.0, BLACK))) == pytest.approx(math.pi * 8.0, rel=0.03)
    assert darkness(drawn(Disc((-9.0, -9.0), 4.0, BLACK), Line(((30, 3), (40, 3)), BLACK))) == 0.0
    assert darkness(drawn(Box((-5.0, -5.0), (10.0, 8.0), BLACK))) == 15.0


def test_touching_strokes_are_not_darker():
    crossed = Line(((2.0, 2.0), (18.0, 18.0), (2.0, 2.0), (18.0, 18.0)), BLACK, 1.0)
    assert np.array_equal(drawn(crossed), drawn(Line(((2.0, 2.0), (18.0, 18.0)), BLACK, 1.0)))


def test_dashes_are_half_of_a_line():
    pieces = dashes(((0.0, 0.0), (30.0, 0.0), (30.0, 10.0)), 5.0)
    assert len(pieces) == 4
    lengths = [sum(map(math.dist, piece, piece[1:])) for piece in pieces]
    assert lengths == pytest.approx([5.0] * 4)
    assert pieces[3] == ((30.0, 0.0), (30.0, 5.0))


@pytest.mark.parametrize(("anchor", "start"), [("start", 100.0), ("middle", 0.5), ("end", 0.0)])
def test_text_stands_where_it_is_anchored(anchor, start):
    width = text_width("Hello", 16.0)
    start = {"start": 100.0, "middle": 100.0 - width / 2, "end": 100.0 - width}[anchor]
    pixels = drawn(Text("Hello", (100.0, 30.0), 16.0, BLACK, anchor), size=(200, 40))
    rows, columns = np.nonzero(pixels[..., 0] < 128)
    assert columns.min() == pytest.approx(start, abs=1.5)
    assert columns.max() == pytest.approx(start + width, abs=1.5)
    assert rows.max() == pytest.approx(30.0, abs=1.5)
    assert rows.max() - rows.min() == pytest.approx(0.72 * 16.0, abs=2.0)


def test_text_upwards_is_turned():
    level = drawn(Text("Error", (30.0, 30.0), 12.0, BLACK, "middle"), size=(60, 60))
    upwards = drawn(Text("Error", (30.0, 30.0), 12.0, BLACK, "middle", upwards=True), size=(60, 60))
    assert np.abs(np.rot90(level) - upwards).max() < 2.0


def test_every_printable_letter_can_be_told():
    letters = [chr(code) for code in range(33, 127)]
    pictures = {drawn(Text(letter, (5.0, 22.0), 24.0, BLACK), size=(40, 32)).tobytes() for letter in letters}
    assert len(pictures) == len(letters)
    unknown = drawn(Text("é", (5.0, 22.0), 24.0, BLACK), size=(40, 32))
    assert darkness(unknown) > 0.0


def chart(**changed):
    points = [(0.5, 4.0), (2.0, 2.0), (20.0, 0.5)]
    series = [
        Series(points, RED, "cheap & good", 4.0, 2.0, [Label("best", points[2])]),
        Series(points, BLACK, radius=3.0),
    ]
    parts = {
        "title": "A < B",
        "x": Axis("s"),
        "y": Axis("%"),
        "series": series,
        "levels": [Level(1.0, "1 %")],
    }
    return Chart(**{**parts, **changed})


def test_svg_is_well_formed_and_complete():
    root = ET.fromstring(to_svg(draw_chart(chart(), 640, 400)))
    assert (root.tag, root.get("width"), root.get("viewBox")) == (f"{SVG}svg", "640", "0 0 640 400")
    texts = [element.text for element in root.iter(f"{SVG}text")]
    assert {"A < B", "cheap & good", "best", "s", "%", "1 %", "10"} <= set(texts)
    # Two series of three points, and one in the legend.
    assert len(list(root.iter(f"{SVG}circle"))) == 7


def test_points_stand_where_the_axes_say():
    drawing = draw_chart(chart(), 800, 500)
    ticks = {item.text: item.at for item in drawing.items if isinstance(item, Text)}
    discs = [item.center for item in drawing.items if isinstance(item, Disc)]
    assert discs[1][0] == pytest.approx(ticks["2"][0]) or discs[1][1] == pytest.approx(ticks["2"][1], abs=6)
    # 0.5 to 2 is as far as 5 to 20 on a logarithmic axis, and half as far as 20 from 2 less a quarter.
    (left, _), (middle, _), (right, _) = discs[:3]
    assert (right - middle) / (middle - left) == pytest.approx(math.log(10.0) / math.log(4.0))


def test_given_ticks_are_marked():
    drawing = draw_chart(chart(x=Axis("grid", ticks=[0.5, 4.0, 32.0])))
    texts = {item.text for item in drawing.items if isinstance(item, Text)}
    assert {"4", "32"} <= texts
    assert "10" not in texts


def test_labels_keep_off_points_and_lines():
    drawing = draw_chart(chart())
    label = next(item for item in drawing.items if isinstance(item, Text) and item.text == "best")
    width = text_width("best", label.size)
    left = label.at[0] - {"start": 0.0, "middle": 0.5, "end": 1.0}[label.anchor] * width
    for disc in (item for item in drawing.items if isinstance(item, Disc)):
        x, y = disc.center
        beside = x + disc.radius < left or left + width < x - disc.radius
        assert beside or y + disc.radius < label.at[1] - 0.72 * label.size or label.at[1] < y - disc.radius


def test_labels_stay_on_the_chart():
    points = [(0.5, 4.0), (20.0, 0.5)]
    long = "a label that is rather long"
    series = [Series(points, RED, labels=[Label(long, point) for point in points])]
    drawing = draw_chart(chart(series=series, levels=[]), 500, 300)
    labels = [item for item in drawing.items if isinstance(item, Text) and item.text == long]
    assert len(labels) == 2
    for label in labels:
        width = text_width(long, label.size)
        left = label.at[0] - {"start": 0.0, "middle": 0.5, "end": 1.0}[label.anchor] * width
        assert left >= 0.0
        assert left + width <= 500.0


def test_png_and_svg_have_the_same_shape():
    assert rasterize(draw_chart(chart(), 640, 400), 2.0).shape == (800, 1280, 3)

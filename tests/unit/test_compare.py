"""Error figures against numbers worked out by hand, and the drawing of differences."""

import json
import subprocess
import sys
import zlib
from pathlib import Path

import numpy as np
import pytest

from rgp_engine.cli import CommandError, exr
from rgp_engine.cli.compare import compare_pictures
from rgp_engine.cli.difference import draw_difference

ROOT = Path(__file__).resolve().parents[2]


def constant(value, height=4, width=6):
    return np.full((height, width, 3), value, np.float32)


@pytest.mark.parametrize("share", [0.9, 0.5, 0.05])
def test_half_a_picture_is_none(tmp_path, share):
    """What a full disk leaves of a file."""
    path = tmp_path / "picture.exr"
    exr.write(path, np.random.default_rng(1).random((64, 64, 3), np.float32))
    path.write_bytes(path.read_bytes()[: int(share * path.stat().st_size)])
    with pytest.raises(CommandError, match=r"picture\.exr is not whole"):
        exr.read_channels(path)


def test_equal_pictures_have_no_error():
    picture = np.random.default_rng(1).random((4, 6, 3), np.float32)
    found = compare_pictures(picture, picture)
    assert (found.rms_peak, found.rms_mean, found.relmse, found.bias, found.nonfinite) == (0, 0, 0, 0, 0)


def test_constant_offset():
    """0.55 against 0.5 with one pixel of 2: error 0.05 everywhere."""
    reference = constant(0.5)
    reference[0, 0, 1] = 2.0
    found = compare_pictures(reference + np.float32(0.05), reference)
    mean = (0.5 * 71 + 2.0) / 72
    assert found.rms_peak == pytest.approx(100 * 0.05 / 2.0, rel=1e-5)
    assert found.rms_mean == pytest.approx(100 * 0.05 / mean, rel=1e-5)
    assert found.bias == pytest.approx(100 * 0.05 / mean, rel=1e-5)
    floor = 0.01 * mean**2
    relmse = 0.05**2 * (71 / (0.25 + floor) + 1 / (4 + floor)) / 72
    assert found.relmse == pytest.approx(relmse, rel=1e-5)


def test_clipped_pictures_do_not_know_lamps():
    """Nine pixels of 1 and a lamp of 91: the mean is 10, the lamp is clipped at 80."""
    reference = constant(1.0, 2, 5)
    reference[1, 2] = 91.0
    picture = reference + np.float32(0.5)
    picture[1, 2] = 1000.0
    found = compare_pictures(picture, reference)
    assert found.rms_clipped == pytest.approx(100 * np.sqrt(0.9 * 0.25) / 8.9, rel=1e-5)
    assert found.rms_mean > 1000.0


def test_errors_that_cancel_are_no_bias():
    reference = constant(1.0)
    picture = reference.copy()
    picture[::2] += 0.5
    picture[1::2] -= 0.5
    found = compare_pictures(picture, reference)
    assert found.rms_mean == pytest.approx(50.0)
    assert found.bias == pytest.approx(0.0, abs=1e-5)


def test_darker_pictures_have_negative_bias():
    assert compare_pictures(constant(0.9), constant(1.0)).bias == pytest.approx(-10.0, rel=1e-5)


def test_pixels_that_are_not_finite_are_counted_and_left_out():
    picture, reference = constant(1.0), constant(1.0)
    picture[0, 0, 0], picture[1, 1] = np.nan, np.inf
    reference[2, 2, 2] = np.nan
    found = compare_pictures(picture, reference)
    assert found.nonfinite == 3
    assert found.rms_mean == 0.0


@pytest.mark.parametrize(
    ("picture", "reference", "message"),
    [
        (constant(1.0), constant(1.0, 5), "differ in size: 6 x 4 and 6 x 5 pixels"),
        (constant(1.0), constant(0.0), "the reference is black"),
        (constant(np.nan), constant(1.0), "no pixel"),
    ],
)
def test_what_cannot_be_compared(picture, reference, message):
    with pytest.raises(CommandError, match=message):
        compare_pictures(picture, reference)


def test_exr_round_trip(tmp_path):
    picture = np.random.default_rng(2).random((5, 7, 3), np.float32)
    exr.write(tmp_path / "rgb.exr", picture)
    assert np.array_equal(exr.read(tmp_path / "rgb.exr"), picture)
    with_alpha = np.concatenate([picture, np.ones((5, 7, 1), np.float32)], axis=2)
    exr.write(tmp_path / "rgba.exr", with_alpha)
    assert np.array_equal(exr.read(tmp_path / "rgba.exr"), picture)


def test_files_that_cannot_be_read_or_written(tmp_path):
    with pytest.raises(CommandError, match=r"none\.exr does not exist"):
        exr.read(tmp_path / "none.exr")
    (tmp_path / "text.exr").write_text("no picture")
    with pytest.raises(CommandError, match="cannot be read as OpenEXR"):
        exr.read(tmp_path / "text.exr")
    with pytest.raises(CommandError, match="cannot be written"):
        exr.write(tmp_path / "none" / "a.exr", constant(1.0))


def decode_png(path):
    """Pixels of an 8-bit RGB PNG without row filters."""
    content = path.read_bytes()
    width, height = (int.from_bytes(content[i : i + 4], "big") for i in (16, 20))
    start = content.index(b"IDAT") + 4
    length = int.from_bytes(content[start - 8 : start - 4], "big")
    rows = np.frombuffer(zlib.decompress(content[start : start + length]), np.uint8).reshape(height, -1)
    assert (rows[:, 0] == 0).all()
    return rows[:, 1:].reshape(height, width, 3)


def test_difference_is_drawn_in_color(tmp_path):
    reference = constant(0.5, 60, 80)
    picture = reference.copy()
    picture[:, :40] = 0.6
    picture[:, 40:] = 0.4
    draw_difference(tmp_path / "d.png", picture, reference)
    drawn = decode_png(tmp_path / "d.png").astype(int)
    panel = drawn[30:50, -80:]
    brighter, darker = panel[5, 10], panel[5, 70]
    assert brighter[0] > brighter[2] + 50, "red where A is brighter"
    assert darker[2] > darker[0] + 50, "blue where A is darker"


def test_equal_pictures_differ_in_black(tmp_path):
    draw_difference(tmp_path / "d.png", constant(0.5, 60, 80), constant(0.5, 60, 80))
    assert (decode_png(tmp_path / "d.png")[30:50, -80:] == 0).all()


def test_small_and_broken_pictures_are_drawn(tmp_path):
    picture = constant(np.nan, 1, 1)
    draw_difference(tmp_path / "d.png", picture, constant(1.0, 1, 1))
    assert decode_png(tmp_path / "d.png").size > 0


def run(*arguments):
    command = [sys.executable, "-m", "rgp_engine", "compare", *map(str, arguments)]
    return subprocess.run(command, cwd=ROOT, check=False, capture_output=True, text=True)


def test_command(tmp_path):
    a, b, png = tmp_path / "a.exr", tmp_path / "b.exr", tmp_path / "d.png"
    exr.write(a, constant(1.1))
    exr.write(b, constant(1.0))
    result = run(a, b, "--png", png)
    assert result.returncode == 0, result.stderr
    assert [line.split()[0] for line in result.stdout.splitlines()] == [
        "rms_peak",
        "rms_mean",
        "rms_clipped",
        "relmse",
        "bias",
        "nonfinite",
    ]
    assert png.stat().st_size > 100
    found = json.loads(run(a, b, "--json").stdout)
    assert found["rms_mean"] == pytest.approx(10.0, rel=1e-5)
    assert found["bias"] == pytest.approx(10.0, rel=1e-5)


def test_command_errors(tmp_path):
    exr.write(tmp_path / "a.exr", constant(1.0))
    result = run(tmp_path / "a.exr", tmp_path / "none.exr")
    assert result.returncode == 1
    assert result.stderr.startswith("error: ")
    assert run(tmp_path / "a.exr").returncode == 2

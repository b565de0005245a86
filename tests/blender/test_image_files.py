"""Image sequences and UDIM tiles: which file is shown, and that it is read."""

from types import SimpleNamespace

import bpy
import numpy as np
import pytest

from rgp_engine.export.image_file import opened, sequence_file, sequence_frame, tile_files


def user(*, duration=4, start=1, offset=0, cyclic=False):
    return SimpleNamespace(frame_duration=duration, frame_start=start, frame_offset=offset, use_cyclic=cyclic)


@pytest.mark.parametrize(
    ("settings", "frames"),
    [
        (user(), {-5: 0, 0: 0, 1: 1, 3: 3, 4: 4, 9: 4}),
        (user(start=3, offset=10), {2: 10, 3: 11, 5: 13, 50: 14}),
        (user(cyclic=True), {-1: 3, 0: 4, 1: 1, 4: 4, 5: 1, 10: 2}),
    ],
)
def test_the_frame_of_a_sequence_is_counted_as_in_blender(settings, frames):
    assert {frame: sequence_frame(settings, frame) for frame in frames} == frames


@pytest.mark.parametrize(
    ("path", "expected"),
    [
        ("/shots/take2/smoke_0001.png", "/shots/take2/smoke_0017.png"),
        ("/shots/7.exr", "/shots/17.exr"),
        ("/shots/fire01_mask.png", "/shots/fire17_mask.png"),
        ("/shots/still.png", "/shots/still.png"),
    ],
)
def test_the_last_number_of_a_file_name_counts(path, expected):
    assert sequence_file(SimpleNamespace(filepath=path, library=None), 17) == expected


@pytest.mark.parametrize("token", ["<UDIM>", "<UVTILE>"])
def test_tiles_have_a_place_and_a_file(token):
    tiles = [SimpleNamespace(number=number) for number in (1001, 1003, 1022)]
    found = tile_files(SimpleNamespace(filepath=f"/bark.{token}.png", library=None, tiles=tiles))
    assert [place[:2] for place in found] == [(0, 0), (2, 0), (1, 2)]
    last = "/bark.1022.png" if token == "<UDIM>" else "/bark.u2_v3.png"
    assert found[-1][2] == last


def test_a_file_is_read_as_its_image_and_leaves_nothing_behind(tmp_path):
    b_image = bpy.data.images.new("Made", 2, 2)
    b_image.pixels.foreach_set(np.tile(np.array([0.2, 0.2, 0.2, 1.0], np.float32), 4))
    b_image.filepath_raw, b_image.file_format = str(tmp_path / "made.png"), "PNG"
    b_image.save()
    b_image.colorspace_settings.name = "Non-Color"
    before = set(bpy.data.images.keys())
    with opened(b_image, str(tmp_path / "made.png")) as b_file:
        assert b_file.colorspace_settings.name == "Non-Color"
        assert b_file.pixels[0] == pytest.approx(0.2, abs=1e-6)
    with opened(b_image, str(tmp_path / "missing.png")) as b_file:
        assert b_file is None
    assert set(bpy.data.images.keys()) == before


def test_packed_tiles_need_no_files(tmp_path):
    for number, shade in ((1001, 0.2), (1002, 0.6)):
        b_image = bpy.data.images.new("Made", 2, 2)
        b_image.pixels.foreach_set(np.tile(np.array([shade, shade, shade, 1.0], np.float32), 4))
        b_image.filepath_raw, b_image.file_format = str(tmp_path / f"bark.{number}.png"), "PNG"
        b_image.save()
    b_tiled = bpy.data.images.load(str(tmp_path / "bark.1001.png"))
    b_tiled.source, b_tiled.filepath = "TILED", str(tmp_path / "bark.<UDIM>.png")
    b_tiled.reload()
    b_tiled.pack()
    for file in tmp_path.iterdir():
        file.unlink()
    shades = []
    for _, _, path in tile_files(b_tiled):
        with opened(b_tiled, path) as b_file:
            shades.append(b_file.pixels[0])
    assert shades == pytest.approx([0.2, 0.6], abs=1e-6)
    assert not any(tmp_path.iterdir())

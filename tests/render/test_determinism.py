"""The picture is the same to the last bit, however the work is divided."""

from pathlib import Path

import numpy as np
import pytest

from rgp_engine.__main__ import main
from scenes import common
from tests.render import pictures

SETTINGS = (
    "--resolution", "50x40", "--set", "photon_pass.photon_count=50000", "--set", "gather.rays=32",
    "--set", "gather.camera_samples=4", "--set", "pyramid.bins=4x8",
)  # fmt: skip


def render(scene: str, folder: Path, *arguments: str) -> dict[str, object]:
    """Channels of what the command line writes."""
    path = folder / "picture.exr"
    path.unlink(missing_ok=True)
    blend = common.SCENES / f"{scene}.blend"
    assert main(["render", str(blend), "-o", str(path), *SETTINGS, *arguments]) == 0
    return pictures.read_channels(path)


def are_identical(first: dict[str, object], second: dict[str, object]) -> bool:
    return first.keys() == second.keys() and all(np.array_equal(first[name], second[name]) for name in first)


@pytest.mark.parametrize("scene", ["cornell_box", "glossy_cornell"])
def test_picture_does_not_depend_on_threads_and_tiles(scene: str, tmp_path: Path) -> None:
    expected = render(scene, tmp_path, "--threads", "1")
    for threads, tile_size in (("1", 64), ("2", 16), ("7", 4), ("7", 64), ("2", 36)):
        found = render(scene, tmp_path, "--threads", threads, "--set", f"film.tile_size={tile_size}")
        assert are_identical(found, expected), f"{threads} threads, tiles of {tile_size}"


def test_another_seed_gives_another_picture(tmp_path: Path) -> None:
    assert not are_identical(render("cornell_box", tmp_path), render("cornell_box", tmp_path, "--seed", "1"))

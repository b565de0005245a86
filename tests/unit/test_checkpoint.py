"""The file that keeps an unfinished picture."""

import numpy as np
import pytest

from rgp_engine.checkpoint import Checkpoint
from rgp_engine.report import UserError

SUMS = np.arange(2 * 3 * 4 * 9, dtype=np.float32).reshape(2, 3, 4, 9)


def test_what_is_written_is_read(tmp_path):
    checkpoint = Checkpoint(tmp_path / "night.rgp", "abc")
    assert checkpoint.read() is None
    checkpoint.write(1, SUMS)
    checkpoint.write(7, 2 * SUMS)
    passes, sums = checkpoint.read()
    assert passes == 7
    assert np.array_equal(sums, 2 * SUMS)
    assert [path.name for path in tmp_path.iterdir()] == ["night.rgp"]
    checkpoint.remove()
    assert checkpoint.read() is None


def test_another_picture_is_left_alone(tmp_path):
    path = tmp_path / "night.rgp"
    Checkpoint(path, "abc").write(1, SUMS)
    with pytest.raises(UserError, match="is of another picture"):
        Checkpoint(path, "abd").read()
    assert Checkpoint(path, "abc").read() is not None


@pytest.mark.parametrize("cut", [0, 1, 100, -1, -30])
def test_a_broken_file_is_named(tmp_path, cut):
    path = tmp_path / "night.rgp"
    Checkpoint(path, "abc").write(1, SUMS)
    path.write_bytes(path.read_bytes()[:cut])
    with pytest.raises(UserError, match="is no checkpoint"):
        Checkpoint(path, "abc").read()


def test_a_file_of_something_else_is_named(tmp_path):
    path = tmp_path / "night.rgp"
    path.write_bytes(b"BLENDER-v300")
    with pytest.raises(UserError, match="is no checkpoint"):
        Checkpoint(path, "abc").read()
    with path.open("wb") as file:
        np.savez(file, other=SUMS)
    with pytest.raises(UserError, match="is no checkpoint"):
        Checkpoint(path, "abc").read()


def test_folders_are_checked_before_the_render(tmp_path):
    with pytest.raises(UserError, match="there is no such folder"):
        Checkpoint(tmp_path / "missing/night.rgp", "abc").read()
    with pytest.raises(UserError, match="cannot be read"):
        Checkpoint(tmp_path, "abc").read()

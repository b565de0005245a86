"""A render that is stopped and goes on later."""

from pathlib import Path

import bpy
import numpy as np
import OpenEXR
import pytest

from rgp_engine import session
from rgp_engine.checkpoint import Checkpoint
from tests.blender import build


@pytest.fixture
def room(scene, tmp_path):
    """A lit room whose view layer keeps unfinished pictures; rendered in 8 passes."""
    build.lit_room()
    scene.rgp.gather.rays, scene.rgp.gather.camera_samples = 16, 8
    scene.view_layers[0].rgp.checkpoint = str(tmp_path / "room.rgp")
    return scene


def picture(b_scene, folder: Path):
    b_settings = b_scene.render.image_settings
    b_settings.file_format, b_settings.color_depth = "OPEN_EXR", "32"
    b_scene.render.filepath = str(folder / "picture.exr")
    bpy.ops.render.render(write_still=True)
    with OpenEXR.File(b_scene.render.filepath) as file:
        channels = file.channels()
        return np.array(channels["RGBA" if "RGBA" in channels else "RGB"].pixels)


def stop_early(monkeypatch):
    """Esc once there are two passes."""

    def stopped(self, core_session, _b_result, checkpoint):
        while core_session.progress()["passes_done"] < 2:
            assert not core_session.wait(0.001), "the render was faster than Esc"
        self._keep(core_session, checkpoint)
        core_session.cancel()

    monkeypatch.setattr(session.RenderSession, "_watch", stopped)


def test_it_goes_on_and_ends_with_the_same_bits(room, tmp_path, monkeypatch, outcome):
    room.render.resolution_x, room.render.resolution_y = 320, 240
    whole = picture(room, tmp_path)
    assert not (tmp_path / "room.rgp").exists(), "nothing is kept of a picture that is finished"
    with monkeypatch.context() as patch:
        stop_early(patch)
        picture(room, tmp_path)
    assert outcome().cancelled
    assert (tmp_path / "room.rgp").is_file()
    assert np.array_equal(picture(room, tmp_path), whole)
    assert not outcome().cancelled
    assert outcome().stats["passes"] == 8
    assert not (tmp_path / "room.rgp").exists()


def test_a_time_limit_leaves_a_checkpoint(room, tmp_path, outcome):
    whole = picture(room, tmp_path)
    rays = outcome().stats["rays"]["camera"]
    room.rgp.gather.time_limit = 1e-3
    picture(room, tmp_path)
    assert outcome().stats["passes"] == 2
    room.rgp.gather.time_limit = 0.0
    assert np.array_equal(picture(room, tmp_path), whole)
    assert outcome().stats["rays"]["camera"] == rays * 6 // 8, "what is there is not traced again"


def test_the_passes_are_kept_while_it_renders(room, tmp_path, monkeypatch):
    """Whoever is killed has what was kept last."""
    kept = []
    monkeypatch.setattr(Checkpoint, "write", lambda _self, passes, _sums: kept.append(passes))
    monkeypatch.setattr(session, "_CHECKPOINT_SECONDS", 0.0)
    monkeypatch.setattr(session, "_STATUS_SECONDS", 0.0)
    monkeypatch.setattr(session, "_POLL_SECONDS", 0.001)
    room.render.resolution_x, room.render.resolution_y = 320, 240
    picture(room, tmp_path)
    assert kept == sorted(kept)
    assert 0 < max(kept) <= 8


def test_a_changed_scene_is_not_mixed_with_what_was_kept(room, tmp_path, outcome):
    room.rgp.gather.time_limit = 1e-3
    picture(room, tmp_path)
    bpy.data.objects["Floor"].location.z += 0.1
    with pytest.raises(RuntimeError, match="is of another picture"):
        bpy.ops.render.render()
    assert "room.rgp is of another picture" in outcome().error
    assert (tmp_path / "room.rgp").is_file()


def test_a_full_disk_costs_the_checkpoint_and_not_the_picture(room, tmp_path, monkeypatch, outcome):
    def full(_self, _passes, _sums):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(Checkpoint, "write", full)
    room.rgp.gather.time_limit = 1e-3
    assert np.isfinite(picture(room, tmp_path)).all()
    assert outcome().error == ""
    messages = [problem.message for problem in outcome().problems]
    assert "the checkpoint cannot be written: No space left on device" in messages

"""A render watched from Python."""

import time

import numpy as np
import pytest
import rgp_core

from tests.native.conftest import SETTINGS

SLOW = {"photon_pass": {"photon_count": 100_000_000}, "gather": {"rays": 4096, "camera_samples": 256}}


def rendered(scene, embree, settings=SETTINGS):
    session = rgp_core.Session(scene, settings, embree)
    session.start()
    assert session.wait(60.0)
    assert session.finish()
    return session


def test_picture_shapes_and_finite_values(room, embree):
    session = rendered(room.finish(), embree)
    combined, indirect = session.picture("combined"), session.picture("indirect")
    assert combined.shape == (20, 30, 4)
    assert indirect.shape == (20, 30, 3)
    assert combined.dtype == indirect.dtype == np.float32
    assert combined.flags["C_CONTIGUOUS"]
    assert np.isfinite(combined).all()
    assert combined[..., :3].min() > 0.0
    assert combined[..., 3] == pytest.approx(1.0)


def test_light_straight_below_the_lamp(room, embree):
    """Irradiance P / (4 pi d^2), radiance albedo / pi of it; a flat floor lights nothing else."""
    session = rendered(room.finish(), embree)
    center = session.picture("combined")[9:11, 14:16, 0].mean()
    assert center == pytest.approx(0.5 / np.pi * 100.0 / (4 * np.pi * 9.0), rel=0.01)
    assert session.picture("indirect").max() == 0.0


def test_rows_start_at_the_bottom(room, embree):
    room.matrix[1, 3] = 2.5
    picture = rendered(room.finish(), embree).picture("combined")
    assert picture[0, 15, 0] == 0.0
    assert picture[19, 15, 0] > 0.0


def test_region(room, embree):
    full = rendered(room.finish(), embree).picture("combined")
    part_room = type(room)()
    part_room.camera["region"] = [10, 5, 8, 6]
    part = rendered(part_room.finish(), embree).picture("combined")
    assert part.shape == (6, 8, 4)
    assert part == pytest.approx(full[5:11, 10:18], rel=0.05)


def test_world_alone(room, embree):
    room.world["radiance"] = [0.5, 0.25, 1.0]
    room.matrix[0, 3] = 100.0
    picture = rendered(room.finish(), embree).picture("combined")
    assert picture == pytest.approx(np.broadcast_to([0.5, 0.25, 1.0, 1.0], picture.shape))


def test_transparent_film(room, embree):
    room.world.update(radiance=[1.0] * 3, film_transparent=True)
    room.matrix[0, 3] = 100.0
    assert (rendered(room.finish(), embree).picture("combined")[..., 3] == 0.0).all()


def test_a_scene_renders_any_number_of_times(room, embree):
    scene = room.finish()
    first, second = (rendered(scene, embree).picture("combined") for _ in range(2))
    assert np.array_equal(first, second)


@pytest.mark.parametrize("threads", [1, 2, 7])
def test_threads_and_tiles_change_nothing(room, embree, threads):
    scene = room.finish()
    expected = rendered(scene, embree).picture("combined")
    settings = {**SETTINGS, "render": {"threads": threads}, "film": {"tile_size": 4 * threads}}
    assert np.array_equal(rendered(scene, embree, settings).picture("combined"), expected)


def test_another_seed_is_another_picture(room, embree):
    scene = room.finish()
    settings = {**SETTINGS, "render": {"seed": 1}}
    first, second = rendered(scene, embree), rendered(scene, embree, settings)
    assert not np.array_equal(first.picture("combined"), second.picture("combined"))


def test_progress_and_stats(room, embree):
    session = rendered(room.finish(), embree)
    progress = session.progress()
    assert progress["passes_done"] == progress["passes_total"] > 0
    assert progress["seconds_elapsed"] > 0.0
    assert progress["memory_bytes"] > 1 << 20
    stats = session.stats()
    assert stats["seconds"]["total"] > 0.0
    assert stats["photons"]["emitted"] == 2000
    assert stats["rays"]["camera"] >= 30 * 20 * 4
    assert stats["settings"]["gather"]["rays"] == 16


@pytest.mark.parametrize("after", [0.0, 0.05, 0.5, 1.5])
def test_cancel_at_any_moment(room, embree, after):
    session = rgp_core.Session(room.finish(), SLOW, embree)
    session.start()
    assert not session.wait(after)
    pressed = time.monotonic()
    session.cancel()
    assert session.wait(10.0)
    assert not session.finish()
    assert time.monotonic() - pressed < 0.4
    assert np.isfinite(session.picture("combined")).all()


def test_waiting_lets_other_threads_run(room, embree):
    """wait() gives the GIL away: a Python thread counts meanwhile."""
    import threading

    session = rgp_core.Session(room.finish(), SLOW, embree)
    session.start()
    counted = []
    stop = threading.Event()

    def count():
        while not stop.is_set():
            counted.append(1)
            time.sleep(0.001)

    thread = threading.Thread(target=count)
    thread.start()
    session.wait(0.5)
    stop.set()
    thread.join()
    session.cancel()
    session.finish()
    assert len(counted) > 20


def test_a_session_that_is_dropped_stops(room, embree):
    session = rgp_core.Session(room.finish(), SLOW, embree)
    session.start()
    time.sleep(0.1)
    start = time.monotonic()
    del session
    assert time.monotonic() - start < 1.0


def test_misuse_is_refused(room, embree):
    scene = room.finish()
    with pytest.raises(rgp_core.SettingsError):
        rgp_core.Session(scene, {"gather": {"rays": 0}}, embree)
    session = rgp_core.Session(scene, SETTINGS, embree)
    with pytest.raises(rgp_core.RenderError):
        session.finish()
    session.start()
    with pytest.raises(rgp_core.RenderError):
        session.start()
    with pytest.raises(ValueError, match="combined"):
        session.picture("depth")
    session.wait(60.0)
    session.finish()


def test_embree_that_is_none(room, tmp_path):
    with pytest.raises(rgp_core.EmbreeError):
        rgp_core.embree_version(str(tmp_path / "none.so"))
    session = rgp_core.Session(room.finish(), SETTINGS, str(tmp_path / "none.so"))
    session.start()
    session.wait(60.0)
    with pytest.raises(rgp_core.EmbreeError):
        session.finish()


def test_embree_version(embree):
    assert rgp_core.embree_version(embree).startswith("4.")


def test_the_fingerprint_is_that_of_the_picture(room, embree):
    """It stays where only the way to the picture changes, and changes with anything that is seen in it."""

    def fingerprint(scene, **groups):
        return rgp_core.Session(scene, {**SETTINGS, **groups}, embree).fingerprint()

    scene = room.finish()
    same = fingerprint(scene)
    assert fingerprint(scene, render={"threads": 3}, film={"tile_size": 8}) == same
    assert fingerprint(scene, gather={**SETTINGS["gather"], "audit": 7, "time_limit": 5.0}) == same
    assert fingerprint(type(room)().finish()) == same
    others = [fingerprint(scene, render={"seed": 1}), fingerprint(scene, film={"exposure": 2.0})]
    for change in (
        lambda other: other.positions.__setitem__((2, 0), np.nextafter(np.float32(2), np.float32(3))),
        lambda other: other.material["closures"][0]["closure"].update(color=[0.5, 0.5, 0.500001]),
        lambda other: other.lamp.update(power=[100.0, 100.0, 100.1]),
        lambda other: other.camera.update(clip=[0.1, 101.0]),
        lambda other: other.world.update(film_transparent=True),
    ):
        other = type(room)()
        change(other)
        others.append(fingerprint(other.finish()))
    assert len({same, *others}) == 1 + len(others)


def test_only_a_film_of_the_same_size_is_taken_up(room, embree):
    session = rgp_core.Session(room.finish(), SETTINGS, embree)
    passes, sums = session.film_state()
    assert (passes, sums.shape[:3]) == (0, (2, 20, 30))
    for wrong in (sums[:1], sums[:, :10], sums[..., :4], sums.swapaxes(1, 2)):
        with pytest.raises(rgp_core.RenderError, match="another size"):
            session.restore_film(2, wrong)
    session.restore_film(passes, sums)
    session.start()
    session.finish()
    with pytest.raises(rgp_core.RenderError, match="started already"):
        session.restore_film(passes, sums)

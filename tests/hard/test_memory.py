"""The memory limit: what would pass it is refused before it is taken, or made coarser and said so."""

import re

import pytest
import rgp_core

from rgp_engine import native
from tests.hard.scenes import ball, furnace, glowing, moved, settings

GROUP = "Memory"


def memory_of(session) -> int:
    return session.progress()["memory_bytes"]


def refused(scene, **values) -> str:
    with pytest.raises(rgp_core.RenderError, match="memory") as error:
        rgp_core.Session(scene.builder.finish(), settings(**values), str(native.embree_library()))
    return str(error.value)


def test_a_picture_too_large_is_refused(check):
    """Before a byte of it is taken: 65,536² pixels would be more than any machine has."""
    small = furnace().builder.finish()
    session = rgp_core.Session(small, settings(), str(native.embree_library()))
    before = memory_of(session)
    scene = furnace()
    scene.look((-0.8, -0.5, 0.2), (1.0, 0.6, 0.6), 1.5, pixels=(65536, 65536))
    message = refused(scene, render__memory_limit=1000)
    assert re.search(r"65536 x 65536 pixels would take \d+ MiB of memory, of 1000 MiB allowed", message)
    grown = memory_of(session) / before
    check("picture of 65,536² pixels refused: memory after it", expected=1.0, got=grown, bound=0.02)


def test_too_many_triangles_are_refused():
    scene = furnace()
    scene.add(ball(6, 0.3), glowing(0.5), moved(0, 0, 0.6))
    assert "triangles" in refused(scene, render__memory_limit=2)


@pytest.mark.parametrize("limit", [8, 30])
def test_cells_become_coarser(check, limit):
    values = settings(
        pyramid__finest_resolution=512, photon_pass__photon_count=400_000, render__memory_limit=limit
    )
    picture = furnace().render(values)
    assert picture.stats["warnings"], "nothing was said"
    assert "512" in picture.stats["warnings"][0]
    check(f"512 cells in {limit} MiB: the room", expected=2.0, got=picture.mean, bound=0.01)
    over = max(0.0, picture.stats["pyramid"]["build_bytes"] / 2**20 - limit)
    check(f"512 cells in {limit} MiB: MiB over the limit", expected=0.0, got=over, bound=0.0)


def test_no_limit_warns_of_nothing():
    assert furnace().render().stats["warnings"] == []


def test_the_machines_memory_is_known():
    assert 500 < native.memory_allowed() < 10**8

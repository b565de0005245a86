"""The parts of a mesh that hang together, and their random numbers."""

from rgp_engine.export.islands import island_numbers, island_roots
from tests.blender import build


def test_the_vertex_that_stands_for_an_island_follows_from_the_order_of_edges():
    assert island_roots(3, []) == [0, 1, 2]
    assert island_roots(5, [[1, 0], [3, 4]]) == [1, 1, 2, 3, 3]
    # A single vertex joins the larger island; of equal ones that of the edge's first end stays.
    assert island_roots(3, [[1, 0], [2, 1]]) == [1, 1, 1]
    assert island_roots(4, [[0, 1], [3, 2], [2, 0]]) == [3, 3, 3, 3]


def test_islands_share_a_number():
    corners = [(x, y, 0.0) for low in (0.0, 2.0) for x, y in ((low, 0), (low + 1, 0), (low + 1, 1), (low, 1))]
    numbers = island_numbers(build.mesh("Halves", corners, [(0, 1, 2, 3), (4, 5, 6, 7)]))
    assert len(set(numbers[:4])) == len(set(numbers[4:])) == 1
    assert numbers[0] != numbers[4]

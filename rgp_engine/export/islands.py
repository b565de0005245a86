"""Random numbers of the parts of a mesh that hang together, the same ones as in Cycles."""

from typing import Any

import numpy as np
import numpy.typing as npt

from .hashing import unit_hash


def island_numbers(b_mesh: Any) -> npt.NDArray[np.float32]:
    """For each vertex a number from 0 to 1 that all vertices have in common which edges connect."""
    edges = np.empty((len(b_mesh.edges), 2), np.int32)
    b_mesh.edges.foreach_get("vertices", edges.reshape(-1))
    roots = np.array(island_roots(len(b_mesh.vertices), edges.tolist()), np.uint32)
    return unit_hash(roots)


def island_roots(count: int, edges: list[list[int]]) -> list[int]:
    """For each vertex the one that stands for its island.

    Which one that is decides the random number, so that edges are joined in their order, and by rank (Tarjan 1975,
    "Efficiency of a Good But Not Linear Set Union Algorithm").
    """
    parents, ranks = list(range(count)), [0] * count

    def root_of(vertex: int) -> int:
        while parents[vertex] != vertex:
            parents[vertex] = vertex = parents[parents[vertex]]
        return vertex

    for a, b in edges:
        high, low = root_of(a), root_of(b)
        if high == low:
            continue
        if ranks[high] < ranks[low]:
            high, low = low, high
        parents[low] = high
        ranks[high] += ranks[high] == ranks[low]
    return [root_of(vertex) for vertex in range(count)]

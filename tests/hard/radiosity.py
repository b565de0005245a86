"""Light between flat faces under a sky of radiance 1, by collocation: the truth for corners whose planes end somewhere.

Faces are parallelograms that see each other whole. Each is cut into parts that shrink towards its first corner, where
the light is wanted; a part has one radiosity, and what of it arrives at a point is Lambert's sum over its edges.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tests.hard.scenes import Array


@dataclass(frozen=True)
class Face:
    """The parallelogram of two edges from a corner (m); its front is where their cross product points."""

    corner: Array
    along: Array
    across: Array
    """The first edges of wedges: what lies along it differs little."""

    @property
    def normal(self) -> Array:
        normal = np.cross(self.along, self.across)
        return normal / np.linalg.norm(normal)

    def outline(self) -> Array:
        """Its four corners, counter-clockwise from the front."""
        return self.corner + np.stack([0.0 * self.along, self.along, self.along + self.across, self.across])

    def parts(self, along: Array, across: Array) -> Array:
        """Outlines of the parts between these fractions of its edges; (parts, 4, 3)."""
        a, b = np.meshgrid(np.arange(len(along) - 1), np.arange(len(across) - 1), indexing="ij")
        corners = [(a, b), (a + 1, b), (a + 1, b + 1), (a, b + 1)]
        outline = [along[i][..., None] * self.along + across[j][..., None] * self.across for i, j in corners]
        return self.corner + np.stack(outline, axis=2).reshape(-1, 4, 3)


def shrinking(least: float, count: int) -> Array:
    """Cuts of 0 to 1 that come closer by an equal ratio towards 0; the first is `least` wide."""
    return np.concatenate([[0.0], np.geomspace(least, 1.0, count)])


def seen(points: Array, normal: Array, outlines: Array) -> Array:
    """The shares of what points of one normal see that polygons in front of them fill; (points, polygons)."""
    shares = np.zeros((len(points), len(outlines)))
    for i in range(outlines.shape[1]):
        a = outlines[None, :, i] - points[:, None]
        b = outlines[None, :, (i + 1) % outlines.shape[1]] - points[:, None]
        cross = np.cross(a, b)
        sine = np.linalg.norm(cross, axis=-1)
        angle = np.arctan2(sine, (a * b).sum(axis=-1))
        shares += angle * (cross @ normal) / np.where(sine > 0.0, sine, 1.0)
    return np.abs(shares) / (2.0 * np.pi)


def scattered_twice(
    faces: list[Face], albedo: float, cuts: tuple[Array, Array], points: Array, on: int = 0
) -> Array:
    """Radiance of `points` on face number `on`, of light that was scattered twice or more."""
    outlines = [face.parts(*cuts) for face in faces]
    count = len(outlines[0])
    transport = np.zeros((len(faces) * count,) * 2)
    for i, face in enumerate(faces):
        for j in (j for j in range(len(faces)) if j != i):
            block = seen(outlines[i].mean(axis=1), face.normal, outlines[j])
            transport[i * count : (i + 1) * count, j * count : (j + 1) * count] = block
    sky = albedo * (1.0 - transport.sum(axis=1))
    light = np.linalg.solve(np.eye(len(sky)) - albedo * transport, sky).reshape(len(faces), count)
    others = [j for j in range(len(faces)) if j != on]
    return albedo * sum(seen(points, faces[on].normal, outlines[j]) @ light[j] for j in others)

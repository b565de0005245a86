"""What the paper measured, and what this engine is to reach.

Yue, Iwasaki, Nishita: Radiance Grid Pyramid. Pentium D 3.0 GHz, one processor, 256 gather rays per pixel, a grid of
128³ and 8 × 16 direction bins unless a table varies them. Errors in percent of the brightest pixel, against a photon
map in the same final gather. Times in seconds, memory in bytes.
"""

from dataclasses import dataclass

RAYS = 256
FINEST = 128
FINER = 2 * FINEST
BINS = "8x16"
BYTES_PER_PHOTON = 28


@dataclass(frozen=True)
class Published:
    """One scene in the paper's tables."""

    name: str
    size: tuple[int, int]
    """Pixels."""
    rms_by_bins: dict[str, float]
    """Table 1 (%)."""
    rms_by_finest: dict[int, float]
    """Table 2 (%)."""
    photon_map_seconds: float
    pyramid_seconds: float
    photon_map_bytes: float
    pyramid_bytes: float

    @property
    def speedup(self) -> float:
        """Of the pyramid over the photon map, as table 3 rounds it."""
        return round(self.photon_map_seconds / self.pyramid_seconds, 1)


@dataclass(frozen=True)
class Goal:
    """What is to be reached in a scene at the paper's settings."""

    speedup: float
    """At least."""
    rms_paper: float
    """At most (%)."""
    bytes: float
    """At most."""


SIBENIK = Published(
    "Sibenik",
    (640, 480),
    {"2x4": 0.658, "4x8": 0.610, "8x16": 0.581, "16x32": 0.562},
    {16: 0.625, 32: 0.598, 64: 0.581, 128: 0.581, 256: 0.595},
    photon_map_seconds=5531.0,
    pyramid_seconds=292.2,
    photon_map_bytes=450.8e6,
    pyramid_bytes=57e6,
)
TABLE = Published(
    "Table",
    (640, 480),
    {"2x4": 0.768, "4x8": 0.652, "8x16": 0.577, "16x32": 0.533},
    {16: 0.732, 32: 0.652, 64: 0.587, 128: 0.577, 256: 0.602},
    photon_map_seconds=5213.0,
    pyramid_seconds=179.1,
    photon_map_bytes=453.4e6,
    pyramid_bytes=66e6,
)
CORNELL_BOX = Published(
    "Cornell box",
    (512, 512),
    {"2x4": 1.210, "4x8": 1.095, "8x16": 0.971, "16x32": 0.913},
    {16: 1.130, 32: 1.010, 64: 0.975, 128: 0.971, 256: 0.983},
    photon_map_seconds=4728.0,
    pyramid_seconds=74.5,
    photon_map_bytes=257.1e6,
    pyramid_bytes=62e6,
)

"""What lies on the laid table: crockery, cutlery, bread and fruit, each around its own origin, standing on z = 0."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from scenes.shapes import (
    Points,
    Shape,
    box,
    in_slot,
    join,
    lathe,
    mapped,
    moved,
    prism,
    sheet,
    smooth_curve,
    surface,
    tube,
    turned,
)

Controls = Sequence[tuple[float, float]]

PLATE: Controls = (
    (0.0, 0.0040),
    (0.052, 0.0040),
    (0.055, 0.0005),
    (0.061, 0.0005),
    (0.066, 0.0040),
    (0.088, 0.0070),
    (0.112, 0.0140),
    (0.1345, 0.0205),
    (0.1365, 0.0225),
    (0.1345, 0.0240),
    (0.112, 0.0185),
    (0.092, 0.0125),
    (0.082, 0.0088),
    (0.0, 0.0080),
)
BOWL: Controls = (
    (0.0, 0.0050),
    (0.032, 0.0050),
    (0.034, 0.0005),
    (0.040, 0.0005),
    (0.044, 0.0060),
    (0.064, 0.0220),
    (0.077, 0.0500),
    (0.0815, 0.0600),
    (0.0800, 0.0620),
    (0.0770, 0.0600),
    (0.060, 0.0280),
    (0.038, 0.0120),
    (0.0, 0.0090),
)
CUP: Controls = (
    (0.0, 0.0040),
    (0.022, 0.0040),
    (0.024, 0.0005),
    (0.028, 0.0010),
    (0.034, 0.0120),
    (0.0385, 0.0400),
    (0.0400, 0.0780),
    (0.0412, 0.0900),
    (0.0400, 0.0912),
    (0.0385, 0.0895),
    (0.0370, 0.0780),
    (0.0355, 0.0400),
    (0.030, 0.0120),
    (0.0, 0.0080),
)
JUG: Controls = (
    (0.0, 0.0050),
    (0.050, 0.0050),
    (0.056, 0.0010),
    (0.062, 0.0060),
    (0.078, 0.0400),
    (0.084, 0.0800),
    (0.074, 0.1350),
    (0.052, 0.1850),
    (0.0500, 0.2150),
    (0.0570, 0.2440),
    (0.0555, 0.2465),
    (0.0525, 0.2440),
    (0.0455, 0.2150),
    (0.0475, 0.1850),
    (0.069, 0.1350),
    (0.079, 0.0800),
    (0.060, 0.0200),
    (0.0, 0.0140),
)
VASE: Controls = (
    (0.0, 0.0050),
    (0.040, 0.0050),
    (0.044, 0.0010),
    (0.050, 0.0060),
    (0.070, 0.0600),
    (0.076, 0.1050),
    (0.064, 0.1500),
    (0.034, 0.1900),
    (0.027, 0.2200),
    (0.0330, 0.2440),
    (0.0315, 0.2460),
    (0.0285, 0.2430),
    (0.0230, 0.2200),
    (0.030, 0.1900),
    (0.058, 0.1500),
    (0.0, 0.1000),
)
FRUIT_BOWL: Controls = (
    (0.0, 0.0120),
    (0.050, 0.0120),
    (0.056, 0.0010),
    (0.066, 0.0010),
    (0.066, 0.0120),
    (0.110, 0.0300),
    (0.148, 0.0640),
    (0.165, 0.0900),
    (0.1630, 0.0925),
    (0.1590, 0.0900),
    (0.142, 0.0680),
    (0.106, 0.0360),
    (0.0, 0.0200),
)
APPLE: Controls = (
    (0.0, 0.0080),
    (0.010, 0.0035),
    (0.020, 0.0010),
    (0.032, 0.0120),
    (0.0385, 0.0330),
    (0.0370, 0.0530),
    (0.026, 0.0670),
    (0.013, 0.0690),
    (0.004, 0.0620),
    (0.0, 0.0590),
)
CANDLESTICK: Controls = (
    (0.0, 0.0010),
    (0.048, 0.0010),
    (0.050, 0.0050),
    (0.040, 0.0120),
    (0.014, 0.0220),
    (0.009, 0.0400),
    (0.015, 0.0520),
    (0.009, 0.0640),
    (0.0075, 0.1300),
    (0.015, 0.1420),
    (0.018, 0.1480),
    (0.024, 0.1560),
    (0.022, 0.1600),
    (0.0, 0.1590),
)


def turned_ware(controls: Controls, segments: int, steps: int = 2) -> Shape:
    """Crockery off the wheel: a smooth profile through (radius, height), turned."""
    curve = smooth_curve(controls, steps)
    curve[:, 0] = np.maximum(curve[:, 0], 0.0)
    return lathe(curve, segments)


def handle(low: tuple[float, float], high: tuple[float, float], reach: float, radius: float) -> Shape:
    """An ear on the +x side between two points (x, z) of a wall, standing out by `reach`."""
    (x0, z0), (x1, z1) = low, high
    rise = z1 - z0
    controls = [
        (x0, 0.0, z0),
        (x0 + 0.65 * reach, 0.0, z0 + 0.05 * rise),
        (x0 + reach, 0.0, z0 + 0.5 * rise),
        (x1 + 0.7 * reach, 0.0, z1 + 0.04 * rise),
        (x1, 0.0, z1),
    ]
    bar = tube(smooth_curve(controls, 4), radius, 8)
    return mapped(bar, lambda points: points * np.array([1.0, 1.5, 1.0]))


def cup() -> Shape:
    """A mug with an ear."""
    return join([turned_ware(CUP, 20), handle((0.0365, 0.022), (0.0385, 0.072), 0.03, 0.0038)])


def jug() -> Shape:
    """A water jug, its spout towards -x."""

    def pull_spout(points: Points) -> Points:
        lip = np.clip((points[:, 2] - 0.195) / 0.05, 0.0, 1.0) ** 1.5
        angle = np.arctan2(points[:, 1], -points[:, 0])
        pull = lip * np.exp(-((angle / 0.42) ** 2))
        squeeze = 1.0 - 0.25 * lip * np.exp(-((np.abs(angle) - 0.75) ** 2) / 0.1)
        moved_points = points * np.stack([np.ones_like(squeeze), squeeze, np.ones_like(squeeze)], axis=1)
        moved_points[:, 0] -= 0.032 * pull
        moved_points[:, 2] += 0.012 * pull
        return moved_points

    body = mapped(turned_ware(JUG, 30), pull_spout)
    return join([body, handle((0.078, 0.085), (0.048, 0.218), 0.055, 0.0065)])


def apple(lean: float) -> Shape:
    """An apple, never quite round; slot 1 is the stem."""
    body = turned_ware(APPLE, 12)

    def bulge(points: Points) -> Points:
        angle = np.arctan2(points[:, 1], points[:, 0])
        lobes = 1.0 + 0.02 * np.cos(5.0 * angle + lean) * (points[:, 2:3].T[0] / 0.07)
        return points * np.stack([lobes, 0.97 * lobes, np.ones_like(lobes)], axis=1)

    stem = tube(smooth_curve([(0, 0, 0.058), (0.001, 0, 0.068), (0.005, 0.002, 0.079)], 3), 0.0012, 6)
    fruit = join([mapped(body, bulge), in_slot(stem, 1)])
    return turned(fruit, 0.25 * lean, 0)


def sprig(height: float, leaves: int, seed: int) -> Shape:
    """A twig with olive leaves in pairs; slot 0 wood, slot 1 leaf."""
    random = np.random.default_rng(seed)
    lean = random.uniform(-0.28, 0.28, 2)
    controls = [(0.0, 0.0, 0.0), (0.3 * lean[0] * height, 0.3 * lean[1] * height, 0.4 * height)]
    controls.append((lean[0] * height, lean[1] * height, height))
    path = smooth_curve(controls, 6)
    parts = [tube(path, np.linspace(0.0022, 0.0008, len(path)), 6)]
    for number in range(leaves):
        place = 0.42 + 0.58 * (number // 2 + 0.5) / (leaves / 2)
        point = path[min(int(place * (len(path) - 1)), len(path) - 1)]
        angle = 2.4 * (number // 2) + math.pi * (number % 2) + random.uniform(-0.4, 0.4)
        blade = turned(leaf(random.uniform(0.045, 0.065)), -random.uniform(0.3, 0.9), 1)
        parts.append(in_slot(moved(blade, tuple(point), angle), 1))
    return join(parts)


def leaf(length: float) -> Shape:
    """A narrow leaf along +x, folded a little along its middle."""
    along = np.linspace(0.0, 1.0, 5)[None, :]
    across = np.array([-1.0, 0.0, 1.0])[:, None]
    width = 0.13 * length * np.sin(math.pi * np.clip(along, 0.02, 0.99)) ** 0.8
    x = length * along + 0.0 * across
    z = 0.25 * length * along * (0.6 - along) + 0.3 * width * np.abs(across)
    return sheet(np.stack([x, width * across, z], axis=2), 0.0004)


def bar_of(
    stations: Sequence[tuple[float, float, float, float]], thickness: float, dish: float = 0.0
) -> Shape:
    """Flat metal along +x through stations (x, half width, height, how deeply dished as a part of `dish`)."""
    curve = smooth_curve(stations, 2)
    across = np.linspace(-1.0, 1.0, 5)[:, None]
    x, half, z, deep = (column[None, :] for column in curve.T)
    points = np.stack([x + 0.0 * across, half * across, z - dish * deep * (1.0 - across**2)], axis=2)
    return sheet(points, thickness)


HANDLE = (
    (0.0, 0.006, 0.003, 0.0),
    (0.010, 0.0105, 0.003, 0.0),
    (0.06, 0.0075, 0.006, 0.0),
    (0.11, 0.004, 0.011, 0.0),
)


def spoon() -> Shape:
    """A table spoon of 0.2 m along +x."""
    bowl = (
        (0.135, 0.006, 0.011, 0.15),
        (0.150, 0.017, 0.012, 0.7),
        (0.172, 0.021, 0.012, 1.0),
        (0.192, 0.012, 0.013, 0.5),
    )
    return bar_of((*HANDLE, *bowl, (0.199, 0.003, 0.0135, 0.0)), 0.0016, dish=0.009)


def fork() -> Shape:
    """A table fork of 0.2 m along +x with four tines."""
    neck = bar_of(
        (*HANDLE, (0.128, 0.0065, 0.012, 0.0), (0.142, 0.0118, 0.009, 0.0), (0.152, 0.0122, 0.007, 0.0)),
        0.0018,
    )
    tines = []
    for number in range(4):
        y = (number - 1.5) * 0.0069
        path = smooth_curve([(0.150, y, 0.0062), (0.172, y, 0.0045), (0.199, 0.96 * y, 0.011)], 3)
        tines.append(tube(path, np.linspace(0.0017, 0.0008, len(path)), 6))
    return join([neck, *tines])


def knife() -> Shape:
    """A table knife of 0.22 m along +x, its edge towards +y."""
    grip = box((0.0, -0.0065, 0.0008), (0.1, 0.0065, 0.0075), 0.0022)
    back = [(0.098, -0.006), (0.15, -0.0075), (0.2, -0.006), (0.2195, 0.001)]
    edge = [(0.2195, 0.001), (0.214, 0.008), (0.19, 0.0118), (0.13, 0.0115), (0.108, 0.009), (0.098, 0.005)]
    outline = np.vstack([smooth_curve(back, 4)[:-1], smooth_curve(edge, 4)])
    return join([grip, prism(outline, 0.003, 0.0046)])


def loaf() -> Shape:
    """A long loaf along x with four cuts across its crust."""
    along = np.linspace(-1.0, 1.0, 35)
    around = np.linspace(0.0, 2.0 * math.pi, 20, endpoint=False)
    half = np.sqrt(np.maximum(1.0 - np.abs(along) ** 2.6, 0.0))[:, None]
    y = 0.055 * half * np.cos(around)
    z = 0.046 * half * np.sin(around)
    z = np.where(z < 0.0, 0.35 * z, z)
    slant = along[:, None] + 0.25 * np.cos(around)
    cuts = (
        np.sin(4.2 * math.pi * slant) ** 8
        * np.clip(np.sin(around), 0.0, 1.0)
        * (np.abs(along) < 0.8)[:, None]
    )
    z = z * (1.0 - 0.13 * cuts) + 0.0165
    x = 0.15 * along[:, None] + 0.0 * y
    body = surface(np.stack([x, y, z], axis=2), wrap_columns=True)
    low = body.points[:, 2].min()
    return moved(body, (0.0, 0.0, 0.0005 - low))


def slice_of_bread() -> Shape:
    """A slice lying flat: slot 0 is the crust, slot 1 the crumb."""
    angles = np.linspace(0.0, 2.0 * math.pi, 28, endpoint=False)
    outline = np.stack([0.052 * np.cos(angles), 0.04 * np.sin(angles)], axis=1)
    outline[:, 1] = np.where(outline[:, 1] < 0.0, 0.7 * outline[:, 1], outline[:, 1])
    crumb = prism(0.93 * outline, 0.0, 0.0136)
    crust = prism(outline, 0.0004, 0.0132)
    return join([crust, in_slot(crumb, 1)])


def napkin() -> Shape:
    """A linen napkin folded twice, about 0.2 by 0.1 m; its layers do not lie quite flat."""
    layers = []
    for number in range(2):
        u, v = np.meshgrid(np.linspace(-1.0, 1.0, 7), np.linspace(-1.0, 1.0, 6))
        wave = 0.0012 * np.sin(3.0 * u + number) * np.cos(2.0 * v - number) + 0.0010 * u * v
        z = 0.0045 * (number + 1) + wave * (0.4 + 0.3 * number)
        shrink = 1.0 - 0.012 * number
        layers.append(sheet(np.stack([0.055 * shrink * u, 0.105 * shrink * v, z], axis=2), 0.0028))
    return join(layers)

"""Measures the sheen of Cycles, and writes it as `core/renderer/src/bsdf/sheen_table.rs`.

`python -m tests.render.measure_sheen` takes a few seconds. Every pixel shows a flat tile of one roughness, leaning
by its own angle, under one sun at a time that has no size: such pictures have no noise. How bright a tile is under many
suns says what its linearly transformed cosine is (see `sheen.rs`), by linear least squares.
"""

from __future__ import annotations

import math
import textwrap
from pathlib import Path

import bpy
import numpy as np
import numpy.typing as npt

from scenes import common
from tests.render import pictures

STEPS = 32
"""Of roughness and of the cosine to the viewer; Cycles interpolates between as many."""
SUNS = 40
LEAST_COS, LARGEST_COS = 0.25 / (STEPS - 1), 1.0 - 1e-6
"""Seen from the side tiles are lines, and face on there is no direction across: the former is extrapolated."""
LEAST_RADIANCE = 1e-12
LIMITS = (0.0, 5e-4, -1.0), (1.0, 1.0, 1.0)
"""Of albedo, across and lean."""
KEPT = "\u00a0"
"""A space at which no line ends."""
TABLE = Path(__file__).resolve().parents[2] / "core/renderer/src/bsdf/sheen_table.rs"
HEAD = """//! What sheen is measured to be (Cycles of Blender {version}), by `python -m tests.render.measure_sheen`.

/// Steps of roughness, and of the cosine to the viewer, from 0 to 1.
pub(super) const STEPS: usize = {steps};

/// Albedo, and `across` and `lean` of [`super::sheen::Sheen`], in ten-thousandths, by roughness and cosine.
#[rustfmt::skip]
pub(super) static MEASURED: [[[i16; 3]; STEPS]; STEPS] = ["""

Array = npt.NDArray[np.float64]


def main() -> None:
    """Measures and writes."""
    cosines = np.linspace(0.0, 1.0, STEPS)
    cosines[0], cosines[-1] = LEAST_COS, LARGEST_COS
    suns = directions()
    scene = tiles(cosines)
    radiance = np.stack([render(scene, sun) for sun in suns])
    table, misfit = fitted(cosines, suns, radiance)
    rest = LEAST_COS * (STEPS - 1)
    table[:, 0] = (table[:, 0] - rest * table[:, 1]) / (1.0 - rest)
    write(table.clip(*LIMITS))
    print(f"largest misfit of a radiance: {misfit:.1e} of itself")


def write(table: Array) -> None:
    """The table as Rust, in ten-thousandths."""
    lines = [HEAD.format(steps=STEPS, version=bpy.app.version_string)]
    for row in (table * 1e4).round().astype(int).tolist():
        entries = ", ".join(str(entry).replace(" ", KEPT) for entry in row)
        wrapped = textwrap.wrap(f"[{entries}],", 120, initial_indent="    ", subsequent_indent="     ")
        lines += [line.replace(KEPT, " ") for line in wrapped]
    TABLE.write_text("\n".join(lines) + "\n];\n")


def directions() -> Array:
    """Unit vectors to the suns, spread evenly over the sphere (a Fibonacci lattice): (suns, 3)."""
    i = np.arange(SUNS) + 0.5
    z, turn = 1.0 - 2.0 * i / SUNS, math.pi * (1.0 + math.sqrt(5.0)) * i
    across = np.sqrt(1.0 - z * z)
    return np.stack([across * np.cos(turn), across * np.sin(turn), z], axis=1)


def tiles(cosines: Array) -> bpy.types.Scene:
    """A tile for each pixel, cosines from left to right and roughnesses from below upwards, seen along -Z."""
    scene = common.start_empty_file()
    polygons = []
    for row in range(STEPS):
        for column, cos in enumerate(cosines):
            # A tile leans about Y; it is as long as it takes to fill its pixel.
            x, y, rise = column + 0.5, row + 0.5, 0.5 * math.sqrt(1.0 - cos * cos) / cos
            left, right, below, above = x - 0.5, x + 0.5, y - 0.5, y + 0.5
            low, high = (
                [(left, below, rise), (right, below, -rise)],
                [(right, above, -rise), (left, above, rise)],
            )
            polygons.append([*low, *high])
    material, tree, output = common.new_material("Sheen")
    sheen, attribute = tree.nodes.new("ShaderNodeBsdfSheen"), tree.nodes.new("ShaderNodeAttribute")
    sheen.inputs["Color"].default_value = (1.0, 1.0, 1.0, 1.0)
    attribute.attribute_name = "rough"
    tree.links.new(attribute.outputs["Fac"], sheen.inputs["Roughness"])
    tree.links.new(sheen.outputs[0], output)
    mesh = common.add_polygons("Tiles", polygons, [material]).data
    mesh.attributes.new("rough", "FLOAT", "FACE").data.foreach_set(
        "value", np.repeat(np.linspace(0.0, 1.0, STEPS), STEPS).astype(np.float32)
    )
    camera = common.add_camera((STEPS / 2, STEPS / 2, 100.0), (0.0, 0.0, 0.0), 1.0, (STEPS, STEPS))
    camera.data.type, camera.data.ortho_scale, camera.data.clip_end = "ORTHO", STEPS, 1000.0
    return scene


def render(scene: bpy.types.Scene, sun: Array) -> Array:
    """Radiance of the tiles under a sun of one watt to the square meter, by roughness and cosine."""
    light = bpy.data.lights.new("Sun", "SUN")
    light.angle, light.energy, light.use_shadow = 0.0, 1.0, False
    lamp = common.add_object("Sun", light)
    lamp.rotation_euler = (math.acos(sun[2]), 0.0, math.atan2(sun[0], -sun[1]))
    pictures.use_cycles(scene, 1, 0)
    scene.cycles.max_bounces = 0
    scene.cycles.pixel_filter_type, scene.cycles.filter_width = "BOX", 0.01
    picture = pictures.render(scene)["Combined"].mean(axis=-1)
    bpy.data.objects.remove(lamp)
    return picture[::-1]


def fitted(cosines: Array, suns: Array, radiance: Array) -> tuple[Array, float]:
    """Albedo, across and lean by roughness and cosine, and the largest relative misfit of a pixel.

    Radiance is albedo · z/π · (across / |w|²)², w = (across x + lean z, across y, z), of a direction (x, y, z) about
    the tile's normal, x towards the viewer. So |w|² / (across √albedo) = √(z / (π radiance)), linear in three unknowns.
    """
    table, misfit = np.zeros((STEPS, STEPS, 3)), 0.0
    for column, cos in enumerate(cosines):
        sin = math.sqrt(1.0 - cos * cos)
        toward, across, normal = (-cos, 0.0, sin), (0.0, 1.0, 0.0), (sin, 0.0, cos)
        x, y, z = (suns @ np.array(direction) for direction in (toward, across, normal))
        for row in range(STEPS):
            seen = radiance[:, row, column]
            lit = seen > LEAST_RADIANCE
            if lit.sum() < 6:
                # There is no sheen; its shape is that of the tile before, if any.
                table[row, column, 1:] = table[row, column - 1, 1:]
                continue
            measured = np.sqrt(z[lit] / (math.pi * seen[lit]))
            terms = np.stack([x[lit] ** 2 + y[lit] ** 2, x[lit] * z[lit], z[lit] ** 2], axis=1)
            (a, b, c), *_ = np.linalg.lstsq(terms / measured[:, None], np.ones(lit.sum()), rcond=None)
            lean_by_across = b / (2.0 * a)
            size = 1.0 / math.sqrt(c / a - lean_by_across**2)
            table[row, column] = size**2 / a**2, size, lean_by_across * size
            misfit = max(misfit, float(np.abs(terms @ (a, b, c) / measured - 1.0).max()))
    return table, misfit


if __name__ == "__main__":
    main()

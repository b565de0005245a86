"""The Sky Texture: a picture of the sky, and the sun's disk."""

import functools
import math
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ... import native
from .. import sky
from ..nodes import Output
from .mapping import own_mapping

if TYPE_CHECKING:
    from .compiler import Compiler, Operand, Register

_SINGLE = ("SINGLE_SCATTERING", "NISHITA")
_EARTH = 6371e3  # its radius (m)


def sky_texture(c: "Compiler", source: Output) -> "Operand | None":
    """The sky around a direction."""
    b_node = source.b_node
    direction = c.input(source, "Vector") if c.linked(source, "Vector") else c.generated()
    direction = own_mapping(c, b_node, direction)
    if b_node.sky_type in ("PREETHAM", "HOSEK_WILKIE"):
        x, y, z = b_node.sun_direction.normalized()
        direction = _sun_in_front(c, direction, math.atan2(y, x))
        if b_node.sky_type == "PREETHAM":
            return _seen(c, direction, ("preetham", math.asin(z), b_node.turbidity))
        # It knows no sun below the horizon.
        elevation = max(math.asin(z), 0.0)
        return _seen(c, direction, ("hosek_wilkie", elevation, b_node.turbidity, b_node.ground_albedo))
    elevation, rotation = _sun_place(b_node.sun_elevation, b_node.sun_rotation)
    direction = _sun_in_front(c, direction, 0.5 * math.pi - rotation)
    # Blender before 5.0 says dust where later ones say aerosol.
    aerosol = b_node.aerosol_density if hasattr(b_node, "aerosol_density") else b_node.dust_density
    air = sky.Air(b_node.altitude, b_node.air_density, aerosol, b_node.ozone_density)
    kind = "single" if b_node.sky_type in _SINGLE else "multiple"
    color = _seen(c, direction, (kind, elevation, air))
    if not b_node.sun_disc or b_node.sun_size <= 0.0:
        return color
    disk = (sky.single_sun if kind == "single" else sky.multiple_sun)(elevation, b_node.sun_size, air)
    lowest = 0.0 if kind == "single" else -math.sin(math.acos(_EARTH / (_EARTH + max(air.altitude, 0.0))))
    seen = c.emit(
        "sun_disk",
        vector=direction,
        towards=[math.cos(elevation), 0.0, math.sin(elevation)],
        radius=0.5 * b_node.sun_size,
        bottom=(disk.bottom * b_node.sun_intensity).tolist(),
        top=(disk.top * b_node.sun_intensity).tolist(),
        lowest=lowest,
    )
    return c.vector_math("ADD", color, seen)


def _sun_place(elevation: float, rotation: float) -> tuple[float, float]:
    """Elevation between -90 and 90 degrees, and rotation, of the same place (rad)."""
    elevation = math.remainder(elevation, 2.0 * math.pi)
    if abs(elevation) > 0.5 * math.pi:
        return math.copysign(math.pi, elevation) - elevation, rotation + math.pi
    return elevation, rotation


def _sun_in_front(c: "Compiler", direction: "Register", azimuth: float) -> "Register":
    """The direction, turned about the zenith so that what lies at an azimuth (rad from +X to +Y) comes to lie on +X."""
    cos, sin = math.cos(azimuth), math.sin(azimuth)
    return c.transformed(direction, [[cos, sin, 0.0, 0.0], [-sin, cos, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]])


@functools.lru_cache(maxsize=4)
def _texels(kind: str, *of_model: Any) -> npt.NDArray[np.float32]:
    """The picture of a sky: kept, since it takes a second and most renders are of the sky of the one before."""
    compute: dict[str, Callable[..., npt.NDArray[np.float64]]] = {
        "preetham": sky.preetham,
        "hosek_wilkie": _hosek_wilkie,
        "single": sky.single_scattering,
        "multiple": sky.multiple_scattering,
    }
    texels = np.ones((sky.HEIGHT, sky.WIDTH, 4), np.float32)
    texels[..., :3] = compute[kind](*of_model)
    return texels


def _hosek_wilkie(elevation: float, turbidity: float, albedo: float) -> npt.NDArray[np.float64]:
    fitted = native.core().hosek_wilkie(elevation, turbidity, albedo)
    return sky.hosek_wilkie(elevation, fitted)


def _seen(c: "Compiler", direction: "Register", model: tuple[Any, ...]) -> "Register":
    """The color of the sky along a direction."""
    textures, key = c.context.textures, repr(model)
    texture = textures.get(key)
    if texture is None:
        textures[key] = texture = c.context.builder.add_texture("sky", _texels(*model), "linear")
    place = c.emit("panorama", vector=direction, projection="equirectangular")
    fields = {"extension": "repeat", "interpolation": "linear", "unassociate": False}
    return c.emit("image", texture=texture, vector=place, **fields)

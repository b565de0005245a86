"""Blender's cameras that see all around: their projection and window, and where a place lies in their picture."""

import math
from dataclasses import dataclass
from typing import Any

_RIGHT_ANGLE = math.pi / 2.0


@dataclass(frozen=True)
class Panorama:
    """What such a camera sees."""

    projection: dict[str, Any]
    """The core's Projection."""
    window: tuple[float, float, float, float]
    """Left, right, bottom and top of the frame without shift, in the unit of the projection."""


def panorama(b_camera: Any, size: tuple[float, float]) -> Panorama:
    """The panorama of a camera. `size` is that of the frame, in any unit."""
    kind = b_camera.panorama_type
    if kind == "EQUIRECTANGULAR":
        longitudes = (b_camera.longitude_min, b_camera.longitude_max)
        return Panorama(
            {"kind": "equirectangular"}, (*longitudes, b_camera.latitude_min, b_camera.latitude_max)
        )
    if kind == "EQUIANGULAR_CUBEMAP_FACE":
        return Panorama({"kind": "cubemap_face"}, _around(math.pi / 4.0))
    if kind == "MIRRORBALL":
        # A small mirror shows equal solid angles on equal areas of its disk.
        return Panorama(_fisheye("equisolid", 2.0 * math.pi), _around(2.0))
    if kind == "CENTRAL_CYLINDRICAL":
        longitudes = (b_camera.central_cylindrical_range_u_min, b_camera.central_cylindrical_range_u_max)
        heights = (b_camera.central_cylindrical_range_v_min, b_camera.central_cylindrical_range_v_max)
        radius = b_camera.central_cylindrical_radius
        return Panorama({"kind": "cylindrical"}, (*longitudes, heights[0] / radius, heights[1] / radius))
    field_of_view = b_camera.fisheye_fov
    if kind == "FISHEYE_EQUIDISTANT":
        return Panorama(_fisheye("equidistant", field_of_view), _around(0.5 * field_of_view))
    width, height = _sensor(b_camera, size)
    if kind == "FISHEYE_LENS_POLYNOMIAL":
        # Blender's polynomial gives the angle with its sign turned.
        coefficients = [-getattr(b_camera, f"fisheye_polynomial_k{power}") for power in range(5)]
        projection = _fisheye("polynomial", field_of_view, coefficients=coefficients)
        return Panorama(projection, _around(0.5 * width, 0.5 * height))
    focal_length = b_camera.fisheye_lens
    projection = _fisheye("equisolid", field_of_view)
    return Panorama(projection, _around(0.5 * width / focal_length, 0.5 * height / focal_length))


def _fisheye(kind: str, field_of_view: float, **others: Any) -> dict[str, Any]:
    return {"kind": f"fisheye_{kind}", "field_of_view": field_of_view, **others}


def _around(half_width: float, half_height: float | None = None) -> tuple[float, float, float, float]:
    half_height = half_width if half_height is None else half_height
    return (-half_width, half_width, -half_height, half_height)


def _sensor(b_camera: Any, size: tuple[float, float]) -> tuple[float, float]:
    """Width and height of the part of the sensor that the frame covers (mm)."""
    width, height = size
    fit = b_camera.sensor_fit
    if width > height if fit == "AUTO" else fit == "HORIZONTAL":
        return b_camera.sensor_width, b_camera.sensor_width * height / width
    sensor = b_camera.sensor_height if fit == "VERTICAL" else b_camera.sensor_width
    return sensor * width / height, sensor

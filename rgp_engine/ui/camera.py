"""What a panoramic camera shows. Blender's own panel has it for Cycles alone."""

from typing import Any

from bpy.types import Panel

from .base import EnginePanel, draw_settings

_LONGITUDES, _LATITUDES = ("longitude_min", "longitude_max"), ("latitude_min", "latitude_max")
_CYLINDER = tuple(
    f"central_cylindrical_{name}"
    for name in ("range_u_min", "range_u_max", "range_v_min", "range_v_max", "radius")
)
_COEFFICIENTS = tuple(f"fisheye_polynomial_k{power}" for power in range(5))
SETTINGS = {
    "EQUIRECTANGULAR": (*_LATITUDES, *_LONGITUDES),
    "FISHEYE_EQUIDISTANT": ("fisheye_fov",),
    "FISHEYE_EQUISOLID": ("fisheye_lens", "fisheye_fov"),
    "FISHEYE_LENS_POLYNOMIAL": ("fisheye_fov", *_COEFFICIENTS),
    "CENTRAL_CYLINDRICAL": _CYLINDER,
}
"""Of the camera, by the kind of panorama; others have none."""


class RGP_PT_panorama(EnginePanel, Panel):
    """The kind of panorama, and its field of view."""

    bl_label = "Panorama"
    bl_context = "data"

    @classmethod
    def poll(cls, context: Any) -> bool:
        """True for a panoramic camera."""
        return bool(context.camera and context.camera.type == "PANO") and super().poll(context)

    def draw(self, context: Any) -> None:
        """Draws the panel."""
        kind = context.camera.panorama_type
        draw_settings(self.layout, context.camera, "panorama_type", *SETTINGS.get(kind, ()))


CLASSES = (RGP_PT_panorama,)
"""Panels of the Properties editor."""

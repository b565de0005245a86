"""Render properties: one panel for each group of settings."""

from typing import Any

from bpy.types import Panel

from .base import ClosedEnginePanel, EnginePanel, draw_settings

_CURVES = {
    "SMOOTH": "SMOOTHCURVE",
    "ROUND": "SPHERECURVE",
    "ROOT": "ROOTCURVE",
    "SHARP": "SHARPCURVE",
    "LINE": "LINCURVE",
    "MAX": "NOCURVE",
}
"""Blender's presets of the shutter curve, and their icons."""


class RGP_PT_photons(EnginePanel, Panel):
    """Photon pass."""

    bl_label = "Photons"
    bl_context = "render"

    def draw(self, context: Any) -> None:
        """Draws the panel."""
        names = (
            "photon_count",
            "caustic_count",
            "caustic_nearest",
            "caustic_solid_angle",
            "max_depth",
            "aim",
        )
        draw_settings(self.layout, context.scene.rgp.photon_pass, *names)


class RGP_PT_pyramid(EnginePanel, Panel):
    """Radiance Grid Pyramid."""

    bl_label = "Pyramid"
    bl_context = "render"

    def draw(self, context: Any) -> None:
        """Draws the panel."""
        b_pyramid = context.scene.rgp.pyramid
        names = ("finest_resolution", "adaptive_levels", "photons_per_cell", "normal_classes")
        draw_settings(self.layout, b_pyramid, *names)
        column = self.layout.column(align=True)
        column.prop(b_pyramid, "bins", index=0, text="Bins Elevation")
        column.prop(b_pyramid, "bins", index=1, text="Azimuth")


class RGP_PT_gather(EnginePanel, Panel):
    """Final gather."""

    bl_label = "Gather"
    bl_context = "render"

    def draw(self, context: Any) -> None:
        """Draws the panel."""
        b_gather = context.scene.rgp.gather
        draw_settings(self.layout, b_gather, "rays", "camera_samples", "light_samples")
        draw_settings(self.layout, b_gather, "sampling", "retrace_distance", "max_depth", "audit")


class RGP_PT_stop(EnginePanel, Panel):
    """What ends the gather before all rays are traced."""

    bl_label = "Stop When"
    bl_context = "render"
    bl_parent_id = "RGP_PT_gather"

    def draw(self, context: Any) -> None:
        """Draws the panel."""
        draw_settings(self.layout, context.scene.rgp.gather, "time_limit", "error_target")


class RGP_PT_film(ClosedEnginePanel, Panel):
    """Film."""

    bl_label = "Film"
    bl_context = "render"

    def draw(self, context: Any) -> None:
        """Draws the panel."""
        draw_settings(self.layout, context.scene.rgp.film, "exposure", "filter", "filter_width")
        self.layout.prop(context.scene.render, "film_transparent", text="Transparent")


class RGP_PT_motion_blur(ClosedEnginePanel, Panel):
    """Blender's own settings of the shutter."""

    bl_label = "Motion Blur"
    bl_context = "render"

    def draw_header(self, context: Any) -> None:
        """Draws the switch."""
        self.layout.prop(context.scene.render, "use_motion_blur", text="")

    def draw(self, context: Any) -> None:
        """Draws the panel."""
        b_render = context.scene.render
        self.layout.active = b_render.use_motion_blur
        draw_settings(self.layout, b_render, "motion_blur_position", "motion_blur_shutter")


class RGP_PT_shutter_curve(ClosedEnginePanel, Panel):
    """How the shutter opens and closes."""

    bl_label = "Shutter Curve"
    bl_context = "render"
    bl_parent_id = "RGP_PT_motion_blur"

    def draw(self, context: Any) -> None:
        """Draws the panel."""
        b_render = context.scene.render
        self.layout.active = b_render.use_motion_blur
        self.layout.template_curve_mapping(b_render, "motion_blur_shutter_curve")
        row = self.layout.row(align=True)
        for shape, icon in _CURVES.items():
            row.operator("render.shutter_curve_preset", icon=icon, text="").shape = shape


class RGP_PT_performance(ClosedEnginePanel, Panel):
    """Performance."""

    bl_label = "Performance"
    bl_context = "render"

    def draw(self, context: Any) -> None:
        """Draws the panel."""
        draw_settings(self.layout, context.scene.rgp.render, "threads", "seed", "memory_limit")
        draw_settings(self.layout, context.scene.rgp.film, "tile_size")


CLASSES = (
    RGP_PT_photons,
    RGP_PT_pyramid,
    RGP_PT_gather,
    RGP_PT_stop,
    RGP_PT_motion_blur,
    RGP_PT_shutter_curve,
    RGP_PT_film,
    RGP_PT_performance,
)

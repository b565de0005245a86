"""Render properties: one panel for each group of settings."""

from typing import Any

from bpy.types import Panel

from .base import ClosedEnginePanel, EnginePanel, draw_settings


class RGP_PT_photons(EnginePanel, Panel):
    """Photon pass."""

    bl_label = "Photons"
    bl_context = "render"

    def draw(self, context: Any) -> None:
        """Draws the panel."""
        draw_settings(self.layout, context.scene.rgp.photon_pass, "photon_count", "max_depth", "aim")


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
    RGP_PT_film,
    RGP_PT_performance,
)

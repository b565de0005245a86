"""Panels of the Properties editor."""

import bpy

from . import accuracy, blender_panels, camera, effects, light, material, problems, render, scene_parts

_register_classes, _unregister_classes = bpy.utils.register_classes_factory(
    (
        *render.CLASSES,
        *accuracy.CLASSES,
        *problems.CLASSES,
        *effects.CLASSES,
        *light.CLASSES,
        *camera.CLASSES,
        *material.CLASSES,
        *scene_parts.CLASSES,
    )
)


def register() -> None:
    """Adds the engine's panels and shows Blender's own that make sense for it."""
    _register_classes()
    blender_panels.show()


def unregister() -> None:
    """Removes them again."""
    blender_panels.hide()
    _unregister_classes()

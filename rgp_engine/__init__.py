"""RGP Engine: final gathering over a Radiance Grid Pyramid, as a Blender render engine.

Importing this package does not import Blender; `register` does.
"""

from types import ModuleType


def _modules() -> tuple[ModuleType, ...]:
    """What is registered with Blender, lowest rank first."""
    from . import engine, operators, properties, ui

    return properties, operators, ui, engine


def register() -> None:
    """Makes the engine known to Blender."""
    for module in _modules():
        module.register()


def unregister() -> None:
    """Removes everything `register` added."""
    for module in reversed(_modules()):
        module.unregister()

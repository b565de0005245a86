"""Operators: what buttons do."""

from . import accuracy


def register() -> None:
    """Adds them."""
    accuracy.register()


def unregister() -> None:
    """Ends what they have started, and removes them."""
    accuracy.unregister()

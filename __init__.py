# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender looks for an extension's code beside its manifest; ours is in `rgp_engine`."""

from .rgp_engine import register, unregister

__all__ = ["register", "unregister"]

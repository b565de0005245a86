"""Scenes that others made, rendered by both engines: `python -m benchmarks.real_scenes`, run by `make scenes`."""

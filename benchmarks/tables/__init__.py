"""The paper's tables with this engine's figures: `python -m benchmarks.tables`, run by `make tables`."""

"""How fast the engine is: `python -m benchmarks -o out/bench.json`, run by `make bench`."""

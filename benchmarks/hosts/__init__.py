"""Programs that load FMUs and importers of SSP, for benchmarks and tests."""

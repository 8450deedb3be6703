"""The benchmarks, run by pytest-benchmark: `make bench` measures, records, compares with the last record."""

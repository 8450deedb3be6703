"""The benchmarks: `python -m reports.bench` runs them, keeps a record and compares it with the last one."""

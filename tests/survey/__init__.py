"""Seven hundred models with contact drawn at random, traced and judged: `python -m survey`."""

"""Nine hundred models with contact and joints drawn at random, traced and judged: `python -m survey`."""

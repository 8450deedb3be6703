"""Duffing A from 0.3 to 3 rad/s by other tools: `python -m reports.benchmarks.peers.NAME` prints it.

These modules run in processes of their own, under a Python that may have nothing of this project installed;
beside their tool they import NumPy at most.
"""

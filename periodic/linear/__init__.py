"""The linear algebra of Newton's method: local elimination, the chain of intervals, the border."""

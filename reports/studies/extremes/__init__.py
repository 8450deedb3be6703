"""The report on extremes: how far each parameter can be taken, and what stops a trace beyond."""

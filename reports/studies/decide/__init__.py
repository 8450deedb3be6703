"""The report on decisions: modes, fits, optima and scatter, each beside an answer that is known."""

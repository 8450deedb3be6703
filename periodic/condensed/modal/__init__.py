"""Motion of the modes under forces that are polynomials in each interval: exact, whatever their number."""

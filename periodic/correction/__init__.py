"""One orbit to a tolerance: Newton's method, the arclength constraint, error estimate, mesh refinement."""

"""Events at which states or rates jump: how they begin and end, and how perturbations pass them."""

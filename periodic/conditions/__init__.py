"""What else may determine an orbit: phases, levels, peaks, folds, doublings, tori; functionals."""

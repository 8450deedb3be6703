"""A branch for other programs: CSV, MATLAB, HDF5 and UFF58."""

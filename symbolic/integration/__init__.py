"""Time integration of expressions by CVODES and LSODA, with and without sensitivities."""

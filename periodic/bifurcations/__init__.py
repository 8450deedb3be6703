"""Special points: test functions, location, names, switching of branches, normal forms."""

"""The paper's method: explicit time stepping from its start, and where it breaks down."""

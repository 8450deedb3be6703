"""Single and multiple shooting by a trusted integrator."""

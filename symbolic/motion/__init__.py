"""What a compiled system does: rest and modes, linear response, simulation, explicit rates."""

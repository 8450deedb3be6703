"""Gears, bearings, rotors and friction dampers: their branches beside every number known of them."""

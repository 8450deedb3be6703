"""Dry friction: on a speed, and of elastic sliders that remember where they slipped."""

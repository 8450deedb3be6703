"""Scenes of the kind "model": coordinates and parts named in text, their keys taken from the part classes."""

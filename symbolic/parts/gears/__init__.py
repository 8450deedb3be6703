"""Gears: what meshing teeth exert on the motion of a pair along the line of action."""

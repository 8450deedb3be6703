"""Inertia, springs, dampers and forces on coordinates."""

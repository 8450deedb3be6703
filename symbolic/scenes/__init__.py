"""Scenes: TOML files, their schema, and the models that they describe."""

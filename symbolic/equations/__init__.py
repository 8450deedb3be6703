"""The language of models: variables, parts, their assembly, and the scaled expressions that come of it."""

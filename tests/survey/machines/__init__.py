"""The survey of machines drawn at random from catalogues: see `python -m survey.machines --help`."""

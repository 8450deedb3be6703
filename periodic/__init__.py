"""Periodic orbits: collocation, continuation, stability, special points. Knows only the `System` protocol.

The names stand in `__init__.pyi`; each is imported when it is first asked for.
"""

from importlib.metadata import version

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
__version__ = version("orbitrace")

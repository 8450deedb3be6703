"""What the equations are: parts that add up to models, scenes of such models, and their compilation.

The names stand in `__init__.pyi`; each is imported when it is first asked for, so that the command line need
not import CasADi to say how it is used.
"""

from importlib.metadata import version

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
__version__ = version("orbitrace")

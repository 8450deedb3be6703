"""The back end that the tests run with: NumPy, unless the environment says otherwise.

The automatic choice depends on what the user's cache holds.
"""

import os

os.environ.setdefault("ORBITRACE_KERNELS", "numpy")

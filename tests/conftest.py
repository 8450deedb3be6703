"""The back end that the tests run with: NumPy, unless the environment says otherwise.

The automatic choice depends on what the user's cache holds.
"""

import os
import signal

os.environ.setdefault("ORBITRACE_KERNELS", "numpy")

# A shell has Ctrl-C ignored in what it runs in the background; tests that send it need it heard.
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)

"""Quasi-periodic motions of forced systems: tori, as invariant curves of the stroboscopic map."""

"""Names of the points of a branch, as the field has them."""

from __future__ import annotations

from enum import Enum


class Label(Enum):
    """Special points of a branch, and of the curves that they trace in two parameters."""

    NONE = ""
    END = "EP"
    FOLD = "LP"
    DOUBLING = "PD"
    TORUS = "NS"
    BRANCH = "BP"
    HOPF = "HB"
    USER = "UZ"
    FAILED = "MX"
    CUSP = "CP"
    RESONANCE_1 = "R1"
    RESONANCE_2 = "R2"
    RESONANCE_3 = "R3"
    RESONANCE_4 = "R4"
    FOLD_DOUBLING = "LPPD"
    FOLD_TORUS = "LPNS"
    DOUBLING_TORUS = "PDNS"

    @property
    def critical(self) -> bool:
        """Whether a multiplier is on the unit circle, an eigenvalue on the imaginary axis there."""
        return self in (Label.FOLD, Label.DOUBLING, Label.TORUS, Label.BRANCH, Label.HOPF)

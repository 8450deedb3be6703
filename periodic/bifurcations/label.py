"""Names of the points of a branch, as is usual in the field."""

from __future__ import annotations

from typing import ClassVar


class Label(str):
    """Special points of a branch, and of the curves that they trace in two parameters.

    A label is a string, `Label.FOLD == "LP"`, of which there is one instance: `Label("LP") is Label.FOLD`.
    A new kind of point takes one line: `ZM = Label.register("ZM", critical=False)`.

    Parameters
    ----------
    text : str
        A registered label, `""` for none.

    Attributes
    ----------
    critical : bool
        Whether a multiplier is on the unit circle, or an eigenvalue on the imaginary axis, there.

    Raises
    ------
    ValueError
        For a text that is not registered; it names those that are.
    """

    critical: bool
    _registered: ClassVar[dict[str, Label]] = {}

    NONE: ClassVar[Label]
    END: ClassVar[Label]
    FOLD: ClassVar[Label]
    DOUBLING: ClassVar[Label]
    TORUS: ClassVar[Label]
    BRANCH: ClassVar[Label]
    HOPF: ClassVar[Label]
    GRAZING: ClassVar[Label]
    USER: ClassVar[Label]
    FAILED: ClassVar[Label]
    PEAK: ClassVar[Label]
    CUSP: ClassVar[Label]
    RESONANCE_1: ClassVar[Label]
    RESONANCE_2: ClassVar[Label]
    RESONANCE_3: ClassVar[Label]
    RESONANCE_4: ClassVar[Label]
    FOLD_DOUBLING: ClassVar[Label]
    FOLD_TORUS: ClassVar[Label]
    DOUBLING_TORUS: ClassVar[Label]
    BAUTIN: ClassVar[Label]
    ZERO_HOPF: ClassVar[Label]
    BOGDANOV_TAKENS: ClassVar[Label]
    GENERALISED_DOUBLING: ClassVar[Label]

    def __new__(cls, text: str) -> Label:
        found = cls._registered.get(text)
        if found is None:
            raise ValueError(f"label is {text!r}; it must be one of {', '.join(cls.known())}")
        return found

    def __reduce__(self) -> tuple[object, ...]:
        return Label.register, (self.value, self.critical)

    @classmethod
    def register(cls, text: str, critical: bool = False) -> Label:
        """Return the label of that text, made if there is none yet.

        Parameters
        ----------
        text : str
            Letters and digits; by custom two of them for points of branches in one parameter.
        critical : bool
            Whether a multiplier is on the unit circle, or an eigenvalue on the imaginary axis, there.

        Raises
        ------
        ValueError
            For other text, and for a label that is registered with another `critical`.
        """
        if not isinstance(text, str) or (text and not (text.isascii() and text.isalnum())):
            raise ValueError(f"label is {text!r}; it must be made of letters and digits")
        if text not in cls._registered:
            made = str.__new__(cls, text)
            made.critical = critical
            cls._registered[text] = made
        found = cls._registered[text]
        if found.critical is not critical:
            raise ValueError(f"label {text} is registered with critical={found.critical}, not {critical}")
        return found

    @classmethod
    def known(cls) -> tuple[Label, ...]:
        """Return the registered labels in the order of their registration, without `NONE`."""
        return tuple(label for label in cls._registered.values() if label)

    @property
    def value(self) -> str:
        """The label as a plain string."""
        return str(self)


Label.NONE = Label.register("")
Label.END = Label.register("EP")
Label.FOLD = Label.register("LP", critical=True)
Label.DOUBLING = Label.register("PD", critical=True)
Label.TORUS = Label.register("NS", critical=True)
Label.BRANCH = Label.register("BP", critical=True)
Label.HOPF = Label.register("HB", critical=True)
Label.GRAZING = Label.register("GR")
Label.USER = Label.register("UZ")
Label.FAILED = Label.register("MX")
Label.PEAK = Label.register("PK")
Label.CUSP = Label.register("CP")
Label.RESONANCE_1 = Label.register("R1")
Label.RESONANCE_2 = Label.register("R2")
Label.RESONANCE_3 = Label.register("R3")
Label.RESONANCE_4 = Label.register("R4")
Label.FOLD_DOUBLING = Label.register("LPPD")
Label.FOLD_TORUS = Label.register("LPNS")
Label.DOUBLING_TORUS = Label.register("PDNS")
Label.BAUTIN = Label.register("GH")
Label.ZERO_HOPF = Label.register("ZH")
Label.BOGDANOV_TAKENS = Label.register("BT")
Label.GENERALISED_DOUBLING = Label.register("GPD")

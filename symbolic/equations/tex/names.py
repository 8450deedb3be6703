"""Names of variables as LaTeX: Omega is a letter, k_3 and k3 have an index, a word stands upright.

A name is text, whatever letters it has: none of them is a command, ends a group or a formula, begins a tag of
HTML or an entity of it. TeX's own letters stand in mathematics, as signs that LaTeX, MathJax and KaTeX share.
"""

from __future__ import annotations

import re

GREEK = {
    "alpha", "beta", "gamma", "delta", "epsilon", "zeta", "eta", "theta", "iota", "kappa", "lambda",
    "mu", "nu", "xi", "pi", "rho", "sigma", "tau", "upsilon", "phi", "chi", "psi", "omega", "Gamma",
    "Delta", "Theta", "Lambda", "Xi", "Pi", "Sigma", "Upsilon", "Phi", "Psi", "Omega",
}  # fmt: skip

SIGNS = {
    "#": r"\#", "$": r"\$", "%": r"\%", "&": r"\&", "_": r"\_", "{": r"\{", "}": r"\}",
    "\\": r"\backslash{}", "^": r"\hat{\ }", "~": r"\sim{}", "<": "{<}", ">": "{>}",
}  # fmt: skip
"""What LaTeX or HTML would read, as signs."""


def tex(name: str) -> str:
    """Return a name as LaTeX; what cannot be printed is a space."""
    name = "".join(letter if letter.isprintable() else " " for letter in name)
    if " " in name:
        return _spelled(name, "text")
    stem, *indices = name.split("_")
    numbered = re.fullmatch(r"([A-Za-z]+)(\d+)", stem)
    if numbered:
        stem, indices = numbered[1], [numbered[2], *indices]
    below = r",\,".join(_word(index) for index in indices if index)
    return f"{_word(stem)}_{{{below}}}" if below else _word(stem)


def _word(word: str) -> str:
    if word in GREEK:
        return f"\\{word}"
    if word.isdigit() or (word.isalpha() and len(word) == 1):
        return word
    return _spelled(word, "mathrm" if word.isalnum() else "text")


def _spelled(name: str, command: str) -> str:
    """A name, its stretches without signs in a command; a group where there is more than one."""
    stretches = [part for part in re.split(f"([{re.escape(''.join(SIGNS))}])", name) if part]
    shown = [SIGNS.get(part, rf"\{command}{{{part}}}") for part in stretches or [""]]
    return shown[0] if len(shown) == 1 else f"{{{''.join(shown)}}}"


def dotted(name: str, order: int) -> str:
    """Return a derivative with respect to time."""
    return rf"\{'d' * order}ot{{{tex(name)}}}" if order else tex(name)

"""Names of variables as LaTeX: Omega is a letter, k_3 and k3 have an index, a word stands upright."""

from __future__ import annotations

import re

GREEK = {
    "alpha", "beta", "gamma", "delta", "epsilon", "zeta", "eta", "theta", "iota", "kappa", "lambda",
    "mu", "nu", "xi", "pi", "rho", "sigma", "tau", "upsilon", "phi", "chi", "psi", "omega", "Gamma",
    "Delta", "Theta", "Lambda", "Xi", "Pi", "Sigma", "Upsilon", "Phi", "Psi", "Omega",
}  # fmt: skip


def tex(name: str) -> str:
    """Return a name as LaTeX."""
    if " " in name:
        return rf"\text{{{name}}}"
    stem, *indices = name.split("_")
    numbered = re.fullmatch(r"([A-Za-z]+)(\d+)", stem)
    if numbered:
        stem, indices = numbered[1], [numbered[2], *indices]
    below = r",\,".join(_word(index) for index in indices if index)
    return f"{_word(stem)}_{{{below}}}" if below else _word(stem)


def _word(word: str) -> str:
    if word in GREEK:
        return f"\\{word}"
    plain = re.sub(r"([#$%&_{}])", r"\\\1", word)
    return plain if len(plain) == 1 or plain.isdigit() else rf"\mathrm{{{plain}}}"


def dotted(name: str, order: int) -> str:
    """Return a derivative with respect to time."""
    return rf"\{'d' * order}ot{{{tex(name)}}}" if order else tex(name)

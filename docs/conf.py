"""The site: `make docs` builds it into docs/_build, without a network."""

from __future__ import annotations

import importlib
from importlib.metadata import version as installed
from pathlib import Path
from types import ModuleType

HERE = Path(__file__).parent

NAMESPACES = {
    "symbolic.films": "films and their laws",
    "symbolic.functions": "of symbols",
    "periodic.plots": "pictures of orbits and curves",
    "periodic.maps": "what design maps are made of",
    "periodic.decisions": "results of fits, optima and scatter",
    "periodic.phasespace": "results of searches for motions, basins and exponents",
    "periodic.tori": "families of tori, averages over them",
    "periodic.extend": "what extensions are written with",
}
"""What few users call, and how its pages of the reference are headed."""

project = "orbitrace"
author = "The orbitrace authors"
project_copyright = author
release = installed("orbitrace")

extensions = [
    "sphinx.ext.autodoc",
    "sphinx.ext.autosummary",
    "sphinx-mathjax-offline",
    "myst_parser",
    "numpydoc",
    "sphinx_copybutton",
    "sphinx_gallery.gen_gallery",
]
templates_path = ["_templates"]
html_theme = "furo"
html_title = "orbitrace"
html_show_sourcelink = False
exclude_patterns = [
    "_build",
    "_templates",
    "gallery/**/*.py",
    "gallery/**/*.md5",
    "gallery/**/*.ipynb",
    "gallery/**/*.json",
]
myst_enable_extensions = ["dollarmath", "colon_fence", "deflist"]
myst_heading_anchors = 3
nitpicky = False

autosummary_generate = True
autodoc_typehints = "none"
autodoc_member_order = "bysource"
numpydoc_show_class_members = False
numpydoc_class_members_toctree = False

sphinx_gallery_conf = {
    "examples_dirs": "../examples",
    "gallery_dirs": "gallery",
    "filename_pattern": r"/[a-z_]+\.py",
    "ignore_pattern": r"__init__\.py",
    "download_all_examples": False,
    "remove_config_comments": True,
    "show_memory": False,
    "min_reported_time": 60,
    "plot_gallery": "True",
    "within_subsection_order": "FileNameSortKey",
    "reset_modules": ("matplotlib",),
}


def reference() -> None:
    """Write the pages of the reference: a list of what stands in each namespace, parts apart."""
    import periodic
    import symbolic

    def page(name: str, title: str, module: str, names: list[str]) -> None:
        lines = [title, "=" * len(title), "", f".. currentmodule:: {module}", "", ".. autosummary::"]
        lines += ["   :toctree: generated", "", *(f"   {item}" for item in sorted(names)), ""]
        text, file = "\n".join(lines), HERE / "reference" / f"{name}.rst"
        file.parent.mkdir(exist_ok=True)
        if not file.exists() or file.read_text("utf-8") != text:
            file.write_text(text, "utf-8")
        listed.update(f"{module}.{item}" for item in names)

    def front(package: ModuleType) -> list[str]:
        return [name for name in dir(package) if not isinstance(getattr(package, name), ModuleType)]

    def is_part(name: str) -> bool:
        found = getattr(symbolic, name)
        return isinstance(found, type) and issubclass(found, symbolic.Part)

    listed: set[str] = set()
    names = front(symbolic)
    page("parts", "Parts", "symbolic", [name for name in names if is_part(name)])
    page("symbolic", "symbolic: what the equations are", "symbolic", [n for n in names if not is_part(n)])
    page("periodic", "periodic: what a periodic orbit is", "periodic", front(periodic))
    for namespace, title in NAMESPACES.items():
        module = importlib.import_module(namespace)
        page(namespace.rpartition(".")[2], f"{namespace}: {title}", namespace, module.__all__)
    for file in (HERE / "reference" / "generated").glob("*.rst"):
        if file.stem not in listed:  # of a name that there was once
            file.unlink()


reference()

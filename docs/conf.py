"""The site: `make docs` builds it into docs/_build, without a network."""

from __future__ import annotations

from importlib.metadata import version as installed
from pathlib import Path

HERE = Path(__file__).parent

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
    """Write the pages of the reference: a list of what each package exports, parts apart."""
    import periodic
    import symbolic
    from symbolic import functions

    def page(name: str, title: str, module: str, names: list[str]) -> None:
        lines = [title, "=" * len(title), "", f".. currentmodule:: {module}", "", ".. autosummary::"]
        lines += ["   :toctree: generated", "", *(f"   {item}" for item in names), ""]
        text, file = "\n".join(lines), HERE / "reference" / f"{name}.rst"
        file.parent.mkdir(exist_ok=True)
        if not file.exists() or file.read_text("utf-8") != text:
            file.write_text(text, "utf-8")

    def is_part(name: str) -> bool:
        found = getattr(symbolic, name)
        return isinstance(found, type) and issubclass(found, symbolic.Part)

    names = [name for name in symbolic.__all__ if name != "functions"]
    page("parts", "Parts", "symbolic", sorted(filter(is_part, names)))
    page("symbolic", "symbolic: what the equations are", "symbolic", [n for n in names if not is_part(n)])
    page("functions", "symbolic.functions: of symbols", "symbolic.functions", sorted(functions.__all__))
    page("periodic", "periodic: what a periodic orbit is", "periodic", sorted(periodic.__all__))


reference()

"""How Sphinx makes the pages; ``make docs`` runs it, warnings being errors and nothing being fetched."""

from __future__ import annotations

import logging
import sys
from pathlib import Path
from typing import TYPE_CHECKING

sys.path[:0] = [str(Path(__file__).parent), str(Path(__file__).parents[1])]

import drawn
import ran
import mathematics

if TYPE_CHECKING:
    from sphinx.application import Sphinx

project = "cprbm"
author = "the cprbm contributors"
copyright = "the cprbm contributors, MIT licence"  # noqa: A001 - Sphinx asks for this name

extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon", "sphinx_click"]
exclude_patterns = ["made", "README.md"]
highlight_language = "text"
smartquotes = False
html_theme = "furo"
html_title = "cprbm"
html_copy_source = False
html_show_sphinx = False
html_math_renderer = "mathml"
html_static_path = ["static"]
html_css_files = ["pages.css"]

myst_enable_extensions = ["dollarmath", "colon_fence", "deflist"]
myst_heading_anchors = 3

autodoc_member_order = "bysource"
autodoc_typehints = "signature"
autodoc_preserve_defaults = True
napoleon_use_rtype = False


def setup(app: Sphinx) -> None:
    """Have figures made before pages are read, and formulas as MathML."""
    app.connect("builder-inited", _make)
    mathematics.install(app)


def _make(app: Sphinx) -> None:
    logging.getLogger("skfem").setLevel(logging.WARNING)  # it tells of every basis
    for name in drawn.make_all():
        print(f"figures of {name}")
    for name in ran.make_all():
        print(f"output of {name}")

"""Settings of Sphinx for ``make docs``: warnings are errors, and the build needs no network."""

from __future__ import annotations

import logging
import sys
from pathlib import Path

sys.path[:0] = [str(Path(__file__).parent), str(Path(__file__).parents[1])]
logging.getLogger("skfem").setLevel(logging.WARNING)  # a line per basis otherwise

python_use_unqualified_type_names = True
project = "cprbm"
author = "the cprbm contributors"
copyright = "the cprbm contributors, MIT licence"  # noqa: A001 - Sphinx asks for this name

extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
    "sphinx_click",
    "drawn",
    "key_tables",
    "pictures",
    "ran",
    "sketches",
    "mathematics",
]
exclude_patterns = ["made"]
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
autodoc_type_aliases = {"Array": "Array", "Ints": "Ints", "Flags": "Flags"}
autodoc_typehints = "signature"
autodoc_preserve_defaults = True
napoleon_custom_sections = ["Source"]
napoleon_use_ivar = True
napoleon_use_rtype = False

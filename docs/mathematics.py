"""Formulas as MathML, which browsers draw by themselves: no script, and nothing that a page would have to fetch."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from docutils import nodes
from latex2mathml.converter import convert

if TYPE_CHECKING:
    from sphinx.application import Sphinx
    from sphinx.writers.html5 import HTML5Translator

_TAG = re.compile(r"\\tag\{([^}]*)\}")


def setup(app: Sphinx) -> None:
    """Make known to Sphinx how formulas are drawn, under the name ``mathml``."""
    app.add_html_math_renderer("mathml", inline_renderers=(_inline, None), block_renderers=(_block, None))


def _inline(page: HTML5Translator, formula: nodes.math) -> None:
    page.body.append(convert(formula.astext()))
    raise nodes.SkipNode


def _block(page: HTML5Translator, formula: nodes.math_block) -> None:
    text = formula.astext()
    number = _TAG.search(text)
    told = f'<span class="eqno">({number[1]})</span>' if number else ""
    page.body.append(f'<div class="math">{convert(_TAG.sub("", text), display="block")}{told}</div>')
    raise nodes.SkipNode

"""Formulas as MathML, which browsers draw without scripts and without a network, and percentages on one line."""

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
    """Register the renderer of formulas with the name ``mathml``."""
    app.add_html_math_renderer("mathml", inline_renderers=(_inline, None), block_renderers=(_block, None))
    app.connect("doctree-resolved", _percentages)


def _percentages(app: Sphinx, document: nodes.document, name: str) -> None:
    for text in document.findall(nodes.Text):
        if " %" in text and not isinstance(text.parent, nodes.literal_block):
            text.parent.replace(text, nodes.Text(text.replace(" %", "\N{NO-BREAK SPACE}%")))


def _inline(page: HTML5Translator, formula: nodes.math) -> None:
    page.body.append(convert(formula.astext()))
    raise nodes.SkipNode


def _block(page: HTML5Translator, formula: nodes.math_block) -> None:
    text = formula.astext()
    number = _TAG.search(text)
    tag = f'<span class="eqno">({number[1]})</span>' if number else ""
    page.body.append(f'<div class="math">{convert(_TAG.sub("", text), display="block")}{tag}</div>')
    raise nodes.SkipNode

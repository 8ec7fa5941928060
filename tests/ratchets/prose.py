"""Share of pronouns in the docstrings and comments of Python modules.

A pronoun makes the reader look for the noun. Code in backticks, indented blocks and fragments of up to three words
are left out.
"""

from __future__ import annotations

import ast
import io
import re
import tokenize
from collections.abc import Iterable, Iterator

PRONOUNS = frozenset(
    {"it", "its", "that", "which", "what", "one", "ones", "each", "those", "these", "them", "they"}
    | {"who", "whose", "whatever"}
)
SHORTEST = 4
"""Least number of words in a counted sentence."""

DOCUMENTED = ast.Module | ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef
CODE = re.compile(r"``?[^`]*``?|^ {4,}.*$|^[=\- ]{4,}$", re.MULTILINE)
END_OF_SENTENCE = re.compile(r"(?<=[.!?:;])\s+|\n\s*\n|\n\s*[-*]\s")
WORD = re.compile(r"[A-Za-z][A-Za-z'’-]*")


def pronoun_share(texts: list[str]) -> float:
    """Pronouns per word in texts; zero without any word."""
    words = [word for text in texts for word in counted_words(text)]
    return sum(word in PRONOUNS for word in words) / max(len(words), 1)


def docstrings(nodes: Iterable[ast.AST]) -> Iterator[str]:
    """Docstrings, without code, of the modules, classes and functions among the nodes of syntax trees."""
    return (CODE.sub(" ", ast.get_docstring(node) or "") for node in nodes if isinstance(node, DOCUMENTED))


def comments(sources: Iterable[str]) -> Iterator[str]:
    """Comments in the sources of modules."""
    for source in sources:
        tokens = tokenize.generate_tokens(io.StringIO(source).readline)
        yield from (token.string.lstrip("# ") for token in tokens if token.type == tokenize.COMMENT)


def counted_words(text: str) -> Iterator[str]:
    """Words of a text in lower case, without the words of fragments."""
    for sentence in END_OF_SENTENCE.split(text):
        words = WORD.findall(sentence.lower())
        if len(words) >= SHORTEST:
            yield from words

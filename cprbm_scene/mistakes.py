"""Mistakes of a question, with the key, the value found and the values allowed; errors of pydantic as mistakes."""

import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from difflib import get_close_matches
from itertools import islice
from typing import Any, NamedTuple, NoReturn, get_args

from pydantic import ValidationError
from pydantic.fields import FieldInfo
from pydantic_core import ErrorDetails

LISTED = 200
"""Largest number of names, or of stations of a stage, in a message."""

_MEANT = {
    "gravity": ("distributed", "a load of kind 'distributed'"),
    "weight": ("distributed", "a load of kind 'distributed'"),
    "torque": ("moment", "a load of kind 'moment'"),
    "clamp": ("weld", "an end with joint = 'weld'"),
    "hinge": ("pin", "an end with joint = 'pin'"),
    "roller": ("slides", "a body with motion = 'slides'"),
    "pivot": ("turns", "a body with motion = 'turns'"),
    "circle": ("arc", "a curve of kind 'arc'"),
    "straight": ("line", "a curve of kind 'line'"),
}
"""Words of other programs; the words of a scene for the same, alone and with their place in a file."""
_NOT_MODELLED = re.compile("friction|temperature|thermal|plastic|yield|damping|density|mass|viscos", re.IGNORECASE)


class Mistake(NamedTuple):
    """A mistake of a problem statement.

    Attributes:
        key: the key path in the file, such as ``beams.beam1.thickness``; empty for the file as a whole.
        found: the value found; empty for the consequence of another mistake.
        allowed: the values allowed.
        file: the name of the file; empty for a scene built in Python.
    """

    key: str
    found: str
    allowed: str
    file: str = ""

    def __str__(self) -> str:
        where = ": ".join(part for part in (self.file, self.key) if part) or "scene"
        return f"{where}: found {self.found}; allowed: {self.allowed}"


MOST = 100
"""Largest number of mistakes in an error: a larger number repeats a single mistake."""


class SceneError(ValueError):
    """A wrong question: all different mistakes, up to :data:`MOST`."""

    def __init__(self, mistakes: list[Mistake] | tuple[Mistake, ...]) -> None:
        self.mistakes = tuple(dict.fromkeys(mistakes))
        super().__init__("\n".join(str(mistake) for mistake in self.mistakes))


def mistake(found: str, allowed: str, key: str = "") -> SceneError:
    """An error of a validator with both halves of a mistake's sentence, at a ``key`` below the validated field."""
    return SceneError([Mistake(key, found, allowed)])


def silent(*_: object) -> NoReturn:
    """Raise a mistake without words, the consequence of another mistake: the record is left out of the scene."""
    raise mistake("", "")


def broken(*rules: object) -> Iterator[Mistake]:
    """Mistakes of the broken rules, in order; a rule is ``condition and Mistake(...)``, true where it is broken."""
    return (rule for rule in rules if isinstance(rule, Mistake))


def refuse_broken(*rules: object) -> None:
    """Raise an error with the mistakes of all broken rules, if any.

    Raises:
        SceneError: a rule is broken.
    """
    if mistakes := list(broken(*rules)):
        raise SceneError(mistakes)


def first_alone(rules: Callable[..., Iterator[Mistake]]) -> Callable[..., Iterator[Mistake]]:
    """The rules up to the first mistake: later rules need what earlier rules ensure."""
    return lambda *given: islice(rules(*given), 1)


first_broken = first_alone(broken)
"""The mistake of the first broken rule, if any."""


def first_of(found: Iterable[Mistake], file: str = "") -> list[Mistake]:
    """The first :data:`MOST` mistakes of a ``file``, and a note if there are more."""
    some = [each._replace(file=file) for each in islice(found, MOST + 1)]
    return some if len(some) <= MOST else [*some[:MOST], Mistake("", "more mistakes", "none; mend these first", file)]


def mistakes_of(error: ValidationError) -> list[Mistake]:
    """The mistakes of a record with rules, from pydantic's error."""
    return [mistake for details in error.errors() for mistake in details["ctx"]["error"].mistakes]


def hint(word: str, known: Iterable[str]) -> str:
    """`` (is 'X' meant?)`` for a ``word`` close to a ``known`` word, upper or lower case; otherwise an empty text."""
    by_case, same = {each.casefold(): each for each in known}, word.casefold()
    term, place = _MEANT.get(same, ("", ""))
    if _NOT_MODELLED.search(word) and not any(map(_NOT_MODELLED.search, by_case)):
        return f" ({word} is not modelled)"
    near = [term] if term in by_case and same not in by_case else get_close_matches(same, by_case, n=1)
    # any two words as short as a unit are close
    if near and (len(word) > 2 or near[0] == same):
        return f" (is {by_case[near[0]]!r} meant?)"
    return f" (is {place} meant?)" if place else ""


def unknown_name(key: str, name: str, what: str, known: Iterable[str]) -> Mistake:
    """The mistake of a name of a ``what`` (such as ``beam``) outside the ``known`` names."""
    names = list(islice(dict.fromkeys(known), LISTED + 1))
    listed = ", ".join([*map(repr, names[:LISTED]), *("..." for _ in names[LISTED:])]) or "there is none"
    return Mistake(key, f"{name!r}, which names no {what}{hint(name, names)}", f"the name of a {what}: {listed}")


def written_place(place: Iterable[float]) -> str:
    """A place as text."""
    return "({:.9g}, {:.9g})".format(*place)


_MEASURED = re.compile(r"\s*[-+]?[\d.]+(?:e[-+]?\d+)?\s*[^\d\s]{1,8}\s*", re.ASCII | re.IGNORECASE)
_UNITS = """units = { length = "mm" }"""
_NUMBERS = (
    f"; numbers have no units of their own: a parameter has the key 'unit', the file the key 'units', as {_UNITS}"
)
_LONGEST = 80
"""Longest value found that a message shows in full."""

_ALLOWED = {
    "missing": "a value: this key is required",
    "finite_number": "a finite number",
    "float_type": "a number",
    "int_type": "a whole number",
    "string_type": "a text in quotes",
    "bool_type": "true or false",
    "tuple_type": "a list",
    "str for the list points": ", or the name of a table of points in a scene file",
    **{
        f"dict for the list {key}": f" of tables, each below [[{key}]]"
        for key in ("stages", "probes", "claims", "limits")
    },
    "dict_type": "a table",
    "mapping_type": "a table",
    "model_type": "a table",
    "model_attributes_type": "a table",
    "string_unicode": "a text in quotes",
    "string_pattern_mismatch": "a name of letters, digits, '_', '-' and single spaces inside, first a letter or '_'",
    "greater_than": "a number greater than {gt:g}",
    "greater_than_equal": "a number of at least {ge:g}",
    "less_than": "a number less than {lt:g}",
    "less_than_equal": "a number of at most {le:g}",
    "too_short": "at least {min_length} items",
    "too_long": "at most {max_length} items",
    "string_too_long": "at most {max_length} characters",
    "literal_error": "one of {expected}",
}
"""Allowed values by the type of an error, with the fields of the error's context; the ends of texts on lists."""


def in_words(error: ValidationError, data: object, fields: Mapping[str, FieldInfo]) -> Iterator[Mistake]:
    """Mistakes of a record with ``fields``, read from ``data``, with keys below the record's own.

    Items with mistakes of their own need no further mistake, and a misspelled key stands for the missing key.
    """
    meant = [hint(str(each["loc"][-1]), fields) for each in error.errors() if each["type"] == "extra_forbidden"]
    for details in error.errors():
        kind, given, context = details["type"], details.get("input"), details.get("ctx", {})
        short = kind == "too_short" and isinstance(given, tuple) and len(given) >= context["min_length"]
        if not short and not (kind == "missing" and f" (is {details['loc'][-1]!r} meant?)" in meant):
            key = _key(details["loc"], data, own=kind in ("missing", "extra_forbidden"))
            own = getattr(context.get("error"), "mistakes", None) or [_mistake(details, fields)]
            yield from (each._replace(key=f"{key}.{each.key}".strip(".")) for each in own)


def _mistake(details: ErrorDetails, fields: Mapping[str, FieldInfo]) -> Mistake:
    """A mistake with both halves of the message, and with the discriminator of a union as the key."""
    kind, loc, given, context = details["type"], details["loc"], details.get("input"), details.get("ctx", {})
    key, known, allowed = "", list[str](), _ALLOWED.get(kind, "{message}").format(message=details["msg"], **context)
    match kind:
        case "tuple_type":
            allowed += _ALLOWED.get(f"{type(given).__name__} for the list {loc[-1]}", "")
        case "extra_forbidden":
            return unknown_name("", str(loc[-1]), "key here", (name for name in fields if name != "file"))
        case "string_pattern_mismatch" if "x00" in context["pattern"]:
            allowed = "a text without control characters"
        case "string_pattern_mismatch" if " " not in context["pattern"]:
            allowed = "a name of letters, digits, '_' and '-' that starts with a letter or '_'"
        case "missing" if isinstance(loc[-1], int):
            allowed = "an item here: the list is too short"
        case "too_long" if context["max_length"] == len(("x", "y")):
            allowed = allowed.removeprefix("at most ")
        case "literal_error":
            known = re.findall("'([^']*)'", context["expected"])
        case "float_type":
            allowed += ", or a table with the keys 'at' and 'values'" if loc[-1] == "number" else ""
            if isinstance(given, str):
                allowed += _NUMBERS if _MEASURED.fullmatch(given) else ", or an expression that begins with '='"
        case "union_tag_invalid" | "union_tag_not_found":
            key = context["discriminator"].strip("'")
            given, known = details["input"].get(key), _tags(fields[str(loc[0])].annotation, key)
            allowed = f"one of {', '.join(map(repr, known))}"
        case "model_type" if "stress" in fields:  # of the record of units
            allowed += f", as {_UNITS}"
    found = "nothing" if kind in ("missing", "union_tag_not_found") else shown(given)
    return Mistake(key, found + (hint(given, known) if known and isinstance(given, str) else ""), allowed)


def _tags(annotation: Any, tag: str) -> list[str]:  # noqa: ANN401 - annotations have no type
    """Kinds, joints or motions of the records in an annotation."""
    fields = getattr(annotation, "model_fields", {})
    inner = [fields[tag].annotation] if tag in fields else get_args(annotation)
    return [annotation] if isinstance(annotation, str) else [name for each in inner for name in _tags(each, tag)]


def shown(value: object) -> str:
    """The value in TOML's notation, cut if the value is long."""
    match value:
        case dict():
            text = f"a table with the keys {', '.join(map(repr, value))}" if value else "an empty table"
        case tuple():
            text = f"[{', '.join(shown(item) for item in value[:9])}]"
        case bool():
            text = str(value).lower()
        case int() if value.bit_length() > 64:  # Python refuses to write the longest integers
            text = f"a whole number of {value.bit_length()} bits"
        case None | str() | int() | float():
            text = repr(value)
        case _:
            text = str(value)
    return text if len(text) <= _LONGEST else f"{text[: _LONGEST - 3]}..."


def _key(loc: tuple[int | str, ...], data: Any, *, own: bool) -> str:  # noqa: ANN401 - whatever TOML holds
    """``("beams", "b", "curve", "arc")`` as ``beams.b.curve``: the tag of a union is no key of the ``data``.

    With ``own`` the last part is a key in any case.
    """
    path, place = "", data
    for depth, part in enumerate(loc, start=1):
        tags = [place.get(tag) for tag in ("kind", "joint", "motion")] if isinstance(place, Mapping) else []
        inside = isinstance(part, int) or (isinstance(place, Mapping) and part in place and part not in tags)
        if inside or (own and depth == len(loc)):
            path += f"[{part}]" if isinstance(part, int) else f".{part}"
            place = place[part] if depth < len(loc) else None
    return path.removeprefix(".")

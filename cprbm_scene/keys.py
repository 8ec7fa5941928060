"""Keys and kinds of the tables of a scene file, from the annotations of the records."""

from __future__ import annotations

from types import NoneType, UnionType
from typing import Annotated, Any, Union, get_args, get_origin

from pydantic import BaseModel, Tag

from cprbm_scene.record import Record


def keys_at(loc: tuple[int | str, ...], root: type[Record]) -> tuple[str, ...]:
    """Keys of the table at ``loc``, a place in ``root`` as pydantic names it (tags of unions included)."""
    record = _bare(_place(loc, root))
    return tuple(key for key in record.model_fields if (record, key) != (root, "file"))


def is_tag(loc: tuple[int | str, ...], depth: int, root: type[Record]) -> bool:
    """True if ``loc`` has the tag of a union at ``depth``: a tag is no key of the file."""
    return get_origin(_bare(_place(loc[:depth], root))) in (Union, UnionType)


def tags_at(loc: tuple[int | str, ...], root: type[Record]) -> tuple[str, ...]:
    """Kinds, joints or motions of the table at ``loc``."""
    return tuple(tag for record in get_args(_bare(_place(loc, root))) for tag in _tags(record))


def _place(loc: tuple[int | str, ...], root: type[Record]) -> Any:  # noqa: ANN401 - annotations have no type
    """The annotation at ``loc``."""
    place: Any = root
    for part in loc:
        place = _below(_bare(place), part)
    return place


def _below(place: Any, part: int | str) -> Any:  # noqa: ANN401 - annotations have no type
    """The annotation one step below ``place``."""
    if isinstance(place, type) and issubclass(place, BaseModel):
        return place.model_fields[str(part)].annotation
    if get_origin(place) in (Union, UnionType):
        return next(record for record in get_args(place) if part in _tags(record))
    # of Mapping[Name, T] and tuple[T, ...], T
    return next(each for each in reversed(get_args(place)) if each is not ...)


def _bare(place: Any) -> Any:  # noqa: ANN401 - annotations have no type
    """An annotation without its metadata and without None."""
    while get_origin(place) is Annotated:
        place = get_args(place)[0]
    if get_origin(place) in (Union, UnionType):
        some = [each for each in get_args(place) if each is not NoneType]
        if len(some) == 1:
            return _bare(some[0])
    return place


def _tags(record: Any) -> tuple[str, ...]:  # noqa: ANN401 - annotations have no type
    """Tags of a member of a union."""
    if get_origin(record) is Annotated:
        return tuple(each.tag for each in get_args(record) if isinstance(each, Tag))
    fields = record.model_fields
    return get_args(next(fields[tag] for tag in ("kind", "joint", "motion") if tag in fields).annotation)

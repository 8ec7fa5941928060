"""All mistakes of a scene at once: rules within records and rules between records."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from itertools import chain

from cprbm_scene.actions import wrong_actions
from cprbm_scene.clearance import wrong_clearance
from cprbm_scene.joints import distant_ends, wrong_assembly, wrong_stops
from cprbm_scene.mistakes import Mistake, first_of
from cprbm_scene.mobility import wrong_mobility
from cprbm_scene.names import records, repeated_contacts, repeated_names, unknown_names
from cprbm_scene.offset import OffsetQuestion
from cprbm_scene.questions import wrong_claims, wrong_probes, wrong_spacings, wrong_stages
from cprbm_scene.record import Record
from cprbm_scene.statement import Scene


def broken_rules(root: Record) -> Iterator[Mistake]:
    """Mistakes within the records of a scene or another question."""
    for key, record in records(root):
        for mistake in record.rules():
            below = mistake.key if not mistake.key or not key else f".{mistake.key}"
            yield replace(mistake, key=f"{key}{below}")


_CHECKS = (
    repeated_names,
    unknown_names,
    distant_ends,
    wrong_assembly,
    wrong_stops,
    wrong_mobility,
    wrong_actions,
    repeated_contacts,
    wrong_spacings,
    wrong_clearance,
    wrong_stages,
    wrong_probes,
    wrong_claims,
)


def mistakes_in(question: Scene | OffsetQuestion) -> list[Mistake]:
    """All mistakes of a question; empty for a valid question.

    A check is silent on parts with other mistakes: a slip has a single message.
    """
    between = (check(question) for check in _CHECKS) if isinstance(question, Scene) else ()
    return [replace(mistake, file=question.file) for mistake in first_of(chain(broken_rules(question), *between))]

"""Contacts that press a beam at one place, and what of their forces mechanics says: the sum alone.

======  ==================================================================================
symbol  meaning
======  ==================================================================================
p, f    a place of a beam's neutral line where a contact presses, and the force there
D, n    distance of p from what another contact has in the way, and the normal from there; D° from its own
======  ==================================================================================

Two drawn obstacles may have a corner in common, or one may stand on the other.  Where a beam leans on both at once,

    |D − D°| ≤ SAME of the longest beam,    f·n ≥ ALIKE |f|,

each may bear all of it or none: the energy is the same, and so is everything but how the force is shared.  It is found
from the scene and from where an answer says that contacts press, also of a contact which that answer leaves without
force.  One with thickness and one of lines are at no one place.  Of lines, whose normal is lost where they touch, the
second condition is not asked, and ends of beams, which two sides of a corner may hold, are left out.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Mapping, Set
from itertools import permutations

import numpy as np

from comparisons.audit.gaps import Rigid, faced
from comparisons.audit.rest import rests_of
from comparisons.audit.seen import Seen, seen_of
from cprbm_scene import Answer, Scene, StationAnswer
from cprbm_scene.answer import Array, Flags, Statics

SAME = 2e-6  # of the longest beam: what the rounding of a drawing leaves between surfaces at one place
ALIKE = 0.999  # cosine
NOTHING = 1e-3  # of a contact's largest force: where it hardly presses is no place of its

Where = tuple[str, float]
"""A stage and a station."""


def sharing(scene: Scene, answers: Iterable[Answer]) -> Mapping[Where, Mapping[str, frozenset[str]]]:
    """By station and contact the other contacts with which it presses at one place in some of the answers."""
    pairs = _candidates(scene)
    found: defaultdict[Where, defaultdict[str, set[str]]] = defaultdict(lambda: defaultdict(set))
    if not pairs:
        return {}
    rests = rests_of(scene)
    for answer in answers:
        for seen in seen_of(scene, answer, rests):
            for one, other in pairs:
                if _at_one_place(seen, one, other):
                    here = found[seen.station.stage, seen.station.value]
                    here[one].add(other)
                    here[other].add(one)
    return {where: {name: frozenset(others) for name, others in here.items()} for where, here in found.items()}


def resultant(station: StationAnswer, contacts: frozenset[str], beam: str) -> Array | None:
    """Magnitude of the force (1,) with which contacts press a beam together, N; None where nothing says what acts."""
    if station.statics is None:
        return None
    return np.array([np.hypot(*station.statics.forces[exerted(station.statics, contacts, beam)].sum(axis=0))])


def exerted(statics: Statics, contacts: Set[str], beam: str) -> Flags:
    """What of all that acts some ``contacts`` or joints exert on a beam, (k,)."""
    return np.array([by in contacts and on == beam for by, on in zip(statics.by, statics.on, strict=True)], dtype=bool)


def _candidates(scene: Scene) -> list[tuple[str, str]]:
    """Ordered pairs of contacts of one beam with one body, or with bodies that do not move."""
    rigid = {name: contact for name, contact in scene.contacts.items() if isinstance(contact, Rigid)}

    def on(contact: Rigid) -> tuple[str, str, bool]:
        still = scene.bodies[contact.body].motion == "fixed"
        return contact.beam, "" if still else contact.body, contact.thick

    return [pair for pair in permutations(rigid, 2) if on(rigid[pair[0]]) == on(rigid[pair[1]])]


def _at_one_place(seen: Seen, one: str, other: str) -> bool:
    """Whether where one contact presses the other touches too."""
    own, contact = seen.scene.contacts[one], seen.scene.contacts[other]
    assert isinstance(own, Rigid)
    assert isinstance(contact, Rigid)
    acting, rest = seen.acting[contact.beam], seen.rests[contact.beam]
    size = np.abs(acting.forces)
    mine = np.array([by == one for by in acting.by], dtype=bool)
    mine &= size > NOTHING * max(size[mine], default=0.0)
    if not contact.thick:
        mine &= (acting.s > 0.0) & (acting.s < rest.length)
    if not mine.any():
        return False
    s, forces = acting.s[mine], acting.forces[mine]
    places = seen.beams[contact.beam].line(s)[0]
    feet, its_own = faced(seen, contact, places), faced(seen, own, places)
    touching = np.abs(feet.distance - its_own.distance) <= SAME * seen.longest
    if contact.thick:
        touching &= (forces * np.conj(feet.normal)).real >= ALIKE * np.abs(forces)
    return bool(touching.any())

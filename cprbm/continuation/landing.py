"""Bodies that contacts alone hold: the way to the first contact, before the first stage.

=======  ====================================================================================
symbol   meaning
=======  ====================================================================================
s        displacement or rotation of a body with a single motion, zero as drawn
μ, f     force and value of the row of the load that the first stage steps
g        least gap
=======  ====================================================================================

As drawn no force resists s: the motion is neutral.  The load moves the body in the sense in which μ f falls, until a
contact closes at g = 0.  From there on the contact holds the body.  A row prescribes s on the way, and is then free.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from cprbm.chain import Mechanism, Row
from cprbm.continuation.closing import CLOSED, kept_open
from cprbm.continuation.limits import located
from cprbm.equilibrium.contact_gaps import least_gap
from cprbm.equilibrium.newton import NotConvergedError, Solved
from cprbm.equilibrium.solving import equilibrium
from cprbm.equilibrium.system import System
from cprbm.settings import loose_bodies
from cprbm_scene.statement import SlidingBody

SHORTEST = 1e-3
"""First way in a search for a contact, longest beams or rad; every further way is twice as long."""

DOUBLINGS = 11
"""Ways of a search: the last leads two lengths of the longest beam far."""

FIRST_LOAD = 1e-3
"""Part of the first station's load under which the contact takes over the body."""


def landing_rows(m: Mechanism) -> Iterator[Row]:
    """Rows that prescribe s of the loose bodies."""
    for name in loose_bodies(m.scene) if m.scene.contacts else ():
        body = m.scene.bodies[name]
        if isinstance(body, SlidingBody):
            along = np.array(body.along) / np.hypot(*body.along)
            yield Row(f"landing.{name}", m.displacement(next(iter(body.points)), (float(along[0]), float(along[1]))))
        else:
            yield Row(f"landing.{name}", m.rotation(name))


def landed(system: System, first: Solved, iterations: int) -> Solved:
    """The state in which contacts hold all loose bodies, under a small part of the first load.

    Raises:
        NotConvergedError: a motion stays neutral, or a state on the way was not found.
    """
    for number, row in enumerate(system.mechanism.rows):
        if row.name.startswith("landing."):
            first = _landed(system, first, number, iterations)
    return first


def _landed(system: System, first: Solved, row: int, iterations: int) -> Solved:
    m, name = system.mechanism, system.mechanism.rows[row].name.removeprefix("landing.")
    stage = m.scene.stages[0]
    load = m.row(stage.steps)
    every = frozenset(range(len(system.geometry.pairs)))

    def moved(s: float, pairs: frozenset[int]) -> Solved:
        target = first.state.target.copy()
        target[row] = s
        return equilibrium(system, kept_open(replace(first.state, target=target), pairs), iterations)

    pushed = m.rows[load].unit * stage.stations[0] if not first.state.driven[load] else 0.0
    work = pushed * float((moved(SHORTEST, every).values - moved(-SHORTEST, every).values)[load])
    if work == 0.0:
        raise NotConvergedError(f"body '{name}' is neutral: no contact and no load holds the body")
    sense = -np.sign(work)

    def gap(s: float) -> float:
        solved = moved(sense * s, every)
        return min(least_gap(system.geometry, solved.state.z, solved.state.contacts, pair) for pair in every) + CLOSED

    far = next((way for way in SHORTEST * 2.0 ** np.arange(DOUBLINGS) if gap(way) < 0.0), None)
    if far is None:
        raise NotConvergedError(f"body '{name}' is neutral: '{stage.steps}' moves the body into no contact")
    touching = moved(sense * far * located(lambda share: gap(share * far)), frozenset())
    target, driven = touching.state.target.copy(), touching.state.driven.copy()
    target[row], driven[row], target[load] = 0.0, False, FIRST_LOAD * pushed
    return equilibrium(system, replace(touching.state, target=target, driven=driven), iterations)

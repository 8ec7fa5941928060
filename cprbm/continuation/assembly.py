"""The way to the first state: ends drawn apart from their points, and bodies that contacts alone hold.

=======  ====================================================================================
symbol   meaning
=======  ====================================================================================
s        displacement or rotation of a body with a single motion, zero as drawn
μ        multiplier of the row that prescribes s: the push of loads and contacts along s
g        least gap
=======  ====================================================================================

The assembly has three parts: moments grow on the free ends; the ends go straight to their points; the moments vanish.
The rows of the ends have a prescribed force in the first part and a prescribed value in the others.  Stops act in the
last part.

No force resists s of a body that contacts alone hold: the motion is neutral as drawn.  A small part of the first load
or drive acts, with a row that prescribes s of every such body.  The body with the largest push μ moves in the sense of
μ until a contact closes at g = 0.  From there on the contact holds the body, and the row is free.  The push goes on
to the next body.

A beam with a pinned end may lie on a contact with the other end.  The motion about the pin is neutral as drawn,
too, and the places that touch as drawn begin as closed places: the first load presses them, or opens them.
"""

from collections.abc import Iterator, Mapping
from contextlib import suppress
from dataclasses import replace

import numpy as np

from cprbm.chain import Mechanism, Row, apart_ends, stop_angle, unit_direction
from cprbm.continuation.closing import CLOSED, drawn_names, kept_open, located, nearest_place, pressing, pressing_names
from cprbm.continuation.driver import Driver, StepError
from cprbm.continuation.path import Way
from cprbm.equilibrium import (
    NotConvergedError,
    Solved,
    State,
    System,
    equilibrium,
    repeated_rows,
    rest_state,
    with_touching,
)
from cprbm.settings import Settings, loose_bodies
from cprbm_scene import Ending, Mistake
from cprbm_scene.answer import Array, Flags
from cprbm_scene.mistakes import refuse_broken
from cprbm_scene.statement import SlidingBody

PASSED = 1e-6
"""Turn, rad, by which the assembled state may be beyond a stop's limit."""

SHORTEST = 1e-3
"""First way in a search for a contact, longest beams or rad; every further way is twice as long."""

DOUBLINGS = 11
"""Ways of a search: the last leads two lengths of the longest beam far."""

NEUTRAL = 1e-9
"""Push on a body, over the largest force of a row, that counts as none: round-off."""

FIRST_LOAD = 1e-3
"""Part of the first station's load under which the contact takes over the body."""


def assembled(system: System, settings: Settings) -> Driver:
    """Driver at the first state of the first stage.

    Raises:
        StepError: no state is found; the sentence names the part of the assembly.
        SceneError: a stop forbids the assembled state.
    """
    state = rest_state(system)
    apart = {f"{beam}@{end}.{axis}" for beam, end in apart_ends(system.mechanism) for axis in "xy"}
    loose = np.array([row.name in apart for row in system.mechanism.rows], dtype=bool)
    state = without_repeated(system, replace(state, driven=state.driven & ~loose))
    try:
        first = equilibrium(system, state, settings.iterations)
        passed = system.limits & (first.values < 0.0)
        if system.mechanism.scene.assembly is None and passed.any():
            # rounded coordinates of a beam drawn beyond an edge at the own pin: the beam turns to the edge
            first = equilibrium(system, replace(first.state, driven=first.state.driven | passed), settings.iterations)
        first, drawn = landed(system, first, settings.iterations), drawn_names(system, state)
        first = with_touching(first) if drawn else first
    except NotConvergedError as failure:
        raise StepError(Ending.STEP_TOO_SMALL, f"no equilibrium as drawn: {failure}") from failure
    driver = Driver(system, settings, first, np.zeros(len(loose), dtype=bool), drawn=drawn)
    scene = system.mechanism.scene
    if scene.assembly is not None:
        _assemble(system, driver, loose, scene.assembly.moments)
    driver.acting, driver.touching = system.limits, driver.drawn | pressing_names(driver.solved)
    return driver


def without_repeated(system: System, state: State) -> State:
    """The state without repeated rows."""
    repeated = repeated_rows(system, state)
    return replace(state, driven=(state.driven | state.repeated) & ~repeated, repeated=repeated)


def _assemble(system: System, driver: Driver, loose: Flags, moments: Mapping[str, float]) -> None:
    m, zero = system.mechanism, np.zeros(len(loose))
    loaded = zero.copy()
    for beam, moment in moments.items():
        row = m.row(f"assembly.{beam}")
        loaded[row] = moment * m.rows[row].unit
    _part(driver, Way(zero, loaded), "the moments of the assembly grow")
    apart = np.where(loose, driver.solved.values, 0.0)
    state = driver.solved.state
    held = without_repeated(system, replace(state, driven=state.driven | loose, target=loaded + apart))
    driver.solved = equilibrium(system, held, driver.settings.iterations)
    _part(driver, Way(loaded + apart, loaded), "the ends go to their points")
    refuse_broken(*_forbidden(system, driver.solved.state.z))
    driver.acting = system.limits
    _part(driver, Way(loaded, zero), "the moments of the assembly go away")


def _part(driver: Driver, way: Way, sentence: str) -> None:
    try:
        driver.follow(way, "stop")
    except StepError as failure:
        raise StepError(failure.ending, f"{failure.ending.value}: as {sentence}, {failure}") from failure


def _forbidden(system: System, z: Array) -> Iterator[Mistake]:
    """Stops that the assembled state violates."""
    scene = system.mechanism.scene
    for name, stop in scene.stops.items():
        angle = stop_angle(system.mechanism, name).value(z)
        for key, limit, sign in (("least", stop.least, -1.0), ("most", stop.most, 1.0)):
            if limit is not None and sign * (angle - limit) > PASSED:
                yield Mistake(
                    f"stops.{name}.{key}",
                    f"{limit:g} rad: a stop that forbids the assembly, by which {stop.beam!r} comes to stand at "
                    f"{angle:.4g} rad",
                    "limits that the assembled beam keeps, or other moments",
                    scene.file,
                )


def landing_rows(m: Mechanism) -> Iterator[Row]:
    """Rows that prescribe s of the loose bodies."""
    for name in loose_bodies(m.scene) if m.scene.contacts else ():
        body = m.scene.bodies[name]
        form = (
            m.displacement(next(iter(body.points)), unit_direction(body.along))
            if isinstance(body, SlidingBody)
            else m.rotation(name)
        )
        yield Row(f"landing.{name}", form)


def landed(system: System, first: Solved, iterations: int) -> Solved:
    """The state in which contacts hold all loose bodies, under a small part of the first load.

    Raises:
        NotConvergedError: a motion stays neutral, or a state on the way was not found.
    """
    rows, stage = system.mechanism.rows, system.mechanism.scene.stages[0]
    loose = [number for number, row in enumerate(rows) if row.name.startswith("landing.")]
    if loose:
        load, target = system.mechanism.row(stage.steps), first.state.target.copy()
        target[load] = FIRST_LOAD * rows[load].unit * stage.stations[0]
        first = equilibrium(system, replace(first.state, target=target), iterations)
    while loose:
        pushes = first.state.multipliers(system)
        row = max(loose, key=lambda number: abs(pushes[number]))
        if abs(pushes[row]) <= NEUTRAL * np.abs(pushes).max():
            raise _neutral(rows[row], "no contact and no load holds the body")
        first = _landed(system, first, row, iterations)
        loose.remove(row)
    return first


def _landed(system: System, first: Solved, row: int, iterations: int) -> Solved:
    """The state in which a contact holds a pushed body; the row of the body prescribes s until then."""
    sense, apart = np.sign(first.state.multipliers(system)[row]), frozenset(range(len(system.geometry.pairs)))
    apart -= pressing(first)

    def moved(s: float, pairs: frozenset[int], *, free: bool = False) -> Solved:
        target, driven = first.state.target.copy(), first.state.driven.copy()
        target[row], driven[row] = 0.0 if free else sense * s, not free
        return equilibrium(system, kept_open(replace(first.state, target=target, driven=driven), pairs), iterations)

    def gap(s: float) -> float:
        solved = moved(s, apart)
        return min(nearest_place(system.geometry, solved.state, pair)[0] for pair in apart) + CLOSED

    with suppress(NotConvergedError):  # contacts that press may hold the body
        if pressing(first):
            return moved(0.0, frozenset(), free=True)
    far = next((way for way in SHORTEST * 2.0 ** np.arange(DOUBLINGS) if gap(way) < 0.0), None)
    if far is None:
        raise _neutral(system.mechanism.rows[row], "the load moves the body into no contact")
    first = moved(far * located(lambda share: gap(share * far)), frozenset())
    return moved(0.0, frozenset(), free=True)


def _neutral(row: Row, why: str) -> NotConvergedError:
    """The error for a body without resistance to motion."""
    return NotConvergedError(f"body '{row.name.removeprefix('landing.')}' is neutral: {why}")

"""The assembly: ends drawn apart from their points go to the points, before the first stage.

Three parts: moments grow on the free ends; the ends go straight to their points; the moments vanish.
The rows of the ends have a prescribed force in the first part and a prescribed value in the others.  Stops act in the
last part.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace

import numpy as np

from cprbm.chain import apart_ends, stop_angle
from cprbm.continuation.closing import drawn_names, pressing_names
from cprbm.continuation.driver import Driver, StepError
from cprbm.continuation.landing import landed
from cprbm.continuation.path import Way
from cprbm.equilibrium.newton import NotConvergedError
from cprbm.equilibrium.rank import repeated_rows
from cprbm.equilibrium.solving import equilibrium
from cprbm.equilibrium.system import State, System, rest_state
from cprbm.settings import Settings
from cprbm_scene import Ending, Mistake, SceneError
from cprbm_scene.answer import Array, Flags

PASSED = 1e-6
"""Turn, rad, by which the assembled state may be beyond a stop's limit."""


def assembled(system: System, settings: Settings) -> Driver:
    """Driver at the first state of the first stage.

    Raises:
        StepError: no state is found; the sentence names the part of the assembly.
        SceneError: a stop forbids the assembled state.
    """
    state = rest_state(system)
    loose = _loose_rows(system)
    state = without_repeated(system, replace(state, driven=state.driven & ~loose))
    try:
        first = equilibrium(system, state, settings.iterations)
        passed = system.limits & (first.values < 0.0)
        if system.mechanism.scene.assembly is None and passed.any():
            # rounded coordinates of a beam drawn beyond an edge at the own pin: the beam turns to the edge
            closed = replace(first.state, driven=first.state.driven | passed)
            first = equilibrium(system, closed, settings.iterations)
        first = landed(system, first, settings.iterations)
    except NotConvergedError as failure:
        raise StepError(Ending.STEP_TOO_SMALL, f"no equilibrium as drawn: {failure}") from failure
    driver = Driver(system, settings, first, np.zeros(len(loose), dtype=bool), drawn=drawn_names(system, state))
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
    _check_stops(system, driver.solved.state)
    driver.acting = system.limits
    _part(driver, Way(loaded, zero), "the moments of the assembly go away")


def _part(driver: Driver, way: Way, sentence: str) -> None:
    try:
        driver.follow(way, "stop")
    except StepError as failure:
        raise StepError(failure.ending, f"{failure.ending.value}: as {sentence}, {failure}") from failure


def _loose_rows(system: System) -> Flags:
    """Rows of the ends drawn apart."""
    names = {f"{beam}@{end}.{axis}" for beam, end in apart_ends(system.mechanism) for axis in "xy"}
    return np.array([row.name in names for row in system.mechanism.rows], dtype=bool)


def _check_stops(system: System, state: State) -> None:
    mistakes = list(_forbidden(system, state.z))
    if mistakes:
        raise SceneError(mistakes)


def _forbidden(system: System, z: Array) -> Iterator[Mistake]:
    scene = system.mechanism.scene
    for name, stop in scene.stops.items():
        angle = stop_angle(system.mechanism, name).value(z)
        for key, limit, sign in (("least", stop.least, -1.0), ("most", stop.most, 1.0)):
            if limit is not None and sign * (angle - limit) > PASSED:
                found = (
                    f"{limit:g} rad: a stop that forbids the assembly, by which {stop.beam!r} comes to stand at "
                    f"{angle:.4g} rad"
                )
                allowed = "limits that the assembled beam keeps, or other moments"
                yield Mistake(f"stops.{name}.{key}", found, allowed, scene.file)

"""Changes of closed contacts: opening, sliding onto an end, wrapping around a circle."""

from dataclasses import replace

import numpy as np

from elastica_reference.newton import LostError
from elastica_reference.restructure import NotCoveredError, moved_to_ends
from elastica_reference.state import State
from elastica_reference.structure import Resting, Touch, Wrap
from elastica_reference.way import Stepping, places_of, touches_of

LEAST_FORCE = -1e-10  # of a contact's force, dimensionless
_LEAST_WRAP_FORCE = -1e-6  # times a wrap's force
_CUTS = -1e-9  # curvature of the gap beside a place on a circle, dimensionless
_FIRST_LENGTH = 1e-3  # times a beam's length: half length of a new wrap
_ABOUT_TO_SLIDE = 0.05  # times a beam's length: distance from which a place of contact may come to an end
_LOOKED_AT = 101  # samples along a wrap


def open_first_contact(stepping: Stepping, trial: State) -> bool:
    """Step to the first opening of a contact in tension; True if there is any.

    Raises:
        LostError: the opening was not found.
    """
    shares = {}
    for name, force in trial.forces.items():
        if force < LEAST_FORCE:
            was = stepping.state.forces[name]
            shares[name] = was / (was - force) if was > 0.0 else 0.0
    if not shares:
        return False
    name = min(shares, key=lambda key: shares[key])
    near = stepping.lam + shares[name] * (trial.lam - stepping.lam)
    at = stepping.at(name, 0.0, near, trial.lam) if shares[name] > 0.0 else stepping.state
    stepping.accept(stepping.restructured(touches_of(at.structure, name), places_of(at, name), at, at.lam))
    stepping.record_side(at.structure.touches[name])
    return True


def change_form(stepping: Stepping, trial: State) -> bool:
    """Replace places by wraps or end contacts, and conversely, where needed; True if there was any change.

    Raises:
        LostError: no equilibrium in the new form.
        NotCoveredError: there are no equations for the new form.
    """
    touches, places = dict(trial.structure.touches), dict(trial.places)
    for name, touch in trial.structure.touches.items():
        strip = stepping.model.strips[touch.beam]
        if isinstance(touch, Wrap):
            _check_wrap(trial, touch)
            a, b = trial.wrap_range(touch)
            if b < a:
                del places[name, "begin"], places[name, "end"]
                touches[name], places[name, touch.beam] = Resting(name, touch.beam, None), 0.5 * (a + b)
            continue
        touches[name], places = moved_to_ends(trial, stepping.model, touch, places)
        if (
            touches[name] == touch
            and isinstance(touch, Resting)
            and touch.at is None
            and _cuts_into_circle(trial, touch)
        ):
            s = places.pop((name, touch.beam))
            touches[name] = Wrap(name, touch.beam, sense_of(trial, touch, s))
            half = _FIRST_LENGTH * strip.length
            places[name, "begin"], places[name, "end"] = s - half, s + half
    if touches == dict(trial.structure.touches) and not _out_of_order(trial):
        return False
    fresh = stepping.restructured(touches, places, stepping.known, trial.lam, forces=trial.forces)
    if not presses(fresh):
        raise LostError
    stepping.accept(fresh)
    return True


def slide_onto_end(stepping: Stepping, goal: float) -> bool:
    """Step to the arrival of a place of contact at an end of its beam, if near; True on success."""
    now = stepping.state
    for name, touch in now.structure.touches.items():
        if isinstance(touch, Wrap) or touch.at is not None:
            continue
        length, s = stepping.model.strips[touch.beam].length, now.places[name, touch.beam]
        end = length if s > 0.5 * length else 0.0
        if abs(s - end) > _ABOUT_TO_SLIDE * length:
            continue
        try:
            at = stepping.at((name, touch.beam), end, goal, goal)
            touches: dict[str, Touch] = {**now.structure.touches, name: replace(touch, at=end)}
            places = {key: value for key, value in at.places.items() if key != (name, touch.beam)}
            stepping.accept(stepping.restructured(touches, places, at, at.lam))
        except LostError:
            continue
        return True
    return False


def presses(state: State) -> bool:
    """True if every contact presses and every wrap has a non-negative length within its beam."""
    if any(force < LEAST_FORCE for force in state.forces.values()):
        return False
    for touch in state.structure.touches.values():
        if isinstance(touch, Wrap):
            a, b = state.wrap_range(touch)
            if not 0.0 <= a <= b <= state.equations.model.strips[touch.beam].length or _is_pulling(state, touch):
                return False
    return True


def sense_of(state: State, touch: Resting | Wrap, s: float) -> float:
    """+1 if a beam runs around its circle counter-clockwise, else −1."""
    x, y, theta = state.along(touch.beam, np.array([s]))[:3, 0]
    arm = np.array([x, y]) - state.evaluation.centres[touch.contact][:, 0]
    return float(np.sign(arm[0] * np.sin(theta) - arm[1] * np.cos(theta)))


def _check_wrap(trial: State, wrap: Wrap) -> None:
    """Check that a wrap presses everywhere, and neither begins nor ends beyond its beam."""
    a, b = trial.wrap_range(wrap)
    if wrap.held and b < a:
        raise NotCoveredError(f"{wrap.beam} leaves the circle of {wrap.contact} at its clamp")
    if a < 0.0 or b > trial.equations.model.strips[wrap.beam].length:
        raise LostError
    if b >= a and _is_pulling(trial, wrap):
        raise NotCoveredError(f"{wrap.beam} does not press on the circle of {wrap.contact} all along its wrap")


def _is_pulling(state: State, wrap: Wrap) -> bool:
    a, b = state.wrap_range(wrap)
    pressure, begin, end = state.pressures(wrap, np.linspace(a, b, _LOOKED_AT))
    size = float(np.hypot(*state.evaluation.resultants[wrap.contact][:, 0]))
    return min(float(np.min(pressure)) * (b - a), begin, end) < _LEAST_WRAP_FORCE * size


def _cuts_into_circle(state: State, touch: Resting) -> bool:
    """True if a beam in contact with a circle at a place cuts into the circle on both sides."""
    strip = state.equations.model.strips[touch.beam]
    s = np.array([state.places[touch.contact, touch.beam]])
    x, y, theta, m = state.along(touch.beam, s)[:4, 0]
    arm = np.array([x, y]) - state.evaluation.centres[touch.contact][:, 0]
    rho = float(np.hypot(*arm))
    kappa = float((strip.line.curvature(s) + strip.compliance(s) * m)[0])
    away = kappa * (-np.sin(theta) * arm[0] + np.cos(theta) * arm[1]) / rho
    return bool(away + 1.0 / rho < _CUTS)


def _out_of_order(state: State) -> bool:
    """True if a place of contact has passed a knot or another place."""
    return any(float(part.b[0]) < float(part.a[0]) for parts in state.evaluation.parts.values() for part in parts)

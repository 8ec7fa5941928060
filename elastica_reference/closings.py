"""Closing of contacts at overlaps."""

import math
from dataclasses import replace

import numpy as np

from cprbm_scene import CircleContact
from elastica_reference.changes import presses, sense_of
from elastica_reference.evaluation import Columns, Evaluation
from elastica_reference.gaps import Overlap
from elastica_reference.newton import LostError
from elastica_reference.restructure import NotCoveredError, moved_to_ends, touch_for
from elastica_reference.state import State
from elastica_reference.structure import Meeting, Resting, Touch, Wrap
from elastica_reference.way import Stepping

_NEAR_END = 0.2  # times a beam's length: range in which a contact at an end moves inwards
_SHALLOW = 1e-4  # units of length: largest depth of an overlap that counts as a second place
_ON_CIRCLE = 1e-9  # relative tolerance for an end clamped on a circle, tangent to it
_FIRST_PLACES = (0.02, 0.01, 0.005)  # times a beam's length: first places of a contact that leaves a clamp
_FIRST_WRAPS = (0.25, 0.1, 0.03)  # shares of the distance to an overlap: first wraps from a clamp
_PULLS = -1e-9  # of a pressure and of a force, dimensionless


def close_first(stepping: Stepping, trial: State, overlaps: list[Overlap]) -> None:
    """Step to the first closing among the overlaps of a trial.

    Raises:
        LostError: the closing was not found.
        NotCoveredError: there are no equations for the closing.
    """
    reached: list[tuple[State, Overlap]] = []
    # where an end in contact moves inwards, both beams overlap: the overlap of the end's own beam comes first
    ends = {
        touch.beam for touch in trial.structure.touches.values() if not isinstance(touch, Wrap) and touch.at is not None
    }
    for overlap in sorted(overlaps, key=lambda overlap: overlap.beam not in ends):
        present = trial.structure.touches.get(overlap.contact)
        if present is not None:
            _move_inwards(stepping, trial, present, overlap)
            return
        clamp = _clamped_on(stepping, overlap)
        if clamp is not None:
            _continue_from_clamp(stepping, trial, overlap, clamp)
            return
        touch, own = touch_for(stepping.model, overlap)
        touches: dict[str, Touch] = {**trial.structure.touches, overlap.contact: touch}
        state = stepping.restructured(touches, {**trial.places, **own}, trial, trial.lam, pinned=overlap.contact)
        ended, places = moved_to_ends(state, stepping.model, touch, state.places)
        if ended != touch:
            touches[overlap.contact] = ended
            state = stepping.restructured(touches, places, state, state.lam, pinned=overlap.contact)
            if moved_to_ends(state, stepping.model, ended, state.places)[0] != ended:
                raise LostError
        reached.append((stepping.between(state, trial.lam), overlap))
    state, overlap = min(reached, key=lambda item: abs(item[0].lam - stepping.lam))
    stepping.record_closing(overlap.contact, state.lam, trial.lam)
    stepping.accept(state)


def _move_inwards(stepping: Stepping, trial: State, present: Touch, overlap: Overlap) -> None:
    """Continue a contact at a beam's end between the ends; elsewhere the overlap would be a second place."""
    length = stepping.model.strips[overlap.beam].length
    second = NotCoveredError(f"{overlap.contact} touches at a second place or along a length")
    if isinstance(present, Wrap) or present.at is None or overlap.beam != present.beam:
        raise second
    # a contact moving inwards starts at the end: a smaller step excludes a second place
    otherwise = second if overlap.gap > -_SHALLOW else LostError()
    if abs(overlap.s - present.at) > _NEAR_END * length:
        raise otherwise
    places = {**trial.places, (overlap.contact, overlap.beam): overlap.s}
    if isinstance(present, Meeting):
        places[overlap.contact, present.onto] = overlap.sigma
    touches: dict[str, Touch] = {**trial.structure.touches, overlap.contact: replace(present, at=None)}
    fresh = stepping.restructured(touches, places, trial, trial.lam)
    if not presses(fresh) or not 0.0 <= fresh.places[overlap.contact, overlap.beam] <= length:
        raise otherwise
    stepping.accept(fresh)


# ------------------------------------------------------------------------------- a clamp on the circle


def _clamped_on(stepping: Stepping, overlap: Overlap) -> str | None:
    """End of the beam clamped on the circle, tangent to it, near an overlap; None without such an end."""
    scene, strip = stepping.model.scene, stepping.model.strips[overlap.beam]
    contact = scene.contacts[overlap.contact]
    if not isinstance(contact, CircleContact):
        return None
    for which, end, s in (("start", strip.start, 0.0), ("end", strip.end, strip.length)):
        if end.point is None or not end.welded or scene.body_of(end.point) != contact.body:
            continue
        arm = stepping.model.rest(end.point) - np.array(contact.center) / stepping.model.unit_length
        half = float(strip.half_thickness(np.array([s]))[0]) if contact.thick else 0.0
        rho, theta = contact.radius / stepping.model.unit_length + half, float(strip.line.angle(np.array([s]))[0])
        on_it = abs(math.hypot(*arm) - rho) < _ON_CIRCLE
        tangent = abs(arm[0] * math.cos(theta) + arm[1] * math.sin(theta)) < _ON_CIRCLE
        if on_it and tangent and abs(overlap.s - s) < 0.5 * strip.length:
            return which
    return None


def _continue_from_clamp(stepping: Stepping, trial: State, overlap: Overlap, which: str) -> None:
    """Step to equal curvatures of a clamped end and its circle, then continue on or off the circle.

    The contact at once carries the whole shear force of the clamp.
    """
    strip, name = stepping.model.strips[overlap.beam], overlap.contact
    s = 0.0 if which == "start" else strip.length
    clamp = np.array([s])
    arm = trial.along(strip.name, clamp)[:2, 0] - trial.evaluation.centres[name][:, 0]
    sense = sense_of(trial, Resting(name, strip.name, None), s)
    kappa = sense / math.hypot(*arm)
    wanted = float((strip.rigidity(clamp) * (kappa - strip.line.curvature(clamp)))[0])

    def bent(z: Columns, evaluation: Evaluation) -> Columns:
        part = evaluation.parts[strip.name][0 if which == "start" else -1]
        moment: Columns = part.start[3] if which == "start" else part.end[3]
        return moment - wanted

    at = stepping.restructured(trial.structure.touches, trial.places, trial, trial.lam, condition=bent)
    stepping.between(at, trial.lam)
    stepping.record_closing(name, at.lam, trial.lam)
    stepping.accept(at)
    state = _wrap_from_clamp(stepping, trial, overlap, which, sense) or _place_beyond_clamp(
        stepping, trial, overlap, which
    )
    if state is None:
        raise NotCoveredError(f"the beginning of {name} beside the clamp of {strip.name} was not found")
    stepping.accept(state)


def _wrap_from_clamp(stepping: Stepping, trial: State, overlap: Overlap, which: str, sense: float) -> State | None:
    """State with a wrap from the clamp, if it presses; else None."""
    at, name, strip = stepping.state, overlap.contact, stepping.model.strips[overlap.beam]
    if strip.beam.tapered and stepping.model.scene.contacts[name].thick:
        return None
    s, key = (0.0, "end") if which == "start" else (strip.length, "begin")
    wrap = Wrap(name, strip.name, sense, from_start=which == "start", to_end=which == "end")
    for share in _FIRST_WRAPS:
        places = {**at.places, (name, key): s + share * (overlap.s - s)}
        try:
            state = stepping.restructured({**at.structure.touches, name: wrap}, places, at, at.lam, pinned=(name, key))
            stepping.between(state, trial.lam)
        except LostError:
            continue
        pressure, begin, end = state.pressures(wrap, np.linspace(*state.wrap_range(wrap), 101))
        return state if min(float(np.min(pressure)), begin, end) > _PULLS else None
    return None


def _place_beyond_clamp(stepping: Stepping, trial: State, overlap: Overlap, which: str) -> State | None:
    """State with a place of contact that moves away from the clamp; None if there is none."""
    at, name, strip = stepping.state, overlap.contact, stepping.model.strips[overlap.beam]
    clamp = at.along(strip.name, np.array([0.0 if which == "start" else strip.length]))[:, 0]
    arm = clamp[:2] - at.evaluation.centres[name][:, 0]
    shear = abs(float(clamp[4:] @ arm) / math.hypot(*arm))
    for share in _FIRST_PLACES:
        s = share * strip.length if which == "start" else (1.0 - share) * strip.length
        places = {**at.places, (name, strip.name): s}
        touches: dict[str, Touch] = {**at.structure.touches, name: Resting(name, strip.name, None)}
        try:
            state = stepping.restructured(touches, places, at, at.lam, forces={name: shear}, pinned=(name, strip.name))
            stepping.between(state, trial.lam)
        except LostError:
            continue
        if state.forces[name] > 0.0:
            return state
    return None

"""Contacts of a mechanism that is acted on: things in its way, one after the other, each where the others let it go."""

from __future__ import annotations

from collections.abc import Sequence
from copy import deepcopy

import numpy as np

from tests.robustness.chance import RedrawError, happens, weighted
from tests.robustness.draft import Data, Draft
from tests.robustness.estimate import Barrier, Estimate, State, followed
from tests.robustness.obstacles import Obstacle, Spot, companion, is_clear, rigid, spot_on

MOST_BEAMS = 4
_TRIES = 10
_STRIDE = 2  # of the states without a barrier, which are followed anew with it
_AWAY = 0.85  # of the states before one that was not found
DEEP = 0.2  # of the size: farther behind it is what has come round its end
SUNK = 0.03  # of the size: a node that sinks deeper into a barrier is led there, and nothing gives way
TAKEN = 1e-5  # of the size: so near to a barrier's surface a spot is on it
_LATE = 0.6  # of the mechanisms: what is in their way they meet once they have turned far, if they do
_REACHED = 0.55  # of the way: a mechanism that a barrier ends before is left without it


def put_in_the_way(
    draft: Draft, model: Estimate, states: Sequence[State], acting: Sequence[str]
) -> tuple[list[State], list[Barrier]]:
    """Put none to four things in the way of some beams; the states with them, as far as they go, and what they are.

    The stages' loads and drives are ``acting`` one after the other.
    """
    rng = draft.rng
    contacts: Data = {}
    spots: list[Spot] = []
    barriers: list[Barrier] = []
    way, late = list(states), happens(rng, _LATE)
    for i in range(weighted(rng, ((0, 0.03), (1, 0.45), (2, 0.34), (3, 0.12), (4, 0.06)))):
        name = f"contact{i + 1}"
        for _ in range(_TRIES):
            before = deepcopy(draft.data)
            try:
                spot = spot_on(draft, model, way, late=late)
                if _is_taken(model, spot, spots, barriers):
                    raise RedrawError
                obstacle = _obstacle(draft, spot)
            except RedrawError:
                draft.data = before
                continue
            thick = happens(rng, 0.78)
            beam = model.scene.beams[spot.beam]
            barrier = Barrier(spot.beam, obstacle.distance, 0.5 * beam.thickest if thick else 0.0)
            held = _with(model, states, acting, [*barriers, barrier]) if _fits(model, obstacle, spot) else []
            if len(held) < _REACHED * len(states[::_STRIDE]):
                draft.data = before
                continue
            contacts[name] = obstacle.data | ({} if thick else {"thick": False})
            spots.append(spot)
            barriers.append(barrier)
            # beyond where the estimate found nothing there may be a jump: what follows keeps away from it
            way = held if len(held) == len(states[::-_STRIDE]) else held[: int(_AWAY * len(held))]
            break
    if contacts:
        draft.data["contacts"] = contacts
    return way, barriers


def _obstacle(draft: Draft, spot: Spot) -> Obstacle:
    beams = draft.data["beams"]
    if len(beams) < MOST_BEAMS and happens(draft.rng, 0.42):
        return companion(draft, f"beam{len(beams) + 1}", spot)
    found = rigid(draft.rng, spot)
    kind = found.data["kind"]
    return Obstacle({"kind": kind, "beam": spot.beam, "body": "wall"} | found.data, found.distance)


def _is_taken(model: Estimate, spot: Spot, spots: Sequence[Spot], barriers: Sequence[Barrier]) -> bool:
    """Whether something has its surface at a spot already: how two would share the force is no question.

    Barriers are asked beside the ``spots`` they stand at, as graphs are known by few of their places.
    """
    s = spot.s[None]
    return any(
        barrier.beam == spot.beam
        and min(abs(float(barrier.distance(s)[0])), float(np.hypot(*(other.s - spot.s)))) < TAKEN * model.size
        for other, barrier in zip(spots, barriers, strict=True)
    )


def _fits(model: Estimate, obstacle: Obstacle, spot: Spot) -> bool:
    return is_clear(model, obstacle, list(model.scene.beams), spot)


def _with(model: Estimate, states: Sequence[State], acting: Sequence[str], barriers: list[Barrier]) -> list[State]:
    """The states at every second one's values with barriers, until there is none near by."""
    state, found = State(np.zeros(model.unknowns), {}), list[State]()
    chosen = list(states[::-_STRIDE])[::-1]
    for target in chosen:
        for name in acting:
            value = target.values.get(name, 0.0)
            if value == state.values.get(name, 0.0):
                continue
            state = next(followed(model, state, name, iter([value]), barriers), None) or State(state.q, {})
            if not state.values or any(_sunk(model, state, barrier) for barrier in barriers):
                return found
        found.append(state)
    return found


def _sunk(model: Estimate, state: State, barrier: Barrier) -> bool:
    """Whether a beam is deeper in a barrier than its springs give way where what presses it can yield."""
    distance = barrier.distance(model.shape(state.q, barrier.beam))
    return bool(np.any((distance < barrier.apart - SUNK * model.size) & (distance > -DEEP * model.size)))

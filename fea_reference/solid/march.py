"""Load stepping from station to station, with step control and penalty continuation.

======  ==========================================
symbol  meaning
======  ==========================================
λ       dimensionless value of the stepped parameter
z(λ)    equilibrium
======  ==========================================

A step starts at the last equilibrium and ends in another or is cut; an easy step is doubled. The first Newton
iteration is the tangent predictor. (Extrapolation from two equilibria is no better: rotating parts are stretched
along the line.) Where a contact closes, the zero of its gap in λ is sought between open states.

A long step may end in an equilibrium on another branch that is no minimum. The sign of the tangent's determinant
reveals an odd number of negative curvatures, and the step is cut.

For slender beams a penalty relative to Young's modulus leaves a millionth of the requested penetration. Newton's
method then fails where a contact slides, opens or moves from an end's corner to the adjacent edge. A failed step
therefore loosens the penalties, as long as the penetration stays within the request; at a station the penalties are
restored.
"""

from dataclasses import dataclass, field, replace

import numpy as np

from cprbm_scene.answer import Array, Ending
from fea_reference.solid.curvature import has_odd_negative_count
from fea_reference.solid.model import Model
from fea_reference.solid.newton import Solved, equilibrium
from fea_reference.solid.pairs import Pair
from fea_reference.solid.passing import contact_passed_through
from fea_reference.solid.settings import Settings
from fea_reference.solid.system import System, assemble

_CUTS = 10  # consecutive cuts: the last step is a millionth of the step that led to the equilibrium
_EASY = 9  # iterations of a step that may be doubled
_CUT = 0.3  # factor of a cut
_WHOLE_STEP = 1.01  # steps: the remaining distance is joined to the last step
_STIFFER = 4.0
_STIFFEST = 1e4  # times the initial factor
_LOOSER = 0.1
_LOOSEST = 1e-4  # times the requested factors
_TIGHTER = 10.0
_LEAST_FACTOR = 1.2
_CLOSING = 1e-9  # lengths of the longest beam: gap of a closed contact
_SAME = 1e-12  # steps: distance of equal values
_LOOKS = 60
_SECANTS = 25  # evaluations before bisection: a gap without a zero so far is discontinuous
_POLISHED = 1e-12  # times the scale: residual at a station, round-off permitting


_NO_MINIMUM = "the equilibria found are no minima of the potential energy"


class StoppedError(Exception):
    """Load stepping cannot continue; with an ending and a sentence."""

    def __init__(self, ending: Ending, sentence: str) -> None:
        super().__init__(sentence)
        self.ending = ending
        self.sentence = sentence


@dataclass
class March:
    """State of load stepping.

    Attributes:
        model: the mechanism.
        settings: numerical settings.
        penalties: current ρ by pair; ``requested`` are the values at stations.
        values: dimensionless values of all stepped parameters.
        system: the last equilibrium.
        closing: value (SI) at the first closing, by contact.
        iterations: Newton iterations since the last station.
        step: limit of the next step.
    """

    model: Model
    settings: Settings
    penalties: dict[Pair, float]
    requested: dict[Pair, float]
    values: Array
    system: System
    closing: dict[str, float] = field(default_factory=dict)
    iterations: int = 0
    step: float = np.inf

    def search(self, values: Array, z: Array, penalties: dict[Pair, float]) -> Solved:
        """Equilibrium near ``z``, or the reason of a failure; counts the iterations.

        Raises:
            StoppedError: the station's iterations are exhausted.
        """
        solved = equilibrium(self.model, penalties, self.settings, values, z)
        self.iterations += solved.iterations
        if self.iterations > self.settings.iteration_limit:
            raise StoppedError(
                Ending.STEP_TOO_SMALL, f"no convergence within {self.settings.iteration_limit} iterations"
            )
        return solved

    def loosen(self) -> None:
        """Lower all penalties, down to their least values."""
        self.penalties = {
            pair: max(_LOOSER * rho, min(rho, _LOOSEST * self.requested[pair])) for pair, rho in self.penalties.items()
        }


def begin(model: Model, settings: Settings, pairs: tuple[Pair, ...]) -> March:
    """Initial state, undeformed and unloaded."""
    penalties = dict.fromkeys(pairs, settings.stiffness)
    values = np.zeros(len(model.stepped))
    return March(
        model,
        settings,
        penalties,
        penalties,
        values,
        assemble(model, penalties, settings.quadrature, values, np.zeros(model.size)),
    )


def reach(march: March, part: int, target: float) -> None:
    """Step parameter number ``part`` to ``target``, dimensionless.

    The least step is not a share of the stage, as the end of a solution would then depend on its stations. As for
    beams, consecutive cuts and the station's iterations are limited.

    Raises:
        StoppedError: no equilibrium is found.
    """
    march.iterations = 0
    why, blocked, cuts = "", "", 0
    while True:
        here = float(march.values[part])
        remaining = target - here
        if remaining == 0.0:
            break
        step = remaining if abs(remaining) < _WHOLE_STEP * march.step else float(np.copysign(march.step, remaining))
        if cuts > _CUTS or here + step == here:
            name, unit = march.model.stepped[part].name, march.model.stepped[part].unit
            ending = Ending.NOT_A_MINIMUM if why == _NO_MINIMUM else Ending.STEP_TOO_SMALL
            why += f"; in a longer step {blocked}" if blocked and blocked != why else ""
            raise StoppedError(ending, f"beyond {name} = {here * unit:.6g} no equilibrium is found: {why}")
        goal = target if step == remaining else here + step
        values = march.values.copy()
        values[part] = goal
        solved = march.search(values, march.system.z, march.penalties)
        through = (
            ""
            if solved.system is None
            else contact_passed_through(march.model, march.penalties, march.system.z, solved.system.z)
        )
        aside = solved.system is not None and has_odd_negative_count(march.model, solved.system)
        if solved.system is None or through or aside:
            blocked = f"a beam passes through the opposite body in contact {through}" if through else blocked
            why = blocked if through else _NO_MINIMUM if aside else solved.reason
            march.step, cuts = _CUT * abs(step), cuts + 1
            if solved.system is None:
                march.loosen()
            continue
        cuts = 0
        before = march.system
        march.values, march.system = values, solved.system
        march.step *= 2.0 if solved.iterations <= _EASY else 1.0
        if march.penalties is not march.requested:
            _tighten(march)
        _record_closings(march, part, here, before)
    _restore_penalties(march)
    _tighten(march)
    _polish(march)


def reset_step(march: March) -> None:
    """Forget the step limit: the next stage steps another parameter."""
    march.step = np.inf


def _polish(march: March) -> None:
    """Iterate to round-off, because balances sum the residuals of many nodes. On failure the state is unchanged."""
    settings = replace(march.settings, residual=_POLISHED)
    solved = equilibrium(march.model, march.penalties, settings, march.values, march.system.z)
    march.iterations += solved.iterations
    if solved.system is not None:
        march.system = solved.system


def _tighten(march: March) -> None:
    """Raise penalties until every penetration is within the request.

    Raises:
        StoppedError: no equilibrium is found.
    """
    while True:
        deep = [
            contact.pair
            for contact in march.system.touches
            if contact.penetration > march.settings.penetration * contact.pair.measure
        ]
        if not deep:
            return
        penalties = march.penalties | {pair: _STIFFER * march.penalties[pair] for pair in deep}
        if max(penalties.values()) > _STIFFEST * march.settings.stiffness:
            return  # the certificate reports the penetration
        solved = march.search(march.values, march.system.z, penalties)
        if solved.system is None:
            raise StoppedError(
                Ending.STEP_TOO_SMALL, f"a contact penalty cannot be raised as requested: {solved.reason}"
            )
        march.penalties, march.system = penalties, solved.system
        march.requested = {pair: max(rho, penalties[pair]) for pair, rho in march.requested.items()}


def _restore_penalties(march: March) -> None:
    """Restore the requested penalties.

    Raises:
        StoppedError: no equilibrium is found.
    """
    if march.penalties != march.requested:
        solved = _with_penalties(march, march.values, march.system.z, march.penalties, march.requested)
        if solved.system is None:
            raise StoppedError(
                Ending.STEP_TOO_SMALL, f"a contact penalty cannot be raised as requested: {solved.reason}"
            )
        march.system = solved.system
    march.penalties = march.requested


def _with_penalties(
    march: March, values: Array, z: Array, loose: dict[Pair, float], requested: dict[Pair, float]
) -> Solved:
    """Equilibrium with the ``requested`` penalties, from ``z`` with loose ones, in smaller factors if needed."""
    factor, solved = _TIGHTER, Solved(None, 0)
    while loose != requested:
        penalties = {pair: min(factor * rho, requested[pair]) for pair, rho in loose.items()}
        solved = march.search(values, z, penalties)
        if solved.system is not None:
            loose, z = penalties, solved.system.z
            continue
        factor = float(np.sqrt(factor))
        if factor < _LEAST_FACTOR:
            break
    return solved


def _record_closings(march: March, part: int, here: float, before: System) -> None:
    """Record the first closings in a step from the system ``before``, at the value ``here``.

    The penetrations under the current penalties are within the request.
    """
    unit = march.model.stepped[part].unit
    was = _least_gaps(before)
    for name, gap in _least_gaps(march.system).items():
        if name in march.closing or not gap < 0.0:
            continue
        march.closing[name] = (here if was[name] <= 0.0 else _closing(march, part, name, here, before)) * unit


def _closing(march: March, part: int, name: str, here: float, before: System) -> float:
    """λ at the closing of a contact, with the requested penalties if possible, else with the current ones.

    Raises:
        StoppedError: no closing is found.
    """
    goal, gap = float(march.values[part]), _least_gaps(before)[name]
    loose, requested = (
        {pair: rho for pair, rho in rhos.items() if pair.name != name} for rhos in (march.penalties, march.requested)
    )
    known = {here: before.z}
    c = _zero_of_gap(march, part, name, loose, known, (here, gap), 0.5 * (here + goal))
    if c is None:
        unit = march.model.stepped[part].unit
        raise StoppedError(
            Ending.STEP_TOO_SMALL,
            f"the closing of {name} between {here * unit:.6g} and {goal * unit:.6g} was not found",
        )
    if loose == requested:
        return c
    solved = _with_penalties(march, _at(march, part, c), known[_nearest(known, c)], loose, requested)
    if solved.system is None:
        return c
    tight = _zero_of_gap(march, part, name, requested, {here: before.z, c: solved.system.z}, (here, gap), c)
    return c if tight is None else tight


def _zero_of_gap(
    march: March,
    part: int,
    name: str,
    without: dict[Pair, float],
    known: dict[float, Array],
    start: tuple[float, float],
    c: float,
) -> float | None:
    """λ at the zero of a contact's gap, between an open ``start`` and an overlapping state; None without success.

    The contact itself is removed for a smooth gap. An overlapping state may be far from the open state: its search
    starts from the nearest known state, in shorter steps if necessary. After passing through, the overlap counts as
    infinite.

    Plain false position would converge slowly, as the overlap without the contact may exceed the gap a hundredfold.
    The gap of an end that stays twice is therefore halved (Dowell and Jarratt, BIT 11 (1971) 168-174, "Illinois").

    Args:
        march: at the end of the step.
        part: number of the stepped parameter.
        name: of the contact.
        without: penalties of the other contacts.
        known: z by λ, extended by all states found.
        start: λ and gap at the beginning of the step.
        c: first λ to evaluate.
    """
    watched = dict.fromkeys((pair for pair in march.penalties if pair.name == name), 1.0)
    (a, fa), b, fb, last = start, float(march.values[part]), -np.inf, 0.0
    whole = abs(b - a)
    for look in range(_LOOKS):
        values, nearest = _at(march, part, c), _nearest(known, c)
        solved = march.search(values, known[nearest], without)
        if solved.system is None or has_odd_negative_count(march.model, solved.system):
            c = 0.5 * (nearest + c)
            continue
        # so near the known state Newton's method may need no iteration, while the residual is significant for a nearly
        # closed gap
        correction = solved.system.solve(-solved.system.residual)
        z = solved.system.z if correction is None else solved.system.z + correction
        watching = assemble(march.model, watched, march.settings.quadrature, values, z)
        fc = min(contact.zones.least for contact in watching.touches)
        if contact_passed_through(march.model, watched, known[a], z):
            fc = -np.inf
        else:
            known[c] = z
        if abs(fc) < _CLOSING:
            return c
        if fc < 0.0:
            b, fb = c, fc
            fa *= 0.5 if last < 0.0 else 1.0
        else:
            a, fa = c, fc
            fb *= 0.5 if last > 0.0 else 1.0
        last = fc
        secant = np.isfinite(fa) and np.isfinite(fb) and look < _SECANTS
        c = a + fa * (b - a) / (fa - fb) if secant else 0.5 * (a + b)
        if abs(b - a) < _SAME * whole:
            return c
    return None


def _at(march: March, part: int, value: float) -> Array:
    """All values, with another value of the stepped parameter."""
    values = march.values.copy()
    values[part] = value
    return values


def _nearest(known: dict[float, Array], c: float) -> float:
    return min(known, key=lambda value: abs(value - c))


def _least_gaps(system: System) -> dict[str, float]:
    """The least gap of every contact."""
    gaps: dict[str, float] = {}
    for contact in system.touches:
        gaps[contact.pair.name] = min(gaps.get(contact.pair.name, np.inf), contact.zones.least)
    return gaps

"""From station to station by load steps that cut and grow.

======  ==========================================
symbol  meaning
======  ==========================================
λ       value of the stepped load or drive, no unit
z(λ)    equilibrium
======  ==========================================

A step begins at the last equilibrium, whose tangent is the first iteration's, and ends in another, or is cut; an
easy one is doubled.  (The line through the last two equilibria is no better a beginning: along it what turns is
stretched.)  Where a contact closes on the way, the λ at which its gap vanishes is looked for between open states.

A step that is too long may end in an equilibrium that is no minimum, beside the branch: the sign of the tangent's
determinant tells of an odd number of negative curvatures, and the step is cut.

Where beams are slender, a penalty by their Young's modulus holds an edge to a millionth of the depth that is asked, and
Newton's iterations find no way along which such a contact travels, opens or goes from an end's corner to the edge
beside it.  A step that fails therefore leaves the march with looser penalties, as long as what they leave is no deeper
than asked; at a station they are brought back to what they were.
"""

from dataclasses import dataclass, field, replace

import numpy as np

from cprbm_scene.answer import Array, Ending
from fea_reference.solid.curvature import beside_minima
from fea_reference.solid.model import Model
from fea_reference.solid.newton import Found, equilibrium
from fea_reference.solid.pairs import Pair
from fea_reference.solid.passing import passed
from fea_reference.solid.settings import Settings
from fea_reference.solid.system import System, assemble

_CUTS = 10  # in a row: from an equilibrium no step is found that is a millionth of the one by which it was reached
_EASY = 9  # iterations in which a step that may be doubled arrives
_CUT = 0.3  # of a step that was too long
_WHOLE = 1.01  # of a step: what is left goes with it
_STIFFER = 4.0
_STIFFEST = 1e4  # of the factor at first
_LOOSER = 0.1
_LOOSEST = 1e-4  # of the factors asked
_TIGHTER = 10.0
_GENTLY = 1.2
_CLOSING = 1e-9  # gap at which a contact is found closed, of the longest beam
_SAME = 1e-12  # of a step: two values that are one
_LOOKS = 60
_SECANTS = 25  # looks after which a gap that has not vanished is taken for one that leaps: the interval is halved
_POLISHED = 1e-12  # residual, over the scale, if round-off allows that


_NO_MINIMUM = "those that are, are no minima of the potential energy"


class StoppedError(Exception):
    """The march cannot go on: with an ending and a sentence."""

    def __init__(self, ending: Ending, sentence: str) -> None:
        super().__init__(sentence)
        self.ending = ending
        self.sentence = sentence


@dataclass
class March:
    """The state of a solve.

    Attributes:
        model: the mechanism.
        settings: how.
        penalties: ρ by pair, on the way; ``asked`` are those of a station.
        values: of all that is stepped, no units.
        system: the equilibrium reached.
        closing: by contact, the value (SI) at which it first closed.
        iterations: of this station.
        step: how far the next step may go.
    """

    model: Model
    settings: Settings
    penalties: dict[Pair, float]
    asked: dict[Pair, float]
    values: Array
    system: System
    closing: dict[str, float] = field(default_factory=dict)
    iterations: int = 0
    step: float = np.inf

    def look(self, values: Array, z: Array, penalties: dict[Pair, float]) -> Found:
        """Look for an equilibrium; its iterations count.

        Raises:
            StoppedError: the station's iterations are used up.
        """
        found = equilibrium(self.model, penalties, self.settings, values, z)
        self.iterations += found.iterations
        if self.iterations > self.settings.iteration_limit:
            raise StoppedError(Ending.STEP_TOO_SMALL, f"{self.settings.iteration_limit} iterations were not enough")
        return found

    def loosen(self) -> None:
        """Make penalties looser, if they are not yet as loose as may be."""
        self.penalties = {
            pair: max(_LOOSER * rho, min(rho, _LOOSEST * self.asked[pair])) for pair, rho in self.penalties.items()
        }


def begin(model: Model, settings: Settings, pairs: tuple[Pair, ...]) -> March:
    """At rest."""
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
    """Step the value of a number ``part`` to a ``target``, both without units.

    How short a step may be is no share of what a stage asks: that would end a solve by where its stations lie.  As with
    the beams a step is cut so often in a row, and the station's iterations are counted.

    Raises:
        StoppedError: no equilibrium is found.
    """
    march.iterations = 0
    why, blocked, cuts = "", "", 0
    while True:
        here = float(march.values[part])
        left = target - here
        if left == 0.0:
            break
        step = left if abs(left) < _WHOLE * march.step else float(np.copysign(march.step, left))
        if cuts > _CUTS or here + step == here:
            name, unit = march.model.stepped[part].name, march.model.stepped[part].unit
            ending = Ending.NOT_A_MINIMUM if why == _NO_MINIMUM else Ending.STEP_TOO_SMALL
            why += f"; in a longer step {blocked}" if blocked and blocked != why else ""
            raise StoppedError(ending, f"beyond {name} = {here * unit:.6g} no equilibrium is found: {why}")
        goal = target if step == left else here + step
        values = march.values.copy()
        values[part] = goal
        found = march.look(values, march.system.z, march.penalties)
        through = "" if found.system is None else passed(march.model, march.penalties, march.system.z, found.system.z)
        aside = found.system is not None and beside_minima(march.model, found.system)
        if found.system is None or through or aside:
            blocked = f"a beam passes through what it may touch in {through}" if through else blocked
            why = blocked if through else _NO_MINIMUM if aside else found.why
            march.step, cuts = _CUT * abs(step), cuts + 1
            if found.system is None:
                march.loosen()
            continue
        cuts = 0
        before = march.system
        march.values, march.system = values, found.system
        march.step *= 2.0 if found.iterations <= _EASY else 1.0
        if march.penalties is not march.asked:
            _tighten(march)
        _note_closings(march, part, here, before)
    _fasten(march)
    _tighten(march)
    _polish(march)


def leave_stage(march: March) -> None:
    """What is stepped is another thing from now on: nothing is known of its way."""
    march.step = np.inf


def _polish(march: March) -> None:
    """Iterate on to round-off: balances sum up what is left at many nodes.  Where that fails the state stays."""
    settings = replace(march.settings, residual=_POLISHED)
    found = equilibrium(march.model, march.penalties, settings, march.values, march.system.z)
    march.iterations += found.iterations
    if found.system is not None:
        march.system = found.system


def _tighten(march: March) -> None:
    """Stiffen penalties until what they leave is no deeper than asked.

    Raises:
        StoppedError: that leads to no equilibrium.
    """
    while True:
        deep = [
            one.pair for one in march.system.touches if one.penetration > march.settings.penetration * one.pair.measure
        ]
        if not deep:
            return
        penalties = march.penalties | {pair: _STIFFER * march.penalties[pair] for pair in deep}
        if max(penalties.values()) > _STIFFEST * march.settings.stiffness:
            return  # the certificate will say so
        found = march.look(march.values, march.system.z, penalties)
        if found.system is None:
            raise StoppedError(Ending.STEP_TOO_SMALL, f"a contact cannot be made as stiff as asked: {found.why}")
        march.penalties, march.system = penalties, found.system
        march.asked = {pair: max(rho, penalties[pair]) for pair, rho in march.asked.items()}


def _fasten(march: March) -> None:
    """Bring penalties back to those that are asked.

    Raises:
        StoppedError: that leads to no equilibrium.
    """
    if march.penalties != march.asked:
        found = _fastened(march, march.values, march.system.z, march.penalties, march.asked)
        if found.system is None:
            raise StoppedError(Ending.STEP_TOO_SMALL, f"a contact cannot be made as stiff as asked: {found.why}")
        march.system = found.system
    march.penalties = march.asked


def _fastened(march: March, values: Array, z: Array, loose: dict[Pair, float], asked: dict[Pair, float]) -> Found:
    """An equilibrium with the penalties asked, from a loose one's ``z``; by smaller factors where a large one fails."""
    factor, found = _TIGHTER, Found(None, 0)
    while loose != asked:
        penalties = {pair: min(factor * rho, asked[pair]) for pair, rho in loose.items()}
        found = march.look(values, z, penalties)
        if found.system is not None:
            loose, z = penalties, found.system.z
            continue
        factor = float(np.sqrt(factor))
        if factor < _GENTLY:
            break
    return found


def _note_closings(march: March, part: int, here: float, before: System) -> None:
    """Find where the contacts have closed that are closed for the first time, since ``before``, at the value ``here``.

    The march's penalties leave nothing deeper than is asked, or are those of a station.
    """
    unit = march.model.stepped[part].unit
    was = _least(before)
    for name, gap in _least(march.system).items():
        if name in march.closing or not gap < 0.0:
            continue
        march.closing[name] = (here if was[name] <= 0.0 else _closing(march, part, name, here, before)) * unit


def _closing(march: March, part: int, name: str, here: float, before: System) -> float:
    """λ at which a contact closes, with the penalties asked unless these lead nowhere there.

    Raises:
        StoppedError: it is not found.
    """
    goal, gap = float(march.values[part]), _least(before)[name]
    loose, asked = (
        {pair: rho for pair, rho in rhos.items() if pair.name != name} for rhos in (march.penalties, march.asked)
    )
    known = {here: before.z}
    c = _vanishing(march, part, name, loose, known, (here, gap), 0.5 * (here + goal))
    if c is None:
        unit = march.model.stepped[part].unit
        raise StoppedError(
            Ending.STEP_TOO_SMALL, f"where {name} closes between {here * unit:.6g} and {goal * unit:.6g} is not found"
        )
    if loose == asked:
        return c
    found = _fastened(march, _at(march, part, c), known[_nearest(known, c)], loose, asked)
    if found.system is None:
        return c
    tight = _vanishing(march, part, name, asked, {here: before.z, c: found.system.z}, (here, gap), c)
    return c if tight is None else tight


def _vanishing(
    march: March,
    part: int,
    name: str,
    without: dict[Pair, float],
    known: dict[float, Array],
    start: tuple[float, float],
    c: float,
) -> float | None:
    """λ at which the gap of a contact vanishes: between a ``start`` (λ, gap) that is open and what overlaps.

    What overlaps does so with the contact taken away, so that the gap is smooth there; such a state may lie far beyond
    the open one, and is gone to from the nearest that is known, in shorter steps where one is too long.  What has gone
    through overlaps too, by nobody knows how much.

    The false position alone would creep: taken away, a contact may leave an overlap that is hundreds of times the gap.
    Where one end stays twice, its gap is therefore halved (Dowell and Jarratt, BIT 11 (1971) 168-174, "Illinois").

    Args:
        march: at the end of the step.
        part: what is stepped.
        name: the contact's.
        without: the penalties of the others.
        known: z by λ; what is found is added.
        start: where the step began.
        c: the first λ that is looked at.
    """
    watched = dict.fromkeys((pair for pair in march.penalties if pair.name == name), 1.0)
    (a, fa), b, fb, last = start, float(march.values[part]), -np.inf, 0.0
    whole = abs(b - a)
    for look in range(_LOOKS):
        values, nearest = _at(march, part, c), _nearest(known, c)
        found = march.look(values, known[nearest], without)
        if found.system is None or beside_minima(march.model, found.system):
            c = 0.5 * (nearest + c)
            continue
        # from so near no iteration may be called for, while what is left of the balance is felt in a gap all but closed
        left = found.system.solve(-found.system.residual)
        z = found.system.z if left is None else found.system.z + left
        watching = assemble(march.model, watched, march.settings.quadrature, values, z)
        fc = min(one.zones.least for one in watching.touches)
        if passed(march.model, watched, known[a], z):
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
    """The march's values with another one of what is stepped."""
    values = march.values.copy()
    values[part] = value
    return values


def _nearest(known: dict[float, Array], c: float) -> float:
    return min(known, key=lambda value: abs(value - c))


def _least(system: System) -> dict[str, float]:
    """The least gap of every contact."""
    found: dict[str, float] = {}
    for one in system.touches:
        found[one.pair.name] = min(found.get(one.pair.name, np.inf), one.zones.least)
    return found

"""Newton's method for one equilibrium.

======  =====================================================================================
symbol  meaning
======  =====================================================================================
g       gap at a point of a contact, to where its pressure begins; δz is a step
k       stiffness of the point, the penalty times the length that it stands for
λ       push of the point, an unknown of its own
======  =====================================================================================

A step overlaps by its square, and a stiff penalty makes of that a force thousands of times the contact's own, and of
the force a geometric stiffness in which the next step gets lost.  Taken for an unknown with the equation λ = −k g, the
push after a step is −k (g + ∂g δz), with the step's overlap left out.  Eliminated point by point, it leaves the
residual as it is, with −k g, and the tangent k ∂g ∂gᵀ − λ ∂²g: the equilibria are the same, and so is the order of
convergence (Magisano, Leonetti and Garcea, Comput. Methods Appl. Mech. Engrg. 313 (2017) 986).
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from cprbm_scene.answer import Array
from fea_reference.acting import Acting
from fea_reference.advance import advance
from fea_reference.hermite import Index
from fea_reference.linesearch import searched
from fea_reference.model import Model
from fea_reference.settings import Settings
from fea_reference.sinking import known_depths, sunk
from fea_reference.state import State
from fea_reference.system import Drag, System, assemble
from fea_reference.touch import Contact, Penalty, Touch

_TURN = 0.4  # rad, and the same in lengths of the longest beam: the most that one iteration may move anything
_LOST = 3  # corrections longer than that: an equilibrium so far off would belong to another branch
_NEAR = 3.0  # factor between penetrations that Newton's method bridges by itself
_NOTHING = 1e-2  # of the correction and the unbalanced force asked: what need not be corrected any more
_SETTLED = 1e-4  # correction after which holding has done what it can
_SMALL = 1e-4  # of the longest correction, or of a length: loads of any size begin their search alike
_FALLING = 0.1  # of the unbalanced force before: who has come so far needs a few iterations more
_TOUCHING = 1e-9  # of the thickness: an overlap that is none
_STALLED = 6  # corrections in a row, each small beside the longest of the search, none of them half the first
_HELD = 6  # iterations for which a contact is held at most


@dataclass(frozen=True, slots=True)
class Solved:
    """What came of it: the last system, whether it is in equilibrium, and the iterations spent."""

    system: System
    converged: bool
    iterations: int


def equilibrium(
    model: Model,
    settings: Settings,
    penalties: Mapping[Contact, Penalty],
    values: Array,
    z: State,
    acting: Acting,
    depths: Mapping[Contact, float],
    before: Mapping[Contact, Array],
    drag: Drag | None = None,
) -> Solved:
    """Seek the equilibrium near ``z`` under load ``values``, with those stops ``acting`` that do, whatever their sign.

    ``depths`` are the penetrations of the contacts that were closed in the equilibrium before: where they are not near
    that, or open before they pull, these are held until they are again, or until they pull.  ``before`` is what the
    points of the contacts pushed with there, (k,) each.  A ``drag`` resists the motions.  A search whose corrections
    stay as small as they are without arriving is given up: small beside what it began with, for a contact's zone may be
    sought by steps as small as the load.
    """
    moving = model.moving
    correction, last, iteration, far = np.inf, np.inf, 0, 0
    longest = 0.0
    small: list[float] = []
    foreseen = dict(before)
    system = assemble(model, penalties, settings.quadrature, values, z, acting, {}, foreseen, drag)
    held = {one.pair: depths[one.pair] for one in system.touches if _to_hold(one, depths, before)}
    if held:
        system = assemble(model, penalties, settings.quadrature, values, z, acting, held, foreseen, drag)
    known = known_depths(system, depths, before)

    def settled_at(system: System, z: State) -> State:
        return sunk(model, penalties, settings.quadrature, system, z, foreseen, known)

    while True:
        unbalanced = float(np.abs(system.residual).max())
        accepted = max(settings.residual * system.scale, system.floor)
        if not held and correction <= settings.correction and unbalanced <= accepted:
            return Solved(system, converged=True, iterations=iteration)
        if iteration >= settings.newton_limit and not unbalanced <= _FALLING * last:
            return Solved(system, converged=False, iterations=iteration)
        last = unbalanced
        step = system.solve(-system.residual)
        if step is None:
            return Solved(system, converged=False, iterations=iteration + 1)
        correction = float(np.abs(step[moving]).max())
        if not held and correction <= _NOTHING * settings.correction and unbalanced <= _NOTHING * accepted:
            return Solved(system, converged=True, iterations=iteration)  # this step need not be made
        far += correction > _TURN
        longest = max(longest, correction)
        small = [*small[1 - _STALLED :], correction] if correction < _SMALL * min(1.0, longest) else []
        stalled = not held and len(small) == _STALLED and min(small) > 0.5 * small[0]
        if far >= _LOST or stalled:
            return Solved(system, converged=False, iterations=iteration + 1)
        step *= min(1.0, _TURN / max(correction, _TURN))
        foreseen = {one.pair: one.foreseen(step) for one in system.touches}
        if penalties and not held and unbalanced > accepted:
            system = _along(model, settings, penalties, values, system, step, moving, foreseen, drag, settled_at)
            z = system.z
        else:
            z = settled_at(system, advance(model, z, step))
            system = assemble(model, penalties, settings.quadrature, values, z, acting, held, foreseen, drag)
        settled = iteration >= _HELD or correction < _SETTLED
        lost = [one.pair for one in system.touches if _lost(one, depths, foreseen) and one.pair not in held]
        if lost and not settled:
            held = {**held, **{pair: depths[pair] for pair in lost}}
            system = assemble(model, penalties, settings.quadrature, values, z, acting, held, foreseen, drag)
        free = [
            one.pair
            for one in system.touches
            if one.pair in held
            and (settled or _near(one, held[one.pair]) or (iteration > 0 and foreseen[one.pair].sum() < 0.0))
        ]
        if free:
            held = {pair: depth for pair, depth in held.items() if pair not in free}
            system = assemble(model, penalties, settings.quadrature, values, z, acting, held, foreseen, drag)
        iteration += 1


def _to_hold(one: Touch, depths: Mapping[Contact, float], before: Mapping[Contact, Array]) -> bool:
    """Whether a contact is to be held: one that did not press and does not overlap is as it was."""
    if one.pair not in depths or _near(one, depths[one.pair]):
        return False
    pressed = one.pair in before and float(before[one.pair].sum()) > 0.0
    return pressed or one.penetration > _TOUCHING * one.pair.scale


def _lost(one: Touch, depths: Mapping[Contact, float], foreseen: Mapping[Contact, Array]) -> bool:
    """Whether a contact that was closed has opened, though it was foreseen to press."""
    return one.pair in depths and not one.closed and float(foreseen[one.pair].sum()) > 0.0


def _near(one: Touch, depth: float) -> bool:
    """Whether Newton's method bridges by itself what a penetration is from a depth."""
    return depth / _NEAR < one.penetration < _NEAR * depth


def _along(
    model: Model,
    settings: Settings,
    penalties: Mapping[Contact, Penalty],
    values: Array,
    system: System,
    step: Array,
    moving: Index,
    foreseen: Mapping[Contact, Array],
    drag: Drag | None,
    settled_at: Callable[[System, State], State],
) -> System:
    """The system after as much of ``step`` as lowers the energy; forces take all of theirs."""
    forces = step.copy()
    forces[moving] = 0.0
    motions = step - forces

    def after(fraction: float) -> System:
        z = advance(model, system.z, forces + fraction * motions)
        if fraction == 1.0:
            z = settled_at(system, z)
        return assemble(model, penalties, settings.quadrature, values, z, system.acting, {}, foreseen, drag)

    def slope(there: System) -> float:
        return float(motions @ there.residual)

    return searched(after, slope, float(motions @ (system.residual + system.tangent @ forces)))

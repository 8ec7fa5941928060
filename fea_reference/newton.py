"""Newton's method for a single equilibrium.

======  =====================================================================================
symbol  meaning
======  =====================================================================================
g       gap minus lead at a point of a contact; δz is a step
k       stiffness of the point, the penalty times the length of the point
λ       contact force of the point, an unknown
======  =====================================================================================

The overlap after a step has an error of second order. A stiff penalty turns this error into a force thousands of
times the contact force, with a geometric stiffness that misleads the next step. With the force as an unknown, λ = −k
g, the force after a step is −k (g + ∂g δz), without the second-order overlap. Eliminated point by point, λ leaves the
residual with −k g unchanged, and the tangent becomes k ∂g ∂gᵀ − λ ∂²g. The equilibria and the order of convergence
remain the same (Magisano, Leonetti and Garcea, Comput. Methods Appl. Mech. Engrg. 313 (2017) 986).
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from cprbm_scene.answer import Array
from fea_reference.acting import Acting
from fea_reference.advance import advance
from fea_reference.linesearch import line_search
from fea_reference.model import Model
from fea_reference.settings import Settings
from fea_reference.sinking import known_depths, with_predicted_depths
from fea_reference.state import State
from fea_reference.system import Drag, System, assemble
from fea_reference.touch import Contact, Penalty, Touch

_MAX_MOTION = 0.4  # rad, and lengths of the longest beam: largest motion per iteration
_LONG_CORRECTIONS = 3  # longer corrections before the search is given up: a distant equilibrium is on another branch
_NEAR = 3.0  # ratio of penetrations within the reach of Newton's method
_NOTHING = 1e-2  # times the accepted correction and residual: no further step needed
_SETTLED = 1e-4  # correction below which held contacts are released
_SMALL = 1e-4  # times the longest correction, or a length: scale of small corrections, the same for loads of any size
_FALLING = 0.1  # times the previous residual: this decrease allows a few more iterations
_TOUCHING = 1e-9  # thicknesses: negligible overlap
_STALLED = 6  # consecutive small corrections without one below half of the first: no convergence
_HOLD_ITERATIONS = 6  # largest number of iterations with held contacts


@dataclass(frozen=True, slots=True)
class Solved:
    """Result of the search: the last system, True for an equilibrium, and the number of iterations."""

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
    """Equilibrium near ``z`` under the ``values``, with fixed active constraints ``acting`` of any sign.

    ``depths`` are penetrations of contacts closed in the previous equilibrium. A contact far from its depth, or open
    although not in tension, is held at this depth until near the depth or in tension. ``before`` are the previous
    point forces (k,) of the contacts. A ``drag`` resists the motions. The search stops if small corrections do not
    decrease: small against the first ones, because the search for a zone may take steps as small as the load.
    """
    correction, longest, last, iteration, far = np.inf, 0.0, np.inf, 0, 0
    small: list[float] = []
    predicted = dict(before)
    system = assemble(model, penalties, settings.quadrature, values, z, acting, {}, predicted, drag)
    held_depths = {
        contact.pair: depths[contact.pair] for contact in system.touches if _needs_holding(contact, depths, before)
    }
    if held_depths:
        system = assemble(model, penalties, settings.quadrature, values, z, acting, held_depths, predicted, drag)
    known = known_depths(system, depths, before)

    def settled_at(system: System, z: State) -> State:
        return with_predicted_depths(model, penalties, settings.quadrature, system, z, predicted, known)

    while True:
        unbalanced = float(np.abs(system.residual).max())
        accepted = max(settings.residual * system.scale, system.floor)
        if not held_depths and correction <= settings.correction and unbalanced <= accepted:
            return Solved(system, converged=True, iterations=iteration)
        if iteration >= settings.newton_limit and not unbalanced <= _FALLING * last:
            return Solved(system, converged=False, iterations=iteration)
        last = unbalanced
        step = system.solve(-system.residual)
        if step is None:
            return Solved(system, converged=False, iterations=iteration + 1)
        correction = float(np.abs(step[model.moving]).max())
        if not held_depths and correction <= _NOTHING * settings.correction and unbalanced <= _NOTHING * accepted:
            return Solved(system, converged=True, iterations=iteration)  # this step is not needed
        far += correction > _MAX_MOTION
        longest = max(longest, correction)
        small = [*small[1 - _STALLED :], correction] if correction < _SMALL * min(1.0, longest) else []
        stalled = not held_depths and len(small) == _STALLED and min(small) > 0.5 * small[0]
        if far >= _LONG_CORRECTIONS or stalled:
            return Solved(system, converged=False, iterations=iteration + 1)
        step *= min(1.0, _MAX_MOTION / max(correction, _MAX_MOTION))
        predicted = {contact.pair: contact.predicted_forces(step) for contact in system.touches}
        if penalties and not held_depths and unbalanced > accepted:
            system = _line_searched(model, settings, penalties, values, system, step, predicted, drag, settled_at)
            z = system.z
        else:
            z = settled_at(system, advance(model, z, step))
            system = assemble(model, penalties, settings.quadrature, values, z, acting, held_depths, predicted, drag)
        settled = iteration >= _HOLD_ITERATIONS or correction < _SETTLED
        opened = [
            contact.pair
            for contact in system.touches
            if not contact.closed
            and contact.pair in depths.keys() - held_depths.keys()
            and float(predicted[contact.pair].sum()) > 0.0
        ]
        if opened and not settled:
            held_depths = {**held_depths, **{pair: depths[pair] for pair in opened}}
            system = assemble(model, penalties, settings.quadrature, values, z, acting, held_depths, predicted, drag)
        released = [
            contact.pair
            for contact in system.touches
            if contact.pair in held_depths
            and (
                settled
                or _near_depth(contact, held_depths[contact.pair])
                or (iteration > 0 and predicted[contact.pair].sum() < 0.0)
            )
        ]
        if released:
            held_depths = {pair: depth for pair, depth in held_depths.items() if pair not in released}
            system = assemble(model, penalties, settings.quadrature, values, z, acting, held_depths, predicted, drag)
        iteration += 1


def _needs_holding(contact: Touch, depths: Mapping[Contact, float], before: Mapping[Contact, Array]) -> bool:
    """True if a contact has to be held; a contact without force or overlap stays as it was."""
    if contact.pair not in depths or _near_depth(contact, depths[contact.pair]):
        return False
    pressed = contact.pair in before and float(before[contact.pair].sum()) > 0.0
    return pressed or contact.penetration > _TOUCHING * contact.pair.scale


def _near_depth(contact: Touch, depth: float) -> bool:
    """True if the penetration is within reach of Newton's method from ``depth``."""
    return depth / _NEAR < contact.penetration < _NEAR * depth


def _line_searched(
    model: Model,
    settings: Settings,
    penalties: Mapping[Contact, Penalty],
    values: Array,
    system: System,
    step: Array,
    predicted: Mapping[Contact, Array],
    drag: Drag | None,
    settled_at: Callable[[System, State], State],
) -> System:
    """System after a line search along the motions of ``step``; forces take the full step."""
    forces = step.copy()
    forces[model.moving] = 0.0
    motions = step - forces

    def after(fraction: float) -> System:
        z = advance(model, system.z, forces + fraction * motions)
        if fraction == 1.0:
            z = settled_at(system, z)
        return assemble(model, penalties, settings.quadrature, values, z, system.acting, {}, predicted, drag)

    def slope(there: System) -> float:
        return float(motions @ there.residual)

    return line_search(after, slope, float(motions @ (system.residual + system.tangent.matrix @ forces)))

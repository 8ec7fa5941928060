"""Energy-drop test: a step that releases energy has left its branch.

======  =========================================================================================
symbol  meaning
======  =========================================================================================
λ, h    value of the stepped parameter, and its increment
Π       potential energy with the energy of penalties, minimal in an equilibrium
F       dΠ/dλ along a branch, equal to ∂Π/∂λ because Π is stationary
======  =========================================================================================

Along a branch Π changes by the integral of F, by Hermite's rule exact up to the fifth power of h:

    ΔΠ = h (F_a + F_b)/2 + h² (F′_a − F′_b)/12.

After a jump less energy is left. In ever shorter steps the missing energy is constant. The error bound of the rule,
the change of F, vanishes with h except for the jump of F. In a long step the missing energy may hide in the error
bound. Then F has dropped against F_a + h (F′_a + F′_b)/2, or F rises first and falls at the end of the step. Before a
fold F falls ever faster, and F may also fall on the branch beyond. An opening contact or a smooth maximum of F has a
similar effect, which vanishes with the step length.
"""

import numpy as np

from cprbm_scene.answer import Array
from fea_reference.acting import Acting
from fea_reference.energy import penalised_energy, potential_energy
from fea_reference.model import DrivePart, Model
from fea_reference.system import System, load_direction

_OFF = 0.1  # times h and the change of F: largest error of the rule on a branch
_DROPPED = 0.6  # times the change of F: accepted deficit against its derivatives
_NOTICED = 0.01  # times F: negligible change
_ROUNDED = 1e-9  # relative to the energies: Newton's residual and an edge's corners leave 1e-10
_NOTHING = 1e-13  # energy of an unloaded mechanism: no branch ends there


def releases_energy(
    model: Model, load: int, acting: Acting, ends: tuple[tuple[System, Array, Array], tuple[System, Array, Array]]
) -> bool:
    """True if a step's second end has less energy than the branch from the first end leads to.

    For both ends: the system, the values, and the path tangent (size,) by the ``load``; dimensionless, with equal
    penalties.
    """
    h = float(ends[1][1][load] - ends[0][1][load])
    energies = [penalised_energy(model, system, values) for system, values, _ in ends]
    forces = [_force(model, load, system, values, h) for system, values, _ in ends]
    # F′ from the path tangent
    bends = [-float(load_direction(model, load, system.z, acting) @ rate) for system, _, rate in ends]
    size = max(map(abs, energies)) + abs(h) * max(map(abs, forces))
    if size < _NOTHING:
        return False
    rule = 0.5 * h * (forces[0] + forces[1]) + h**2 * (bends[0] - bends[1]) / 12.0
    missing = rule - (energies[1] - energies[0])
    off = abs(h) * (abs(forces[1] - forces[0]) + 0.5 * abs(h) * abs(bends[1] - bends[0]))
    if missing > _OFF * off + _ROUNDED * size:
        return True
    changes = (forces[1] - forces[0], h * bends[0], h * bends[1])
    largest, least = max(map(abs, changes)), max(_NOTICED * max(map(abs, forces)), _ROUNDED * size / abs(h))
    dropped = float(np.sign(h)) * (0.5 * (changes[1] + changes[2]) - changes[0])
    turned = changes[1] * h > 0.0 > changes[2] * h and min(abs(changes[1]), abs(changes[2])) > least
    return bool(turned or dropped > max(_DROPPED * largest, least))


def _force(model: Model, load: int, system: System, values: Array, h: float) -> float:
    """F: for a drive its reaction, for a load a difference quotient, as Π is quadratic in its value."""
    part = model.stepped[load]
    if isinstance(part, DrivePart):
        return -float(system.z.values[part.row])
    raised, lowered = values.copy(), values.copy()
    raised[load] += h
    lowered[load] -= h
    return (potential_energy(model, system, raised) - potential_energy(model, system, lowered)) / (2.0 * h)

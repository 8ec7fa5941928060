"""Whether a step has released energy: it has left its branch, however near the other one is.

======  =========================================================================================
symbol  meaning
======  =========================================================================================
λ, h    value of what is stepped, and by how much a step changes it
Π       the potential energy with what penalties store: what an equilibrium has least of
F       dΠ/dλ along a branch: ∂Π/∂λ, as everything else is stationary
======  =========================================================================================

Along a branch Π changes by the integral of F, which the rule of Hermite has to the fifth power of h:

    ΔΠ = h (F_a + F_b)/2 + h² (F′_a − F′_b)/12.

A jump leaves less.  However short the step is then, what is missing stays, while what F changes by in it, the measure
of what the rule may be off by, goes to zero with h but for the jump of F itself.  In a long step what is missing hides
behind that; there it is F that has dropped where F_a + h (F′_a + F′_b)/2 says otherwise, or that rises where the step
begins and falls where it ends: before a fold F falls ever faster, and the branch beyond may fall as well.  Where a
contact lets go within a step, or F has a smooth top, either seems so, but the less the shorter the step.
"""

import numpy as np

from cprbm_scene.answer import Array
from fea_reference.acting import Acting
from fea_reference.energy import penalised_energy, potential_energy
from fea_reference.model import DrivePart, Model
from fea_reference.system import System, load_direction

_OFF = 0.1  # of h times what F changes by: the most by which the rule is off on a branch
_DROPPED = 0.6  # of what F changes by: by how much it may be less than its rates say
_NOTICED = 0.01  # of F: less than that is a bend
_ROUNDED = 1e-9  # of the energies themselves: Newton's residual and a face's corners leave 1e-10
_NOTHING = 1e-13  # energy, in units, of a mechanism at rest: no branch ends there


def released(
    model: Model, load: int, acting: Acting, ends: tuple[tuple[System, Array, Array], tuple[System, Array, Array]]
) -> bool:
    """Whether there is less energy at the second of a step's ``ends`` than the branch leads to from the first.

    Of each: the system, the values, and the rate (size,) by that of the ``load``; all without units, penalties alike.
    """
    h = float(ends[1][1][load] - ends[0][1][load])
    energies = [penalised_energy(model, system, values) for system, values, _ in ends]
    forces = [_force(model, load, system, values, h) for system, values, _ in ends]
    bends = [_bend(model, load, system, rate, acting) for system, _, rate in ends]
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
    """F: of a drive what holds it, of a load, in whose value Π is a square, the quotient of differences."""
    part = model.stepped[load]
    if isinstance(part, DrivePart):
        return -float(system.z.values[part.row])
    more, less = values.copy(), values.copy()
    more[load] += h
    less[load] -= h
    return (potential_energy(model, system, more) - potential_energy(model, system, less)) / (2.0 * h)


def _bend(model: Model, load: int, system: System, rate: Array, acting: Acting) -> float:
    """F′ by the rate of everything else."""
    return -float(load_direction(model, load, system.z, acting) @ rate)

"""The way from one station to the next, the states on it, and the test for a step to another branch of minima.

=======  ====================================================================================
symbol   meaning
=======  ====================================================================================
t        fraction of the way, from 0 to 1
f*, μ*   targets of the rows, linear in t
Π        potential energy: strain energy, energy of the rows with prescribed force, energy of point contacts
Π′       dΠ/dt of equilibria: Σ −μ df*/dt of prescribed values, Σ f dμ*/dt of prescribed forces,
         less the part of the flexibility that the chain does not show
Δθ       turns of the links in a step
τ₀, τ₁   tangents dθ of the step at both ends
Π₀′, Π₁′ power of the step at both ends; Π″ their rates
=======  ====================================================================================

**Jumps.**  On a single branch Δθ is near the mean of both tangents, and the change of Π near Hermite's quadrature
(Π₀′ + Π₁′)/2 + (Π₀″ − Π₁″)/12.  Steps on a single branch reached 0.43 and 0.18 in all
built-in cases, steps to another branch 0.28 and 0.05 at least, with turns beyond 0.1 rad: there 0.25 is an alarm.
"""

from dataclasses import dataclass

import numpy as np

from cprbm.chain import add_row_gradient, row_values, strain_energy
from cprbm.contact import TOUCHING, lost_at
from cprbm.equilibrium import Solved, State, System, hidden_forces
from cprbm_scene.answer import Array

BENT = 0.5
"""Largest distance of the turns from the mean of both tangents, over the largest turn."""

FAR = 0.1
"""Turn in a step, rad, beyond which half the distance is an alarm: the step need not be so long."""

MISSED = 0.25
"""Largest error of the quadrature, over half the change of the power in the step."""

OUTSIDE = 1.1
"""Largest distance of the mean power of a step from the mean of both ends, over half the change, with one tangent."""

SMALLEST_TURN = 1e-4
"""Turn in a step, rad, below which tangents are not compared: such a step cannot lead to another branch."""

SMALLEST_WORK = 1e-9
"""Power, and its change over the power, below which the energy is not compared: round-off of its sum is near."""


@dataclass(frozen=True, eq=False)
class Way:
    """Targets of all rows at the begin and the end (rows,), values (SI) and name of the stepped load or drive, stage.

    The targets of stops are zero: a closed stop stays at the limit, an open stop has no force.
    """

    begin: Array
    end: Array
    values: tuple[float, float] = (0.0, 1.0)
    name: str = ""
    stage: str = ""

    @property
    def change(self) -> Array:
        """Change of the targets on the whole way."""
        return self.end - self.begin

    def target(self, t: float) -> Array:
        """Targets at a fraction of the way."""
        return self.end if t >= 1.0 else self.begin + t * self.change

    def value(self, t: float) -> float:
        """Value (SI) of the stepped load or drive."""
        return self.values[0] + t * (self.values[1] - self.values[0])


@dataclass(frozen=True, eq=False)
class Reached:
    """A state on the way at the fraction ``t``."""

    t: float
    solved: Solved


def potential(system: System, state: State) -> float:
    """Π in units of moment."""
    mu = np.where(state.driven | state.repeated, 0.0, state.multipliers(system))
    hidden = hidden_forces(system, state.z, mu)
    acting = mu @ row_values(state.z, system.rows) - 0.5 * hidden @ system.hidden @ hidden
    return float(strain_energy(state.z, system.links, system.joints) + acting) + _point_energy(system, state)


def _point_energy(system: System, state: State) -> float:
    """Energy Σ c F²/2 of the compliance c that the chain lacks under point contacts."""
    contacts, arrays = state.contacts, system.geometry.arrays
    places, energy = contacts.places, 0.0
    for k in np.flatnonzero(contacts.closed & places.moves).tolist():
        lost = lost_at(arrays, places.piece[k], places.xi[k], 0) + lost_at(arrays, places.foot[k], places.eta[k], 0)
        energy += 0.5 * lost * float(places.force[k]) ** 2
    return energy


def tangent(solved: Solved, change: Array) -> Array:
    """dz/dt (size,) of the equilibria for a ``change`` of the targets."""
    system, state = solved.system, solved.state
    load = np.zeros(system.size)
    add_row_gradient(state.z, system.rows, np.where(state.driven, 0.0, -change), load)
    load[system.rows.first :] = np.where(state.driven, change, 0.0)
    rate = solved.response(load)
    rate[system.rows.first :][~state.driven] = change[~state.driven]
    return rate


def power(solved: Solved, change: Array) -> float:
    """Π′."""
    system, state = solved.system, solved.state
    of_row = np.where(state.driven, -state.multipliers(system), solved.values)
    hidden, changing = (hidden_forces(system, state.z, forces) for forces in (state.multipliers(system), change))
    return float(of_row @ change - hidden @ system.hidden @ changing)


def power_rate(solved: Solved, change: Array, rate: Array) -> float:
    """dΠ′/dt along the tangent ``rate``."""
    system, state = solved.system, solved.state
    slope = np.zeros(system.size)
    add_row_gradient(state.z, system.rows, np.where(state.driven, 0.0, change), slope)
    forced = np.where(state.driven, 0.0, change)
    hidden = hidden_forces(system, state.z, forced)
    return float(slope @ rate - (change - forced) @ rate[system.rows.first :] - hidden @ system.hidden @ hidden)


def energy_before(solved: Solved, change: Array, part: float) -> float:
    """Π at a ``part`` of the way before a state on the same branch, by Taylor's series."""
    rate = power_rate(solved, change, tangent(solved, change))
    return potential(solved.system, solved.state) - part * power(solved, change) + 0.5 * part**2 * rate


def turned(before: Solved, after: Solved) -> float:
    """Largest turn of a link or a body between two states, rad."""
    return float(np.abs(after.state.z - before.state.z)[before.system.turns].max())


def pressing_joints(solved: Solved) -> list[tuple[int, int]]:
    """Pairs and pieces of the closed joints where all places are joints; else empty."""
    contacts = solved.state.contacts
    closed = contacts.closed & solved.system.geometry.joints_alone
    return list(zip(contacts.places.pair[closed].tolist(), contacts.places.piece[closed].tolist(), strict=True))


def jumped(before: Solved, after: Solved, change: Array) -> bool:
    """True if a step between two minima, with a ``change`` of the targets, left the branch.

    Where open places touch at the first state, the tangent there is one-sided.  Where all places are joints and other
    joints press at the end, the tangent has changed at every exchange of joints.  Then only the energy tells.
    """
    system = before.system
    rates = tangent(before, change), tangent(after, change)
    angles = system.angles
    turn = after.state.z[angles] - before.state.z[angles]
    largest = float(np.abs(turn).max())
    mean = 0.5 * (rates[0][angles] + rates[1][angles])
    touching = np.any(np.abs(before.gaps[~before.state.contacts.closed]) < TOUCHING)
    one_sided = touching or pressing_joints(before) != pressing_joints(after)
    if (
        not one_sided
        and max(largest, float(np.abs(mean).max())) > SMALLEST_TURN
        and float(np.abs(turn - mean).max()) > (0.5 if largest > FAR else 1.0) * BENT * largest
    ):
        return True
    powers = power(before, change), power(after, change)
    scale, spread = max(abs(powers[0]), abs(powers[1])), abs(powers[1] - powers[0])
    if scale < SMALLEST_WORK or spread < SMALLEST_WORK * scale or largest < SMALLEST_TURN:
        return False
    curved = power_rate(before, change, rates[0]) - power_rate(after, change, rates[1])
    missed = potential(system, after.state) - potential(system, before.state) - 0.5 * (powers[0] + powers[1])
    return abs(missed) > OUTSIDE * 0.5 * spread if one_sided else abs(missed - curved / 12.0) > MISSED * 0.5 * spread

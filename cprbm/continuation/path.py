"""The way from one station to the next, and the states on it.

=======  ====================================================================================
symbol   meaning
=======  ====================================================================================
t        fraction of the way, from 0 to 1
f*, μ*   targets of the rows, linear in t
Π        potential energy: strain energy, energy of the rows with prescribed force, energy of point contacts
Π′       dΠ/dt of equilibria: Σ −μ df*/dt of prescribed values, Σ f dμ*/dt of prescribed forces,
         less the part of the flexibility that the chain does not show
=======  ====================================================================================
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cprbm.chain import add_row_gradient, row_values, strain_energy
from cprbm.contact import lost_at
from cprbm.equilibrium.solving import Solved
from cprbm.equilibrium.system import State, System, hidden_forces
from cprbm_scene.answer import Array


@dataclass(frozen=True, eq=False)
class Way:
    """Targets of all rows at the begin and the end (rows,), and values (SI) and name of the stepped load or drive."""

    begin: Array
    end: Array
    values: tuple[float, float] = (0.0, 1.0)
    name: str = ""

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
    system = before.system
    return float(np.abs(after.state.z - before.state.z)[system.turns].max())

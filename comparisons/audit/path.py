"""Energy along the path: between two stations of one branch the potential energy changes by the work.

======  ==========================================================================
symbol  meaning
======  ==========================================================================
Π       strain energy less the work of the loads
g, x    dΠ/dx and x of the stepped load or drive: -u and P, or F and d
h       step between two stations
======  ==========================================================================

The trapezoidal rule gives ΔΠ = h (g₀ + g₁)/2.  The allowance is the difference of both products, and twice the term
|g[x₀, x₁, x₂]| h³/6 of a third station beside.  Without a third station only a loss of energy counts: between far
stations a reaction may rise and fall.  A silent jump to another state loses energy that no work accounts for.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise

import numpy as np

from comparisons.audit.probes import energies
from comparisons.audit.state import StationState, unit
from cprbm_scene import Answer
from cprbm_scene.statement import DisplacementDrive

CURVED = 2.0
"""Times the term of the third station that the trapezoidal rule may be off."""

FITTED = 2e-3
"""Difference of energies, over the energies, between meshes that are fitted from station to station."""

CONTINUOUS = 0.01
"""Energy gained beyond a critical point, over the energy: a continuous bifurcation releases none."""

ROUND_OFF = 1e-9
"""Energy that round-off explains, over the natural energy E·I/L."""


def path(answer: Answer, states: Sequence[StationState]) -> Iterator[str]:
    """Steps over which the energy changes by more than the work, and critical points beyond which energy grows."""
    for i, (one, other) in enumerate(pairwise(states)):
        branch = one.station.stage, one.station.branch
        if branch == (other.station.stage, other.station.branch):
            beside = [*states[max(0, i - 1) : i], *states[i + 2 : i + 3]]
            lost, allowed = _lost(one, other, [state for state in beside if state.station.branch == branch[1]])
            if not -allowed <= lost <= (allowed if beside else np.inf):
                where = f"from {branch[0]} {one.station.value:g} to {other.station.value:g}"
                yield f"{where} the energy changes by {lost:.3g} J more than the work, {allowed:.2g} J are allowed"
    for critical in answer.critical:
        floor = CONTINUOUS * abs(critical.energy) + (ROUND_OFF * states[0].natural if states else 0.0)
        if critical.after is not None and not critical.after <= critical.energy + floor:
            after = f"{critical.after:.4g} J, more than {critical.energy:.4g} J before"
            yield f"beyond {critical.stage} {critical.value:g} the energy is {after}"


def _lost(one: StationState, other: StationState, beside: list[StationState]) -> tuple[float, float]:
    """Change of energy less the work, and the allowed amount."""
    name = next(stage.steps for stage in one.scene.stages if stage.name == one.station.stage)
    (x0, g0), (x1, g1), *thirds = ((state.values[name], _driving(state, name)) for state in (one, other, *beside))
    (strain0, work0, even0), (strain1, work1, even1) = (energies(state) for state in (one, other))
    step, bent = x1 - x0, 0.0
    for x, g in thirds:
        if step and (x - x0) and (x - x1):
            bent = max(bent, abs(((g - g1) / (x - x1) - (g1 - g0) / step) / (x - x0) * step**3) / 6.0)
    allowed = abs((g1 - g0) * step) + CURVED * bent + 2.0 * (even0 + even1) + ROUND_OFF * one.natural
    allowed += FITTED * (strain0 + strain1 + abs(work0) + abs(work1))
    return strain1 - work1 - strain0 + work0 - 0.5 * (g0 + g1) * step, allowed


def _driving(state: StationState, name: str) -> float:
    """g of the stepped load or drive."""
    if name in state.scene.loads:
        return -state.way_of(name)
    drive, forces = state.scene.drives[name], state.forces[state.forces["source"] == name]
    if isinstance(drive, DisplacementDrive):
        return float((forces["force"].sum() * np.conj(unit(drive.direction))).real)
    return float(forces["moment"].sum())

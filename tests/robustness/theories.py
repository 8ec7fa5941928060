"""How much stretch and shear make of a mechanism, roughly: the chains' forces, and what beams would yield to them.

What a row's theories are apart no mesh makes smaller.  In a mechanism that bending alone can follow it is about
(t/L)²; where ends are held so that a beam has to become longer or shorter it can be anything.  The first is left
thick, the second is made thinner.

======  =====================================================================================================
symbol  meaning
======  =====================================================================================================
N, Q    axial and shear force in a bar, N
U_b     energy of the chains' springs, J
U_t     energy that stretch and shear would add under the same forces, ½ ∫ N²/(E A) + 6/5 Q²/(G A) ds, J
======  =====================================================================================================
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from cprbm_scene import FreeEnd
from cprbm_scene.curves import unit_vector as unit
from cprbm_scene.statement import BeamForce, DistributedLoad
from tests.robustness.chance import RedrawError, rounded
from tests.robustness.draft import Data, Draft
from tests.robustness.estimate import BARS, Barrier, Estimate, State, rigidity_of

Array = NDArray[np.float64]
LARGEST_SHARE = 3e-3  # of U_t in U_b: a contact's force may differ by some times that
LEAST = 0.05  # of the largest U_b: states with less are not told by it
THINNEST = 1.0 / 1500.0  # of a beam's length


def share_of(model: Estimate, states: Sequence[State], barriers: Sequence[Barrier]) -> float:
    """The largest U_t / U_b of some states, those left out that hardly bend."""
    bent = [0.5 * float(state.q @ model.stiffness @ state.q) for state in states]
    return max(
        (_yielding(model, state, barriers) / U for state, U in zip(states, bent, strict=True) if LEAST * max(bent) < U),
        default=0.0,
    )


def _yielding(model: Estimate, state: State, barriers: Sequence[Barrier]) -> float:
    """U_t."""
    found = 0.0
    for name, at_nodes in _forces(model, state, barriers).items():
        beam = model.scene.beams[name]
        backwards = isinstance(beam.start, FreeEnd)
        # what acts beyond a bar, seen from where the chain is held
        beyond = np.cumsum(at_nodes, axis=0)[:-1] if backwards else np.cumsum(at_nodes[::-1], axis=0)[:-1][::-1]
        bars = np.diff(model.shape(state.q, name), axis=0)
        lengths = np.hypot(*bars.T)
        along = (beyond * bars).sum(axis=1) / lengths
        squared = (beyond**2).sum(axis=1)
        u = (np.arange(BARS) + 0.5) / BARS
        EA = 12.0 * rigidity_of(model.scene, beam, u) / np.asarray(beam.thickness_at(u)) ** 2
        shear = 1.2 * 2.0 * (1.0 + model.scene.materials[beam.material].poisson_ratio)
        found += 0.5 * float(np.sum(lengths * (along**2 + shear * (squared - along**2)) / EA))
    return found


def _forces(model: Estimate, state: State, barriers: Sequence[Barrier]) -> dict[str, Array]:
    """By beam the forces on the nodes of its chain (bars + 1, 2) from all but where the chain is held, N."""
    scene, q = model.scene, state.q
    found = {name: np.zeros((BARS + 1, 2)) for name in scene.beams}
    left = model.stiffness @ q
    for name, load in scene.loads.items():
        value = state.values.get(name, 0.0)
        left = left - value * model.acted(load).slopes(q)[0]
        if isinstance(load, BeamForce):
            found[load.beam][round(load.at * BARS)] += value * np.array(unit(load.direction))
        elif isinstance(load, DistributedLoad):
            low, high = load.along
            inside = [i for i in range(BARS + 1) if low * BARS - 0.5 <= i <= high * BARS + 0.5]
            each = value * (high - low) * model.lengths[load.beam] / len(inside)
            found[load.beam][inside] += each * np.array(unit(load.direction))
    for barrier in barriers:
        pushes = model.pushed(q, barrier)
        left = left - model.lines[barrier.beam].slopes(q).T @ pushes.ravel()
        found[barrier.beam] += pushes
    rows = [model.held.slopes(q), *(model.acted(drive).slopes(q) for drive in scene.drives.values())]
    mu = np.linalg.lstsq(np.vstack(rows).T, -left, rcond=None)[0]
    closed = [name for name, beam in scene.beams.items() if not {FreeEnd} & {type(beam.start), type(beam.end)}]
    for i, name in enumerate(closed):  # in the order of the rows that hold their ends
        found[name][-1] -= mu[2 * i : 2 * i + 2]
    return found


def made_thin(draft: Draft, share: float) -> None:
    """Make all beams thinner by what their ``share`` of U_t is too large, and loads weaker as they are softer.

    Raises:
        RedrawError: they would be too thin.
    """
    by = (LARGEST_SHARE / share) ** 0.5 if share > LARGEST_SHARE else 1.0
    if by == 1.0:
        return
    for beam in draft.data["beams"].values():
        beam["thickness"] = _times(beam["thickness"], by)
        thickness = beam["thickness"]
        if min(thickness["values"] if isinstance(thickness, dict) else [thickness]) < THINNEST * draft.frame.size:
            raise RedrawError
    for stage in draft.data["stages"]:
        if stage["steps"] in draft.data.get("loads", {}):
            stage["stations"] = [rounded(station * by**3) for station in stage["stations"]]


def _times(size: Data | float, by: float) -> Data | float:
    if isinstance(size, dict):
        return size | {"values": [rounded(value * by, 3) for value in size["values"]]}
    return rounded(size * by, 3)

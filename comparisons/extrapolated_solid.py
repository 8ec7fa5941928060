"""What the solid's values at meshes that double tend to, and how far off that may be.

======  =====================================================================================================
symbol  meaning
======  =====================================================================================================
v, V    the solid's value at n and at 2n elements along (and across, m and 2m), the finest two meshes
w       at n/2, where three meshes have been solved
p       order of convergence, 2λ
λ       exponent of the displacement at the corner where a free edge meets a face that is held, κ = (3 − ν)/(1 + ν):
        κ sin²(λ π/2) = (κ + 1)²/4 − λ², at most 1
q       the order of the largest changes in the stage, |v − w|/|V − v| = 2^q, between 1/2 and 4; of two meshes p
x       extrapolated value, V + (V − v)/(2^q − 1)
u       its uncertainty, S |x − V|
======  =====================================================================================================

Elements of second order would converge with the fourth power of their size, but a face that is held keeps the section
from growing wider, and at its corners the stress has no bound: the energy, and with it every displacement, converges
with 2λ (M. L. Williams, Stress singularities resulting from various boundary conditions in angular corners of plates in
extension, J. Appl. Mech. 19 (1952) 526; Szabó & Babuška, Finite Element Analysis, on meshes that are even).  With the
largest ν of the scene this is about 1.5; taken for the order of all quantities it makes u larger where they are better.

A third mesh shows the order.  It may be higher, for elements are short beside held faces, and it may be less, where
the end of a zone of contact falls between nodes as it likes; then u is larger than two meshes would have said.  One
order for a probe's whole stage: at a single station a change may vanish by accident.  S = 1.25 is what Roache asks of
an order that was observed (P. J. Roache, Verification and Validation in Computational Science, 1998, chapter 5).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cache

import numpy as np

from comparisons.measures import Row
from comparisons.order import SAFETY
from comparisons.scales import norm
from comparisons.spots import clear_of_spots
from comparisons.stations import station_of
from cprbm_scene import Answer, Probe, Scene, StationAnswer
from cprbm_scene.answer import Array, Flags
from cprbm_scene.statement import STRESSES

SLOWEST, FASTEST = 0.5, 4.0
Orders = Mapping[tuple[str, str], float]
"""q by the names of stage and probe."""


def extrapolated(v: Array, V: Array, order: float) -> tuple[Array, Array]:
    """x and, component by component with its sign, what u is the size of; both as ``v`` (k,) and ``V`` (k,)."""
    change = (V - v) / (2.0**order - 1.0)
    return V + change, SAFETY * change


def orders_of(scene: Scene, answers: Sequence[Answer]) -> Orders:
    """q of every stage and probe, or p of all where only two meshes have been solved."""
    assumed = corner_order(max(one.poisson_ratio for one in scene.materials.values()))
    return {
        (stage.name, probe.name): _observed(stage.name, stage.stations, probe, answers, assumed)
        for stage in scene.stages
        for probe in scene.probes
    }


def _observed(stage: str, stations: Sequence[float], probe: Probe, answers: Sequence[Answer], assumed: float) -> float:
    if len(answers) < 3:
        return assumed
    largest = [0.0, 0.0]
    for value in stations:
        w, v, V = (station_of(answer, stage, value).values[probe.name] for answer in answers[-3:])
        if w.shape == v.shape == V.shape:
            largest = [max(largest[0], norm(probe.quantity, v - w)), max(largest[1], norm(probe.quantity, V - v))]
    if not min(largest) > 0.0:
        return assumed
    return float(np.clip(np.log2(largest[0] / largest[1]), SLOWEST, FASTEST))


def at_row(
    scene: Scene, row: Row, answers: Sequence[Answer], orders: Orders, beside: Sequence[StationAnswer] = ()
) -> tuple[Array, Array, Flags] | None:
    """x (k,), what u is the size of (k,), and which components count; None where one has no value of the row's shape.

    Args:
        scene: the question.
        row: of a comparison.
        answers: the solid's, each on a mesh twice as fine as the one before; all of them whole.
        orders: :func:`orders_of` these.
        beside: what else answers the row, whose contacts count as well: of a stress those places are left out that
            are near held ends and near what presses.
    """
    stations = [station_of(answer, row.stage, row.station) for answer in answers[-2:]]
    v, V = (station.values[row.probe.name] for station in stations)
    if v.shape != row.fea.shape or V.shape != row.fea.shape:
        return None
    counts = np.ones(row.fea.shape, dtype=bool)
    if row.probe.quantity in STRESSES and row.arc_length is not None:
        counts = clear_of_spots(scene, row.probe.of, row.arc_length, (*stations, *beside))
    x, off = extrapolated(v, V, orders[row.stage, row.probe.name])
    return x, off, counts


@cache
def corner_order(poisson_ratio: float) -> float:
    """p of a scene with that ratio, at most 2."""
    from scipy.optimize import brentq  # loaded when a solid is beside, not with every table

    kappa = (3.0 - poisson_ratio) / (1.0 + poisson_ratio)

    def excess(exponent: float) -> float:
        return float(kappa * np.sin(0.5 * np.pi * exponent) ** 2 - 0.25 * (kappa + 1.0) ** 2 + exponent**2)

    return 2.0 * brentq(excess, 0.1, 1.0) if excess(1.0) > 0.0 else 2.0

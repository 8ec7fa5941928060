"""Stated uncertainty of both solvers' values, from the runs on further grids.

======  ==========================================================================================
symbol  meaning
======  ==========================================================================================
v_c     value of the CPRBM at N links; v_a in the formulation ``auto``, where ``paper`` is compared
v_f     value of the finite elements at n elements in the chosen theory; v_b in ``bending``
u_c     |v_c − v_a| + u(v_a)
u_f     the larger of u(v_f) and u_b
u_b     u(v_b), with the uneven part of u(v_f) where that is larger: the meshes are the same
θ       |v_b − v_f|, the step of theory
r       round-off
======  ==========================================================================================

u is the uncertainty of :mod:`comparisons.verdict.uncertainty` on the grids N, N + N/7 and 2N.  The two sums

    |v_c − v_f| ≤ u_c + u_f + θ + r,    |v_c − v_b| ≤ u_c + u_b + r

belong to a chain that cannot shear: the first alone would excuse a wrong CPRBM by a large step of theory.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from comparisons.pairing import Runs
from comparisons.verdict.uncertainty import Error, error
from cprbm_scene.answer import Array
from cprbm_scene.frozendict import frozendict


@dataclass(frozen=True, slots=True)
class Bounds:
    """Stated uncertainties of a row in the probe's unit, none negative.

    Attributes:
        cprbm: u_c.
        fea: u_f.
        bending: u_b; None where the finite elements have no value in ``bending``.
        theory: θ; 0 where the finite elements have no value in ``bending``.
        round_off: r.
    """

    cprbm: float
    fea: float
    bending: float | None
    theory: float
    round_off: float

    @property
    def own(self) -> float:
        """Stated uncertainty of the difference without the step of theory."""
        return self.cprbm + self.fea + self.round_off

    @property
    def total(self) -> float:
        """Stated uncertainty of the difference between the solvers."""
        return self.own + self.theory

    @property
    def same_theory(self) -> float:
        """Stated uncertainty of the difference within ``bending``; that of the chosen theory without such values."""
        return self.own if self.bending is None else self.cprbm + self.bending + self.round_off


def bounds_of(
    runs: Runs,
    values: Mapping[str, Array],
    size: Callable[[Array], float],
    round_off: float,
    known: Mapping[str, Error] = frozendict(),
) -> Bounds | None:
    """Stated uncertainties of a row; None where a solver lacks the value on the finer grid.

    Args:
        runs: the runs.
        values: values (k,) by name of the run, as :meth:`comparisons.pairing.Runs.everything` names it.
        size: norm of a difference (k,).
        round_off: r.
        known: uncertainties of settled runs, by name.
    """
    chosen = f"fea {runs.kinematics}"
    even = values.get("cprbm auto", values["cprbm"])
    of_cprbm = known.get("cprbm") or _error(even, values, "cprbm", runs.ratio)
    of_fea = known.get(chosen) or _error(values[chosen], values, chosen, runs.fea_ratio)
    if of_cprbm is None or of_fea is None:
        return None
    bending, theory = None, 0.0
    if "fea bending" in values:
        v_b = values["fea bending"]
        theory = size(v_b - values[chosen])
        of_bending = known.get("fea bending") or _error(v_b, values, "fea bending", runs.fea_ratio)
        if of_bending is not None:
            bending = size(of_bending.even) + max(size(of_bending.uneven), size(of_fea.uneven))
    return Bounds(
        cprbm=size(values["cprbm"] - even) + size(of_cprbm.even) + size(of_cprbm.uneven),
        fea=max(size(of_fea.even) + size(of_fea.uneven), bending or 0.0),
        bending=bending,
        theory=theory,
        round_off=round_off,
    )


def _error(value: Array, values: Mapping[str, Array], name: str, ratio: float) -> Error | None:
    """Uncertainty of the ``value`` of the runs of a name; None without a run at 2N."""
    if f"{name} finer" not in values:
        return None
    grids = [(1.0, value), (2.0, values[f"{name} finer"])]
    if f"{name} beside" in values:
        grids.insert(1, (1.0 / ratio, values[f"{name} beside"]))
    sizes, found = zip(*grids, strict=True)
    return error(sizes, found)

"""Stated uncertainty of both solvers' values, from the runs on further grids.

======  ==========================================================================================
symbol  meaning
======  ==========================================================================================
v_c     value of the CPRBM at N links; v_a in the formulation ``auto``, where ``paper`` is compared
v_f     value of the finite elements at n elements
u_c     |v_c − v_a| + u(v_a)
u_f     u(v_f)
r       round-off
======  ==========================================================================================

u is the uncertainty of :mod:`comparisons.verdict.uncertainty` on the grids N, N + N/7 and 2N.  All runs have one beam
theory.  Two right solvers therefore have

    |v_c − v_f| ≤ u_c + u_f + r.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from comparisons.verdict.runs import Runs
from comparisons.verdict.uncertainty import Error, error
from cprbm_scene.answer import Array
from cprbm_scene.frozendict import frozendict


@dataclass(frozen=True, slots=True)
class Bounds:
    """Stated uncertainties of a row in the probe's unit, none negative: u_c, u_f and r."""

    cprbm: float
    fea: float
    round_off: float

    @property
    def total(self) -> float:
        """Stated uncertainty of the difference between the solvers."""
        return self.cprbm + self.fea + self.round_off


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
        values: values (k,) by name of the run, as :meth:`comparisons.verdict.runs.Runs.everything` names it.
        size: norm of a difference (k,).
        round_off: r.
        known: uncertainties of settled runs, by name.
    """
    even = values.get("cprbm auto", values["cprbm"])
    of_cprbm = known.get("cprbm") or _error(even, values, "cprbm", runs.ratio)
    of_fea = known.get("fea") or _error(values["fea"], values, "fea", runs.fea_ratio)
    if of_cprbm is None or of_fea is None:
        return None
    return Bounds(
        cprbm=size(values["cprbm"] - even) + size(of_cprbm.even) + size(of_cprbm.uneven),
        fea=size(of_fea.even) + size(of_fea.uneven),
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

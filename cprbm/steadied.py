"""From meshes each of which is fitted to the state on the last, to the one that is fitted to the state on itself.

==========  ======================================================================================
x_k         a mesh's fit as numbers: its borders in elements, its kinks' slopes over the largest of them
f(x)        what fits the state on it; the mesh sought is x = f(x)
r_k         f(x_k) − x_k
==========  ======================================================================================

From x_{k+1} = f(x_k) alone two meshes may take turns: where a contact presses beside a border of elements, each says
that the other fits.  Of the two last, the mixture whose residual is least if f is linear between them is taken
(Anderson's method of depth one):

    x_{k+1} = f(x_k) − w·(f(x_k) − f(x_{k−1})),    w = r_k·(r_k − r_{k−1}) / |r_k − r_{k−1}|²
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from cprbm.model import Fit, Kinks
from cprbm_scene.answer import Array
from cprbm_scene.frozendict import frozendict

MOST = 0.9  # |w|: beyond, there is no line through the two

Turn = tuple[Fit, Fit]
"""A mesh's fit x_k, and f(x_k)."""


def steadied(now: Turn, before: Turn | None) -> Fit:
    """x_{k+1}; f(x_k) where the last two turns have no numbers in common, or one of them is a mesh of even elements."""
    wanted = now[1]
    if before is None or wanted.ends or not _same_numbers((*now, *before)):
        return wanted
    left, left_before = _residual(now), _residual(before)
    change = left - left_before
    squared = float(change @ change)
    weight = float(left @ change) / squared if squared > 0.0 else 0.0
    if not 0.0 < abs(weight) <= MOST:
        return wanted
    return _mixed(wanted, before[1], weight)


def _same_numbers(fits: tuple[Fit, ...]) -> bool:
    def built(fit: Fit) -> tuple[object, ...]:
        return (
            fit.ends.keys(),
            {beam: len(borders) for beam, borders in fit.borders.items()},
            {name: tuple(len(each.places) for each in kinks) for name, kinks in fit.kinks.items()},
        )

    return all(built(fit) == built(fits[0]) for fit in fits[1:])


def _residual(turn: Turn) -> Array:
    made, wanted = turn
    parts = [(len(wanted.borders[beam]) - 1) * (wanted.borders[beam] - made.borders[beam]) for beam in wanted.borders]
    for name, kinks in wanted.kinks.items():
        for here, there in zip(kinks, made.kinks[name], strict=True):
            largest = max(here.largest, there.largest) or 1.0
            parts += [(here.before - there.before) / largest, (here.behind - there.behind) / largest]
    return np.concatenate([np.zeros(0), *parts])


def _mixed(one: Fit, other: Fit, weight: float) -> Fit:
    """One fit less so much of what it is more than the other."""

    def less(here: Array, there: Array) -> Array:
        return np.asarray(here - weight * (here - there))

    return replace(
        one,
        borders=frozendict({beam: less(borders, other.borders[beam]) for beam, borders in one.borders.items()}),
        kinks=frozendict(
            {
                name: tuple(
                    Kinks(*(less(getattr(here, of), getattr(there, of)) for of in ("places", "before", "behind")))
                    for here, there in zip(kinks, other.kinks[name], strict=True)
                )
                for name, kinks in one.kinks.items()
            }
        ),
    )

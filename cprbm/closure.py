"""Loop closures, welds, slides and drives: the equalities Z(θ) = 0 of eq. (1).

==========  =======================================================================
Z_x, Z_y    beam's last joint less the point of the body it is joined to, less how far apart they are meant to be
Z_w         angle of the first or last link, less its stress-free one, less φ
Z_p         of pins between bodies, :mod:`cprbm.hinging`
Z_h         of slides and drives, :mod:`cprbm.holding`
μ           multipliers: force and moment of the beam on what its end is joined to
==========  =======================================================================

The first joint of a beam sits at its point by construction.  A first link that
is welded to the ground does not turn and is no unknown at all.

What the bodies have in an equality is linear in their posture, :mod:`cprbm.posture`.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from cprbm.hinging import Hinge
from cprbm.holding import Hold
from cprbm.kinematics import Positions, State, behind
from cprbm.model import Model
from cprbm.posture import Linear, points_of, stacked, turn_of
from cprbm_scene.answer import Array, Ints


@dataclass(frozen=True, slots=True, eq=False)
class Closure:
    """Which equalities a mechanism has, in the order of their rows: ends' x, y, welds, pins' x, y, slides, drives.

    Attributes:
        ends: index of each beam whose end is joined to a point.
        end_joints: the last joints of those beams.
        welds: (link, body) of every welded link that is an unknown; body −1 is the ground.
        fixed: links that do not turn (ground welds at a beam's start).
        hinges: pins between bodies.
        holds: slides and drives.
        own: Z less the last joints' places and the welded links' angles, without drives.
        whole: the same with what the last joints go with the points where their beams start.
        weld_links: the links of ``welds``.
        behind: of the last joints, as :func:`cprbm.kinematics.behind` says (ends, n_links + k).
        welded: derivatives of Z over the welded links, which are the same in all states, (rows, n_links + 3B).
        given: name of each value that is given, its row, and what the row has of it per unit (SI).
    """

    ends: tuple[int, ...]
    end_joints: Ints
    welds: tuple[tuple[int, int], ...]
    fixed: Ints
    hinges: tuple[Hinge, ...]
    holds: tuple[Hold, ...]
    own: Linear
    whole: Linear
    weld_links: Ints
    behind: Array
    welded: Array
    given: tuple[tuple[str, int, float], ...]

    @property
    def rows(self) -> int:
        """Number of equalities."""
        return len(self.welded)

    @property
    def first_hinge(self) -> int:
        """Row of the first pin between bodies."""
        return 2 * len(self.ends) + len(self.welds)

    @property
    def first_hold(self) -> int:
        """Row of the first slide or drive."""
        return self.first_hinge + 2 * len(self.hinges)


def closure_of(
    model: Model, hinges: tuple[Hinge, ...], holds: tuple[Hold, ...], free: frozenset[str] = frozenset()
) -> Closure:
    """The equalities of a mechanism; the ends of some beams are ``free`` as yet."""
    ends, welds, fixed = list[int](), list[tuple[int, int]](), list[int]()
    starts, places = list[tuple[int, tuple[float, float]]](), list[tuple[int, tuple[float, float]]]()
    given = list[tuple[str, int, float]]()
    count = model.n_bodies
    for c, chain in enumerate(model.chains):
        start, end = chain.start, chain.end
        if start.welded:
            if start.body < 0:
                fixed.append(chain.first_link)
            else:
                welds.append((chain.first_link, start.body))
        if end is not None and chain.name not in free:
            names = enumerate(apart_by(chain.name), start=2 * len(ends))
            given += [(name, row, 1.0 / model.unit_length) for row, name in names]
            ends.append(c)
            starts.append((start.body, start.point))
            places.append((end.body, end.point))
            if end.welded:
                welds.append((chain.first_link + chain.n, end.body))
    first_hold = 2 * len(ends) + len(welds) + 2 * len(hinges)
    given += [(hold.drive, row, hold.unit) for row, hold in enumerate(holds, start=first_hold) if hold.unit]
    rest = [Linear(np.array([-model.rest[link]]), -turn_of(body, count)) for link, body in welds]
    rest += [hinge.linear(model) for hinge in hinges]
    rest += [hold.linear(model) for hold in holds]
    own = stacked([-points_of(places, model.references), *rest], count)
    weld_links = np.array([link for link, _ in welds], dtype=np.intp)
    moved = own.over.copy()
    moved[: 2 * len(ends)] += points_of(starts, model.references).over
    welded = np.zeros((len(own.base), model.n_unknowns))
    welded[2 * len(ends) + np.arange(len(welds)), weld_links] = 1.0
    end_joints = np.array([model.chains[c].joints.stop - 1 for c in ends], dtype=np.intp)
    return Closure(
        ends=tuple(ends),
        end_joints=end_joints,
        welds=tuple(welds),
        fixed=np.array(fixed, dtype=np.intp),
        hinges=hinges,
        holds=holds,
        own=own,
        whole=Linear(own.base, moved),
        weld_links=weld_links,
        behind=behind(model, end_joints),
        welded=welded,
        given=tuple(given),
    )


def apart_by(beam: str) -> tuple[str, str]:
    """Names of the values that say how far, along x and y, a beam's end is apart from its point, m."""
    return f"{beam}.apart.x", f"{beam}.apart.y"  # no name in a scene holds a dot


def closure_values(model: Model, closure: Closure, state: State, at: Positions, given: Mapping[str, float]) -> Array:
    """Z (rows,) with the ``given`` values (SI) of drives and of how far ends are apart; without one they are zero."""
    values = closure.own.values(state.posture)
    k = 2 * len(closure.ends)
    values[0:k:2] += at.x[closure.end_joints]
    values[1:k:2] += at.y[closure.end_joints]
    values[k : k + len(closure.welds)] += state.theta[closure.weld_links]
    for name, row, unit in closure.given:
        if name in given:
            values[row] -= unit * given[name]
    return values


def closure_rows(model: Model, closure: Closure, state: State, at: Positions) -> Array:
    """∂Z over all unknowns, (rows, n_links + 3B)."""
    rows = closure.welded.copy()
    for r, c in enumerate(closure.ends):
        links = model.layout.links[c]
        np.negative(at.dy[links], out=rows[2 * r, links])
        rows[2 * r + 1, links] = at.dx[links]
    rows[:, model.n_links :] = closure.whole.over @ state.posture.derivatives[:, : 3 * model.n_bodies]
    return rows


def closure_forces(model: Model, closure: Closure, multipliers: Array) -> tuple[Array, Array]:
    """The multipliers as generalised forces on the joints, fx and fy (n_joints,)."""
    fx, fy = np.zeros(model.n_joints), np.zeros(model.n_joints)
    k = 2 * len(closure.ends)
    fx[closure.end_joints] = multipliers[0:k:2]
    fy[closure.end_joints] = multipliers[1:k:2]
    return fx, fy


def closure_sums(closure: Closure, multipliers: Array) -> Array:
    """The same, as :func:`cprbm.kinematics.summed` sums them (2, n_links + k)."""
    return np.asarray(multipliers[: 2 * len(closure.ends)].reshape(-1, 2).T @ closure.behind)


def closure_second(model: Model, closure: Closure, state: State, multipliers: Array) -> Array:
    """Second derivative over φ of each body (B,) of Σ μ·Z, the part of the bodies' own points."""
    return closure.own.gradient(state.posture, multipliers)[1]

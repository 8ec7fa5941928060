"""How a mechanism moves, roughly: chains of straight bars with springs between them, followed without any contact.

It tells where obstacles are in the way and how large loads have to be.  Neither solver has a part in it, and nothing
is compared with it.

=======  ===================================================================================================
symbol   meaning
=======  ===================================================================================================
q        unknowns: of each body that moves two translations and a turn, of each beam a turn for each bar
a        arm: a bar, or from a body's first point to another, as drawn; turned by R(q), its own unknown
c, l     of a number that is a sum of arms: its constant, and its derivatives by translations
g, h     of the same: the shares of cos q and sin q, so that it is c + l·q + g·cos q + h·sin q
K        springs' stiffness, over all q
λ        values of loads and drives, in the scene's units
A, μ     derivatives of what joints, guides and drives hold, and the forces in them
=======  ===================================================================================================

Equilibrium is K q − λ·∂(work) + Aᵀμ = 0.  A turn is counted from the shape as drawn, which is free of stress.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cprbm_scene import Beam, Drive, FreeEnd, Load, Scene
from cprbm_scene.curve_records import shape_of
from cprbm_scene.curves import unit_vector as unit
from cprbm_scene.statement import (
    BeamForce,
    BeamMoment,
    DisplacementDrive,
    DistributedLoad,
    Force,
    Moment,
    RotationDrive,
    SlidingBody,
    TurningBody,
)

Array = NDArray[np.float64]
BARS = 10  # of a beam
_ITERATIONS = 15
_CLOSE = 1e-8
_FARTHEST = 0.5  # rad, in one step
_STIFF = 20.0  # of a barrier's springs, in those of the beams
_SOFTEST = 1e-6  # of the stiffest spring


@dataclass(frozen=True, slots=True)
class Sums:
    """Numbers (m,) that are c + l·q + g·cos q + h·sin q; ``c`` (m,), the others (m, unknowns)."""

    c: Array
    l: Array  # noqa: E741 - the symbol
    g: Array
    h: Array

    def at(self, q: Array) -> Array:
        """Their values (m,)."""
        return np.asarray(self.c + self.l @ q + self.g @ np.cos(q) + self.h @ np.sin(q))

    def slopes(self, q: Array) -> Array:
        """Their derivatives (m, unknowns)."""
        return np.asarray(self.l - self.g * np.sin(q) + self.h * np.cos(q))

    def bends(self, q: Array) -> Array:
        """Their second derivatives, which are diagonal, (m, unknowns)."""
        return np.asarray(-self.g * np.cos(q) - self.h * np.sin(q))

    def along(self, e: Array) -> Sums:
        """Of pairs of coordinates (2,) the part along a direction, (1,)."""
        return Sums(e @ self.c[None].T, e[None] @ self.l, e[None] @ self.g, e[None] @ self.h)

    def minus(self, other: Sums) -> Sums:
        """The differences."""
        return Sums(self.c - other.c, self.l - other.l, self.g - other.g, self.h - other.h)


def _stacked(parts: list[Sums], unknowns: int) -> Sums:
    if not parts:
        none = np.zeros((0, unknowns))
        return Sums(np.zeros(0), none, none, none)
    return Sums(
        np.concatenate([part.c for part in parts]),
        *(np.vstack([getattr(part, name) for part in parts]) for name in "lgh"),
    )


class Estimate:
    """A scene's mechanism as chains; ``places`` are the nodes (bars + 1) of each beam as :class:`Sums` of pairs."""

    def __init__(self, scene: Scene) -> None:
        self.scene = scene
        self.turns: dict[str, slice] = {}
        self.bodies: dict[str, int] = {}
        n = 0
        for name, body in scene.bodies.items():
            if body.motion != "fixed":
                self.bodies[name] = n
                n += 3
        for name in scene.beams:
            self.turns[name] = slice(n, n + BARS)
            n += BARS
        self.unknowns = n
        self.lengths = {name: shape_of(beam.curve).length for name, beam in scene.beams.items()}
        self.nodes: dict[str, list[Sums]] = {name: self._nodes(name) for name in scene.beams}
        self.lines = {name: _stacked(nodes, n) for name, nodes in self.nodes.items()}
        self.stiffness = self._springs()
        self.held = _stacked(self._joints(), n)
        self.size = max(self.lengths.values())

    def point(self, name: str) -> Sums:
        """A body's point as a pair of sums."""
        body = self.scene.body_of(name)
        place = np.array(self.scene.place_of(name))
        if body not in self.bodies:
            none = np.zeros((2, self.unknowns))
            return Sums(place, none, none, none)
        i = self.bodies[body]
        pole = np.array(next(iter(self.scene.bodies[body].points.values())))
        l, g, h = np.zeros((3, 2, self.unknowns))  # noqa: E741
        l[0, i] = l[1, i + 1] = 1.0
        arm = place - pole
        g[:, i + 2], h[:, i + 2] = arm, (-arm[1], arm[0])
        return Sums(pole, l, g, h)

    def shape(self, q: Array, beam: str) -> Array:
        """Nodes (bars + 1, 2) of a beam, m."""
        return self.lines[beam].at(q).reshape(-1, 2)

    def pushed(self, q: Array, barrier: Barrier) -> Array:
        """Forces (bars + 1, 2) of a barrier on the nodes of its beam."""
        p = self.lines[barrier.beam].at(q).reshape(-1, 2)
        d, rises = _distances(self, p, barrier)
        k = _STIFF * float(np.abs(self.stiffness).max()) / self.size**2
        return np.asarray(-k * np.minimum(d - barrier.apart, 0.0)[:, None] * rises.T)

    def softness(self, q: Array, name: str) -> float:
        """By how much what ``name`` does can yield to it at once, of what it would without joints.

        Nothing where a load only pulls or presses what is straight, or a drive would have to shorten it: what follows
        then is a bifurcation.
        """
        acting = self.scene.loads.get(name) or self.scene.drives[name]
        others = [drive for each, drive in self.scene.drives.items() if each != name]
        scale = np.ones(self.unknowns)
        scale[[j for i in self.bodies.values() for j in (i, i + 1)]] = self.size
        A = np.vstack([self.held.slopes(q), *(self.acted(drive).slopes(q) for drive in others)]) * scale
        g = self.acted(acting).slopes(q)[0] * scale
        _, values, motions = np.linalg.svd(A)
        free = motions[int(np.count_nonzero(values > 1e-9 * values[0])) :] if len(values) else motions
        return float(np.linalg.norm(free @ g) / max(float(np.linalg.norm(g)), 1e-300))

    def largest_turn(self, q: Array) -> float:
        """The largest turn of a bar or a body, rad."""
        bars = max(float(np.abs(q[part]).max()) for part in self.turns.values())
        return max([bars, *(abs(float(q[i + 2])) for i in self.bodies.values())])

    def _nodes(self, name: str) -> list[Sums]:
        beam = self.scene.beams[name]
        p = shape_of(beam.curve).point(np.linspace(0.0, 1.0, BARS + 1))
        backwards = isinstance(beam.start, FreeEnd)
        held = beam.end if backwards else beam.start
        assert not isinstance(held, FreeEnd)
        place = self.point(held.point)
        order = range(BARS - 1, -1, -1) if backwards else range(BARS)
        found = [place]
        for i in order:
            arm = p[i] - p[i + 1] if backwards else p[i + 1] - p[i]
            j = self.turns[name].start + i
            g, h = place.g.copy(), place.h.copy()
            g[:, j] += arm
            h[:, j] += (-arm[1], arm[0])
            place = Sums(place.c, place.l, g, h)
            found.append(place)
        return found[::-1] if backwards else found

    def _springs(self) -> Array:
        K = np.zeros((self.unknowns, self.unknowns))

        def spring(k: float, i: int, j: int | None) -> None:
            K[i, i] += k
            if j is not None:
                K[j, j] += k
                K[i, j] -= k
                K[j, i] -= k

        for name, beam in self.scene.beams.items():
            rigidity = rigidity_of(self.scene, beam, np.linspace(0.0, 1.0, BARS + 1))
            bar, first = self.lengths[name] / BARS, self.turns[name].start
            for i in range(1, BARS):
                spring(float(rigidity[i]) / bar, first + i, first + i - 1)
            for end, i, k in ((beam.start, first, rigidity[0]), (beam.end, first + BARS - 1, rigidity[-1])):
                if end.joint == "weld":
                    body = self.bodies.get(self.scene.body_of(end.point))
                    spring(2.0 * float(k) / bar, i, None if body is None else body + 2)
        return K

    def _joints(self) -> list[Sums]:
        scene, rows = self.scene, list[Sums]()
        for name, beam in scene.beams.items():
            if not isinstance(beam.start, FreeEnd) and not isinstance(beam.end, FreeEnd):
                rows.append(self.nodes[name][-1].minus(self.point(beam.end.point)))
        for pin in scene.pins.values():
            rows.append(self.point(pin.points[0]).minus(self.point(pin.points[1])))
        for name, body in scene.bodies.items():
            if isinstance(body, TurningBody):
                place = self.point(body.about)
                rows.append(Sums(place.c - np.array(body.points[body.about]), place.l, place.g, place.h))
            elif isinstance(body, SlidingBody):
                e = unit(body.along)
                point = body.pin or next(iter(body.points))
                place = self.point(point)
                across = place.along(np.array([-e[1], e[0]]))
                rows.append(Sums(across.c - across.at(np.zeros(self.unknowns)), across.l, across.g, across.h))
                if body.pin is None:
                    rows.append(self._turn(self.bodies[name] + 2))
        return rows

    def _turn(self, i: int) -> Sums:
        l = np.zeros((1, self.unknowns))  # noqa: E741
        l[0, i] = 1.0
        none = np.zeros((1, self.unknowns))
        return Sums(np.zeros(1), l, none, none)

    def acted(self, acting: Load | Drive) -> Sums:
        """What a load of one does work in, or what a drive prescribes, (1,)."""
        match acting:
            case Moment() | RotationDrive():
                return self._turn(self.bodies[acting.body] + 2)
            case Force() | DisplacementDrive():
                moved = self.point(acting.point).along(unit(acting.direction))
                return Sums(moved.c - moved.at(np.zeros(self.unknowns)), moved.l, moved.g, moved.h)
            case BeamForce():
                return self.nodes[acting.beam][round(acting.at * BARS)].along(unit(acting.direction))
            case BeamMoment():
                return self._turn(self.turns[acting.beam].start + min(int(acting.at * BARS), BARS - 1))
            case DistributedLoad():
                e, (low, high) = unit(acting.direction), acting.along
                inside = [i for i in range(BARS + 1) if low * BARS - 0.5 <= i <= high * BARS + 0.5]
                share = (high - low) * self.lengths[acting.beam] / len(inside)
                parts = [self.nodes[acting.beam][i].along(share * e) for i in inside]
                whole = _stacked(parts, self.unknowns)
                return Sums(*(getattr(whole, name).sum(axis=0, keepdims=True) for name in "clgh"))


def rigidity_of(scene: Scene, beam: Beam, u: Array) -> Array:
    """E w t³/12 (n,) at fractions ``u`` (n,) of a beam's length, N·m²."""
    E = scene.materials[beam.material].youngs_modulus
    return np.asarray(E * beam.width_at(u) * beam.thickness_at(u) ** 3 / 12.0)


@dataclass(frozen=True, slots=True)
class Barrier:
    """What keeps the nodes of a ``beam`` at least ``apart`` (m) away: its signed ``distance`` from places (k, 2), m."""

    beam: str
    distance: Callable[[Array], Array]
    apart: float


@dataclass(frozen=True, slots=True)
class State:
    """Unknowns ``q`` at ``values`` of loads and drives; ``stable`` where they are a minimum of the energy."""

    q: Array
    values: Mapping[str, float]


def followed(
    model: Estimate, state: State, acting: str, growing: Iterator[float], barriers: Sequence[Barrier] = ()
) -> Iterator[State]:
    """The states along values of one load or drive, as long as they are stable and near each other."""
    scene = model.scene
    loads = {name: model.acted(load) for name, load in scene.loads.items()}
    drives = {name: model.acted(drive) for name, drive in scene.drives.items()}
    held = _stacked([model.held, *drives.values()], model.unknowns)
    q, values = state.q, dict(state.values)
    for value in growing:
        before = values.get(acting, 0.0)
        share, step = 0.0, 1.0
        while share < 1.0:
            target = min(1.0, share + step)
            values[acting] = before + target * (value - before)
            found = _equilibrium(model, q, values, loads, held, list(drives), barriers)
            if found is None or np.abs(found - q).max() > _FARTHEST * max(1.0, model.size):
                step *= 0.5
                if step < 0.05:
                    return
                continue
            q, share = found, target
        yield State(q, dict(values))


def _equilibrium(
    model: Estimate,
    q: Array,
    values: Mapping[str, float],
    loads: Mapping[str, Sums],
    held: Sums,
    drives: list[str],
    barriers: Sequence[Barrier],
) -> Array | None:
    """The equilibrium near ``q`` if it is found and stable."""
    K, n, m = model.stiffness, model.unknowns, held.c.size
    prescribed = np.zeros(m)
    prescribed[m - len(drives) :] = [values.get(name, 0.0) for name in drives]
    mu = np.zeros(m)
    force = max(float(np.abs(K).max()), 1e-300)
    matrix, right = np.zeros((n + m, n + m)), np.empty(n + m)
    for _ in range(_ITERATIONS):
        A, c = held.slopes(q), held.at(q) - prescribed
        diagonal = mu @ held.bends(q)
        gradient = K @ q
        for name, work in loads.items():
            gradient = gradient - values.get(name, 0.0) * work.slopes(q)[0]
            diagonal = diagonal - values.get(name, 0.0) * work.bends(q)[0]
        H = K + np.diag(diagonal)
        for barrier in barriers:
            pushed, stiffer = _held_off(model, q, barrier)
            gradient, H = gradient + pushed, H + stiffer
        # all rows in one unit: lengths over the size, and forces over the stiffest spring
        matrix[:n, :n], matrix[:n, n:], matrix[n:, :n] = H / force, A.T / model.size, A / model.size
        right[:n], right[n:] = gradient / force, c / model.size
        try:
            step = np.linalg.solve(matrix, -right)
        except np.linalg.LinAlgError:
            return None
        dq = step[:n]
        if not np.abs(dq).max() < 3.0:
            return None
        q, mu = q + dq, step[n:] * force / model.size
        if np.abs(dq).max() < _CLOSE:
            return q if _stable(H / force, A / model.size) else None
    return None


def _held_off(model: Estimate, q: Array, barrier: Barrier) -> tuple[Array, Array]:
    """Derivatives (unknowns,) and (unknowns, unknowns) of a barrier's energy: springs at nodes that are too near."""
    nodes = model.lines[barrier.beam]
    d, rises = _distances(model, nodes.at(q).reshape(-1, 2), barrier)
    gap = np.minimum(d - barrier.apart, 0.0)
    near = np.flatnonzero(gap < 0.0)
    if not near.size:
        return np.zeros(model.unknowns), np.zeros((model.unknowns, model.unknowns))
    J = nodes.slopes(q).reshape(-1, 2, model.unknowns)[near]
    rows = np.einsum("ik,kij->kj", rises[:, near], J)
    k = _STIFF * float(np.abs(model.stiffness).max()) / model.size**2
    return k * gap[near] @ rows, k * rows.T @ rows


def _distances(model: Estimate, p: Array, barrier: Barrier) -> tuple[Array, Array]:
    """A barrier's distance from places (k, 2), (k,), and its derivatives (2, k)."""
    step = 1e-6 * model.size
    # all that is asked of the distance at once: it is the dearest part of an estimate
    beside = step * np.array([[0.0, 0.0], [1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0]])
    d = barrier.distance((p + beside[:, None]).reshape(-1, 2)).reshape(5, -1)
    return d[0], (d[1::2] - d[2::2]) / (2.0 * step)


def _stable(H: Array, A: Array) -> bool:
    """Whether H is positive on what A leaves free."""
    if A.shape[0]:
        _, values, motions = np.linalg.svd(A)
        free = motions[int(np.count_nonzero(values > 1e-9 * values[0])) :]
        if not len(free):
            return True
        H = free @ H @ free.T
    return bool(np.linalg.eigvalsh(H)[0] > _SOFTEST)

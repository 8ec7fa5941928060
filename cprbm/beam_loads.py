"""Dead loads on beams: forces at places and distributed ones, by their work on the smooth line through the chain.

==========  ==================================================================================
s_g, f_g    places of a load, arc length, and its force there per unit (SI) of its value
C(s)        the smooth line, :mod:`cprbm.smooth`; C⁰ at rest
W           Σ f_g·(C(s_g) − C⁰(s_g)), work per unit of the value
p_i         joint i, on whose link a place lies; θ_i
==========  ==================================================================================

A distributed load is summed by Gauss's rule between joints and borders, where C is smooth.  C(s) depends on p_i and on
θ_{i−1}, θ_i, θ_{i+1} through the turning of one element only: W is as a sum of forces at joints, whose work
:mod:`cprbm.kinematics` knows, and a part with tridiagonal second derivatives over θ.

The turning of an element is the mean of the true one.  What its evenness leaves out of C at a force is of third order
in the element's length, wherever in it that acts: energy and shape keep their second order.  Beside a held end it is a
part of what the force does there, so that the span between has elements enough (:mod:`cprbm.refining`).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cprbm import smooth
from cprbm.kinematics import Positions, State
from cprbm.model import Chain, Model
from cprbm.moving import moving, position_curvature, position_slopes
from cprbm_scene import Scene
from cprbm_scene.answer import Array
from cprbm_scene.statement import BeamForce, BeamMoment, DistributedLoad

ABSCISSAE, WEIGHTS = np.polynomial.legendre.leggauss(3)


@dataclass(frozen=True, slots=True)
class BeamLoad:
    """A load on one beam, in numbers without units, per unit (SI) of the scene's load value.

    Attributes:
        chain: number of the beam's chain.
        s: places (k,); forces: there (k, 2); rest: C⁰ there (k, 2).
        ends: arc lengths between which it is distributed, the same twice for a force at a place.
        density: force at the place, or per length (2,).
    """

    chain: int
    s: Array
    forces: Array
    rest: Array
    ends: tuple[float, float]
    density: Array

    @property
    def distributed(self) -> bool:
        """Whether it is."""
        return self.ends[0] < self.ends[1]


@dataclass(frozen=True, slots=True)
class MomentOnBeam:
    """A moment on one beam, in numbers without units, per unit (SI) of the scene's load value.

    Its work is what the smooth line turns by at its place, between the borders of an element as even as the beam does,
    and what the jump of the curvature turns the place by besides: a constant, since the element's mean has no share.

    Attributes:
        chain: number of the beam's chain.
        s: its place; links: the two that turn with it, in the shared numbering, by the ``weights`` (2,): 1 − f and f.
        moment: of value one, in units of S; bends: h/(E·I) of the element.
    """

    chain: int
    s: float
    links: tuple[int, int]
    weights: Array
    moment: float
    bends: float

    def work(self, value: float, turned: Array) -> float:
        """W at links ``turned`` (n_links,) from rest, under a ``value`` (SI)."""
        M = value * self.moment
        return float(M * (self.weights @ turned[list(self.links)]) + 0.5 * M**2 * self._give(self))

    def shared_work(self, value: float, other: MomentOnBeam, its_value: float) -> float:
        """What it does as another in the same element turns its place, under their values (SI); else nothing."""
        if other.links != self.links:
            return 0.0
        return value * self.moment * its_value * other.moment * self._give(other)

    def _give(self, other: MomentOnBeam) -> float:
        """f(1 − f') h/(E·I), f ≤ f': by what a moment of one at either place turns the other beyond the links."""
        before, beyond = (min(self.weights[1], other.weights[1]), min(self.weights[0], other.weights[0]))
        return float(before * beyond * 0.5 * (self.bends + other.bends))


@dataclass(frozen=True, slots=True)
class BeamWork:
    """W and what it is by: forces on joints fx, fy (n_joints,), and beside them over θ.

    ``gradient``, ``diagonal`` (n_links,) and ``off`` (n_links−1,), of the second derivatives.
    """

    value: float
    fx: Array
    fy: Array
    gradient: Array
    diagonal: Array
    off: Array


def beam_loads(scene: Scene, model: Model) -> dict[str, BeamLoad]:
    """The scene's loads on beams by name."""
    return {
        name: _beam_load(model, load)
        for name, load in scene.loads.items()
        if isinstance(load, BeamForce | DistributedLoad)
    }


def beam_moments(scene: Scene, model: Model) -> dict[str, MomentOnBeam]:
    """The scene's moments on beams by name."""
    return {name: _moment(model, load) for name, load in scene.loads.items() if isinstance(load, BeamMoment)}


def _moment(model: Model, load: BeamMoment) -> MomentOnBeam:
    number = [chain.name for chain in model.chains].index(load.beam)
    chain = model.chains[number]
    s = load.at * float(chain.s[-1])
    e = int(np.clip(np.searchsorted(chain.borders, s) - 1, 0, chain.n - 1))
    h = float(chain.sizes[e])
    part = min(max((s - float(chain.borders[e])) / h, 0.0), 1.0)
    bends = h / float(chain.section.rigidity_at(np.array([s]))[0])
    links = (chain.first_link + e, chain.first_link + e + 1)
    return MomentOnBeam(number, s, links, np.array([1.0 - part, part]), 1.0 / model.unit_moment, bends)


def _beam_load(model: Model, load: BeamForce | DistributedLoad) -> BeamLoad:
    number = [chain.name for chain in model.chains].index(load.beam)
    chain, length = model.chains[number], model.chains[number].s[-1]
    along = np.array(load.direction) / np.hypot(*load.direction) / model.unit_force
    if isinstance(load, BeamForce):
        begin = end = load.at * float(length)
        s, shares, density = np.array([begin]), np.ones(1), along
    else:
        begin, end = (share * float(length) for share in load.along)
        s, shares = _spread(chain, begin, end)
        density = along * model.unit_length
    x, y = chain.line.position(s * model.unit_length)
    rest = np.stack((x, y), axis=1) / model.unit_length
    return BeamLoad(number, s, shares[:, None] * density, rest, (begin, end), density)


def _spread(chain: Chain, begin: float, end: float) -> tuple[Array, Array]:
    """Gauss's places (k,) between two arc lengths and the lengths that they stand for (k,)."""
    ends = np.unique(np.clip(np.concatenate((chain.s, chain.borders, [begin, end])), begin, end))
    half = 0.5 * np.diff(ends)[:, None]
    return (0.5 * (ends[1:] + ends[:-1])[:, None] + half * ABSCISSAE).ravel(), (half * WEIGHTS).ravel()


def beam_work(model: Model, load: BeamLoad, state: State, at: Positions) -> BeamWork:
    """W at a state."""
    chain = model.chains[load.chain]
    points = smooth.smooth_line(chain, model.unit_length, state, at).at(load.s)
    joints = chain.first_joint + points.link
    on_joints = np.zeros((model.n_joints, 2))
    np.add.at(on_joints, joints, load.forces)
    # by the angles of the link before, of the link itself and of the one behind; what is beyond an end has no share
    z = moving(points)
    slopes = position_slopes(z, load.forces)[:, 2:]
    second = position_curvature(z, load.forces)[:, 2:, 2:]
    links = chain.first_link + points.link[:, None] + np.arange(-1, 2)
    gradient, diagonal = np.zeros(model.n_links + 2), np.zeros(model.n_links + 2)
    off = np.zeros(model.n_links + 1)
    np.add.at(gradient, links + 1, slopes)
    np.add.at(diagonal, links + 1, second[:, range(3), range(3)])
    np.add.at(off, links[:, :2] + 1, second[:, range(2), range(1, 3)])
    moved = np.stack((points.x, points.y), axis=1) - load.rest
    fx, fy = on_joints[:, 0], on_joints[:, 1]
    return BeamWork(float(np.sum(load.forces * moved)), fx, fy, gradient[1:-1], diagonal[1:-1], off[1:-1])


def spread_from(load: BeamLoad, s: Array) -> Array:
    """Length (k,) of a distributed load that lies beyond arc lengths ``s`` (k,)."""
    begin, end = load.ends
    return np.asarray(end - np.clip(s, begin, end))


def kinks(model: Model, load: BeamLoad, state: State, at: Positions) -> tuple[Array, Array]:
    """Where the bending moment has a kink or a bend by a load of value one: places (k,) and jumps (k,).

    Of dM/ds at a force, of d²M/ds² at both ends of a distributed load: its part along the left normal there.
    """
    chain = model.chains[load.chain]
    places = np.array(load.ends if load.distributed else load.ends[:1])
    psi = smooth.smooth_line(chain, model.unit_length, state, at).at(places).psi
    across = load.density[1] * np.cos(psi) - load.density[0] * np.sin(psi)
    return places, across * ((1.0, -1.0) if load.distributed else 1.0)

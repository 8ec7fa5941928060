"""Potential energy of springs and dead loads, eqs. (4)-(5), with exact derivatives.

======  ========================================================================
δ_i     (θ_i − θ_{i−1}) − (θ_i⁰ − θ_{i−1}⁰), change of angle at spring i
m_i     k_i δ_i, moment of spring i
W       work of the dead loads from the initial state
======  ========================================================================

PE = Σ ½ k_i δ_i² − W; the Hessian over θ is tridiagonal, also that of W, which loads on bodies leave linear in θ.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from cprbm.beam_loads import BeamLoad, MomentOnBeam, beam_loads, beam_moments, beam_work
from cprbm.kinematics import Positions, State, pulled_back
from cprbm.model import Model
from cprbm_scene import Scene
from cprbm_scene.answer import Array
from cprbm_scene.statement import Force, Moment


@dataclass(frozen=True, slots=True)
class DeadLoad:
    """A load on a free body, in numbers without units, per unit (SI) of the scene's load value."""

    body: int
    moment: float
    force: tuple[float, float]
    point: tuple[float, float]


@dataclass(frozen=True, slots=True)
class EndMoment:
    """A moment on a beam's last link, in units of S per N·m."""

    link: int
    moment: float


AnyLoad = DeadLoad | EndMoment | BeamLoad | MomentOnBeam


def dead_loads(scene: Scene, model: Model) -> dict[str, DeadLoad | BeamLoad | MomentOnBeam]:
    """The scene's loads by name."""
    loads: dict[str, DeadLoad | BeamLoad | MomentOnBeam] = {**beam_loads(scene, model), **beam_moments(scene, model)}
    for name, load in scene.loads.items():
        if isinstance(load, Moment):
            body = model.free_bodies.index(load.body)
            loads[name] = DeadLoad(body, 1.0 / model.unit_moment, (0.0, 0.0), (0.0, 0.0))
        elif isinstance(load, Force):
            owner = scene.body_of(load.point)
            body = model.free_bodies.index(owner)
            size = float(np.hypot(*load.direction)) * model.unit_force
            x, y = scene.bodies[owner].points[load.point]
            ox, oy = model.references[body].tolist()
            r = (x / model.unit_length - ox, y / model.unit_length - oy)
            loads[name] = DeadLoad(body, 0.0, (load.direction[0] / size, load.direction[1] / size), r)
    return loads


def moment_on(beam: str) -> str:
    """Name of the value of the moment on a beam's end while it is assembled, N·m."""
    return f"{beam}.end"  # no name in a scene holds a dot


def end_moments(scene: Scene, model: Model) -> dict[str, EndMoment]:
    """Those on the ends of the beams that are assembled."""
    assembly = scene.assembly
    return {
        moment_on(chain.name): EndMoment(chain.first_link + chain.n, 1.0 / model.unit_moment)
        for chain in model.chains
        if assembly is not None and chain.name in assembly.moments
    }


def spring_moments(model: Model, state: State) -> Array:
    """m_i of every spring in the shared numbering (n_links−1,), zero between beams."""
    return model.couplings * turns(model, state)


def turns(model: Model, state: State) -> Array:
    """δ_i (n_links−1,)."""
    delta = state.theta[1:] - state.theta[:-1]
    delta -= model.rest_turns
    return delta


def strain_energy(model: Model, state: State) -> float:
    """Σ ½ k_i δ_i²."""
    delta = turns(model, state)
    return float(0.5 * (model.couplings @ (delta * delta)))


def strain_gradient(moments: Array) -> Array:
    """∂/∂θ of the strain energy (n_links,), from the springs' ``moments`` (n_links−1,)."""
    gradient = np.zeros(len(moments) + 1)
    gradient[1:] = moments
    gradient[:-1] -= moments
    return gradient


def strain_hessian(model: Model) -> tuple[Array, Array]:
    """Diagonal (n_links,) and off-diagonal (n_links−1,) of the strain energy's Hessian, both the model's own."""
    return model.stiffness


@dataclass(frozen=True, slots=True)
class LoadWork:
    """W and its derivatives.

    Attributes:
        value, gradient: W, and over all unknowns (n_links + 3B,).
        second: second derivatives over φ of the bodies (B,).
        diagonal, off: the same over θ, (n_links,) and (n_links−1,).
        fx, fy: what of the loads on beams is forces on joints (n_joints,), all of their resultants.
        on_beams: forces on beams that act, with their values (SI); moments: likewise.
    """

    value: float
    gradient: Array
    second: Array
    diagonal: Array
    off: Array
    fx: Array
    fy: Array
    on_beams: tuple[tuple[BeamLoad, float], ...]
    moments: tuple[tuple[MomentOnBeam, float], ...]

    def curved_as(self, other: LoadWork) -> bool:
        """Whether the second derivatives are those of another work at the same state."""
        return (
            np.array_equal(self.second, other.second)
            and np.array_equal(self.diagonal, other.diagonal)
            and np.array_equal(self.off, other.off)
        )


def load_work(
    model: Model, loads: Mapping[str, AnyLoad], values: dict[str, float], state: State, at: Positions
) -> LoadWork:
    """Work of all loads at their present ``values`` (SI)."""
    total, B = 0.0, model.n_bodies
    linear: Array | None = None  # the work of loads on bodies over their posture
    gradient = np.zeros(model.n_unknowns)
    diagonal, off, on_x = model.nothing
    on_y = on_x
    on_beams: list[tuple[BeamLoad, float]] = []
    moments: list[tuple[MomentOnBeam, float]] = []
    for name, load in loads.items():
        value = values.get(name, 0.0)
        if isinstance(load, DeadLoad):
            b, (fx, fy), (px, py) = load.body, load.force, load.point
            linear = np.zeros(5 * B) if linear is None else linear
            linear[3 * b] += value * fx
            linear[3 * b + 1] += value * fy
            linear[3 * b + 2] += value * load.moment
            linear[3 * B + b] += value * (fx * px + fy * py)
            linear[4 * B + b] += value * (fy * px - fx * py)
        elif isinstance(load, BeamLoad):
            if value == 0.0:
                continue
            work = beam_work(model, load, state, at)
            total += value * work.value
            gradient[: model.n_links] += value * work.gradient
            diagonal = diagonal + value * work.diagonal
            off = off + value * work.off
            on_x = on_x + value * work.fx
            on_y = on_y + value * work.fy
            on_beams.append((load, value))
        elif isinstance(load, EndMoment):
            total += value * load.moment * float(state.theta[load.link] - model.rest[load.link])
            gradient[load.link] += value * load.moment
        else:
            total += load.work(value, state.theta - model.rest)
            for other, its_value in moments:
                total += load.shared_work(value, other, its_value)
            gradient[list(load.links)] += value * load.moment * load.weights
            moments.append((load, value))
    second = np.zeros(B)
    if linear is not None:
        total += float(linear @ state.posture.w)
        over_posture = linear @ state.posture.derivatives
        gradient[model.n_links :], second = over_posture[: 3 * B], over_posture[3 * B :]
    if on_beams:
        over_theta, bodies, twice, twice_bodies = pulled_back(model, state, at, on_x, on_y)
        gradient += np.concatenate((over_theta, bodies))
        diagonal += twice
        second += twice_bodies
    return LoadWork(total, gradient, second, diagonal, off, on_x, on_y, tuple(on_beams), tuple(moments))

"""The numbers a scene asks for, read off a state; meanings in :mod:`scene.answer`."""

from __future__ import annotations

import numpy as np
from frozendict import frozendict

from exact.gaps import SAMPLES
from exact.model import Model
from exact.spectral import rule
from exact.state import State
from exact.structure import Meeting, Wrap
from scene import Certificate, CircleContact, Probe, Scene, Shape, StationAnswer
from scene.answer import Array, frozen_array
from scene.statement import DisplacementDrive, Force

_HOLDS = 1e-9  # largest residual with more Gauss points, no dimension


def answered(
    model: Model,
    state: State,
    stage: str,
    value: float,
    closed_at: dict[str, float],
    iterations: int,
    finer: float,
) -> StationAnswer:
    """A station's answer; ``finer`` is the largest row with more Gauss points."""
    scene = model.scene
    failures = () if finer <= _HOLDS else (f"the equations hold to {finer:.1e} only with more Gauss points",)
    balance = [float(np.max(np.abs(act[:, 0]))) for body, act in state.found.on_body.items() if body in model.moving]
    certificate = Certificate(
        residual=max(finer, state.residual),
        residual_floor=1e-13,
        violation=state.residual,
        penetration=0.0,
        complementarity=0.0,
        force_balance=max(balance, default=0.0),
        moment_balance=max(balance, default=0.0),
        smallest_curvature=float("nan"),
        iterations=iterations,
        failures=failures,
    )
    shapes = {}
    for name, strip in model.strips.items():
        s = np.linspace(0.0, strip.length, SAMPLES)
        x, y = state.along(name, s)[:2] * model.unit_length
        shapes[name] = Shape(frozen_array(s * model.unit_length), frozen_array(x), frozen_array(y))
    return StationAnswer(
        stage=stage,
        value=value,
        values=frozendict(
            {probe.name: frozen_array(_value(scene, model, state, probe, closed_at)).ravel() for probe in scene.probes}
        ),
        shapes=frozendict(shapes),
        touching=frozendict(_touching(model, state)),
        certificate=certificate,
    )


def _value(
    scene: Scene, model: Model, state: State, probe: Probe, closed_at: dict[str, float]
) -> Array | float | list[float]:
    found, touches = state.found, state.structure.touches
    match probe.quantity:
        case "displacement":
            return _displacement(model, state, scene.body_of(probe.of), model.rest(probe.of)) * model.unit_length
        case "rotation":
            return float(found.placements[probe.of][2, 0])
        case "force":
            return float(np.hypot(*found.resultants[probe.of][:, 0])) * model.unit_force if probe.of in touches else 0.0
        case "centre":
            return [_centre(state, probe.of, scene.contacts[probe.of].beams[0]) * model.unit_length] if (
                probe.of in touches
            ) else []  # fmt: skip
        case "ends":
            if probe.of not in touches:
                return []
            return [x * model.unit_length for x in _ends(state, probe.of, scene.contacts[probe.of].beams[0])]
        case "closing_load":
            return [closed_at[probe.of]] if probe.of in touches and probe.of in closed_at else []
        case "bending_stress":
            strip = model.strips[probe.of]
            s = np.linspace(0.0, strip.length, probe.points)
            E = scene.materials[strip.beam.material].youngs_modulus
            change = strip.compliance(s) * state.along(probe.of, s)[3] / model.unit_length
            return np.asarray(0.5 * E * strip.beam.thickness_at(s / strip.length) * change)
        case "reaction" | "reaction_moment":
            force, moment = _reaction(scene, state, probe.of)
            return force * model.unit_force if probe.quantity == "reaction" else moment * model.unit_moment
        case "potential_energy":
            return _energy(model, state) * model.unit_moment


def _displacement(model: Model, state: State, body: str, rest: Array) -> Array:
    u, v, phi = state.found.placements[body][:, 0]
    x, y = rest - model.reference(body)
    less, sin = -2.0 * np.sin(0.5 * phi) ** 2, np.sin(phi)
    return np.array([u + less * x - sin * y, v + sin * x + less * y])


def _centre(state: State, contact: str, beam: str) -> float:
    """Arc length of a contact along its first beam, weighted by the magnitudes of its forces."""
    touch = state.structure.touches[contact]
    begin, end = _ends(state, contact, beam)
    if not isinstance(touch, Wrap):
        return begin
    gauss = rule(state.equations.nodes)
    s = begin + (end - begin) * gauss.points
    pressure, at_begin, at_end = state.pressures(touch, s)
    weights = (end - begin) * gauss.weights * pressure
    return float((weights @ s + at_begin * begin + at_end * end) / (np.sum(weights) + at_begin + at_end))


def _ends(state: State, contact: str, beam: str) -> tuple[float, float]:
    touch = state.structure.touches[contact]
    if isinstance(touch, Wrap):
        a, b = state.found.wraps[contact][:2]
        return float(a[0]), float(b[0])
    if touch.at is not None and touch.beam == beam:
        return touch.at, touch.at
    s = float(state.z[state.equations.layout.places[contact, beam]])
    return s, s


def _touching(model: Model, state: State) -> dict[str, Array]:
    """Places (k, 2), m: between the neutral lines of two beams, on a circle on the line less half a thickness."""
    found = {}
    for name, touch in state.structure.touches.items():
        contact = model.scene.contacts[name]
        begin, end = _ends(state, name, touch.beam)
        s = np.linspace(begin, end, 21) if end > begin else np.array([begin])
        line = state.along(touch.beam, s)[:2]
        if isinstance(contact, CircleContact):
            centre = state.found.centres[name]
            arm = line - centre
            line = centre + arm * (contact.radius / model.unit_length) / np.hypot(*arm)
        else:
            assert isinstance(touch, Meeting)
            sigma = np.array([state.z[state.equations.layout.places[name, touch.onto]]])
            line = 0.5 * (line + state.along(touch.onto, sigma)[:2])
        found[name] = frozen_array(line.T * model.unit_length)
    return found


def _reaction(scene: Scene, state: State, name: str) -> tuple[Array, float]:
    """Force and moment of the ground at a point, or of the drives of that point or body."""
    model, force, moment = state.equations.model, np.zeros(2), 0.0
    for (beam, which), (_, onto, turning) in state.found.ends.items():
        strip = model.strips[beam]
        end = strip.start if which == "start" else strip.end
        if end.point == name and scene.body_of(name) not in model.moving:
            force = force - onto[:, 0]
            moment -= float(turning[0]) if end.welded else 0.0
    for drive, index in state.equations.layout.drives.items():
        record, reaction = scene.drives[drive], float(state.z[index])
        if isinstance(record, DisplacementDrive):
            if record.point == name:
                force = force + reaction * np.array(record.direction) / float(np.hypot(*record.direction))
        elif record.body == name:
            moment += reaction
    return force, moment


def _energy(model: Model, state: State) -> float:
    """∫ m² c/2 ds less the work of the dead loads."""
    energy = 0.0
    for name, pieces in state.found.pieces.items():
        strip = model.strips[name]
        for a, b, _, _, solved in pieces:
            gauss, h = rule(len(solved.theta)), float(b[0] - a[0])
            c = strip.compliance(float(a[0]) + h * gauss.points)
            energy += 0.5 * h * float(gauss.weights @ (c * solved.moment**2))
    for touch in state.structure.touches.values():
        if not isinstance(touch, Wrap):
            continue
        begin, end = state.wrapped(touch)
        gauss = rule(state.equations.nodes)
        s = begin + (end - begin) * gauss.points
        m = state.along(touch.beam, s)[3]
        energy += 0.5 * (end - begin) * float(gauss.weights @ (model.strips[touch.beam].compliance(s) * m**2))
    for name, load in model.scene.loads.items():
        value = state.lam if name == state.equations.stepped else state.equations.others.get(name, 0.0)
        if isinstance(load, Force):
            moved = _displacement(model, state, model.scene.body_of(load.point), model.rest(load.point))
            direction = np.array(load.direction) / float(np.hypot(*load.direction))
            energy -= value * float(moved @ direction)
        else:
            energy -= value * float(state.found.placements[load.body][2, 0])
    return energy

"""Probed quantities of a state, as :mod:`cprbm_scene.answer` defines them."""

import numpy as np

from cprbm_scene import Certificate, CircleContact, Probe, Scene, Shape, StationAnswer
from cprbm_scene.answer import Array, frozen_array
from cprbm_scene.frozendict import frozendict
from cprbm_scene.statement import BeamForce, DisplacementDrive, DistributedLoad, Force, Moment, RotationDrive
from elastica_reference.equations import unit
from elastica_reference.gaps import SAMPLES
from elastica_reference.model import Model
from elastica_reference.restructure import NotCoveredError
from elastica_reference.spectral import rule
from elastica_reference.state import State
from elastica_reference.structure import Meeting, Wrap
from elastica_reference.way import Stepping

_FLOOR = 1e-13  # of a residual, dimensionless: about a hundred roundings


def station_answer(stepping: Stepping, value: float, finer: float) -> StationAnswer:
    """A station's answer; ``finer`` is the largest row with more Gauss points."""
    model, state, scene = stepping.model, stepping.state, stepping.model.scene
    # a guide constrains a slide; the remaining direction is a row of the equations
    free = [body for body, freedoms in model.moving.items() if freedoms == 3]
    unbalanced = max((float(np.max(np.abs(state.evaluation.on_body[body]))) for body in free), default=0.0)
    certificate = Certificate(
        residual=max(finer, state.residual),
        residual_floor=_FLOOR,
        violation=state.residual,
        penetration=0.0,
        complementarity=0.0,
        force_balance=unbalanced,
        moment_balance=unbalanced,
        smallest_curvature=stepping.curvature,
        iterations=stepping.states,
    )
    shapes = {}
    for name, strip in model.strips.items():
        s = np.linspace(0.0, strip.length, SAMPLES)
        x, y = state.along(name, s)[:2] * model.unit_length
        shapes[name] = Shape(frozen_array(s * model.unit_length), frozen_array(x), frozen_array(y))
    return StationAnswer(
        stage=stepping.stage,
        value=value,
        values=frozendict(
            {
                probe.name: frozen_array(
                    _value(scene, model, state, probe, stepping.closed_at) if probe.asked_in(stepping.stage) else []
                ).ravel()
                for probe in scene.probes
            }
        ),
        shapes=frozendict(shapes),
        touching=frozendict(_touching(model, state)),
        certificate=certificate,
    )


def _value(
    scene: Scene, model: Model, state: State, probe: Probe, closed_at: dict[str, float]
) -> Array | float | list[float]:
    evaluation, touches = state.evaluation, state.structure.touches
    match probe.quantity:
        case "displacement":
            return _displacement(model, state, probe.of) * model.unit_length
        case "rotation":
            return float(evaluation.placements[probe.of][2, 0])
        case "force":
            return (
                float(np.hypot(*evaluation.resultants[probe.of][:, 0])) * model.unit_force
                if probe.of in touches
                else 0.0
            )
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
        case "combined_stress":
            strip = model.strips[probe.of]
            s = np.linspace(0.0, strip.length, probe.points)
            beam, E = strip.beam, scene.materials[strip.beam.material].youngs_modulus
            _, _, theta, m, Fx, Fy = state.along(probe.of, s)
            t, b = (size(s / strip.length) for size in (beam.thickness_at, beam.width_at))
            bent = 0.5 * E * t * strip.compliance(s) * m / model.unit_length
            normal = (Fx * np.cos(theta) + Fy * np.sin(theta)) * model.unit_force
            return np.asarray(np.abs(bent) + np.abs(normal) / (t * b))
        case "reaction" | "reaction_moment":
            force, moment = _reaction(scene, state, probe.of)
            return force * model.unit_force if probe.quantity == "reaction" else moment * model.unit_moment
        case "potential_energy":
            return _energy(model, state) * model.unit_moment
        case "angle" | "moment":
            raise NotCoveredError("the exact solution has no equations for stops")


def _displacement(model: Model, state: State, point: str) -> Array:
    rest = model.rest(point)
    return np.asarray(state.evaluation.moved(model.scene.body_of(point), rest)[:, 0] - rest)


def _centre(state: State, contact: str, beam: str) -> float:
    """Centre of pressure of a contact, as arc length along its first beam."""
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
        return state.wrap_range(touch)
    if touch.at is not None and touch.beam == beam:
        return touch.at, touch.at
    s = float(state.z[state.equations.layout.places[contact, beam]])
    return s, s


def _touching(model: Model, state: State) -> dict[str, Array]:
    """Places (k, 2), m: midway between the neutral lines of two beams, or on the circle."""
    places = {}
    for name, touch in state.structure.touches.items():
        contact = model.scene.contacts[name]
        begin, end = _ends(state, name, touch.beam)
        s = np.linspace(begin, end, 21) if end > begin else np.array([begin])
        line = state.along(touch.beam, s)[:2]
        if isinstance(contact, CircleContact):
            centre = state.evaluation.centres[name]
            arm = line - centre
            line = centre + arm * (contact.radius / model.unit_length) / np.hypot(*arm)
        else:
            assert isinstance(touch, Meeting)
            sigma = np.array([state.z[state.equations.layout.places[name, touch.onto]]])
            line = 0.5 * (line + state.along(touch.onto, sigma)[:2])
        places[name] = frozen_array(line.T * model.unit_length)
    return places


def _reaction(scene: Scene, state: State, name: str) -> tuple[Array, float]:
    """Reaction force and moment at a fixed point, or of the drives of a point or body."""
    model, force, moment = state.equations.model, np.zeros(2), 0.0
    for (beam, which), action in state.evaluation.ends.items():
        strip = model.strips[beam]
        end = strip.start if which == "start" else strip.end
        if end.point == name and scene.body_of(name) not in model.moving:
            force = force - action.force[:, 0]
            moment -= float(action.moment[0]) if end.welded else 0.0
    for drive, index in state.equations.layout.drives.items():
        record, reaction = scene.drives[drive], float(state.z[index])
        if isinstance(record, DisplacementDrive) and record.point == name:
            force = force + reaction * unit(record.direction)
        elif isinstance(record, RotationDrive) and record.body == name:
            moment += reaction
    return force, moment


def _energy(model: Model, state: State) -> float:
    """∫ m² c/2 ds minus the work of dead loads."""
    energy, gauss = 0.0, rule(state.equations.nodes)
    for beam, parts in state.evaluation.parts.items():
        spans = [(float(part.a[0]), float(part.b[0])) for part in parts]
        spans += [state.wrap_range(wrap) for wrap in state.structure.wraps(beam)]
        for a, b in spans:
            s = a + (b - a) * gauss.points
            m = state.along(beam, s)[3]
            energy += 0.5 * (b - a) * float(gauss.weights @ (model.strips[beam].compliance(s) * m**2))
    for name, load in model.scene.loads.items():
        value = state.lam if name == state.equations.stepped else state.equations.others.get(name, 0.0)
        if isinstance(load, BeamForce):
            s = np.array([load.at * model.strips[load.beam].length])
            moved = state.along(load.beam, s)[:2] - model.strips[load.beam].line.place(s)
            energy -= value * float(unit(load.direction) @ moved[:, 0])
        elif isinstance(load, DistributedLoad):
            strip = model.strips[load.beam]
            begin, stop = (share * strip.length for share in load.along)
            for part in state.evaluation.parts[load.beam]:
                a, b = float(part.a[0]), float(part.b[0])
                if begin < 0.5 * (a + b) < stop:
                    s = a + (b - a) * gauss.points
                    moved = unit(load.direction) @ (state.along(load.beam, s)[:2] - strip.line.place(s))
                    energy -= value * (b - a) * float(gauss.weights @ moved)
        elif isinstance(load, Force):
            energy -= value * float(_displacement(model, state, load.point) @ unit(load.direction))
        elif isinstance(load, Moment):
            energy -= value * float(state.evaluation.placements[load.body][2, 0])
    return energy

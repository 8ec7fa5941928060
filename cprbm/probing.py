"""The numbers a scene asks for, read off a state; meanings in :mod:`cprbm_scene.answer`."""

from __future__ import annotations

import numpy as np

from cprbm import smooth
from cprbm.edge import Edge
from cprbm.forces import contact_moment, contact_pressure, holding, resultant, supports
from cprbm.mechanism import Mechanism
from cprbm.normal_force import normal_force
from cprbm.point import Point, Problem, potential_energy
from cprbm.stress import bending_stress
from cprbm.zones import zones_of
from cprbm_scene import Probe, Scene, Shape
from cprbm_scene.answer import Array, frozen_array
from cprbm_scene.statement import DisplacementDrive, PinnedEnd, WeldedEnd


def probed(
    scene: Scene, mechanism: Mechanism, point: Point, closed_at: dict[str, float], stage: str
) -> dict[str, Array]:
    """Every probe's value at a state in a stage; ``closed_at`` holds the load at which contacts closed."""
    return {
        probe.name: frozen_array(
            _value(scene, mechanism, point, probe, closed_at) if probe.asked_in(stage) else []
        ).ravel()
        for probe in scene.probes
    }


def _value(
    scene: Scene, mechanism: Mechanism, point: Point, probe: Probe, closed_at: dict[str, float]
) -> Array | float | list[float]:
    problem = mechanism.problem
    model = problem.model
    match probe.quantity:
        case "displacement":
            return _displacement(scene, problem, point, probe.of)
        case "rotation":
            return (
                float(point.state.bodies[model.free_bodies.index(probe.of), 2])
                if probe.of in model.free_bodies
                else 0.0
            )
        case "force":
            first = model.chain(scene.contacts[probe.of].beams[0])
            return resultant(point, probe.of, first) * model.unit_force
        case "centre":
            arc, pressing = contact_pressure(point, probe.of, model.chain(scene.contacts[probe.of].beams[0]))
            return float((pressing / pressing.sum()) @ arc) * model.unit_length if pressing.size else []
        case "ends":
            zones = zones_of(mechanism.pairs[probe.of], point)
            return [zones[0].begin * model.unit_length, zones[-1].end * model.unit_length] if zones else []
        case "closing_load":
            _, pressing = contact_pressure(point, probe.of, model.chain(scene.contacts[probe.of].beams[0]))
            return [closed_at[probe.of]] if probe.of in closed_at and pressing.size else []
        case "bending_stress":
            return bending_stress(mechanism, point, model.chain(probe.of), probe.points)
        case "combined_stress":
            beam, u = scene.beams[probe.of], np.linspace(0.0, 1.0, probe.points)
            chain = model.chain(probe.of)
            normal = normal_force(mechanism, point, chain, probe.points) * model.unit_force
            bent = np.abs(bending_stress(mechanism, point, chain, probe.points))
            return np.asarray(bent + np.abs(normal) / (beam.thickness_at(u) * beam.width_at(u)))
        case "reaction" | "reaction_moment":
            force, moment = _reaction(scene, problem, point, probe.of)
            return force * model.unit_force if probe.quantity == "reaction" else moment * model.unit_moment
        case "potential_energy":
            return potential_energy(problem, point) * model.unit_moment
        case "angle":
            return mechanism.stops[probe.of].angle(point.state)
        case "moment":
            return abs(_holding_moment(mechanism, point, probe.of)) * model.unit_moment


def _holding_moment(mechanism: Mechanism, point: Point, name: str) -> float:
    """Moment of a stop, or of all that an edge exerts on a beam about the first of its pins on it; zero without one."""
    pair = mechanism.pairs.get(name)
    if pair is None:
        return float(sum(lam.sum() for group, lam in point.rows.shares(point.lam) if group.contact == name))
    pin = next((pin for pin in pair.pins if pin is not None), None) if isinstance(pair, Edge) else None
    return 0.0 if pin is None else contact_moment(mechanism.problem, point, name, pair.a, pin.arc)


def _displacement(scene: Scene, problem: Problem, point: Point, name: str) -> Array:
    owner = scene.body_of(name)
    model = problem.model
    if owner not in model.free_bodies:
        return np.zeros(2)
    b = model.free_bodies.index(owner)
    u, v, phi = point.state.bodies[b]
    rx, ry = np.array(scene.bodies[owner].points[name]) / model.unit_length - model.references[b]
    # cos φ − 1 as −2 sin²(φ/2), which keeps small rotations exact
    less, sin = -2.0 * np.sin(0.5 * phi) ** 2, np.sin(phi)
    return np.array([u + less * rx - sin * ry, v + sin * rx + less * ry]) * model.unit_length


def _reaction(scene: Scene, problem: Problem, point: Point, name: str) -> tuple[Array, float]:
    """Force and moment of the ground at a point ``name``, or of the drives of that point or body."""
    force, moment = np.zeros(2), 0.0
    for support in supports(problem, point):
        beam = scene.beams[support.beam]
        end = beam.start if support.at == "start" else beam.end
        if isinstance(end, WeldedEnd | PinnedEnd) and end.point == name:
            force = force + support.force
            moment += support.moment
    for each in holding(problem, point):
        if name == _held(scene, each.drive):
            force = force + each.force
            moment += each.moment
    return force, moment


def _held(scene: Scene, drive: str) -> str:
    """Of which point or body a drive's reaction is asked; a pivot's own point, and the body that slides."""
    if drive not in scene.drives:
        return drive
    driven = scene.drives[drive]
    return driven.point if isinstance(driven, DisplacementDrive) else driven.body


def shapes(mechanism: Mechanism, point: Point) -> dict[str, Shape]:
    """Deformed neutral lines, metres, two points per link."""
    model = mechanism.problem.model
    found = {}
    for chain in model.chains:
        line = smooth.smooth_line(chain, model.unit_length, point.state, point.at).sampled
        found[chain.name] = Shape(
            frozen_array(line.s * model.unit_length),
            frozen_array(line.x * model.unit_length),
            frozen_array(line.y * model.unit_length),
        )
    return found


def touching(mechanism: Mechanism, point: Point) -> dict[str, Array]:
    """Places (k, 2), metres, where closed contacts touch: between the neutral lines, by thickness."""
    model = mechanism.problem.model
    found = {}
    closed = point.rows.pressing(point.lam)
    for name in [name for name in mechanism.pairs if name in closed]:
        parts = [(group.arc, lam) for group, lam in point.rows.shares(point.lam) if group.contact == name]
        pressing = np.concatenate([arc[lam > 0.0] for arc, lam in parts])
        places = mechanism.pairs[name].touching(point.state, point.at, pressing)
        found[name] = frozen_array(places * model.unit_length)
    return found

"""Statics of an answer: sums over every beam and body, action and reaction, and moments at cuts.

Cut a beam where its shape says what the moment inside is (:mod:`comparisons.audit.links`, ``elements``): it is that of
all forces beyond the cut about it, whatever the discretisation.  That holds to round-off where nothing acts near the
cut.  A force within h of it does its work by a mean of levers over the element, which is off by a part of h; a moment
in the same element is shared by the cuts beside it.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from comparisons.audit.areas import AreaOfBeam
from comparisons.audit.elements import SHEAR_FACTOR, ElementsOfBeam
from comparisons.audit.links import Links
from comparisons.audit.seen import Acting, AnyBeam, Seen
from cprbm_scene.statement import BeamContact, BeamMoment, SelfContact, WeldedEnd

CLOSED = 1e-7  # of the largest force or moment in a sum
ROUNDED = 100.0  # times what round-off leaves
SMALL = 1e-3  # of the longest beam
LEVER = 0.4  # h: by how much the lever of a force near a cut may be off
SIDE = 1e-9  # of the longest beam
NEAR, NEAR_SHEAR = 1.6, 2.6  # h: how near that is


def sums(seen: Seen) -> Iterator[str]:
    """What is left over of ΣF and ΣM of beams, bodies, contacts and joints."""
    floor = _floor(seen)
    for name, acting in seen.acting.items():
        given = between_nodes(seen, name)[1] if name in seen.beams else 0.0
        yield from _unbalanced(name, acting, (floor[0], floor[1] + given))
    for name in {*seen.scene.contacts, *seen.scene.pins, *(p for b in seen.scene.bodies.values() for p in b.points)}:
        if _is_between(seen, name):
            yield from _unbalanced(f"{name}, action and reaction,", _only(seen, name), floor)
    for name, beam in seen.scene.beams.items():
        for end, s in ((beam.start, 0.0), (beam.end, seen.rests[name].length)):
            if isinstance(end, WeldedEnd):
                continue
            acting = seen.acting[name]
            at = np.isclose(acting.s, s, rtol=0.0, atol=1e-9 * seen.longest)
            joint = [] if end.joint == "free" else [end.point]
            moments = [m for m, by, here in zip(acting.moments, acting.by, at, strict=True) if here and by in joint]
            if np.max(np.abs(moments), initial=0.0) > floor[1]:
                yield f"the {end.joint} end of {name} carries a moment of {np.max(np.abs(moments)):.2g} N·m"


def cuts(seen: Seen) -> Iterator[str]:
    """Where the moment inside is not that of what acts beyond."""
    floor = _floor(seen)[1]
    for name, beam in seen.beams.items():
        arc, _, inside = beam.cuts
        allowed = floor + between_nodes(seen, name)[1] + near(seen, name, arc)
        if isinstance(beam, Links):
            allowed = allowed + beam.blurred
        beyond = moments_beyond(seen, name, arc)
        off = np.abs(inside - beyond) - allowed
        worst = int(np.argmax(off))
        if not off[worst] <= 0.0:
            yield (
                f"{name} at {arc[worst]:.4g} m bears {inside[worst]:.6g} N·m by its shape and {beyond[worst]:.6g} N·m "
                f"by all that acts beyond"
            )


def at_nodes(seen: Seen) -> Iterator[str]:
    """Nodes of areas that are left with a force where nothing acts: neither in a held section nor near a contact."""
    floor = _floor(seen)[0]
    for name, beam in seen.beams.items():
        if isinstance(beam, AreaOfBeam):
            s = beam.inside.along
            off = np.where(near(seen, name, s) > 0.0, 0.0, beam.left.max(axis=1))
            off[[0, -1]] = 0.0
            worst = int(np.argmax(off))
            if not off[worst] <= floor:
                yield f"{name} at {s[worst]:.4g} m is left with {off[worst]:.2g} N by its elements where nothing acts"


def between_nodes(seen: Seen, name: str) -> tuple[float, float]:
    """What loads on a beam do between its nodes, of which an answer says nothing: energy, J, and moment, N·m, at most.

    A force F yields by F h³/(192 E·I) at most where it acts, by F h/(4 EA) and F h/(4 GA) more in what stretches and
    shears, and a moment M turns by M h/(3 E·I).  So much work is done there, and so far from the line drawn here may
    the force act: as far again, as that leans by the mean of elements beside each other, and is as long as they say.
    """
    beam, acting, rest = seen.beams[name], seen.acting[name], seen.rests[name]
    e = beam.inside.borders
    loads = np.array([by in seen.scene.loads for by in acting.by], dtype=bool)
    at = np.clip(np.searchsorted(e, acting.s[loads], side="right") - 1, 0, len(e) - 2)
    forces, moments = np.zeros(len(e) - 1), np.zeros(len(e) - 1)
    np.add.at(forces, at, np.abs(acting.forces[loads]))
    np.add.at(moments, at, np.abs(acting.moments[loads]))
    h, EI = np.diff(e), np.minimum(rest.rigidity(e[:-1]), rest.rigidity(e[1:]))
    give = h**3 / (192.0 * EI)
    if isinstance(beam, ElementsOfBeam) and beam.kinematics != "bending":
        EA = 12.0 * EI / np.maximum(rest.thickness(e[:-1]), rest.thickness(e[1:])) ** 2
        GA = SHEAR_FACTOR * EA / (2.0 * (1.0 + rest.nu)) if beam.kinematics == "shear" else np.inf
        give = give + h / (2.0 * EA) + h / (2.0 * GA)
    given = float(np.sum(forces**2 * give))
    return given + float(np.sum(moments**2 * h / (3.0 * EI))), given


def unbalance(seen: Seen) -> tuple[float, float]:
    """Stationarity: the largest moment at a cut that nothing acts near which its shape does not bear.

    Unscaled, N·m, and over the largest moment in the mechanism.
    """
    worst, largest = 0.0, _largest(seen)[1]
    for name, beam in seen.beams.items():
        arc, _, inside = beam.cuts
        off = np.abs(inside - moments_beyond(seen, name, arc))[near(seen, name, arc) == 0.0]
        worst = max(worst, float(np.max(off, initial=0.0)))
    return worst, worst / largest if largest > 0.0 else 0.0


def moments_beyond(seen: Seen, name: str, arc: np.ndarray) -> np.ndarray:
    """Moment of all that acts on a beam beyond arc lengths (n,), about the line there, N·m."""
    beam, acting = seen.beams[name], seen.acting[name]
    at = beam.line(arc)[0] if not np.array_equal(arc, beam.cuts[0]) else beam.cuts[1]
    lever = acting.places[None, :] - at[:, None]
    moments = (np.conj(lever) * acting.forces).imag + acting.moments
    return np.asarray((moments * (acting.s > arc[:, None])).sum(axis=1))


def near(seen: Seen, name: str, arc: np.ndarray) -> np.ndarray:
    """By how much moments at arc lengths (n,) may be off for what acts near there, N·m; zero where nothing does."""
    beam, acting = seen.beams[name], seen.acting[name]
    # beside a much shorter element it is the one that the force acts in or beside
    beside = np.maximum(_size(beam, acting.s - SIDE * seen.longest), _size(beam, acting.s + SIDE * seen.longest))
    h = np.maximum(_size(beam, arc)[:, None], beside)
    inner = (acting.s > 0.0) & (acting.s < seen.rests[name].length)
    ends = ~inner & ~np.isin(acting.by, _joints_of(seen, name))
    wide = seen.kinematics == "shear" or isinstance(beam, AreaOfBeam)  # an area's edge leads a force on to neighbours
    reach = NEAR_SHEAR if wide else NEAR
    close = (np.abs(acting.s - arc[:, None]) < reach * h) & (inner | ends)
    moments = np.array([isinstance(seen.scene.loads.get(by), BeamMoment) for by in acting.by], dtype=bool)
    return np.asarray((close * (LEVER * h * np.abs(acting.forces) + np.abs(acting.moments) * moments)).sum(axis=1))


def _joints_of(seen: Seen, name: str) -> list[str]:
    beam = seen.scene.beams[name]
    stops = [key for key, stop in seen.scene.stops.items() if stop.beam == name]
    return [*stops, *(end.point for end in (beam.start, beam.end) if end.joint != "free")]


def _size(beam: AnyBeam, arc: np.ndarray) -> np.ndarray:
    e = beam.inside.borders
    return np.asarray(np.diff(e)[np.clip(np.searchsorted(e, arc, side="right") - 1, 0, len(e) - 2)])


def _largest(seen: Seen) -> tuple[float, float]:
    """The largest force and moment, N and N·m; of a moment no less than a small lever makes of the force."""
    force = max((float(np.max(np.abs(one.forces), initial=0.0)) for one in seen.acting.values()), default=0.0)
    inside = max(float(np.max(np.abs(beam.cuts[2]))) for beam in seen.beams.values())
    moment = max(inside, *(float(np.max(np.abs(one.moments), initial=0.0)) for one in seen.acting.values()))
    return force, max(moment, SMALL * force * seen.longest)


def _floor(seen: Seen) -> tuple[float, float]:
    """What a force and a moment may be left over by, N and N·m."""
    force, moment = _largest(seen)
    rounding = ROUNDED * max(beam.rounding for beam in seen.beams.values())
    h = min(float(np.diff(beam.inside.borders).min()) for beam in seen.beams.values())
    return CLOSED * max(force, moment / seen.longest) + rounding / h, CLOSED * moment + rounding


def _unbalanced(name: str, acting: Acting, floor: tuple[float, float]) -> Iterator[str]:
    if not acting.by:
        return
    force, moment = acting.forces.sum(), float(acting.about(complex(acting.places[0])).sum())
    if not abs(force) <= floor[0]:
        yield f"ΣF of {name} is {abs(force):.2g} N, of {np.max(np.abs(acting.forces)):.2g} N"
    size = float(np.max(np.abs(acting.places - acting.places[0])))
    if not abs(moment) <= floor[1] + floor[0] * size:
        yield f"ΣM of {name} is {abs(moment):.2g} N·m, of {np.max(np.abs(acting.about(complex(acting.places[0])))):.2g}"


def _is_between(seen: Seen, name: str) -> bool:
    """Whether what is exerted under a name acts on two that are both in the answer."""
    scene = seen.scene
    if name in scene.contacts:
        contact = scene.contacts[name]
        return isinstance(contact, BeamContact | SelfContact) or contact.body in seen.statics.bodies
    if name in scene.pins:
        return all(scene.body_of(point) in seen.statics.bodies for point in scene.pins[name].points)
    return scene.body_of(name) in seen.statics.bodies and name not in _pivots(seen)


def _pivots(seen: Seen) -> set[str]:
    return {body.about for body in seen.scene.bodies.values() if body.motion == "turns"}


def _only(seen: Seen, name: str) -> Acting:
    of = seen.statics
    mine = np.array([by == name for by in of.by], dtype=bool)
    by = tuple(name for here in mine if here)
    return Acting(by, of.s[mine], of.places[mine] @ (1.0, 1j), of.forces[mine] @ (1.0, 1j), of.moments[mine])

"""Laws of one station: closed joints, sums of forces, free-body cuts, and the section law.

======  ===============================================================================
symbol  meaning
======  ===============================================================================
F, M    force and moment of all that acts beyond a cut
N, Q    stated normal force and shear force
φ       rotation of the section from rest
γ       shear angle ψ - φ, with ψ of the tangent and φ of the section
h       distance of two neighbouring stated places
======  ===============================================================================

A beam is cut at every stated place.  N, Q and M at the cut are the resultant of all forces beyond, whatever the
discretisation.  A lever is known up to the distance of a chain's joints from the smooth line.

Between two places Δφ = ∫ M/(E·I) ds, with an error of up to h |ΔM|/(E·I), as M may step between both places, of h² |ΔQ|
/(8 E·I) of a kink of M, and of the variation of E·I.  γ = Q/(GA_s) holds in the middle of all places that bear shear:
beside held ends and forces γ is not uniform over the section.  The law is coarse on purpose: without a copy of any
element the audit finds gross errors of the section alone.

Ends stand at their points, welded ends at their angles; guides, pivots, pins, drives and drawn shapes hold to CLOSED.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from comparisons.audit.state import BESIDE, Finding, StationState, about, unit
from cprbm_scene.answer import Array
from cprbm_scene.statement import DisplacementDrive, FreeEnd, PinnedEnd, SlidingBody, TurningBody, WeldedEnd

CLOSED = 1e-7
"""Largest sum of forces or moments in equilibrium, over the largest force or moment."""

ROUND_OFF, ANGLE = 2e-14, 1e-9
"""Relative error of a rotation between neighbouring places: a hundred units in the last place; the largest, rad."""

NEAR, LEVER = 2.6, 0.2
"""A force within NEAR elements of a cut has a lever that is known to LEVER elements: 0.1 is the largest measured."""

SHARE, SHEARED = 0.05, 0.08
"""Largest relative errors of a rotation by M, over the beam's largest value, and of the median of γ GA_s/Q: a shear
factor of 1 makes 0.17."""

BEARING, ENOUGH = 0.3, 4
"""Share of a beam's largest shear force, and more than the load on an element, from which a place bears shear; least
number of places with a median."""


def sums(state: StationState) -> Iterator[Finding]:
    """Forces of beams, bodies, contacts and joints that do not cancel, and moments of pinned ends."""
    scene, forces, moving = state.scene, state.forces, state.station.bodies
    held = {
        point
        for name, body in scene.bodies.items()
        for point in body.points
        if name not in moving or (isinstance(body, TurningBody) and point == body.about)
    }
    pairs = {source: forces[forces["source"] == source] for source in set(forces["source"]) - held}
    parts = state.on | {f"{name}, both sides,": pair for name, pair in pairs.items() if len(set(pair["target"])) > 1}
    for name, part in parts.items():
        force, moment = floors(state, name)
        left, turning = abs(part["force"].sum()), abs(about(part, complex(part["place"][:1].sum())).sum())
        yield left - force, f"the forces of {name} leave {left:.2g} N over"
        yield turning - moment - force * state.longest, f"the moments of {name} leave {turning:.2g} N·m over"
    pinned = {
        (end.point, name)
        for name, beam in scene.beams.items()
        for end in (beam.start, beam.end)
        if isinstance(end, PinnedEnd)
    }
    for source, target, moment in (row for row in forces[["source", "target", "moment"]] if row.tolist()[:2] in pinned):
        yield abs(moment) - floors(state)[1], f"{target} bears {moment:.2g} N·m at the pinned end {source}"


def cuts(state: StationState) -> Iterator[Finding]:
    """Differences of N, Q and M from the resultant of all that acts beyond; a load at a cut leaves N and Q open."""
    for name, beam in state.beams.items():
        s, stated = beam.state.s, (beam.state.N + 1j * beam.state.Q) * np.exp(1j * beam.state.angle)
        at_cut = nearby(state, name, s, BESIDE * beam.length)
        force = np.abs(stated - state.beyond(name, s)[0]) - at_cut - floors(state)[0]
        moment = np.abs(state.unbalance(name)) - moment_errors(state, name, s)
        for off, of in ((force, "force (N)"), (moment, "moment (N·m)")):
            yield (
                off.max(),
                f"the {of} of {name} at {s[np.argmax(off)]:.4g} m is {off.max():.2g} too far off all that acts beyond",
            )


def section_law(state: StationState) -> Iterator[Finding]:
    """Differences of rotations and shear angles from the deformation by the stated moments and shear forces."""
    for name, beam in state.beams.items():
        s, M, h, ripple = beam.state.s, beam.state.M, np.diff(beam.state.s), state.ripple(name)
        give = 1.0 / np.stack([beam.stiffness(at)[0] for at in (s[:-1], 0.5 * (s[1:] + s[:-1]), s[1:])])
        made = h * (give[0] * M[:-1] + 2.0 * give[1] * (M[1:] + M[:-1]) + give[2] * M[1:]) / 6.0
        stepped = np.abs(np.diff(M)) + 0.125 * h * np.abs(np.diff(beam.state.Q)) + ripple
        varied = np.ptp(give, axis=0) * np.abs(M[1:] + M[:-1]) + SHARE * np.abs(made / h).max()
        off = np.abs(np.diff(beam.turned) - made) - h * (give.max(axis=0) * stepped + varied) - ANGLE
        yield off.max(), f"{name} at {s[np.argmax(off)]:.4g} m turns {off.max():.4g} rad off what its moments make"
        if state.kinematics == "shear":
            gamma, made = beam.state.angle - beam.state.section_angle, beam.state.Q / beam.stiffness(s)[2]
            bears = np.abs(made) > BEARING * np.abs(made).max() + ANGLE
            bears &= (np.abs(beam.state.Q) > 8.0 * ripple / beam.h) & (s > 0.0) & (s < beam.length)
            share = float(np.median(gamma[bears] / made[bears])) if bears.sum() >= ENOUGH else 1.0
            yield abs(share - 1.0) - SHEARED, f"{name} shears by {share:.3g} times what its internal forces make"


def moment_errors(state: StationState, name: str, s: Array) -> Array:
    """Largest errors of the moment of all that acts beyond arc lengths (k,) of a beam, (k,), N·m."""
    h = state.beams[name].h
    return floors(state, name)[1] + LEVER * h * nearby(state, name, s, NEAR * h)


def nearby(state: StationState, name: str, s: Array, reach: float) -> Array:
    """Sums of the forces of contacts and loads within a distance of arc lengths (k,) of a beam, (k,), N."""
    forces, sources = state.on[name], [*state.scene.contacts, *state.scene.loads]
    near = (np.abs(forces["s"] - s[:, None]) < reach) & np.isin(forces["source"], sources)
    return np.asarray(near @ np.abs(forces["force"]))


def floors(state: StationState, name: str = "") -> tuple[float, float]:
    """Largest force, N, and moment, N·m, that equilibrium may leave over, of all or of a beam."""
    force, moment = state.largest
    rounding = ROUND_OFF * state.natural * max(len(beam.state.s) for beam in state.beams.values()) ** 2
    closed, moment = CLOSED * force, CLOSED * moment + rounding
    levered = state.lever(name) + state.ripple(name) if name in state.beams else 0.0
    return closed + moment / state.longest, moment + levered


JOINED = 1e-8
"""Largest error of a joint, over the longest beam, or rad."""


def joints(state: StationState) -> Iterator[Finding]:
    """Errors of joints, guides, drives and drawn shapes beyond JOINED."""
    for joint, off in _errors(state):
        yield abs(off) - JOINED * state.longest, f"{joint} is {abs(off):.2g} m off"


def _errors(state: StationState) -> Iterator[tuple[str, float]]:
    """Joints and their errors, m; an angle counts with the longest beam as the arm."""
    scene, arm = state.scene, state.longest
    for name, beam in state.beams.items():
        shape = state.station.shapes[name]
        drawn = np.interp(beam.state.s, shape.s, shape.x + 1j * shape.y)
        yield f"the shape of {name}", float(np.abs(drawn - beam.places).max())
        for end, i in ((beam.beam.start, 0), (beam.beam.end, -1)):
            if not isinstance(end, FreeEnd):
                ahead = np.angle(np.exp(1j * (beam.turned[i] - state.rotation(scene.body_of(end.point)))))
                off = abs(beam.places[i] - state.point(end.point)) + arm * abs(ahead) * isinstance(end, WeldedEnd)
                yield f"the end of {name} at {end.point}", off
    for name, body in scene.bodies.items():
        if isinstance(body, SlidingBody):
            aside = abs((state.moved(body.pin or next(iter(body.points))) * np.conj(unit(body.along))).imag)
            yield f"the slide of {name}", aside + (arm * abs(state.rotation(name)) if body.pin is None else 0.0)
        elif isinstance(body, TurningBody):
            yield f"the pivot {body.about}", abs(state.moved(body.about))
    for name, pin in scene.pins.items():
        yield f"the pin {name}", abs(state.point(pin.points[0]) - state.point(pin.points[1]))
    for name, drive in scene.drives.items():
        if isinstance(drive, DisplacementDrive):
            moved = (state.moved(drive.point) * np.conj(unit(drive.direction))).real
            yield f"the drive {name}", moved - state.values[name]
        else:
            yield f"the drive {name}", arm * (state.rotation(drive.body) - state.values[name])

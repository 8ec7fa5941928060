"""Laws of an answer: closed joints, sums of forces, free-body cuts, the section law, probes, and the energy of a path.

======  ===============================================================================
symbol  meaning
======  ===============================================================================
F, M    force and moment of all that acts beyond a cut
N, Q    stated normal force and shear force
φ       rotation of the section from rest
γ       shear angle ψ - φ, with ψ of the tangent and φ of the section
h       distance of two neighbouring stated places; step between two stations
Π       strain energy less the work of the loads
g, x    dΠ/dx and x of the stepped loads or drive: -u and P, or F and d
======  ===============================================================================

*Joints.*  Ends stand at their points, welded ends at their angles; guides, pivots, pins, drives and drawn shapes hold.

*Cuts.*  A beam is cut at every stated place.  N, Q and M at the cut are the resultant of all forces beyond, whatever
the discretisation.  A lever is known up to the distance of a chain's joints from the smooth line.

*Section law.*  Between two places Δφ = ∫ M/(E·I) ds, with an error of up to h |ΔM|/(E·I), as M may step between both
places, of h² |ΔQ| /(8 E·I) of a kink of M, and of the variation of E·I.  Forces at places stand for the pressure of a
contact: M has a ripple of h |F|/8 with the forces F within h, all of M in a taut strip on a circle.  γ = Q/(GA_s) holds
in the middle of all places that bear shear: beside held ends, forces and steps of Q γ is not uniform over the section.
The law is coarse on purpose: without a copy of any element the audit finds gross errors of the section alone.

*Probes.*  Stresses follow from the moment and the force of all forces beyond the place, everywhere along the beam.  The
strain energy is ∫ M²/(2 E·I) + N²/(2 EA) + Q²/(2 GA_s) ds.  M is the moment of all forces beyond, corrected by the
difference of the stated M, which is linear between the stated places.  Elements of even curvature store less by
Σ l³ Q²/(24 E·I), with l of the element.

*Path.*  Between two stations of one branch the trapezoidal rule gives ΔΠ = h (g₀ + g₁)/2.  The allowance is the
range of g in the interval, also at stations of other stages, and twice the error term h² Δg′/12.  Δg′ is the larger
difference to the secant of a neighbouring interval, since g has a kink where the branch bifurcates.  Only a loss of
energy counts: a silent jump to another state loses energy that no work accounts for, and a reaction may rise and fall
between two stations.  Under a load u rises with P on a path of minima, whatever contacts close.  An interval of a drive
is not judged if a contact closes or opens there.  A silent jump in such an interval is not seen.

*Critical points.*  The energy beyond a critical point belongs to a value up to the next station: the work up to that
station is allowed.  Without a next station the energy is not judged.
"""

from collections.abc import Iterator, Sequence
from itertools import groupby, pairwise

import numpy as np

from comparisons.audit.state import BESIDE, Finding, StationState, about, gauss, unit
from comparisons.formats import at_station, load_text
from comparisons.quantities import arc_lengths
from cprbm_scene import (
    Answer,
    Array,
    DisplacementDrive,
    Flags,
    FreeEnd,
    PinnedEnd,
    Probe,
    Scene,
    SelfContact,
    SlidingBody,
    TurningBody,
    WeldedEnd,
)

CLOSED = 1e-7
"""Largest sum of forces or moments in equilibrium, over the largest force or moment, or all forces on the beam."""

ROUND_OFF, ANGLE = 2e-14, 1e-9
"""Relative error of a rotation between neighbouring places: a hundred units in the last place; the largest, rad."""

NEAR, LEVER = 2.6, 0.2
"""A force within NEAR elements of a cut has a lever that is known to LEVER elements: 0.1 is the largest measured."""

SHARE, SHEARED = 0.05, 0.08
"""Largest relative errors of a rotation by M, over the beam's largest value, and of the median of γ GA_s/Q: a shear
factor of 1 makes 0.17."""

BEARING, ENOUGH = 0.3, 4
"""Share of a beam's largest shear force, beside the step to the next place, and more than the load on an element, from
which a place bears shear; least number of places with a median."""

JOINED = 1e-8
"""Largest error of a joint, over the longest beam, or rad."""

SAME, STRESS = 1e-6, 0.02
"""Error of a probe that is read or summed, over the summed parts; error of a stress between two cuts, over the largest
stress of the beam."""

ENERGY, EVEN = 5e-3, 1.2
"""Error of the energy over strain energy and work, and over the energy that an even curvature leaves out: of 198
answers to random scenes at N = 40 one misses more than 2.2e-3 of strain energy and work."""

FITTED = 2e-3
"""Difference of energies, over the energies, between meshes that are fitted from station to station."""

CONTINUOUS = 0.01
"""Energy gained beyond a critical point, over the energy: a continuous bifurcation releases none."""

ENERGY_ROUND_OFF = 1e-9
"""Energy that round-off explains, over the natural energy E·I/L."""


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
        force = np.abs(stated - state.beyond(name, s)[0]) - at_cut - floors(state, name)[0]
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
        kinked = np.abs(np.diff(beam.state.Q)) + nearby(state, name, 0.5 * (s[1:] + s[:-1]), beam.h)
        stepped = np.abs(np.diff(M)) + 0.125 * h * kinked + ripple
        varied = np.ptp(give, axis=0) * np.abs(M[1:] + M[:-1]) + SHARE * np.abs(made / h).max()
        off = np.abs(np.diff(beam.turned) - made) - h * (give.max(axis=0) * stepped + varied) - ANGLE
        yield off.max(), f"{name} at {s[np.argmax(off)]:.4g} m turns {off.max():.4g} rad off what its moments make"
        if state.kinematics == "shear":
            gamma, made = beam.state.angle - beam.state.section_angle, beam.state.Q / beam.stiffness(s)[2]
            step = np.abs(np.diff(made, prepend=made[0], append=made[-1]))
            bears = np.abs(made) - np.maximum(step[1:], step[:-1]) > BEARING * np.abs(made).max() + ANGLE
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
    """Largest force, N, and moment, N·m, that equilibrium may leave over, of all or of a beam or a body."""
    force, moment = state.largest
    force = max(force, float(np.abs(state.on[name]["force"]).sum()) if name in state.on else 0.0)
    rounding = ROUND_OFF * state.natural * max(len(beam.state.s) for beam in state.beams.values()) ** 2
    closed, moment = CLOSED * force, CLOSED * moment + rounding
    levered = state.lever(name) + state.ripple(name) if name in state.beams else 0.0
    return closed + moment / state.longest, moment + levered


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
            lever, moved = 1.0, (state.moved(drive.point) * np.conj(unit(drive.direction))).real
        else:
            lever, moved = arm, state.rotation(drive.body)
        yield f"the drive {name}", lever * (moved - state.values.get(name, moved))


def probes(state: StationState) -> Iterator[Finding]:
    """Differences of probes from the values of the stated forces and shape; infinite if a probe is not finite."""
    for probe in state.scene.probes_in(state.station.stage):
        given = state.station.values.get(probe.name, np.array([np.nan]))
        value, allowed = _expected(state, probe) or (given, SAME)
        off = np.abs(given - value) - allowed if given.shape == value.shape else np.array([np.nan])
        if off.size:
            i = int(np.argmax(np.nan_to_num(off, nan=np.inf)))
            yield (
                off[i],
                # NumPy prints arrays in longer than the check takes
                ""
                if off[i] <= 0.0
                else f"{probe.name} is {given[i : i + 1]} where the stated forces and shape make {value[i : i + 1]}",
            )


def _expected(state: StationState, probe: Probe) -> tuple[Array, Array | float] | None:
    """The value of a probe and the allowed error; None of quantities that are not recomputed."""
    of, forces, (force, moment) = probe.of, state.forces, floors(state)
    match probe.quantity:
        case "displacement":
            return np.array([state.moved(of)]).view(float), SAME * state.longest
        case "rotation":
            return np.array([state.rotation(of)]), SAME
        case "force":
            contact = state.scene.contacts[of]
            on = np.sort(forces[(forces["source"] == of) & (forces["target"] == contact.beams[0])], order="s")
            if isinstance(contact, SelfContact) and len(on):
                # a lap bears the opposite force beside the force on the other lap: the lap with the smaller s counts
                own = on[:, None]
                apart = (
                    np.abs(own["force"] + on["force"]) / (np.abs(own["force"]) + np.finfo(float).tiny)
                    + np.abs(own["place"] - on["place"]) / state.longest
                )
                on = on[np.arange(len(on)) < np.argmin(apart, axis=1)]
            value = abs(on["force"].sum())
            return np.array([value]), SAME * value + force
        case "moment":
            value = _moment(state, of)
            return np.array([value]), SAME * value + moment
        case "reaction" | "reaction_moment":
            held = forces[np.isin(forces["source"], _holding(state.scene, of))]
            size, value = np.abs(held["force"]).max(initial=0.0), float(held["moment"].sum())
            if probe.quantity == "reaction":
                return np.array([held["force"].sum()]).view(float), SAME * size + force
            return np.array([value]), SAME * (abs(value) + size * state.longest) + moment
        case "potential_energy":
            strain, work, even = _energies(state)
            return (
                np.array([strain - work]),
                ENERGY * (strain + abs(work)) + EVEN * even + ENERGY_ROUND_OFF * state.natural,
            )
        case "bending_stress" | "combined_stress":
            return _stress(state, probe)
    return None


def _stress(state: StationState, probe: Probe) -> tuple[Array, Array]:
    """Stress along a beam by the forces beyond, and the allowed error, (points,) each."""
    beam, s = state.beams[probe.of], arc_lengths(state.scene, probe)
    (F, M), (EI, EA, _), E = state.beyond(probe.of, s), beam.stiffness(s), beam.material.youngs_modulus
    per_moment, per_force = 0.5 * beam.thickness(s) * E / EI, E / EA
    # where the moment of a load acts, the stress on either side is right
    of_loads = state.on[probe.of][np.isin(state.on[probe.of]["source"], list(state.scene.loads))]
    steps = (np.abs(of_loads["s"] - s[:, None]) <= SAME * beam.length) @ np.abs(of_loads["moment"])
    value, allowed = per_moment * M, per_moment * (moment_errors(state, probe.of, s) + steps)
    if probe.quantity == "combined_stress":
        tangent = beam.rest(s)[1] + beam.displacement(s, 1)
        value = np.abs(value) + per_force * np.abs((F * np.conj(tangent / np.abs(tangent))).real)
        allowed += per_force * floors(state)[0]
    return value, allowed + STRESS * np.abs(value).max()


def _moment(state: StationState, of: str) -> float:
    """Moment of a stop on its beam, or of a contact about the first pin that joins the beam and the touched body."""
    scene, body = state.scene, getattr(state.scene.contacts.get(of), "body", None)
    on = scene.stops[of].beam if of in scene.stops else scene.contacts[of].beams[0]
    ends = (end.point for end in (scene.beams[on].start, scene.beams[on].end) if isinstance(end, PinnedEnd))
    pin = next(state.point(point) for point in ends if body in (None, scene.body_of(point)))
    return abs(float(about(state.on[on][state.on[on]["source"] == of], pin).sum()))


def _holding(scene: Scene, of: str) -> list[str]:
    """Sources that hold a point or a body: joints, guides, drives, pins and stops."""
    ends = {name: getattr(scene.beams[stop.beam], stop.end).point for name, stop in scene.stops.items()}
    driven = {name: getattr(drive, "point", "") or getattr(drive, "body", "") for name, drive in scene.drives.items()}
    pins = {name: of for name, pin in scene.pins.items() if of in pin.points}
    return [of, *(name for name, held in (ends | driven | pins).items() if held == of)]


def _energies(state: StationState) -> tuple[float, float, float]:
    """Strain energy, work of the loads, and the energy that an even state of elements leaves out, J."""
    strain = even = 0.0
    for name, beam in state.beams.items():
        s, ds = gauss(np.unique(np.concatenate((beam.state.s, state.on[name]["s"]))))  # M may step at a load
        N, Q, M = (np.interp(s, beam.state.s, of) for of in (beam.state.N, beam.state.Q, state.unbalance(name)))
        EI, EA, GA = beam.stiffness(s)
        stretch, slip = (state.kinematics != "bending") / EA, (state.kinematics == "shear") / GA
        strain += 0.5 * float(((M + state.beyond(name, s)[1]) ** 2 / EI + stretch * N**2 + slip * Q**2) @ ds)
        # a load along the beam steps N between two stated places
        even += beam.h * float(
            (beam.h * Q**2 / (24.0 * EI)) @ ds + stretch.max() * np.sum(np.diff(beam.state.N) ** 2) / 3.0
        )
    return strain, sum(state.values[load] * state.load(load)[1] for load in state.scene.loads), even


def path(scene: Scene, answer: Answer, states: Sequence[StationState]) -> Iterator[Finding]:
    """Changes of energy besides the work between stations of a branch, and energies gained at critical points."""
    for (stage, _), group in groupby(states, key=lambda state: (state.station.stage, state.station.branch)):
        of = list(group)
        x, g = np.array([(state.station.value, _driving(state)) for state in of]).T
        strain, work, even = np.array([_energies(state) for state in of]).T
        h, bends = np.diff(x), np.pad(np.abs(np.diff(np.diff(g) / np.diff(x))), 1)
        lost = np.diff(strain - work) - 0.5 * h * (g[1:] + g[:-1])
        error = 2.0 * even + FITTED * (strain + np.abs(work)) + ENERGY_ROUND_OFF * of[0].natural
        allowed = (
            np.abs(h) * _ranges(states, of[0].stage.steps, x)
            + h**2 * np.maximum(bends[1:], bends[:-1]) / 6.0
            + error[1:]
            + error[:-1]
        )
        for i in np.flatnonzero(_judged(answer, of)):
            yield (
                -lost[i] - allowed[i],
                f"from {at_station(scene, stage, x[i])} to {load_text(scene, stage, x[i + 1])} the energy changes by "
                f"{lost[i]:.3g} J more than the work",
            )
    for branch, critical in enumerate(answer.critical, start=1):
        beyond = [state for state in states if (state.station.stage, state.station.branch) == (critical.stage, branch)]
        if critical.after is not None and beyond:
            gained, allowed = critical.after - critical.energy, CONTINUOUS * abs(critical.energy)
            allowed += abs(_driving(beyond[0]) * (beyond[0].station.value - critical.value))
            yield (
                gained - allowed - ENERGY_ROUND_OFF * beyond[0].natural,
                f"beyond {at_station(scene, critical.stage, critical.value)} the energy is {gained:.3g} J larger",
            )


def _judged(answer: Answer, states: Sequence[StationState]) -> Flags:
    """Intervals (k-1,) between k states in which the energy is judged: under a drive no contact closes or opens."""
    first, x = states[0], np.array([state.station.value for state in states])
    events = np.array([event.value for event in answer.events if event.stage == first.stage.name])
    between = np.sign(events - x[:-1, None]) * np.sign(events - x[1:, None]) < 0.0
    pressing = np.array([{name for name, of in state.station.contacts.items() if of.active} for state in states])
    changes = between.any(axis=1) | (pressing[1:] != pressing[:-1])
    return np.asarray(~changes | (first.stage.steps in first.scene.loads))


def _ranges(states: Sequence[StationState], steps: str, x: Array) -> Array:
    """Ranges (k-1,) of g between neighbours of the values x (k,) of a load or drive, at all stations between them."""
    every, g = np.array([(of.station.value, _driving(of)) for of in states if of.stage.steps == steps]).T
    return np.array([np.ptp(g[(min(pair) <= every) & (every <= max(pair))]) for pair in pairwise(x)])


def _driving(state: StationState) -> float:
    """g of the stepped loads or drive."""
    name = state.stage.steps
    if name in state.scene.loads:
        return -sum(state.load(load)[1] for load in state.stage.stepped)
    drive, forces = state.scene.drives[name], state.forces[state.forces["source"] == name]
    way = unit(drive.direction) if isinstance(drive, DisplacementDrive) else 0j
    return float((forces["force"].sum() * np.conj(way)).real + (0.0 if way else forces["moment"].sum()))

"""The answer sheet of every solver, at the scene's own stations.

Values are NumPy arrays in SI units, made read-only.  Meaning of the quantities:

=================  ======  ====================================================================
quantity           shape   meaning
=================  ======  ====================================================================
displacement       (2,)    of a body's point, m
rotation           (1,)    of a body, counter-clockwise, rad, counted through full turns
force              (1,)    magnitude of a contact's resultant, N; 0 for an open contact
centre             (1,)    arc length on the contact's first beam of the resultant, m; empty if open; in self-contact
                           the smaller arc length of both places, here and for the ends
ends               (2,)    arc lengths on the contact's first beam at the begin and the end of the zone, m,
                           ascending, the same twice for contact in a point; empty if open; of several
                           zones the beginning of the first and the end of the last
closing_load       (1,)    value of the stepped load or drive at which a contact first closes; else empty
bending_stress     (P,)    signed: E·t/2 times the change of curvature along the beam, Pa, with t of the place,
                           at P equal arc-length steps from the beam's start to its end;
                           a positive change turns the tangent counter-clockwise
combined_stress    (P,)    largest magnitude over the section at the same places, Pa: those of the bending stress
                           and of the normal force over the section's area together
reaction           (2,)    force of the ground on the parts joined at a point, N; at a driven point the drive's force,
                           of a sliding body the force of the slide
reaction_moment    (1,)    moment of the ground there, about the point, N·m; of a body turned by a drive the
                           drive's moment
potential_energy   (1,)    strain energy less the work of the dead loads from the initial state, J
angle              (1,)    of a stop, from the line between its body's two points to the beam, rad
moment             (1,)    magnitude of the moment by which a stop holds, N·m; 0 where no limit is reached;
                           of a contact the moment of all contact forces on the beam, about the pin of the beam on the
                           touched body (about the first of two pins)
=================  ======  ====================================================================
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from enum import Enum
from itertools import pairwise
from typing import NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from cprbm_scene.statement import Scene

Array = NDArray[np.float64]
Ints = NDArray[np.intp]
Flags = NDArray[np.bool_]


class Ending(Enum):
    """How a solve ended; the value is a sentence for people."""

    COMPLETED = "every station was reached and certified"
    STEP_TOO_SMALL = "the load step was cut below its smallest size without finding a certified equilibrium"
    NOT_A_MINIMUM = "an equilibrium was found that is not a minimum of the potential energy"
    LEFT_BOUNDARY = "a touching joint left the range of the fitted boundary"
    BEAMS_CROSSED = "the beams of a contact pass through each other where nothing holds them apart"
    TURNED_TOO_FAR = "an element turned by more than the discretisation can carry"
    NOT_CERTIFIED = "an equilibrium was found whose certificate does not hold"
    BRANCH_ENDS = "the branch that was followed ends: beyond it no equilibrium near by is a minimum"
    NOT_COVERED = "no exact solution is known here for what happens"


@dataclass(frozen=True, slots=True)
class Certificate:
    """Evidence for the answer at a station; every number is relative to a stated scale.

    Attributes:
        residual: largest unbalanced generalised force over the largest one that balances.
        residual_floor: the same in units of round-off at this discretisation: below it nothing can be asked.
        violation: largest violation of a joint or loop closure, as a fraction of the longest beam.
        penetration: largest depth by which beams of a contact overlap, as a fraction of the mean thickness;
            for lines, of the longest beam.  On what is rigid a thousandth of that beam is the least thickness.
        complementarity: largest product of gap and contact force over their scales.
        force_balance: norm of ΣF, supports and contacts included, over the largest force in it.
        moment_balance: the same for ΣM.
        smallest_curvature: smallest curvature of the potential energy on the feasible directions,
            over the bending stiffness scale; positive for a minimum.
        iterations: of the equilibrium solve that ended at this station, all load steps counted.
        failures: a sentence for each thing that does not hold; empty if the certificate holds.
    """

    residual: float
    residual_floor: float
    violation: float
    penetration: float
    complementarity: float
    force_balance: float
    moment_balance: float
    smallest_curvature: float
    iterations: int
    failures: tuple[str, ...] = ()

    @property
    def holds(self) -> bool:
        """Whether nothing failed."""
        return not self.failures


@dataclass(frozen=True, slots=True)
class Shape:
    """A beam's deformed neutral line: arc length ``s`` and positions ``x``, ``y`` (n,), metres."""

    s: Array
    x: Array
    y: Array


@dataclass(frozen=True, slots=True)
class BeamState(Shape):
    """Shape and internal forces of one beam at n ascending places; SI.

    At a point force or moment the values are the limit from the side of the beam's end.  At the first and the last
    place they are limits from inside the beam.  With the arc length s, dM/ds = -Q where nothing but forces acts.

    Attributes:
        s: undeformed arc lengths, (n,), m; the first is 0, the last the beam's length.
        x, y: positions of the neutral line, (n,), m.
        angle: tangent angle of the deformed neutral line, (n,), rad, continuous along the beam.
        section_angle: angle of the section's normal, (n,), rad; equal to ``angle`` without shear.
        N: normal force along the tangent, (n,), N, positive in tension.
        Q: shear force, (n,), N: the force of the part beyond, along the left normal of the tangent.
        M: bending moment, (n,), N·m: the moment of the part beyond, counter-clockwise, with the sign of the probe
            ``bending_stress``.
        borders: arc lengths at which elements begin and end, (m+1,), m.
    """

    angle: Array
    section_angle: Array
    N: Array
    Q: Array
    M: Array
    borders: Array


class PointForce(NamedTuple):
    """Force on a beam or body: a row of :class:`PointForces`.

    Attributes:
        source: name of the cause: the point that a beam's end is joined to, the contact, stop, drive, pin or sliding
            body, or the point that is a pivot.
        target: name of the beam or body that the force acts on.
        s: arc length on a beam, m; nan on a body.
        place: of contacts on a beam, the place on the neutral line, (2,), m.
        force: (2,), N.
        moment: about ``place``, counter-clockwise, N·m.
    """

    source: str
    target: str
    s: float
    place: Array
    force: Array
    moment: float


@dataclass(frozen=True, slots=True)
class PointForces:
    """All forces of joints, contacts, stops, slides, pivots, drives and pins on beams and moving bodies, as arrays.

    A force stands once, for the loaded beam or body; the ground's share and the scene's loads are left out.
    The fields are those of :class:`PointForce`, of k forces: ``s`` and ``moment`` (k,), ``place`` and ``force`` (k, 2).
    """

    source: tuple[str, ...] = ()
    target: tuple[str, ...] = ()
    s: Array = field(default_factory=lambda: frozen_array([]))
    place: Array = field(default_factory=lambda: frozen_array(np.zeros((0, 2))))
    force: Array = field(default_factory=lambda: frozen_array(np.zeros((0, 2))))
    moment: Array = field(default_factory=lambda: frozen_array([]))

    @classmethod
    def collected(
        cls, rows: Iterable[PointForce], length: float, force: float, origin: tuple[float, float] = (0.0, 0.0)
    ) -> Self:
        """The forces of ``rows``, in units of ``length`` (m) and ``force`` (N), with places relative to ``origin``."""
        found = list(rows)
        return cls(
            tuple(row.source for row in found),
            tuple(row.target for row in found),
            frozen_array(np.array([row.s for row in found]) * length),
            frozen_array(np.reshape([row.place for row in found], (-1, 2)) * length + origin),
            frozen_array(np.reshape([row.force for row in found], (-1, 2)) * force),
            frozen_array(np.array([row.moment for row in found]) * (force * length)),
        )

    def __iter__(self) -> Iterator[PointForce]:
        """One force after the other."""
        return map(PointForce, self.source, self.target, self.s, self.place, self.force, self.moment)

    def chosen(self, source: str, target: str) -> Flags:
        """Which forces (k,) a ``source`` exerts on a ``target``."""
        return np.array([pair == (source, target) for pair in zip(self.source, self.target, strict=True)], dtype=bool)


@dataclass(frozen=True, slots=True)
class ContactState:
    """State of one contact at a station.

    Attributes:
        active: whether the contact presses by more than the share ``ACTIVE`` of the largest force at the station.
        places: positions where the beams or edges touch, (k, 2), m; also of a contact that touches without force.
        indeterminate: whether equilibrium leaves the contact's force open; None where the solver does not know.
    """

    active: bool
    places: Array
    indeterminate: bool | None = None


@dataclass(frozen=True, slots=True)
class StationAnswer:
    """Probe values, shapes, statics and certificate at one station.

    Attributes:
        stage: name of the stage.
        value: of the stepped load or drive, SI.
        values: by probe name; empty (0,) for a probe that is not asked in the stage.
        shapes: deformed neutral lines by beam name.
        touching: by the name of a closed contact the places where the beams touch, (k, 2), m.
        certificate: of this station.
        branch: number of critical points passed before; stations of different numbers lie on different branches.
        beams: internal forces by beam name; empty where the solver does not state them.
        forces: of joints, contacts and all else besides the loads.
        contacts: by name the state of every contact of the scene, inactive contacts included.
        bodies: of every moving body the displacement of the first point, m, and the rotation, rad, (3,).
    """

    stage: str
    value: float
    values: Mapping[str, Array]
    shapes: Mapping[str, Shape]
    touching: Mapping[str, Array]
    certificate: Certificate
    branch: int = 0
    beams: Mapping[str, BeamState] = field(default_factory=dict)
    forces: PointForces = field(default_factory=PointForces)
    contacts: Mapping[str, ContactState] = field(default_factory=dict)
    bodies: Mapping[str, Array] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Event:
    """Closing or opening of a contact, at ``value`` of the load or drive that ``stage`` steps.

    ``kind`` is ``closes`` or ``opens``.  An opening that is known to lie between two stations has an ``interval``, the
    ascending values of the stepped load or drive, and their mean as its value.
    """

    stage: str
    contact: str
    kind: str
    value: float
    interval: tuple[float, float] | None = None


class Loss(Enum):
    """How an equilibrium ceases to be a minimum; the value names it for people."""

    FOLD = "fold"
    BIFURCATION = "bifurcation"
    CONTACT = "contact lets go"
    STOP = "stop lets go"
    SLIP = "contact slips off an end"


@dataclass(frozen=True, slots=True)
class Critical:
    """End of a branch: at ``value`` of the stepped load or drive the equilibria cease to be minima.

    Attributes:
        stage: name of the stage.
        value: of the stepped load or drive, SI.
        uncertainty: of the value on this discretisation, in the same unit.
        loss: how stability is lost.
        what: the contact or stop that lets go, or the contact in which one end slips off another; empty for a fold or
            a bifurcation.
        curvature: smallest curvature of the potential energy on the feasible directions as the branch comes to its
            end, over the bending stiffness scale of the certificate: about zero unless something lets go.
        left: the same once what lets go holds no more, positive where that is out of balance then, as after a slip; of
            a fold or a bifurcation the curvature itself.
        energy: potential energy there, J.
        after: that of the state to which its decrease leads, J; None where the solver stopped.
    """

    stage: str
    value: float
    uncertainty: float
    loss: Loss
    what: str
    curvature: float
    left: float
    energy: float
    after: float | None


@dataclass(frozen=True, slots=True)
class GoneOver:
    """A critical point that the solver passed, without a request, to a state beside the critical point.

    Attributes:
        end: place and kind of the loss of stability; ``after`` is the energy in the state beside.
        turned: the most by which the tangent of a beam, or a body, is turned in that state against the end, rad.
    """

    end: Critical
    turned: float


@dataclass(frozen=True, slots=True)
class Answer:
    """A solver's whole answer to a scene.

    Attributes:
        solver: name of the solver; scene: name of the scene.
        settings: the solver's numerical choices as plain values.
        ending: how the solve ended; sentence: details of the ending.
        stations: reached stations with a certificate that holds, in order.
        events: closings and openings of contacts between stations.
        critical: ends of branches.
        gone_over: critical points passed in stages that ask for none; the ``branch`` of a station does not count them.
        seconds: wall time of the whole solve; notes: remarks of the solver.
    """

    solver: str
    scene: str
    settings: Mapping[str, object]
    ending: Ending
    sentence: str
    stations: tuple[StationAnswer, ...]
    events: tuple[Event, ...] = ()
    critical: tuple[Critical, ...] = ()
    gone_over: tuple[GoneOver, ...] = ()
    seconds: float = 0.0
    notes: tuple[str, ...] = field(default=())

    @property
    def completed(self) -> bool:
        """Whether every station was reached and certified."""
        return self.ending is Ending.COMPLETED

    def __repr__(self) -> str:
        """Scene, solver, ending and number of stations."""
        return f"<Answer {self.scene} by {self.solver}: {self.ending.name}, {len(self.stations)} stations>"


def frozen_array(values: object) -> Array:
    """A read-only float copy of ``values``, at least one-dimensional."""
    array = np.array(values, dtype=float, ndmin=1)
    array.setflags(write=False)
    return array


ACTIVE = 1e-9
"""Floor of an active contact's force, over the largest force at the station: round-off leaves far less."""

UNLOADED = 1e-12
"""The same over the natural force, the largest E·I over the square of the longest beam: no load acts below."""


def contact_states(
    names: Iterable[str], forces: PointForces, touching: Mapping[str, Array], natural: tuple[float, float]
) -> Mapping[str, ContactState]:
    """States of the contacts ``names`` by their forces; ``natural`` are the scene's length (m) and force (N).

    A moment counts as a force at the natural length.  Without any forces a contact that touches is active.
    """
    size = np.hypot(forces.force[:, 0], forces.force[:, 1]) + np.abs(forces.moment) / natural[0]
    floor = max(ACTIVE * float(np.max(size, initial=0.0)), UNLOADED * natural[1])
    source, nowhere = np.array(forces.source, dtype=str), frozen_array(np.zeros((0, 2)))
    return {
        name: ContactState(
            bool(size[source == name].sum() > floor) if len(size) else name in touching, touching.get(name, nowhere)
        )
        for name in names
    }


def openings(scene: Scene, stations: Sequence[StationAnswer]) -> tuple[Event, ...]:
    """Events of contacts with forces at a station and without forces at the next station of the same branch.

    Between two stages the interval begins where the stepped load or drive stands before the later stage.
    """
    found, steps = list[Event](), {stage.name: stage.steps for stage in scene.stages}
    for before, after in pairwise(stations):
        if before.branch == after.branch:
            low, high = sorted((scene.values_at(before.stage, before.value).get(steps[after.stage], 0.0), after.value))
            found += [
                Event(after.stage, name, "opens", 0.5 * (low + high), (low, high))
                for name, contact in before.contacts.items()
                if contact.active and not after.contacts[name].active
            ]
    return tuple(found)

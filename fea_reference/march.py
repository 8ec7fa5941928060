"""State of load stepping and a single step: contact closing, stop switching, penalty continuation.

The stepped parameter is a load, a drive or a share of the assembly; λ is its value. ``load`` is its number in
``Model.stepped``.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace

import numpy as np
from scipy.optimize import brentq

from cprbm_scene.answer import Array, Critical, Ending, GoneOver
from cprbm_scene.frozendict import frozendict
from fea_reference.acting import Acting
from fea_reference.advance import advance, path_terms, step_between
from fea_reference.carrying import at_ends
from fea_reference.contact import least_at_ends
from fea_reference.contacts import (
    CLOSED,
    around_end,
    least_gap,
    motion_before_contact,
    motion_before_overlap,
    open_contact,
    passed_through,
    relative_motion,
    resting_pressure,
    touch,
    with_current_sides,
    zones_of,
)
from fea_reference.curvature import all_positive, softest
from fea_reference.face import tip_depth
from fea_reference.model import Model
from fea_reference.newton import Solved, equilibrium
from fea_reference.off_a_corner import slipped_off
from fea_reference.onward import PathTangent, path_tangent
from fea_reference.poised import without_gap_round_off
from fea_reference.settings import Settings
from fea_reference.sinking import Depth, known_depths, with_predicted_depths
from fea_reference.slipping import passed_end
from fea_reference.state import State
from fea_reference.stops import StopPart
from fea_reference.system import System, assemble, load_direction
from fea_reference.touch import LACKING, Circle, Contact, Face, Pair, Penalty, Rigid, Touch
from fea_reference.yielding import ROUND_OFF_DEPTH, SIGNIFICANT, is_point_contact, penetration_effects, point_width

# rad (and lengths): largest difference between equilibrium and prediction; a larger one means another branch
_MAX_CORRECTION = 0.2
_MAX_STEP_RATIO = (
    2.0  # times the last step: longest step for which the last step's change of tangent still helps the predictor
)
_MAX_HIGHER_TERMS = 0.3  # largest share of the first-order motion that the higher-order terms may add
_MAX_ROTATION = 1.0  # rad: rotation of an element's end against its chord; the shallow-arch element is not valid beyond
_TIGHTEN = 100.0  # largest factor for a penalty in a single increase
_POINT_POWER = 2.0  # exponent of this factor for a contact in a point, where the penetration is predictable
_LEAST_FACTOR = 1.03  # smallest factor, tried last
_TIGHTENINGS = 40
_EFFECT_FACTOR = (
    5.0  # times the requested penetration: largest effect of a penetration on other forces and motions, as a share
)
_EXCESSIVE_DEPTH = (
    200.0  # times the allowed penetration: deeper contacts are lost, as their penalties could not be raised
)
_SETTLINGS = 8
_LEAD_TOLERANCE = 1e-5  # relative change of the resting pressure above which the lead is computed again
_NEARBY = (1e-3, 1e-2, 0.1, 0.3, 1.0, 3.0)  # steps: distances at which a closing under tight penalties is sought
_DEEP = 0.1  # thicknesses: penetration above which tight penalties have to push the beams apart first
_PASSING_DEPTH = 1e-3  # shortest elements: additional penetration of a contact about to be passed through
_LONGEST_PATH = 0.5  # thicknesses: longest motion within which no beam passes through another unnoticed
_LIMIT_TOLERANCE = 1e-10  # rad: overrun of an angle limit at the closing of the stop
_FINE_RESIDUAL = 1e-3  # times the accepted residual: aim at a station, where this is above round-off
_FINE_ITERATIONS = 3
_SOFT = 0.1  # times the stiffest penalty that the elements resolve
_STOP_TENSION = 1e-9  # times the largest force or EI/length: tension of a stop at which the stop opens
_DIFFERENCE = 1e-4  # steps: increment for finite-difference rates of gaps
_PATH_ROOTS = 3  # roots sought on the path between equilibria
_INSIDE = 0.01  # closing tolerances: distance from the edge of the tolerance to the value sought
_SWITCH_MARGIN = 1e-8  # rad, or forces: margin within which a stop counts as switched
_AIM = 0.84  # times the requested penetration: aim for a pair of beams, so that the error follows a power law
_STIFFEST = 1e9  # times the stiffest penalty that the elements resolve: upper bound at the penetration of the next line
_STANDARD = 1e-4  # for elements as long as thick; at a tip the bound grows with the square of the ratio of penetrations
# factor of a single increase, and upper bound over the stiffest, where a penalty ends a branch too early
_FIRMER, _FIRMEST = 1e3, 1e9
_PENALTY_TOLERANCE = 0.03  # accepted relative difference between a penalty and the wanted penalty
_SAME = 1e-9  # the same for a circle
_POLISHINGS = 8  # iterations after which a penetration below the requested one is accepted
_POINT_EXPONENT = 1.5  # penalty ∝ penetration to the power −1.5 for a contact in a point
_EXPONENTS = (1.0, 2.0)  # the same exponent in an area, and at a tip
_PASSING_SHARE = (
    0.3  # times the greatest penetration of a contact not yet passed through: a deeper one is about to pass
)
_STIFFER = 10.0  # factor of the penalty for the repeated step
_STIFFENINGS = 3
_LOOSER = (1.0, 0.5)  # shares of the way, in orders of magnitude, from tight penalties to the loosest
_NONE: Mapping[Contact, Touch] = frozendict()

Trouble = tuple[Ending, str]


class StoppedError(Exception):
    """Load stepping cannot continue; internal to this package, turned into the ending of the answer."""

    def __init__(self, ending: Ending, sentence: str) -> None:
        super().__init__(sentence)
        self.ending, self.sentence = ending, sentence


@dataclass(frozen=True, slots=True)
class LastStep:
    """The last step: parameter number ``load``, increment ``by``, higher-order terms of the path.

    With u from −1 at the beginning of the step to 0 at the end, the path is u times the last tangent + ``second`` u²
    + ``third`` u³, (size,) both. ``acting`` and ``contacts`` are the active constraints and the closed contacts at
    the beginning.
    """

    load: int
    by: float
    second: Array
    third: Array
    acting: Acting
    contacts: frozenset[Contact]


@dataclass(frozen=True, slots=True)
class BypassedPoint:
    """A critical point passed although no continuation was requested: the sentence for the user and the record."""

    sentence: str
    record: GoneOver


@dataclass
class March:
    """Current state of load stepping, the only mutable record of the solver.

    Attributes:
        open: contacts that have not closed yet.
        values: dimensionless values of all stepped parameters.
        acting: active pins and stops.
        penalties: penalty of every contact that has closed so far.
        closing: value of the stepped parameter at the first closing of a contact or stop, by name.
        switched: value at the last switch of a stop, by name.
        critical: critical points passed on request.
        bypassed: critical points passed without request.
        iterations: Newton iterations since the last station.
        zones_far: True if zones moved too far between the last stations for tight penalties; the next station then
            starts with loose penalties.
        loosened: True if penalties were loosened after the last tightening.
        known_curvature: last system with a computed smallest curvature, and this curvature.
        last_step: the last step, if the branch continued along it.
        previous_point: parameter number, value and curvature one step before, if watched and with tight penalties.
        least_penalties: lower bounds of penalties up to the next station, by contact, above the bound from the
            penetration.
    """

    model: Model
    settings: Settings
    open: list[Contact]
    values: Array
    system: System
    acting: Acting
    penalties: dict[Contact, Penalty] = field(default_factory=dict)
    closing: dict[str, float] = field(default_factory=dict)
    switched: dict[str, float] = field(default_factory=dict)
    critical: list[Critical] = field(default_factory=list)
    bypassed: list[BypassedPoint] = field(default_factory=list)
    iterations: int = 0
    zones_far: bool = False
    loosened: bool = False
    known_curvature: tuple[System, float] | None = None
    last_step: LastStep | None = None
    previous_point: tuple[int, float, float] | None = None
    least_penalties: dict[str, float] = field(default_factory=dict)

    def points_before(self, load: int) -> list[tuple[float, float]]:
        """Value and curvature one step before, as a list; empty if the step had another parameter than ``load``."""
        if self.previous_point is None or self.previous_point[0] != load or self.previous_point[1] == self.values[load]:
            return []
        return [self.previous_point[1:]]

    @property
    def curvature(self) -> float:
        """Smallest curvature of the potential energy on the feasible directions, computed once per system."""
        if self.known_curvature is None or self.known_curvature[0] is not self.system:
            self.known_curvature = self.system, softest(self.model, self.system).curvature
        return self.known_curvature[1]

    @property
    def is_minimum(self) -> bool:
        """True if the smallest curvature is positive."""
        if self.known_curvature is None or self.known_curvature[0] is not self.system:
            return all_positive(self.model, self.system)
        return self.known_curvature[1] > 0.0

    @property
    def penetrations_bounded(self) -> bool:
        """True if no penetration is far above the allowed one, so that penalties could be tightened."""
        allowed = self.allowed()
        return all(
            contact.penetration <= _EXCESSIVE_DEPTH * allowed.get(contact.pair, np.inf)
            for contact in self.system.touches
        )

    @property
    def largest_axial_force(self) -> float:
        """Largest axial force."""
        return float(np.abs(self.system.z[self.model.element_dofs[6]]).max())

    def saved(self) -> March:
        """Copy of the state, for :meth:`restore`."""
        return replace(
            self,
            open=list(self.open),
            values=self.values.copy(),
            penalties=dict(self.penalties),
            closing=dict(self.closing),
            switched=dict(self.switched),
            critical=list(self.critical),
            bypassed=list(self.bypassed),
        )

    def restore(self, saved: March) -> None:
        """Return to a saved state, except for the count of iterations; the copy stays usable."""
        self.open, self.values, self.system, self.acting = (
            list(saved.open),
            saved.values.copy(),
            saved.system,
            saved.acting,
        )
        self.penalties, self.closing, self.switched = dict(saved.penalties), dict(saved.closing), dict(saved.switched)
        self.zones_far, self.loosened, self.previous_point = saved.zones_far, saved.loosened, saved.previous_point

    def rate(self, load: int, system: System | None = None) -> Array:
        """Path tangent dz/dλ (size,) of this or another ``system``; zero if the stiffness matrix is singular."""
        system = system or self.system
        rate = system.solve(load_direction(self.model, load, system.z, self.acting))
        return np.zeros(self.model.size) if rate is None else rate

    def path_tangent(self, load: int, rate: Array, target: float) -> PathTangent:
        """Path tangent towards ``target`` with the contacts that begin to press.

        ``rate`` (size,) is the path tangent without these contacts.
        """
        sense = float(np.sign(target - self.values[load]))
        return path_tangent(self.model, self.system, self.penalties, self.settings.quadrature, rate, sense)

    def _equilibrium(
        self,
        penalties: Mapping[Contact, Penalty],
        values: Array,
        z: State,
        depths: Mapping[Contact, float],
        pushes: Mapping[Contact, Array],
        settings: Settings | None = None,
    ) -> Solved:
        """Equilibrium near ``z`` with the current constraints, see :func:`fea_reference.newton.equilibrium`."""
        solved = equilibrium(self.model, settings or self.settings, penalties, values, z, self.acting, depths, pushes)
        self.iterations += solved.iterations
        return solved

    def solve(
        self, load: int, value: float, z: State, starting_contacts: Mapping[Contact, Touch] = _NONE
    ) -> System | None:
        """Equilibrium at ``value`` from the start ``z``; None if Newton's method fails.

        ``starting_contacts`` begin to press in the start state.
        """
        values = self.values.copy()
        values[load] = value
        depths = self.depths() | {
            pair: contact.penetration for pair, contact in starting_contacts.items() if isinstance(pair, Pair)
        }
        pushes = self.pushes() | {pair: contact.pushes for pair, contact in starting_contacts.items()}
        solved = self._equilibrium(self.penalties, values, z, depths, pushes)
        return (
            solved.system
            if solved.converged
            else self._without_pulling_contact(values, step_between(self.model, self.system.z, z))
        )

    def _without_pulling_contact(self, values: Array, predicted: Array) -> System | None:
        """Equilibrium under ``values`` without a contact predicted to be in tension; None if there is none.

        A beam lying on a surface lifts off place by place, and Newton's active set may cycle. A solution without the
        contact is accepted if it has no overlap.
        """
        for contact in (
            contact
            for contact in self.system.touches
            if contact.closed and contact.predicted_forces(predicted).sum() <= 0.0
        ):
            remaining = {pair: penalty for pair, penalty in self.penalties.items() if pair is not contact.pair}
            solved = self._equilibrium(remaining, values, self.system.z, self.depths(), self.pushes())
            if solved.converged and zones_of(self.model, contact.pair, solved.system.z).least >= 0.0:
                z = solved.system.z
                return assemble(self.model, self.penalties, self.settings.quadrature, values, z, self.acting)
        return None

    def step(self, load: int, value: float, tangent: PathTangent) -> Trouble | None:
        """Step to ``value``, or to the first change of a contact or stop; the reason of a failure, else None."""
        penalties = dict(self.penalties)
        self.update_sides()
        before, start = self.system.z, float(self.values[load])
        predicted = advance(self.model, before, self._predicted_step(load, value - start, tangent.rate))
        predicted, starting_contacts = self._with_point_forces(tangent, penalties, predicted, value - start)
        system = self.solve(load, value, predicted, starting_contacts)
        for _ in range(_STIFFENINGS):
            stiffer = self.stiffer_penalties(system) if system is not None else {}
            if not stiffer:
                break
            self.penalties.update(stiffer)
            system = self.solve(load, value, predicted)
        if system is not None and self._include_overlapping_ends(system):
            self.reassemble()
            system = self.solve(load, value, predicted)
        if system is None:
            return (
                Ending.STEP_TOO_SMALL,
                f"Newton's method finds no equilibrium beyond {self.described(load, start)}",
            )
        if self.largest_motion(system, predicted) > _MAX_CORRECTION:
            return (
                Ending.STEP_TOO_SMALL,
                f"beyond {self.described(load, start)} the nearest equilibrium is on another branch",
            )
        touched, opened = self.least_gap(system) < 0.0, self.open
        changing = [stop for stop in self.model.stops if self.stop_margin(stop, system) < 0.0]
        if touched:
            known = {start: self.system, value: system}
            first_touch = self._first_touch(load, known)
            if first_touch is None:
                return (
                    Ending.STEP_TOO_SMALL,
                    f"the closing of a contact or stop beyond {self.described(load, start)} was not found",
                )
            value, system = first_touch
            last, opened = self._before_side_change(known, value)
            if opened != self.open:
                value, system, touched = last, known[last], False
            alternating = [stop.known_as for stop in changing if self.switched.get(stop.name) == value]
            if alternating:
                return (
                    Ending.STEP_TOO_SMALL,
                    f"beyond {self.described(load, start)} {alternating[0]} alternates between open and closed",
                )
        where = f"beyond {self.described(load, start)}"
        trouble = self.passing_failure(before, system, where) or self.slip_failure(system, where)
        if trouble is not None:
            return trouble
        self.values[load], self.system, self.open = value, system, opened
        self.exchange_beams()
        if touched:
            self._close_tightly(load, value - start)
            self.close_touching(load, value - start)
            self.switch_stops(load, changing)
        return None

    def _before_side_change(self, known: Mapping[float, System], value: float) -> tuple[float, list[Contact]]:
        """Last value before an overlap at ``value``, and the open contacts with the sides beyond the ends passed there.

        A closing starts without overlap. A point that faces another beam from the far side, around an end, has a gap
        as negative as its distance and is no closing.
        """
        without_overlap = (lam for lam in known if self.least_gap(known[lam]) >= 0.0)
        last = min(without_overlap, key=lambda lam: abs(lam - value), default=value)
        return last, [around_end(self.model, pair, known[last].z, known[value].z) for pair in self.open]

    def _with_point_forces(
        self, tangent: PathTangent, penalties: Mapping[Contact, Penalty], z: State, step: float
    ) -> tuple[State, dict[Contact, Touch]]:
        """Predicted state near ``z`` with the predicted point forces, and the contacts that begin to press.

        ``step`` is the increment of λ.
        """
        model, quadrature, motion = self.model, self.settings.quadrature, step * tangent.rate
        pressing = [contact for contact in self.system.touches if contact.push > 0.0]
        known = known_depths(self.system, {contact.pair: contact.penetration for contact in pressing}, self.pushes())
        predicted = {contact.pair: contact.predicted_forces(motion) for contact in pressing}
        for pair, push in tangent.pushes.items():
            known[pair] = Depth(self.settings.penetration * pair.scale, push * step)
            predicted[pair] = np.array([push * step])
        z = with_predicted_depths(model, penalties, quadrature, tangent.system, z, predicted, known)
        starting_contacts = (touch(model, pair, penalties[pair], quadrature, z) for pair in tangent.pushes)
        return z, {contact.pair: contact for contact in starting_contacts if contact.closed}

    def step_record(self, load: int, before: March, rate: Array, ahead: Array) -> LastStep:
        """Record of the step from ``before`` to the current state, with path tangents ``rate`` and ``ahead`` (size,).

        Both states have the penalties of the step: motions due to a later tightening do not belong to the path.
        """
        by = float(self.values[load] - before.values[load])
        second, third = path_terms(self.model, before.system.z, self.system.z, (rate, ahead), by)
        return LastStep(load, by, second, third, before.acting, frozenset(before.penalties))

    def stiffer_penalties(self, system: System) -> dict[Contact, Penalty]:
        """Stiffer penalties for contacts that are too deep; empty if all have their stiffest penalty.

        A circle's penalty never exceeds its value at a station, determined by the penetration in a point.
        """
        deep = {contact: self.penalties[contact].stiffness for contact in _too_deep(self.model, system)}
        wide = {
            contact.pair
            for contact in system.touches
            if isinstance(contact.pair, Circle) and not is_point_contact(self.model, contact)
        }
        limits = {contact: contact.stiffest if contact in wide else np.inf for contact in deep}
        return {
            contact: Penalty(min(_STIFFER * now, limits[contact]))
            for contact, now in deep.items()
            if now < limits[contact]
        }

    def _overlaps_more(self, system: System) -> bool:
        """True if a contact that is open now overlaps in ``system``: no step could start from there."""
        gaps = zip(self.gaps(self.system), self.gaps(system), strict=True)
        return any(after < 0.0 <= before for before, after in gaps)

    def _passed_rigid_body(self, system: System) -> bool:
        """True if ``system``, with other penalties, lies beyond a rigid body or a corner that presses now."""
        rigid = (pair for pair in self.penalties if isinstance(pair, Rigid))
        passed = any(passed_through(self.model, pair, self.system.z, system.z) for pair in rigid)
        return passed or any(slipped_off(self.model, touch, self.system.z, system.z) for touch in self.system.touches)

    def _predicted_step(self, load: int, step: float, rate: Array) -> Array:
        """Predicted motion (size,) for a ``step`` in λ: third order if the last step applies, else first order."""
        first, last_step = step * rate, self.last_step
        if last_step is None or last_step.load != load or last_step.acting is not self.acting:
            return first
        if last_step.contacts != frozenset(self.penalties) or not abs(step) <= _MAX_STEP_RATIO * abs(last_step.by):
            return first
        u = step / last_step.by
        higher = u**2 * last_step.second + u**3 * last_step.third
        bent, straight = (float(np.abs(motion[self.model.moving]).max()) for motion in (higher, first))
        return first + higher if bent <= _MAX_HIGHER_TERMS * straight else first

    def passing_failure(self, before: State, system: System, where: str) -> Trouble | None:
        """Failure if bodies passed through each other, or an element turned too far, since ``before``; else None."""
        pressing = {contact.pair for contact in system.touches if contact.closed}
        for pair in (*self.open, *self.penalties):
            if isinstance(pair, Face):
                continue  # a Face is tested in the frame of its body, below
            least, touching = zones_of(self.model, pair, system.z).least, CLOSED * pair.scale
            # an overlap of a contact that does not press yet is about to close; a contact that pressed has been passed
            # through
            if pair in pressing or (abs(least) if pair in self.penalties else least) <= touching:
                continue
            if self._overlapped_between(pair, before, system.z):
                return Ending.BEAMS_CROSSED, f"{where} a beam passes through the opposite body in contact {pair.name}"
        turned = float(np.abs(system.elements.rotation).max())
        if turned > _MAX_ROTATION:
            return Ending.TURNED_TOO_FAR, f"{where} an element turns by {turned:.2f} rad: take more elements"
        for pair in (*self.open, *self.penalties):
            if passed_through(self.model, pair, before, system.z):
                return Ending.BEAMS_CROSSED, f"{where} a beam passes through the opposite body in contact {pair.name}"
        return None

    def slip_failure(self, system: System, where: str) -> Trouble | None:
        """Failure if a pressing end slipped off another beam's end or off a corner before ``system``; else None."""
        for contact in self.system.touches:
            if slipped_off(self.model, contact, self.system.z, system.z):
                return Ending.STEP_TOO_SMALL, f"{where} a beam's end slips off a corner in contact {contact.pair.name}"
            if passed_end(self.model, contact, self.system.z, system.z):
                return (
                    Ending.STEP_TOO_SMALL,
                    f"{where} a beam's end slips off the other beam in contact {contact.pair.name}",
                )
        return None

    def stop_margin(self, stop: StopPart, system: System) -> float:
        """Margin (rad) of an open stop to its limit, or dimensionless margin of a closed stop to its opening."""
        if not self.acting.stopping:
            return np.inf
        limit = self.acting.limits.get(stop.name)
        if limit is None:
            return stop.margin(system.z)[0] + _LIMIT_TOLERANCE
        # the largest force may be the stop's own, which vanishes where the stop opens
        return stop.press(system.z, limit) / max(1.0, system.scale) + _STOP_TENSION

    def switch_stops(self, load: int, changing: Iterable[StopPart]) -> None:
        """Close or open the stops among ``changing`` that have reached their margin."""
        arrived = [stop for stop in changing if self.stop_margin(stop, self.system) <= _SWITCH_MARGIN]
        for stop in arrived:
            self.switched[stop.name] = float(self.values[load])
            self.toggle_stop(stop, load, self.system)
        if arrived:
            self.reassemble()

    def toggle_stop(self, stop: StopPart, load: int, system: System) -> None:
        """Open a closed stop; close an open stop at the limit nearest in ``system``."""
        if stop.name in self.acting.limits:
            self.acting = self.acting.released(stop.name)
        else:
            self.acting = self.acting.stopped(stop.name, stop.margin(system.z)[1])
            self.closing.setdefault(stop.known_as, self.value(load))

    def constrain(self, acting: Acting) -> None:
        """Change the active constraints without motion."""
        self.acting = acting
        self.reassemble()

    def reassemble(self) -> None:
        """Assemble the system again with the current constraints and penalties, in the same state."""
        self.system = assemble(
            self.model, self.penalties, self.settings.quadrature, self.values, self.system.z, self.acting
        )

    def update_sides(self) -> None:
        """Update the sides of all open contacts, and the sides of self-contacts, from the current state."""
        model, z = self.model, self.system.z
        self.open = [open_contact(model, pair, z) for pair in self.open]
        self.penalties = {with_current_sides(model, pair, z): penalty for pair, penalty in self.penalties.items()}

    def value(self, load: int) -> float:
        """Value of a stepped parameter in SI units."""
        return float(self.values[load]) * self.model.stepped[load].unit

    def _overlapped_between(self, pair: Contact, before: State, after: State) -> bool:
        """True if an open contact overlaps on the straight way between two states, deeper than before.

        An overlap deeper than a few elements counts as the far side of a bent beam. A beam that passes the end of
        another in a single step may therefore end open behind the other beam.
        """
        path = after.values - before.values
        largest_motion = float(np.abs(path[self.model.moving]).max())
        least = zones_of(self.model, pair, before).least
        if least > 2.0 * largest_motion:
            return False
        deepest = least - _PASSING_DEPTH * self._shortest_element if least < 0.0 else 0.0
        thick = min(pair.distance, pair.scale) if isinstance(pair, Pair) else 0.0
        parts = max(2, int(np.ceil(largest_motion / max(self._shortest_element, _LONGEST_PATH * thick))))
        pace = relative_motion(self.model, pair, before, after) / parts

        def overlaps(first: int, last: int) -> bool:
            """Recursive bisection between two subdivision points; a gap larger than the motion excludes overlap."""
            if last - first < 2:
                return False
            middle = (first + last) // 2
            state = State.of(before.values + middle / parts * path)
            if motion_before_contact(self.model, pair, state) > pace * (last - middle):
                return False
            if zones_of(self.model, pair, state).least < deepest:
                return True
            if motion_before_overlap(self.model, pair, state) > pace * (last - middle):
                return False
            return overlaps(first, middle) or overlaps(middle, last)

        return overlaps(0, parts)

    @property
    def _shortest_element(self) -> float:
        return min(float(self.model.line(beam, self.model.start).lengths.min()) for beam in self.model.beams)

    def _first_touch(self, load: int, known: dict[float, System]) -> tuple[float, System] | None:
        """Value and equilibrium at the first zero of a gap or stop margin; None if none is found.

        ``known`` has two equilibria by value, before and beyond the zero, and gets all further ones. The root of a
        single smooth gap is sought, first of the gap with the earliest zero on a straight line.
        """

        def gaps(value: float) -> list[float]:
            if value not in known:
                low, high = max(v for v in known if v < value), min(v for v in known if v > value)
                system = self.solve(load, value, self._path(load, known, low, high)(value))
                if system is None:
                    raise ArithmeticError
                known[value] = system
            return self.gaps(known[value])

        def sought(value: float, which: int, path: Callable[[float], State] | None) -> float:
            # a gap within half the closing tolerance counts as zero; the aim lies inside the tolerance, because beyond
            # its edge an end without thickness would be on the other side
            gap = (gaps(value) if path is None or value in known else self.gaps(replace(self.system, z=path(value))))[
                which
            ]
            return 0.0 if 0.0 <= gap <= 0.5 * tolerances[which] else gap - _INSIDE * tolerances[which]

        def root_between(low: float, high: float, which: int) -> float:
            # first on the path between two equilibria, where a gap costs no equilibrium
            for _ in range(_PATH_ROOTS):
                path = self._path(load, known, low, high)
                root = float(brentq(sought, low, high, (which, path), xtol=xtol, rtol=1e-11))
                there = sought(root, which, None)
                if there == 0.0:
                    return root
                low, high = (root, high) if there > 0.0 else (low, root)
            return float(brentq(sought, low, high, (which, None), xtol=xtol, rtol=1e-11))

        tolerances = [*(CLOSED * pair.scale for pair in self.open), *(_SWITCH_MARGIN for _ in self.model.stops)]
        clear, beyond = sorted(known, key=lambda value: min(gaps(value)), reverse=True)
        xtol = 1e-11 * max(abs(clear), abs(beyond))
        try:
            for _ in gaps(clear):
                pairs = list(zip(gaps(clear), gaps(beyond), strict=True))
                first = min((i for i, pair in enumerate(pairs) if pair[1] < 0.0), key=lambda i: _straight(*pairs[i]))
                root = root_between(clear, beyond, first)
                if gaps(root)[first] > tolerances[first]:  # a jump: the overlap is visible only beyond a certain size
                    over = [value for value in known if gaps(value)[first] <= 0.0]
                    root = over[int(np.argmin(np.abs(np.array(over) - root)))]
                if min((*gaps(root)[:first], *gaps(root)[first + 1 :]), default=0.0) >= 0.0:
                    return root, known[root]
                beyond = root
        except (ArithmeticError, ValueError):
            return None
        return None

    def _path(self, load: int, known: Mapping[float, System], low: float, high: float) -> Callable[[float], State]:
        """Predicted state by value between two known equilibria, a Hermite cubic from their path tangents."""
        before, after = known[low], known[high]
        rates = self.rate(load, before), self.rate(load, after)
        second, third = path_terms(self.model, before.z, after.z, rates, high - low)
        terms = np.array([third, second, (high - low) * rates[1], np.zeros(self.model.size)])
        return lambda value: advance(self.model, after.z, np.polyval(terms, (value - high) / (high - low)))

    def _close_tightly(self, load: int, increment: float) -> None:
        """Tighten the other penalties after a closing and locate the closing again.

        Penetration under loose penalties shifts a closing. ``increment`` is the step in λ. Without a new location an
        open contact stays open.
        """
        loose = dict(self.penalties)
        self.tighten()
        if self.penalties == loose:
            return
        value, gap = float(self.values[load]), self.least_gap(self.system)
        for share in _NEARBY:
            other = value + np.copysign(share, gap) * increment
            beyond = self.solve(load, other, advance(self.model, self.system.z, (other - value) * self.rate(load)))
            if beyond is None:
                return
            if self.least_gap(beyond) * gap <= 0.0:
                closing = self._first_touch(load, {value: self.system, other: beyond})
                if closing is not None:
                    self.values[load], self.system = closing
                return

    def gaps(self, system: System) -> list[float]:
        """Gaps of all open contacts, then margins of all stops."""
        gaps = [least_gap(self.model, pair, system.z) for pair in self.open]
        return [*gaps, *(self.stop_margin(stop, system) for stop in self.model.stops)]

    def least_gap(self, system: System) -> float:
        """The least value of :meth:`gaps`."""
        return min(self.gaps(system), default=np.inf)

    def close_touching(self, load: int, increment: float = 0.0) -> None:
        """Close every open contact with a vanishing gap; ``increment`` is the last step in λ."""
        z = self.system.z
        closing = [p for p in self.open if least_gap(self.model, p, z) <= CLOSED * p.scale]
        for pair in closing:
            self.open.remove(pair)
            # an end that touches has to belong to the first beam
            unseen = zones_of(self.model, pair, z).least > CLOSED * pair.scale
            closed = pair.exchanged() if unseen and isinstance(pair, Pair) else pair
            self.penalties[closed] = Penalty(pair.stiffness)
            remainder = self._increment_to_zero_gap(load, pair, increment) * self.model.stepped[load].unit
            self.closing.setdefault(pair.name, self.value(load) + remainder)
        if closing:
            self.reassemble()

    def _increment_to_zero_gap(self, load: int, pair: Contact, increment: float) -> float:
        """Increment of λ to the exact zero of a gap within the closing tolerance, by the current rate of the gap."""
        step = _DIFFERENCE * increment
        moved_state = advance(self.model, self.system.z, step * self.rate(load))
        here, gap_there = (least_gap(self.model, pair, z) for z in (self.system.z, moved_state))
        return step * here / (here - gap_there) if 0.0 < here < (here - gap_there) / _DIFFERENCE else 0.0

    def loosen(self, *kinds: type[Contact]) -> bool:
        """Lower the penalties of contacts of the given ``kinds``, as far as possible; True on success.

        Zone ends move by a layer's width per iteration, so that loose penalties move them faster. A failure is an
        excessive penetration, a slip or a new overlap. Most pairs of beams touch in a point, whose zone is found
        anyway.
        """
        return any(self._loosened(kinds, share) for share in _LOOSER)

    def _loosened(self, kinds: tuple[type[Contact], ...], share: float) -> bool:
        """Lower penalties by a ``share`` of the way to the loosest, in orders of magnitude; True on success."""
        looser = {
            pair: Penalty(now.stiffness ** (1.0 - share) * pair.loosest**share)
            if isinstance(pair, kinds) and pair.loosest < now.stiffness
            else now
            for pair, now in self.penalties.items()
        }
        if looser == self.penalties:
            return False
        solved = self._equilibrium(looser, self.values, self.system.z, self.depths(), self.pushes())
        if not solved.converged or _too_deep(self.model, solved.system) or self._overlaps_more(solved.system):
            return False
        contact_lost = self._passed_rigid_body(solved.system) or self.slip_failure(solved.system, "") is not None
        if self.largest_motion(solved.system, self.system.z) <= _MAX_CORRECTION and not contact_lost:
            self.system, self.penalties, self.loosened = solved.system, looser, True
            self.exchange_beams()
            return True
        return False

    def exchange_beams(self) -> None:
        """Exchange the beams of a pair where an end of the second presses.

        The gap function sees ends of the first beam only. If ends of both beams press, the zones at an end are
        integrated along the beam of this end. The pair returns to a single integral when only one beam's ends press.
        """
        for contact in self.system.touches:
            pair, missing_share = contact.pair, contact.missing_share
            if not isinstance(pair, Pair) or pair.roles is not None:
                continue
            if (
                pair.carried
                and contact.closed
                and missing_share <= LACKING
                and (single := self._as_single_integral(contact, pair)) is not None
            ):
                solved = self._with_replaced_pair(pair, single)
                if solved is not None and all(renewed.missing_share <= LACKING for renewed in solved[0].touches):
                    self.system, self.penalties = solved
                continue
            about = pair.exchanged()
            for other in (about, replace(pair, carried=pair.ends_m), replace(about, carried=about.ends_m)):
                if missing_share <= LACKING:
                    break
                if other != pair and (solved := self._with_replaced_pair(pair, other)) is not None:
                    reduced_share = next(
                        (renewed.missing_share for renewed in solved[0].touches if renewed.pair == other), 0.0
                    )
                    if reduced_share < missing_share:
                        (self.system, self.penalties), pair, missing_share = solved, other, reduced_share

    def _include_overlapping_ends(self, system: System) -> bool:
        """Include beam ends that overlap in ``system`` but are missing in the pair's integral; True if there are any.

        Measured along the other beam, such an end is oblique: its contact would start later and deeper than normal to
        the beam's side.
        """
        extended: dict[Contact, Contact] = {}
        for contact in system.touches:
            pair, z = contact.pair, system.z
            if not isinstance(pair, Pair) or pair.roles is not None or pair.carried or not contact.closed:
                continue
            last, last_m = (self.model.line(self.model.beams[i], z).n for i in (pair.first, pair.second))
            if at_ends(contact.zones.zeta_m, last_m) or least_at_ends(self.model, pair, z) >= -CLOSED * pair.scale:
                continue
            extended[pair] = (
                replace(pair, carried=pair.ends_m) if at_ends(contact.zones.intervals, last) else pair.exchanged()
            )
        self.penalties = {extended.get(pair, pair): penalty for pair, penalty in self.penalties.items()}
        return bool(extended)

    def _as_single_integral(self, contact: Touch, pair: Pair) -> Pair | None:
        """The pair as integrated along the only beam with pressing ends; None if ends of both beams press."""
        last, last_m = (self.model.line(self.model.beams[i], self.system.z).n for i in (pair.first, pair.second))
        if not at_ends(contact.zones.intervals, last):
            return pair.exchanged()
        return None if at_ends(contact.zones.zeta_m, last_m) else replace(pair, carried=())

    def _with_replaced_pair(self, pair: Pair, other: Pair) -> tuple[System, dict[Contact, Penalty]] | None:
        """Equilibrium and penalties with ``pair`` replaced by ``other``; None if the state would change."""
        penalties = {other if key == pair else key: penalty for key, penalty in self.penalties.items()}
        depths = {other if key == pair else key: depth for key, depth in self.depths().items()}
        pushes = {key: push for key, push in self.pushes().items() if key != pair}
        solved = self._equilibrium(penalties, self.values, self.system.z, depths, pushes)
        if not solved.converged or self.largest_motion(solved.system, self.system.z) > _MAX_CORRECTION:
            return None
        return solved.system, penalties

    def zones(self) -> dict[Contact, Array]:
        """First and last place ζ of every closed contact with a rigid body, (2,)."""
        return {
            contact.pair: np.array([contact.zones.intervals.min(), contact.zones.intervals.max()])
            for contact in self.system.touches
            if isinstance(contact.pair, Rigid) and contact.closed
        }

    def tighten(self) -> None:
        """Penalty continuation: change penalties until every contact has its intended penetration.

        A contact in a point starts at a depth with the same force, which saves iterations of a large change. Such
        pairs of beams are held active meanwhile: a motion above their depth would open them or multiply their force.
        """
        self.loosened = False
        most = _TIGHTEN
        falls: dict[Contact, float] = {}
        for tries in range(_TIGHTENINGS):
            allowed = self.allowed()
            factors = {
                contact.pair: self._penalty_factor(
                    contact, falls.get(contact.pair, _POINT_EXPONENT), allowed.get(contact.pair)
                )
                for contact in self.system.touches
            }
            pressures = {
                contact.pair: resting_pressure(self.model, contact, self.system.z) for contact in self.system.touches
            }
            done = all(
                self._penalty_accepted(contact, factors[contact.pair], tries, allowed.get(contact.pair))
                for contact in self.system.touches
            )
            if done and not self._leads_outdated(pressures):
                return
            tighter = dict(self.penalties)
            depths: dict[Contact, float] = {}
            held_depths: dict[Contact, float] = {}
            for contact in self.system.touches:
                narrow = contact.closed and np.ptp(contact.zones.intervals) < point_width(self.model, contact)
                limit = most**_POINT_POWER if narrow else most
                factor = min(max(factors[contact.pair], 1.0 / limit), limit)
                stiffness = factor * self.penalties[contact.pair].stiffness
                tighter[contact.pair] = Penalty(stiffness, pressures[contact.pair] / stiffness)
                depths[contact.pair] = contact.penetration * factor ** (-1.0 / falls.get(contact.pair, _POINT_EXPONENT))
                if narrow and isinstance(contact.pair, Pair):
                    held_depths[contact.pair] = depths[contact.pair]
            pushes = self.pushes()
            known = known_depths(self.system, depths, pushes)
            z = with_predicted_depths(
                self.model, tighter, self.settings.quadrature, self.system, self.system.z, pushes, known
            )
            solved = self._equilibrium(tighter, self.values, z, held_depths, pushes)
            # under a soft contact a strut is straight: a stiffer contact must not jump over the bent states
            near = (
                solved.converged
                and self.largest_motion(solved.system, self.system.z) <= _MAX_CORRECTION
                and (all_positive(self.model, solved.system) or not self.is_minimum)
            )
            if near and not self._passed_rigid_body(solved.system):
                falls = self._penetration_exponents(solved.system, tighter)
                self.system, self.penalties = solved.system, tighter
                most = min(most**1.5, _TIGHTEN)
            else:
                if most <= _LEAST_FACTOR:
                    return  # the next attempt would be identical
                tried = max(max(factor, 1.0 / factor) for factor in factors.values())
                most = max(min(most, tried) ** 0.4, _LEAST_FACTOR)

    def raise_penalty(self, name: str) -> bool:
        """Hold a contact by a far stiffer penalty up to the next station; True if this was possible."""
        pair = next(pair for pair in self.penalties if pair.name == name)
        stiffness = _FIRMER * self.penalties[pair].stiffness
        if stiffness > _FIRMEST * pair.stiffest:
            return False
        self.least_penalties[name] = stiffness
        self.tighten()
        return self.penalties[pair].stiffness >= (1.0 - _PENALTY_TOLERANCE) * stiffness

    def has_soft_penalty(self) -> bool:
        """True if a closed contact has a penalty far below the stiffest that the elements resolve."""
        return any(
            contact.closed and self.penalties[contact.pair].stiffness < _SOFT * contact.pair.stiffest
            for contact in self.system.touches
        )

    def has_deep_pair(self) -> bool:
        """True if contacts are so deep under the current penalties that the next step might pass through."""
        return self.has_deep_tip() or any(
            isinstance(contact.pair, Pair) and contact.penetration > _DEEP * contact.pair.scale
            for contact in self.system.touches
        )

    def has_deep_tip(self) -> bool:
        """True if a tip of a rigid edge has cut deep into a beam: no further step may find an equilibrium there."""
        faces = (contact.pair for contact in self.system.touches if isinstance(contact.pair, Face) and contact.closed)
        return any(tip_depth(self.model, face, self.system.z) > _DEEP * face.scale for face in faces)

    def settle(self, load: int) -> None:
        """Tighten penalties and switch stops until both are consistent.

        Beside an end held on an edge, the stop and the contact pressure share a moment in proportion to their
        stiffness.
        """
        for _ in range(_SETTLINGS):
            self.tighten()
            if self._close_what_overlaps(load):
                continue
            changing = [stop for stop in self.model.stops if self.stop_margin(stop, self.system) < 0.0]
            if not changing:
                return
            before, closing = self.acting, dict(self.closing)
            for stop in changing:
                self.toggle_stop(stop, load, self.system)
            system = self.solve(load, float(self.values[load]), self.system.z)
            if system is None or self.largest_motion(system, self.system.z) > _MAX_CORRECTION:
                self.acting, self.closing = before, closing
                return
            self.system = system

    def _close_what_overlaps(self, load: int) -> bool:
        """Close open contacts that overlap under tight penalties only; True if there are any."""
        z = self.system.z
        closing = [pair for pair in self.open if least_gap(self.model, pair, z) < 0.0]
        if not closing:
            return False
        there = self.saved()
        for pair in closing:
            self.open.remove(pair)
            self.penalties[pair] = Penalty(pair.stiffness)
            self.closing.setdefault(pair.name, self.value(load))
        system = self.solve(load, float(self.values[load]), z)
        if system is None or self.largest_motion(system, z) > _MAX_CORRECTION:
            self.restore(there)
            return False
        self.system = system
        return True

    def iterate_to_round_off(self) -> None:
        """Iterate the residual down to round-off, if a few iterations suffice.

        The accepted residual is relative to the largest element force, which may exceed the loads a hundredfold.
        """
        settings = replace(
            self.settings, residual=_FINE_RESIDUAL * self.settings.residual, newton_limit=_FINE_ITERATIONS
        )
        system = self.system
        if float(np.abs(system.residual).max()) > max(settings.residual * system.scale, system.floor):
            solved = self._equilibrium(self.penalties, self.values, system.z, self.depths(), self.pushes(), settings)
            if solved.converged and self.largest_motion(solved.system, system.z) <= _FINE_RESIDUAL:
                self.system = solved.system

    def remove_gap_round_off(self) -> None:
        """Remove the round-off of gaps times a stiff penalty from the residual, if the forces exceed round-off."""
        accepted = self.settings.residual * self.system.scale
        if self.system.significant and float(np.abs(self.system.residual).max()) > accepted:
            self.system = without_gap_round_off(self.model, self.values, self.system, accepted)

    def allowed(self) -> dict[Contact, float]:
        """Allowed penetration by contact, from the requested penetration or from the effect on other forces.

        For contacts with smooth rigid surfaces only the effect counts; a contact without an entry has no bound.
        """
        system, settings = self.system, self.settings
        effects = penetration_effects(self.model, system, self.penalties, self.open, settings.quadrature)
        felt_at_most = min(_EFFECT_FACTOR * settings.penetration, SIGNIFICANT)
        depths: dict[Contact, float] = {}
        for contact in system.touches:
            if not contact.closed:
                continue
            depth = (
                settings.penetration * contact.pair.scale if isinstance(contact.pair, Pair) or contact.sharp else np.inf
            )
            if (share := effects.get(contact.pair, 0.0)) > 0.0:
                reduced_depth = contact.penetration * max(felt_at_most / share, 1.0 / _TIGHTEN)
                depth = min(depth, max(reduced_depth, ROUND_OFF_DEPTH))
            if np.isfinite(depth):
                depths[contact.pair] = depth
        return depths

    def _penalty_factor(self, contact: Touch, fall: float, allowed: float | None) -> float:
        """Factor of a penalty for the penetration ``allowed``, and at least for the stiffness required at a station.

        The penetration goes with the penalty to the power −1/``fall``: −2/3 in a point between sides, −1/2 at a tip,
        −1 in an area. On a smooth rigid surface the penalty is constant: beyond the resolution of the elements a
        stiffer penalty costs more accuracy than its penetration.
        """
        least = (
            max(contact.pair.stiffest, self.least_penalties.get(contact.pair.name, 0.0))
            / self.penalties[contact.pair].stiffness
        )
        if not contact.closed:
            return 1.0
        if allowed is None:
            return max(1.0, least)
        aim = _AIM * allowed
        # a penetration above this bound belongs to a body that was passed through
        slender = max(1.0, self._shortest_element / contact.pair.scale)
        most = _STIFFEST * (slender * _STANDARD / self.settings.penetration) ** _EXPONENTS[1] * least
        return float(min(max((contact.penetration / aim) ** fall, least), most))

    def _penalty_accepted(self, contact: Touch, factor: float, tries: int, allowed: float | None) -> bool:
        """True if a penalty needs no change; after several iterations a pair's penalty may be too stiff."""
        if allowed is None:
            return factor <= 1.0 + _SAME
        if abs(factor - 1.0) <= _PENALTY_TOLERANCE:
            return True
        enough = contact.penetration <= allowed
        stiff = contact.pair.stiffest <= (1.0 + _PENALTY_TOLERANCE) * self.penalties[contact.pair].stiffness
        return tries >= _POLISHINGS and enough and stiff

    def _penetration_exponents(self, system: System, tighter: Mapping[Contact, Penalty]) -> dict[Contact, float]:
        """Exponents −Δln ε/Δln depth of the penetration, from current to ``tighter`` penalties of ``system``."""
        before = {contact.pair: contact.penetration for contact in self.system.touches}
        exponents = {}
        for contact in system.touches:
            factor = tighter[contact.pair].stiffness / self.penalties[contact.pair].stiffness
            share = contact.penetration / before[contact.pair] if before[contact.pair] > 0.0 else 0.0
            if share > 0.0 and abs(np.log(share)) > _PENALTY_TOLERANCE:
                exponents[contact.pair] = float(np.clip(-np.log(factor) / np.log(share), *_EXPONENTS))
        return exponents

    def _leads_outdated(self, pressures: Mapping[Contact, float]) -> bool:
        """True if a lead differs from the lead of the current axial forces."""
        return any(
            abs(pressure / self.penalties[pair].stiffness - self.penalties[pair].lead)
            > _LEAD_TOLERANCE * max(pressure / self.penalties[pair].stiffness, self.settings.penetration * pair.scale)
            for pair, pressure in pressures.items()
        )

    def depths(self) -> dict[Contact, float]:
        """Penetrations of closed pairs of beams; the allowed penetration for pairs that do not press yet.

        A contact whose zone is still sought is left out: its penalty is soft enough to open.
        """
        allowed = self.settings.penetration
        return {
            contact.pair: contact.penetration if contact.push > 0.0 else allowed * contact.pair.scale
            for contact in self.system.touches
            if isinstance(contact.pair, Pair)
            and contact.zones.least <= CLOSED * contact.pair.scale
            and self.penalties[contact.pair].stiffness >= contact.pair.stiffness
        }

    def pushes(self) -> dict[Contact, Array]:
        """Point forces (k,) of the closed contacts."""
        return {contact.pair: contact.pushes for contact in self.system.touches if contact.closed}

    def largest_motion(self, system: System, z: State) -> float:
        """Largest displacement (or rotation) between ``system`` and the state ``z``."""
        return float(np.abs((system.z.values - z.values)[self.model.moving]).max())

    def largest_rotation(self, system: System, z: State) -> float:
        """Largest rotation (rad) of a section or body between ``system`` and the state ``z``."""
        return float(np.abs((system.z.values - z.values)[self.model.turning]).max())

    def described(self, load: int, value: float) -> str:
        """Name of the stepped parameter and a value in SI units, for messages."""
        part = self.model.stepped[load]
        return f"{part.name} = {value * part.unit:.6g}"


def _too_deep(model: Model, system: System) -> list[Contact]:
    """Contacts too deep for the next step, which might count the bodies as passed through.

    Where neutral lines cross, the first beam is on no side of the second, and no penalty separates them.
    """
    return [
        contact.pair
        for contact in system.touches
        if contact.penetration > _PASSING_SHARE * _deepest(contact.pair)
        or (
            isinstance(contact.pair, Face)
            and contact.closed
            and tip_depth(model, contact.pair, system.z) > _PASSING_SHARE * contact.pair.scale
        )
    ]


def _deepest(contact: Contact) -> float:
    """Greatest penetration of a contact not yet passed through; infinite for lines and edges."""
    if isinstance(contact, Pair) and contact.distance > 0.0:
        return contact.scale
    return contact.deepest if isinstance(contact, Circle) else np.inf


def _straight(before: float, beyond: float) -> float:
    """Share of the way to the zero of a linear function with these end values; zero if the first is not positive."""
    return before / (before - beyond) if before > 0.0 else 0.0


def begin(model: Model, settings: Settings, contacts: tuple[Contact, ...]) -> March:
    """Initial state of load stepping: undeformed and unloaded."""
    values, acting = np.zeros(len(model.stepped)), model.initial_constraints
    system = assemble(model, {}, settings.quadrature, values, model.start, acting)
    return March(model, settings, list(contacts), values, system, acting)

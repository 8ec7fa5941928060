"""The march from rest through assembly and stations: load steps that cut and grow, branches that end.

The march goes on even elements, on a coarse mesh where many are asked.  What is handed out at a station is solved
from there on the mesh that was asked, fitted to where contact is (:mod:`cprbm.refining`).
"""

from __future__ import annotations

import logging
from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from cprbm import answer_sheet
from cprbm.assembling import brought, formulated, freed, released
from cprbm.certifying import certify
from cprbm.closing import Closings, Stood
from cprbm.critical import BranchEnd, Minimum, at_rest, branch_end, told
from cprbm.extrapolating import FITTED, KEPT, alike, continued, led
from cprbm.first_contact import NO_ROWS
from cprbm.first_equilibrium import Equilibrium, equilibrium
from cprbm.following import Follower, Reached, Way, pressing, to
from cprbm.kinematics import State, most_changed, most_turned, rest_state
from cprbm.leap import Landed, leap
from cprbm.leaving import aside, left
from cprbm.levelling import levelled
from cprbm.mechanism import Mechanism, mechanism_of, swept_between
from cprbm.model import Fit
from cprbm.nearest import Pair
from cprbm.once import once
from cprbm.point import Point, point_at, potential_energy
from cprbm.probing import probed, shapes, touching
from cprbm.rate import rate, strayed
from cprbm.refining import all_zones, carried_over, carried_state, fits, fitted, long_ones
from cprbm.remarks import Remarks
from cprbm.settings import Settings
from cprbm.steadied import Turn, steadied
from cprbm.zones import Zone
from cprbm_scene import Certificate, Critical, Ending, Event, GoneOver, Loss, Scene, Stage, StationAnswer
from cprbm_scene.progress import station_reached

_SAYS = logging.getLogger(__name__)

AGAIN = 12  # iterations on a mesh that fits a little better
LAST = 4  # meshes less one, on one of which there is an equilibrium
FITS = 5  # PASSES where contacts are long
PASSES = 8  # of fitting the mesh to where contact is, at most
STRAIGHT = 6  # of them before meshes that take turns are led to the one between
BEYOND = 10.0  # times as far beyond a branch's end as that is known, there is no doubt that it has ended
ENDS = 10  # of branches between two stations
ONWARD = 0.01  # of the way on from there, at least: beside a bifurcation all branches are near
FURTHER = 30.0  # times as far before it, the fitted mesh is on the branch still
FARTHER = 2.0  # times as far where it is not
REFITTED = 3  # meshes, each fitted to a state nearer to the end than the one before
SOON = 6  # iterations to a state that is nearly known
NEARLY = 3  # from one that is near already
ROUGHLY = 1e-7  # residual on a mesh whose places of contact may ask for another; on the last one none is left
NEAR, NEARER = 1e-3, 1e-2  # residual of a state on a mesh that is not the last one, and of what it overlaps by
FOLLOWED = 0.2  # rad: the most that a finer mesh may turn a link by against the coarser


class March:
    """The state while marching: where we are, under which loads, and what was reached.

    ``family`` are the meshes from the one that is marched on to the one that is asked.
    """

    def __init__(self, scene: Scene, family: tuple[Settings, ...]) -> None:
        self.scene, self.family = scene, family
        mechanism = mechanism_of(scene, family[0])
        problem = mechanism.problem
        closed = np.zeros(problem.closure.rows)
        rest = point_at(problem, {}, rest_state(problem.model), closed, np.zeros(0), NO_ROWS)
        # the march's own mesh, of even elements
        self.whole = mechanism
        self.on = Follower(mechanism, family[0], rest, {}, [])
        self.reached: list[StationAnswer] = []
        self.events: list[Event] = []
        self.closed_at: dict[str, float] = {}
        self.asked_events = [p.of for p in scene.probes if p.quantity == "closing_load"]
        # where contacts stood open in this stage, of those that have not closed yet
        self.opened: dict[str, list[Stood]] = {}
        self.critical: list[Critical] = []
        # ends that nothing was asked of: those gone on over, and those on the way to the next station with how they
        # are told and where they were met
        self.gone_over: list[GoneOver] = []
        self.left: list[tuple[str, GoneOver, Follower]] = []
        self.remarks = Remarks()
        # what was solved at the last stations, by how often the mesh had been fitted, and to what
        self.before: dict[int, tuple[Fit, list[Stood]]] = {}
        # Newton iterations since the last station, those that led nowhere among them
        self.spent = 0
        # the last stations of this stage on meshes that were fitted
        self.stood: list[tuple[float, Mechanism, Point]] = []

    def run(self) -> tuple[Ending, str]:
        """Assemble, and march through every stage; the Ending and its sentence."""
        if self.scene.assembly is not None:
            ending, sentence = self._assemble()
            if ending is not Ending.COMPLETED:
                return ending, sentence
        for stage in self.scene.stages:
            here = self.on.values.get(stage.steps, 0.0), self.on.point
            self.opened = {name: [here] for name in self.asked_events if name not in self.closed_at}
            self.on.trail, self.on.careful, self.before, self.stood = [], stage.beyond is not None, {}, []
            for target in stage.stations:
                found = self._gone_on(stage, target)
                if found is not None:
                    self._keep(self._answer(stage, target, found))
                    continue
                reached = self._reach(stage, target)
                if reached.certificate is None:
                    last = f"the last good value of {stage.steps} is {self.on.values.get(stage.steps, 0.0):.6g}"
                    return reached.ending, f"{reached.ending.value}: {reached.sentence}; {last}"
                station = self._station(stage, target, reached.certificate)
                if station is None:
                    return Ending.STEP_TOO_SMALL, "the finer meshes do not follow the coarsest"
                self._keep(station)
        return Ending.COMPLETED, Ending.COMPLETED.value

    def _keep(self, station: StationAnswer) -> None:
        self.reached.append(station)
        station_reached(_SAYS, self.scene, len(self.reached), station)

    def _reach(self, stage: Stage, target: float) -> Reached:
        """Go to a station, also over ends that nothing was asked of; where that leads nowhere the first is told."""
        known, self.left = len(self.critical), []
        closed_at, events = dict(self.closed_at), list(self.events)
        reached = self._led(stage, target)
        if reached.certificate is None and self.left:
            of, met, self.on = self.left[0]
            self.critical[known:] = [replace(met.end, after=None)]
            self.closed_at, self.events = closed_at, events
            return Reached(Ending.BRANCH_ENDS, of, certificate=None)
        self.remarks.passed += [of for of, _, _ in self.left]
        self.gone_over += [met for _, met, _ in self.left]
        return reached

    def _led(self, stage: Stage, target: float) -> Reached:
        """Go to a station, from branch to branch where one ends."""

        def accept(point: Point, values: dict[str, float]) -> None:
            if self.opened:
                self._note_closings(stage.name, stage.steps, point, values[stage.steps])
            for name, opened in self.opened.items():
                if name not in pressing(point):
                    opened.append((values[stage.steps], point))

        for _ in range(ENDS):
            reached = self.on.go(to(stage.steps, self.on.values, target), accept)
            end = self._end(reached, stage.steps)
            if isinstance(end, Landed) and not self.on.careful:
                self.on.stand(end.point, self.on.beyond, end.certificate, stage.steps)
                accept(self.on.point, self.on.values)
                continue
            if not isinstance(end, BranchEnd):
                return reached
            for _ in range(REFITTED):
                finer = self._finer(stage.steps, end)
                if finer is None:
                    break
                far = abs(end.value - finer.trail[0].value) > FARTHER * self._before(end)
                again = finer.go(to(stage.steps, finer.values, target), accept)
                if again.certificate is not None:
                    self.on, self.before = finer, {}
                    return again
                sharper = self._told(finer, stage.steps)
                if not isinstance(sharper, BranchEnd):
                    # as far as the branch was followed on the mesh that fits it may end anywhere beyond
                    doubt = max(end.uncertainty, abs(end.value - finer.reached))
                    end = replace(end, uncertainty=doubt)
                    break
                self.on, end = finer, sharper
                # the mesh fits there as it stands, or the end is a place of the beam, to which it makes no difference
                if not far or end.loss is Loss.SLIP:
                    break
            landed, reached = self._ended(stage, target, end)
            if landed is None or self.on.values[stage.steps] == target:
                return reached
        return Reached(Ending.STEP_TOO_SMALL, f"{ENDS} branches ended one after the other", certificate=None)

    def _end(self, reached: Reached, load: str) -> BranchEnd | Landed | None:
        """Where the branch ends, if that is why a way has no certificate at its end, or else how it goes on."""
        on = self.on
        if on.locked is not None:
            return at_rest(on.mechanism, on.point, on.reached) if on.locked.buckles else None
        return self._told(on, load) if reached.certificate is None else None

    def _told(self, on: Follower, load: str) -> BranchEnd | Landed | None:
        """Where the branch ends by what goes to zero there, or by where the energy's decrease leads just beyond.

        That itself, where it leads to no other branch.
        """
        end = branch_end(on.mechanism, on.trail, on.refused)
        if end is not None or not on.trail:
            return end
        return left(on.mechanism, on.settings, on.trail[-1], Way(load, on.values, on.beyond))

    def _before(self, end: BranchEnd) -> float:
        """How far before an end the branch is looked for on a mesh that fits."""
        return FURTHER * (abs(self.on.refused - self.on.reached) + abs(end.value - self.on.reached))

    def _finer(self, load: str, end: BranchEnd) -> Follower | None:
        """From a little before the end, the same branch on the mesh that was asked, fitted to where contact is then.

        None where this is that mesh already, or the branch is not found on it.  What joints of even elements hold is no
        end of the branch where it has ended before on a mesh that fits: so it is sought from farther and farther back.
        """
        on = self.on
        least = self._before(end)
        for start in reversed(on.trail):
            away = abs(end.value - start.value)
            if away < least:
                continue
            values = {**on.values, load: start.value}
            zones = all_zones(on.mechanism, start.point)
            if on.settings is self.family[-1] and fits(
                on.mechanism, fitted(on.mechanism, start.point, zones, on.settings)
            ):
                return None
            found = self._fitted(start.point, values, start.certificate)
            if found is None or found[0] is on.mechanism:
                least = FARTHER * away
                continue
            mechanism, point, certificate = found
            stood = Minimum(start.value, point, certificate)
            return Follower(mechanism, self.family[-1], point, values, [stood], careful=on.careful, settles=False)
        return None

    def _ended(self, stage: Stage, target: float, end: BranchEnd) -> tuple[Landed | None, Reached]:
        """Note that the branch ends, and leap from there if the stage goes on, to what is the present state then.

        Where a stage says nothing of what is beyond, it goes on over an end beside which that is.
        """
        self.before = {}
        on, of = self.on, f"{told(end.loss, end.what)} at {stage.steps} = {end.value:.6g}"
        problem = on.mechanism.problem
        before, after = potential_energy(problem, on.point) * problem.model.unit_moment, None
        landed, reached = None, Reached(Ending.BRANCH_ENDS, of, certificate=None)
        # where another branch goes off, either of its sides is as good as the other; off a beam there is nothing beside
        off = end.loss is Loss.SLIP and isinstance(on.mechanism.pairs[end.what], Pair)
        beside = stage.beyond is None and end.loss is not Loss.BIFURCATION and not off
        if (beside and not end.far) or stage.beyond == "jump":
            ends = (end.value, on.refused)
            furthest = max(ends) if target > on.reached else min(ends)
            step = max(BEYOND * abs(on.refused - on.reached), ONWARD * abs(target - furthest))
            value = furthest + np.copysign(min(step, abs(target - furthest)), target - furthest)
            values = {**on.values, stage.steps: value}
            leads = leap if stage.beyond == "jump" else aside
            landed = leads(on.mechanism, on.settings, values, on.point, end.direction)
        if stage.beyond == "jump":
            reached = Reached(Ending.STEP_TOO_SMALL, f"no minimum found to which {of} leads", certificate=None)
        if landed is not None:
            after = potential_energy(problem, landed.point) * problem.model.unit_moment
            reached = Reached(Ending.COMPLETED, "", landed.certificate)
            self.on = self._evened(Minimum(value, landed.point, landed.certificate), values)
        critical = Critical(
            stage=stage.name,
            value=end.value,
            uncertainty=end.uncertainty,
            loss=end.loss,
            what=end.what,
            curvature=end.curvature,
            left=end.left,
            energy=before,
            after=after,
        )
        if landed is not None and beside:
            turned = most_changed(on.point.state, landed.point.state)
            self.left.append((of, GoneOver(critical, turned), on))
        else:
            self.critical.append(critical)
        return landed, reached

    def _evened(self, landed: Minimum, values: dict[str, float]) -> Follower:
        """From where a leap has landed, on the mesh of the march again, unless that has no such minimum."""
        on, settings = self.on, self.family[0]
        careful = on.careful
        if on.mechanism is not self.whole:
            start = carried_over(on.mechanism, landed.point, self.whole, values)
            found = equilibrium(self.whole.problem, values, start, settings.tolerance, settings.iterations, settle=True)
            certificate, ending = certify(self.whole, settings, found)
            turned = most_turned(start.state, found.point.state)
            if ending is Ending.COMPLETED and turned <= FOLLOWED:
                stood = Minimum(landed.value, found.point, certificate)
                return Follower(self.whole, settings, found.point, values, [stood], careful=careful)
        return Follower(on.mechanism, on.settings, landed.point, values, [landed], careful=careful)

    def _assemble(self) -> tuple[Ending, str]:
        """Bring the beams' ends to their points; the Ending and its sentence."""
        on = self.on
        for begun in (freed, brought, released, formulated):
            part = begun(self.scene, self.whole, on.point)
            on.mechanism, on.point, on.trail, on.careful = part.mechanism, part.start, [], True
            reached = on.go(Way("", part.begin, part.target), _unseen)
            if reached.certificate is None:
                end = self._end(reached, "")
                ends = isinstance(end, BranchEnd)
                ending = Ending.BRANCH_ENDS if ends else reached.ending
                sentence = told(end.loss, end.what) if isinstance(end, BranchEnd) else reached.sentence
                return ending, f"{ending.value}: as {part.sentence}, {sentence}"
        on.mechanism, on.values = self.whole, {}
        self.closed_at |= {name: 0.0 for name in self.asked_events if name in pressing(on.point)}
        return Ending.COMPLETED, ""

    def _station(self, stage: Stage, value: float, certificate: Certificate) -> StationAnswer | None:
        """The answer at a station that the march has reached, on the mesh that was asked; None if that fails."""
        found = self._fitted(self.on.point, self.on.values, certificate, station=value)
        if found is None:
            if len(self.family) > 1:
                return None
            self.remarks.even.append(f"{stage.name} {value:.6g}")
            found = self.on.mechanism, self.on.point, certificate
        self.spent += certificate.iterations
        return self._answer(stage, value, found)

    def _answer(self, stage: Stage, value: float, found: tuple[Mechanism, Point, Certificate]) -> StationAnswer:
        """The answer at a station from the state there."""
        mechanism, point, certificate = found
        spent, self.spent = self.spent, 0
        if mechanism is not self.on.mechanism:
            self.stood = [*self.stood[1 - KEPT :], (value, mechanism, point.bare)]
        # what is open on the march's mesh may be closed on this one
        self._note_closings(stage.name, stage.steps, point, value)
        places, forces = touching(mechanism, point), answer_sheet.point_forces(self.scene, mechanism, point)
        return StationAnswer(
            stage=stage.name,
            value=value,
            values=probed(self.scene, mechanism, point, self.closed_at, stage.name),
            shapes=shapes(mechanism, point),
            touching=places,
            certificate=replace(certificate, iterations=spent),
            branch=len(self.critical),
            beams=answer_sheet.beam_states(mechanism, point),
            forces=forces,
            contacts=answer_sheet.contacts(self.scene, mechanism, forces, places),
            bodies=answer_sheet.body_motions(self.scene, mechanism, point),
        )

    def _gone_on(self, stage: Stage, value: float) -> tuple[Mechanism, Point, Certificate] | None:
        """The station where the last ones lead on the meshes that were fitted, without the march going there.

        None where the march has to go: where another stage begins from there, ends of branches are asked for, other
        contacts press, no state is found soon, the mesh does not fit or joints share what is a place's (either hangs on
        where one comes from), or the links did not go as their rates say.
        """
        asked, stood = self.family[-1], self.stood
        if not stood or stage is not self.scene.stages[-1] or stage.beyond is not None:
            return None
        # without kinks a mesh fits within a part of an element, and which part would hang on the way there
        made = stood[-1][1].fit
        if made.ends or not pressing(stood[-1][2]) <= made.kinks.keys():
            return None
        way = to(stage.steps, {**self.on.values, stage.steps: stood[-1][0]}, value)
        values, (_, last, before) = way.at(1.0), stood[-1]
        target, start = last, None
        fit = led([(at, mechanism) for at, mechanism, _ in stood], value)
        if fit is not None:
            target = mechanism_of(self.scene, asked, fit, last)
            start = continued(target.problem, values, [(at, point) for at, _, point in stood[-FITTED:]], value)
        if start is None:
            target, start = last, before
        solved = self._nearly(target, values, start)
        if solved is None or pressing(solved.point) != pressing(before):
            return None
        found = self._settled(target, asked, solved.point, values, [asked] * PASSES, None, solved)
        if found is None or pressing(found[1]) != pressing(before):
            return None
        mechanism, point, refit = found
        if not fits(mechanism, fitted(mechanism, point, all_zones(mechanism, point), asked)) or _halved(point):
            return None
        change = point.state.theta - carried_state(last.problem.model, before.state, mechanism.problem.model).theta
        rates = rate(last.problem, before, way.change), rate(mechanism.problem, point, way.change)
        if strayed(mechanism.problem.model.lengths, change, *rates) or mechanism.passed(before, point):
            return None
        assert refit is not None
        certificate, ending = certify(mechanism, asked, refit)
        return (mechanism, point, certificate) if ending is Ending.COMPLETED else None

    def _fitted(
        self, point: Point, values: dict[str, float], certificate: Certificate, station: float | None = None
    ) -> tuple[Mechanism, Point, Certificate] | None:
        """A state on the branch on the mesh that was asked, its borders where zones of contact end.

        At a ``station`` it is sought first where the states on such meshes at the last stations lead.
        """
        on, asked = self.on, self.family[-1]
        found = self._settled(
            on.mechanism, on.settings, point, values, [*self.family[1:-1], *[asked] * PASSES], station
        )
        if found is None:
            return None
        mechanism, point, solved = found
        if solved is None:
            return mechanism, point, certificate
        certificate, ending = certify(mechanism, asked, solved)
        return (mechanism, point, certificate) if ending is Ending.COMPLETED else None

    def _settled(
        self,
        mechanism: Mechanism,
        now: Settings,
        point: Point,
        values: dict[str, float],
        meshes: Sequence[Settings],
        station: float | None,
        found: Equilibrium | None = None,
    ) -> tuple[Mechanism, Point, Equilibrium | None] | None:
        """From a state on a mesh, with the settings ``now``, through ``meshes`` to one that fits its contacts.

        The equilibrium is ``found`` where the first mesh fits.
        """
        asked, seen = self.family[-1], [(mechanism, found)] if found is not None else []
        last: Turn | None = None
        for turn, settings in enumerate(meshes):
            zones = all_zones(mechanism, point)
            long = long_ones(zones)
            if settings is not asked and not long:
                continue  # a few places need no mesh between the coarsest and the finest
            passes = FITS if long else PASSES
            if turn - (len(meshes) - PASSES) >= passes:
                break
            fit = fitted(mechanism, point, zones, settings)
            if settings is now and fits(mechanism, fit):
                if found is None or found.converged:
                    break
                found = self._solved(mechanism, values, point, NEARLY)
                if not found.converged:
                    break
                point = found.point
                continue
            if settings is now and turn - (len(meshes) - PASSES) > STRAIGHT:
                turned_to = (mechanism.fit, fit)
                fit, last = steadied(turned_to, last), turned_to
            target = mechanism_of(self.scene, settings, fit, mechanism)
            carried = carried_state(mechanism.problem.model, point.state, target.problem.model)
            solved = self._resumed(turn, target, carried, values, station)
            # from the march's own mesh, fitted ones may take turns for good, and if they were solved only nearly, which
            # is the last would hang on round-off; from one that fitted at the last station they do not
            if solved is None and now is asked and mechanism is not self.on.mechanism and station is None:
                solved = self._nearly(target, values, carried_over(mechanism, point, target, values))
            if solved is None:
                # the first mesh, or one for other zones, may settle which places there are; the next ones know them
                first = mechanism is self.on.mechanism or mechanism.fit.ends.keys() != fit.ends.keys()
                at = mechanism, point, zones
                target, solved = self._refitted(at, target, values, settings, now, settle=first)
            turned = most_turned(carried, solved.point.state)
            # a mesh may lose what is thin from sight, and the beam go through it
            gone = swept_between(mechanism, point, target, solved.point)
            if not (solved.converged or _near(solved)) or turned > FOLLOWED or gone:
                if now is asked:  # on a mesh that fits a little less it stands already
                    break
                return None
            mechanism, point, now, found = target, solved.point, settings, solved
            seen.append((mechanism, solved))
            if station is not None:
                fit, known = self.before.get(turn, (target.fit, []))
                kept = known[1 - KEPT :] if alike(fit, target.fit) else []
                self.before[turn] = target.fit, [*kept, (station, point.bare)]
        if found is None or found.converged:
            return mechanism, point, found
        # of meshes on which the state is only near, the last that has one; on one that fits a little less it may stand
        for mechanism, near in seen[:-LAST:-1]:
            found = near if near.converged else self._solved(mechanism, values, near.point, NEARLY)
            if found.converged:
                return mechanism, found.point, found
        return None

    def _nearly(self, mechanism: Mechanism, values: dict[str, float], start: Point) -> Equilibrium | None:
        """A state near an equilibrium on a mesh that is not the last one; None where none is found soon."""
        for _ in range(SOON):
            found = self._solved(mechanism, values, start, 1)
            if found.converged or _near(found):
                return found
            start = found.point
        return None

    def _solved(self, mechanism: Mechanism, values: dict[str, float], start: Point, most: int) -> Equilibrium:
        """An equilibrium on a mesh that was asked; the next station's certificate counts its iterations."""
        found = equilibrium(mechanism.problem, values, start, self.family[-1].tolerance, most)
        self.spent += found.iterations
        return found

    def _resumed(
        self, turn: int, target: Mechanism, carried: State, values: dict[str, float], station: float | None
    ) -> Equilibrium | None:
        """The equilibrium near where those on such meshes at the last stations lead; None where none is found there.

        ``carried`` is the state near which it must be.
        """
        fit, known = self.before.get(turn, (target.fit, []))
        if station is None or not alike(fit, target.fit):
            return None
        start = continued(target.problem, values, known, station)
        if start is None:
            return None
        found = self._solved(target, values, start, SOON)
        return found if found.converged and most_turned(carried, found.point.state) <= FOLLOWED else None

    def _refitted(
        self,
        at: tuple[Mechanism, Point, Mapping[str, tuple[Zone, ...]]],
        target: Mechanism,
        values: dict[str, float],
        settings: Settings,
        now: Settings,
        *,
        settle: bool,
    ) -> tuple[Mechanism, Equilibrium]:
        """The equilibrium on a mesh, and the next mesh, from a state ``at`` the one before and its zones.

        Its settings are those of ``now``.

        That is another than the ``target`` where places were to be levelled.
        """
        most = settings.iterations if settle else min(settings.iterations, AGAIN)
        before, point, zones = at
        start = carried_over(before, point, target, values, zones)
        coarse = now is not self.family[-1]
        # meshes that end where zones do may take turns, and which is the last must not hang on what was left
        left = settings.tolerance if target.fit.ends else max(settings.tolerance, ROUGHLY)
        for steady in (False, True) if settle and not coarse else (coarse,):
            solved = equilibrium(target.problem, values, start, left, most, settle=steady, same=True)
            self.spent += solved.iterations
            if solved.converged:
                break
            level = levelled(self.scene, settings, before, point, target.fit, values) if target.fit.kinks else None
            if level is not None:
                target, solved = level
                self.spent += solved.iterations
                break
        return target, replace(solved, converged=solved.converged and solved.measure.within(settings.tolerance))

    def notes(self) -> list[str]:
        """What a reader should know besides the numbers."""
        said = [
            f"contact '{name}' never closed at a station"
            for name in self.scene.contacts
            if not any(name in station.touching for station in self.reached)
        ]
        return said + self.remarks.told()

    def _note_closings(self, stage: str, load: str, after: Point, value: float) -> None:
        """Note which contacts have closed on the way to ``after``, and where, if the scene asks."""
        for name in [name for name in self.opened if name in pressing(after)]:
            closings = Closings(self.scene, self.family[-1], self.on.mechanism, self.asked, load, self.on.values)
            closing = closings.first(name, self.opened[name], value)
            if closing is not None:
                del self.opened[name]
                self.closed_at[name] = closing
                self.events.append(Event(stage, name, "closes", closing))

    @once
    def asked(self) -> Mechanism:
        """The scene on even elements of the mesh that was asked."""
        return self.whole if len(self.family) == 1 else mechanism_of(self.scene, self.family[-1], before=self.whole)


def _halved(point: Point) -> bool:
    """Whether joints press that share the force of a place."""
    return any(lam > 0.0 and key >= 0 for (_, key), lam in zip(point.rows.keys, point.lam, strict=True))


def _near(found: Equilibrium) -> bool:
    """Whether a state is so near an equilibrium that its contacts say where the elements of the next mesh end."""
    of = found.measure
    return of.residual <= NEAR and max(of.violation, of.overlap) <= NEAR * NEARER


def _unseen(point: Point, values: dict[str, float]) -> None:
    """Of minima on the way that nobody asks for."""

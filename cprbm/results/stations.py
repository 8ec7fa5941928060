"""The run through all stages and stations, and the answer sheet."""

import logging
import time
from dataclasses import dataclass, field, replace

from cprbm.chain import add_rows, mechanism_of
from cprbm.contact import contact_geometry, hold_sections_upright
from cprbm.continuation.assembly import assembled, landing_rows, without_repeated
from cprbm.continuation.driver import Driver, Passed, StepError
from cprbm.continuation.path import Way, potential, turned
from cprbm.equilibrium import NotConvergedError, System, certify, equilibrium, system_of
from cprbm.paper.contacts import paper_geometry, refuse_contacts
from cprbm.paper.inspection import Inspection
from cprbm.results.probes import probe_values, states_of_contacts, touching_places
from cprbm.results.statics import Statics
from cprbm.results.view import Samples, View
from cprbm.settings import Settings
from cprbm_scene import Answer, Certificate, Critical, Ending, Event, GoneOver, Scene, Shape, Stage, StationAnswer
from cprbm_scene.answer import PointForces, frozen_array
from cprbm_scene.solving import one_thread, station_reached

LOGGER = logging.getLogger("cprbm.stations")
"""Its first part is the solver's name in the message of progress."""

PLAIN = (
    "elements are longer than the bends that the forces in them allow: the values are those of the plain chain, "
    "of second order in 1/N"
)


@dataclass(eq=False)
class Run:
    """A scene with its mechanism, before and during the solve.

    Attributes:
        scene, settings: the question.
        plain: whether beams are plain chains in the formulation ``auto`` too.
        driver: at the first state once the run has begun.
        values: present values (SI) of loads and drives.
        closing: name and value (SI) of the stepped load or drive at the first closing of contacts.
        stations, events, critical, gone_over, notes: of the answer.
        inspection: of contacts in the formulation ``paper``.
    """

    scene: Scene
    settings: Settings
    plain: bool = False
    driver: Driver | None = None
    values: dict[str, float] = field(default_factory=dict)
    closing: dict[str, tuple[str, float]] = field(default_factory=dict)
    stations: list[StationAnswer] = field(default_factory=list)
    events: list[Event] = field(default_factory=list)
    critical: list[Critical] = field(default_factory=list)
    gone_over: list[GoneOver] = field(default_factory=list)
    inspection: Inspection | None = None
    seconds: float = 0.0

    def __post_init__(self) -> None:
        began = time.perf_counter()
        self.system = self._system(corrected=self.settings.formulation == "auto" and not self.plain)
        self.notes = [PLAIN] if self.plain else []
        self.seconds = time.perf_counter() - began

    def _system(self, *, corrected: bool) -> System:
        links = {beam: self.settings.links_of(beam) for beam in self.scene.beams}
        mechanism = mechanism_of(self.scene, links, self.scene.theory, corrected=corrected)
        add_rows(mechanism)
        mechanism.rows.extend(landing_rows(mechanism))
        geometry = contact_geometry(mechanism)
        if self.scene.theory == "shear":
            hold_sections_upright(mechanism, geometry)
        if self.settings.formulation == "paper" and geometry.pairs:
            refuse_contacts(self.scene)
            every, geometry = geometry, paper_geometry(mechanism, geometry, self.settings.degree)
            self.inspection = Inspection(mechanism, every)
        self.samples = {beam: Samples(mechanism, beam) for beam in mechanism.chains}
        return system_of(mechanism, geometry)

    def answer(self) -> Answer:
        """Solve the scene."""
        began = time.perf_counter()
        with one_thread():
            ending, sentence = self._solve()
        if ending is Ending.TURNED_TOO_FAR and self.settings.formulation == "auto" and not self.plain:
            # elements longer than the bends have no corrections
            plain = Run(self.scene, self.settings, plain=True).answer()
            return replace(plain, seconds=self.seconds + time.perf_counter() - began)
        touched = {name for station in self.stations for name in station.touching}
        never = [f"contact '{name}' never closed at a station" for name in self.scene.contacts if name not in touched]
        if self.inspection is not None and self.driver is not None:
            self.notes += self.inspection.sentences(self.driver.solved)
        return Answer(
            solver="cprbm",
            scene=self.scene.name,
            settings=self.settings.plain(),
            ending=ending,
            sentence=sentence,
            stations=tuple(self.stations),
            events=tuple(self.events),
            critical=tuple(self.critical),
            gone_over=tuple(self.gone_over),
            seconds=self.seconds + time.perf_counter() - began,
            notes=(*never, *self.notes),
        )

    def _solve(self) -> tuple[Ending, str]:
        try:
            self.driver = assembled(self.system, self.settings)
        except StepError as failure:
            return failure.ending, str(failure)
        first = self.scene.stages[0]
        self._note_contacts(first, [Event(first.name, name, "closes", 0.0) for name in sorted(self.driver.touching)])
        for stage in self.scene.stages:
            for station in stage.stations:
                try:
                    self._go(self.driver, stage, station)
                except StepError as failure:
                    before = self.values.get(stage.steps, 0.0)
                    reached = before + min(1.0, self.driver.reached) * (station - before)
                    last = f"the last good value of {stage.steps} is {reached:.6g}"
                    return failure.ending, f"{failure.ending.value}: {failure}; {last}"
        return Ending.COMPLETED, Ending.COMPLETED.value

    def _hold_drives(self, driver: Driver, stage: Stage) -> None:
        """Hold the drives that begin with a stage, and have no value yet, at the present values.

        Raises:
            StepError: the drives contradict other rows.
        """
        m, state = self.system.mechanism, driver.solved.state
        begun = {
            name: m.row(name)
            for name, drive in self.scene.drives.items()
            if drive.begins == stage.name and name not in self.values
        }
        if not begun:
            return
        driven, target = state.driven.copy(), state.target.copy()
        for name, row in begun.items():
            driven[row], target[row] = True, driver.solved.values[row]
            self.values[name] = float(target[row]) / m.rows[row].unit
        held = without_repeated(self.system, replace(state, driven=driven, target=target))
        try:
            driver.solved = equilibrium(self.system, held, self.settings.iterations)
        except NotConvergedError as failure:
            raise StepError(Ending.STEP_TOO_SMALL, f"no equilibrium with {' and '.join(begun)}: {failure}") from failure

    def _go(self, driver: Driver, stage: Stage, station: float) -> None:
        """Follow the path to a station and add the answer.

        Raises:
            StepError: the station was not reached, or its certificate does not hold.
        """
        self._hold_drives(driver, stage)
        mechanism, names = self.system.mechanism, {stage.steps, *stage.together}
        begin, before = driver.solved.state.target, self.values.get(stage.steps, 0.0)
        end, driver.spent = begin.copy(), 0
        for row in map(mechanism.row, names):
            end[row] = station * mechanism.rows[row].unit
        try:
            driver.follow(Way(begin, end, (before, station), stage.steps, stage.name), stage.beyond)
        finally:
            self._note(stage, driver.passed)
            self._note_contacts(stage, driver.events)
        self.values |= dict.fromkeys(names, station)
        certificate, ending = certify(driver.solved, self.settings.tolerance, driver.spent, driver.acting)
        if ending is not Ending.COMPLETED:
            raise StepError(ending, certificate.failures[0])
        if self.inspection is not None:
            if crossed := self.inspection.crossed(driver.solved):
                raise StepError(Ending.BEAMS_CROSSED, crossed)
            self.inspection.look(driver.solved, f"{stage.name} {station:.6g}")
        self.stations.append(self._station(driver, stage, station, certificate))
        station_reached(LOGGER, self.scene, len(self.stations), self.stations[-1])

    def _note(self, stage: Stage, passed: list[Passed]) -> None:
        """Add the critical points of the way to a station to the answer."""
        unit = self.system.mechanism.units.moment
        for each in passed:
            point, landed = each.point, each.landed
            critical = Critical(
                stage=stage.name,
                value=each.value,
                uncertainty=each.width,
                loss=point.loss,
                what=point.what,
                curvature=point.curvature,
                left=point.left,
                energy=potential(self.system, point.last.state) * unit,
                after=None if each.after is None else each.after * unit,
            )
            if landed is not None and stage.beyond is None:
                self.gone_over.append(GoneOver(critical, turned(point.last, landed)))
                self.notes.append(
                    f"the branch ends, {point.sentence} at {stage.steps} = {each.value:.6g}, and was left for the "
                    "state beside it to which the decrease of the energy leads"
                )
            else:
                self.critical.append(critical)

    def _note_contacts(self, stage: Stage, events: list[Event]) -> None:
        """Add closings and openings on the way to a station to the answer."""
        self.events += events
        for event in (event for event in events if event.kind == "closes"):
            self.closing.setdefault(event.contact, (stage.steps, event.value))

    def _station(self, driver: Driver, stage: Stage, station: float, certificate: Certificate) -> StationAnswer:
        """Answer at a station."""
        closing = {name: value for name, (steps, value) in self.closing.items() if steps == stage.steps}
        view = View(driver.solved, self.samples, dict(self.values), closing)
        units, statics = self.system.mechanism.units, Statics(view)
        # the paper's contacts press on joints and turn links: no places of the line carry the forces
        touching, shown = touching_places(view), self.inspection is None
        parts = self.system.mechanism.bodies.keys() | self.scene.beams.keys()
        forces = PointForces.collected(
            (force for force in statics.forces if shown and force.target in parts),
            units.length,
            units.force,
            (float(units.origin[0]), float(units.origin[1])),
        )
        return StationAnswer(
            stage=stage.name,
            value=station,
            values=probe_values(statics, stage.name),
            shapes={
                beam: Shape(
                    frozen_array(samples.s[samples.shape] * units.length),
                    *map(frozen_array, (view.lines[beam][samples.shape] * units.length + units.origin).T),
                )
                for beam, samples in self.samples.items()
            },
            touching=touching,
            certificate=certificate,
            branch=len(self.critical),
            beams={beam: statics.state(beam) for beam in self.scene.beams if shown},
            forces=forces,
            contacts=states_of_contacts(view, forces, touching),
            bodies={
                name: frozen_array(view.z[first : first + 3] * (units.length, units.length, 1.0))
                for name, first in self.system.mechanism.bodies.items()
            },
        )

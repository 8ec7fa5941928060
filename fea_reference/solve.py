"""Solution of a scene by finite elements."""

import logging
import time
from dataclasses import dataclass

import numpy as np

from cprbm_scene.answer import Answer, Ending, Event, StationAnswer, frozen_array, openings
from cprbm_scene.solving import one_thread, station_reached
from cprbm_scene.statement import Scene, Stage
from fea_reference import answer_sheet
from fea_reference.assembly import assemble_ends
from fea_reference.certificates import certify
from fea_reference.contacts import contacts
from fea_reference.march import March, StoppedError, begin
from fea_reference.model import build
from fea_reference.probes import probed, shapes, touching
from fea_reference.settings import Settings
from fea_reference.travel import Course, reach

_SAYS = logging.getLogger(__name__)

_DEFAULT = Settings()


@dataclass(frozen=True, slots=True)
class Prepared:
    """A discretised scene with single-use load-stepping state, initially unloaded.

    ``seconds`` is the preparation time (s).
    """

    scene: Scene
    settings: Settings
    march: March
    seconds: float

    def answer(self) -> Answer:
        """Answer of the scene, see :func:`answer`.

        Raises:
            SceneError: a stop forbids the assembly.
        """
        began = time.perf_counter()
        scene, march, model = self.scene, self.march, self.march.model
        stations: list[StationAnswer] = []
        events: list[Event] = []
        ending, sentence = Ending.COMPLETED, Ending.COMPLETED.value
        with one_thread():
            try:
                known: dict[str, str] = {}  # closed contacts, with the parameter stepped at their closing
                assemble_ends(scene, march)
                for stage in scene.stages:
                    course = _course(march, stage)
                    for station in stage.stations:
                        reach(march, course, station / model.stepped[course.load].unit)
                        events += [
                            Event(stage.name, name, "closes", closing)
                            for name, closing in march.closing.items()
                            if name not in known
                        ]
                        known = {name: known.get(name, stage.steps) for name in march.closing}
                        stations.append(_certified(scene, march, stage, station, known))
                        station_reached(_SAYS, scene, len(stations), stations[-1])
            except StoppedError as stopped:
                ending, sentence = stopped.ending, stopped.sentence
        closed = {name: f"closed at {value:.6g}" for name, value in march.closing.items()}
        tested = [f"{name}: {closed.get(name, 'stayed open')}" for name in scene.contacts]
        bypassed = [
            f"{end.sentence}; the solution continues on a nearby branch, found by energy descent"
            for end in march.bypassed
        ]
        return Answer(
            solver="fea",
            scene=scene.name,
            settings=self.settings.plain(),
            ending=ending,
            sentence=sentence,
            stations=tuple(stations),
            events=(*events, *openings(scene, stations)),
            critical=tuple(march.critical),
            gone_over=tuple(end.record for end in march.bypassed),
            seconds=self.seconds + time.perf_counter() - began,
            notes=(*tested, *bypassed),
        )


def prepared(scene: Scene, settings: Settings = _DEFAULT) -> Prepared:
    """Prepare a scene without solving, to time the preparation separately.

    Args:
        scene: as for :func:`answer`.
        settings: as for :func:`answer`.

    Returns:
        The elements in the stress-free state; ``answer`` of the result solves the scene.

    Raises:
        SceneError: the settings do not fit the scene.
    """
    began = time.perf_counter()
    model = build(scene, settings)
    march = begin(model, settings, contacts(scene, model, settings.penetration))
    return Prepared(scene, settings, march, time.perf_counter() - began)


def answer(scene: Scene, settings: Settings = _DEFAULT) -> Answer:
    """Solve a scene by finite elements.

    The bending theory converges with the fourth power of the element's length. Stretch and shear converge with the
    second power, because axial and shear forces of a curved element refer to the chord. Their errors start at a
    hundredth of their contribution. An answer that ends early has the stations reached before.

    Args:
        scene: the problem statement.
        settings: numerical choices; by default 80 elements per beam, with stretch and shear.

    Returns:
        Certified answers at the scene's stations, up to the last reached; values are read-only arrays in SI, of
        the shapes in :mod:`cprbm_scene.answer`.

    Raises:
        SceneError: the settings do not fit the scene, or a stop forbids the assembly.

    Source:
        Corotational beams: Crisfield, Non-linear Finite Element Analysis of Solids and Structures, vol. 1, ch. 7.
        Contact: Konyukhov and Schweizerhof, Computational Contact Mechanics, ch. 5, in the plane.

    Example:
        >>> import fea_reference
        >>> from cprbm_scene import read
        >>> answer = fea_reference.answer(read("comparisons/cases/tapered.toml"), fea_reference.Settings(elements=12))
        >>> answer.completed, answer.stations[-1].values["T.displacement"].shape
        (True, (2,))
    """
    return prepared(scene, settings).answer()


def _certified(scene: Scene, march: March, stage: Stage, station: float, closed: dict[str, str]) -> StationAnswer:
    """The station's answer with its certificate.

    ``closed`` is the stepped parameter of every closing; a closing value belongs to this parameter only.

    Raises:
        StoppedError: the certificate fails.
    """
    certificate = certify(march)
    if not certificate.holds:
        minimum = certificate.smallest_curvature > 0.0
        raise StoppedError(
            Ending.NOT_CERTIFIED if minimum else Ending.NOT_A_MINIMUM,
            f"at {stage.steps} = {station:g}: " + "; ".join(certificate.failures),
        )
    places, forces = touching(march), answer_sheet.point_forces(scene, march)
    return StationAnswer(
        stage=stage.name,
        value=station,
        values={
            probe.name: probed(scene, march, probe)
            if probe.asked_in(stage.name)
            and (probe.quantity != "closing_load" or closed.get(probe.of, stage.steps) == stage.steps)
            else frozen_array([])
            for probe in scene.probes
        },
        shapes=shapes(march),
        touching=places,
        certificate=certificate,
        branch=len(march.critical),
        beams=answer_sheet.beam_states(march),
        forces=forces,
        contacts=answer_sheet.contacts(scene, march, forces, places),
        bodies=answer_sheet.body_motions(march),
    )


def _course(march: March, stage: Stage) -> Course:
    """Stepped parameter of a stage and its span, from the present value through all stations."""
    load = [part.name for part in march.model.stepped].index(stage.steps)
    values = [march.values[load], *(station / march.model.stepped[load].unit for station in stage.stations)]
    return Course(load, float(np.ptp(values)) or 1.0, stage.name, stage.beyond)

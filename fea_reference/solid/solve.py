"""Solution of a scene as a plane solid."""

import logging
import time
from dataclasses import dataclass

from cprbm_scene.answer import Answer, Ending, Event, StationAnswer, frozen_array, openings
from cprbm_scene.solving import one_thread, station_reached
from cprbm_scene.statement import Scene, Stage
from fea_reference.solid import answer_sheet
from fea_reference.solid.assembly import assemble_ends
from fea_reference.solid.certificates import certify
from fea_reference.solid.march import March, StoppedError, begin, reach, reset_step
from fea_reference.solid.meshing import choose_mesher
from fea_reference.solid.model import build
from fea_reference.solid.pairs import pairs_of
from fea_reference.solid.probes import probed, shapes, touching
from fea_reference.solid.refusals import refuse
from fea_reference.solid.settings import Settings

_SAYS = logging.getLogger(__name__)

_DEFAULT = Settings()


@dataclass(frozen=True, slots=True)
class Prepared:
    """A discretised scene with single-use load-stepping state, initially unloaded.

    ``seconds`` is the preparation time (s); ``notes`` describe the mesher.
    """

    scene: Scene
    settings: Settings
    march: March
    seconds: float
    notes: tuple[str, ...]

    def answer(self) -> Answer:
        """Answer of the scene, see :func:`answer`.

        Raises:
            SceneError: a stop forbids the assembly.
        """
        began = time.perf_counter()
        scene, march = self.scene, self.march
        stations: list[StationAnswer] = []
        events: list[Event] = []
        ending, sentence = Ending.COMPLETED, Ending.COMPLETED.value
        with one_thread():
            try:
                known: dict[str, str] = {}  # closed contacts, with the parameter stepped at their closing
                assemble_ends(scene, march)
                for stage in scene.stages:
                    reset_step(march)
                    part = [part.name for part in march.model.stepped].index(stage.steps)
                    unit = march.model.stepped[part].unit
                    for station in stage.stations:
                        reach(march, part, station / unit)
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
        tested = tuple(
            f"{name}: " + (f"closed at {march.closing[name]:.6g}" if name in march.closing else "stayed open")
            for name in scene.contacts
        )
        return Answer(
            solver="solid",
            scene=scene.name,
            settings=self.settings.plain(),
            ending=ending,
            sentence=sentence,
            stations=tuple(stations),
            events=(*events, *openings(scene, stations)),
            seconds=self.seconds + time.perf_counter() - began,
            notes=(*self.notes, *tested),
        )


def prepared(scene: Scene, settings: Settings = _DEFAULT) -> Prepared:
    """Prepare a scene without solving.

    Arguments as for :func:`answer`.

    Raises:
        SceneError: the settings do not fit the scene, or the scene needs a feature that the solid lacks.
    """
    began = time.perf_counter()
    refuse(scene)
    rectangle, how = choose_mesher()
    model = build(scene, settings, rectangle)
    march = begin(model, settings, pairs_of(scene, model))
    return Prepared(scene, settings, march, time.perf_counter() - began, (how,))


def answer(scene: Scene, settings: Settings = _DEFAULT) -> Answer:
    """Solve a scene as a solid.

    An answer that ends early has the stations reached before.

    Raises:
        SceneError: the settings do not fit the scene, the scene needs a feature that the solid lacks, or a stop
            forbids the assembly.
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
        forces=forces,
        contacts=answer_sheet.contacts(scene, march, forces, places),
        bodies=answer_sheet.body_motions(scene, march),
    )

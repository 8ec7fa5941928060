"""Planted solvers: calls of the public solvers with other arguments, and no mechanics."""

import importlib
from dataclasses import dataclass, field, replace

import cprbm
import fea_reference
from comparisons.pairing import Solvers


@dataclass(frozen=True)
class Exact:
    """The exact reference, by the name of its package."""

    package: str

    def __call__(self, scene, choices):
        return importlib.import_module(self.package).answer(scene)


def plain(packages):
    """The real solvers and the exact reference, all in this process."""
    return Solvers(exact=Exact(packages.exact))


def wider(packages):
    """A CPRBM with beams 3 % wider than in the scene: the answers differ from the finite elements'."""
    return Solvers(cprbm=_of_wider_beams)


def _of_wider_beams(scene, choices):
    beams = {name: beam.model_copy(update={"width": 1.03 * beam.width}) for name, beam in scene.beams.items()}
    wide = scene.model_copy(update={"beams": type(scene.beams)(beams)})
    return cprbm.answer(wide, cprbm.Settings(links=choices.links))


def interrupted(packages):
    """Solvers under which the user interrupts."""
    return Solvers(_interrupt, _interrupt)


def _interrupt(scene, choices):
    raise KeyboardInterrupt


def brief(packages):
    """Answers with the first station in place of all stations; the user interrupts at the second scene."""
    session = _Session()
    return Solvers(
        cprbm=_Brief(session, "cprbm", _few_links),
        fea=_Brief(session, "fea", _few_elements),
        exact=_Brief(session, "exact", Exact(packages.exact)),
    )


def _few_links(scene, choices):
    return cprbm.answer(scene, cprbm.Settings(links=6))


def _few_elements(scene, choices):
    return fea_reference.answer(scene, fea_reference.Settings(elements=6, kinematics=choices.kinematics))


@dataclass
class _Session:
    """A run of the program: the first scene, and the answers so far."""

    first: str = ""
    answers: dict = field(default_factory=dict)


@dataclass
class _Brief:
    """A solver of the first station of a session's first scene; no solve is repeated."""

    session: _Session
    name: str
    solver: object

    def __call__(self, scene, choices):
        if self.name != "exact":
            self.session.first = self.session.first or scene.name
            if scene.name != self.session.first:
                raise KeyboardInterrupt
        key = self.name, scene, choices.kinematics if self.name == "fea" else ""
        answers = self.session.answers
        if key not in answers:
            answers[key] = self._repeated(scene, choices)
        return answers[key]

    def _repeated(self, scene, choices):
        """An answer with the first station in place of all stations; none where the solver reaches none."""
        stage = scene.stages[0]
        short = scene.model_copy(update={"stages": (stage.model_copy(update={"stations": stage.stations[:1]}),)})
        found = self.solver(short, choices)
        asked = [(stage.name, value) for stage in scene.stages for value in stage.stations]
        stations = [replace(each, stage=name, value=value) for name, value in asked for each in found.stations[:1]]
        return replace(found, stations=tuple(stations))


PLANTED = {"": plain, "wider": wider, "interrupted": interrupted, "brief": brief}

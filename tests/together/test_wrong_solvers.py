"""Deliberately wrong solvers, made of the real ones: the verdict must say so, or at least not AGREE.

Here on the cases that were made for a fault, and at the standard settings, where a theory could excuse one; each fault
on every case that contains it is :mod:`tests.together.test_faults_everywhere`'s.

How each is planted:

* *too stiff*: the scene's Young's modulus is 2 % larger before one solver sees it;
* *contact ignored*: the scene has no contacts when one solver sees it, and the contact's probes are then
  answered as a solver would that found it open;
* *thickness forgotten*: the beams touch as lines for one solver;
* *one thickness*: a beam whose thickness varies has the mean thickness for one solver;
* *sampled stiffness*: inside a solver the bending stiffness at an element's end stands for the whole element;
* *NaN*: one number of an otherwise right answer.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

import cprbm.chain.beam
from comparisons import cases
from comparisons.case import Verdict, compare
from comparisons.choices import Choices
from comparisons.executor import Solver
from comparisons.pairing import Solvers, cprbm_answer, fea_answer, paired
from comparisons.verdict import Word
from comparisons.verdict.runs import Runs
from cprbm_scene import Answer, Scene
from cprbm_scene.answer import frozen_array
from cprbm_scene.frozendict import frozendict
from tests.together.planted import COARSE, asked_of, remembered, stiffer, without_contact


def with_cprbm(scene: Scene, runs: Runs, wrong: Solver) -> Verdict:
    """The verdict on a wrong CPRBM beside the right finite elements, at the standard settings."""
    return compare(paired(scene, Choices(), replace(remembered(runs), cprbm=wrong))).verdict


def with_fea(scene: Scene, runs: Runs, wrong: Solver) -> Verdict:
    """The verdict on wrong finite elements beside the right CPRBM, in one theory and coarse."""
    return compare(paired(scene, COARSE, replace(remembered(runs), fea=wrong))).verdict


def thin(scene: Scene) -> Scene:
    contacts = {name: contact.model_copy(update={"thick": False}) for name, contact in scene.contacts.items()}
    return scene.model_copy(update={"contacts": frozendict(contacts)})


def untapered(scene: Scene) -> Scene:
    u = np.linspace(0.0, 1.0, 1001)
    beams = {
        name: beam.model_copy(update={"thickness": float(np.mean(beam.thickness_at(u)))})
        for name, beam in scene.beams.items()
    }
    return scene.model_copy(update={"beams": frozendict(beams)})


def spoilt(solver: Solver, probe: str) -> Solver:
    def answer(scene: Scene, choices: Choices) -> Answer:
        found = solver(scene, choices)
        last = found.stations[-1]
        values = np.array(last.values[probe])
        values[0] = np.nan
        bad = replace(last, values=frozendict({**last.values, probe: frozen_array(values)}))
        return replace(found, stations=(*found.stations[:-1], bad))

    return answer


def test_the_right_ones_agree(hinge, hinge_runs, coarse_runs):
    right = paired(hinge, Choices(), remembered(hinge_runs))
    assert compare(right).verdict.word is Word.AGREE
    coarse = paired(hinge, COARSE, remembered(coarse_runs))
    assert compare(coarse).verdict.word is Word.AGREE


@pytest.mark.parametrize("altered", [stiffer, thin], ids=["too stiff", "thickness forgotten"])
def test_another_question_is_caught_in_the_cprbm(hinge, hinge_runs, altered):
    assert with_cprbm(hinge, hinge_runs, asked_of(cprbm_answer, altered)).word is Word.DIFFER


@pytest.mark.parametrize("altered", [stiffer, thin], ids=["too stiff", "thickness forgotten"])
def test_another_question_is_caught_in_the_finite_elements(hinge, coarse_runs, altered):
    assert with_fea(hinge, coarse_runs, asked_of(fea_answer, altered)).word is Word.DIFFER


def test_an_ignored_contact_is_caught_in_the_cprbm(hinge, hinge_runs):
    assert with_cprbm(hinge, hinge_runs, without_contact(cprbm_answer)).word is Word.DIFFER


@pytest.fixture(scope="module")
def tapered() -> Scene:
    return cases.opened("tapered")


def in_bending(scene: Scene, solvers: Solvers) -> Word:
    """The verdict in one theory, in which nothing excuses a difference."""
    return compare(paired(scene, Choices(), solvers)).verdict.word


def test_the_right_ones_agree_on_the_tapered_beam(tapered):
    assert in_bending(tapered, Solvers()) is Word.AGREE


def test_a_mean_thickness_is_caught(tapered):
    assert in_bending(tapered, Solvers(cprbm=asked_of(cprbm_answer, untapered))) is Word.DIFFER
    assert in_bending(tapered, Solvers(fea=asked_of(fea_answer, untapered))) is Word.DIFFER


def test_a_stiffness_sampled_at_the_ends_of_elements_is_caught(tapered, monkeypatch):
    def sampled(function: Callable[[np.ndarray], np.ndarray], borders: np.ndarray, knots: np.ndarray) -> np.ndarray:
        return np.diff(borders) * function(borders[1:])

    monkeypatch.setattr(cprbm.chain.beam, "_integrals", sampled)
    assert in_bending(tapered, Solvers()) is not Word.AGREE


@pytest.mark.parametrize(
    "probe",
    ["B.displacement", "contact.force", "contact.centre", "beam1.bending_stress", "scene.potential_energy"],
)
def test_nan_is_caught(hinge, hinge_runs, coarse_runs, probe):
    said = with_cprbm(hinge, hinge_runs, spoilt(remembered(hinge_runs).cprbm, probe))
    assert said.word is Word.UNDECIDED
    said = with_fea(hinge, coarse_runs, spoilt(remembered(coarse_runs).fea, probe))
    assert said.word is Word.UNDECIDED

"""Deliberately wrong solvers, made of the real ones: the verdict must say so, or at least not AGREE.

Here on the cases that were made for a fault; :mod:`tests.together.test_faults_everywhere` plants other faults in every
built-in case with a place for the fault.

How each is planted:

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
from comparisons.case import compare
from comparisons.choices import Choices
from comparisons.executor import Solver
from comparisons.pairing import Solvers, cprbm_answer, fea_answer, paired
from comparisons.verdict import Word
from comparisons.verdict.runs import Runs
from cprbm_scene import Answer, Scene
from cprbm_scene.answer import frozen_array
from cprbm_scene.frozendict import frozendict
from tests.together.planted import COARSE, asked_of, remembered

SOLVERS: dict[str, Solver] = {"cprbm": cprbm_answer, "fea": fea_answer}


def word(scene: Scene, runs: Runs, **wrong: Solver) -> Word:
    """The verdict on a wrong solver beside the right one, coarse."""
    return compare(paired(scene, COARSE, replace(remembered(runs), **wrong))).verdict.word


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


def test_the_right_ones_agree(hinge, coarse_runs):
    right = paired(hinge, COARSE, remembered(coarse_runs))
    assert compare(right).verdict.word is Word.AGREE


@pytest.mark.parametrize("solver", SOLVERS)
def test_a_thickness_forgotten_is_caught(hinge, coarse_runs, solver):
    assert word(hinge, coarse_runs, **{solver: asked_of(SOLVERS[solver], thin)}) is Word.DIFFER


@pytest.mark.parametrize(("solver", "probe"), [("cprbm", "beam1.bending_stress"), ("fea", "contact.centre")])
def test_nan_is_caught(hinge, coarse_runs, solver, probe):
    known = getattr(remembered(coarse_runs), solver)
    assert word(hinge, coarse_runs, **{solver: spoilt(known, probe)}) is Word.UNDECIDED


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

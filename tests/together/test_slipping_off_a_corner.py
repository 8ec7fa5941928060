"""A propped cantilever whose end is drawn in over a corner by a dead force at its middle, until it slips off.

==========  =================================================================
P, L        force at the middle; length from the clamp to the free end
w, u, ψ     deflection; what it draws the end in by; slope at the end
e           from the corner to the end at rest
T           thickness, by half of which the corner is below the neutral line
==========  =================================================================

Reference: the linear theory of a beam that is clamped and propped at its ends (Timoshenko, Strength of Materials),
EI w″ = −5P (L − x)/16 + P ⟨L/2 − x⟩, with u = ½ ∫ w′² dx.  The corner comes to the end where u = e + T ψ/2.  From there
the corner's force turns away with 2/T, and draws the end farther in by more than the beam resists.
"""

import re

import numpy as np
import pytest
from scipy.optimize import brentq

import cprbm
import fea_reference
from cprbm_scene import Ending, Loss, Scene, scene_from

L, T, B, E = 0.2, 4e-4, 0.01, 2e9
EI = E * B * T**3 / 12.0
SAG = 0.07  # of L: at the middle, about, when it slips off


def _shape(P: float) -> tuple[float, float, float]:
    """w at the middle, u and ψ."""
    x = np.linspace(0.0, L, 20001)
    bent = (-5.0 * P * (L - x) / 16.0 + P * np.maximum(0.5 * L - x, 0.0)) / EI
    slope = np.concatenate(([0.0], np.cumsum(0.5 * (bent[1:] + bent[:-1]) * np.diff(x))))
    w = np.concatenate(([0.0], np.cumsum(0.5 * (slope[1:] + slope[:-1]) * np.diff(x))))
    drawn = 0.5 * float(np.sum(0.5 * (slope[1:] ** 2 + slope[:-1] ** 2) * np.diff(x)))
    return float(abs(w[10000])), drawn, float(abs(slope[-1]))


def _slips(sag: float) -> tuple[float, float]:
    """P and e where it slips off with such a ``sag`` at the middle, of L."""
    P = brentq(lambda P: _shape(P)[0] - sag * L, 1e-6, 1e3)
    return P, _shape(P)[1] - 0.5 * T * _shape(P)[2]


SLIPS, BEYOND = _slips(SAG)


def _propped(stations: list[float], beyond: str | None, *, turned: bool = False, e: float = BEYOND) -> Scene:
    """From its start to its end, or as the beam is ``turned`` the other way."""
    root, tip = [0.0, 0.0], [L, 0.0]
    welded, free = {"joint": "weld", "point": "R"}, {"joint": "free"}
    corner = [[L - e - 0.05, -0.05], [L - e, -0.5 * T], [L - e + 0.05, -0.05]]
    stage = {"name": "press", "steps": "down", "stations": stations} | ({"beyond": beyond} if beyond else {})
    return scene_from(
        {
            "name": "propped",
            "materials": {"m": {"youngs_modulus": E, "poisson_ratio": 0.3}},
            "bodies": {"wall": {"motion": "fixed", "points": {"R": root}}},
            "beams": {
                "beam": {
                    "curve": {"kind": "line", "start": tip if turned else root, "end": root if turned else tip},
                    "thickness": T,
                    "width": B,
                    "material": "m",
                    "start": free if turned else welded,
                    "end": welded if turned else free,
                }
            },
            "loads": {"down": {"kind": "beam_force", "beam": "beam", "at": 0.5, "direction": [0.0, -1.0]}},
            "contacts": {
                "corner": {"kind": "beam-line", "beam": "beam", "body": "wall", "points": corner, "side": "left"}
            },
            "stages": [stage],
            "probes": [{"of": "scene", "quantity": "potential_energy"}],
        }
    )


@pytest.mark.parametrize(("links", "turned"), [(20, False), (40, False), (40, True)])
def test_the_branch_ends_where_the_end_slips_off_the_corner(links, turned):
    got = cprbm.answer(_propped([0.5 * SLIPS, 1.5 * SLIPS], "stop", turned=turned), cprbm.Settings(links=links))
    assert got.ending is Ending.BRANCH_ENDS, got.sentence
    assert [station.value for station in got.stations] == [0.5 * SLIPS]
    (critical,) = got.critical
    assert (critical.loss, critical.what) == (Loss.SLIP, "corner")
    # the linear theory is off by a part of (w/L)²
    assert critical.value == pytest.approx(SLIPS, rel=0.02)


def test_a_step_over_it_is_noticed():
    # where nothing is asked of ends, both go on to where the end lies on the corner's other side, and say so
    scene = _propped([1.5 * SLIPS], None)
    energies = []
    for got, says in (
        (cprbm.answer(scene, cprbm.Settings(links=80)), Loss.SLIP.value),
        (fea_reference.answer(scene, fea_reference.Settings(elements=20, kinematics="bending")), "slips off in corner"),
    ):
        assert got.completed, got.sentence
        (said,) = (note for note in got.notes if says in note)
        (value,) = re.findall(r"down = ([\d.]+)", said)
        assert float(value) == pytest.approx(SLIPS, rel=0.02)
        energies.append(got.stations[-1].values["scene.potential_energy"])
    assert energies[0] == pytest.approx(energies[1], rel=1e-3)


@pytest.mark.parametrize(("beyond", "turned"), [("stop", False), ("jump", True)])
def test_finite_elements_tell_it_where_a_penalty_as_stiff_as_one_likes_would(beyond, turned):
    # with this penalty the branch folds back 8e-4 before.  What the linear theory is off by goes with (w/L)²; with that
    # taken out by two sags a part of (w/L)⁴ is left
    sags, off = (0.05, 0.07), []
    for sag in sags:
        P, e = _slips(sag)
        scene = _propped([0.5 * P, 1.5 * P], beyond, turned=turned, e=e)
        got = fea_reference.answer(scene, fea_reference.Settings(elements=20, kinematics="bending"))
        assert got.ending is (Ending.BRANCH_ENDS if beyond == "stop" else Ending.COMPLETED), got.sentence
        assert [station.value for station in got.stations] == [0.5 * P, 1.5 * P][: 1 if beyond == "stop" else 2]
        (critical,) = got.critical
        assert (critical.loss, critical.what) == (Loss.SLIP, "corner")
        assert critical.uncertainty < 2e-3 * P
        off.append(critical.value / P - 1.0)
    (a, b), (c, d) = sags, off
    assert abs(b**2 * c - a**2 * d) / (b**2 - a**2) < 2e-4


def test_where_the_end_holds_against_the_force_that_turns_away_the_corner_goes_round_it():
    # as both solvers have it: with less force the beam resists more than the corner's force draws, and nothing ends
    P, e = _slips(0.03)
    scene = _propped([1.5 * P], "stop", e=e)
    answers = [
        cprbm.answer(scene, cprbm.Settings(links=80)),
        fea_reference.answer(scene, fea_reference.Settings(elements=20, kinematics="bending")),
    ]
    assert all(answer.completed for answer in answers)
    energies = [answer.stations[-1].values["scene.potential_energy"] for answer in answers]
    assert energies[0] == pytest.approx(energies[1], rel=1e-3)


def test_finite_elements_in_one_step_and_finer_tell_the_same():
    # as both solvers tell it: the linear theory is a hundredth off here
    told = []
    for elements, penetration in ((20, 1e-4), (40, 6.25e-6)):
        settings = fea_reference.Settings(elements=elements, kinematics="bending", penetration=penetration)
        (critical,) = fea_reference.answer(_propped([1.5 * SLIPS], "stop"), settings).critical
        assert critical.loss is Loss.SLIP
        told.append(critical.value)
    (links,) = cprbm.answer(_propped([1.5 * SLIPS], "stop"), cprbm.Settings(links=160)).critical
    assert told[0] == pytest.approx(told[1], rel=1e-5)
    assert told[1] == pytest.approx(links.value, rel=5e-5)

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
from scene import Ending, Loss, Scene
from scene.reading import scene_from

L, T, B, E = 0.2, 4e-4, 0.01, 2e9
EI = E * B * T**3 / 12.0
SAG = 0.07 * L  # at the middle, about, when it slips off


def _shape(P: float) -> tuple[float, float, float]:
    """w at the middle, u and ψ."""
    x = np.linspace(0.0, L, 20001)
    bent = (-5.0 * P * (L - x) / 16.0 + P * np.maximum(0.5 * L - x, 0.0)) / EI
    slope = np.concatenate(([0.0], np.cumsum(0.5 * (bent[1:] + bent[:-1]) * np.diff(x))))
    w = np.concatenate(([0.0], np.cumsum(0.5 * (slope[1:] + slope[:-1]) * np.diff(x))))
    drawn = 0.5 * float(np.sum(0.5 * (slope[1:] ** 2 + slope[:-1] ** 2) * np.diff(x)))
    return float(abs(w[10000])), drawn, float(abs(slope[-1]))


SLIPS = brentq(lambda P: _shape(P)[0] - SAG, 1e-6, 1e3)
BEYOND = _shape(SLIPS)[1] - 0.5 * T * _shape(SLIPS)[2]  # e


def _propped(stations: list[float], beyond: str | None, *, turned: bool = False) -> Scene:
    """From its start to its end, or as the beam is ``turned`` the other way."""
    root, tip = [0.0, 0.0], [L, 0.0]
    welded, free = {"joint": "weld", "point": "R"}, {"joint": "free"}
    corner = [[L - BEYOND - 0.05, -0.05], [L - BEYOND, -0.5 * T], [L - BEYOND + 0.05, -0.05]]
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
    # where nothing is asked of ends, the march goes on to where the end lies on the corner's other side, and says so
    got = cprbm.answer(_propped([1.5 * SLIPS], None), cprbm.Settings(links=40))
    assert got.completed, got.sentence
    (said,) = (note for note in got.notes if Loss.SLIP.value in note)
    (value,) = re.findall(r"down = ([\d.]+)", said)
    assert float(value) == pytest.approx(SLIPS, rel=0.02)

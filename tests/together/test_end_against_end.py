"""An open ring pressed until its ends meet head-on, circles about them being all that either has before the other."""

import numpy as np
import pytest

import cprbm
import fea_reference
from scene import Ending
from scene.reading import scene_from

THICKNESS, RADIUS, HALF = 0.0011, 0.051, 3.0
LOAD = 6.1  # N; the ends meet at about 4.9


def ring(load, *, contact):
    start, end = ([float(RADIUS * np.cos(HALF)), float(side * RADIUS * np.sin(HALF))] for side in (-1.0, 1.0))
    return scene_from(
        {
            "name": "ring",
            "materials": {"m": {"youngs_modulus": 114e9, "poisson_ratio": 0.33}},
            "bodies": {
                "wall": {"motion": "fixed", "points": {"R": start}},
                "tip": {"motion": "slides", "along": [0.0, 1.0], "points": {"T": end}},
            },
            "beams": {
                "strip": {
                    "curve": {
                        "kind": "arc",
                        "center": [0.0, 0.0],
                        "start": start,
                        "end": end,
                        "direction": "counterclockwise",
                    },
                    "thickness": THICKNESS,
                    "width": 0.011,
                    "material": "m",
                    "start": {"joint": "weld", "point": "R"},
                    "end": {"joint": "weld", "point": "T"},
                }
            },
            "loads": {"press": {"kind": "force", "point": "T", "direction": [0.0, -1.0]}},
            "contacts": {"itself": {"kind": "beam-self", "beam": "strip"}} if contact else {},
            "stages": [{"name": "press", "steps": "press", "stations": [load]}],
            "probes": [
                {"of": "scene", "quantity": "potential_energy"},
                {"of": "T", "quantity": "displacement"},
                *([{"of": "itself", "quantity": "force"}] if contact else []),
            ],
        }
    )


def test_ends_that_meet_share_the_load():
    """The ends are above each other and cannot turn: what they carry is what the ring does not."""
    settings = fea_reference.Settings(elements=33, kinematics="bending")
    found = fea_reference.answer(ring(LOAD, contact=True), settings)
    assert found.ending is Ending.COMPLETED, found.sentence
    station = found.stations[-1]
    shape, carried = station.shapes["strip"], station.values["itself.force"].item()
    apart = np.hypot(shape.x[-1] - shape.x[0], shape.y[-1] - shape.y[0])
    # geometry; the penetration asked is 1e-4 of the thickness
    assert apart == pytest.approx(THICKNESS, rel=3e-4)
    assert carried > 0.1 * LOAD
    # the other solver, of the ring alone, under the rest of the load
    alone = cprbm.answer(ring(LOAD - carried, contact=False), cprbm.Settings(links=80))
    assert alone.ending is Ending.COMPLETED, alone.sentence
    expected = alone.stations[-1].values["T.displacement"]
    assert station.values["T.displacement"] == pytest.approx(expected, abs=1e-3 * abs(expected[1]))


@pytest.mark.parametrize(("load", "meet"), [(4.5, False), (5.0, True)])
def test_the_links_end_where_ends_meet_which_they_cannot_hold_apart(load, meet):
    """The ring alone says whether its ends would overlap: an answer without a force is then none."""
    settings = cprbm.Settings(links=53)
    shape = cprbm.answer(ring(load, contact=False), settings).stations[-1].shapes["strip"]
    apart = float(np.hypot(shape.x[-1] - shape.x[0], shape.y[-1] - shape.y[0]))
    assert (apart < THICKNESS) is meet
    found = cprbm.answer(ring(load, contact=True), settings)
    assert found.ending is (Ending.BEAMS_CROSSED if meet else Ending.COMPLETED)
    assert len(found.stations) == (0 if meet else 1)

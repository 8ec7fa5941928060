"""An open ring pressed until its ends meet head-on, circles about them being all that either has before the other."""

import numpy as np
import pytest

import cprbm
import fea_reference
from cprbm_scene import Ending, scene_from

THICKNESS, RADIUS, HALF = 0.0011, 0.051, 3.0
SLENDER = 0.000265
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


LINKS = cprbm.Settings(links=80, tolerance=1e-12)  # nine digits of the thickness are held against geometry
ELEMENTS = fea_reference.Settings(elements=33, kinematics="bending")


@pytest.mark.parametrize("links", [True, False], ids=["links", "elements"])
def test_ends_that_meet_share_the_load(links):
    """The ends are above each other and cannot turn: what they carry is what the ring does not."""
    scene = ring(LOAD, contact=True)
    found = cprbm.answer(scene, LINKS) if links else fea_reference.answer(scene, ELEMENTS)
    assert found.ending is Ending.COMPLETED, found.sentence
    station = found.stations[-1]
    shape, carried = station.shapes["strip"], station.values["itself.force"].item()
    apart = np.hypot(shape.x[-1] - shape.x[0], shape.y[-1] - shape.y[0])
    # geometry; the penetration that the elements are asked for is 1e-4 of the thickness
    assert apart == pytest.approx(THICKNESS, rel=1e-9 if links else 3e-4)
    assert carried > 0.1 * LOAD
    # the other solver, of the ring alone, under the rest of the load
    rest = ring(LOAD - carried, contact=False)
    alone = fea_reference.answer(rest, ELEMENTS) if links else cprbm.answer(rest, LINKS)
    assert alone.ending is Ending.COMPLETED, alone.sentence
    expected = alone.stations[-1].values["T.displacement"]
    assert station.values["T.displacement"] == pytest.approx(expected, abs=1e-3 * abs(expected[1]))


def test_ends_that_meet_slip_off_each_other_to_the_side_on_which_they_are():
    """A strip whose width varies is rolled up: its ends are above each other by a third of the thickness as they meet.

    Reference: the way there, on which no station lets an end go further than the thickness, by the other solver.
    """
    scene = rolled_up((5.57, 5.58, 5.6, 5.63, 5.7, 5.8))
    steps = fea_reference.answer(scene, fea_reference.Settings(elements=40, kinematics="bending"))
    assert steps.completed, steps.sentence
    shape = steps.stations[0].shapes["strip"]
    assert np.hypot(shape.x[-1] - shape.x[0], shape.y[-1] - shape.y[0]) > SLENDER
    at_once = cprbm.answer(rolled_up((5.8,)), cprbm.Settings(links=80))
    assert at_once.completed, at_once.sentence
    for probe, values in steps.stations[-1].values.items():
        size = np.linalg.norm(values)
        allowed = 0.05 if probe == "itself.force" else 2e-3
        assert at_once.stations[-1].values[probe] == pytest.approx(values, abs=allowed * size), probe


@pytest.mark.parametrize("elements", [23, 41])
def test_elements_go_round_the_end_that_they_meet_in_one_step_too(elements):
    """The same strip, asked at one roll: an end that went through the other had a third of the force, certified.

    Reference: the way there, on which no station lets an end go further than the thickness, by the other solver.
    """
    steps = cprbm.answer(rolled_up((5.57, 5.58, 5.6, 5.63, 5.7, 5.8, 6.31)), cprbm.Settings(links=80))
    assert steps.completed, steps.sentence
    at_once = fea_reference.answer(rolled_up((6.31,)), fea_reference.Settings(elements=elements, kinematics="bending"))
    assert at_once.completed, at_once.sentence
    for probe, values in steps.stations[-1].values.items():
        allowed = 0.05 if probe == "itself.force" else 2e-3
        assert at_once.stations[-1].values[probe] == pytest.approx(values, abs=allowed * np.linalg.norm(values)), probe


def rolled_up(turns):
    start, end = [0.0, 0.0], [-0.0080537, 0.0755034]
    return scene_from(
        {
            "name": "rolled",
            "materials": {"m": {"youngs_modulus": 1.37e9, "poisson_ratio": 0.42}},
            "bodies": {
                "wall": {"motion": "fixed", "points": {"R": start}},
                "tip": {"motion": "free", "points": {"T": end}},
            },
            "beams": {
                "strip": {
                    "curve": {
                        "kind": "arc",
                        "center": [-0.09229453354991723, 0.02833647574511918],
                        "start": start,
                        "end": end,
                        "direction": "counterclockwise",
                    },
                    "thickness": SLENDER,
                    "width": {"at": [0.0, 0.3, 0.9, 1.0], "values": [0.0128, 0.0119, 0.0125, 0.00671]},
                    "material": "m",
                    "start": {"joint": "weld", "point": "R"},
                    "end": {"joint": "weld", "point": "T"},
                }
            },
            "drives": {"roll": {"kind": "rotation", "body": "tip"}},
            "contacts": {"itself": {"kind": "beam-self", "beam": "strip"}},
            "stages": [{"name": "roll", "steps": "roll", "stations": list(turns)}],
            "probes": [
                {"of": "scene", "quantity": "potential_energy"},
                {"of": "T", "quantity": "displacement"},
                {"of": "itself", "quantity": "force"},
            ],
        }
    )

"""A cantilever pressed onto rigid bodies far smaller than an element, against the closed form for points."""

import numpy as np
import pytest

import cprbm
from scene import Scene
from tests.fea_reference.on_an_edge import WIDTH, T
from tests.references.pressed import Pressed


def beam_onto(contacts, load, *, thick):
    """A beam of unit length and EI from the origin along x, with ``contacts`` by their names, under a load."""
    tip = {"kind": "force", "point": "tip", "direction": (0.0, 1.0)}
    along = {"kind": "beam_force", "beam": "beam", "at": load.at, "direction": (0.0, 1.0)}
    block = {"motion": "free"} if load.tip == "free" else {"motion": "slides", "along": (1.0, 0.0)}
    loads = {
        "P": (load.force, tip if load.tip == "free" else along),
        "M": (load.moment, {"kind": "moment", "body": "block"}),
    }
    acting = {name: (value, of) for name, (value, of) in loads.items() if value}
    probes = [("tip", "displacement"), *((name, "force") for name in contacts)]
    return Scene.model_validate(
        {
            "name": "tiny",
            "materials": {"m": {"youngs_modulus": 12.0 / (WIDTH * T**3), "poisson_ratio": 0.3}},
            "bodies": {
                "ground": {"motion": "fixed", "points": {"root": (0.0, 0.0)}},
                "block": {**block, "points": {"tip": (1.0, 0.0)}},
            },
            "beams": {
                "beam": {
                    "curve": {"kind": "line", "start": (0.0, 0.0), "end": (1.0, 0.0)},
                    "thickness": T,
                    "width": WIDTH,
                    "material": "m",
                    "start": {"joint": "weld", "point": "root"},
                    "end": {"joint": "pin" if load.tip == "pinned" else "weld", "point": "tip"},
                }
            },
            "loads": {name: of for name, (_, of) in acting.items()},
            "contacts": {
                name: {"beam": "beam", "body": "ground", "thick": thick, **of} for name, of in contacts.items()
            },
            "stages": tuple({"name": f"s{n}", "steps": n, "stations": (value,)} for n, (value, _) in acting.items()),
            "probes": tuple({"of": of, "quantity": quantity} for of, quantity in probes),
        }
    )


def solved(scene, links):
    answer = cprbm.answer(scene, cprbm.Settings(links=links))
    assert answer.completed, answer.sentence
    return answer.stations[-1].values


@pytest.mark.parametrize("thick", [False, True])
@pytest.mark.parametrize("links", [20, 40, 80])
@pytest.mark.parametrize("radius", [1e-4, 1e-3, 1e-2])
def test_a_circle_smaller_than_an_element_presses_as_a_point_does(radius, links, thick):
    # one in the middle of an element, one at a joint; the slope is 0.02 at most, its square what is left out
    load, places, gaps = Pressed(force=-0.04), np.array([0.411, 0.75]), np.array([0.0004, 0.0035])
    half = 0.5 * T if thick else 0.0
    circles = {
        f"c{i}": {"kind": "beam-circle", "center": (float(x), -float(gap) - radius - half), "radius": radius}
        for i, (x, gap) in enumerate(zip(places, gaps, strict=True))
    }
    values = solved(beam_onto(circles, load, thick=thick), links)
    forces, tip = load.onto(places, gaps, np.ones(2))
    assert [values[f"{name}.force"][0] for name in circles] == pytest.approx(forces, rel=0.02, abs=1e-3)
    assert values["tip.displacement"][1] == pytest.approx(tip, rel=0.02)

"""A cantilever that lies on an edge from its clamp on, pressed down at one place: nothing bends, only the edge acts."""

import numpy as np
import pytest

import cprbm
from cprbm_scene import scene_from
from tests.cprbm.scenes import LENGTH, RIGIDITY, THICKNESS, cantilever_data, drives_of

FORCE = 1.3 * RIGIDITY / LENGTH**2
DRAWN_AT = 0.7


def turned(x, y):
    cos, sin = np.cos(DRAWN_AT), np.sin(DRAWN_AT)
    return [float(cos * x - sin * y), float(sin * x + cos * y)]


def pressed(clamped, at, gap=0.0, lean=0.0, along=False, block=False):
    """The cantilever with its start or its end ``clamped``, pressed at a share ``at`` of its length from there.

    Or it is drawn ``gap`` above the edge, which falls by ``lean``; or pulled ``along`` itself.  The edge is the wall's,
    or that of a ``block`` which drives hold.
    """
    down = {"kind": "beam_force", "beam": "beam", "at": at if clamped == "start" else 1.0 - at}
    data = cantilever_data({**down, "direction": turned(1.0, 0.0) if along else turned(0.0, -1.0)}, [FORCE])
    data["bodies"] = {"wall": {"motion": "fixed", "points": {"R": [0.0, 0.0]}}}
    ends = {"start": ([0.0, 0.0], {"joint": "weld", "point": "R"}), "end": (turned(LENGTH, 0.0), {"joint": "free"})}
    if clamped == "end":
        ends = {"start": ends["end"], "end": ends["start"]}
    line = {"kind": "line", "start": ends["start"][0], "end": ends["end"][0]}
    data["beams"]["beam"] |= {"curve": line, "start": ends["start"][1], "end": ends["end"][1]}
    below = {"point": turned(0.0, -0.5 * THICKNESS - gap), "normal": turned(lean, 1.0)}
    data["contacts"] = {"edge": {"kind": "beam-half-plane", "beam": "beam", "body": "wall", **below}}
    if block:
        data["bodies"]["block"] = {"motion": "free", "points": {"Q": turned(0.017, -0.023)}}
        data["contacts"]["edge"]["body"], data["drives"] = "block", drives_of("Q", "block")
    data["probes"] = [{"of": "edge", "quantity": quantity} for quantity in ("force", "centre", "ends")]
    data["probes"] += [{"of": "R", "quantity": quantity} for quantity in ("reaction", "reaction_moment")]
    return scene_from(data)


@pytest.mark.parametrize(("links", "block"), [(20, False), (37, False), (20, True)])
@pytest.mark.parametrize("at", [0.37, 0.6])
@pytest.mark.parametrize("clamped", ["start", "end"])
def test_the_force_goes_straight_through(clamped, at, links, block):
    answer = cprbm.answer(pressed(clamped, at, block=block), cprbm.Settings(links=links))
    assert answer.completed, answer.sentence
    values, element = answer.stations[-1].values, 1.0 / links
    place, error = at if clamped == "start" else 1.0 - at, 0.5 * (element / at) ** 2
    assert values["edge.force"][0] == pytest.approx(FORCE, rel=error)
    assert values["edge.centre"][0] == pytest.approx(place * LENGTH, abs=error * at * LENGTH)
    # what presses are the joints beside the place, and not the clamp
    assert values["edge.ends"] == pytest.approx([place * LENGTH] * 2, abs=1.001 * element * LENGTH)
    assert values["R.reaction_moment"][0] == pytest.approx(0.0, abs=error * at * FORCE * LENGTH)


@pytest.mark.parametrize("gap", [0.0, 0.02 * LENGTH])
def test_a_pull_along_it_moves_nothing(gap):
    # neither a link nor the rate at which one would turn
    answer = cprbm.answer(pressed("start", 0.37, gap=gap, along=True), cprbm.Settings(links=20))
    assert answer.completed, answer.sentence
    values = answer.stations[-1].values
    assert values["R.reaction"] == pytest.approx(turned(-FORCE, 0.0), rel=1e-12)
    assert values["R.reaction_moment"][0] == pytest.approx(0.0, abs=1e-9 * FORCE * LENGTH)
    assert values["edge.force"][0] == pytest.approx(0.0, abs=1e-9 * FORCE)


@pytest.mark.parametrize(("beyond", "links"), [("stop", 100), ("jump", 80)])
def test_the_flat_part_of_a_buckled_strip_buckles_off(beyond, links):
    """A strip between clamps bends out by H to a wall, and lies flat there between two bent parts of 2π/k, k² = P/EI.

    The flat part is clamped by the bent parts and buckles at k (L − 4π/k) = 2π: k = 6π/L and P = 36 π² EI/L².
    The ends have come closer by PL/EA + 3 H² k/4π; the slopes are small to 2 %.
    """
    young, length, thickness, width, gap = 2e11, 0.1, 5e-4, 0.01, 3e-3
    rigidity, area = young * width * thickness**3 / 12.0, width * thickness
    force, height = 36.0 * np.pi**2 * rigidity / length**2, gap - 0.5 * thickness
    shortening = force * length / (young * area) + 4.5 * height**2 / length
    stations = [shortening * share for share in (0.5, 0.75, 0.97, 1.1, 1.2)]
    beam = {"curve": {"kind": "line", "start": [0.0, 0.0], "end": [length, 0.0]}, "material": "m"}
    beam |= {"thickness": thickness, "width": width, "imperfection": {"amplitude": 2e-5, "half_waves": 1}}
    beam |= {"start": {"joint": "weld", "point": "A"}, "end": {"joint": "weld", "point": "T"}}
    wall = {"kind": "beam-half-plane", "beam": "strip", "body": "g", "point": [0.0, gap], "normal": [0.0, -1.0]}
    answer = cprbm.answer(
        scene_from(
            {
                "name": "strip",
                "theory": "stretch",
                "materials": {"m": {"youngs_modulus": young, "poisson_ratio": 0.3}},
                "bodies": {
                    "g": {"motion": "fixed", "points": {"A": [0.0, 0.0]}},
                    "b": {"motion": "slides", "along": [1.0, 0.0], "points": {"T": [length, 0.0]}},
                },
                "beams": {"strip": beam},
                "contacts": {"wall": wall},
                "drives": {"v": {"kind": "displacement", "point": "T", "direction": [-1.0, 0.0]}},
                "stages": [{"name": "press", "steps": "v", "stations": stations, "beyond": beyond}],
                "probes": [{"of": "T", "quantity": "reaction"}],
            }
        ),
        cprbm.Settings(links=links),
    )
    assert answer.critical[0].value == pytest.approx(shortening, rel=0.02)
    assert len(answer.stations) == (3 if beyond == "stop" else 5), answer.sentence
    assert all(abs(station.values["T.reaction"][0]) < force for station in answer.stations)

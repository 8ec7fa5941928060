"""A slider with a round nose on a leaf spring under a dead force: only the contact holds the slider."""

import math

import numpy as np
import pytest
from scipy.optimize import fsolve, minimize_scalar

import cprbm
from cprbm_scene import Ending, Loss, scene_from
from tests.cprbm.scenes import cantilever_data
from tests.references.integrated import end_of

LENGTH, PLACE, RADIUS, HALF = 0.1, 0.07, 0.005, 0.0005
RIGIDITY = 2e11 * 0.01 * (2.0 * HALF) ** 3 / 12.0


def scene_of(**stages):
    data = cantilever_data({"kind": "force", "point": "N", "direction": [0.0, -1.0]}, [1.0])
    data["materials"]["m"]["youngs_modulus"] = 2e11
    data["bodies"]["tip"]["points"]["T"] = [LENGTH, 0.0]
    data["bodies"]["slider"] = {"motion": "slides", "along": [0.0, 1.0], "points": {"N": [PLACE, 0.01]}}
    data["beams"]["beam"] |= {"thickness": 2.0 * HALF, "width": 0.01}
    data["beams"]["beam"]["curve"]["end"] = [LENGTH, 0.0]
    data["contacts"] = {
        "nose": {
            "kind": "beam-circle",
            "beam": "beam",
            "body": "slider",
            "center": [PLACE, RADIUS + 1.2 * HALF],
            "radius": RADIUS,
        }
    }
    (load,) = data["loads"]
    data["stages"] = [{"name": name, "steps": load, "stations": values} for name, values in stages.items()]
    data["probes"] = [{"of": "N", "quantity": "displacement"}, {"of": "nose", "quantity": "force"}]
    return scene_from(data)


@pytest.fixture(scope="module")
def largest_weight():
    """Largest weight of the equilibria, by shooting from the contact to the clamp for a tangent angle there."""
    offset = RADIUS + HALF
    start = [10.0, PLACE]

    def weight(angle):
        def clamp(unknowns):
            force, arc = unknowns
            across, down = force * np.tan(angle), -force

            def rates(_, state):
                _, _, tangent, moment = state
                cos, sin = math.cos(tangent), math.sin(tangent)
                return [-cos, -sin, -moment / RIGIDITY, cos * down - sin * across]

            x, _, tangent, _ = end_of(rates, (0.0, arc), [0.0, 0.0, angle, 0.0], rtol=1e-8, atol=1e-10)
            return [tangent, (-x - offset * np.sin(angle) - PLACE) / PLACE]

        start[:] = fsolve(clamp, start)
        return start[0]

    for angle in -np.radians([10.0, 20.0, 30.0, 36.0]):
        weight(angle)
    found = minimize_scalar(lambda angle: -weight(angle), bounds=(-0.77, -0.63), options={"xatol": 1e-3})
    return -found.fun


def test_the_branch_ends_at_the_largest_weight(largest_weight):
    # reference: the shooting above; beyond it two joints on the nose hold the slider like a valley, at any weight
    answer = cprbm.answer(scene_of(press=[5.0, 30.0, 34.0]), cprbm.Settings(links=20))
    (end,) = answer.critical
    assert answer.ending is Ending.BRANCH_ENDS
    assert end.loss is Loss.FOLD
    assert end.value == pytest.approx(largest_weight, rel=3e-4)


def test_a_pull_ends_the_branch_where_the_contact_opens():
    # reference: statics, since nothing but the contact holds the slider
    answer = cprbm.answer(scene_of(press=[1.0], pull=[-0.5]), cprbm.Settings(links=20))
    (end,) = answer.critical
    assert answer.ending is Ending.BRANCH_ENDS
    assert (end.loss, end.what) == (Loss.CONTACT, "nose")
    assert abs(end.value) < 1e-4


def between_leaves(noses, leaves, **stepped):
    """Leaves (height) of 80 mm on the ground, or on a jaw, and noses (name, body, leaf, place, height); mm."""
    ends = {"ground": [], "jaw": []}
    beams = {}
    for name, (height, body) in leaves.items():
        ends[body].append(name)
        line = {"kind": "line", "start": [0.0, 1e-3 * height], "end": [0.08, 1e-3 * height]}
        beams[name] = {"curve": line, "thickness": 1e-3, "width": 8e-3, "material": "steel"}
        beams[name] |= {"start": {"joint": "weld", "point": f"on {name}"}, "end": {"joint": "free"}}
    bodies = {
        body: {
            **({"motion": "fixed"} if body == "ground" else {"motion": "slides", "along": [0.0, 1.0]}),
            "points": {f"on {name}": beams[name]["curve"]["start"] for name in names},
        }
        for body, names in ends.items()
        if names
    }
    contacts = {}
    for name, (body, leaf, place, height) in noses.items():
        bodies.setdefault(
            body, {"motion": "slides", "along": [0.0, 1.0], "points": {f"on {body}": [1e-3 * place, 0.07]}}
        )
        circle = {"kind": "beam-circle", "beam": leaf, "body": body, "radius": 6e-3}
        contacts[name] = {**circle, "center": [1e-3 * place, 1e-3 * height]}
    return scene_from(
        {
            "name": "noses",
            "theory": "bending",
            "materials": {"steel": {"youngs_modulus": 2e11, "poisson_ratio": 0.3}},
            "bodies": bodies,
            "beams": beams,
            "contacts": contacts,
            **stepped,
            "probes": [
                *({"of": name, "quantity": "force"} for name in noses),
                *({"of": f"on {name}", "quantity": "displacement"} for name in bodies if name not in ends),
                *({"of": f"on {name}", "quantity": "reaction"} for name in ends["ground"]),
            ],
        }
    )


def test_a_disk_gripped_by_like_leaves_moves_half_as_far_as_the_jaw():
    # reference: symmetry about the disk
    scene = between_leaves(
        {"low": ("disk", "a", 60.0, 6.5), "high": ("disk", "b", 60.0, 6.5)},
        {"a": (0.0, "ground"), "b": (13.0, "jaw")},
        drives={"d": {"kind": "displacement", "point": "on b", "direction": [0.0, -1.0]}},
        stages=[{"name": "grip", "steps": "d", "stations": [0.5e-3, 2e-3]}],
    )
    answer = cprbm.answer(scene, cprbm.Settings(links=20))
    assert answer.completed, answer.sentence
    for station in answer.stations:
        assert station.values["on disk.displacement"] == pytest.approx([0.0, -0.5 * station.value], abs=1e-12)
        assert station.values["low.force"] == pytest.approx(station.values["high.force"], rel=1e-9)


def test_a_force_goes_through_a_body_between_two_leaves():
    # reference: statics, both leaves together bear the force on the upper body
    scene = between_leaves(
        {"k1": ("low", "a", 60.0, 6.5), "k2": ("low", "b", 60.0, 33.5), "k3": ("high", "b", 70.0, 46.5)},
        {"a": (0.0, "ground"), "b": (40.0, "ground")},
        loads={"F": {"kind": "force", "point": "on high", "direction": [0.0, -1.0]}},
        stages=[{"name": "on", "steps": "F", "stations": [0.5, 4.0]}, {"name": "off", "steps": "F", "stations": [0.5]}],
    )
    answer = cprbm.answer(scene, cprbm.Settings(links=20))
    assert answer.completed, answer.sentence
    for station in answer.stations:
        borne = station.values["on a.reaction"] + station.values["on b.reaction"]
        assert borne[1] == pytest.approx(station.value, rel=1e-9)
        assert station.values["k1.force"][0] > 0.5 * station.value
    first, _, last = answer.stations
    assert last.values["on high.displacement"] == pytest.approx(first.values["on high.displacement"], rel=1e-9)

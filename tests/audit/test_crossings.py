"""Undeclared contact in made-up answers, with overlaps from plane geometry, and the verdict on a real scene."""

from pathlib import Path

import numpy as np
import pytest

import comparisons
from comparisons.audit import audit
from comparisons.choices import Choices
from comparisons.verdict import Reason, Word
from cprbm_scene import Answer, Ending, SceneError, Shape, StationAnswer, read, scene_from
from cprbm_scene.answer import BeamState
from tests.cprbm.scenes import LENGTH, MOMENT, RIGIDITY, cantilever_data
from tests.verdict.made_up import CERTIFICATE

SCENE = Path(__file__).parents[1] / "scenes" / "undeclared-contact.toml"
T = 1e-3


def line(start, end, count=41):
    return np.linspace(start, end, count)


def arc(radius, length, count):
    angle = np.linspace(0.0, length / radius, count)
    return radius * np.column_stack((np.cos(angle), np.sin(angle)))


def scene_of(beams, contacts=(), thickness=T, **keys):
    """Straight beams ``{name: (start, end)}``, welded to the ground at the starts, beside a body ``slide``."""
    points = {f"P{name}": list(start) for name, (start, _) in beams.items()}
    return scene_from(
        {
            "name": "drawn",
            "theory": "bending",
            "materials": {"steel": {"youngs_modulus": 2e11, "poisson_ratio": 0.3}},
            "bodies": {
                "ground": {"motion": "fixed", "points": points},
                "slide": {"motion": "slides", "along": [1.0, 0.0], "points": {"S": list(beams["a"][1])}},
            },
            "beams": {
                name: {
                    "curve": {"kind": "line", "start": list(start), "end": list(end)},
                    "thickness": thickness,
                    "width": 0.01,
                    "material": "steel",
                    "start": {"joint": "weld", "point": f"P{name}"},
                    "end": {"joint": "weld", "point": "S"} if name == "a" else {"joint": "free"},
                }
                for name, (start, end) in beams.items()
            },
            "loads": {"F": {"kind": "force", "point": "S", "direction": [1.0, 0.0]}},
            "contacts": dict(contacts),
            "stages": [{"name": "push", "steps": "F", "stations": [1.0, 2.0, 3.0]}],
            "probes": [{"of": "S", "quantity": "displacement"}],
            **keys,
        }
    )


def crossings(scene, *drawn, slide=(0.0, 0.0, 0.0)):
    """Sentences on neutral lines ``{name: places}``, a dictionary for every station; other beams stay at rest."""
    stations = []
    for value, lines in zip(scene.stages[0].stations, drawn, strict=False):
        lines = {name: line(beam.curve.start, beam.curve.end) for name, beam in scene.beams.items()} | lines
        shapes, states = {}, {}
        for name, places in lines.items():
            curve = scene.beams[name].curve
            s = np.linspace(0.0, np.hypot(*np.subtract(curve.end, curve.start)), len(places))
            x, y = places.T
            angle, zero = np.unwrap(np.arctan2(*(np.gradient(of, s, edge_order=2) for of in (y, x)))), np.zeros(len(s))
            shapes[name], states[name] = Shape(s, x, y), BeamState(s, x, y, angle, angle, zero, zero, zero, s)
        bodies = {"slide": np.array(slide)}
        stations.append(StationAnswer("push", value, {}, shapes, {}, CERTIFICATE, beams=states, bodies=bodies))
    return audit(scene, Answer("planted", scene.name, {}, Ending.COMPLETED, "", tuple(stations))).crossings


BESIDE = {"a": ((0.0, 0.05), (0.05, 0.05)), "b": ((0.0, 0.0), (0.1, 0.0))}
"""Two parallel beams, 50 mm apart."""


def dropped(depth):
    """The beam ``a`` upright above the middle of ``b``, with the free end ``depth`` below the line of ``b``."""
    return {"a": line((0.05, 0.05 - depth), (0.05, -depth))}


def test_a_beam_that_passes_through_another_is_named_once_with_the_first_load():
    (said,) = crossings(scene_of(BESIDE), {}, dropped(0.007), dropped(0.011))
    assert "a and b pass through each other from push 2 N on, and no contact" in said
    assert "add a contact of a and b" in said
    assert 'may_cross = [["a", "b"]]' in said


@pytest.mark.parametrize(
    ("gap", "deep"), [(0.0, 0), (-0.04 * T, 0), (-0.1 * T, 1)], ids=["touch", "within the floor", "overlap"]
)
def test_beams_side_by_side_cross_if_they_overlap_by_more_than_the_floor(gap, deep):
    assert len(crossings(scene_of(BESIDE), {"a": line((0.0, T + gap), (0.05, T + gap))})) == deep


@pytest.mark.parametrize(("gap", "deep"), [(T, 0), (0.5 * T, 1)])
def test_bent_beams_with_few_stated_places_lie_on_their_arcs(gap, deep):
    # a chord of the outer arc between two of 21 places cuts 0.06 mm off, more than the floor
    lines = {"a": arc(0.05, 0.05, 41), "b": arc(0.05 + gap, 0.1, 21)}
    assert len(crossings(scene_of(BESIDE), lines)) == deep


@pytest.mark.parametrize(("thickest", "cross"), [("start", 1), ("end", 0)])
def test_the_thickness_of_a_tapered_beam_counts_where_the_other_beam_lies(thickest, cross):
    values = [4 * T, 0.4 * T] if thickest == "start" else [0.4 * T, 4 * T]
    scene = scene_of(BESIDE, thickness={"at": [0.0, 1.0], "values": values})
    near = {"a": line((0.0, 2.0 * T), (-0.05, 2.0 * T)), "b": line((0.0, 0.0), (0.1, 0.0))}
    assert len(crossings(scene, near)) == cross


@pytest.mark.parametrize(
    "keys",
    [
        {"may_cross": [["b", "a"]]},
        {"contacts": {"both": {"kind": "beam-beam", "between": ["a", "b"]}}},
    ],
    ids=["may_cross", "contact"],
)
def test_a_pair_that_the_scene_names_may_cross(keys):
    assert crossings(scene_of(BESIDE, **keys), dropped(0.007)) == ()


@pytest.mark.parametrize(
    "beams",
    [
        {"a": ((0.0, 0.0), (0.0, 0.05)), "b": ((0.0, 0.0), (0.1, 0.0))},
        {"a": ((0.03, -0.02), (0.03, 0.03)), "b": ((0.0, 0.0), (0.1, 0.0))},
        {"a": ((0.0, T), (0.05, T)), "b": ((0.0, 0.0), (0.1, 0.0))},
    ],
    ids=["common joint", "crossing at rest", "touch at rest"],
)
def test_beams_that_touch_at_rest_may_cross(beams):
    assert crossings(scene_of(beams), dropped(0.007)) == ()


EDGES = {
    "disc": {"kind": "beam-circle", "center": [0.05, -0.03], "radius": 0.01},
    "wall": {"kind": "beam-line", "points": [[0.0, -0.02], [0.1, -0.02]], "side": "left"},
    "floor": {"kind": "beam-half-plane", "point": [0.0, -0.02], "normal": [0.0, 2.0]},
    "graph": {"kind": "beam-function", "axis": "x", "coefficients": [-0.02, 0.0], "range": [0.0, 0.1], "side": "above"},
}
AWAY = {"b": line((0.0, 0.0), (-0.1, 0.0))}


@pytest.mark.parametrize("edge", EDGES)
@pytest.mark.parametrize("allowed", [False, True])
def test_a_beam_passes_through_a_rigid_edge_that_another_beam_may_touch(edge, allowed):
    keys = {"may_cross": [["a", edge]]} if allowed else {}
    scene = scene_of(BESIDE, {edge: {**EDGES[edge], "body": "ground", "beam": "b"}}, **keys)
    assert crossings(scene, dropped(0.019) | AWAY) == ()  # 0.5 mm above the edge
    assert len(crossings(scene, dropped(0.025) | AWAY)) == (0 if allowed else 1)


def test_an_edge_moves_with_the_body():
    scene = scene_of(BESIDE, {"disc": {**EDGES["disc"], "body": "slide", "beam": "b"}})
    path = dropped(0.025) | AWAY
    assert len(crossings(scene, path)) == 1
    assert crossings(scene, path, slide=(0.02, 0.0, 0.0)) == ()
    # half a turn about S, 80 mm above the centre, takes the disc above both beams
    assert crossings(scene, path, slide=(0.0, 0.0, np.pi)) == ()


def test_undeclared_contact():
    compared = comparisons.compare(read(SCENE), Choices(links=20, elements=20))
    verdict = compared.verdict
    assert verdict.word is Word.UNDECIDED
    # at 5 N the upper beam, 10 mm above, moves down by about F L³/(3 E I) = 10 mm and touches the lower one; at 10 N it
    # moves by almost 20 mm
    assert "up and lo pass through each other" in verdict.because
    assert "from undeclared-contact 10 N on" in verdict.because
    assert 'may_cross = [["up", "lo"]]' in verdict.because
    allowed = read(SCENE).model_copy(update={"may_cross": (("lo", "up"),)})
    assert comparisons.compare(allowed, Choices(links=20, elements=20)).verdict.word is Word.AGREE


def rolled(turns):
    """The beam ``b``, 100 thicknesses long, that a moment at the end rolls up to a circle."""
    return {"b": arc(0.1 / (2.0 * np.pi * turns), 0.1, 401)}


@pytest.mark.parametrize(("turns", "cross"), [(0.9, 0), (0.98, 0), (1.0, 1), (1.3, 1)])
def test_a_beam_that_is_rolled_by_more_than_a_turn_passes_through_itself(turns, cross):
    # at 0.98 turns both ends are two thicknesses apart
    assert len(crossings(scene_of(BESIDE), rolled(turns))) == cross


def test_a_beam_that_passes_through_itself_is_named_once_with_the_first_load():
    (said,) = crossings(scene_of(BESIDE), rolled(0.5), rolled(1.1), rolled(1.3))
    assert "b passes through itself from push 2 N on" in said
    assert 'may_cross = [["b", "b"]]' in said
    half = line((-0.02, 0.0), (0.0, 0.02)), line((0.0, 0.02), (0.005, -0.02)), line((0.005, -0.02), (-0.02, 0.015))
    assert len(crossings(scene_of(BESIDE), {"b": np.concatenate((half[0], half[1][1:], half[2][1:]))})) == 1
    # a hairpin of two straight legs about a radius of 0.8 thicknesses
    s = np.linspace(0.0, 0.1, 2001)
    turn = np.clip((s - 0.04) / (0.8 * T), 0.0, np.pi)
    places = np.column_stack([np.cumsum(of) * s[1] for of in (np.cos(turn), np.sin(turn))])
    assert crossings(scene_of(BESIDE), {"b": places}) == ()
    keys = {"contacts": {"both": {"kind": "beam-beam", "between": ["a", "b"]}}}
    assert len(crossings(scene_of(BESIDE, **keys), rolled(1.3))) == 1


@pytest.mark.parametrize(
    "keys",
    [{"may_cross": [["b", "b"]]}, {"contacts": {"own": {"kind": "beam-self", "beam": "b"}}}],
    ids=["may_cross", "contact"],
)
def test_a_beam_may_pass_through_itself_where_the_scene_permits_it(keys):
    assert crossings(scene_of(BESIDE, **keys), rolled(1.3)) == ()


def test_an_edge_twice_is_a_mistake():
    with pytest.raises(SceneError, match="two different names, or a beam twice"):
        scene_of(BESIDE, {"disc": {**EDGES["disc"], "body": "ground", "beam": "b"}}, may_cross=[["disc", "disc"]])


def test_a_cantilever_that_a_moment_rolls_by_more_than_a_turn_is_undecided():
    # a moment of 2 pi E I/L rolls the cantilever to a full circle
    scene = scene_from(cantilever_data(MOMENT, [turns * 2.0 * np.pi * RIGIDITY / LENGTH for turns in (0.9, 1.3)]))
    verdict = comparisons.compare(scene, Choices(links=20, elements=20)).verdict
    assert (verdict.word, verdict.reason) == (Word.UNDECIDED, Reason.UNDECLARED_CONTACT)
    assert f"beam passes through itself from load {scene.stages[0].stations[1]:.6g} N·m on" in verdict.because

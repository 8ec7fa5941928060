"""Undeclared crossings at drawn stations, with depths from plane geometry, and the verdict on a real scene."""

from pathlib import Path

import numpy as np
import pytest

import comparisons
from comparisons.audit.crossings import crossing_sentence, crossings
from comparisons.choices import Choices
from comparisons.verdict.words import Word
from cprbm_scene import Answer, Ending, Shape, StationAnswer, read, scene_from
from tests.verdict.made_up import CERTIFICATE

SCENE = Path(__file__).parents[1] / "scenes" / "undeclared-contact.toml"
T = 1e-3


def line(start, end, count=41):
    return np.linspace(start, end, count)


def arc(radius, count):
    angle = np.linspace(0.0, 0.5 * np.pi, count)
    return radius * np.column_stack((np.cos(angle), np.sin(angle)))


def scene_of(beams, contacts=(), thickness=T, **keys):
    """Straight beams ``{name: (start, end)}``, welded to the ground at the starts, beside a body ``slide``."""
    points = {f"P{name}": list(start) for name, (start, _) in beams.items()}
    return scene_from(
        {
            "name": "drawn",
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


def answer_of(scene, *drawn, slide=(0.0, 0.0, 0.0)):
    """An answer with these neutral lines ``{name: places}`` at the stations; a beam without places stays at rest."""
    stations = []
    for value, lines in zip(scene.stages[0].stations, drawn, strict=False):
        lines = {name: line(beam.curve.start, beam.curve.end) for name, beam in scene.beams.items()} | lines
        shapes = {}
        for name, places in lines.items():
            s = np.concatenate(([0.0], np.cumsum(np.hypot(*np.diff(places, axis=0).T))))
            shapes[name] = Shape(s, *places.T)
        stations.append(StationAnswer("push", value, {}, shapes, {}, CERTIFICATE, bodies={"slide": np.array(slide)}))
    return Answer("planted", scene.name, {}, Ending.COMPLETED, "", tuple(stations))


BESIDE = {"a": ((0.0, 0.05), (0.05, 0.05)), "b": ((0.0, 0.0), (0.1, 0.0))}
"""Two parallel beams, 50 mm apart."""


def dropped(depth):
    """The beam ``a`` upright above the middle of ``b``, with the free end ``depth`` below the border of ``b``."""
    return {"a": line((0.05, 0.04), (0.05, -depth))}  # the round end adds T/2, and b is T/2 thick below


def test_a_beam_that_passes_through_another_is_named_with_the_first_load_and_the_largest_depth():
    scene = scene_of(BESIDE)
    (found,) = crossings(scene, answer_of(scene, {}, dropped(0.007), dropped(0.011)))
    assert (found.one, found.other, found.stage, found.value) == ("a", "b", "push", 2.0)
    assert found.depth == pytest.approx(0.011, rel=1e-3)
    said = crossing_sentence(scene, found)
    assert "a and b pass through each other by up to 0.011 m, from push 2 on (F = 2)" in said
    assert "add a contact of a and b" in said
    assert 'may_cross = [["a", "b"]]' in said


@pytest.mark.parametrize(
    ("gap", "deep"), [(0.0, False), (-0.04 * T, False), (-0.1 * T, True)], ids=["touch", "within the floor", "overlap"]
)
def test_beams_side_by_side_cross_if_they_overlap_by_more_than_the_floor(gap, deep):
    scene = scene_of(BESIDE)
    found = crossings(scene, answer_of(scene, {"a": line((0.0, T + gap), (0.05, T + gap))}))
    assert [each.depth for each in found] == ([pytest.approx(-gap, rel=1e-3)] if deep else [])


def test_chords_that_overlap_where_the_arcs_touch_do_not_count():
    scene = scene_of(BESIDE)
    # a chord of the outer arc over 22.5° cuts 0.98 mm off, about the thickness of the inner arc
    assert crossings(scene, answer_of(scene, {"a": arc(0.05, 401), "b": arc(0.05 + T, 5)})) == ()
    assert len(crossings(scene, answer_of(scene, {"a": arc(0.05, 401), "b": arc(0.05 + 0.5 * T, 401)}))) == 1


@pytest.mark.parametrize(("thickest", "cross"), [("start", True), ("end", False)])
def test_the_thickness_of_a_tapered_beam_counts_where_the_other_beam_lies(thickest, cross):
    values = [4 * T, 0.4 * T] if thickest == "start" else [0.4 * T, 4 * T]
    scene = scene_of(BESIDE, thickness={"at": [0.0, 1.0], "values": values})
    near = {"a": line((0.0, 2.0 * T), (-0.05, 2.0 * T)), "b": line((0.0, 0.0), (0.1, 0.0))}
    assert bool(crossings(scene, answer_of(scene, near))) is cross


@pytest.mark.parametrize(
    "keys",
    [
        {"may_cross": [["b", "a"]]},
        {"contacts": {"both": {"kind": "beam-beam", "between": ["a", "b"]}}},
    ],
    ids=["may_cross", "contact"],
)
def test_a_pair_that_the_scene_names_may_cross(keys):
    scene = scene_of(BESIDE, **keys)
    assert crossings(scene, answer_of(scene, dropped(0.007))) == ()


@pytest.mark.parametrize(
    "beams",
    [
        {"a": ((0.0, 0.0), (0.0, 0.05)), "b": ((0.0, 0.0), (0.1, 0.0))},
        {"a": ((0.03, -0.02), (0.03, 0.05)), "b": ((0.0, 0.0), (0.1, 0.0))},
        {"a": ((0.0, T), (0.05, T)), "b": ((0.0, 0.0), (0.1, 0.0))},
    ],
    ids=["common place", "crossing at rest", "touch at rest"],
)
def test_beams_that_touch_at_rest_may_cross(beams):
    scene = scene_of(beams)
    assert crossings(scene, answer_of(scene, dropped(0.007))) == ()


def test_beams_that_share_a_joint_may_cross():
    scene = scene_of(BESIDE)
    beams = {**scene.beams, "b": scene.beams["b"].model_copy(update={"start": scene.beams["a"].start})}
    scene = scene.model_copy(update={"beams": beams})
    assert crossings(scene, answer_of(scene, dropped(0.007))) == ()


EDGES = {
    "disc": {"kind": "beam-circle", "center": [0.05, -0.03], "radius": 0.01},
    "wall": {"kind": "beam-line", "points": [[0.0, -0.02], [0.1, -0.02]], "side": "left"},
    "floor": {"kind": "beam-half-plane", "point": [0.0, -0.02], "normal": [0.0, 2.0]},
    "graph": {"kind": "beam-function", "axis": "x", "coefficients": [-0.02, 0.0], "range": [0.0, 0.1], "side": "above"},
}


@pytest.mark.parametrize("edge", EDGES)
@pytest.mark.parametrize("allowed", ["nothing", "may_cross", "contact"])
def test_a_beam_passes_through_a_rigid_edge_that_another_beam_may_touch(edge, allowed):
    stated = {**EDGES[edge], "body": "ground"}
    contacts = {edge: {**stated, "beam": "b"}} | ({"second": {**stated, "beam": "a"}} if allowed == "contact" else {})
    keys = {"may_cross": [["a", edge]]} if allowed == "may_cross" else {}
    scene = scene_of(BESIDE, contacts, **keys)
    # past the border of b, 5 mm beyond the line or into the disc: b is clear of the path
    path = {"a": line((0.05, 0.04), (0.05, -0.025)), "b": line((0.0, 0.0), (0.0, -0.01))}
    found = crossings(scene, answer_of(scene, path))
    assert [(each.one, each.other) for each in found] == ([("a", edge)] if allowed == "nothing" else [])
    assert all(each.depth == pytest.approx(0.005 + 0.5 * T, rel=0.01) for each in found)


def test_an_edge_moves_with_the_body():
    scene = scene_of(BESIDE, {"disc": {**EDGES["disc"], "body": "slide", "beam": "b"}})
    path = {"a": line((0.05, 0.04), (0.05, -0.025)), "b": line((0.0, 0.0), (0.0, -0.01))}
    assert len(crossings(scene, answer_of(scene, path))) == 1
    assert crossings(scene, answer_of(scene, path, slide=(0.02, 0.0, 0.0))) == ()
    # half a turn about S, 80 mm above the centre, takes the disc above both beams
    assert crossings(scene, answer_of(scene, path, slide=(0.0, 0.0, np.pi))) == ()


def test_undeclared_contact():
    compared = comparisons.compare(read(SCENE), Choices(links=20, elements=20))
    verdict = compared.verdict
    assert verdict.word is Word.UNDECIDED
    # at 5 N the upper beam, 10 mm above, moves down by about F L³/(3 E I) = 10 mm and touches the lower one; at 10 N it
    # moves by almost 20 mm
    assert "up and lo pass through each other" in verdict.because
    assert "from undeclared-contact 10 on (F = 10)" in verdict.because
    assert 'may_cross = [["up", "lo"]]' in verdict.because
    allowed = read(SCENE).model_copy(update={"may_cross": (("lo", "up"),)})
    assert comparisons.compare(allowed, Choices(links=20, elements=20)).verdict.word is Word.AGREE

"""Loads on beams: what a scene can say of them, and each wrong question by its key and a word."""

import pytest

from cprbm_scene import scene_from
from cprbm_scene.statement import BeamForce, DistributedLoad
from tests.cprbm_scene.editing import REMOVED, edited, mistakes, two_lines

FORCE = {"kind": "beam_force", "beam": "lower", "at": 0.3, "direction": [0.0, -2.0]}
WEIGHT = {"kind": "distributed", "beam": "upper", "direction": [0.0, -1.0]}
STAGES = [{"name": name, "steps": name, "stations": [1.0]} for name in ("F", "q")]
PAIR = edited(("loads", {"F": FORCE, "q": WEIGHT}), ("stages", STAGES), base=two_lines(0.01))


def test_what_is_written_is_what_is_read():
    loads = scene_from(edited(("loads/q/along", [0, 0.25]), base=PAIR)).loads
    assert loads["F"] == BeamForce(kind="beam_force", beam="lower", at=0.3, direction=(0.0, -2.0))
    assert loads["q"] == DistributedLoad(kind="distributed", beam="upper", direction=(0.0, -1.0), along=(0.0, 0.25))
    assert scene_from(PAIR).loads["q"].along == (0.0, 1.0)


def test_ends_that_can_move_may_be_loaded():
    for beam, at in (("upper", 1.0), ("lower", 1.0)):
        assert not mistakes(("loads/F/beam", beam), ("loads/F/at", at), base=PAIR)


WRONG = [
    (
        "loads/F/kind",
        "beamforce",
        "loads.F.kind",
        "one of 'moment', 'force', 'beam_force', 'beam_moment', 'distributed'",
    ),
    ("loads/F/beam", "lowr", "loads.F.beam", "'lowr', which names no beam (is 'lower' meant?)"),
    ("loads/q/beam", "Q", "loads.q.beam", "'Q', which names no beam"),
    ("loads/F/direction", [0, 0], "loads.F.direction", "at least one number not zero"),
    ("loads/q/direction", [0, 0], "loads.q.direction", "at least one number not zero"),
    ("loads/F/at", REMOVED, "loads.F.at", "required"),
    ("loads/F/at", 1.01, "loads.F.at", "1.01; a number of at most 1"),
    ("loads/F/at", -0.01, "loads.F.at", "-0.01; a number of at least 0"),
    ("loads/F/at", float("nan"), "loads.F.at", "a finite number"),
    ("loads/F/at", 0.0, "loads.F.at", "0, an end of 'lower' that is held at 'O', a point of a fixed body"),
    ("loads/F/point", "Q", "loads.F.point", "'kind', 'beam', 'at', 'direction'"),
    ("loads/q/along", [0.5, 0.5], "loads.q.along", "a stretch from 0.5 to 0.5; two fractions of the beam's length"),
    ("loads/q/along", [0.7, 0.2], "loads.q.along", "a stretch from 0.7 to 0.2"),
    ("loads/q/along", [0.0, 1.5], "loads.q.along[1]", "1.5; a number of at most 1"),
    ("loads/q/along", [0.2], "loads.q.along[1]", "an item"),
    ("loads/q/at", 0.2, "loads.q.at", "'kind', 'beam', 'direction', 'along'"),
    ("loads/lower", WEIGHT, "loads.lower", "beams.lower has too"),
]


@pytest.mark.parametrize(("path", "value", "key", "said"), WRONG)
def test_a_wrong_question_is_named_by_its_key(path, value, key, said):
    found = mistakes((path, value), base=PAIR)
    assert key in found, found
    assert said in found[key]

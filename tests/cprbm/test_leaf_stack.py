"""A stack of four leaves without gap: the closed set has hundreds of places with hardly any gap and force."""

from math import cos, sin

import numpy as np
import pytest

import cprbm
from cprbm_scene import scene_from
from tests.together.pivots import line, weld

LEAVES = (200.0, 160.0, 120.0, 80.0)


def leaves(overlap, lengths=LEAVES, stations=(0.1, 1.0), thicknesses=(1.0,) * 4):
    """Leaves side by side, clamped together and loaded at the tip of the longest; the second overlaps the first."""
    means = 0.5 * (np.array(thicknesses[:-1]) + thicknesses[1:])
    heights = np.append(0.0, np.cumsum(means) - overlap * (np.arange(len(means)) == 0)).tolist()
    free, tip = {"joint": "free"}, {"joint": "weld", "point": "T"}
    return scene_from(
        {
            "name": "leaves",
            "units": {"length": "mm", "force": "N", "angle": "deg", "stress": "MPa"},
            "theory": "bending",
            "materials": {"steel": {"youngs_modulus": 200000.0, "poisson_ratio": 0.3}},
            "bodies": {
                "ground": {"motion": "fixed", "points": {f"A{k}": [0.0, y] for k, y in enumerate(heights)}},
                "tip": {"motion": "free", "points": {"T": [200.0, 0.0]}},
            },
            "beams": {
                f"leaf{k}": {
                    "curve": {"kind": "line", "start": [0.0, y], "end": [length, y]},
                    "thickness": thickness,
                    "width": 20.0,
                    "material": "steel",
                    "start": {"joint": "weld", "point": f"A{k}"},
                    "end": free if k else tip,
                }
                for k, (y, length, thickness) in enumerate(zip(heights, lengths, thicknesses, strict=True))
            },
            "contacts": {
                f"c{k}": {"kind": "beam-beam", "between": [f"leaf{k}", f"leaf{k + 1}"]} for k in range(len(means))
            },
            "loads": {"F": {"kind": "force", "point": "T", "direction": [0.0, 1.0]}},
            "stages": [{"name": "load", "steps": "F", "stations": list(stations)}],
            "probes": [
                {"of": "T", "quantity": "displacement"},
                *({"of": f"c{k}", "quantity": "force"} for k in range(len(means))),
            ],
        }
    )


@pytest.mark.parametrize(("links", "overlap"), [(46, 0.0), (80, 0.0), (60, 0.0009)])
def test_leaves_share_the_load(links, overlap):
    # quadratic programme of four Euler-Bernoulli leaves: 2.4132 mm/N and forces of 0.992, 0.962 and 0.842 F
    answer = cprbm.answer(leaves(0.0), cprbm.Settings(links=links))
    assert answer.completed, answer.sentence
    values = answer.stations[-1].values
    assert values["T.displacement"][1] == pytest.approx(2.4132e-3, rel=0.01)
    assert [values[f"c{k}.force"][0] for k in range(3)] == pytest.approx([0.992, 0.962, 0.842], rel=0.01)


@pytest.mark.parametrize("links", [40, 60])
def test_leaves_that_overlap_settle(links):
    # clamps carry the overlap of 0.9 µm; the deflection is that of the leaves without overlap
    answer = cprbm.answer(leaves(9e-4), cprbm.Settings(links=links))
    assert answer.completed, answer.sentence
    assert answer.stations[-1].values["T.displacement"][1] == pytest.approx(2.4132e-3, rel=0.01)


def test_joints_with_a_shared_force_keep_the_force_of_their_leader():
    # reference: 80 links; a joint beside a clamp kept a pull of its own at 40 links, and the run ended at 14.46 N
    lengths, stations = (200.0, 150.0, 100.0, 50.0), (5.0, 15.0)
    coarse, fine = (cprbm.answer(leaves(0.0, lengths, stations), cprbm.Settings(links=n)) for n in (40, 80))
    assert coarse.completed, coarse.sentence
    tips = [answer.stations[-1].values["T.displacement"][1] for answer in (coarse, fine)]
    assert tips[0] == pytest.approx(tips[1], rel=1e-4)


def test_nested_arcs_that_touch_as_drawn_touch_along_their_length():
    """The splines of both arcs leave minima of 1e-10 between the joints.  Reference: 320 finite elements."""
    radii, spans, arc = (100.0, 99.0, 98.0), (0.5, 0.38, 0.25), {"kind": "arc", "center": [0.0, -100.0]}
    data = {
        "name": "arcs",
        "units": {"length": "mm", "force": "N", "angle": "deg", "stress": "MPa"},
        "materials": {"steel": {"youngs_modulus": 200000.0, "poisson_ratio": 0.3}},
        "bodies": {"ground": {"motion": "fixed", "points": {f"A{k}": [0.0, r - 100.0] for k, r in enumerate(radii)}}},
        "beams": {
            f"leaf{k}": {
                "curve": {
                    **arc,
                    "start": [0.0, r - 100.0],
                    "end": [r * sin(span), r * cos(span) - 100.0],
                    "direction": "clockwise",
                },
                "thickness": 1.0,
                "width": 15.0,
                "material": "steel",
                "start": {"joint": "weld", "point": f"A{k}"},
                "end": {"joint": "free", "point": f"T{k}"},
            }
            for k, (r, span) in enumerate(zip(radii, spans, strict=True))
        },
        "contacts": {f"c{k}": {"kind": "beam-beam", "between": [f"leaf{k}", f"leaf{k + 1}"]} for k in range(2)},
        "loads": {"F": {"kind": "force", "point": "T0", "direction": [0.0, -1.0]}},
        "stages": [{"name": "load", "steps": "F", "stations": [1.0, 20.0]}],
        "probes": [{"of": "T0", "quantity": "displacement"}],
    }
    answer = cprbm.answer(scene_from(data))
    assert answer.completed, answer.sentence
    assert answer.stations[-1].values["T0.displacement"] == pytest.approx([-3.8489e-4, -1.08306e-3], rel=1e-4)


def test_a_point_of_contact_between_leaves_of_nearly_equal_curvature_is_certified():
    """The place is known to 1e-11 of a link only.  Reference: 60 links."""
    thick = {"thickness": 6e-3, "width": 0.01, "material": "m"}
    load = {"M": {"kind": "moment", "body": "tip"}}
    data = {
        "name": "two leaves",
        "theory": "stretch",
        "materials": {"m": {"youngs_modulus": 2.3e9, "poisson_ratio": 0.35}},
        "bodies": {
            "ground": {"motion": "fixed", "points": {"A": [0.0, 0.0], "B": [0.0, -7.5e-3]}},
            "tip": {"motion": "free", "points": {"T": [0.06, 0.0]}},
        },
        "beams": {
            "b": thick | {"curve": line([0.0, 0.0], [0.06, 0.0]), "start": weld("A"), "end": weld("T")},
            "c": thick | {"curve": line([0.0, -7.5e-3], [0.06, -7.5e-3]), "start": weld("B"), "end": {"joint": "free"}},
        },
        "contacts": {"k": {"kind": "beam-beam", "between": ["b", "c"]}},
        "loads": load | {"F": {"kind": "force", "point": "T", "direction": [0.3, -1.0]}},
        "stages": [
            {"name": "F", "steps": "F", "stations": [50.0, 400.0, 900.0]},
            {"name": "M", "steps": "M", "stations": [-0.5, -3.0]},
        ],
        "probes": [{"of": "T", "quantity": "displacement"}],
    }
    answers = [cprbm.answer(scene_from(data), cprbm.Settings(links=links)) for links in (36, 60)]
    assert [answer.sentence for answer in answers if not answer.completed] == []
    coarse, fine = (answer.stations[-1].values["T.displacement"] for answer in answers)
    assert coarse == pytest.approx(fine, rel=1e-4)

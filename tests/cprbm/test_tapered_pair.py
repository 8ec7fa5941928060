"""Two beams whose thickness varies, touching by their edges."""

import numpy as np
import pytest

import cprbm
from cprbm_scene import Profile, SceneError, scene_from
from tests.cprbm import necks
from tests.cprbm.test_lying import bowl

STEP = 1e-6
EVEN = (1.0,)
THINNER, THICKER = (1.0, 0.4), (0.6, 1.0)
RIDGED = (0.6, 0.6, 1.0, 0.7, 0.7)  # with a corner that stands out at half of the length
LENGTH, THICKNESS = 0.1, 1e-3
BOWED = np.polynomial.Polynomial([0.5 * THICKNESS + 1e-4, 0.0, 3.0])(np.polynomial.Polynomial([-0.05, 1.0]))
WEDGE = {"from": 0.4e-3, "to": 1.6e-3, "length": 0.127, "begins": -0.013}


def tapered(scene, **parts):
    """The scene with thicknesses that vary, stated at equal steps in parts of the even one."""
    beams = dict(scene.beams)
    for name, values in parts.items():
        if len(values) > 1:
            at = tuple(np.linspace(0.0, 1.0, len(values)).tolist())
            profile = Profile(at=at, values=tuple(beams[name].thickness * value for value in values))
            beams[name] = beams[name].model_copy(update={"thickness": profile})
    return scene.model_copy(update={"beams": beams})


def pressed_down(load, contact, *, mirrored=False, below=None, points=()):
    """A cantilever A = :data:`BOWED` above y = 0, its tip pushed down on a ``contact``.

    ``mirrored`` adds its image B below, whose tip is pushed up; ``below`` is a beam B that ``points`` of the wall hold.
    """
    height = float(BOWED(LENGTH))

    def bow(sign, start, end):
        curve = {"kind": "polynomial", "axis": "x", "range": [0.0, LENGTH]}
        return {
            "curve": {**curve, "coefficients": (sign * BOWED.coef).tolist()},
            "thickness": THICKNESS,
            "width": 0.01,
            "material": "soft",
            "start": {"joint": "weld", "point": start},
            "end": {"joint": "weld", "point": end},
        }

    wall = {"R": [0.0, float(BOWED(0.0))], **dict(points)}
    bodies = {"tip": {"motion": "free", "points": {"T": [LENGTH, height]}}}
    beams, loads = {"A": bow(1.0, "R", "T")}, {"P": {"kind": "force", "point": "T", "direction": [0.0, -1.0]}}
    stages = [{"name": "down", "steps": "P", "stations": [load]}]
    if mirrored:
        wall["U"] = [0.0, -float(BOWED(0.0))]
        bodies["end"] = {"motion": "free", "points": {"S": [LENGTH, -height]}}
        beams["B"] = bow(-1.0, "U", "S")
        loads["Q"] = {"kind": "force", "point": "S", "direction": [0.0, 1.0]}
        stages.append({"name": "up", "steps": "Q", "stations": [load]})
    if below is not None:
        beams["B"] = below
    probes = [("T", "displacement"), ("tip", "rotation"), ("c", "force"), ("c", "centre"), ("c", "ends")]
    probes += [("R", "reaction_moment"), ("scene", "potential_energy")]
    return scene_from(
        {
            "name": "pressed",
            "theory": "bending",
            "materials": {
                "soft": {"youngs_modulus": 2.0e9, "poisson_ratio": 0.3},
                "hard": {"youngs_modulus": 2.0e12, "poisson_ratio": 0.3},
                "harder": {"youngs_modulus": 2.0e13, "poisson_ratio": 0.3},
            },
            "bodies": {"wall": {"motion": "fixed", "points": wall}, **bodies},
            "beams": beams,
            "contacts": {"c": contact},
            "loads": loads,
            "stages": stages,
            "probes": [{"of": of, "quantity": quantity} for of, quantity in probes],
        }
    )


HALF_PLANE = {"kind": "beam-half-plane", "beam": "A", "body": "wall", "point": [0.0, 0.0], "normal": [0.0, 1.0]}
TWO = {"kind": "beam-beam", "between": ["A", "B"]}


def solved(scene, links):
    answer = cprbm.answer(scene, cprbm.Settings(links=links))
    assert answer.completed, answer.sentence
    assert max(answer.stations[-1].certificate.force_balance, answer.stations[-1].certificate.moment_balance) < 1e-9
    return answer.stations[-1].values


@pytest.mark.parametrize("values", [THINNER, THICKER, RIDGED], ids=["thinner", "thicker", "ridged"])
def test_two_that_mirror_each_other_are_one_against_a_half_plane(values):
    # reference: symmetry, and contact with a rigid edge, which has formulas of its own
    two = solved(tapered(pressed_down(1.0, TWO, mirrored=True), A=values, B=values), 40)
    one = solved(tapered(pressed_down(1.0, HALF_PLANE), A=values), 40)
    assert one["c.force"][0] > 1.0
    for name, value in one.items():
        both = two[name] / (2.0 if name == "scene.potential_energy" else 1.0)
        assert both == pytest.approx(value, rel=3e-6, abs=1e-8 * LENGTH), name


def wedge(material):
    """A straight beam below y = 0 whose upper edge is that line, clamped where it is thinnest."""
    first, last = 0.5 * WEDGE["from"], 0.5 * WEDGE["to"]
    start = [WEDGE["begins"], -first]
    along = np.sqrt(WEDGE["length"] ** 2 - (last - first) ** 2)
    return start, {
        "curve": {"kind": "line", "start": start, "end": [start[0] + float(along), -last]},
        "thickness": {"at": [0.0, 1.0], "values": [WEDGE["from"], WEDGE["to"]]},
        "width": 0.01,
        "material": material,
        "start": {"joint": "weld", "point": "U"},
        "end": {"joint": "free"},
    }


@pytest.mark.parametrize(
    ("values", "load", "gain"),
    [(EVEN, 0.02, 8.0), (THICKER, 0.02, 8.0), (THINNER, 0.1, 4.0)],
    ids=["even", "place", "length"],
)
def test_a_hard_wedge_is_a_half_plane(values, load, gain):
    # reference: contact with a rigid edge; what the wedge yields falls with its modulus
    flat = solved(tapered(pressed_down(load, HALF_PLANE), A=values), 20)
    errors = []
    for material in ("hard", "harder"):
        start, below = wedge(material)
        scene = pressed_down(load, TWO, below=below, points={"U": start}.items())
        errors.append(solved(tapered(scene, A=values), 20)["T.displacement"] - flat["T.displacement"])
    soft, hard = (np.hypot(*error) for error in errors)
    assert hard < 1e-2 * np.hypot(*flat["T.displacement"])
    assert hard < soft / gain


@pytest.mark.parametrize("load", [12.0, 60.0], ids=["length", "place"])
def test_the_error_falls_faster_than_the_square_of_the_element(load):
    scene = tapered(bowl(load), A=THINNER, B=THICKER)
    coarse, middle, fine = (solved(scene, links) for links in (20, 40, 80))
    for name in ("T.displacement", "S.displacement", "tip.rotation", "scene.potential_energy"):
        changes = [np.linalg.norm(one[name] - other[name]) for one, other in ((coarse, middle), (middle, fine))]
        assert 4.0 * changes[1] < changes[0] < 1e-3 * np.linalg.norm(fine[name]), name
    assert fine["c.force"] == pytest.approx(middle["c.force"], rel=1e-3)


def test_the_papers_form_refuses_edges_that_lean():
    hints = {"boundary": "B", "axis": "y"}
    scene = tapered(pressed_down(1.0, TWO | {"paper": hints}, mirrored=True), A=THINNER, B=THINNER)
    with pytest.raises(SceneError, match=r"contacts\.c\.thick.*thickness varies"):
        cprbm.answer(scene, cprbm.Settings(formulation="paper"))


@pytest.mark.parametrize("values", [(1.0, 0.9, 1.0), (0.9, 1.0, 0.9)], ids=["waist", "belly"])
def test_a_neck_of_varying_thickness_is_one_half_against_a_wall(values):
    # reference: symmetry, and contact with a rigid line, which has formulas of its own
    whole, half = (
        tapered(necks.whole(0.01, [70.0]), column=values),
        tapered(necks.half(0.01, [70.0]), column=values[:2]),
    )
    found, wanted = solved(whole, 80), solved(half, 40)
    assert wanted["neck.force"][0] > 0.0
    assert found["neck.force"] == pytest.approx(wanted["neck.force"], rel=3e-3)
    assert found["neck.centre"] == pytest.approx(wanted["neck.centre"], rel=2e-3)
    assert found["neck.closing_load"] == pytest.approx(wanted["neck.closing_load"], rel=5e-4)
    assert found["scene.potential_energy"] == pytest.approx(2.0 * wanted["scene.potential_energy"], rel=2e-3)

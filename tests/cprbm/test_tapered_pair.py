"""Two beams whose thickness varies, touching by their edges."""

import numpy as np
import pytest

import cprbm
from cprbm import wells
from cprbm.feet import distance_along
from cprbm.first_contact import NO_ROWS
from cprbm.first_equilibrium import equilibrium
from cprbm.kinematics import State, rest_state
from cprbm.mechanism import mechanism_of
from cprbm.point import point_at
from cprbm_scene import Profile, SceneError, scene_from
from tests.cprbm import necks
from tests.cprbm.lagrangian import check
from tests.cprbm.test_lying import bowl
from tests.cprbm.test_nearest import beams, pair_at_rest
from tests.cprbm.test_nearest import line as straight

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


def loaded(scene, load, links):
    mechanism = mechanism_of(scene, cprbm.Settings(links=links))
    problem = mechanism.problem
    start = point_at(problem, {}, rest_state(problem.model), np.zeros(problem.closure.rows), np.zeros(0), NO_ROWS)
    for part in (0.25, 0.5, 0.75, 1.0):
        found = equilibrium(problem, {"P": part * load}, start, 1e-11, 60)
        assert found.converged
        start = found.point
    return mechanism, start


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


def test_edges_touch_half_a_thickness_from_either_line():
    mechanism, point = loaded(tapered(bowl(60.0), A=THINNER, B=THICKER), 60.0, 40)
    pair = mechanism.pairs["c"]
    s = point.rows.arc[point.lam > 0.0]
    assert s.size == 1
    place = pair.touching(point.state, point.at, s)[0]
    for chain, line, (_, arc, _) in zip(
        pair.chains, pair.lines(point.state, point.at), pair.pressed(point.state, point.at, s), strict=True
    ):
        at = line.at(arc)
        away = np.hypot(at.x[0] - place[0], at.y[0] - place[1])
        assert away == pytest.approx(0.5 * chain.section.thickness_at(arc)[0], rel=1e-6)


def test_what_presses_with_a_place_of_its_own_has_no_gap_there(monkeypatch):
    """Of edges that lean, too: whether a minimum keeps its place is asked of the gap between them."""
    seen = []
    held = wells.Wells.held

    def recorded(found, gap):
        seen.append(gap)
        return held(found, gap)

    monkeypatch.setattr(wells.Wells, "held", recorded)
    _, point = loaded(tapered(bowl(1.3), A=THINNER, B=THICKER), 1.3, 23)
    assert np.count_nonzero(point.lam) == 1
    assert seen[-1] == pytest.approx([0.0], abs=1e-9 * THICKNESS / LENGTH)


def test_what_is_across_from_a_corner_that_stands_out_has_its_foot_there():
    # reference: plane geometry; the edge leans by 6e-3 before the corner and by −4.5e-3 behind it, and to what is above
    # it between the two normals it is the nearest place
    scene = beams(straight((0.0, 2.1e-3), (LENGTH, 2.1e-3)), straight((0.0, 0.0), (LENGTH, 0.0)), THICKNESS)
    pair, *rest = pair_at_rest(tapered(scene, B=(0.6, 0.6, 1.0, 0.7)), 23)
    corner, high = 2.0 / 3.0, 2.1e-3 / LENGTH
    across = corner + high * np.array([-5.9e-3, -1.9e-3, 0.0, 1.4e-3, 4.4e-3])
    D, sigma, foot = distance_along(pair, pair.lines(*rest), across)
    assert foot.all()
    assert sigma == pytest.approx(np.full(5, corner), abs=1e-12)
    assert pytest.approx(np.full(5, high - 0.5 * (1.0 - 0.6) * THICKNESS / LENGTH), abs=3e-5 * high) == D


def test_the_papers_form_refuses_edges_that_lean():
    hints = {"boundary": "B", "axis": "y"}
    scene = tapered(pressed_down(1.0, TWO | {"paper": hints}, mirrored=True), A=THINNER, B=THINNER)
    with pytest.raises(SceneError, match=r"contacts\.c\.thick.*thickness varies"):
        cprbm.answer(scene, cprbm.Settings(formulation="paper"))


@pytest.mark.parametrize("load", [12.0, 60.0], ids=["length", "place"])
@pytest.mark.parametrize(
    ("A", "B"),
    [(THINNER, EVEN), (EVEN, THICKER), (THINNER, THICKER), (RIDGED, THICKER), (THINNER, RIDGED)],
)
@pytest.mark.parametrize("links", [{"A": 23, "B": 31}, {"A": 31, "B": 23}], ids=["rows on A", "rows on B"])
def test_derivatives_of_gaps_and_of_the_lagrangian(load, A, B, links):
    mechanism, start = loaded(tapered(bowl(load), A=A, B=B), load, links)
    problem, values = mechanism.problem, {"P": load}
    model, closure = problem.model, problem.closure
    n = model.n_links
    random = np.random.default_rng(99)
    state = State(start.state.theta + 1e-3 * random.standard_normal(n), start.state.bodies)
    mu = random.standard_normal(closure.rows)
    moved = point_at(problem, values, state, mu, np.zeros(0), NO_ROWS)
    assert moved.rows.size > 0
    point = point_at(problem, values, state, mu, 0.5 + random.random(moved.rows.size), moved.rows)
    check(problem, values, point, random)


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

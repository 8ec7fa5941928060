"""Random scenes: the same whatever else is drawn, readable, and of all kinds."""

import tomllib
from collections import Counter
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.random import Generator, Philox

from comparisons.choices import Choices
from comparisons.pairing import cprbm_answer
from cprbm_scene import read, scene_from
from tests.cprbm.scenes import LENGTH, RIGIDITY, THICKNESS, cantilever_data, force
from tests.robustness import contacts, strata
from tests.robustness.chance import RedrawError
from tests.robustness.draft import started
from tests.robustness.drawing import drawn
from tests.robustness.estimate import Estimate, State, followed
from tests.robustness.obstacles import ON, TURNED, Obstacle, Spot, spot_on
from tests.robustness.pushers import leaves_alone
from tests.robustness.theories import LARGEST_SHARE, made_thin, share_of
from tests.robustness.toml import toml_of
from tests.robustness.whole import assembled, column, lying

COUNTERS = st.integers(0, 2**64 - 1)


@cache
def sample(index):
    """A scene of the sample on which shares are counted."""
    return scene_from(drawn(11, index).data)


def test_a_scene_depends_on_its_counters_alone():
    forwards = [drawn(7, index).text for index in (3, 11, 12)]
    backwards = [drawn(7, index).text for index in (12, 11, 3)]
    assert forwards == backwards[::-1]


def test_seeds_and_indices_give_different_scenes():
    texts = {drawn(seed, index).text.split("\n", 1)[1] for seed in (0, 1, 5) for index in (0, 1)}
    assert len(texts) == 6


def test_no_two_obstacles_have_their_surface_at_one_place(monkeypatch):
    # how two of them share the force is no question, since nothing but the sum of their forces is determined
    model, states = tip_loaded(0.0, 1.0, [0.02, 0.04, 0.08, 0.16, 0.32])
    spot = Spot("beam", np.array([0.8 * LENGTH, 0.05 * LENGTH]), np.array([0.0, 1.0]), LENGTH)
    monkeypatch.setattr(contacts, "spot_on", lambda *_, **__: spot)
    monkeypatch.setattr(contacts, "MOST_BEAMS", 1)  # what is in the way is rigid
    counted = []
    for seed in range(12):
        draft = started(np.random.default_rng(seed))
        draft.data, draft.frame = cantilever_data(force(0.0, 1.0), [0.32]), replace(draft.frame, size=LENGTH)
        draft.material = "m"
        contacts.put_in_the_way(draft, model, states, ["P"])
        counted.append(len(draft.data.get("contacts", {})))
    assert set(counted) == {0, 1}
    assert sum(counted) > 6


def test_what_is_late_in_the_way_is_met_once_the_mechanism_has_turned():
    # a tip load that grows by a tenth of E·I/L² at a time turns the tip by more than 1.15 rad
    model, states = tip_loaded(0.0, 1.0, [0.1 * k * RIGIDITY / LENGTH**2 for k in range(1, 81)])
    turned = [model.largest_turn(state.q) for state in states]
    assert turned[-1] > TURNED > turned[len(turned) // 2]
    draft = started(np.random.default_rng(2))
    draft.frame = replace(draft.frame, size=LENGTH)
    after = [state for state, turn in zip(states, turned, strict=True) if turn > TURNED]
    for _ in range(20):
        spot = spot_on(draft, model, states, late=True)
        middle = spot.s - 0.5 * THICKNESS * spot.n
        met = min(float(np.hypot(*(model.shape(state.q, "beam") - middle).T).min()) for state in after)
        assert met < 1e-9 * LENGTH
        # and from there it goes on, away from where it was at rest
        assert max(float(((model.shape(states[-1].q, "beam") - middle) @ spot.n).max()), 0.0) > ON * LENGTH


def test_as_many_scenes_turn_far_and_touch_as_chance_leaves_of_few():
    # two in five are to turn beyond 60°, seven in ten to touch: two standard deviations less, of twenty-odd
    met, solved = Counter(), 0
    for index in range(24):
        scene = sample(index)
        found = cprbm_answer(scene, Choices(links=10))
        if found.completed:
            solved += 1
            met.update(strata.met(scene, found))
    assert solved > 20
    for feature, share in (("met: rotation beyond 60°", 0.4), ("met: closed contact", 0.7)):
        assert met[feature] > share * solved - 2.0 * np.sqrt(share * (1.0 - share) * solved), met


@settings(max_examples=8, deadline=None)
@given(seed=COUNTERS, index=COUNTERS)
def test_every_counter_gives_a_scene_that_reads_back(seed, index):
    one = drawn(seed, index)
    assert tomllib.loads(one.text) == one.data
    assert scene_from(one.data).name == one.name


def test_the_text_is_a_file_of_the_scene(tmp_path):
    one = drawn(3, 1)
    (tmp_path / "scene.toml").write_text(one.text, encoding="utf-8")
    found = read(tmp_path / "scene.toml")
    assert found.model_copy(update={"file": ""}) == scene_from(one.data)


def test_every_kind_stands_in_some_scenes():
    counted = Counter()
    scenes = 120
    for index in range(scenes):
        counted.update(strata.stated(sample(index)))
    rare = {kind: counted[kind] for kind in strata.KINDS if counted[kind] < 0.03 * scenes}
    assert rare == {}
    assert all(counted[f"beams: {n}"] for n in (1, 2, 3, 4))
    assert all(counted[f"contacts: {n}"] for n in (1, 2, 3, 4))


def tip_loaded(x, y, values=(1e-3,)):
    data = cantilever_data(force(x, y), [*values])
    model = Estimate(scene_from(data))
    return model, list(followed(model, State(np.zeros(model.unknowns), {}), "P", iter(values)))


def test_the_share_of_stretch_and_shear_is_timoshenkos():
    # F across the tip: U_b = F²L³/(6 E·I), U_t = 3/5 F²L/(G·A), their ratio 0.6 (1 + ν) (t/L)²; of F along the beam
    # the same energy is F²L/(2 E·A), and of a slanting force what is across bends alone.  Ten bars are 1 % too stiff
    def expected(x, y):
        return (0.6 * 1.31 * y**2 + 0.25 * x**2) * (THICKNESS / LENGTH) ** 2 / y**2

    for x, y in ((0.0, -1.0), (0.83, 0.56)):
        assert share_of(*tip_loaded(x, y), []) == pytest.approx(expected(x, y), rel=0.02)


def test_what_presses_a_straight_column_bends_nothing_at_first():
    model, _ = tip_loaded(-1.0, 0.0)
    across, _ = tip_loaded(0.0, 1.0)
    rest = np.zeros(model.unknowns)
    assert model.softness(rest, "P") < 1e-12
    assert across.softness(rest, "P") > 0.1


def test_thinner_beams_carry_weaker_loads():
    draft = started(Generator(Philox(key=np.array([3, 5], dtype=np.uint64))))
    draft.data = cantilever_data(force(0.0, -1.0), [0.47])
    draft.frame = replace(draft.frame, size=LENGTH)
    made_thin(draft, 2.89 * LARGEST_SHARE)
    assert draft.data["beams"]["beam"]["thickness"] == pytest.approx(THICKNESS / 1.7, rel=5e-3)
    assert draft.data["stages"][0]["stations"] == pytest.approx([0.47 / 1.7**3], rel=1e-3)


def test_text_of_what_no_scene_is_written_with_is_refused():
    with pytest.raises(TypeError, match="complex"):
        toml_of({"name": "x", "stages": [{"stations": [1j]}]})


def laid_out(whole, seed):
    """What a mechanism that is laid out as a whole is drawn as; nothing where it is to be drawn anew."""
    draft = started(np.random.default_rng(seed))
    try:
        whole(draft)
    except RedrawError:
        return None
    return draft.data


def test_a_crank_never_draws_its_beam_straight():
    seen = 0
    for data in filter(None, (laid_out(assembled, seed) for seed in range(40))):
        if "drives" not in data:
            continue
        seen += 1
        crank, curve = data["bodies"]["crank"]["points"], data["beams"]["beam1"]["curve"]
        pivot, pin, root = (complex(*place) for place in (crank["P"], crank["T"], curve["start"]))
        turns = np.linspace(0.0, max(data["stages"][0]["stations"], key=abs), 7)
        chord = np.abs(pivot + np.exp(1j * turns) * (pin - pivot) - root)
        # the beam is at least as long as from one of its ends to the other
        assert chord.max() <= 0.951 * abs(complex(*curve["end"]) - root)
    assert seen > 5


def test_a_beam_pressed_on_a_plane_is_pressed_no_farther_than_flat():
    # closed form: pinned at the plane, its tip on it and as far from the pin as the beam is long
    for data in filter(None, (laid_out(lying, seed) for seed in range(40))):
        (contact,), (drive,) = data["contacts"].values(), data["drives"].values()
        curve = data["beams"]["beam1"]["curve"]
        end, center, n, d = (
            np.array(each) for each in (curve["end"], curve["center"], contact["normal"], drive["direction"])
        )
        n, d = n / np.hypot(*n), d / np.hypot(*d)
        chord = np.hypot(*end)
        radius = np.hypot(*center)
        length = 2.0 * radius * np.arcsin(0.5 * chord / radius)
        along = end - (end @ n) * n
        flat = length * along / np.hypot(*along)
        farthest = max((flat - end) @ d, (along - end) @ d)
        assert 0.0 < data["stages"][0]["stations"][-1] <= 0.94 * farthest


def test_a_column_between_driven_ends_is_bent():
    drawn_so = [data for data in (laid_out(column, seed) for seed in range(40)) if "drives" in data]
    assert len(drawn_so) > 5
    assert all(data["beams"]["beam1"]["curve"]["kind"] == "arc" for data in drawn_so)
    # a load before the drive would bend it between ends that the drive holds
    assert all([stage["steps"] for stage in data["stages"]] == ["press"] for data in drawn_so)


def test_a_column_between_walls_is_pressed_less_than_what_lies_on_them_buckles_off_at():
    # small slopes: from clamp to wall y = g (x/ℓ − sin(2πx/ℓ)/2π) takes ¾ g²/ℓ, from a pin half of that on half the
    # length; what lies flat is clamped at both ends, and buckles when it is as long as ℓ: 3 ℓ = L, or 2½ ℓ = L
    most = {"weld": 2 * 0.75 * 3, "pin": 0.75 * 2.5 + 0.75 * 5}
    seen = Counter()
    for data in filter(None, (laid_out(column, seed) for seed in range(120))):
        if "drives" not in data or "contacts" not in data:
            continue
        curve, planes = data["beams"]["beam1"]["curve"], data["contacts"].values()
        start, end = np.array(curve["start"]), np.array(curve["end"])
        size = np.hypot(*(end - start))
        one, other = (np.array(plane["point"]) for plane in planes)
        gap = 0.5 * np.hypot(*(one - other)) / size
        joint = data["beams"]["beam1"]["end"]["joint"]
        assert gap >= 0.0999
        assert data["stages"][0]["stations"][-1] / size < 0.88 * most[joint] * gap**2
        seen[joint] += 1
    assert min(seen["weld"], seen["pin"]) > 3


@pytest.mark.parametrize(("angle", "alone"), [(0.0, True), (0.9, False)])
def test_what_is_driven_against_a_beam_leaves_alone_where_it_is_held(angle, alone):
    # a plane above the tip of a cantilever comes down by a quarter of the length: a level plane, 0.3 away, stays above
    # the root; a plane that leans by 0.9, 0.1 away from the root, comes down by 0.25 cos 0.9 = 0.155: more than 0.1
    model, _ = tip_loaded(0.0, 1.0)
    size = model.size
    normal = np.array([-np.sin(angle), -np.cos(angle)])
    away = 0.3 * size if alone else 0.1 * size
    obstacle = Obstacle({}, lambda p: p @ normal + away)

    def motion(part):
        return 1.0 + 0.0j, -0.25j * part * size

    assert leaves_alone(model, obstacle, motion, 0.02 * size) is alone

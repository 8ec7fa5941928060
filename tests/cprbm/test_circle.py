"""A cantilever pressed round a rigid circle, against its closed form, and contact at one point of a circle."""

import numpy as np
import pytest

import cprbm
from cprbm_scene import Profile, scene_from
from tests.cprbm.scenes import cantilever_data, drives_of, force
from tests.references.wrapped import Wrapped

BEAM = {"length": 0.0973, "thickness": 0.00103, "width": 0.0087, "youngs_modulus": 2.03e11}
RADIUS = 0.0711


def scene_of(stations, radius=RADIUS, center=None, angle=-np.pi / 2.0, **changes):
    length = BEAM["length"]
    data = cantilever_data(force(np.cos(angle), np.sin(angle)), stations)
    data["materials"]["m"]["youngs_modulus"] = BEAM["youngs_modulus"]
    data["bodies"]["tip"]["points"]["T"] = [length, 0.0]
    beam = data["beams"]["beam"]
    beam["curve"]["end"] = [length, 0.0]
    beam["thickness"], beam["width"] = BEAM["thickness"], BEAM["width"]
    center = center or [0.0, -radius - BEAM["thickness"] / 2.0]
    data["contacts"] = {
        "circle": {"kind": "beam-circle", "beam": "beam", "body": "wall", "center": center, "radius": radius}
    }
    data["probes"] += [{"of": "circle", "quantity": "force"}, {"of": "circle", "quantity": "centre"}]
    data["probes"] += [{"of": "circle", "quantity": "ends"}]
    return scene_from({**data, **changes})


def solved(load, links, **changes):
    answer = cprbm.answer(scene_of([load], **changes), cprbm.Settings(links=links))
    assert answer.completed, answer.sentence
    return answer.stations[-1]


@pytest.fixture(scope="module")
def truth():
    return Wrapped(**BEAM, radius=RADIUS, force=191.0)


def errors_of(links, truth):
    """Of tip, rotation, energy, clamp's moment and force, contact's force, centre and end."""
    values = solved(truth.force, links).values
    begin, end = values["circle.ends"]
    assert begin == 0.0
    return np.array(
        [
            np.hypot(*(values["T.displacement"] - truth.displacement)) / BEAM["length"],
            abs(values["tip.rotation"][0] - truth.rotation),
            abs(values["scene.potential_energy"][0] / truth.potential_energy - 1.0),
            abs(values["R.reaction_moment"][0] / truth.reaction_moment - 1.0),
            np.hypot(*(values["R.reaction"] - truth.reaction)) / truth.force,
            abs(values["circle.force"][0] / np.hypot(*truth.contact_force) - 1.0),
            abs(values["circle.centre"][0] - truth.contact_centre) / BEAM["length"],
            abs(end - truth.wrap_length) / BEAM["length"],
        ]
    )


def check(errors, links, share):
    """Shape, energy and clamp's moment; force shared by clamp and contact; end of the wrap within a quarter link.

    Clamp and contact share with first order: docs/contact-rules.md, 1, over the zone's pressure within a link.
    """
    assert np.all(errors[:4] < 0.5 / links**2)
    assert np.all(errors[4:7] < share / links)
    assert errors[7] < 0.25 / links


@pytest.mark.parametrize("links", [20, 40, 43, 47, 80])
def test_a_wrap_over_most_of_the_beam(truth, links):
    # reference: tests.references.wrapped, c/L = 0.705; the lift-off lies anywhere in a link
    check(errors_of(links, truth), links, share=0.015)


@pytest.mark.parametrize("load", [43.0, 67.0, 97.0, 137.0])
@pytest.mark.parametrize("links", [21, 40])
def test_forces_and_ends_at_other_loads(load, links):
    # reference: tests.references.wrapped, c/L from 0.23 to 0.64; a zone of few links shares a link's pressure
    check(errors_of(links, Wrapped(**BEAM, radius=RADIUS, force=load)), links, share=0.25)


@pytest.mark.parametrize("links", [11, 20, 29, 37, 38])
def test_a_wrap_that_begins_within_the_first_element_beside_its_clamp(links):
    """The circle's top is 0.3 mm beyond the clamp, at a height with it: hardly anything moves before it touches.

    Reference: tests.references.wrapped of a beam that is clamped there, shorter by as much.  What is left out is the
    bow of what lies before, of the third power of its length over the radius.
    """
    beside = 0.0003
    truth = Wrapped(**(BEAM | {"length": BEAM["length"] - beside}), radius=RADIUS, force=191.0)
    values = solved(191.0, links, center=[beside, -RADIUS - 0.5 * BEAM["thickness"]]).values
    off = values["T.displacement"] - truth.displacement
    assert np.hypot(*off) < 0.5 / links**2 * BEAM["length"]
    assert values["tip.rotation"][0] == pytest.approx(truth.rotation, abs=0.5 / links**2)


def test_one_point_of_a_circle_under_the_beams_middle():
    # reference: with w'' = M/EI, a rigid point that lifts nothing at a distance a carries R = F(3L − a)/2a of a
    # cantilever's tip force F, to the square of the slopes (1e-5 here)
    length = BEAM["length"]
    a, small = 0.43 * length, 0.003
    center = [a, -small - BEAM["thickness"] / 2.0]
    rigidity = BEAM["youngs_modulus"] * BEAM["width"] * BEAM["thickness"] ** 3 / 12.0
    load = 3e-3 * rigidity / length**2
    values = solved(load, 60, radius=small, center=center).values
    assert values["circle.force"][0] == pytest.approx(load * (3.0 * length - a) / (2.0 * a), rel=2e-3)
    assert values["circle.centre"][0] == pytest.approx(a, abs=1e-4 * length)


def test_nothing_presses_below_the_closing_load_and_the_circle_does_above(truth):
    below, above = solved(0.9 * truth.closing_load, 80), solved(1.2 * truth.closing_load, 80)
    assert below.values["circle.force"][0] < 1e-9
    assert above.values["circle.force"][0] > 0.0


def test_a_circle_that_is_driven_to_a_beam_at_rest_moves_nothing_before_it_touches():
    # reference: a cantilever that is lifted at 0.6 of its length by what the circle goes beyond its gap;
    # so little that its place on the circle hardly leaves the crown
    length, radius, below = BEAM["length"], 0.0071, 0.02
    place = 0.6 * length
    gap = below - radius - 0.5 * BEAM["thickness"]
    bodies = {
        "wall": {"motion": "fixed", "points": {"R": [0.0, 0.0]}},
        "tip": {"motion": "free", "points": {"T": [length, 0.0]}},
        "sled": {"motion": "slides", "along": [0.0, 1.0], "points": {"S": [place, -below]}},
    }
    circle = {"kind": "beam-circle", "beam": "beam", "body": "sled", "center": [place, -below], "radius": radius}
    scene = scene_of(
        [1.0],
        bodies=bodies,
        contacts={"circle": circle},
        drives={"lift": {"kind": "displacement", "point": "S", "direction": [0.0, 1.0]}},
        stages=[{"name": "lift", "steps": "lift", "stations": [0.3 * gap, 0.8 * gap, 1.003 * gap]}],
        probes=[{"of": "circle", "quantity": "force"}, {"of": "T", "quantity": "displacement"}],
    )
    answer = cprbm.answer(scene, cprbm.Settings(links=60))
    assert answer.completed, answer.sentence
    for station in answer.stations[:2]:
        assert station.values["circle.force"] == [0.0]
        assert station.values["T.displacement"] == pytest.approx([0.0, 0.0], abs=1e-15)
    lifted, values = 0.003 * gap, answer.stations[-1].values
    rigidity = BEAM["youngs_modulus"] * BEAM["width"] * BEAM["thickness"] ** 3 / 12.0
    assert values["circle.force"][0] == pytest.approx(3.0 * rigidity * lifted / place**3, rel=1e-3)
    tip = lifted * (1.0 + 1.5 * (length - place) / place)
    assert values["T.displacement"][1] == pytest.approx(tip, rel=1e-3)


def test_a_force_that_pulls_backwards_wraps_more_than_half_a_circle():
    # reference: tests.references.wrapped; down first, then backwards, then up, or the beam would bend away
    reference = Wrapped(**BEAM, radius=0.0181, force=2500.0, pull=np.radians(230.0))
    assert reference.wrap_length / reference.neutral_radius > 1.1 * np.pi
    back, up = -reference.force * np.cos(reference.pull), -reference.force * np.sin(reference.pull)
    scene = scene_of(
        [2000.0],
        radius=0.0181,
        loads={"down": force(0.0, -1.0), "back": force(-1.0, 0.0)},
        stages=[
            {"name": "first", "steps": "down", "stations": [2000.0]},
            {"name": "second", "steps": "back", "stations": [back]},
            {"name": "third", "steps": "down", "stations": [0.0, -up]},
        ],
    )
    answer = cprbm.answer(scene, cprbm.Settings(links=120))
    assert answer.completed, answer.sentence
    values = answer.stations[-1].values
    assert values["tip.rotation"][0] == pytest.approx(reference.rotation, rel=1e-3)
    assert values["T.displacement"] == pytest.approx(reference.displacement, abs=1e-3 * BEAM["length"])


def tapered(scene, *values):
    """The scene with a thickness that varies, stated at equal steps in parts of the even one."""
    size = {"at": tuple(np.linspace(0.0, 1.0, len(values)).tolist())}
    thickness = Profile(**size, values=tuple(BEAM["thickness"] * value for value in values))
    beam = scene.beams["beam"].model_copy(update={"thickness": thickness})
    return scene.model_copy(update={"beams": {"beam": beam}})


def hanging(reference, hold):
    """The beam's tip pinned to the ground, clamp and circle on a body that a dead force pulls down at ``hold`` metres
    from the tip on the force's line in equilibrium; drawn so that the line is upright at rest too."""
    length, radius = BEAM["length"], RADIUS + BEAM["thickness"] / 2.0
    pull = np.array([np.cos(reference.pull), -np.sin(reference.pull)])
    hub = reference.tip - hold * pull  # in the clamp's frame
    towards = hub - [length, 0.0]
    turn = -np.pi / 2.0 - np.arctan2(towards[1], towards[0])
    cos, sin = np.cos(turn), np.sin(turn)

    def drawn(x, y):
        return [float(cos * x - sin * y), float(sin * x + cos * y)]

    data = cantilever_data({"kind": "force", "point": "Q", "direction": [0.0, -1.0]}, [reference.force])
    data["materials"]["m"]["youngs_modulus"] = BEAM["youngs_modulus"]
    data["bodies"] = {
        "wall": {"motion": "fixed", "points": {"T": drawn(length, 0.0)}},
        "hub": {"motion": "free", "points": {"R": [0.0, 0.0], "Q": drawn(*hub)}},
    }
    beam = data["beams"]["beam"]
    beam |= {"thickness": BEAM["thickness"], "width": BEAM["width"], "end": {"joint": "pin", "point": "T"}}
    beam["curve"] = {"kind": "line", "start": [0.0, 0.0], "end": drawn(length, 0.0)}
    circle = {"kind": "beam-circle", "beam": "beam", "body": "hub", "radius": RADIUS, "center": drawn(0.0, -radius)}
    data["contacts"] = {"circle": circle}
    kinds = {
        "hub": ["rotation"],
        "T": ["reaction"],
        "circle": ["force", "centre", "ends"],
        "scene": ["potential_energy"],
    }
    data["probes"] = [{"of": of, "quantity": quantity} for of, asked in kinds.items() for quantity in asked]
    turned = np.pi / 2.0 - np.arctan2(pull[1], pull[0]) - turn
    return scene_from(data), (turned + np.pi) % (2.0 * np.pi) - np.pi


@pytest.mark.parametrize("links", [30, 60])
def test_a_circle_that_moves_with_the_body_that_the_beam_is_clamped_to(links):
    # reference: tests.references.wrapped, seen from the moving body
    reference = Wrapped(**BEAM, radius=RADIUS, force=97.0, pull=np.radians(80.0))
    scene, turned = hanging(reference, 0.5)
    answer = cprbm.answer(scene, cprbm.Settings(links=links))
    assert answer.completed, answer.sentence
    values, rough, share = answer.stations[-1].values, 0.5 / links**2, 0.02 / links
    assert answer.stations[-1].certificate.force_balance < 1e-9
    assert values["hub.rotation"][0] == pytest.approx(turned, abs=rough)
    assert values["T.reaction"] == pytest.approx([0.0, reference.force], abs=1e-9 * reference.force)
    assert values["circle.force"][0] == pytest.approx(np.hypot(*reference.contact_force), rel=share)
    assert values["circle.centre"][0] == pytest.approx(reference.contact_centre, abs=share * BEAM["length"])
    assert values["circle.ends"] == pytest.approx([0.0, reference.wrap_length], abs=0.25 / links * BEAM["length"])


PLACE = {"Q": [0.013, -0.041]}
HELD = {
    "three drives": ({"motion": "free", "points": PLACE}, ("across", "beside", "turn")),
    "a pivot": ({"motion": "turns", "about": "Q", "points": PLACE}, ("turn",)),
    "a slide": ({"motion": "slides", "along": [0.6, -0.8], "points": PLACE}, ("beside",)),
    "three forces": ({"motion": "free", "points": {"S": [0.021, 0.017], **PLACE}}, ("across", "beside", "above")),
}


@pytest.mark.parametrize("formulation", ["auto", "paper"])
@pytest.mark.parametrize("how", HELD)
def test_a_circle_on_a_body_that_is_held_where_it_stands(truth, how, formulation):
    # reference: tests.references.wrapped; while the circle's body was taken for one of its own, the rows beside the
    # clamp took any force, up to ten times the contact's, and the answer was certified
    cam, names = HELD[how]
    drives = {**drives_of("Q", "cam"), "above": {"kind": "displacement", "point": "S", "direction": [1.0, 0.0]}}
    fixed = cprbm.answer(scene_of([truth.force]), cprbm.Settings(links=20, formulation=formulation))
    data = scene_of([truth.force]).model_dump(mode="json", exclude_defaults=True)
    data["bodies"]["cam"], data["contacts"]["circle"]["body"] = cam, "cam"
    data["drives"] = {name: drives[name] for name in names}
    answer = cprbm.answer(scene_from(data), cprbm.Settings(links=20, formulation=formulation))
    assert answer.completed, answer.sentence
    values, on_wall = answer.stations[-1].values, fixed.stations[-1].values
    if formulation == "auto":
        assert values["circle.force"][0] == pytest.approx(np.hypot(*truth.contact_force), rel=0.05 / 20)
        assert values["circle.centre"][0] == pytest.approx(truth.contact_centre, abs=0.05 / 20 * BEAM["length"])
        return
    for name, value in on_wall.items():
        assert values[name] == pytest.approx(value, rel=1e-8, abs=1e-8 * np.max(np.abs(value))), name


UP, TURN = 0.00131, 0.37
BROUGHT = {
    "a later stage moves it off": (0.0, [], [("beside", [-0.0007])]),
    "moved off and back": (0.0, [("beside", [-0.0007]), ("beside", [0.0])], []),
    "brought up to the clamp": (UP, [("beside", [UP])], []),
    "turned about its centre": (0.0, [("turn", [TURN])], []),
}


def on_a_cam(kind, center, before=(), after=()):
    """The contact of a ``kind`` on a body that three drives lead, stages ``before`` and ``after`` the load's."""
    data = scene_of([191.0]).model_dump(mode="json", exclude_defaults=True)
    data["bodies"]["cam"] = {"motion": "free", "points": {"Q": center}}
    data["contacts"]["circle"] = {**kind, "beam": "beam", "body": "cam"}
    data["drives"] = {
        "across": {"kind": "displacement", "point": "Q", "direction": [1.0, 0.0]},
        "beside": {"kind": "displacement", "point": "Q", "direction": [0.0, 1.0]},
        "turn": {"kind": "rotation", "body": "cam"},
    }
    moves = [
        [{"name": f"{when}{i}", "steps": drive, "stations": to} for i, (drive, to) in enumerate(each)]
        for when, each in (("before", before), ("after", after))
    ]
    (load,) = data["stages"]
    data["stages"] = [*moves[0], load, *moves[1]]
    answer = cprbm.answer(scene_from(data), cprbm.Settings(links=20))
    assert answer.completed, answer.sentence
    (values,) = (station.values for station in answer.stations if station.stage == load["name"])
    return values


@pytest.mark.parametrize("how", BROUGHT)
def test_a_circle_in_touch_with_the_clamp_where_drives_have_brought_it(truth, how):
    # reference: tests.references.wrapped; taken for one that might move, up to ten times the contact's force
    off, before, after = BROUGHT[how]
    center = [0.0, -RADIUS - BEAM["thickness"] / 2.0 - off]
    values = on_a_cam({"kind": "beam-circle", "center": center, "radius": RADIUS}, center, before, after)
    assert values["circle.force"][0] == pytest.approx(np.hypot(*truth.contact_force), rel=0.05 / 20)
    assert values["circle.centre"][0] == pytest.approx(truth.contact_centre, abs=0.05 / 20 * BEAM["length"])
    # clamp and circle are not on one body: the first joint, half a link from the clamp, has a force of its own
    assert values["circle.ends"] == pytest.approx([0.0, truth.wrap_length], abs=0.51 / 20 * BEAM["length"])


@pytest.mark.parametrize("off", [0.0, UP])
def test_an_edge_in_touch_with_the_clamp_where_drives_have_brought_it(off):
    # reference: the same edge on the ground, of which the clamp is.  Clamp and edge are not on one body: the first
    # joint, half a link from the clamp, has a force of its own, so that both share their force in another way
    def edge(y):
        return {"kind": "beam-function", "axis": "x", "coefficients": [y, 0.0, -5.3], "range": [-0.01, 0.2],
                "side": "above"}  # fmt: skip

    y = -0.5 * BEAM["thickness"]
    fixed = scene_of([191.0], contacts={"circle": {**edge(y), "beam": "beam", "body": "wall"}})
    on_wall = cprbm.answer(fixed, cprbm.Settings(links=20)).stations[-1].values
    assert on_wall["circle.ends"][0] == 0.0 < on_wall["circle.ends"][1]
    before = [("beside", [off])] if off else []
    values = on_a_cam(edge(y - off), [0.003, -0.07], before, [("beside", [off - 0.0007])])
    for name, value in on_wall.items():
        shared = name.startswith(("circle.", "R."))
        allowed = (0.1 / 20 if shared else 0.25 / 20**2) * max(np.max(np.abs(value)), BEAM["length"])
        # the zone begins at the first joint
        allowed = 0.51 / 20 * BEAM["length"] if name == "circle.ends" else allowed
        assert values[name] == pytest.approx(value, rel=0.0, abs=allowed), name


def test_a_beam_never_passes_over_a_circle_whatever_the_step():
    # a thin pin under the middle of the beam, far smaller than what one load step moves the beam by; it stands
    # in the way on the beam's whole path, so that an answer without force is on the wrong side of it
    length = BEAM["length"]
    pin = {"radius": 0.0005, "center": [0.5 * length, -0.012]}
    answer = cprbm.answer(scene_of([400.0], **pin), cprbm.Settings(links=30))
    for station in answer.stations:
        assert station.values["circle.force"][0] > 10.0
    free = cprbm.answer(scene_of([400.0], radius=0.0005, center=[-0.5, 0.5]), cprbm.Settings(links=30))
    shape = free.stations[0].shapes["beam"]
    assert np.interp(0.5 * length, shape.x, shape.y) < -0.012


@pytest.mark.parametrize("load", [20.0, 100.0, 400.0, 1500.0])
def test_a_pin_as_thin_as_the_beam_presses_at_one_place_however_coarse_the_elements(load):
    # reference: the chain itself with many links; the force on a pin is no matter of the elements' length
    pin = {"radius": 0.0005, "center": [0.5 * BEAM["length"], -0.012]}
    coarse, fine = solved(load, 20, **pin), solved(load, 320, **pin)
    assert coarse.values["circle.force"] == pytest.approx(fine.values["circle.force"], rel=0.03)
    assert coarse.values["circle.ends"] == pytest.approx(fine.values["circle.ends"], abs=2e-3 * BEAM["length"])
    assert np.ptp(coarse.values["circle.ends"]) == 0.0


@pytest.mark.parametrize("links", [20, 33, 120])
def test_a_tip_that_would_cut_through_a_circle_in_one_step_comes_to_lie_on_it(links):
    # without contact the tip is on the other side at this load, having passed beside the centre. reference for the
    # place: the side of a tip touches where it is normal to the radius, just before the end; of the force: finer links
    length = BEAM["length"]
    circle = {"radius": 0.143 * length, "center": [0.94 * length, -(0.31 * length + BEAM["thickness"] / 2.0)]}
    values, fine = (solved(77.0, n, angle=-1.684, **circle).values for n in (links, 320))
    assert values["circle.ends"][0] > 0.98 * length
    assert values["circle.force"] == pytest.approx(fine["circle.force"], rel=1e-3)


def test_in_the_papers_form_shape_and_energy_converge_and_forces_beside_the_clamp_slowly(truth):
    # reference: tests.references.wrapped.  The first spring is held h²/8R away from the circle.  The beam comes down to
    # it over a length a with EI h²/8R ~ p a⁴ at the pressure p, so a ~ √h; the clamp carries what lies there: p a of
    # the force and p a²/2 of the moment.
    errors = []
    for links in (57, 180):
        answer = cprbm.answer(scene_of([truth.force]), cprbm.Settings(links=links, formulation="paper"))
        assert answer.completed, answer.sentence
        values = answer.stations[-1].values
        errors.append(
            [
                np.hypot(*(values["T.displacement"] - truth.displacement)) / BEAM["length"],
                abs(values["tip.rotation"][0] - truth.rotation),
                abs(values["scene.potential_energy"][0] / truth.potential_energy - 1.0),
                abs(values["circle.ends"][1] - truth.wrap_length) / BEAM["length"],
                abs(values["R.reaction_moment"][0] / truth.reaction_moment - 1.0),
                abs(values["circle.force"][0] / np.hypot(*truth.contact_force) - 1.0),
            ]
        )
    coarse, fine = np.array(errors)
    assert fine[:4] == pytest.approx(np.zeros(4), abs=2e-5)
    assert np.max(fine[:4] / coarse[:4]) < 2.0 * (57 / 180) ** 2
    assert fine[4] / coarse[4] < 1.2 * 57 / 180
    assert fine[5] / coarse[5] < 1.1 * (57 / 180) ** 0.5


def test_in_the_papers_form_a_circle_moves_with_its_body():
    # reference: tests.references.wrapped, seen from the moving body
    reference = Wrapped(**BEAM, radius=RADIUS, force=97.0, pull=np.radians(80.0))
    scene, turned = hanging(reference, 0.5)
    answer = cprbm.answer(scene, cprbm.Settings(links=60, formulation="paper"))
    assert answer.completed, answer.sentence
    (station,) = answer.stations
    assert station.certificate.force_balance < 1e-9
    assert station.values["hub.rotation"][0] == pytest.approx(turned, abs=1.0 / 60**2)
    assert station.values["T.reaction"] == pytest.approx([0.0, reference.force], abs=1e-9 * reference.force)

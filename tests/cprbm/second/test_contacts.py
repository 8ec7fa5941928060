"""Answers with contacts: exact references, events, stops with contacts, and planted faults of the certificate."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import cprbm
from comparisons import cases
from cprbm.chain import add_rows, mechanism_of
from cprbm.contact import contact_geometry
from cprbm.continuation.closing import kept_open
from cprbm.equilibrium.certificate import certify
from cprbm.equilibrium.solving import at_state, equilibrium
from cprbm.equilibrium.system import rest_state, system_of
from cprbm.results.stations import Run
from cprbm_scene import Ending, Loss, read, scene_from

FOLDER = Path(cases.__file__).parent
STEEL = {"youngs_modulus": 2.0e11, "poisson_ratio": 0.3}


def solved(scene, links=40):
    """The second edition's answer, also in bending."""
    return Run(scene, cprbm.Settings(links=links)).answer()


def answer(name, links):
    return solved(read(FOLDER / f"{name}.toml"), links)


def test_the_hinges_contact_meets_the_exact_reference():
    # reference: ``cprbm solve hinge --solver exact``, collocation of the beams' differential equations
    for links, error in ((20, 1e-4), (40, 2e-5)):
        found = answer("hinge", links)
        assert found.completed
        assert found.stations[-1].values["contact.force"] == pytest.approx([8.83723785], rel=error)
        (event,) = found.events
        assert (event.contact, event.kind) == ("contact", "closes")
        assert event.value == found.stations[-1].values["contact.closing_load"][0]


def test_a_contact_that_opens_ends_the_branch():
    # reference: the first edition with 240 links, 1.3822543 rad; the branch after the jump has no contact
    found = answer("prestressed", 20)
    (point,) = found.critical
    assert (point.loss, point.what) == (Loss.CONTACT, "contact")
    assert point.value == pytest.approx(1.38225, abs=3e-4)
    assert point.left < 0.0 < point.curvature
    assert point.after < point.energy
    assert not found.stations[-1].contacts["contact"].active


def test_an_opening_is_located_between_stations():
    # reference: the first edition with 240 links: closed at -0.03 N·m, open at -0.09 N·m
    found = answer("platform", 20)
    closes, opens = found.events
    assert (closes.kind, opens.kind) == ("closes", "opens")
    assert closes.value == pytest.approx(2.16768, rel=2e-4)
    assert -0.06 < opens.value < -0.03


@pytest.mark.parametrize("links", [20, 30, 40])
def test_beside_a_clamp_the_way_decides_nothing(links):
    # reference: one equilibrium at 6.4 N, 2.1535 N on the circle (docs/contact-rules.md, 2, and 80 links).  A pair of
    # joints with a shared force beside the clamp was a second one, 3.98 N, after unloading from 16 N with 30 links
    data = cases.data("gripper")
    (stage,) = data["stages"]

    def circle_force(*stages):
        named = [{**stage, "name": f"s{k}", "stations": list(stations)} for k, stations in enumerate(stages)]
        found = solved(scene_from({**data, "claims": [], "stages": named}), links)
        assert found.completed, found.sentence
        return found.stations[-1].values["circle.force"]

    once = circle_force([6.4])
    assert circle_force([16.0], [6.4]) == pytest.approx(once, rel=1e-7)
    assert circle_force([16.0], [12.3, 7.1, 6.4]) == pytest.approx(once, rel=1e-7)
    assert once == pytest.approx([2.1535], rel=32.0 / links**2)


@pytest.mark.parametrize("angle", [0.0, np.radians(37.0)])
def test_a_cantilever_pressed_on_a_round_pin_is_a_propped_beam(angle):
    # reference: small deflections, statically indeterminate: the prop at a = L/2 takes F (3L − a)/(2a) = 2.5 F
    c, s = np.cos(angle), np.sin(angle)

    def at(x, y):
        return [float(c * x - s * y), float(s * x + c * y)]

    scene = scene_from(
        {
            "name": "propped",
            "theory": "bending",
            "materials": {"m": STEEL},
            "bodies": {
                "ground": {"motion": "fixed", "points": {"A": at(0.0, 0.0)}},
                "tip": {"motion": "free", "points": {"T": at(0.1, 0.0)}},
            },
            "beams": {
                "beam": {
                    "curve": {"kind": "line", "start": at(0.0, 0.0), "end": at(0.1, 0.0)},
                    "thickness": 0.001,
                    "width": 0.01,
                    "material": "m",
                    "start": {"joint": "weld", "point": "A"},
                    "end": {"joint": "weld", "point": "T"},
                }
            },
            "loads": {"F": {"kind": "force", "point": "T", "direction": at(0.0, -1.0)}},
            "contacts": {
                "prop": {
                    "kind": "beam-circle",
                    "beam": "beam",
                    "body": "ground",
                    "center": at(0.05, -0.0025),
                    "radius": 0.002,
                }
            },
            "stages": [{"name": "press", "steps": "F", "stations": [0.001]}],
            "probes": [
                {"of": "prop", "quantity": "force"},
                {"of": "prop", "quantity": "centre"},
                {"of": "A", "quantity": "reaction_moment"},
            ],
        }
    )
    found = solved(scene)
    (station,) = found.stations
    assert station.values["prop.force"] == pytest.approx([2.5e-3], rel=2e-3)
    assert station.values["prop.centre"] == pytest.approx([0.05], rel=1e-3)
    # the moment at the clamp: 2.5 F a − F L = F L/4
    assert station.values["A.reaction_moment"] == pytest.approx([-2.5e-5], rel=3e-3)
    state = station.beams["beam"]
    assert state.M[-1] == pytest.approx(0.0, abs=1e-9)
    (row,) = np.flatnonzero(station.forces.chosen("prop", "beam"))
    assert np.hypot(*station.forces.force[row]) == pytest.approx(station.values["prop.force"][0])


@pytest.fixture(scope="module")
def pressed():
    """Equilibrium of the hinge with a closed contact."""
    scene = read(FOLDER / "hinge.toml")
    mechanism = mechanism_of(scene, dict.fromkeys(scene.beams, 12), "bending", corrected=True)
    add_rows(mechanism)
    system = system_of(mechanism, contact_geometry(mechanism))
    state, row = rest_state(system), mechanism.row(scene.stages[0].steps)
    for station in scene.stages[0].stations:
        target = state.target.copy()
        target[row] = mechanism.rows[row].unit * station
        state = equilibrium(system, replace(state, target=target), 50).state
    return at_state(system, state)


def ending(solved):
    return certify(solved, 1e-11, 0, solved.system.limits, with_curvature=False)[1]


def with_force(solved, factor):
    """The state with other contact forces."""
    contacts = solved.state.contacts
    places = contacts.places._replace(force=factor * contacts.places.force)
    return at_state(solved.system, replace(solved.state, contacts=replace(contacts, places=places)))


def test_the_certificate_refuses_planted_faults(pressed):
    assert ending(pressed) is Ending.COMPLETED
    # out of balance, and a contact that pulls
    assert ending(with_force(pressed, 1.001)) is Ending.NOT_CERTIFIED
    assert ending(with_force(pressed, -1.0)) is not Ending.COMPLETED
    # without the contact nothing balances the load, and the beams overlap
    contacts = pressed.state.contacts
    none = replace(contacts, closed=np.zeros(len(contacts.closed), dtype=bool))
    assert ending(at_state(pressed.system, replace(pressed.state, contacts=none))) is Ending.NOT_CERTIFIED
    # an equilibrium of the beams alone crosses
    kept = replace(
        contacts, places=contacts.places._replace(moves=np.zeros(len(none.closed), dtype=bool)), closed=none.closed
    )
    free = equilibrium(pressed.system, kept_open(pressed.state, frozenset([0])), 50).state
    crossed = at_state(pressed.system, replace(free, contacts=kept))
    assert ending(crossed) is Ending.BEAMS_CROSSED

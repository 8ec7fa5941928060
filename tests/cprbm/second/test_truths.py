"""Answers in all theories against closed forms, the finite elements, and each other."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import cprbm
import fea_reference
from comparisons import cases
from cprbm.equilibrium.factors import factorise
from cprbm.equilibrium.solving import equilibrium
from cprbm.equilibrium.system import rest_state
from cprbm_scene import Loss, read, scene_from
from tests.cprbm.second.systems import loop

TAPERED = Path(cases.__file__).parent / "tapered.toml"
STEEL = {"youngs_modulus": 2.1e11, "poisson_ratio": 0.3}


def two_halves(rise, load, stations, *, theory, span=0.2, thickness=1e-3, width=0.01, modulus=2.1e11, beyond=None):
    """Two straight beams between the ground and a free body in the middle, which a force presses down."""

    def half(start, end, first, last):
        curve = {"kind": "line", "start": start, "end": end}
        ends = {"start": {"joint": "weld", "point": first}, "end": {"joint": "weld", "point": last}}
        return {"curve": curve, "thickness": thickness, "width": width, "material": "steel", **ends}

    left, top, right = [0.0, 0.0], [0.5 * span, rise], [span, 0.0]
    stage = {"name": "press", "steps": load, "stations": stations}
    return scene_from(
        {
            "name": "halves",
            "theory": theory,
            "materials": {"steel": {**STEEL, "youngs_modulus": modulus}},
            "bodies": {
                "ground": {"motion": "fixed", "points": {"A": left, "D": right}},
                "middle": {"motion": "free", "points": {"P": top}},
            },
            "beams": {"one": half(left, top, "A", "P"), "other": half(top, right, "P", "D")},
            "loads": {"F": {"kind": "force", "point": "P", "direction": [0.0, -1.0]}},
            "stages": [stage | ({"beyond": beyond} if beyond else {})],
            "probes": [{"of": "P", "quantity": "displacement"}, {"of": "A", "quantity": "reaction"}],
        }
    )


def solved(scene, links=40, formulation="auto"):
    answer = cprbm.answer(scene, cprbm.Settings(links=links, formulation=formulation))
    assert answer.completed, answer.sentence
    return answer


def test_a_fixed_fixed_beam_stiffens_as_von_karmans_does():
    # reference: von Kármán's beam equation, integrated; shear and the slope's square change it by less than 0.1 %
    answer = solved(two_halves(0.0, "F", [1.0, 10.0, 100.0], theory="shear"))
    found = [-1e3 * station.values["P.displacement"][1] for station in answer.stations]
    assert found == pytest.approx([0.22941, 1.19385, 3.19095], rel=1e-3)


def test_the_limit_load_of_williamss_toggle():
    # reference: finite elements in shear at 160 elements, 33.8477 (Williams 1964 by experiment: 34)
    data = {"span": 25.886, "thickness": 0.243, "width": 0.753, "modulus": 1.03e7, "beyond": "stop"}
    answer = cprbm.answer(two_halves(0.386, "F", [30.0, 35.0], theory="shear", **data), cprbm.Settings(links=40))
    (point,) = answer.critical
    assert (point.loss, point.value) == (Loss.FOLD, pytest.approx(33.8477, rel=1e-5))


@pytest.mark.parametrize("stations", [[33.0, 34.0], [33.8, 33.9]])
def test_williamss_toggle_snaps_through_just_beyond_the_limit_load(stations):
    # reference: finite elements; the descent begins close to the limit load, where the forces nearly balance
    data = {"span": 25.886, "thickness": 0.243, "width": 0.753, "modulus": 1.03e7, "beyond": "jump"}
    scene = two_halves(0.386, "F", stations, theory="shear", **data)
    other = fea_reference.answer(scene, fea_reference.Settings(elements=40, kinematics="shear")).stations[-1].values
    for name, value in solved(scene).stations[-1].values.items():
        assert value == pytest.approx(other[name], rel=1e-5, abs=1e-9)


@pytest.mark.parametrize("theory", ["bending", "stretch", "shear"])
def test_a_tapered_flexure_meets_the_finite_elements_in_their_theory(theory):
    # reference: 160 finite elements, fourth order, in the same theory
    scene = read(TAPERED).model_copy(update={"theory": theory})
    reference = fea_reference.answer(scene, fea_reference.Settings(elements=160, kinematics=theory))
    for found, station in zip(solved(scene).stations, reference.stations, strict=True):
        for name, limit in (("T.displacement", 1e-5), ("C.reaction_moment", 5e-6), ("scene.potential_energy", 1e-5)):
            size = np.max(np.abs(reference.stations[-1].values[name]))
            assert found.values[name] == pytest.approx(station.values[name], abs=limit * size), name


def test_the_error_falls_with_the_fourth_order_and_that_of_the_plain_chain_with_the_second():
    # reference: 160 finite elements in bending
    scene = read(TAPERED)
    exact = fea_reference.answer(scene, fea_reference.Settings(elements=160, kinematics="bending")).stations[-1].values
    for formulation, least, most in (("auto", 3.5, 4.5), ("paper", 1.9, 2.1)):
        errors = [
            np.hypot(*(solved(scene, n, formulation).stations[-1].values["T.displacement"] - exact["T.displacement"]))
            for n in (10, 20, 40)
        ]
        orders = np.log2(np.array(errors[:-1]) / errors[1:])
        assert np.all((orders > least - 0.4) & (orders < most + 0.4)), formulation


def test_a_vanishing_compliance_leads_to_bending():
    # reference: the chain in bending; the difference is linear in the compliance
    system, _ = loop("shear", 20)
    rigid, _ = loop("bending", 20)
    numbering = system.mechanism
    target = np.zeros(len(numbering.rows))
    target[numbering.row("m")] = 0.4 * numbering.rows[numbering.row("m")].unit * numbering.units.moment

    def state(compliance):
        links = replace_links(system, rigid, compliance)
        start = rest_state(system)
        found = equilibrium(links, replace(start, target=target), 40)
        return found.state.z, found.iterations

    limit, iterations = state(0.0)
    gaps = []
    for compliance in (1e-2, 1e-4, 1e-6):
        z, count = state(compliance)
        assert abs(count - iterations) <= 2
        gaps.append(np.abs(z - limit)[system.motions].max())
    assert np.array(gaps[:-1]) / gaps[1:] == pytest.approx([100.0, 100.0], rel=0.05)


def replace_links(system, rigid, compliance):
    links = system.links._replace(
        stretch=compliance * system.links.stretch,
        shear=rigid.links.shear + compliance * (system.links.shear - rigid.links.shear),
    )
    return replace(system, links=links)


@pytest.mark.parametrize("theory", ["bending", "shear"])
def test_a_turned_and_shifted_scene_has_the_same_answer(theory):
    turn = np.radians(37.0)
    answers = []
    for angle, shift in ((0.0, (0.0, 0.0)), (turn, (3.1, -1.7))):
        _, scene = loop(theory, 20, turn=angle, shift=shift)
        probes = [{"of": "A", "quantity": "displacement"}, {"of": "R", "quantity": "reaction_moment"}]
        data = scene.model_dump(mode="json", exclude={"file"}) | {"probes": probes}
        data["stages"] = [
            {"name": "q", "steps": "q", "stations": [3.0]},
            {"name": "m", "steps": "m", "stations": [0.2, 0.5]},
            {"name": "k", "steps": "k", "stations": [0.1]},
        ]
        answers.append(solved(scene_from(data), 20))
    for one, other in zip(*(answer.stations for answer in answers), strict=True):
        x, y = one.values["A.displacement"]
        turned = [np.cos(turn) * x - np.sin(turn) * y, np.sin(turn) * x + np.cos(turn) * y]
        assert other.values["A.displacement"] == pytest.approx(turned, abs=1e-9 * 0.1)
        assert other.values["R.reaction_moment"] == pytest.approx(one.values["R.reaction_moment"], rel=1e-9)


def test_three_blades_share_their_forces():
    # reference: 36 EI/L³ of three guided blades for a small force; the pulls of the blades balance the plate
    length, thickness, width, modulus = 0.04, 6e-4, 0.01, 2e9
    blades, points, plate = {}, {}, {}
    for i in range(3):
        x = 0.01 * i
        points[f"G{i}"], plate[f"A{i}"] = [x, 0.0], [x, length]
        blades[f"blade{i}"] = {
            "curve": {"kind": "line", "start": [x, 0.0], "end": [x, length]},
            "thickness": thickness,
            "width": width,
            "material": "plastic",
            "start": {"joint": "weld", "point": f"G{i}"},
            "end": {"joint": "weld", "point": f"A{i}"},
        }
    rigidity = modulus * width * thickness**3 / 12.0
    force = 1e-3 * 36.0 * rigidity / length**2
    scene = scene_from(
        {
            "name": "guide",
            "theory": "bending",
            "materials": {"plastic": {"youngs_modulus": modulus, "poisson_ratio": 0.36}},
            "bodies": {
                "ground": {"motion": "fixed", "points": points},
                "plate": {"motion": "free", "points": plate},
            },
            "beams": blades,
            "loads": {"F": {"kind": "force", "point": "A0", "direction": [1.0, 0.0]}},
            "stages": [{"name": "push", "steps": "F", "stations": [force]}],
            "probes": [{"of": "A0", "quantity": "displacement"}]
            + [{"of": f"G{i}", "quantity": "reaction"} for i in range(3)],
        }
    )
    station = solved(scene).stations[-1]
    assert station.values["A0.displacement"][0] == pytest.approx(1e-3 * length, rel=1e-4)
    reactions = np.array([station.values[f"G{i}.reaction"] for i in range(3)])
    assert reactions.sum(axis=0) == pytest.approx([-force, 0.0], abs=1e-9 * force)
    # moment of the ends: force times half a length on either side of a blade
    assert reactions[:, 0] == pytest.approx(np.full(3, -force / 3.0), rel=1e-2)


def test_a_step_and_its_inertia_do_not_grow_faster_than_the_mesh():
    # the number of stored values counts, not the clock
    sizes = []
    for links in (40, 160):
        system, _ = loop("shear", links)
        factors, _ = factorise(system, rest_state(system))
        sizes.append(factors.bordered.coupling.solved.size + factors.factored.size)
    assert sizes[1] < 4.2 * sizes[0]


def test_sections_beside_a_moment_inside_an_element_turn_as_the_elastica_does():
    # reference: dφ/ds = M/EI before the moment, 0 behind it; EI = 2.1e11 · 0.01 · 1e-9/12 = 0.175 N·m²
    at, moment, bending_stiffness = 0.1 * 0.78, 0.5, 0.175
    data = {
        "name": "moment",
        "theory": "bending",
        "materials": {"steel": STEEL},
        "bodies": {"ground": {"motion": "fixed", "points": {"A": [0.0, 0.0]}}},
        "beams": {
            "beam": {
                "curve": {"kind": "line", "start": [0.0, 0.0], "end": [0.1, 0.0]},
                "thickness": 1e-3,
                "width": 0.01,
                "material": "steel",
                "start": {"joint": "weld", "point": "A"},
                "end": {"joint": "free"},
            }
        },
        "loads": {"M": {"kind": "beam_moment", "beam": "beam", "at": 0.78}},
        "stages": [{"name": "turn", "steps": "M", "stations": [moment]}],
        "probes": [{"of": "A", "quantity": "reaction_moment"}],
    }
    (station,) = solved(scene_from(data)).stations
    state = station.beams["beam"]
    expected = moment / bending_stiffness * np.minimum(state.s, at)
    assert state.section_angle == pytest.approx(expected, abs=1e-11)

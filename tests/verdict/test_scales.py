"""Scales of probes on made-up answers, by quantity, and places of a stress that are compared.

The made-up hinge is exact: at the reach R = 0.67 its beams of length ℓ = π·25 mm turn by 0.9·R about their starts, and
the farthest place of a beam moves by 0.01·R·(1, 1.5).
"""

import math
from dataclasses import replace

import numpy as np
import pytest

from comparisons import cases
from comparisons.choices import Choices
from comparisons.quantities import probe_scales
from comparisons.verdict.point_forces import away_from_point_forces, sharing_sources, zone_ends
from cprbm_scene import Probe, Stage
from cprbm_scene.answer import BeamState, PointForces, frozen_array
from cprbm_scene.frozendict import frozendict
from tests.verdict.made_up import MadeUp

R, LENGTH = 0.67, math.pi * 0.025
S = 2.3e9 * 0.008 * 0.002**3 / 12.0 / LENGTH  # E·I/ℓ
DEFLECTED, TURNED = 0.01 * R * math.hypot(1.0, 1.5), 0.9 * R
CRANK = 2e11 * 0.008 * 0.001**3 / 12.0 / 0.06  # E·I/ℓ of the case prestressed


def scales(scene, values):
    """Scales with these ``values`` by probe at every station; other probes have made-up values."""
    answer = MadeUp("fea", 0.0, contact=False)(scene, Choices(kinematics="bending"))
    given = {name: frozen_array(value) for name, value in values.items()}
    stations = (replace(each, values=frozendict({**each.values, **given})) for each in answer.stations)
    return probe_scales(scene, (replace(answer, stations=tuple(stations)),))


@pytest.mark.parametrize(
    ("vanishing", "size", "others", "scale"),
    [
        ("C displacement", 2, {}, 1e-3 * DEFLECTED),
        ("C displacement", 2, {"BD rotation": [TURNED]}, 1e-3 * TURNED * LENGTH),
        ("BD rotation", 1, {}, 1e-3 * DEFLECTED / LENGTH),
        ("BD rotation", 1, {"B displacement": [0.08, 0.0]}, 1e-3 * 0.08 / LENGTH),
        ("contact force", 1, {}, 1e-3 * R / LENGTH),
        ("contact force", 1, {"A reaction": [0.0, 20.0]}, 1e-3 * 20.0),
        ("A reaction", 2, {"C reaction_moment": [2.0]}, 1e-3 * 2.0 / LENGTH),
        ("A reaction_moment", 1, {}, R),
        ("A reaction_moment", 1, {"C reaction_moment": [-2.0]}, 2.0),
        ("beam1 bending_stress", 81, {"beam2 combined_stress": [0.0] * 80 + [5e7]}, 1e-3 * 5e7),
        ("beam1 combined_stress", 81, {}, 1e-4 * 2.3e9 * 0.002 / (2.0 * LENGTH)),
        ("scene potential_energy", 1, {}, 1e-8 * S),
        ("scene potential_energy", 1, {"A reaction_moment": [2.0]}, 1e-8 * S),
        ("contact closing_load", 1, {}, 1e-3 * R),
        ("contact centre", 1, {}, LENGTH),
        ("contact ends", 2, {}, LENGTH),
    ],
)
def test_a_probe_that_vanishes_has_the_scale_of_its_family(hinge, vanishing, size, others, scale):
    asked = tuple(Probe(of=name.split()[0], quantity=name.split()[1]) for name in (vanishing, *others))
    values = {vanishing.replace(" ", "."): [1e-24] * size} | {
        name.replace(" ", "."): value for name, value in others.items()
    }
    found = scales(hinge.model_copy(update={"probes": asked, "claims": ()}), values)
    assert found["load", asked[0].name] == pytest.approx(scale, rel=1e-9)


@pytest.mark.parametrize(
    ("vanishing", "scale"),
    [
        ("stopB angle", 1e-4),
        ("stopB moment", 1e-3 * math.pi / 2.0 * CRANK),
        ("O1 reaction", 1e-3 * math.pi / 2.0 * CRANK / 0.06),
        ("crank rotation", 1e-3 * math.pi / 2.0),
    ],
)
def test_a_drive_is_a_rotation_and_is_resisted_by_the_softest_beam(vanishing, scale):
    whole = cases.opened("prestressed")
    probe = Probe(of=vanishing.split()[0], quantity=vanishing.split()[1])
    scene = whole.model_copy(update={"probes": (probe,), "stages": whole.stages[:1], "claims": ()})
    found = scales(scene, {probe.name: [1e-20] * (2 if probe.quantity == "reaction" else 1)})
    assert found["forward", probe.name] == pytest.approx(scale, rel=1e-9)


def test_the_largest_value_of_a_stage_and_a_quarter_of_all_stages(hinge):
    stages = tuple(Stage(name=name, steps="M", stations=(load,)) for name, load in (("little", 0.01), ("much", R)))
    found = scales(hinge.model_copy(update={"stages": stages, "claims": ()}), {})
    assert found["much", "BD.rotation"] == pytest.approx(TURNED, rel=1e-9)
    assert found["little", "BD.rotation"] == pytest.approx(TURNED / 4.0, rel=1e-9)
    assert found["little", "A.reaction_moment"] == pytest.approx(0.3 * R / 4.0, rel=1e-9)


@pytest.mark.parametrize(
    ("name", "scale"),
    [
        ("C.displacement", 1e-4 * LENGTH),
        ("BD.rotation", 1e-4),
        ("contact.force", 1e-4 * S / LENGTH),
        ("A.reaction", 1e-4 * S / LENGTH),
        ("beam1.bending_stress", 1e-4 * 2.3e9 * 0.002 / (2.0 * LENGTH)),
        ("scene.potential_energy", 1e-8 * S),
        ("contact.closing_load", 1e-4 * S),
    ],
)
def test_where_nothing_happens_the_scale_is_a_share_of_the_natural_value(hinge, name, scale):
    """An unloaded part, or a straight column before it buckles: round-off is no scale."""
    still = Stage(name="load", steps="M", stations=(0.0,))
    asked = (*hinge.probes, Probe(of="C", quantity="displacement"))
    found = scales(hinge.model_copy(update={"stages": (still,), "probes": asked, "claims": ()}), {})
    assert found["load", name] == pytest.approx(scale, rel=1e-9)


@pytest.mark.parametrize(("tension", "scale"), [(800.0, 5e7), (-800.0, 5e7), (0.0, 5e5)])
def test_a_stress_has_at_least_the_stress_of_the_normal_force(hinge, tension, scale):
    """800 N on 8 mm times 2 mm, and a bending stress of 0.5 MPa."""
    answer = MadeUp("fea", 0.0, contact=False)(hinge, Choices(kinematics="bending"))
    s, zero = np.linspace(0.0, LENGTH, 3), np.zeros(3)
    state = BeamState(s, zero, zero, zero, zero, np.array([0.0, tension, 0.0]), zero, zero, s)
    bent = frozendict({**answer.stations[-1].values, "beam1.bending_stress": frozen_array([5e5])})
    station = replace(answer.stations[-1], values=bent, beams=frozendict({"beam1": state}))
    found = probe_scales(hinge, (replace(answer, stations=(station,)),))["load", "beam1.bending_stress"]
    assert found == pytest.approx(scale, rel=1e-9)


def test_a_value_that_is_not_finite_is_no_scale(hinge):
    assert scales(hinge, {"BD.rotation": [math.inf]})["load", "BD.rotation"] == pytest.approx(
        1e-3 * 0.01 * R * math.hypot(1.0, 2.0) / LENGTH  # B moves farther than the beams
    )


# -- Places of a stress: a thickness of 2 mm from clamps and from the ends of zones, elements of ℓ/40

PLACES = np.linspace(0.0, LENGTH, 801)


def pressed(hinge, *forces, source="contact", beam="beam1"):
    """A station with contact forces on the beam at fractions of the length: (0, 1) N or a given force."""
    station = MadeUp("cprbm", 0.0, contact=False)(hinge, Choices()).stations[-1]
    pairs = [each if isinstance(each, tuple) else (each, 1.0) for each in forces]
    k = len(pairs)
    return replace(
        station,
        forces=PointForces(
            (source,) * k if isinstance(source, str) else source,
            (beam,) * k,
            frozen_array([LENGTH * place for place, _ in pairs]),
            frozen_array(np.zeros((k, 2))),
            frozen_array(np.reshape([(0.0, force) for _, force in pairs], (k, 2))),
            frozen_array(np.zeros(k)),
        ),
    )


SPARSE, DENSE = (0.21, 0.25, 0.5, 0.68), tuple(np.linspace(0.2, 0.7, 101))
ZONES = (*np.linspace(0.1, 0.3, 15), *np.linspace(0.6, 0.8, 15))


@pytest.mark.parametrize(
    ("answers", "left_out"),
    [
        ([()], ()),
        ([(0.4,)], (0.4,)),
        ([tuple(np.linspace(0.2, 0.7, 31))], (0.2, 0.7)),
        ([(0.3, 0.6)], (0.3, 0.6)),
        ([ZONES], (0.1, 0.3, 0.6, 0.8)),
        ([SPARSE], SPARSE),
        ([SPARSE, DENSE], (0.2, 0.21, 0.68, 0.7)),
        ([(0.48,), (0.5,), (0.52,)], (0.48, 0.5, 0.52)),
        ([((0.3, 1.0), (0.6, 1e-4))], (0.3,)),
    ],
    ids=["open", "point", "zone", "two points", "two zones", "sparse", "sparse and dense", "meshes", "faint force"],
)
def test_a_stress_is_compared_a_thickness_from_clamps_and_ends_of_zones(hinge, answers, left_out):
    found = away_from_point_forces(hinge, "beam1", PLACES, [pressed(hinge, *each) for each in answers])
    expected = [np.abs(PLACES - LENGTH * place) >= 0.002 for place in (0.0, 1.0, *left_out)]
    np.testing.assert_array_equal(found, np.all(expected, axis=0))


@pytest.mark.parametrize(
    ("places", "gap", "ends"),
    [
        ([[]], 1.0, []),
        ([[3.0]], 1.0, [3.0, 3.0]),
        ([[3.0, 1.0, 2.0]], 1.0, [1.0, 3.0]),
        ([[1.0, 2.0, 4.0]], 1.5, [1.0, 2.0, 4.0, 4.0]),
        ([[1.0, 4.0], [2.0, 3.0]], 1.0, [1.0, 4.0, 2.0, 3.0]),
        ([[1.0, 9.0], [], [2.0]], 1.0, [1.0, 1.0, 9.0, 9.0, 2.0, 2.0]),
    ],
)
def test_ends_of_zones(places, gap, ends):
    assert zone_ends([np.array(own) for own in places], gap) == ends


@pytest.mark.parametrize(
    ("forces", "sources", "asked", "found"),
    [
        ((0.02, 0.0), ("contact", "A"), "contact", ("beam1", {"A"})),
        ((0.02, 0.0), ("contact", "A"), "A", ("beam1", {"contact"})),
        ((0.03, 0.0), ("contact", "A"), "contact", None),
        ((0.02, 1.0, 0.0), ("contact", "contact", "A"), "A", ("beam1", {"contact"})),
        ((0.0, 0.001), ("A", "B"), "A", None),
        (((0.02, 1e-4), (0.5, 1.0), 0.0), ("contact", "contact", "A"), "contact", None),
    ],
    ids=["contact", "clamp", "farther than an element", "nearest force", "two joints", "faint force"],
)
def test_a_clamp_and_a_contact_within_an_element_share_a_force(hinge, forces, sources, asked, found):
    """Elements are ℓ/40 long, 0.025 of the beam."""
    assert sharing_sources(hinge, [pressed(hinge, *forces, source=sources)], asked) == found

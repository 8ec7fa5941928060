"""Rows of made-up answers: differences, stated uncertainties, steps of theory and divisors; scales of probes.

Expected numbers follow from the planted law: a rotation of 0.9·m·f before contact at the moment m, with
f = 1 + e (40/N)² + theory.  Once the contact is closed the rotation is 0.8·m·f and a constant.  The hinge of the scales
is exact: at the reach R = 0.67 its beams of length ℓ = π·25 mm turn by 0.9·R about their starts, and the farthest place
of a beam moves by 0.01·R·(1, 1.5).
"""

import math
from dataclasses import replace

import numpy as np
import pytest

from comparisons import cases
from comparisons.choices import Choices
from comparisons.opinions import contact_model
from comparisons.pairing import Solvers, paired
from comparisons.quantities import probe_scales
from comparisons.verdict.point_forces import away_from_point_forces, sharing_sources, zone_ends
from comparisons.verdict.rows import rows_of
from comparisons.verdict.runs import other_theory
from cprbm_scene import Mistake, Probe, SceneError, Stage
from cprbm_scene.answer import BeamState, PointForces, frozen_array
from cprbm_scene.frozendict import frozendict
from tests.verdict.comparing import C, F, altered, compared, counted, ending, only, row_of, said_of, word_of
from tests.verdict.made_up import CLOSES, THEORY, MadeUp, with_value

S = 1.25
ROTATION = "BD.rotation"


def at_one_station(hinge, load):
    """The hinge at one station: no other station widens an uncertainty."""
    return hinge.model_copy(update={"stages": (Stage(name="load", steps="M", stations=(load,)),), "claims": ()})


@pytest.fixture
def first(hinge):
    """The hinge at one station before contact."""
    return at_one_station(hinge, 0.067)


@pytest.fixture
def last(hinge):
    """The hinge at one station behind the closing."""
    return at_one_station(hinge, 0.67)


def test_every_probe_has_a_row_at_every_station_and_an_open_contact_has_no_place(hinge):
    asked = hinge.model_copy(update={"probes": (*hinge.probes, Probe(of="contact", quantity="ends"))})
    found = compared(asked, C, F)
    assert len(found.rows) == len(asked.probes) * len(asked.stages[0].stations)
    assert [row.station for row in found.rows] == sorted(row.station for row in found.rows)
    force, centre = (row_of(found, f"contact.{name}", 0.067) for name in ("force", "centre"))
    assert (force.difference, force.bounds.total) == (0.0, 0.0)
    assert (centre.bounds, centre.fraction(centre.difference)) == (None, None)
    assert (said_of(found, "contact.force", 0.067), said_of(found, "contact.centre", 0.067)) == ("AGREE", "")
    assert row_of(found, "contact.closing_load").cprbm == pytest.approx([CLOSES / 1.002])
    ends = row_of(found, "contact.ends")  # two places on a beam
    assert (ends.cprbm.shape, ends.fea.shape, ends.unit) == ((2,), (2,), "m")
    assert ends.scale == ends.denominator == pytest.approx(math.pi * 0.025)


def test_planted_errors_are_stated_with_a_quarter_more_with_and_without_a_third_grid(hinge, first):
    row = row_of(compared(first, MadeUp("cprbm", 4e-3), MadeUp("fea", -8e-3)), ROTATION, 0.067)
    rotation, fea_error = 0.9 * 0.067, -8e-3 / 4  # at 80 elements a quarter of the error at 40
    assert row.bounds.cprbm == pytest.approx(S * rotation * 4e-3, rel=1e-9)
    assert row.bounds.fea == pytest.approx(S * rotation * 2e-3, rel=1e-9)
    assert row.difference == pytest.approx(rotation * (4e-3 - fea_error), rel=1e-9)
    assert row.theory == pytest.approx(rotation * 0.005, rel=1e-9)
    assert row.fraction(row.theory) == pytest.approx(0.005 / (1.0 + fea_error), rel=1e-9)
    runs = paired(hinge, Choices(), Solvers(C, F))
    assert list(runs.sizes.values()) == pytest.approx([46 / 40, 91 / 80, 2.0, 2.0])
    bare = replace(runs, answers={name: each for name, each in runs.answers.items() if "beside" not in name})
    for row, other in zip(rows_of(runs), rows_of(bare), strict=True):
        if row.bounds is not None:
            own, without = (np.array([each.bounds.cprbm, each.bounds.fea]) for each in (row, other))
            assert own == pytest.approx(without, rel=0.02, abs=1e-12 * row.scale)


def test_grids_that_meet_state_an_error_all_the_same(hinge, last):
    """N and 2N give one value, and the grid at 8/7 N a value 1 % smaller: S times the rest, transferred to N."""
    for solver in ("cprbm", "fea"):
        right, other = MadeUp(solver, 0.0), MadeUp(solver, 0.0, stiffness=1.01)
        planted = only(right, other, lambda choices: 46 in (choices.links, choices.elements))
        pair = {"cprbm": C, "fea": F, solver: planted}
        found = compared(last, pair["cprbm"], pair["fea"], Choices(elements=40))
        stated = S * 0.8 * 0.67 * (1.0 - 1.0 / 1.01) * (46 / 40) ** 2
        assert getattr(row_of(found, ROTATION).bounds, solver) == pytest.approx(stated, rel=1e-9), solver
    # the change between both grids vanishes at 0.335: a stage states the uncertainty of its last station
    meeting = altered(C, with_value(ROTATION, [0.8 * 0.335 * 1.002 + 0.1 * CLOSES]), 0.335)
    stages = [row.bounds.cprbm for row in compared(hinge, meeting, F).rows if row.probe.name == ROTATION]
    assert stages == pytest.approx([S * 0.8 * 0.67 * 2e-3] * 10, rel=1e-9)


@pytest.mark.parametrize("theory", ["bending", "stretch", "shear"])
def test_both_formulations_and_every_theory_of_the_scene_or_of_an_option(hinge, first, theory):
    """f is 1e-3 larger in ``paper``, and 0, 0.002 and 0.005 larger in the three theories."""
    rotation, other = 0.9 * 0.067, "shear" if theory == "bending" else "bending"
    for formulation in ("auto", "paper"):
        choices = Choices(formulation=formulation, theory=theory)
        found = compared(first, replace(C, paper=1e-3), MadeUp("fea", 0.0), choices)
        row = row_of(found, ROTATION, 0.067)
        assert contact_model(found.runs, row) == pytest.approx(1e-3 * rotation, rel=1e-9)
        assert row.theory == pytest.approx(rotation * abs(THEORY[other] - THEORY[theory]), rel=1e-9)
    for scene, choices in (
        (hinge.model_copy(update={"theory": theory}), Choices()),
        (hinge, Choices(theory=theory)),
        (hinge, Choices(kinematics=theory)),
    ):
        found = compared(scene, C, F, choices)
        assert (word_of(found), found.runs.theory, other_theory(found.runs.theory)) == ("AGREE", theory, other)
        assert row_of(found, ROTATION, 0.067).fea == pytest.approx([rotation * (1.0 - 1.25e-4 + THEORY[theory])])


def test_a_contact_force_tilts_in_shear_whatever_the_mesh(last):
    # F/(4 GA_s) of the most slender beam in contact, with GA_s = 5/6 E A/(2 (1 + ν)) of a rectangle
    fea = MadeUp("fea", 0.0)
    rows = {theory: row_of(compared(last, C, fea, Choices(theory=theory)), ROTATION) for theory in ("stretch", "shear")}
    beams = [last.beams[beam] for beam in last.contacts["contact"].beams]
    stiffness = min(
        5.0
        / 6.0
        * last.materials[beam.material].youngs_modulus
        * beam.thickest
        * float(beam.width_at(np.zeros(1))[0])
        / (2.0 * (1.0 + last.materials[beam.material].poisson_ratio))
        for beam in beams
    )
    force = 20.0 * (0.67 * (1.0 + THEORY["shear"]) - CLOSES)
    assert rows["stretch"].bounds.fea == 0.0
    assert rows["shear"].bounds.fea == pytest.approx(rows["shear"].scale * 0.25 * force / stiffness, rel=1e-9)


@pytest.mark.parametrize(
    ("solver", "size", "agreeing"),
    [("cprbm", 80, False), ("cprbm", 46, True), ("fea", 160, False), ("fea", 91, True)],
    ids=["2N", "8/7 N", "2n", "8/7 n"],
)
def test_a_helper_run_that_ends_early_leaves_both_values(hinge, solver, size, agreeing):
    """Without a run at 2N no uncertainty is known."""
    pair = {"cprbm": C, "fea": F}
    kind = "links" if solver == "cprbm" else "elements"
    pair[solver] = only(pair[solver], ending(pair[solver], 4), lambda choices: getattr(choices, kind) == size)
    found = compared(hinge, pair["cprbm"], pair["fea"])
    assert found.verdict.completed
    assert word_of(found) == ("AGREE" if agreeing else "UNDECIDED RUN_ENDED"), found.verdict.sentence
    row = row_of(found, "scene.potential_energy")
    assert row.missing
    assert all(name.startswith(solver) for name in row.missing)
    assert row.difference == pytest.approx(abs(float(row.cprbm[0] - row.fea[0])), rel=1e-12)
    assert found.verdict.sentence.count("It stuck.") == 1
    if row.bounds is None:
        assert said_of(found, "scene.potential_energy") == "UNDECIDED RUN_ENDED"
    assert said_of(found, "scene.potential_energy", 0.067) == "AGREE"


def refusing(scene, choices):
    if choices.theory == "shear":
        raise SceneError([Mistake("theory", "'shear'", "'bending'", "file.toml")])
    return C(scene, choices)


@pytest.mark.parametrize(
    ("cprbm", "known", "absence"),
    [
        (only(C, ending(C, 0), lambda choices: choices.theory == "shear"), 0, "it ended early: It stuck."),
        (only(C, ending(C, 4), lambda choices: choices.theory == "shear"), 4, "it ended early: It stuck."),
        (refusing, None, "file.toml: theory: found 'shear'; allowed: 'bending'."),
    ],
    ids=["nothing", "four stations", "refused"],
)
def test_a_chain_without_an_answer_in_the_other_theory_leaves_the_verdict_and_is_named(hinge, cprbm, known, absence):
    found = compared(hinge, cprbm, F)
    assert (word_of(found), found.runs.other is None) == ("AGREE", known is None)
    refused, ended = "The CPRBM does not answer in shear", "In shear the CPRBM has no complete answer"
    assert f"{refused if known is None else ended}: {absence}" in found.verdict.sentence
    theories = [math.isfinite(row.theory) for row in found.rows if row.probe.name == ROTATION]
    assert theories == [True] * (known or 0) + [False] * (10 - (known or 0))


def test_more_than_round_off_is_a_difference(last, hinge):
    """Values of 3.6 N that no grid changes: nothing but 3.6e-9 N of round-off is stated; at zero load 1e-9 rad."""
    for off, word in ((1e-9, "AGREE"), (1e-8, "DIFFER VALUES")):
        pair = [altered(solver, with_value("C.reaction", [2.01 + own, 3.0])) for solver, own in ((C, off), (F, 0.0))]
        assert said_of(compared(last, *pair), "C.reaction") == word, off
    still = at_one_station(hinge, 0.0)
    assert set(counted(compared(still, altered(C, with_value(ROTATION, [3e-16])), F))) == {"AGREE"}
    wrong = altered(C, with_value(ROTATION, [1e-9]))
    assert said_of(compared(still, wrong, F), ROTATION, 0.0) == "DIFFER VALUES"


def test_a_stress_differs_by_its_worst_place_and_fractions_are_of_a_value_or_of_the_scale(hinge, last, agreeing):
    def spoilt(station):
        stress = np.array(station.values["beam1.bending_stress"])
        stress[20] -= 5e6  # away from clamps and contact, and not the largest stress
        return with_value("beam1.bending_stress", stress)(station)

    stress = row_of(compared(last, altered(C, spoilt), F), "beam1.bending_stress")
    assert stress.difference == pytest.approx(5e6, rel=0.02)
    early = row_of(agreeing, "B.displacement", 0.067)
    assert early.denominator == pytest.approx(float(np.linalg.norm(early.fea)))
    assert early.denominator < early.scale
    force = row_of(agreeing, "contact.force", 0.268)
    assert force.denominator == force.scale == pytest.approx(float(row_of(agreeing, "contact.force").cprbm[0]))
    vanishing = altered(F, with_value("B.displacement", [1e-7, 0.0]), 0.067)
    row = row_of(compared(hinge, C, vanishing), "B.displacement", 0.067)
    assert row.denominator == row.scale


# -- Scales of probes

R, LENGTH = 0.67, math.pi * 0.025
STIFFNESS = 2.3e9 * 0.008 * 0.002**3 / 12.0 / LENGTH  # E·I/ℓ
DEFLECTED, TURNED = 0.01 * R * math.hypot(1.0, 1.5), 0.9 * R
CRANK = 2e11 * 0.008 * 0.001**3 / 12.0 / 0.06  # E·I/ℓ of the case prestressed


def scales(scene, values):
    """Scales with these ``values`` by probe at every station; other probes have made-up values."""
    answer = MadeUp("fea", 0.0, contact=False)(scene, Choices(kinematics="bending"))
    given = {name: frozen_array(value) for name, value in values.items()}
    stations = (replace(each, values=frozendict({**each.values, **given})) for each in answer.stations)
    return probe_scales(scene, (replace(answer, stations=tuple(stations)),))


@pytest.mark.parametrize(
    ("case", "vanishing", "size", "others", "scale"),
    [
        ("hinge", "C displacement", 2, {}, 1e-3 * DEFLECTED),
        ("hinge", "C displacement", 2, {"BD rotation": [TURNED]}, 1e-3 * TURNED * LENGTH),
        ("hinge", "BD rotation", 1, {}, 1e-3 * DEFLECTED / LENGTH),
        ("hinge", "BD rotation", 1, {"B displacement": [0.08, 0.0]}, 1e-3 * 0.08 / LENGTH),
        ("hinge", "contact force", 1, {}, 1e-3 * R / LENGTH),
        ("hinge", "contact force", 1, {"A reaction": [0.0, 20.0]}, 1e-3 * 20.0),
        ("hinge", "A reaction", 2, {"C reaction_moment": [2.0]}, 1e-3 * 2.0 / LENGTH),
        ("hinge", "A reaction_moment", 1, {}, R),
        ("hinge", "A reaction_moment", 1, {"C reaction_moment": [-2.0]}, 2.0),
        ("hinge", "beam1 bending_stress", 81, {"beam2 combined_stress": [0.0] * 80 + [5e7]}, 1e-3 * 5e7),
        ("hinge", "beam1 combined_stress", 81, {}, 1e-4 * 2.3e9 * 0.002 / (2.0 * LENGTH)),
        ("hinge", "scene potential_energy", 1, {}, 1e-8 * STIFFNESS),
        ("hinge", "scene potential_energy", 1, {"A reaction_moment": [2.0]}, 1e-8 * STIFFNESS),
        ("hinge", "contact closing_load", 1, {}, 1e-3 * R),
        ("hinge", "contact centre", 1, {}, LENGTH),
        ("hinge", "contact ends", 2, {}, LENGTH),
        ("prestressed", "stopB angle", 1, {}, 1e-4),
        ("prestressed", "stopB moment", 1, {}, 1e-3 * math.pi / 2.0 * CRANK),
        ("prestressed", "O1 reaction", 2, {}, 1e-3 * math.pi / 2.0 * CRANK / 0.06),
        ("prestressed", "crank rotation", 1, {}, 1e-3 * math.pi / 2.0),
    ],
)
def test_a_probe_that_vanishes_has_the_scale_of_its_family(case, vanishing, size, others, scale):
    """In the case ``prestressed`` a drive is a rotation and is resisted by the softest beam."""
    scene = cases.opened(case)
    asked = tuple(Probe(of=name.split()[0], quantity=name.split()[1]) for name in (vanishing, *others))
    values = {vanishing: [1e-24] * size} | others
    scene = scene.model_copy(update={"probes": asked, "stages": scene.stages[:1], "claims": ()})
    found = scales(scene, {name.replace(" ", "."): value for name, value in values.items()})
    assert found[scene.stages[0].name, asked[0].name] == pytest.approx(scale, rel=1e-9)


def test_a_scale_is_the_largest_finite_value_of_a_stage_and_a_quarter_of_all_stages(hinge):
    stages = tuple(Stage(name=name, steps="M", stations=(load,)) for name, load in (("little", 0.01), ("much", R)))
    found = scales(hinge.model_copy(update={"stages": stages, "claims": ()}), {})
    assert found["much", ROTATION] == pytest.approx(TURNED, rel=1e-9)
    assert found["little", ROTATION] == pytest.approx(TURNED / 4.0, rel=1e-9)
    assert found["little", "A.reaction_moment"] == pytest.approx(0.3 * R / 4.0, rel=1e-9)
    assert scales(hinge, {ROTATION: [math.inf]})["load", ROTATION] == pytest.approx(
        1e-3 * 0.01 * R * math.hypot(1.0, 2.0) / LENGTH  # B moves farther than the beams
    )
    # a stress has at least the stress of the normal force: 800 N on 8 mm times 2 mm, and a bending stress of 0.5 MPa
    last = MadeUp("fea", 0.0, contact=False)(hinge, Choices(kinematics="bending"))
    s, zero = np.linspace(0.0, LENGTH, 3), np.zeros(3)
    bent = frozendict({**last.stations[-1].values, "beam1.bending_stress": frozen_array([5e5])})
    for tension, scale in ((800.0, 5e7), (-800.0, 5e7), (0.0, 5e5)):
        state = BeamState(s, zero, zero, zero, zero, np.array([0.0, tension, 0.0]), zero, zero, s)
        station = replace(last.stations[-1], values=bent, beams=frozendict({"beam1": state}))
        stresses = probe_scales(hinge, (replace(last, stations=(station,)),))
        assert stresses["load", "beam1.bending_stress"] == pytest.approx(scale, rel=1e-9), tension


def test_where_nothing_happens_the_scale_is_a_share_of_the_natural_value(hinge):
    """An unloaded part, or a straight column before it buckles: round-off is no scale."""
    asked = (*hinge.probes, Probe(of="C", quantity="displacement"))
    found = scales(at_one_station(hinge, 0.0).model_copy(update={"probes": asked}), {})
    expected = {
        "C.displacement": 1e-4 * LENGTH,
        ROTATION: 1e-4,
        "contact.force": 1e-4 * STIFFNESS / LENGTH,
        "A.reaction": 1e-4 * STIFFNESS / LENGTH,
        "beam1.bending_stress": 1e-4 * 2.3e9 * 0.002 / (2.0 * LENGTH),
        "scene.potential_energy": 1e-8 * STIFFNESS,
        "contact.closing_load": 1e-4 * STIFFNESS,
    }
    assert {name: found["load", name] for name in expected} == pytest.approx(expected, rel=1e-9)


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

"""The exact solution beside references that share nothing with it: each comes from ``tests.references``."""

from __future__ import annotations

import dataclasses
import json

import numpy as np
import pytest

from cprbm_scene import scene_from
from elastica_reference import Settings
from elastica_reference import answer as exact_answer
from tests.cprbm.scenes import LENGTH, MODULUS, MOMENT, RIGIDITY, THICKNESS, cantilever_data, force
from tests.elastica_reference import scenes
from tests.elastica_reference.scenes import completed
from tests.references import curved, hinge, tapered
from tests.references.elastica import cantilever_under_tip_force, roll_up
from tests.references.guided import guided_beam
from tests.references.post_buckled import post_buckled
from tests.references.three_cantilevers import solve as three_cantilevers
from tests.references.two_cantilevers import TwoCantilevers
from tests.references.two_cantilevers import solve as two_cantilevers
from tests.references.wrapped import Wrapped
from tests.together import bowed
from tests.together.test_stacked import EI, STACK, L, stacked
from tests.together.test_tapered import KNOTTED, NARROW, sized

CLOSE = 1e-9


def close(value, expected, scale=None):
    """Within 1e-9 of the expected value's size, or of ``scale``."""
    size = np.max(np.abs(expected)) if scale is None else scale
    np.testing.assert_allclose(np.ravel(value), np.ravel(expected), rtol=0.0, atol=CLOSE * size)


# ------------------------------------------------------------------------------------- single beams


@pytest.mark.parametrize("alpha", [1e-3, 1.0, -10.0, 60.0])
def test_tip_force(alpha):
    data = cantilever_data(force(0.0, 1.0), [alpha * RIGIDITY / LENGTH**2])
    values, tip = completed(data).stations[-1].values, cantilever_under_tip_force(alpha)
    close(values["T.displacement"] / LENGTH, [tip.x - 1.0, tip.y])
    close(values["tip.rotation"], tip.rotation)
    close(values["R.reaction_moment"], -alpha * RIGIDITY / LENGTH * tip.x)


@pytest.mark.parametrize("kappa", [0.3, -np.pi, 2.0 * np.pi, 13.0])
def test_roll_up_to_more_than_one_turn(kappa):
    values = completed(cantilever_data(MOMENT, [kappa * RIGIDITY / LENGTH])).stations[-1].values
    tip = roll_up(kappa)
    close(values["T.displacement"] / LENGTH, [tip.x - 1.0, tip.y], 1.0)
    close(values["tip.rotation"], kappa)
    close(values["beam.bending_stress"], np.full(11, 0.5 * MODULUS * THICKNESS * kappa / LENGTH))
    # reference: the strain energy ½ M κ/L · L less the work M κ
    close(values["scene.potential_energy"], -0.5 * RIGIDITY / LENGTH * kappa**2)


@pytest.mark.parametrize("load", ["force", "moment", "both"])
def test_sections_that_vary(load):
    F = (0.3 * RIGIDITY / LENGTH**2, 0.9 * RIGIDITY / LENGTH**2) if load != "moment" else (0.0, 0.0)
    M = 0.2 * RIGIDITY / LENGTH if load != "force" else 0.0
    data = cantilever_data(force(*F) if load != "moment" else MOMENT, [float(np.hypot(*F)) or M])
    if load == "both":
        data["loads"]["M"] = MOMENT
        data["stages"].append({"name": "turn", "steps": "M", "stations": [M]})
    data["beams"]["beam"] |= {"thickness": sized(KNOTTED), "width": sized(NARROW)}
    values = completed(data).stations[-1].values
    reference = tapered.bent(LENGTH, MODULUS, KNOTTED, NARROW, F, M, np.linspace(0.0, 1.0, 11))
    close(values["T.displacement"] / LENGTH + [1.0, 0.0], np.array([reference.x, reference.y]) / LENGTH)
    close(values["tip.rotation"], reference.angle)
    close(values["beam.bending_stress"], reference.stress)
    close(values["scene.potential_energy"], reference.energy)


@pytest.mark.parametrize("axis", ["x", "y"])
@pytest.mark.parametrize("against", [False, True])
def test_polynomial_beams_both_ways(axis, against):
    # x = f(y) or y = f(x), f a cubic without symmetry, clamped at either end of its range
    span, coefficients = ((0.05, 0.01) if against else (0.01, 0.05)), [0.02, 0.1, 6.0, -90.0]
    f = np.polynomial.Polynomial(coefficients)
    ends = [[v, float(f(v))] if axis == "x" else [float(f(v)), v] for v in span]
    for load, stations, kept in (
        (bowed.force(0.6, -0.8), [30.0], {"force": (18.0, -24.0)}),
        (bowed.MOMENT, [0.3], {"moment": 0.3}),
    ):
        curve = {"kind": "polynomial", "axis": axis, "coefficients": coefficients, "range": list(span)}
        data = bowed.cantilever(load, stations, curve)
        data["bodies"]["wall"]["points"]["R"], data["bodies"]["tip"]["points"]["T"] = ends
        values = completed(data).stations[-1].values
        reference = curved.bent(lambda v: float(f.deriv()(v)), axis, span, bowed.RIGIDITY, **kept)
        assert np.hypot(*reference.displacement) > 0.002
        close(values["T.displacement"], reference.displacement, 0.05)
        close(values["tip.rotation"], reference.rotation)
        close(values["R.reaction_moment"], -reference.clamp_moment)


def test_a_beam_between_guides():
    # the tip is kept level by a drive that stays at zero, whose moment is the probe
    data = cantilever_data(force(0.0, 1.0), [a * RIGIDITY / LENGTH**2 for a in (4.0, 40.0)])
    data["drives"] = {"level": {"kind": "rotation", "body": "tip"}}
    data["probes"].append({"of": "tip", "quantity": "reaction_moment"})
    for alpha, station in zip((4.0, 40.0), completed(data).stations, strict=True):
        reference = guided_beam(alpha)
        close(station.values["T.displacement"] / LENGTH, [-reference.shortening, reference.offset])
        for probe in ("tip.reaction_moment", "R.reaction_moment"):
            close(np.abs(station.values[probe]), reference.moment * RIGIDITY / LENGTH)


# ------------------------------------------------------------------------------------ after buckling


@pytest.mark.parametrize("load", [45.0, 70.0])
def test_the_clamped_column_beyond_eulers_load(load):
    found = completed(scenes.post_buckled(load))
    values, reference = found.stations[-1].values, post_buckled(load)
    close(values["M.displacement"] / LENGTH, [-0.5 * reference.shortening, reference.deflection])
    close(values["E.displacement"] / LENGTH, [-reference.shortening, 0.0])
    close(values["R.reaction"], [load * RIGIDITY / LENGTH**2, 0.0])
    close(np.abs(values["R.reaction_moment"]), reference.moment * RIGIDITY / LENGTH)
    energy = (reference.strain_energy - load * reference.shortening) * RIGIDITY / LENGTH
    close(values["scene.potential_energy"], energy)
    stress = 0.5 * MODULUS * THICKNESS * reference.moment / LENGTH * np.array([1.0, 0.0, -1.0])
    close(np.abs(values["first.bending_stress"][[0, 2, 4]]), np.abs(stress))
    assert found.stations[-1].certificate.smallest_curvature > 0.0


def test_a_drive_that_bows_the_column_as_far_as_its_load_does_has_nothing_to_hold():
    load = 60.0
    reference = post_buckled(load)
    values = completed(scenes.post_buckled(load, driven_to=reference.deflection)).stations[-1].values
    close(values["M.reaction"], [0.0, 0.0], load * RIGIDITY / LENGTH**2)
    close(values["E.displacement"] / LENGTH, [-reference.shortening, 0.0])


# ------------------------------------------------------------------------------------------ contacts

HINGES = {
    "thickness": dataclasses.replace(hinge.PAPER, thickness=0.0013, yc=0.0261),
    "gap": dataclasses.replace(hinge.PAPER, yc=0.0277),
}


@pytest.mark.parametrize("name", HINGES)
def test_the_hinge(name):
    of = HINGES[name]
    closing = hinge.closing_moment(of)
    moments = [0.7 * closing, 1.9 * closing, -0.5 * closing] if name == "gap" else [0.8 * closing, 2.3 * closing]
    found = completed(scenes.hinge(of, moments))
    for station in found.stations:
        reference = hinge.solve(of, station.value)
        values, size = station.values, of.bending_stiffness / of.radius
        for probe, expected in (
            ("B.displacement", reference.displacement_B),
            ("D.displacement", reference.displacement_D),
            ("BD.rotation", reference.rotation),
            ("beam1.bending_stress", reference.bending_stress(1, np.linspace(0.0, of.length, 81))),
            ("beam2.bending_stress", reference.bending_stress(2, np.linspace(0.0, of.length, 81))),
            ("scene.potential_energy", reference.potential_energy),
        ):
            close(values[probe], expected)
        for point in "AC":
            close(values[f"{point}.reaction"], getattr(reference, f"reaction_{point}"), size / of.radius)
            close(values[f"{point}.reaction_moment"], getattr(reference, f"reaction_moment_{point}"), size)
        close(values["contact.force"], reference.contact_force, size / of.radius)
        assert (reference.contact_arc_lengths is None) == (len(values["contact.centre"]) == 0)
        if reference.contact_arc_lengths is not None:
            close(values["contact.centre"], reference.contact_arc_lengths[0])
            close(values["contact.closing_load"], closing)
            assert reference.contact_point is not None
            close(station.touching["contact"], reference.contact_point, of.radius)


def test_the_hinge_by_any_other_name():
    # recognised by content: every name but the moment's is another, the answers are the same
    of = hinge.PAPER
    text = json.dumps(scenes.hinge(of, [0.5]))
    for name, other in (("beam1", "q7"), ("beam2", "arc"), ("BD", "plate"), ("AC", "rock"), ("contact", "kiss")):
        text = text.replace(f'"{name}"', f'"{other}"')
    data = json.loads(text)
    del data["contacts"]["kiss"]["paper"]
    reference = hinge.solve(of, 0.5)
    values = completed(data | {"name": "something_else"}).stations[-1].values
    close(values["plate.rotation"], reference.rotation)
    close(values["kiss.force"], reference.contact_force)


WRAPS = {
    "case": Wrapped(0.0973, 0.0711, 0.00103, 0.0097, 2.07e11, 1.0),
    "radius": Wrapped(0.0973, 0.0431, 0.00103, 0.0097, 2.07e11, 1.0),
    "thickness": Wrapped(0.0973, 0.0711, 0.00207, 0.0097, 2.07e11, 1.0),
    "pull": Wrapped(0.0973, 0.0711, 0.00103, 0.0097, 2.07e11, 1.0, 0.45 * np.pi),
    "forwards": Wrapped(0.0973, 0.0711, 0.00103, 0.0097, 2.07e11, 1.0, 0.35 * np.pi),
}


def of_wrapped(beam):
    return {
        "T.displacement": beam.displacement,
        "tip.rotation": beam.rotation,
        "contact.force": np.linalg.norm(beam.contact_force),
        "contact.centre": [beam.contact_centre] if beam.wrapped else [],
        "contact.ends": [0.0, beam.wrap_length] if beam.wrapped else [],
        "contact.closing_load": [beam.closing_load] if beam.wrapped else [],
        "C.reaction": beam.reaction,
        "C.reaction_moment": beam.reaction_moment,
        "beam.bending_stress": beam.bending_stress(81),
        "scene.potential_energy": beam.potential_energy,
    }


@pytest.mark.parametrize("name", WRAPS)
@pytest.mark.parametrize("reverse", [False, True])
def test_a_cantilever_pressed_round_a_circle(name, reverse):
    of = WRAPS[name]
    closing = of.closing_load
    data = scenes.wrapped(of, [0.6 * closing, 1.3 * closing, 3.0 * closing])
    if reverse:  # the clamp on the circle is then at the beam's end
        data = scenes.reversed_beam(data, "beam")
    found = completed(data)
    for station in found.stations:
        beam = dataclasses.replace(of, force=station.value)
        assert beam.wrapped == (station.value > closing)
        for probe, expected in of_wrapped(beam).items():
            value = station.values[probe]
            assert value.size == np.size(expected), probe
            if reverse and probe in ("contact.centre", "contact.ends") and value.size:
                value = (of.length - value)[::-1]
            if reverse and probe == "beam.bending_stress":
                value = -value[::-1]
            if value.size:
                close(value, expected)


def test_a_tip_on_a_beam():
    for of in (TwoCantilevers(0.02, 1.8, 1.0, 2.0), TwoCantilevers(0.05, 1.6, 0.9, 2.0)):
        found = completed(scenes.tip_on_beam(of, [0.5 * of.force, of.force]))
        for share, station in zip((0.5, 1.0), found.stations, strict=True):
            reference, values = two_cantilevers(dataclasses.replace(of, force=share * of.force)), station.values
            close((values["T.displacement"] + [LENGTH, of.gap * LENGTH]) / LENGTH, reference.tip)
            close(values["tip.rotation"], reference.rotation)
            close(values["touch.force"], reference.contact_force * RIGIDITY / LENGTH**2)
            close(values["touch.centre"], LENGTH)
            close(values["R.reaction_moment"], -reference.upper_moment * RIGIDITY / LENGTH)
            close(values["Q.reaction_moment"], -reference.lower_moment * RIGIDITY / LENGTH)
        # reference: the tip comes down by the gap as Bisshopp and Drucker's does
        alpha = found.events[0].value * LENGTH**2 / RIGIDITY
        close(cantilever_under_tip_force(alpha).y, of.gap)


def test_three_cantilevers():
    found, reference = exact_answer(stacked()), three_cantilevers(STACK)
    assert found.completed, found.sentence
    values = found.stations[-1].values
    close(values["tip.displacement"] / L, reference.tip - [1.0, STACK.gap])
    close(values["end.rotation"], reference.rotation)
    close(values["first.force"], reference.forces[0] * EI / L**2)
    close(values["second.force"], reference.forces[1] * EI / L**2)
    for point, moment in zip("UVW", reference.moments, strict=True):
        close(values[f"{point}.reaction_moment"], -moment * EI / L)


def test_more_gauss_points_change_nothing():
    data = scenes.hinge(hinge.PAPER, [0.5])
    coarse, fine = (exact_answer(scene_from(data), Settings(nodes=nodes)).stations[-1].values for nodes in (24, 48))
    for probe, value in coarse.items():
        close(value, fine[probe])

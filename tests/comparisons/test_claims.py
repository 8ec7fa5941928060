"""Claims: at one station or at all, of a displacement or of a force, beside rows written by hand."""

import math
from dataclasses import replace

import pytest

from comparisons.case import compare
from comparisons.choices import Choices
from comparisons.formats import percent
from comparisons.opinions import claim_difference, claim_met, claim_of, standings
from comparisons.pairing import paired
from comparisons.present import json_document
from comparisons.verdict.rows import Row
from cprbm_scene import Claim, Probe
from cprbm_scene.answer import frozen_array
from cprbm_scene.reading import mistakes_in
from tests.tables import tables_of


def row(value, reference, *, station=1.0, quantity="reaction", scale=100.0):
    """A row of one component whose fraction is of the scale."""
    probe = Probe(of="A", quantity=quantity)
    both = frozen_array([value]), frozen_array([reference])
    return Row(probe, "load", station, "N", *both, scale, scale, difference=abs(value - reference))


def claiming(hinge, *claims):
    return hinge.model_copy(update={"claims": claims})


ROTATION = Probe(of="BD", quantity="rotation")
EVERYWHERE = Claim(probe="BD.rotation", bound=0.005, text="rotation within 0.5 % everywhere")


def test_a_claim_without_a_station_stands_at_every_row_of_its_probe(hinge, right):
    comparison = compare(paired(claiming(hinge, EVERYWHERE), Choices(), right))
    found = json_document.comparison(comparison)["rows"]
    mine = [each for each in found if each["probe"] == "BD.rotation"]
    assert len(mine) == 10
    for each in mine:
        assert each["claim"] == 0.005
        assert each["claim_met"] is (each["claim_difference"] <= 0.005)
    assert {each["claim"] for each in found if each["probe"] != "BD.rotation"} == {None}
    assert {each["claim_difference"] for each in found if each["probe"] != "BD.rotation"} == {None}


def test_it_has_one_line_with_the_worst_station_and_how_often_it_is_met(hinge, right):
    comparison = compare(paired(claiming(hinge, EVERYWHERE), Choices(), right))
    fractions = {row.station: claim_difference(row) for row in comparison.rows if row.probe.name == "BD.rotation"}
    worst = max(fractions, key=fractions.get)
    met = sum(fraction <= 0.005 for fraction in fractions.values())
    sheet = next(sheet for sheet in tables_of(comparison) if sheet.title == "Claims of the source")
    ((text, theirs, _, at, how_often, word),) = sheet.rows
    assert text == EVERYWHERE.text
    assert theirs == "0.500 %"
    assert at == f"load {worst:g} N·m"
    assert how_often == f"{met} of 10"
    assert word == ("met" if met == 10 else "not met")


def test_met_everywhere_but_once_is_not_met(hinge):
    scene = claiming(hinge, Claim(probe="A.reaction", bound=0.01))
    rows = [row(100.0, 100.5, station=1.0), row(100.0, 102.0, station=2.0), row(100.0, 100.0, station=3.0)]
    (standing,) = standings(scene, rows)
    assert (standing.met, standing.stations, standing.holds) == (2, 3, False)
    assert standing.worst.station == 2.0
    assert standings(scene, rows[::2])[0].holds


def test_a_claim_of_a_station_goes_before_one_of_all(hinge):
    everywhere, here = Claim(probe="A.reaction", bound=0.01), Claim(probe="A.reaction", station=2.0, bound=0.05)
    scene = claiming(hinge, everywhere, here)
    assert claim_of(scene, row(1.0, 1.0, station=2.0)) is here
    assert claim_of(scene, row(1.0, 1.0, station=1.0)) is everywhere
    assert claim_of(scene, row(1.0, 1.0, quantity="force")) is None


@pytest.mark.parametrize("quantity", ["reaction", "force", "reaction_moment"])
def test_a_claim_of_a_force_is_of_the_value_there(quantity):
    """10.2 for 10 where the stage has 100: 0.2 % of the largest, and 2 % of the value that is claimed about."""
    small = row(10.2, 10.0, quantity=quantity)
    assert small.fraction(small.difference) == pytest.approx(0.002)
    assert claim_difference(small) == pytest.approx(0.02)
    assert claim_met(Claim(probe=small.probe.name, bound=0.01), small) is False


def test_a_claim_of_a_vanishing_force_is_of_the_stages_largest_and_of_a_place_of_the_beam():
    assert claim_difference(row(0.9, 0.5)) == pytest.approx(0.004)
    assert claim_difference(row(10.2, 10.0, quantity="centre")) == pytest.approx(0.002)


def test_every_station_that_the_scenes_check_lets_pass_has_its_row(hinge):
    near = Claim(probe="BD.rotation", station=0.67 * (1.0 + 1e-10), bound=0.01)
    assert not list(mistakes_in(claiming(hinge, near)))
    assert standings(claiming(hinge, near), [replace(row(1.0, 1.0, station=0.67), probe=ROTATION)])


def test_a_row_without_a_difference_meets_nothing(hinge):
    nothing = Row(
        Probe(of="A", quantity="reaction"), "load", 1.0, "N", frozen_array([]), frozen_array([]), 1.0, 1.0, math.nan
    )
    claim = Claim(probe="A.reaction", bound=0.01)
    assert claim_met(claim, nothing) is None
    assert standings(claiming(hinge, claim), [nothing]) == ()


def test_a_force_is_claimed_as_a_share_of_its_own_value(hinge, right):
    scene = claiming(hinge, Claim(probe="contact.force", station=0.335, bound=0.01))
    comparison = compare(paired(scene, Choices(), right))
    sheet = next(sheet for sheet in tables_of(comparison) if sheet.title == "Claims of the source")
    (small,) = (each for each in comparison.rows if each.probe.name == "contact.force" and each.station == 0.335)
    assert sheet.rows[0][2] == percent(claim_difference(small))
    assert small.fraction(small.difference) != claim_difference(small)

"""Settings that make no sense are refused by name."""

import pytest

from cprbm_scene import SceneError
from fea_reference import Settings, answer
from tests.fea_reference.cantilever import MOMENT, cantilever


@pytest.mark.parametrize(
    ("key", "value"),
    [
        ("elements", 0),
        ("elements", -3),
        ("elements", 2.5),
        ("elements", True),
        ("kinematics", "solid"),
        ("penetration", 0.0),
        ("penetration", float("nan")),
        ("quadrature", 0),
        ("residual", 2.0),
    ],
)
def test_out_of_bounds(key, value):
    with pytest.raises(SceneError) as caught:
        Settings(**{key: value})
    (mistake,) = caught.value.mistakes
    assert mistake.key == f"settings.{key}"


def test_elements_of_unknown_and_forgotten_beams():
    with pytest.raises(SceneError, match="unknown beam 'beam7'") as caught:
        answer(cantilever(MOMENT, (1e-3,)), Settings(elements={"beam7": 10}))
    assert {mistake.key for mistake in caught.value.mistakes} == {"settings.elements"}
    assert len(caught.value.mistakes) == 2
    with pytest.raises(SceneError, match=r"settings\.elements\.beam"):
        Settings(elements={"beam": 0})


def test_finer_and_plain():
    assert Settings(elements=3).finer() == Settings(elements=6)
    finer = Settings(elements={"a": 2, "b": 5}, kinematics="bending").finer()
    assert finer.plain()["elements"] == {"a": 4, "b": 10}
    assert finer.plain()["kinematics"] == "bending"
    assert Settings(**finer.plain()) == finer

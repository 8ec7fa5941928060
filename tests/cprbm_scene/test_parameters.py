"""Parameters and expressions: values by hand, dimensions, cycles, settings, and the built-in cases that use them."""

import copy
import math
import pickle

import pytest

from comparisons import cases
from cprbm_scene import SceneError, read, scene_from
from tests.cprbm_scene.conftest import HINGE as FILE
from tests.cprbm_scene.editing import mistakes, two_lines

PARAMETERS = {
    "t": {"value": 2.0, "unit": "mm", "range": [1.6, 2.4], "tolerance": {"normal": 0.02}},
    "L": {"value": 0.1, "unit": "m"},
    "slope": {"value": 30.0, "unit": "deg"},
    "E": {"value": 200.0, "unit": "GPa"},
    "M": {"value": 40.0, "unit": "N*mm"},
    "k": {"value": 0.5},
    "half": {"value": "= t/2"},
}


def with_thickness(expression):
    """Two cantilevers with parameters and an expression for the lower thickness."""
    data = two_lines(0.02, thick=False)
    data |= {"parameters": copy.deepcopy(PARAMETERS)}
    data["beams"]["lower"]["thickness"] = expression
    return data


VALUES = [
    ("= t", 0.002),
    ("= 2*half", 0.002),
    ("=0.001 + half", 0.002),
    ("= 50e-4*sqrt(0.16) - t/2 + half", 0.002),
    ("= 2*t*sin(slope)", 0.002),
    ("= t*tan(slope)*sqrt(3)", 0.002),
    ("= hypot(0.6*t, 0.8*t)", 0.002),
    ("= min(t, L, 1)", 0.002),
    ("= abs(max(-t, -L))", 0.002),
    ("= t**2/L*50", 0.002),
    ("= sqrt(t*L/50)", 0.002),
    ("= k*0.004", 0.002),
    ("= t*pi/3.141592653589793", 0.002),
    ("= L*atan2(t, L)", 0.1 * math.atan2(0.002, 0.1)),
    ("= 1000*sqrt(M/(E*L*k))", 1000.0 * math.sqrt(0.04 / (200e9 * 0.1 * 0.5))),
]


def test_an_expression_has_the_value_of_its_arithmetic():
    for expression, thickness in VALUES:
        assert scene_from(with_thickness(expression)).beams["lower"].thickness == pytest.approx(thickness, rel=1e-14)


def test_literals_have_the_unit_of_the_key():
    """The same two cantilevers in millimetres, degrees and kilonewtons: 50 is 50 mm, sin takes degrees."""
    data = with_thickness("= 4*sin(30) + k*0")
    data["units"] = {"length": "mm", "angle": "deg"}
    for beam in data["beams"].values():
        beam["width"] = "= 5*t"
    data["beams"]["upper"] |= {"curve": {"kind": "line", "start": [0, 20], "end": [100, 20]}, "thickness": "= t"}
    data["bodies"]["ground"]["points"]["P"] = [0, "= 10*t"]
    data["bodies"]["block"]["points"]["Q"] = ["= L", 0]
    data["beams"]["lower"]["curve"] |= {"start": ["= L - 100", 0.0], "end": ["= 50 + 25*t", "= 0*t"]}
    lower = scene_from(data).beams["lower"]
    assert (lower.thickness, lower.width) == (pytest.approx(0.002, rel=1e-15), pytest.approx(0.01, rel=1e-15))
    assert lower.curve.end == (pytest.approx(0.1, rel=1e-15), 0.0)


WITHOUT_VALUE = [
    ("= t/L", "a ratio without unit; a number in m"),
    ("= t*t", "a number in m**2; a number in m"),
    ("= t + slope", "different units"),
    ("= E", "a number in Pa; a number in m"),
    ("= tt", "'tt', which names no parameter"),
    ("= t.real", "no arithmetic"),
    ("= open('x')", "no arithmetic"),
    ("= t if t else 1", "no arithmetic"),
    ("= [t]", "no arithmetic"),
    ("= True", "no arithmetic"),
    ("= t, t", "no arithmetic"),
    ("= t**0.5", "a root of a unit"),
    ("= 2**t", "an exponent with a unit"),
    ("= (-1)**0.5", "a power of a negative number"),
    ("= sqrt(-1)", "a power of a negative number"),
    ("= sqrt(1, 2)", "sqrt of 2 numbers"),
    ("= 1/0", "without a value"),
    ("= 9.0**9**9", "without a value"),
    ("= 1e308*10", "without a finite value"),
    ("= sin(1e308*10)", "without a value"),
    ("= (t", "no arithmetic"),
    ("=", "no arithmetic"),
    ("= " + "-" * 400 + "t", "an expression of 40"),
    ("= 0*t", "greater than 0"),
    ("= t - 3*t", "greater than 0"),
]


def test_an_expression_without_a_fitting_value_is_named_by_its_key():
    for expression, found in WITHOUT_VALUE:
        assert found in mistakes(base=with_thickness(expression))["beams.lower.thickness"]


@pytest.mark.parametrize(
    ("edits", "key", "found"),
    [
        ([("parameters/half/value", "= half")], "parameters.half.value", "a cycle: half -> half"),
        (
            [("parameters/half/value", "= third"), ("parameters/third", {"value": "= 2*half"})],
            "parameters.third.value",
            "a cycle: half -> third -> half",
        ),
        ([("parameters/half/value", "= ha")], "parameters.half.value", "'ha', which names no parameter"),
        ([("parameters/t/unit", "miles")], "parameters.t.unit", "'miles', which is no unit"),
        ([("parameters/t/value", 2.5)], "parameters.t.value", "2.5 mm; a number from 1.6 to 2.4 mm"),
        ([("parameters/t/range", [2.4, 1.6])], "parameters.t.range", "the least value, then the largest"),
        ([("parameters/t/value", "2mm")], "parameters.t.value", "a parameter has the key 'unit'"),
        ([("parameters/t/value", "two")], "parameters.t.value", "'two'; a number"),
        ([("parameters/t/tolerance/normal", 0.0)], "parameters.t.tolerance.normal", "greater than 0"),
        ([("parameters/t/size", 1.0)], "parameters.t.size", "names no key here"),
        ([("parameters/half/unit", "mm")], "parameters.half", "an expression"),
    ],
)
def test_a_mistake_in_a_parameter_is_the_only_one(edits, key, found):
    mistaken = mistakes(*edits, base=with_thickness("= t"))
    assert list(mistaken) == [key]
    assert found in mistaken[key]


@pytest.mark.parametrize(
    ("setting", "thickness"), [("1.9mm", 0.0019), (" 1900 um ", 0.0019), ("1.9", 0.0019), (0.0019, 0.0019)]
)
def test_a_setting_replaces_a_value(setting, thickness):
    scene = scene_from(with_thickness("= 2*half"), parameters={"t": setting})
    assert scene.beams["lower"].thickness == pytest.approx(thickness, rel=1e-15)
    assert scene.parameters["t"].value == pytest.approx(thickness, rel=1e-15)


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        ({"x": 1.0}, "parameters.x: found 'x', which names no parameter; allowed: .*'t'"),
        ({"t": "3mm"}, "parameters.t.value: found 3 mm; allowed: a number from 1.6 to 2.4 mm"),
        ({"t": "2deg"}, "parameters.t: found '2deg'; allowed: a finite number in mm"),
        ({"t": "thin"}, "parameters.t: found 'thin'; allowed: a finite number in mm, such as 1.9mm"),
        ({"t": math.nan}, "parameters.t: found nan; allowed: a finite number"),
        ({"half": "1mm"}, "parameters.half: found '= t/2', an expression; .*; an expression takes no other value"),
    ],
)
def test_a_wrong_setting_is_refused(settings, message):
    with pytest.raises(SceneError, match=message):
        scene_from(with_thickness("= t"), parameters=settings)
    with pytest.raises(SceneError, match="names no parameter; allowed: the name of a parameter: there is none"):
        scene_from(two_lines(0.01), parameters={"t": 1.0})


def test_a_scene_with_other_parameters_is_checked_like_a_file():
    scene = read(FILE)
    thin = scene.with_parameters(t=1.9e-3)
    assert thin.beams["beam1"].thickness == 0.0019
    assert thin.beams["beam1"].curve.center[1] == pytest.approx(0.025 + (0.0019 + 0.0005) / 2, rel=1e-15)
    assert pickle.loads(pickle.dumps(thin)).with_parameters(t=2e-3).beams == scene.beams
    with pytest.raises(SceneError, match=r"parameters\.t\.value"):
        scene.with_parameters(t=3e-3)
    with pytest.raises(SceneError, match="overlap at the start"):
        scene.with_parameters(gap=-1e-3)
    with pytest.raises(ValueError, match="without parameters"):
        scene_from(two_lines(0.01)).with_parameters(t=1e-3)
    with pytest.raises(ValueError, match="altered after reading"):
        scene.model_copy(update={"claims": ()}).with_parameters(t=1e-3)


@pytest.mark.parametrize("name", ["hinge", "gripper", "prestressed"])
def test_every_parameter_of_a_built_in_case_may_change_by_two_percent(name):
    scene = cases.opened(name)
    for parameter, record in scene.parameters.items():
        for factor in (0.98, 1.02):
            changed = scene.with_parameters(**{parameter: factor * record.value})
            assert changed.parameters[parameter].value == factor * record.value


TODAY = {
    "hinge": lambda scene: (scene.place_of("D"), (0.051, -0.02625)),
    "gripper": lambda scene: (
        (*scene.place_of("A"), *scene.place_of("O"), scene.contacts["circle"].radius),
        (0.08560254037844386, 0.05173205080756888, -0.001, 0.0017320508075688774, 0.019),
    ),
    "prestressed": lambda scene: (
        (*scene.place_of("O1"), *scene.beams["beam2"].curve.end),
        (-0.0005, 0.0, 0.0005, 0.06),
    ),
}
"""Numbers of the cases before parameters, at commit cffdfe7."""


@pytest.mark.parametrize("name", TODAY)
def test_the_built_in_cases_keep_their_numbers(name):
    ours, before = TODAY[name](cases.opened(name))
    assert ours == pytest.approx(before, rel=1e-15)
    opened = cases.opened(name, {"t": "1.05mm" if name == "prestressed" else "2.1mm"})
    assert opened.beams["beam1"].thickness == pytest.approx(1.05 * cases.opened(name).beams["beam1"].thickness)

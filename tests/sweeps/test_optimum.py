"""``cprbm optimise``: closed forms of a cantilever in the linear range, failing points, and the name of the result.

Under the tip force P the deflection is 4 P L³ / (E b t³), and the stress at the clamp 6 P L / (b t²).
"""

import json
from math import sqrt

import pytest

from comparisons.cli.main import run
from comparisons.pairing import Solvers, cprbm_answer, fea_answer
from tests.sweeps.scenes import CANTILEVER

STRESS = '\n[[probes]]\nof = "b"\nquantity = "bending_stress"\npoints = 5\n'
LIMIT = '\n[[limits]]\nprobe = "b.bending_stress"\nat = "every"\nmost = 0.12\n'


@pytest.fixture
def scene(tmp_path):
    path = tmp_path / "cantilever.toml"
    text = CANTILEVER.format(stations="['= P']").replace("P = { value = 1.0", "P = { value = 0.01") + STRESS
    path.write_text(text, "utf-8")
    return path


def optimised(scene, goal, *options, solvers=None):
    """Exit code and numbers of a search."""
    file, out = scene.with_name("goal.toml"), scene.with_name("out")
    file.write_text('[goal]\nprobe = "B.displacement"\ncomponent = "y"\n' + goal, "utf-8")
    sizes = ("-n", "8", "--elements", "8", "--starts", "2", "--quiet", "--out", str(out))
    code = run(["optimise", str(scene), "--goal", str(file), *sizes, *options], solvers)
    return code, json.loads((out / "optimum.json").read_text("utf-8"))


def test_the_optimum_stands_on_the_limit_and_at_the_end_of_a_range(scene, capsys):
    """On the limit t² = 6 P L / (b σ); the deflection then grows with the length, to the end of its range."""
    code, found = optimised(scene, 'aim = "maximise"\n' + LIMIT, "--vary", "t=1mm..3mm", "--vary", "L=80..120")
    assert found["parameters"]["L"] == pytest.approx(0.12, rel=1e-4)
    assert found["parameters"]["t"] == pytest.approx(1e-3 * sqrt(6.0 * 0.01 * 120.0 / (10.0 * 0.12)), rel=1e-3)
    assert found["goal"]["value"] == pytest.approx(4.0 * 0.01 * 120.0**3 / (2000.0 * 10.0 * 2.4495**3), rel=3e-3)
    assert found["optimum"] == (found["verdict"] == "AGREE")
    assert code == (0 if found["optimum"] else 3)
    out = capsys.readouterr().out
    assert "2 of 2 starts end there" in out
    assert "L lies at an end of its range" in out
    page = scene.with_name("out") / "index.html"
    assert "Best point, checked" in page.read_text("utf-8")


def test_a_value_is_reached(scene):
    _, found = optimised(scene, 'aim = "reach"\nvalue = 0.2\n')
    assert found["parameters"]["t"] == pytest.approx(
        1e-3 * (4.0 * 0.01 * 1e6 / (2000.0 * 10.0 * 0.2)) ** (1 / 3), rel=1e-3
    )


class Breaking:
    """The CPRBM, which breaks below the thickness of 2 mm."""

    def __call__(self, scene, choices):
        if scene.beams["b"].thickness < 2e-3:
            raise ZeroDivisionError("a beam of no length")
        return cprbm_answer(scene, choices)


class Stiff:
    """Finite elements of twice the modulus."""

    def __call__(self, scene, choices):
        materials = {
            name: each.model_copy(update={"youngs_modulus": 2.0 * each.youngs_modulus})
            for name, each in scene.materials.items()
        }
        return fea_answer(scene.model_copy(update={"materials": materials}), choices)


def test_points_without_an_answer_are_avoided(scene):
    _, found = optimised(scene, 'aim = "maximise"\n', solvers=Solvers(cprbm=Breaking()))
    assert 2.0e-3 <= found["parameters"]["t"] < 2.01e-3


def test_without_an_optimum_the_best_point_is_named_with_the_doubt(scene, capsys):
    code, found = optimised(scene, 'aim = "reach"\nvalue = 0.2\n', solvers=Solvers(fea=Stiff()))
    assert (code, found["optimum"], found["verdict"]) == (1, False, "DIFFER")
    assert "no optimum" in capsys.readouterr().out
    code, found = optimised(scene, 'aim = "maximise"\n' + LIMIT.replace("0.12", "0.001"))
    assert (code, found["doubt"]) == (1, "no start met all limits")


@pytest.mark.parametrize(
    ("goal", "options", "said"),
    [
        ('[goal]\nprobe = "C.displacement"\n', [], "'B.displacement'"),
        ('[goal]\nprobe = "B.displacement"\n', [], "allowed: 'x', 'y'"),
        ('[goal]\nprobe = "B.displacement"\ncomponent = "y"\naim = "reach"\n', [], "a value with aim = 'reach'"),
        ('[[limits]]\nprobe = "B.displacement"\ncomponent = "y"\n', [], "neither least nor most"),
        (
            '[[limits]]\nprobe = "B.displacement"\ncomponent = "y"\nleast = 2\nmost = 1\n',
            [],
            "limits[0].least: found 2; allowed: a number of at most 1",
        ),
        ("", [], "[goal] with a probe"),
        ('[goal]\nprobe = "B.displacement"\ncomponent = "y"\n', ["--vary", "t=1N..2N"], "a finite number, as 1.9mm"),
        ('[goal]\nprobe = "B.displacement"\ncomponent = "y"\n', ["--vary", "d=1..2"], "names no parameter"),
    ],
)
def test_a_wrong_question_is_a_sentence(scene, capsys, goal, options, said):
    file, out = scene.with_name("goal.toml"), scene.with_name("out")
    file.write_text(goal, "utf-8")
    assert run(["optimise", str(scene), "--goal", str(file), "--out", str(out), *options]) == 2
    error = capsys.readouterr().err
    assert said in error
    assert error.count("\n") == 1
    assert not out.exists()

"""``cprbm optimise`` and ``cprbm tolerance`` beside closed forms, and the wrong questions of all sweeps.

In the linear range the tip force P deflects a cantilever by 4 P L³ / (E b t³).  The stress at the clamp is
6 P L / (b t²).
"""

import json
import re
from dataclasses import replace
from math import sqrt

import numpy as np
import pytest
from scipy.stats import lognorm, norm

import comparisons
from comparisons.choices import Choices
from comparisons.cli.main import run
from comparisons.pairing import Solvers
from comparisons.sweeps.outcome import solve
from comparisons.sweeps.running import Runner
from comparisons.sweeps.scatter import drawn, indices, study, values_of
from comparisons.sweeps.workers import workers_on
from cprbm_scene import read
from tests.sweeps.circle import drop, radius_of
from tests.sweeps.elastica import tip
from tests.sweeps.planted import Breaking, stiff
from tests.sweeps.scenes import CANTILEVER, LINEAR, ROUND, SCATTERING, table

ALONE = CANTILEVER.format(stations="['= P']")
LIMIT = '\n[[limits]]\nprobe = "b.bending_stress"\nat = "every"\nmost = 0.12\n'
DEFLECTION = 'probe = "B.displacement"\ncomponent = "y"\n'


@pytest.fixture
def written(tmp_path):
    """Function that writes a text into a file, and returns the path."""

    def write(name, text):
        (tmp_path / name).write_text(text, "utf-8")
        return tmp_path / name

    return write


# -- Optimum


@pytest.fixture
def optimised(written, tmp_path):
    """Function of the exit code and the numbers of a search on the cantilever in the linear range."""
    scene, out = written("cantilever.toml", LINEAR), tmp_path / "out"

    def search(goal, *options, solvers=None):
        goal = written("goal.toml", f"[goal]\n{DEFLECTION}{goal}")
        sizes = ("-n", "8", "--elements", "8", "--starts", "2", "--quiet", "--out", str(out))
        code = run(["optimise", str(scene), "--goal", str(goal), *sizes, *options], solvers)
        return code, json.loads((out / "optimum.json").read_text("utf-8"))

    return search


def test_the_optimum_stands_on_the_limit_and_at_the_end_of_a_range(optimised, tmp_path, capsys):
    """On the limit t² = 6 P L / (b σ); the deflection then grows with the length, to the end of its range."""
    code, found = optimised('aim = "maximise"\n' + LIMIT, "--vary", "t=1mm..3mm", "--vary", "L=80..120")
    assert found["parameters"]["L"] == pytest.approx(0.12, rel=1e-4)
    assert found["parameters"]["t"] == pytest.approx(1e-3 * sqrt(6.0 * 0.01 * 120.0 / (10.0 * 0.12)), rel=1e-3)
    assert found["goal"]["value"] == pytest.approx(4.0 * 0.01 * 120.0**3 / (2000.0 * 10.0 * 2.4495**3), rel=3e-3)
    assert found["optimum"] == (found["verdict"] == "AGREE")
    assert code == (0 if found["optimum"] else 3)
    out = capsys.readouterr().out
    assert "2 of 2 starts end there" in out
    assert "L lies at an end of its range" in out
    assert "Best point, checked" in (tmp_path / "out" / "index.html").read_text("utf-8")


def test_without_an_optimum_the_best_point_is_named_with_the_doubt(optimised, capsys):
    code, found = optimised('aim = "reach"\nvalue = 0.2\n', solvers=Solvers(fea=stiff))
    thickness = 1e-3 * (4.0 * 0.01 * 1e6 / (2000.0 * 10.0 * 0.2)) ** (1 / 3)
    assert found["parameters"]["t"] == pytest.approx(thickness, rel=1e-3)
    assert (code, found["optimum"], found["verdict"]) == (1, False, "DIFFER")
    assert "no optimum" in capsys.readouterr().out
    code, found = optimised('aim = "maximise"\n' + LIMIT.replace("0.12", "0.001"))
    assert (code, found["doubt"]) == (1, "no start met all limits")


def test_points_without_an_answer_are_avoided(optimised):
    _, found = optimised('aim = "maximise"\n', solvers=Solvers(cprbm=Breaking(most=2e-3)))
    assert 2.0e-3 <= found["parameters"]["t"] < 2.01e-3


def test_the_radius_of_a_circle_for_a_fall_of_half_the_length(written, tmp_path):
    """The closed form: at ρ = 0.45 the wrap just begins (Bisshopp and Drucker); a wide circle is a parabola."""
    assert drop(0.45, 3.0) == pytest.approx(tip(3.0)[1], abs=3e-5)
    assert drop(100.0, 3.0) == pytest.approx(1.0 / 200.0, abs=1e-6)
    goal = '[goal]\nprobe = "T.displacement"\ncomponent = "y"\naim = "reach"\nvalue = -0.5\n'
    options = ["-n", "60", "--elements", "20", "--starts", "1", "--quiet", "--out", str(tmp_path / "out")]
    scene, goal = written("round.toml", ROUND), written("goal.toml", goal)
    run(["optimise", str(scene), "--goal", str(goal), *options])
    found = json.loads((tmp_path / "out" / "optimum.json").read_text("utf-8"))
    assert found["goal"]["value"] == pytest.approx(-0.5, abs=1e-4)
    assert found["parameters"]["rho"] == pytest.approx(radius_of(0.5, 3.0), abs=1e-4)


def test_a_cantilever_follows_the_elastica_with_order_four(written):
    """α = P L² / (E I) from 0.2 to 10, with the closed form of Bisshopp and Drucker; E I / L² is 4/3 N.

    The chain has order four on a beam without contact (docs/method.md).
    """
    scene = read(written("cantilever.toml", ALONE))
    alphas, errors = (0.2, 1.0, 4.0, 10.0), {}
    for links in (20, 40, 80, 160):
        swept = comparisons.sweep(scene, {"P": [4.0 / 3.0 * alpha for alpha in alphas]}, choices=Choices(links))
        values = [[number["value"] / 0.1 for number in outcome.numbers] for _, outcome in swept.points()]
        errors[links] = [np.hypot(*np.subtract(value, tip(alpha))) for value, alpha in zip(values, alphas, strict=True)]
    assert max(errors[40]) < 5e-4
    orders = [np.log2(np.divide(errors[n], errors[2 * n])) for n in (20, 40, 80)]
    np.testing.assert_allclose(orders, 4.0, atol=0.1)


# -- Scatter

CENTRES = {"E": 2e9, "b": 0.01, "t": 2e-3, "L": 0.1}


@pytest.fixture
def scene(written):
    return written("scattering.toml", SCATTERING)


def stiffness_of(sample):
    """ln k of a tip load in the linear range, k = E b t³ / (4 L³), at values (k, 4) of E, b, t and L."""
    E, b, t, L = sample.T
    return np.log(E * b * t**3 / (4.0 * L**3))


DISTRIBUTIONS = {name: lognorm(0.01, scale=centre) for name, centre in CENTRES.items()}


def test_indices_and_rows_of_a_stiffness_are_the_closed_form(scene):
    """ln k has the exponents 1, 1, 3, -3 of four lognormals.

    With equal deviations the indices are the squares of the exponents over their sum: 1/20, 1/20, 9/20, 9/20.
    """
    design = drawn(DISTRIBUTIONS, 256, indices=True)
    for part in indices(stiffness_of(design).reshape(6, 256)):
        for interval, exact in zip(part, (1 / 20, 1 / 20, 9 / 20, 9 / 20), strict=True):
            assert interval.low <= exact <= interval.high
            assert interval.high - interval.low < 0.3
    question, choices = read(scene).with_parameters(P=1e-3), Choices(links=4)
    asked = study(question, DISTRIBUTIONS, 16, "cprbm", choices, indexed=True)
    with workers_on("local:1") as workers:
        solved = replace(asked, sweep=Runner(workers, choices, Solvers(), 60.0).run(asked.sweep))
    (deflection,) = [each for each in solved.scattering() if each.component == "y"]
    stiffness = np.log(1.0 / solved.rows(deflection))  # 1 mN over millimetres, in N/m
    exact = stiffness_of(drawn(DISTRIBUTIONS, 16, indices=True))
    np.testing.assert_allclose(stiffness, exact.reshape(6, 16), atol=1e-3)
    assert solved.indices(deflection) == indices(solved.rows(deflection))
    mean = values_of(deflection, solved.standing).mean()
    assert mean == pytest.approx(1e-3 * 4.0 * 100.0**3 / (2000.0 * 10.0 * 2.0**3), rel=1e-2)


def test_quantiles_shares_and_yield(scene, written, tmp_path, capsys):
    """The deflection is a falling function of the thickness: its quantiles are the thickness' quantiles."""
    limits = written("limits.toml", f"[[limits]]\n{DEFLECTION}most = 23.4\n")
    out = tmp_path / "out"
    options = ["-n", "6", "--samples", "64", "--limits", str(limits), "--out", str(out), "--quiet"]
    assert run(["tolerance", str(scene), *options]) == 0
    data = json.loads((out / "tolerance.json").read_text("utf-8"))
    assert data["points"] == 64
    assert data["shares"]["without a complete answer"][0] == 0.0
    (deflection,) = [each for each in data["numbers"] if each["component"] == "y"]
    assert deflection["unit"] == "mm"
    rows = table(out, "last.csv")[1:]
    pairs = sorted((float(row["t, mm"]), float(row["load B.displacement.y, mm"])) for row in rows)
    assert [value for _, value in pairs] == sorted((value for _, value in pairs), reverse=True)
    thickness = norm(2.0, 0.02).ppf(0.5)
    assert deflection["quantiles"][1][0] == pytest.approx(np.interp(thickness, *zip(*pairs, strict=True)), rel=1e-3)
    met = sum(value <= 23.4 for _, value in pairs)
    assert 0 < met < 64
    assert data["shares"]["yield"][0] == met / 64
    low, high = data["shares"]["yield"][1:]
    assert low < met / 64 < high
    assert "Quantiles" in (out / "index.html").read_text("utf-8")
    assert "yield" in capsys.readouterr().out


@pytest.mark.usefixtures("printed")
def test_histograms_have_the_units_of_the_table(written, tmp_path, capsys):
    scene = written("si.toml", SCATTERING.replace('units = { length = "mm", stress = "MPa" }', ""))
    assert run(["tolerance", str(scene), "-n", "6", "--samples", "16", "--out", str(tmp_path)]) == 0
    assert re.search(r"B\.displacement\.y +mm +23\.", capsys.readouterr().out)
    assert "<!-- load B.displacement.y, mm -->" in (tmp_path / "scatter.svg").read_text("utf-8")


def test_failing_points_are_counted(scene):
    choices = Choices(links=4)
    asked = study(read(scene), {"t": norm(2e-3, 2e-5)}, 64, "cprbm", choices, indexed=False)
    solvers = Solvers(cprbm=Breaking(least=2.02e-3))
    outcomes = {task.key: solve(task.scene, choices, "cprbm", solvers) for task in asked.sweep.tasks}
    scatter = replace(asked, sweep=replace(asked.sweep, outcomes=outcomes))
    expected = sum(task.point["t"] > 2.02e-3 for task in asked.sweep.tasks)
    assert 0 < expected < 32
    assert len(scatter.sample) - len(scatter.standing) == expected


# -- Wrong questions

ASK = f"[goal]\n{DEFLECTION}"
VARY = "--vary t=1mm..2mm:3"
TABLES = {
    "t,L\n1.7mm,95\n# thin\n1.9mm\n": "row 4: found 1 values of t, L; allowed: a value for every name",
    "t,t\n1.7,1.8\n": "row 2: found 2 values of t, t; allowed: a value for every name, each name once",
    "t\n1,7\n": "row 2: found 2 values of t;",
    "t\n1.7\nthin\n": "row 3: found 'thin'; allowed: a finite number, as 1.9mm",
    "thick\n1.7\n": "row 2: found 'thick', which names no parameter; allowed: the name of a parameter: 't', 'L'",
    "t\n": "found 0 rows below the names t",
    "": "found 0 rows below the names (none)",
}
WRONG = [
    ("sweep alone", "", "--vary thickness=1mm..2mm:3", "names no parameter"),
    ("sweep alone", "", "--vary t=1N..2N:3", "a finite number, as 1.9mm"),
    ("sweep alone", "", "--vary t=1mm..5mm:3", "a number from 1 to 3 mm"),
    ("sweep alone", "", "--vary t=1mm..2mm:1", "two values or more"),
    ("sweep alone", "", "--vary t=1mm..2mm", "without a number of values"),
    ("sweep alone", "", f"{VARY} --vary t=1mm..2mm:4", "a parameter once"),
    ("sweep alone", "", "--vary L=-100..100:3", "1 of 3 points without a valid scene"),
    ("sweep alone", "", "--sample halton:9", "sobol:K or lhs:K"),
    ("sweep alone", "", "--sample absent.csv", "No such file"),
    ("sweep alone", "", f"{VARY} --shard 4/3", "I/N with I from 1 to N"),
    ("sweep alone", "", f"{VARY} --on remote", "local:N"),
    ("sweep alone", "", "", "neither --vary nor --sample"),
    *(("sweep alone", text, "--sample CSV", f"points.csv: {said}") for text, said in TABLES.items()),
    ("optimise linear", '[goal]\nprobe = "C.displacement"\n', "--goal TOML", "'B.displacement'"),
    ("optimise linear", '[goal]\nprobe = "B.displacement"\n', "--goal TOML", "allowed: 'x', 'y'"),
    ("optimise linear", f'{ASK}aim = "reach"\n', "--goal TOML", "a value with aim = 'reach'"),
    ("optimise linear", f"[[limits]]\n{DEFLECTION}", "--goal TOML", "neither least nor most"),
    (
        "optimise linear",
        f"[[limits]]\n{DEFLECTION}least = 2\nmost = 1\n",
        "--goal TOML",
        "limits[0].least: found 2; allowed: a number of at most 1",
    ),
    ("optimise linear", "", "--goal TOML", "[goal] with a probe"),
    ("optimise linear", ASK, "--goal TOML --vary t=1N..2N", "a finite number, as 1.9mm"),
    ("optimise linear", ASK, "--goal TOML --vary d=1..2", "names no parameter"),
    ("tolerance scattering", "", "--sobol", "two or more"),
    ("tolerance scattering", "", "--samples 1000", "a power of 2"),
    ("tolerance scattering", '[[limits]]\nprobe = "C.displacement"\nmost = 1.0\n', "--limits TOML", "limits[0].probe"),
    ("tolerance scattering", "", "--limits absent.toml", "File 'absent.toml' does not exist"),
    ("tolerance scattering", ASK, "--limits TOML", "limits: found nothing; allowed: [[limits]] with a probe"),
    ("tolerance scattering", "", "--on remote --samples 16", "local:N"),
    ("tolerance scattering", "", "--samples 16 --set t=2.99mm", "without a valid scene"),
    ("tolerance alone", "", "", "tolerance = { normal"),
]


@pytest.mark.parametrize(("asked", "text", "options", "said"), WRONG)
def test_a_wrong_question_is_a_sentence(written, tmp_path, capsys, asked, text, options, said):
    """CSV and TOML are files with the text."""
    command, name = asked.split()
    scene = written("scene.toml", {"alone": ALONE, "linear": LINEAR, "scattering": SCATTERING}[name])
    files, out = {"CSV": "points.csv", "TOML": "asked.toml"}, tmp_path / "out"
    arguments = [str(written(files[each], text)) if each in files else each for each in options.split()]
    assert run([command, str(scene), "--out", str(out), *arguments]) == 2
    error = capsys.readouterr().err
    assert said in error
    assert error.count("\n") == 1
    assert not out.exists()

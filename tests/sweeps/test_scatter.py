"""``cprbm tolerance``: quantiles, shares, yield, and Sobol indices of a stiffness with a closed form."""

import json
from dataclasses import replace

import numpy as np
import pytest
from scipy.stats import lognorm, norm

from comparisons.choices import Choices
from comparisons.cli.main import run
from comparisons.pairing import Solvers
from comparisons.sweeps.outcome import solve
from comparisons.sweeps.running import Runner
from comparisons.sweeps.scatter import drawn, indices, study, values_of
from comparisons.sweeps.workers import workers_on
from cprbm_scene import read
from tests.sweeps.scenes import CANTILEVER, table

SCATTERING = (
    CANTILEVER.format(stations="['= P']")
    .replace("range = [1.0, 3.0]", "range = [1.0, 3.0], tolerance = { normal = 0.02 }")
    .replace("[materials.plastic]\nyoungs_modulus = 2000.0", '[materials.plastic]\nyoungs_modulus = "= E"')
    .replace("width = 10.0", 'width = "= b"')
    .replace("[parameters]", '[parameters]\nE = { value = 2000.0, unit = "MPa" }\nb = { value = 10.0, unit = "mm" }')
)


@pytest.fixture
def scene(tmp_path):
    path = tmp_path / "cantilever.toml"
    path.write_text(SCATTERING, "utf-8")
    return path


CENTRES = {"E": 2e9, "b": 0.01, "t": 2e-3, "L": 0.1}


def stiffness_of(sample):
    """ln k of a tip load in the linear range, k = E b t³ / (4 L³), at values (k, 4) of E, b, t and L."""
    E, b, t, L = sample.T
    return np.log(E * b * t**3 / (4.0 * L**3))


DISTRIBUTIONS = {name: lognorm(0.01, scale=centre) for name, centre in CENTRES.items()}


def test_indices_of_a_stiffness_are_the_squares_of_the_exponents():
    """ln k has the exponents 1, 1, 3, -3 of four lognormals.

    With equal deviations the indices are the squares of the exponents over their sum: 1/20, 1/20, 9/20, 9/20.
    """
    design = drawn(DISTRIBUTIONS, 256, indices=True)
    for part in indices(stiffness_of(design).reshape(6, 256)):
        for interval, exact in zip(part, (1 / 20, 1 / 20, 9 / 20, 9 / 20), strict=True):
            assert interval.low <= exact <= interval.high
            assert interval.high - interval.low < 0.3


def test_rows_of_a_scatter_are_the_closed_form_at_the_points_of_the_design(scene):
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


def test_quantiles_shares_and_yield(scene, tmp_path, capsys):
    """The deflection is a falling function of the thickness: its quantiles are the thickness' quantiles."""
    limits = tmp_path / "limits.toml"
    limits.write_text('[[limits]]\nprobe = "B.displacement"\ncomponent = "y"\nmost = 23.4\n', "utf-8")
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


def test_failing_points_are_counted(scene, tmp_path):
    class Failing:
        def __call__(self, scene, choices):
            if scene.beams["b"].thickness > 2.02e-3:
                raise ZeroDivisionError("a beam of no length")
            return Solvers().cprbm(scene, choices)

    question = read(scene)
    choices = Choices(links=4)
    asked = study(question, {"t": norm(2e-3, 2e-5)}, 64, "cprbm", choices, indexed=False)
    outcomes = {}
    for task in asked.sweep.tasks:
        outcomes[task.key] = solve(task.scene, choices, "cprbm", Solvers(cprbm=Failing()))
    scatter = replace(asked, sweep=replace(asked.sweep, outcomes=outcomes))
    expected = sum(task.point["t"] > 2.02e-3 for task in asked.sweep.tasks)
    assert 0 < expected < 32
    assert len(scatter.sample) - len(scatter.standing) == expected


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (["--sobol"], "two or more"),
        (["--samples", "1000"], "a power of 2"),
        (["--limits", "LIMITS"], "limits[0].probe"),
        (["--limits", "absent.toml"], "File 'absent.toml' does not exist"),
        (["--limits", "GOAL"], "limits: found nothing; allowed: [[limits]] with a probe"),
        (["--on", "remote", "--samples", "16"], "local:N"),
        (["--samples", "16", "--set", "t=2.99mm"], "without a valid scene"),
    ],
)
def test_a_wrong_question_is_a_sentence(scene, tmp_path, capsys, options, said):
    limits = tmp_path / "limits.toml"
    limits.write_text('[[limits]]\nprobe = "C.displacement"\nmost = 1.0\n', "utf-8")
    goal = tmp_path / "goal.toml"
    goal.write_text('[goal]\nprobe = "B.displacement"\ncomponent = "y"\n', "utf-8")
    options = [{"LIMITS": str(limits), "GOAL": str(goal)}.get(each, each) for each in options]
    out = tmp_path / "out"
    assert run(["tolerance", str(scene), "--out", str(out), *options]) == 2
    error = capsys.readouterr().err
    assert said in error
    assert error.count("\n") == 1
    assert not out.exists()


def test_a_scene_without_tolerances_is_refused(tmp_path, capsys):
    path = tmp_path / "cantilever.toml"
    path.write_text(CANTILEVER.format(stations="['= P']"), "utf-8")
    assert run(["tolerance", str(path)]) == 2
    assert "tolerance = { normal" in capsys.readouterr().err

"""Refusals of a solver on the command line: the key in the message, exit code 2."""

from pathlib import Path

from comparisons import cases
from comparisons.cli.main import run

TAPERED = Path(cases.__file__).parent / "tapered.toml"


def test_the_cprbm_refuses_a_theory_that_the_finite_elements_ignore(tmp_path, capsys):
    path = tmp_path / "shear.toml"
    path.write_text('theory = "shear"\n' + TAPERED.read_text(encoding="utf-8"), encoding="utf-8")
    assert run(["solve", str(path), "--solver", "cprbm"]) == 2
    assert f"{path}: theory: found 'shear'; allowed: 'bending'" in capsys.readouterr().err
    assert run(["solve", str(path), "--solver", "fea", "--elements", "8"]) == 0

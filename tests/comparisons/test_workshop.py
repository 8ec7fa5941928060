"""The door to the developers' tools: what a checkout offers, and what an installed package says of the rest."""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from comparisons.cli import commands
from comparisons.cli.main import run

ROOT = Path(__file__).parents[2]
PACKAGES = ("cprbm_scene", "cprbm", "fea_reference", "elastica_reference", "comparisons")
ELSEWHERE = "is a developers' tool: it runs in a checkout of the repository, not from an installed package."


@pytest.fixture(scope="module")
def installed(tmp_path_factory):
    """The packages as a wheel holds them, without ``tests`` and ``benchmarks``, with the stored kernels."""
    folder = tmp_path_factory.mktemp("installed")
    for package in PACKAGES:
        shutil.copytree(ROOT / package, folder / package)
    return folder


def _run(arguments, packages, folder):
    return subprocess.run(
        [sys.executable, "-m", "comparisons", *arguments],
        cwd=folder,
        env={**os.environ, "PYTHONPATH": str(packages), "NUMBA_DISABLE_JIT": "1"},
        capture_output=True,
        text=True,
        check=False,
    )


@pytest.mark.parametrize(
    ("arguments", "command"),
    [
        (["robustness", "--scenes", "3"], "robustness"),
        (["robustness", "--help"], "robustness"),
        (["study", "relations", "tapered"], "study relations"),
        (["bench", "hinge", "--method", "ipopt"], "bench --method ipopt"),
        (["bench", "hinge", "--method", "auto", "--method", "slsqp"], "bench --method slsqp"),
    ],
)
def test_an_installed_package_says_where_the_tool_is(installed, tmp_path, arguments, command):
    done = _run(arguments, installed, tmp_path)
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr == f"cprbm: 'cprbm {command}' {ELSEWHERE}\n"


def test_an_installed_package_times_its_own_solvers(installed, tmp_path):
    done = _run(["bench", "tapered", "--sizes", "10", "--repeat", "1", "--json", "-"], installed, tmp_path)
    # the first solve of an installation names the compilation
    others = [line for line in done.stderr.splitlines() if not line.startswith("cprbm compiles its kernels")]
    assert (done.returncode, others) == (0, [])
    data = json.loads(done.stdout)
    assert [(row["method"], row["formulation"]) for row in data["rows"]] == [
        ("cprbm", "auto"),
        ("cprbm", "paper"),
        ("fea", None),
    ]
    assert data["tolerance"] is None


def test_an_installed_package_lists_no_tools_and_no_study_of_a_checkout(installed, tmp_path):
    done = _run(["--help"], installed, tmp_path)
    assert (done.returncode, done.stderr) == (0, "")
    assert "compare" in done.stdout
    assert "robustness" not in done.stdout
    done = _run(["study"], installed, tmp_path)
    assert (done.returncode, done.stderr) == (0, "")
    assert "calibration" in done.stdout
    assert "relations" not in done.stdout


def test_a_checkout_lists_its_tools(capsys):
    assert run(["--help"]) == 0
    listed = [line.split()[0] for line in capsys.readouterr().out.splitlines() if line.startswith("  ")]
    assert "robustness" in listed


@pytest.mark.parametrize("name", [name for name, tool in commands.TOOLS.items() if tool[1]])
def test_the_list_of_commands_says_of_a_tool_what_its_own_help_does(name):
    assert commands.load_tool(name).command.help.splitlines()[0] == commands.TOOLS[name][1]

"""The command line: output, messages and exit codes, completion in a shell, and the developers' tools of a checkout."""

import json
import os
import re
import shutil
import subprocess
import sys
from dataclasses import replace
from importlib.metadata import PackageNotFoundError
from pathlib import Path

import pytest

from comparisons import cases
from comparisons.cli import commands, main
from comparisons.cli.main import run
from comparisons.pairing import Solvers
from comparisons.present import page
from cprbm_scene import Ending
from tests.comparisons.programs import ROOT, in_turn, told
from tests.verdict.jumping import FORWARD, Jumping
from tests.verdict.made_up import THEORY, MadeUp

HINGE = Path(cases.__file__).parent / "hinge.toml"


def ended(solver, ending=Ending.STEP_TOO_SMALL):
    def answer(scene, choices):
        found = solver(scene, choices)
        return replace(found, stations=found.stations[:4], ending=ending, sentence="The step fell below 1e-9.")

    return answer


def out_and_err(capsys):
    captured = capsys.readouterr()
    return captured.out, captured.err


def test_compare_ends_with_0_1_or_3_and_writes_json_and_tables(right, capsys, tmp_path):
    """0 if all agree, 1 if a case differs or a solver does not complete, 3 for nothing worse than undecided."""
    assert run(["compare", "hinge"], right) == 0
    out, err = out_and_err(capsys)
    assert "hinge: AGREE" in out
    assert err == ""
    file = tmp_path / "new" / "numbers.json"
    assert run(["compare", "hinge", "--json", str(file), "-v"], right) == 0
    assert "Certificates" in capsys.readouterr().out
    assert json.loads(file.read_text("utf-8"))["cases"][0]["verdict"] == "AGREE"
    assert run(["compare", "hinge"], Solvers(MadeUp("cprbm", 2e-3, stiffness=1.02), right.fea)) == 1
    assert "hinge: DIFFER" in capsys.readouterr().out
    assert run(["compare", "hinge", "--quiet"], Solvers(ended(right.cprbm), right.fea)) == 1
    assert "UNDECIDED" in capsys.readouterr().out
    assert run(["compare", "hinge", "--quiet"], Solvers(MadeUp("cprbm", 2e-2), right.fea)) == 3
    assert capsys.readouterr().out.startswith("hinge: UNDECIDED")


@pytest.mark.parametrize("command", ["compare", "solve"])
def test_json_on_standard_output_is_alone_there_and_an_implausible_load_is_noted(right, tmp_path, capsys, command):
    assert run([command, "hinge", "--json", "-"], right) == 0
    data = json.loads(capsys.readouterr().out)
    assert [case["case"] for case in data["cases"]] == ["hinge"]
    assert ("verdict" in data["cases"][0]) is (command == "compare")
    soft = tmp_path / "soft.toml"
    soft.write_text(HINGE.read_text(encoding="utf-8").replace("2.3e9", "2.1e3"), encoding="utf-8")
    run([command, str(soft), "--quiet"], right)
    assert capsys.readouterr().err.startswith(f"Note: {soft}: loads.M: M L/(E I) is ")


@pytest.mark.parametrize(
    ("command", "option", "there"),
    [("compare", [], True), ("compare", ["--no-exact"], False), ("converge", ["--exact"], True)],
)
def test_the_exact_reference_is_asked_by_a_rule_or_by_an_option(command, option, there, capsys):
    sizes = ["-n", "8", "--elements", "8"] if command == "compare" else ["--sizes", "4,8,16"]
    run([command, "tapered", *sizes, *option, "--json", "-"])
    found = json.loads(capsys.readouterr().out)
    rows = found["cases"][0]["rows"] if command == "compare" else found["families"]
    assert any(row["exact"] is not None for row in rows) is there


def test_solve_ends_with_0_or_1_also_without_a_station_or_with_too_little_memory(right, capsys):
    assert run(["solve", "hinge"], right) == 0
    assert "B.displacement" in capsys.readouterr().out
    assert run(["solve", "hinge", "--solver", "fea", "--quiet"], Solvers(right.cprbm, ended(right.fea))) == 1
    captured = capsys.readouterr()
    assert captured.out == ""
    assert "The step fell below 1e-9." in captured.err

    def nothing(scene, choices):
        return replace(ended(right.cprbm)(scene, choices), stations=())

    assert run(["solve", "hinge", "--json", "-"], Solvers(nothing, right.fea)) == 1
    case = json.loads(capsys.readouterr().out)["cases"][0]
    assert case["rows"] == []
    assert case["solvers"]["cprbm"]["ending"] == "STEP_TOO_SMALL"

    def large(scene, choices):
        raise MemoryError

    said = "cprbm: The memory is too small for this model. Finished results stand; ask for fewer links.\n"
    for command in ("solve", "compare"):
        assert run([command, "hinge"], Solvers(large, large)) == 1
        assert capsys.readouterr().err == said


def test_compare_all_writes_the_report_where_it_stands_and_an_interruption_leaves_finished_cases(
    right, capsys, tmp_path, monkeypatch
):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(page, "figures_of", lambda compared: ())
    monkeypatch.setattr(cases, "names", lambda: ("hinge", "tapered"))
    assert run(["compare", "all", "--quiet"], right) == 0
    text = (tmp_path / "report" / "index.html").read_text("utf-8")
    assert all(f'id="{name}"' in text for name in cases.names())
    file = tmp_path / "second.toml"
    file.write_text(HINGE.read_text("utf-8").replace('name = "hinge"', 'name = "second"'), "utf-8")

    def interrupted(scene, choices):
        if scene.name == "second":
            raise KeyboardInterrupt
        return right.fea(scene, choices)

    arguments = ["--out", str(tmp_path / "r"), "--json", str(tmp_path / "all.json"), "--quiet"]
    assert run(["compare", "hinge", str(file), *arguments], Solvers(right.cprbm, interrupted)) == 130
    assert "Interrupted" in capsys.readouterr().err
    assert 'id="hinge"' in (tmp_path / "r" / "index.html").read_text("utf-8")
    assert (tmp_path / "r" / "hinge" / "comparison.json").is_file()
    assert len(json.loads((tmp_path / "all.json").read_text("utf-8"))["cases"]) == 1


def test_solve_prints_the_notes_of_an_answer(tmp_path, capsys):
    text = (ROOT / "docs" / "gallery" / "latch.toml").read_text("utf-8")
    (tmp_path / "latch.toml").write_text(re.sub("stations = .*", "stations = [3.0]", text), "utf-8")
    assert run(["solve", str(tmp_path / "latch.toml"), "-n", "8"]) == 0
    assert "Note: contact 'pin' never closed at a station." in capsys.readouterr().out


@pytest.mark.parametrize(
    ("options", "theory"),
    [
        ((), "bending"),
        (("--theory", "stretch"), "stretch"),
        (("--theory", "bending", "--kinematics", "shear"), "shear"),
    ],
)
def test_options_reach_both_solvers_and_the_theory_the_table(right, capsys, options, theory):
    asked = []

    def noting(name, theory_of):
        def answer(scene, choices):
            asked.append((name, theory_of(choices)(scene), choices))
            return getattr(right, name)(scene, choices)

        return answer

    solvers = Solvers(noting("cprbm", lambda its: its.theory_of), noting("fea", lambda its: its.kinematics_of))
    assert run(["compare", "hinge", "-v", *options], solvers) == 0
    assert f"both in the theory {theory}" in capsys.readouterr().out
    other = "shear" if theory == "bending" else "bending"
    assert {found for name, found, _ in asked if name == "fea"} == {theory}
    assert {found for name, found, _ in asked if name == "cprbm"} == {theory, other}
    asked.clear()
    arguments = ["--links", "beam1=30,beam2=40", "--formulation", "paper", "--elements", "60", "--penetration", "1e-6"]
    assert run(["solve", "hinge", "--quiet", *arguments, *options], solvers) == 0
    ((_, _, choices),) = asked
    assert choices.links == {"beam1": 30, "beam2": 40}
    assert (choices.formulation, choices.elements, choices.penetration) == ("paper", 60, 1e-6)


@pytest.mark.parametrize(
    ("solver", "options", "theory"),
    [
        ("cprbm", (), "bending"),
        ("cprbm", ("--theory", "shear"), "shear"),
        ("cprbm", ("--kinematics", "shear"), "bending"),
        ("fea", ("--theory", "stretch"), "stretch"),
        ("fea", ("--theory", "stretch", "--kinematics", "shear"), "shear"),
    ],
)
def test_a_solver_answers_in_the_theory_of_its_options(hinge, right, solver, options, theory, capsys):
    """The made-up rotation before contact is 0.9 of the load, with the error of the size and the theory's share."""
    assert run(["solve", "hinge", "--solver", solver, "--json", "-", *options], right) == 0
    (row, *_) = (
        one for one in json.loads(capsys.readouterr().out)["cases"][0]["rows"] if one["probe"] == "BD.rotation"
    )
    error = {"cprbm": 2e-3, "fea": -5e-4 / 4.0}[solver]
    assert row[solver] == pytest.approx(0.9 * row["station"] * (1.0 + error + THEORY[theory]), rel=1e-9)


@pytest.mark.parametrize("installed", [True, False])
def test_the_version_is_a_line_whether_or_not_the_package_is_installed(capsys, monkeypatch, installed):
    def version(name):
        if installed:
            return "3.2.1"
        raise PackageNotFoundError(name)

    monkeypatch.setattr("comparisons.provenance.version", version)
    assert run(["--version"]) == 0
    said = "cprbm 3.2.1\n" if installed else "cprbm, run from its sources: no version is installed\n"
    assert out_and_err(capsys) == (said, "")


# -- Critical values of the prestressed crank

PRESTRESSED = (Path(cases.__file__).parent / "prestressed.toml").read_text("utf-8")
FEW = re.sub(r"shown = .*\n", "", PRESTRESSED)
FEW = re.sub(r"stations = \[\n    0\.0,.*?\]", "stations = [0.0, 0.5, 1.0, 1.5]", FEW, flags=re.DOTALL)
FEW = re.sub(r"stations = \[\n    1\.55.*?\]", "stations = [1.0, 0.5, 0.0]", FEW, flags=re.DOTALL)


def asked_of(tmp_path, source):
    file = tmp_path / "prestressed.toml"
    file.write_text(source, "utf-8")
    return str(file)


@pytest.mark.parametrize("command", ["solve", "compare"])
def test_an_assembly_that_a_stop_forbids_is_found_while_solving_and_ends_with_2(tmp_path, capsys, command):
    """Both solvers refuse it, in processes of their own where there are some; the angle is known once assembled."""
    source = FEW.replace("most = 0.785398163397448", "most = -0.7", 1)
    assert run([command, asked_of(tmp_path, source), "--quiet", "-n", "10", "--elements", "20"]) == 2
    assert "forbids the assembly" in capsys.readouterr().err


def test_critical_values_are_printed_are_in_the_json_and_go_with_n(tmp_path, capsys):
    solvers = Solvers(Jumping("cprbm"), Jumping("fea"))
    assert run(["compare", "prestressed", "-v"], solvers) == 0
    said = capsys.readouterr().out
    assert said.count("Critical values: where a branch ends") == 1
    assert "1.2288 rad (70.41°)" in said
    assert "Branch by branch" in said
    assert len(said.splitlines()) < 300  # of 181 stations the named stations and the last
    few = asked_of(tmp_path, FEW)
    assert run(["solve", few, "--json", "-"], solvers) == 0
    case = json.loads(capsys.readouterr().out)["cases"][0]
    assert [each["stage"] for each in case["solvers"]["cprbm"]["critical"]] == ["forward", "back"]
    assert run(["solve", few], solvers) == 0
    assert "Critical values" in capsys.readouterr().out
    # 1e-4 rad at 40 links, falling with the square of N: the limit is where the made-up branch ends
    assert run(["converge", few, "--sizes", "40,80,160", "--json", "-"], solvers) == 0
    families = json.loads(capsys.readouterr().out)["families"]
    forward, *_ = (each for each in families if (each["probe"], each["solver"]) == ("critical", "cprbm"))
    assert forward["values"] == pytest.approx([FORWARD + 1e-4 / 4**k for k in range(3)])
    assert forward["order"] == pytest.approx(2.0, abs=1e-3)
    assert forward["limit"] == pytest.approx(FORWARD, abs=1e-9)
    assert forward["errors"][0] == pytest.approx(1e-4 + forward["limit_uncertainty"], rel=1e-4)
    assert (forward["component"], forward["station"], forward["loss"]) == ("forward", None, "fold")


# -- Help and completion

MODULE = [sys.executable, "-m", "comparisons"]
ENVIRONMENT = os.environ | {"PYTHONPATH": str(ROOT)}


def completed(*words):
    """What bash is given for the last of the words: kinds and values."""
    asked = {"_CPRBM_COMPLETE": "bash_complete", "COMP_WORDS": " ".join(words), "COMP_CWORD": str(len(words) - 1)}
    done = subprocess.run(MODULE, env=ENVIRONMENT | asked, capture_output=True, text=True, check=True)
    return [tuple(line.split(",")) for line in done.stdout.splitlines()]


def test_help_shows_every_command_once_under_three_headings_with_the_tools_of_a_checkout(capsys):
    assert run(["--help"]) == 0
    text = capsys.readouterr().out.partition("--help ")[2]
    headings = ["Your mechanism", "Built-in cases and evidence", "Development"]
    assert re.findall(r"^(\w[\w -]+):$", text, re.MULTILINE) == headings
    shown = re.findall(r"^  (\w+) {2,}\S", text, re.MULTILINE)
    assert "robustness" in shown
    assert run(["nonsense"]) == 2
    assert shown == re.search(r"allowed: ([\w, ]+)\.", capsys.readouterr().err)[1].split(", ")
    told = {name: tool[1] for name, tool in commands.TOOLS.items() if tool[1]}
    assert told
    for name, line in told.items():  # the list of commands says of a tool the first line of its own help
        assert commands.load_tool(name).command.help.splitlines()[0] == line
    assert run(["study"]) == 0
    names = [line.split()[0] for line in capsys.readouterr().out.splitlines()]
    assert names == ["calibration", "relations", "table1"]
    # the program is a module, too
    listed = subprocess.run([*MODULE, "list"], env=ENVIRONMENT, capture_output=True, text=True, check=True)
    assert [line.split()[0] for line in listed.stdout.splitlines()] == list(cases.names())
    wrong = subprocess.run([*MODULE, "nothing"], env=ENVIRONMENT, capture_output=True, text=True, check=False)
    assert wrong.returncode == 2
    assert wrong.stderr.startswith("cprbm: found 'nothing'")


def test_commands_options_cases_and_files_are_offered_where_they_may_stand():
    names = [("plain", name) for name in cases.names() if name.startswith("gripper")]
    assert len(names) > 1
    assert completed("cprbm", "solve", "gripper") == [("file", "gripper"), *names]
    assert completed("cprbm", "solve", "al") == [("file", "al")]
    assert completed("cprbm", "compare", "hinge", "al") == [("file", "al"), ("plain", "all")]
    assert completed("cprbm", "so") == [("plain", "solve")]
    assert completed("cprbm", "bench", "hinge", "--method", "slsq") == [("plain", "slsqp")]
    asking = {
        name: parameter
        for name in main.commands.list_commands(None)
        for parameter in main.commands.get_command(None, name).params
        if "CASE" in (parameter.metavar or "")
    }
    assert {"solve", "compare", "report"} <= set(asking)
    for name, parameter in asking.items():
        context = main.commands.make_context("cprbm", [name, "--help"], resilient_parsing=True)
        assert "wrapped" in [item.value for item in parameter.shell_complete(context, "wr")], name


@pytest.mark.skipif(shutil.which("bash") is None, reason="no bash to ask")
def test_a_real_bash_that_was_taught_completes(tmp_path):
    program = tmp_path / "cprbm"
    program.write_text(f'#!/bin/sh\nexec "{sys.executable}" -m comparisons "$@"\n')
    program.chmod(0o755)
    script = f"""
eval "$(_CPRBM_COMPLETE=bash_source {program})"
COMP_WORDS=({program} view wra) COMP_CWORD=2
_cprbm_completion {program} 2>/dev/null
echo "${{COMPREPLY[@]}}"
"""
    path = f"{tmp_path}{os.pathsep}{os.environ['PATH']}"
    done = subprocess.run(
        ["bash", "-c", script], env=ENVIRONMENT | {"PATH": path}, capture_output=True, text=True, check=True
    )
    assert done.stdout == "wrapped\n", done.stderr


# -- An installed package, without the tools of a checkout

PACKAGES = ("cprbm_scene", "cprbm", "fea_reference", "elastica_reference", "comparisons")
ELSEWHERE = "is a developers' tool: it runs in a checkout of the repository, not from an installed package."


@pytest.fixture(scope="module")
def installed(tmp_path_factory):
    """The packages as a wheel holds them, without ``tests`` and ``benchmarks``, with the stored kernels."""
    folder = tmp_path_factory.mktemp("installed")
    for package in PACKAGES:
        shutil.copytree(ROOT / package, folder / package)
    return folder


WORDS = (
    (["robustness", "--scenes", "3"], "robustness"),
    (["robustness", "--help"], "robustness"),
    (["study", "relations", "tapered"], "study relations"),
    (["bench", "hinge", "--method", "ipopt"], "bench --method ipopt"),
    (["bench", "hinge", "--method", "auto", "--method", "slsqp"], "bench --method slsqp"),
)
FURTHER = (["--help"], ["study"], ["bench", "tapered", "--sizes", "4", "--repeat", "1", "--json", "-"])


def test_an_installed_package_names_the_tools_of_a_checkout_lists_none_and_times_its_own_solvers(installed, tmp_path):
    done = subprocess.run(
        [sys.executable, "-c", in_turn([*(words for words, _ in WORDS), *FURTHER])],
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": str(installed), "NUMBA_DISABLE_JIT": "1"},
        capture_output=True,
        text=True,
        check=True,
    )
    found = told(done.stdout, done.stderr)
    refused, taken = found[: len(WORDS)], found[len(WORDS) :]
    assert refused == [(2, "", f"cprbm: 'cprbm {command}' {ELSEWHERE}\n") for _, command in WORDS]
    assert [code for code, *_ in taken] == [0, 0, 0]
    listed, studies, timed = (out for _, out, _ in taken)
    assert "compare" in listed
    assert "robustness" not in listed
    assert "calibration" in studies
    assert "relations" not in studies
    # the first solve of an installation names the compilation
    said = [line for _, _, err in taken for line in err.splitlines()]
    assert [line for line in said if not line.startswith("cprbm compiles its kernels")] == []
    data = json.loads(timed)
    methods = [(row["method"], row["formulation"]) for row in data["rows"]]
    assert methods == [("cprbm", "auto"), ("cprbm", "paper"), ("fea", None)]
    assert data["tolerance"] is None

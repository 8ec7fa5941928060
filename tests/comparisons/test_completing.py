"""Shells are told what may follow on a command line; the program is a module as well."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from comparisons import cases
from comparisons.cli.main import commands

ROOT = Path(__file__).parents[2]
PROGRAM = [sys.executable, "-m", "comparisons"]
ENVIRONMENT = os.environ | {"PYTHONPATH": str(ROOT)}


def completed(*words):
    """What bash is given for the last of the words: kinds and values."""
    asked = {"_CPRBM_COMPLETE": "bash_complete", "COMP_WORDS": " ".join(words), "COMP_CWORD": str(len(words) - 1)}
    done = subprocess.run(PROGRAM, env=ENVIRONMENT | asked, capture_output=True, text=True, check=True)
    return [tuple(line.split(",")) for line in done.stdout.splitlines()]


def test_cases_and_files_are_offered_where_they_may_stand():
    names = [("plain", name) for name in cases.names() if name.startswith("gripper")]
    assert len(names) > 1
    assert completed("cprbm", "solve", "gripper") == [("file", "gripper"), *names]
    assert completed("cprbm", "solve", "al") == [("file", "al")]
    assert completed("cprbm", "compare", "hinge", "al") == [("file", "al"), ("plain", "all")]


def test_commands_and_options_are_offered():
    assert completed("cprbm", "so") == [("plain", "solve")]
    assert completed("cprbm", "bench", "hinge", "--method", "slsq") == [("plain", "slsqp")]


def test_whatever_takes_a_case_offers_them():
    asking = {
        name: parameter
        for name in commands.list_commands(None)
        for parameter in commands.get_command(None, name).params
        if "CASE" in (parameter.metavar or "")
    }
    assert {"solve", "compare", "report"} <= set(asking)
    for name, parameter in asking.items():
        context = commands.make_context("cprbm", [name, "--help"], resilient_parsing=True)
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


def test_the_program_is_a_module_too():
    listed = subprocess.run([*PROGRAM, "list"], env=ENVIRONMENT, capture_output=True, text=True, check=True)
    assert [line.split()[0] for line in listed.stdout.splitlines()] == list(cases.names())
    wrong = subprocess.run([*PROGRAM, "nothing"], env=ENVIRONMENT, capture_output=True, text=True, check=False)
    assert wrong.returncode == 2
    assert wrong.stderr.startswith("cprbm: found 'nothing'")

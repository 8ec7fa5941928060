"""A program that kills ``cprbm compare ... --out`` again and again, at random moments.

A child dies at the n-th event of Python's audit: files opened, renamed and removed, folders made, modules sought.
So the moment does not depend on the speed of the machine; n is drawn from a seed. The program checks the folder
after every kill.  Usage: ``killed.py FOLDER KILLS SEED``.
"""

import gzip
import json
import os
import random
import signal
import sys
from contextlib import redirect_stdout
from dataclasses import dataclass
from pathlib import Path

from comparisons.cli.main import run
from comparisons.pairing import Solvers
from comparisons.present import page as pages
from tests.verdict.made_up import MadeUp

QUESTION = """
name = "{name}"
materials.steel = {{ youngs_modulus = 2.07e11, poisson_ratio = 0.29 }}
bodies.ground = {{ motion = "fixed", points = {{ P = [0.0, 0.0] }} }}
bodies.tip = {{ motion = "free", points = {{ Q = [{length}, 0.0] }} }}
loads.F = {{ kind = "force", point = "Q", direction = [0.0, 1.0] }}
stages = [{{ name = "load", steps = "F", stations = [0.7, 1.3] }}]
probes = [{{ of = "Q", quantity = "displacement" }}, {{ of = "P", quantity = "reaction" }}]
[beams.b]
curve = {{ kind = "line", start = [0.0, 0.0], end = [{length}, 0.0] }}
thickness = 0.0011
width = 0.013
material = "steel"
start = {{ joint = "weld", point = "P" }}
end = {{ joint = "weld", point = "Q" }}
"""
NAMES = ("first", "second", "third")


@dataclass(frozen=True)
class Counting:
    """A solver with a mark in a file for every solve."""

    solver: MadeUp
    marks: Path

    def __call__(self, scene, choices):
        with self.marks.open("a") as stream:
            stream.write("x")
        return self.solver(scene, choices)


def ran(folder, out):
    """Compare all questions; the exit code."""
    marks = folder / "marks"
    solvers = Solvers(Counting(MadeUp("cprbm", 2e-3), marks), Counting(MadeUp("fea", -5e-4), marks))
    files = [str(folder / f"{name}.toml") for name in NAMES]
    with Path(os.devnull).open("w") as nowhere, redirect_stdout(nowhere):
        return run(["compare", *files, "--quiet", "--out", str(out), "--json", str(out / "all.json")], solvers)


def compared(folder, out, die_at=None):
    """Status and number of events of a child that compares all questions and dies at an event."""
    reading, writing = os.pipe()
    child = os.fork()
    if child == 0:
        seen = 0

        def audited(event, arguments):
            nonlocal seen
            seen += 1
            if seen == die_at:
                os.kill(os.getpid(), signal.SIGKILL)

        sys.addaudithook(audited)
        code = ran(folder, out)
        os.write(writing, str(seen).encode())
        os._exit(code)
    os.close(writing)
    _, status = os.waitpid(child, 0)
    with os.fdopen(reading) as stream:
        seen = stream.read()
    return status, int(seen or 0)


def told(out):
    """Cases on the page and in the JSON; fails if a file is not whole."""
    for file in out.rglob("*.json"):
        json.loads(file.read_text("utf-8"))
    for file in out.rglob(".unfinished/*.json.gz"):
        json.loads(gzip.decompress(file.read_bytes()))
    page, numbers = out / "index.html", out / "all.json"
    text = page.read_text("utf-8") if page.exists() else "</html>\n"
    assert text.endswith("</html>\n"), text[-80:]
    data = json.loads(numbers.read_text("utf-8"))["cases"] if numbers.exists() else []
    return {name for name in NAMES if f'id="{name}"' in text}, {case["case"] for case in data}


def main(folder, kills, seed):
    """Kill all children, and print the counts as JSON."""
    pages.figures_of = lambda compared: ()  # figures are files as the others are, and take long
    for place, name in enumerate(NAMES):
        (folder / f"{name}.toml").write_text(QUESTION.format(name=name, length=0.1 + 0.013 * place), "utf-8")
    assert ran(folder, folder / "loaded") == 0  # every module is loaded here, and in no child again
    (folder / "marks").unlink()
    status, events = compared(folder, folder / "whole")
    assert status == 0, status
    jobs = len((folder / "marks").read_text())
    (folder / "marks").unlink()
    out, drawn = folder / "killed", random.Random(seed)
    ended = {"killed": 0, "finished": 0}
    page, numbers = set(), set()
    while ended["killed"] < kills:
        begun = (out / ".unfinished").exists()
        status, _ = compared(folder, out, 1 + drawn.randrange(events // 2))
        if status == 0:
            ended["finished"] += 1
            page, numbers = set(), set()  # another run begins
            continue
        assert status == signal.SIGKILL, status
        ended["killed"] += 1
        if not (out / ".unfinished").exists():  # just before the begin, or at the very end
            ended["finished"] += begun
            page, numbers = set(), set()
            continue
        page_now, numbers_now = told(out)
        assert page <= page_now, (page, page_now)
        assert numbers <= numbers_now, (numbers, numbers_now)
        page, numbers = page_now, numbers_now
    status, _ = compared(folder, out)
    assert status == 0, status
    marks = len((folder / "marks").read_text())
    sys.stdout.write(json.dumps({**ended, "jobs": jobs, "solved": marks}))


if __name__ == "__main__":
    main(Path(sys.argv[1]), int(sys.argv[2]), int(sys.argv[3]))

"""How many small faults in the mechanics the tests catch: ``python -m tests.mutants --mutants 200 --seed 905``.

First every file of the solvers' own tests runs once and notes what it reaches (``.mutants/map``).  Then mutants are
drawn, kind by kind; each is put into a copy of the tree, and those tests run that reach its function, the quickest
first, until one fails; then, within ``--seconds`` of the processor, whole files in which one does.  Whatever is there
already, the map of an unchanged test file or the fate of a mutant, is not done again: a run may be ended at any time.

The fates: ``caught`` by a test; ``endless``, which took several times the seconds of its tests; ``survived`` all; and
``unreached`` by any.  Survivors of which it was understood why nothing can catch them stand in ``equivalent.json``.
"""

from __future__ import annotations

import argparse
import json
import os
import random
import resource
import shutil
import subprocess
import sys
import tempfile
from hashlib import sha256
from pathlib import Path

from comparisons.writing import write
from tests.mutants.kinds import KINDS, Mutant, mutants_of

ROOT = Path(__file__).parents[2]
WORK = ROOT / ".mutants"
RESULTS = Path(__file__).parent / "results.json"
EQUIVALENT = Path(__file__).parent / "equivalent.json"
COPIED = ("scene", "cprbm", "fea_reference", "exact", "comparisons", "tests", "pyproject.toml", "Makefile", "README.md")
ROOMS = ("cprbm", "fea_reference")
NO_MECHANICS = ("__init__.py", "settings.py", "remarks.py")
TOLD = ROOT / "docs" / "mutants.md"
CAUGHT = ("caught", "endless")
HEAD = (
    "# Mutants of the mechanics",
    "",
    "What `make mutants` has put into the mechanics of both solvers, one small fault at a time, and whether a test",
    "catches it. The kinds are told in `tests/mutants/kinds.py`, every mutant with the test that caught it in",
    "`tests/mutants/results.json`.",
    "A mutant is equivalent where it was understood why nothing that can be asked shows it; the reason stands below.",
    "",
)
ENDLESS = 6.0
"""A mutant's tests may take so many times their seconds, and a minute more."""


def main() -> None:
    """Map, draw, try, and write the table."""
    asked = argparse.ArgumentParser(description=__doc__)
    asked.add_argument("--mutants", type=int, default=200)
    asked.add_argument("--seed", type=int, default=905)
    asked.add_argument("--seconds", type=float, default=120.0)
    asked.add_argument("--tests", nargs="*", default=["tests/cprbm", "tests/fea_reference"])
    asked.add_argument("--only", nargs="*", default=[], help="files of the solvers to draw from, all unless given")
    options = asked.parse_args()
    mapped = reached(options.tests)
    results = json.loads(RESULTS.read_text("utf-8")) if RESULTS.exists() else {}
    with_tests = sha256(repr((sorted(mapped), options.seconds)).encode()).hexdigest()[:12]
    mine = []
    for mutant in sample(options.mutants, options.seed, options.only):
        key = f"{mutant.name} {source_digest(mutant.file)}"  # of a file that has changed all are tried again
        mine.append(key)
        if key in results and (results[key]["fate"] in CAUGHT or results[key]["with"] == with_tests):
            continue
        fate, by = tried(mutant, mapped, options.seconds)
        line = (ROOT / mutant.file).read_text("utf-8").splitlines()[mutant.line - 1].strip()
        results[key] = {
            "fate": fate,
            "by": by,
            "kind": mutant.kind,
            "file": mutant.file,
            "line": line,
            "new": mutant.new,
            "with": with_tests,
        }
        write(RESULTS, json.dumps(results, indent=1, ensure_ascii=False) + "\n")
        sys.stdout.write(f"{fate:10s} {mutant.name}  {by}\n")
        sys.stdout.flush()
    drawn = f"Drawn by seed {options.seed} from {', '.join(options.only) or ' and '.join(ROOMS)}; at most"
    tests = f"{options.seconds:g} s of the processor of the {len(mapped)} tests in {', '.join(options.tests)}."
    told({key: results[key] for key in mine}, (f"{drawn} {tests}", ""))


def source_digest(file: str) -> str:
    """Short, of a file as it is now."""
    return sha256((ROOT / file).read_bytes()).hexdigest()[:12]


def sample(number: int, seed: int, only: list[str]) -> list[Mutant]:
    """So many mutants, as evenly of all kinds as there are some, in the order in which they were drawn.

    A larger number begins with those of a smaller one.
    """
    files = [
        f"{room}/{path.name}"
        for room in ROOMS
        for path in sorted((ROOT / room).glob("*.py"))
        if path.name not in NO_MECHANICS and (not only or f"{room}/{path.name}" in only)
    ]
    drawn = random.Random(seed)
    by_kind: dict[str, list[Mutant]] = {kind: [] for kind in KINDS}
    for file in files:
        for mutant in mutants_of(file, (ROOT / file).read_bytes()):
            by_kind[mutant.kind].append(mutant)
    for mutants in by_kind.values():
        drawn.shuffle(mutants)
    found: list[Mutant] = []
    while len(found) < number and any(by_kind.values()):
        found.extend(mutants.pop() for mutants in by_kind.values() if mutants)
    return found[:number]


def reached(folders: list[str]) -> dict[str, dict]:
    """By test, seconds and functions; test files that have not changed are not run again."""
    found: dict[str, dict] = {}
    named = [ROOT / folder for folder in folders]
    files = [path for one in named for path in ([one] if one.is_file() else one.glob("**/test_*.py"))]
    for file in sorted(files):
        name = file.relative_to(ROOT)
        kept = WORK / "map" / f"{name.stem}-{name.parent.name}-{sha256(file.read_bytes()).hexdigest()[:12]}.json"
        if not kept.exists():
            kept.parent.mkdir(parents=True, exist_ok=True)
            arguments = ["-p", "tests.mutants.reached", "--reached", str(kept), str(name)]
            done = _pytest(ROOT, arguments, 3600.0)
            if done != 0:
                kept.unlink(missing_ok=True)
                sys.exit(f"{name} fails as it is: pytest ended with {done}")
        found.update(json.loads(kept.read_text("utf-8")))
    return found


def tried(mutant: Mutant, mapped: dict[str, dict], seconds: float) -> tuple[str, str]:
    """A mutant's fate, and the test that caught it."""
    place = [mutant.file, mutant.function]
    reach = {
        test: each["seconds"]
        for test, each in mapped.items()
        if (
            place in each["functions"] if mutant.function else any(file == mutant.file for file, _ in each["functions"])
        )
    }
    if not reach:
        return "unreached", ""
    first = sorted(reach, key=lambda test: reach[test])
    files = {test.partition("::")[0] for test in first}
    beside = sorted(
        (t for t in mapped if t.partition("::")[0] in files and t not in reach), key=lambda t: mapped[t]["seconds"]
    )
    tests, total = [], 0.0
    for test in [*first, *beside]:
        total += mapped[test]["seconds"]
        if total > seconds and tests:
            break
        tests.append(test)
    with tempfile.TemporaryDirectory(prefix="mutant-") as folder:
        tree = Path(folder)
        for name in COPIED:
            if (ROOT / name).is_dir():
                shutil.copytree(ROOT / name, tree / name, ignore=shutil.ignore_patterns("__pycache__"))
            else:
                shutil.copy(ROOT / name, tree / name)
        source = tree / mutant.file
        source.write_bytes(mutant.applied(source.read_bytes()))
        # a few first: most mutants fall there, and every further test is a file to be collected
        for some in (tests[:12], tests[12:]):
            if not some:
                continue
            limit = 60.0 + ENDLESS * sum(mapped[test]["seconds"] for test in some)
            (tree / "tests.txt").write_text("\n".join(some), "utf-8")
            report = tree / "report.txt"
            code = _pytest(tree, ["-x", "@tests.txt"], limit, report)
            if code < 0 or code > 128:
                return "endless", f"{limit:.0f} s"
            if code != 0:
                failed = [
                    line for line in report.read_text("utf-8").splitlines() if line.startswith(("FAILED", "ERROR"))
                ]
                return "caught", failed[0].split(" - ")[0].split(" ", 1)[1] if failed else f"pytest {code}"
    return "survived", f"{len(tests)} tests"


def _pytest(tree: Path, arguments: list[str], seconds: float, report: Path | None = None) -> int:
    def limited() -> None:
        resource.setrlimit(resource.RLIMIT_CPU, (int(seconds), int(seconds) + 5))

    command = [sys.executable, "-B", "-m", "pytest", "-q", "-p", "no:cacheprovider", "--tb=no", *arguments]
    with (report or Path(os.devnull)).open("w") as stream:
        return subprocess.run(
            command, cwd=tree, stdout=stream, stderr=stream, preexec_fn=limited, check=False
        ).returncode


def told(results: dict[str, dict], how: tuple[str, ...]) -> None:
    """Write the score by kind, and who survives."""
    equivalent = json.loads(EQUIVALENT.read_text("utf-8")) if EQUIVALENT.exists() else {}
    lines = [*HEAD, *how, "| kind | mutants | caught | equivalent | alive |", "|---|---|---|---|---|"]
    total = [0, 0, 0, 0]
    for kind in KINDS:
        mine = {key: each for key, each in results.items() if each["kind"] == kind}
        caught = sum(each["fate"] in CAUGHT for each in mine.values())
        same = sum(each["fate"] not in CAUGHT and _fault(each) in equivalent for each in mine.values())
        row = [len(mine), caught, same, len(mine) - caught - same]
        total = [one + other for one, other in zip(total, row, strict=True)]
        lines.append(f"| {kind} | {' | '.join(map(str, row))} |")
    lines += [f"| all | {' | '.join(map(str, total))} |", "", "## Survivors", ""]
    lines += ["| where | line | becomes | what is known of it |", "|---|---|---|---|"]
    for key, each in results.items():
        if each["fate"] not in CAUGHT:
            known = equivalent.get(_fault(each)) or f"alive: {each['fate']} {each['by']}".rstrip()
            told = [f"`{text}`".replace("|", "\\|") for text in (key.split()[0], each["line"], each["new"])]
            lines.append(f"| {' | '.join(told)} | {known} |")
    write(TOLD, "\n".join(lines) + "\n")
    sys.stdout.write(f"{total[0]} mutants: {total[1]} caught, {total[2]} equivalent, {total[3]} alive; {TOLD}\n")


def _fault(each: dict) -> str:
    """What a mutant is called in ``equivalent.json``: it stays the same as lines move."""
    return f"{each['file']}: {each['line']} -> {each['new']}"


if __name__ == "__main__":
    main()

"""How many small faults in the mechanics the tests catch: ``python -m tests.mutants --mutants 200 --seed 905``.

First every file of the solvers' own tests runs once and notes which lines its quick tests reach (``.mutants/map``).
Then mutants are drawn, kind by kind; each is put into a copy of the tree, and those tests run that reach its
statement, the quickest first and ``--seconds`` of the processor at most, until one fails.  Whatever is there already,
the map of an unchanged test file or the fate of a mutant, is not done again: a run may be ended at any time.  Which
mutants a seed draws is a matter of each by itself: as sources change, those of unchanged lines stay drawn, and what is
known of a mutant holds as long as the function around it is the same.  Those drawn earlier are told of too.

The fates: ``caught`` by a test; ``endless``, which took several times the seconds of its tests; ``survived`` all; and
``unreached`` by any.  Survivors of which it was understood why nothing can catch them stand in ``equivalent.json``,
those that a test was seen to catch which is not among the quick ones in ``longer.json``.
"""

from __future__ import annotations

import argparse
import ast
import compileall
import json
import py_compile
import shutil
import sys
import tempfile
import time
from hashlib import sha256
from pathlib import Path

import numpy as np

from comparisons.writing import write
from tests.mutants.forked import forked_pytest, warm
from tests.mutants.kinds import KINDS, Mutant, mutants_of, reads, statement_at

ROOT = Path(__file__).parents[2]
WORK = ROOT / ".mutants"
RESULTS = Path(__file__).parent / "results.json"
EQUIVALENT = Path(__file__).parent / "equivalent.json"
LONGER = Path(__file__).parent / "longer.json"
COPIED = (
    "cprbm_scene",
    "cprbm",
    "fea_reference",
    "elastica_reference",
    "comparisons",
    "benchmarks",
    "tests",
    "pyproject.toml",
    "Makefile",
    "README.md",
)
ROOMS = ("cprbm", "fea_reference")
NO_MECHANICS = ("__init__.py", "settings.py", "remarks.py")
SURVIVORS = WORK / "survivors.md"
CAUGHT = ("caught", "endless")
HEAD = (
    "# Mutants of the mechanics",
    "",
    "What `make mutants` has put into the mechanics of both solvers, one small fault at a time, and whether a test",
    "catches it. The kinds are told in `tests/mutants/kinds.py`, every mutant with the test that caught it in",
    "`tests/mutants/results.json`.",
    "A mutant is equivalent where it was understood why nothing that can be asked shows it; the reason stands below.",
    "By longer tests are those caught that survive the quick ones and that a slower test was seen to catch.",
    "",
)
ENDLESS = 6.0
"""A mutant's tests may take so many times their seconds, and ten seconds more."""
SOME_FAILED, NO_TESTS = 1, 5


def main() -> None:
    """Map, draw, try, and write the table."""
    asked = argparse.ArgumentParser(description=__doc__)
    asked.add_argument("--mutants", type=int, default=200)
    asked.add_argument("--seed", type=int, default=905)
    asked.add_argument("--seconds", type=float, default=20.0, help="of the processor, at most, of a mutant's tests")
    asked.add_argument("--minutes", type=float, default=600.0, help="after which no other mutant is tried")
    asked.add_argument("--tests", nargs="*", default=["tests/cprbm", "tests/fea_reference"])
    asked.add_argument("--only", nargs="*", default=[], help="files of the solvers to draw from, all unless given")
    options, begun = asked.parse_args(), time.monotonic()
    warm()
    mapped = reached(options.tests)
    results = json.loads(RESULTS.read_text("utf-8")) if RESULTS.exists() else {}
    drawn = sample(options.mutants, options.seed, options.only)
    known = known_before(results, drawn)
    known_fates = {}
    with tempfile.TemporaryDirectory(prefix="mutants-") as folder:
        copy_of_sources(tree := Path(folder))
        for mutant in (*drawn, *known):
            around = digest_around(mutant)
            key = f"{mutant.fault} {around}"
            tests = planned(mutant, mapped, options.seconds)
            with_tests = sha256(repr(sorted(tests)).encode()).hexdigest()[:12]
            in_time = time.monotonic() - begun < 60.0 * options.minutes
            last = results.get(key)
            if in_time and (last is None or (last["fate"] not in CAUGHT and last["with"] != with_tests)):
                fate, by = tried(mutant, tests, mapped, tree)
                results = {one: each for one, each in results.items() if fault_of(one) != mutant.fault}
                results[key] = {"fate": fate, "by": by, "kind": mutant.kind, "with": with_tests}
                write(RESULTS, json.dumps(results, indent=1, ensure_ascii=False) + "\n")
                sys.stdout.write(
                    f"{fate:10s} {mutant.file}:{mutant.line} {mutant.kind}: {mutant.text} -> {mutant.new}  {by}\n"
                )
                sys.stdout.flush()
            if key in results:
                known_fates[key] = (mutant, results[key])
    of_seed = sum(mutant in drawn for mutant, _ in known_fates.values())
    asked_for = f"{of_seed} of the {options.mutants} mutants that seed {options.seed} draws from"
    quick = f"Each was given at most {options.seconds:g} s of the processor of {len(mapped)} quick tests, those that"
    how = (
        f"{asked_for} {', '.join(options.only) or ' and '.join(ROOMS)}, {len(known_fates) - of_seed} drawn earlier.",
        f"{quick} reach its statement, in {', '.join(options.tests)}.",
    )
    write_survivors(list(known_fates.values()), (*how, ""))


def fault_of(key: str) -> str:
    """What a key of the results begins with: the fault, without the digest of what was around it."""
    return key.rpartition(" ")[0]


def digest_around(mutant: Mutant) -> str:
    """Short, of the function around a mutant as it is now; of what is in none, of the statement."""
    source = (ROOT / mutant.file).read_bytes()
    functions = [node for node in ast.walk(ast.parse(source)) if isinstance(node, ast.FunctionDef)]
    around = [node for node in functions if node.lineno <= mutant.line <= node.end_lineno]
    first, last = statement_at(source, mutant.line)
    if around:
        first, last = min(node.lineno for node in around), max(node.end_lineno for node in around)
    return sha256(b"\n".join(source.splitlines()[first - 1 : last])).hexdigest()[:12]


def sample(number: int, seed: int, only: list[str]) -> list[Mutant]:
    """So many mutants, as evenly of all kinds as there are some, in the order in which they were drawn.

    A larger number begins with those of a smaller one.
    """
    modules = [path for room in ROOMS for path in sorted((ROOT / room).rglob("*.py")) if path.name not in NO_MECHANICS]
    files = [str(path.relative_to(ROOT)) for path in modules]
    by_kind: dict[str, dict[str, Mutant]] = {kind: {} for kind in KINDS}
    for file in only or files:
        for mutant in mutants_of(file, (ROOT / file).read_bytes()):
            by_kind[mutant.kind].setdefault(sha256(f"{seed} {mutant.kind} {mutant.fault}".encode()).hexdigest(), mutant)
    drawn = [[of[lot] for lot in sorted(of, reverse=True)] for of in by_kind.values()]
    found: list[Mutant] = []
    while len(found) < number and any(drawn):
        popped = [mutants.pop() for mutants in drawn if mutants]
        found.extend(each for each in popped if reads(each.applied((ROOT / each.file).read_bytes())))
    return found[:number]


def known_before(results: dict[str, dict], drawn: list[Mutant]) -> list[Mutant]:
    """Those beside the drawn of which results tell, as far as their lines are still there."""
    known, found = {fault_of(key) for key in results}, {mutant.fault: mutant for mutant in drawn}
    for file in sorted({fault.partition(": ")[0] for fault in known}):
        if (ROOT / file).exists():
            for mutant in mutants_of(file, (ROOT / file).read_bytes()):
                if mutant.fault in known:
                    found.setdefault(mutant.fault, mutant)
    return [mutant for mutant in found.values() if mutant not in drawn]


def reached(folders: list[str]) -> dict[str, dict]:
    """By test, seconds and lines; test files that have not changed are not run again."""
    found: dict[str, dict] = {}
    named = [ROOT / folder for folder in folders]
    files = [path for one in named for path in ([one] if one.is_file() else one.glob("**/test_*.py"))]
    for file in sorted(files):
        name = file.relative_to(ROOT)
        kept = WORK / "map" / f"{name.stem}-{name.parent.name}-{sha256(file.read_bytes()).hexdigest()[:12]}.json"
        if not kept.exists():
            kept.parent.mkdir(parents=True, exist_ok=True)
            part = kept.with_suffix(".part")
            done = forked_pytest(ROOT, ["-p", "tests.mutants.reached", "--reached", str(part), str(name)], 600.0)
            if done not in (0, SOME_FAILED, NO_TESTS):
                sys.exit(f"{name} cannot be mapped: pytest ended with {done}")
            part.rename(kept)  # without those that failed, most of them broken off
        found.update(json.loads(kept.read_text("utf-8")))
    return {test: each for test, each in found.items() if each["lines"]}


def planned(mutant: Mutant, mapped: dict[str, dict], seconds: float) -> list[str]:
    """The tests that reach a mutant's statement, the quickest first, as many as fit into ``seconds``."""
    first, last = statement_at((ROOT / mutant.file).read_bytes(), mutant.line)
    reach = {
        test: each["seconds"]
        for test, each in mapped.items()
        if any(not mutant.function or first <= line <= last for line in each["lines"].get(mutant.file, ()))
    }
    tests, total = [], 0.0
    for test in sorted(reach, key=lambda test: reach[test]):
        total += reach[test]
        if total > seconds and tests:
            break
        tests.append(test)
    return tests


def tried(mutant: Mutant, tests: list[str], mapped: dict[str, dict], tree: Path) -> tuple[str, str]:
    """A mutant's fate in a copy of the sources, and the test that caught it."""
    if not tests:
        return "unreached", ""
    source, report = tree / mutant.file, tree / "report.txt"
    whole = source.read_bytes()
    try:
        source.write_bytes(mutant.applied(whole))
        # a few first: most mutants fall there, and every further test is a file to be collected
        for some in (tests[:12], tests[12:]):
            if not some:
                continue
            limit = 10.0 + ENDLESS * sum(mapped[test]["seconds"] for test in some)
            code = forked_pytest(tree, ["-x", *some], limit, report)
            if code < 0:
                return "endless", f"{limit:.0f} s"
            if code != 0:
                lines = report.read_text("utf-8").splitlines()
                failed = [line for line in lines if line.startswith(("FAILED", "ERROR"))]
                return "caught", failed[0].split(" - ")[0].split(" ", 1)[1] if failed else f"pytest {code}"
    finally:
        source.write_bytes(whole)
    return "survived", f"{len(tests)} tests"


def copy_of_sources(tree: Path) -> None:
    """A tree to be altered; what is compiled in it is known by its sources' contents, not by their dates."""
    for name in COPIED:
        if (ROOT / name).is_dir():
            shutil.copytree(ROOT / name, tree / name, ignore=shutil.ignore_patterns("__pycache__"))
            compileall.compile_dir(tree / name, quiet=2, invalidation_mode=py_compile.PycInvalidationMode.CHECKED_HASH)
        else:
            shutil.copy(ROOT / name, tree / name)


def write_survivors(tried: list[tuple[Mutant, dict]], how: tuple[str, ...]) -> None:
    """Write the score by kind, and the survivors with reasons."""
    equivalent, longer = (json.loads(path.read_text("utf-8")) if path.exists() else {} for path in (EQUIVALENT, LONGER))
    lines = [
        *HEAD,
        *how,
        "| kind | mutants | caught | by longer tests | equivalent | alive |",
        "|---|---|---|---|---|---|",
    ]
    total = np.zeros(5, dtype=int)
    for kind in KINDS:
        mine = [mutant.fault for mutant, each in tried if mutant.kind == kind and each["fate"] not in CAUGHT]
        number = sum(mutant.kind == kind for mutant, _ in tried)
        late, same = sum(fault in longer for fault in mine), sum(fault in equivalent for fault in mine)
        row = [number, number - len(mine), late, same, len(mine) - late - same]
        total += row
        lines.append(f"| {kind} | {' | '.join(map(str, row))} |")
    lines += [f"| all | {' | '.join(map(str, total))} |", "", "## Survivors of the quick tests", ""]
    lines += ["| where | line | becomes | what is known of it |", "|---|---|---|---|"]
    for mutant, each in tried:
        if each["fate"] not in CAUGHT:
            known = f"alive: {each['fate']} {each['by']}".rstrip()
            if mutant.fault in longer:
                known = f"caught by `{longer[mutant.fault]}`"
            known = equivalent.get(mutant.fault, known)
            where = (f"{mutant.file}:{mutant.line}", mutant.text, mutant.new)
            lines.append(f"| {' | '.join(f'`{text}`'.replace('|', chr(92) + '|') for text in where)} | {known} |")
    write(SURVIVORS, "\n".join(lines) + "\n")
    score = f"{total[1]} caught, {total[2]} by longer tests, {total[3]} equivalent, {total[4]} alive"
    sys.stdout.write(f"{total[0]} mutants: {score}; {SURVIVORS}\n")


if __name__ == "__main__":
    main()

"""``python -m tests.baseline``: record the program's answers, compare two records, pack a record into a file."""

from __future__ import annotations

import os
import sys
from pathlib import Path

import click

from comparisons import cases
from tests.baseline import record as records
from tests.baseline.accepted import AcceptedError, read_accepted
from tests.baseline.changes import SAME, compare_records
from tests.baseline.measuring import Program
from tests.baseline.recorder import record_runs
from tests.baseline.report import failing, lines
from tests.baseline.runs import THEORIES, planned_runs

NOT_SAME, WRONG_QUESTION = 1, 2
BUILT_IN = cases.scenes()


@click.group()
def main() -> None:
    """Record the answers of both solvers and of the comparison, and compare records."""


@main.command()
@click.argument("folder", type=click.Path(file_okay=False, path_type=Path))
@click.option("--only", "built_in", multiple=True, type=click.Choice(BUILT_IN), help="A built-in case; all by default.")
@click.option("--scenes", type=click.IntRange(0), default=300, show_default=True, help="Number of random scenes.")
@click.option("--seed", type=click.IntRange(0), default=905, show_default=True, help="Their seed.")
@click.option("--theory", type=click.Choice(THEORIES), help="Beam theory of every solver with a choice.")
@click.option("--workers", type=click.IntRange(1), default=os.cpu_count() or 1, help="Processes; all cores by default.")
def record(folder: Path, built_in: tuple[str, ...], scenes: int, seed: int, theory: str | None, workers: int) -> None:
    """Record all runs into FOLDER; a stopped record goes on."""
    names = built_in or BUILT_IN
    about = records.About(names, scenes, seed, theory, records.program_digest())
    runs = list(planned_runs(names, scenes, seed, theory))
    done = list(_shown(record_runs(folder, about, runs, Program(), workers), len(runs)))
    outcomes = [entry["outcome"] for entry in records.read(folder).entries.values()]
    counts = ", ".join(f"{outcomes.count(outcome)} {outcome}" for outcome in sorted(set(outcomes)))
    click.echo(f"{folder}: {len(outcomes)} runs ({counts}); {len(done)} of them now.")


@main.command()
@click.argument("old", type=click.Path(exists=True, path_type=Path))
@click.argument("new", type=click.Path(exists=True, path_type=Path))
@click.option("--accepted", type=click.Path(path_type=Path), help="TOML file of accepted changes with a reason each.")
@click.option(
    "--same", type=click.FloatRange(0.0), default=SAME, show_default=True, help="Share of a scale that is no change."
)
def compare(old: Path, new: Path, accepted: Path | None, same: float) -> None:
    """Compare two records; exit code 1 if a change fails."""
    allowed = read_accepted(accepted)
    before, after = records.read(old), records.read(new)
    findings = list(compare_records(before, after, same=same, improved=allowed.improved))
    for line in lines(before, after, findings, allowed):
        click.echo(line)
    sys.exit(NOT_SAME if failing(findings, allowed) else 0)


@main.command()
@click.argument("sources", metavar="RECORD...", nargs=-1, required=True, type=click.Path(exists=True, path_type=Path))
@click.argument("file", type=click.Path(dir_okay=False, path_type=Path))
def pack(sources: tuple[Path, ...], file: Path) -> None:
    """Write records as a compressed FILE (.jsonl.xz); a later RECORD replaces runs of earlier records."""
    if not file.name.endswith(records.PACKED):
        raise click.UsageError(f"FILE: found {file.name!r}, allowed: a name that ends in {records.PACKED}")
    records.pack(records.join([records.read(source) for source in sources]), file)
    click.echo(f"{file}: {file.stat().st_size / 1e6:.2f} MB")


def _shown(entries, runs):
    with click.progressbar(entries, length=runs, label="runs", file=sys.stderr) as bar:
        yield from bar


if __name__ == "__main__":
    try:
        main()
    except (records.RecordError, AcceptedError) as error:
        click.echo(f"baseline: {error}", err=True)
        sys.exit(WRONG_QUESTION)

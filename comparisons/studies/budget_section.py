"""Table, figure, sentences and documented JSON of an error budget."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

from comparisons.choices import Count
from comparisons.claims import claim_of
from comparisons.display_units import at_station
from comparisons.formats import number, percent
from comparisons.plain import Plain, plain
from comparisons.present.canvas import canvas, finished
from comparisons.present.columns import Column, Figure, Table, records_of, table_of
from comparisons.studies.budget import Account, Budget

if TYPE_CHECKING:
    from matplotlib.axes import Axes

LOOKS = {
    "contact": ("#7b4ea3", "contact: paper to auto"),
    "links": ("#1f5fa8", "CPRBM: links"),
    "rest": ("#222222", "rest between the limits"),
    "elements": ("#3f8f5b", "FEA: elements"),
    "penalty": ("#8fd0b5", "FEA: penalty"),
}
"""Colour and label by part, in the order of the sum."""

MISSED = "#8a6d1f"

_MOVED = ("displacement", "rotation")
_LISTED = 0.02
"""Share of a difference below which a sentence sums parts up."""


def sentences_of(account: Account) -> tuple[str, ...]:
    """Parts of every claimed difference, the solid's opinion, or why there is no budget."""
    if account.missing:
        return (f"{account.scene.name} has no error budget: {'; '.join(account.missing)}.",)
    claimed = [each for each in account.last if (claim := claim_of(account.scene, each.row)) and claim.value is None]
    return (*(_made_of(account, each) for each in claimed), *_of_solid(account))


def data_of(account: Account) -> Plain:
    """Keys for one case of ``converge``: ``budget``, with fractions as in the rows of ``compare``."""

    def share(header: str, size: Callable[[Budget], float | None]) -> Column[Budget]:
        def fraction(at: Budget) -> float | None:
            value = size(at)
            return None if value is None else at.row.fraction(value)

        return Column(header, fraction)

    solid = [share("missed", lambda at: at.missed), share("missed_uncertainty", lambda at: at.missed_uncertainty)]
    columns = [
        Column[Budget]("probe", lambda at: at.row.probe.name),
        Column("stage", lambda at: at.row.stage),
        Column("station", lambda at: at.row.station),
        Column("unit", lambda at: at.row.unit),
        share("difference", lambda at: at.row.difference),
        Column("parts", _shares),
        share("rest_uncertainty", lambda at: at.rest_uncertainty),
        share("elements_uncertainty", lambda at: at.elements_uncertainty),
        share("penalty_off_line", lambda at: at.off_line),
        share("paper", lambda at: at.paper),
        share("curved_beam", lambda at: at.curved),
        Column("inner_edge_factor", lambda at: plain(at.inner_edge)),
        Column("scale", lambda at: at.row.scale),
        Column("denominator", lambda at: at.row.denominator),
    ]
    records = []
    for each in account.budgets:
        records += records_of([*columns, *(solid if each.missed is not None else ())], [each])
    return {"budget": records, "budget_missing": list(account.missing)}


def _shares(budget: Budget) -> dict[str, float | None]:
    """Parts as fractions."""
    return {name: budget.row.fraction(part) for name, part in budget.parts.by_name().items()}


def budget_table(account: Account) -> Table:
    """Parts at the last station, per cent of the denominators; without columns of zeros for theories not chosen."""

    def size(header: str, value: Callable[[Budget], float | None]) -> Column[Budget]:
        return Column(header, lambda at: _cell(at, value(at)))

    def part(name: str) -> Column[Budget]:
        return Column(name, lambda at: _cell(at, getattr(at.parts, name), sign=True) if at.all_parts else None)

    shown = [name for name in LOOKS if any(getattr(each.parts, name) for each in account.last)]
    columns = [Column[Budget]("probe", lambda at: at.row.probe.name), size("difference", lambda at: at.row.difference)]
    for name in shown:
        columns.append(part(name))
        if name == "rest":
            columns.append(size("±", lambda at: at.rest_uncertainty if at.all_parts else None))
    columns += [
        Column("paper", lambda at: None if at.parts.contact else _cell(at, at.paper, sign=True)),
        size("curved", lambda at: at.curved or None),
        Column("missed", lambda at: _cell(at, at.missed, sign=True)),
        size("±", lambda at: at.missed_uncertainty),
    ]
    note = (
        "Per cent of the denominator of the case's table. The parts sum to the difference; negative parts make the "
        "difference smaller. Links, elements, penalty: value beside its limit. Rest: between the solvers' limits "
        f"in {account.choices.theory}, with the uncertainty. Beside the sum: paper, "
        "from auto to paper at the same links; curved, error of the straight-beam formula of stress, t/(3R) to first "
        "order; missed, limit of the finite elements less the solid's limit, with the uncertainty."
    )
    stage, choices = account.scene.stages[-1], account.choices
    where = at_station(account.scene, stage.name, stage.stations[-1])
    title = f"Error budget at {where} with {_count(choices.links)} links and {_count(choices.elements)} elements"
    return table_of(f"{title} per beam, %", columns, account.last, note)


def budget_figures(account: Account) -> tuple[Figure, ...]:
    """Composition of the differences at the last station; no figure without parts."""
    budgets = [each for each in account.last if each.all_parts > 0.0]
    if not budgets:
        return ()
    with canvas(9.0, 1.9 + 0.34 * len(budgets)) as drawing:
        axes = drawing.add_subplot()
        _draw_parts(axes, budgets)
        missed = _draw_missed(axes, budgets)
        axes.axvline(0.0, color="black", linewidth=0.8)
        axes.set_xlabel("share of all parts, %")
        axes.set_yticks(range(len(budgets)), [each.row.probe.name for each in budgets])
        axes.invert_yaxis()
        for place, each in enumerate(budgets):
            text = percent(each.row.fraction(each.row.difference))
            axes.annotate(text, (1.01, place), xycoords=("axes fraction", "data"), va="center", fontsize=9.0)
        drawing.legend(*axes.get_legend_handles_labels(), loc="outside lower center", ncols=4, fontsize=9.0)
        stage = account.scene.stages[-1]
        caption = (
            f"Parts of the differences at {at_station(account.scene, stage.name, stage.stations[-1])}: to the right "
            "parts that make the difference larger, to the left parts that make it smaller; the diamond is the sum, "
            "and the number at the right the difference."
        )
        caption += " Thin bars: what the beam theories miss together, by the solid." if missed else ""
        return (finished(drawing, "budget", caption),)


def _draw_parts(axes: Axes, budgets: Sequence[Budget]) -> None:
    """A bar of all parts for every budget."""
    ends = [[0.0, 0.0] for _ in budgets]
    for name, (colour, label) in LOOKS.items():
        shares = [100.0 * (each.row.fraction(getattr(each.parts, name)) or 0.0) / each.all_parts for each in budgets]
        if any(shares):
            starts = [end[share < 0.0] for end, share in zip(ends, shares, strict=True)]
            axes.barh(range(len(budgets)), shares, left=starts, height=0.66, color=colour, label=label)
        for end, share in zip(ends, shares, strict=True):
            end[share < 0.0] += share
    sums = [sum(end) for end in ends]
    axes.plot(sums, range(len(budgets)), "D", color="white", markeredgecolor="black", markersize=5.0, label="sum")


def _draw_missed(axes: Axes, budgets: Sequence[Budget]) -> bool:
    """A thin bar below every budget with a value of the solid; whether there is any."""
    known = [(place, each) for place, each in enumerate(budgets) if each.missed is not None]
    if known:
        sizes, doubts = (
            [100.0 * (at.row.fraction(getattr(at, name)) or 0.0) / at.all_parts for _, at in known]
            for name in ("missed", "missed_uncertainty")
        )
        axes.barh([place + 0.42 for place, _ in known], sizes, xerr=doubts, height=0.14, color=MISSED,
                  error_kw={"linewidth": 0.8}, label="missed by beam theory: FEA to solid")  # fmt: skip
    return bool(known)


def _cell(budget: Budget, value: float | None, *, sign: bool = False) -> str | None:
    """A size in per cent of the row's denominator, without the unit."""
    fraction = None if value is None else budget.row.fraction(value)
    if fraction is None:
        return None
    mark = "" if not sign or fraction == 0.0 else "−" if fraction < 0.0 else "+"
    return f"{mark}{number(100.0 * abs(fraction))}"


def _count(count: Count) -> str:
    return str(count) if isinstance(count, int) else ",".join(f"{beam}={number}" for beam, number in count.items())


def _made_of(account: Account, budget: Budget) -> str:
    """The large parts of a difference in a sentence."""
    row, parts = budget.row, budget.parts.by_name()
    large = {name: part for name, part in parts.items() if abs(part) > _LISTED * row.difference}
    small = sum(part for name, part in parts.items() if name not in large)
    listed = ", ".join(f"{name} {_cell(budget, part, sign=True)} %" for name, part in large.items())
    return (
        f"{row.probe.name} at {at_station(account.scene, row.stage, row.station)}: the difference of "
        f"{percent(row.fraction(row.difference))} is {listed}, and {_cell(budget, small, sign=True)} % for all else."
    )


def _of_solid(account: Account) -> tuple[str, ...]:
    """What the solid states about displacements and rotations at the last station; nothing without a solid."""
    if account.silent:
        return (f"The solid states nothing: {account.silent}",)
    missed = [each for each in account.last if each.missed is not None and each.row.probe.quantity in _MOVED]
    listed = ", ".join(
        f"{each.row.probe.name} {_cell(each, each.missed, sign=True)} % (± {_cell(each, each.missed_uncertainty)} %)"
        for each in missed
    )
    return (f"What the beam theories miss together, beside the sum, by the solid: {listed}.",) if missed else ()

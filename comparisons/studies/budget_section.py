"""Table, figure, sentences and documented JSON of an error budget."""

from itertools import chain

import numpy as np

from comparisons.formats import at_station, number, percent
from comparisons.opinions import claim_of
from comparisons.present.canvas import canvas, finished, name_rows
from comparisons.present.columns import NOTHING, Column, Figure, Plain, Table, plain, table_of
from comparisons.stations import last_station
from comparisons.studies.budget import PARTS, Account, Budget

LOOKS = {
    "contact": ("#7b4ea3", "contact: paper to auto"),
    "links": ("#1f5fa8", "CPRBM: links"),
    "rest": ("#222222", "rest between the limits"),
    "elements": ("#3f8f5b", "FEA: elements"),
    "penalty": ("#8fd0b5", "FEA: penalty"),
}
"""Colour and label by part."""

MISSED = "#8a6d1f"

_LISTED = 0.02
"""Share of a difference below which a sentence sums parts up."""


def sentences_of(account: Account) -> tuple[str, ...]:
    """Parts of every claimed difference, the solid's opinion, or why there is no budget."""
    if account.missing:
        return (f"{account.scene.name} has no error budget: {'; '.join(account.missing)}.",)
    claimed = [each for each in account.last if (claim := claim_of(account.scene, each.row)) and claim.value is None]
    return (*(_claimed_sentence(account, each) for each in claimed), *_solid_sentences(account))


def _claimed_sentence(account: Account, budget: Budget) -> str:
    """The large parts of a difference."""
    row = budget.row
    large = {name: part for name, part in budget.parts.items() if abs(part) > _LISTED * row.difference}
    small = sum(part for name, part in budget.parts.items() if name not in large)
    listed = ", ".join(f"{name} {_cell(budget, part, sign=True)} %" for name, part in large.items())
    return (
        f"{row.probe.name} at {at_station(account.scene, row.stage, row.station)}: the difference of "
        f"{percent(row.fraction(row.difference))} is {listed}, and {_cell(budget, small, sign=True)} % for all else."
    )


def _solid_sentences(account: Account) -> tuple[str, ...]:
    """Statement of the solid on displacements and rotations at the last station; nothing without a solid."""
    if account.silent:
        return (f"The solid states nothing: {account.silent}",)
    listed = ", ".join(
        f"{each.row.probe.name} {_cell(each, each.missed, sign=True)} % (± {_cell(each, each.missed_uncertainty)} %)"
        for each in account.last
        if each.missed is not None and each.row.probe.quantity in ("displacement", "rotation")
    )
    return (f"What the beam theories miss together, beside the sum, by the solid: {listed}.",) if listed else ()


def data_of(account: Account) -> Plain:
    """Keys for one case of ``converge``: ``budget``, with fractions as in the rows of ``compare``."""
    return {"budget": [_record(each) for each in account.budgets], "budget_missing": list(account.missing)}


def _record(at: Budget) -> Plain:
    """Documented JSON of a budget; ``missed`` only with a solid."""
    row, solid = at.row, {"missed": at.missed, "missed_uncertainty": at.missed_uncertainty}
    sizes = {
        "difference": row.difference,
        "rest_uncertainty": at.rest_uncertainty,
        "elements_uncertainty": at.elements_uncertainty,
        "penalty_off_line": at.off_line,
        "paper": at.paper,
        "curved_beam": at.curved,
        **(solid if at.missed is not None else {}),
    }
    return {
        "probe": row.probe.name,
        "stage": row.stage,
        "station": row.station,
        "unit": row.unit,
        "parts": {name: row.fraction(part) for name, part in at.parts.items()},
        **{name: None if value is None else row.fraction(value) for name, value in sizes.items()},
        "inner_edge_factor": plain(at.inner_edge),
        "scale": row.scale,
        "denominator": row.denominator,
    }


def budget_table(account: Account) -> Table:
    """Parts at the last station, per cent of the denominators; without columns of zeros for theories not chosen."""

    def part(name: str) -> Column[Budget]:
        return Column(name, lambda at: _cell(at, at.parts[name] if at.all_parts else None, sign=True))

    uncertainty = Column[Budget]("±", lambda at: _cell(at, at.rest_uncertainty if at.all_parts else None))
    parts = {name: [part(name), *[uncertainty] * (name == "rest")] for name in PARTS}
    links, elements = (
        str(count) if isinstance(count, int) else ",".join(f"{beam}={n}" for beam, n in count.items())
        for count in (account.choices.links, account.choices.elements)
    )
    sizes = f"{links} links and {elements} elements per beam"
    return table_of(
        title=f"Error budget at {at_station(account.scene, *last_station(account.scene))} with {sizes}, %",
        columns=[
            Column[Budget]("probe", "row.probe.name"),
            Column("difference", lambda at: _cell(at, at.row.difference)),
            *chain.from_iterable(parts[name] for name in PARTS if any(at.parts[name] for at in account.last)),
            Column("paper", lambda at: _cell(at, None if at.parts["contact"] else at.paper, sign=True)),
            Column("curved", lambda at: _cell(at, at.curved or None)),
            Column("missed", lambda at: _cell(at, at.missed, sign=True)),
            Column("±", lambda at: _cell(at, at.missed_uncertainty)),
        ],
        items=account.last,
        note="Per cent of the denominator of the case's table. The parts sum to the difference; negative parts make "
        "the difference smaller. Links, elements, penalty: value beside its limit. Rest: between the solvers' limits "
        f"in {account.choices.theory}, with the uncertainty. Beside the sum: paper, "
        "from auto to paper at the same links; curved, error of the straight-beam formula of stress, t/(3R) to first "
        "order; missed, limit of the finite elements less the solid's limit, with the uncertainty.",
    )


def budget_figures(account: Account) -> tuple[Figure, ...]:
    """Composition of the differences at the last station; no figure without parts.

    Negative parts of a budget stand to the left, positive parts to the right.
    """
    budgets = [each for each in account.last if each.all_parts > 0.0]
    if not budgets:
        return ()
    places = np.arange(len(budgets))
    shares = np.array([[_share(each, each.parts[name]) for each in budgets] for name in LOOKS])
    below, above = (np.cumsum(half(shares, 0.0), axis=0) for half in (np.minimum, np.maximum))
    starts = np.where(shares < 0.0, below, above) - shares
    missed = {place + 0.42: each for place, each in enumerate(budgets) if each.missed is not None}
    caption = (
        f"Parts of the differences at {at_station(account.scene, *last_station(account.scene))}: to the right "
        "parts that make the difference larger, to the left parts that make it smaller; the diamond is the sum, "
        "and the number at the right the difference."
    )
    with canvas(9.0, 1.9 + 0.34 * len(budgets)) as (drawing, (axes,)):
        for (colour, label), own, start in zip(LOOKS.values(), shares, starts, strict=True):
            if own.any():
                axes.barh(places, own, left=start, height=0.66, color=colour, label=label)
        axes.plot(shares.sum(axis=0), places, "D", color="white", markeredgecolor="black", markersize=5.0, label="sum",
                  clip_on=False, zorder=3.0)  # fmt: skip
        if missed:
            sizes = [_share(at, at.missed) for at in missed.values()]
            doubts = [_share(at, at.missed_uncertainty) for at in missed.values()]
            axes.barh([*missed], sizes, xerr=doubts, height=0.14, color=MISSED, error_kw={"linewidth": 0.8},
                      label="missed by beam theory: FEA to solid")  # fmt: skip
            caption += " Thin bars: what the beam theories miss together, by the solid."
        axes.axvline(0.0, color="black", linewidth=0.8)
        name_rows(axes, [each.row.probe.name for each in budgets])
        axes.set_xlabel("share of all parts, %")
        for place, each in enumerate(budgets):
            text = percent(each.row.fraction(each.row.difference))
            axes.annotate(text, (1.02, place), xycoords=("axes fraction", "data"), va="center", fontsize=9.0)
        return (finished(drawing, "budget", caption, ("lower center", 4)),)


def _share(budget: Budget, value: float | None) -> float:
    """A size in per cent of all parts together."""
    return 100.0 * (budget.row.fraction(value or 0.0) or 0.0) / budget.all_parts


def _cell(budget: Budget, value: float | None, *, sign: bool = False) -> str:
    """A size in per cent of the row's denominator, without the unit."""
    fraction = None if value is None else budget.row.fraction(value)
    if fraction is None:
        return NOTHING
    mark = "" if not sign or fraction == 0.0 else "−" if fraction < 0.0 else "+"
    return f"{mark}{number(100.0 * abs(fraction))}"

"""Tables, sentences and documented JSON of an error budget."""

from __future__ import annotations

from comparisons.budgets.accounts import Account
from comparisons.budgets.parts import Budget
from comparisons.choices import Count
from comparisons.claims import claim_of
from comparisons.display_units import at_station
from comparisons.formats import number, percent
from comparisons.plain import Plain, plain
from comparisons.present.columns import Table
from cprbm_scene import Scene

_HEADERS = {
    "contact": "contact",
    "links": "links",
    "rest": "rest",
    "elements": "elements",
    "penalty": "penalty",
}
_MOVED = ("displacement", "rotation")
_LISTED = 0.02
"""Share of a difference below which parts are summed in a sentence."""


def sheets_of(account: Account) -> tuple[Table, ...]:
    """The budgets of the last station; none without rows."""
    sheet = _budgets(account)
    return (sheet,) if sheet.rows else ()


def sentences_of(account: Account) -> tuple[str, ...]:
    """Parts of every claimed difference at the last station, or why there is no budget."""
    if account.missing:
        return (f"{account.scene.name} has no error budget: {'; '.join(account.missing)}.",)
    claims = ((each, claim_of(account.scene, each.row)) for each in account.last)
    claimed = tuple(_made_of(account.scene, each) for each, claim in claims if claim and claim.value is None)
    return claimed if account.runs.solid is None else (*claimed, _missed(account))


def data_of(account: Account) -> Plain:
    """Keys for one case of ``converge``: ``budget``, fractions as in ``compare``'s rows, and ``budget_missing``."""
    return {"budget": [_data(each) for each in account.budgets], "budget_missing": list(account.missing)}


def _data(budget: Budget) -> Plain:
    row = budget.row
    return {
        "probe": row.probe.name,
        "stage": row.stage,
        "station": row.station,
        "unit": row.unit,
        "difference": row.fraction(row.difference),
        "parts": {name: row.fraction(part) for name, part in budget.parts.by_name().items()},
        "rest_uncertainty": row.fraction(budget.rest_uncertainty),
        "elements_uncertainty": row.fraction(budget.elements_uncertainty),
        "penalty_off_line": row.fraction(budget.off_line),
        "paper": None if budget.paper is None else row.fraction(budget.paper),
        "curved_beam": None if budget.curved is None else row.fraction(budget.curved),
        "inner_edge_factor": plain(budget.inner_edge),
        **_solid(budget),
        "scale": row.scale,
        "denominator": row.denominator,
    }


def _solid(budget: Budget) -> Plain:
    """What the solid adds to a row, where it was asked and has a value."""
    if budget.missed is None or budget.missed_uncertainty is None:
        return {}
    row = budget.row
    return {"missed": row.fraction(budget.missed), "missed_uncertainty": row.fraction(budget.missed_uncertainty)}


def _budgets(account: Account) -> Table:
    rows = account.last
    chosen = any(budget.parts.contact != 0.0 for budget in rows)
    beside = not chosen and any(budget.paper is not None for budget in rows)
    curved = any(budget.curved for budget in rows)
    solid = any(budget.missed is not None for budget in rows)
    names = [name for name in _HEADERS if chosen or name != "contact"]
    body = []
    for budget in rows:
        has_parts = budget.all_parts > 0.0
        cells = [_cell(budget, budget.row.difference)]
        for name in names:
            cells.append(_cell(budget, getattr(budget.parts, name), sign=True) if has_parts else "–")
            if name == "rest":
                cells.append(_cell(budget, budget.rest_uncertainty) if has_parts else "–")
        cells += [_cell(budget, budget.paper, sign=True)] if beside else []
        cells += [_cell(budget, budget.curved)] if curved else []
        cells += [_cell(budget, budget.missed, sign=True), _cell(budget, budget.missed_uncertainty)] if solid else []
        body.append((budget.row.probe.name, *cells))
    headers = ["probe", "difference"]
    for name in names:
        headers += [_HEADERS[name], "±"] if name == "rest" else [_HEADERS[name]]
    stage = account.scene.stages[-1]
    note = (
        "Per cent of what the case's table has its differences in. The parts sum to the difference; those below zero "
        "make it smaller. Links, elements, penalty: value beside its limit. Rest: between the solvers' limits in "
        f"{account.runs.theory}, and how far these may be off."
    )
    if beside:
        note += " Beside the sum: what paper would add to the difference at the same number of links."
    if curved:
        note += (
            " Curved: what the inner edge of a beam that is curved at rest has more than both solvers' straight-beam "
            "formula says, t/(3R) to first order."
        )
    if solid:
        note += (
            f" Missed: what the beam theories miss together, the limit in {account.runs.theory} less the solid's "
            "extrapolated value, in the same sense, and how far that may be off; with it the sum would lead from the "
            "CPRBM to the solid."
        )
    return Table(
        f"Error budget at {stage.name} {stage.stations[-1]:g} with {_count(account.choices.links)} links and "
        f"{_count(account.choices.elements)} elements per beam, %",
        (
            *headers,
            *(("paper",) if beside else ()),
            *(("curved",) if curved else ()),
            *(("missed", "±") if solid else ()),
        ),
        tuple(body),
        note,
    )


def _cell(budget: Budget, value: float | None, *, sign: bool = False) -> str:
    """A size in per cent of what the row's fractions are of, without the unit."""
    fraction = None if value is None else budget.row.fraction(value)
    if fraction is None:
        return "–"
    return f"{_sign(fraction) if sign else ''}{number(100.0 * abs(fraction))}"


def _count(count: Count) -> str:
    return str(count) if isinstance(count, int) else ",".join(f"{beam}={number}" for beam, number in count.items())


def _sign(fraction: float) -> str:
    return "" if fraction == 0.0 else "−" if fraction < 0.0 else "+"


def _signed(budget: Budget, value: float) -> str:
    return f"{_cell(budget, value, sign=True)} %"


def _made_of(scene: Scene, budget: Budget) -> str:
    row = budget.row
    parts = budget.parts.by_name()
    listed_parts = {name: part for name, part in parts.items() if abs(part) > _LISTED * row.difference}
    listed = ", ".join(f"{_HEADERS[name]} {_signed(budget, part)}" for name, part in listed_parts.items())
    left = sum(part for name, part in parts.items() if name not in listed_parts)
    return (
        f"{row.probe.name} at {at_station(scene, row.stage, row.station)}: our difference of "
        f"{percent(row.fraction(row.difference))} is "
        f"{listed}, and {_signed(budget, left)} for all else."
    )


def _missed(account: Account) -> str:
    """What the solid says of displacements and rotations at the last station."""
    if account.silent:
        return f"The solid says nothing: {account.silent}"
    missed = [each for each in account.last if each.missed is not None and each.row.probe.quantity in _MOVED]
    if not missed:
        return "The solid has no displacement or rotation to hold the beam theories against."
    listed = ", ".join(
        f"{each.row.probe.name} {_cell(each, each.missed, sign=True)} % (± {_cell(each, each.missed_uncertainty)} %)"
        for each in missed
    )
    return f"What the beam theories miss together, beside the sum, by the solid: {listed}."

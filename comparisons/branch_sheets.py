"""What the tables say of branches and of where they end."""

from __future__ import annotations

from comparisons.case import Comparison
from comparisons.display_units import distance_text, load_text, with_unit
from comparisons.formats import number
from comparisons.quantities import load_unit
from comparisons.sheet import Sheet
from comparisons.verdict.events import mechanism, released
from comparisons.verdict.station_events import Place
from cprbm_scene import Answer, Critical, Scene


def of_criticals(compared: Comparison) -> Sheet:
    """Where branches end in both answers."""
    scene, body = compared.scene, []
    for row in compared.criticals:
        bounds = row.bounds
        body.append(
            (
                row.stage if row.place == 0 else f"{row.stage}, {row.place + 1}",
                *(_ends(scene, found, row.unit) for found in (row.cprbm, row.fea)),
                distance_text(scene, row.difference, row.unit),
                distance_text(scene, row.same_theory, row.unit),
                *(
                    ("–", "–", "–")
                    if bounds is None
                    else (distance_text(scene, size, row.unit) for size in (bounds.cprbm, bounds.fea, bounds.theory))
                ),
                distance_text(scene, row.allowed, row.unit),
                *(_released(scene, found) for found in (row.cprbm, row.fea)),
                row.word.value,
            )
        )
    return Sheet(
        "Critical values: where a branch ends",
        (
            "stage",
            "CPRBM",
            "FEA",
            "apart",
            "in bending",
            "u CPRBM",
            "u FEA",
            "theory",
            "allowed",
            "releases CPRBM",
            "FEA",
            "says",
        ),
        tuple(body),
        "Of the load or drive that the stage steps, and how stability is lost; uncertainties from further "
        "discretisations of each solver. What is allowed is asked within bending. Released: what the potential energy "
        "falls by in the jump.",
    )


def of_branches(compared: Comparison) -> Sheet:
    """The verdict branch by branch; nothing where no branch ends."""
    branches = compared.verdict.branches if compared.criticals or len(compared.verdict.branches) > 1 else ()
    body = [
        (
            f"{each.stage}, branch {each.number}",
            " to ".join(load_text(compared.scene, each.stage, value) for value in (each.first, each.last)),
            str(each.stations - each.near),
            str(each.near),
            "takes no part" if each.word is None else each.word.value,
        )
        for each in branches
    ]
    between = dict.fromkeys(row.where for row in compared.rows if row.branch is None)
    for stage in dict.fromkeys(stage for stage, _ in between):
        mine = [value for name, value in between if name == stage]
        values = ", ".join(load_text(compared.scene, stage, value) for value in mine)
        body.append((f"{stage}, {Place.BETWEEN.value}", values, str(len(mine)), "–", "takes no part"))
    return Sheet(
        "Branch by branch",
        ("branch", "stations", "compared", "between events", "says"),
        tuple(body),
        "A branch is compared with the same branch. Stations between the runs' loads of one event take no part.",
    )


def _ends(scene: Scene, critical: Critical | None, unit: str) -> str:
    return "–" if critical is None else f"{with_unit(scene, critical.value, unit, 5)}, {mechanism(critical)}"


def _released(scene: Scene, critical: Critical | None) -> str:
    energy = None if critical is None else released(critical)
    return "–" if energy is None else with_unit(scene, energy, "J", 4)


def of_ends(scene: Scene, answer: Answer) -> Sheet:
    """Where the branches of an answer end, and what it went on over."""
    units = {stage.name: load_unit(scene, stage) for stage in scene.stages}
    over = {id(one.end): f", gone on over: turned by {number(one.turned, 3)} rad" for one in answer.gone_over}
    body = tuple(
        (
            each.stage,
            with_unit(scene, each.value, units[each.stage], 5),
            distance_text(scene, each.uncertainty, units[each.stage]),
            f"{mechanism(each)}{over.get(id(each), '')}",
            number(each.curvature),
            number(each.left),
            _released(scene, each),
        )
        for each in (*(one.end for one in answer.gone_over), *answer.critical)
    )
    return Sheet(
        "Critical values: where a branch ends",
        ("stage", "at", "±", "how", "smallest curvature", "left", "releases"),
        body,
        "The smallest curvature of the energy on the feasible directions as the branch comes to its end, and what is "
        "left of it once something lets go. ±: on this discretisation. Gone on over: to a state so far turned.",
    )

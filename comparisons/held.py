"""What holds at each station of an answer, what changes from one to the next, and stretches in which nothing does."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import groupby

from comparisons.stations import station_of
from cprbm_scene import Answer, Scene, StationAnswer


@dataclass(frozen=True, slots=True)
class Held:
    """A station, the contacts that are closed there and, of those that are asked for, the stops that hold."""

    station: StationAnswer
    contacts: frozenset[str]
    stops: frozenset[str]

    @property
    def all_of_it(self) -> tuple[str, int, frozenset[str], frozenset[str]]:
        """Stage, branch, contacts and stops: what all stations of a stretch have in common."""
        return self.station.stage, self.station.branch, self.contacts, self.stops


def held(scene: Scene, answer: Answer) -> tuple[Held, ...]:
    """Every station of the scene in order.

    Raises:
        KeyError: the answer lacks a station or a stop's moment.
    """
    moments = {probe.of: probe.name for probe in scene.probes if probe.quantity == "moment"}
    found = []
    for stage in scene.stages:
        for value in stage.stations:
            station = station_of(answer, stage.name, value)
            stops = frozenset(stop for stop, moment in moments.items() if station.values[moment].any())
            found.append(Held(station, frozenset(station.touching), stops))
    return tuple(found)


def stretches(every: Sequence[Held]) -> tuple[tuple[Held, ...], ...]:
    """The stations cut where a stage or a branch ends, or a contact or a stop changes."""
    return tuple(tuple(mine) for _, mine in groupby(every, key=lambda each: each.all_of_it))


def changes(scene: Scene, every: Sequence[Held], here: int, beside: Sequence[StationAnswer] = ()) -> tuple[str, ...]:
    """Contacts and stops that are not in one state from the station before one to the one after, and ``beside`` it.

    Before the first station nothing is loaded, and no contact presses; of a scene that is assembled first that is not
    known, and nothing is said of it.
    """
    around = list(every[max(here - 1, 0) : here + 2])
    nothing = frozenset[str]()
    contacts = [*(each.contacts for each in around), *(frozenset(station.touching) for station in beside)]
    stops = [each.stops for each in around]
    if here == 0 and scene.assembly is None:
        contacts.append(nothing)
        stops.append(nothing)
    changing = [frozenset.union(*states) - frozenset.intersection(*states) for states in (contacts, stops)]
    return tuple(sorted(frozenset.union(*changing)))

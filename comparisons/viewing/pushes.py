"""Contact forces at a station, as far as the answer says where and how each acts."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from cprbm_scene import Scene, StationAnswer
from cprbm_scene.answer import Array
from cprbm_scene.statement import SelfContact


@dataclass(frozen=True, slots=True)
class Push:
    """Forces of one contact ``on`` a beam or body: where they press, m (k, 2), and what they are, N (k, 2)."""

    contact: str
    on: str
    places: Array
    forces: Array

    @property
    def resultant(self) -> Array:
        """Their sum (2,), N."""
        return np.asarray(self.forces.sum(axis=0))

    @property
    def middle(self) -> Array:
        """The one of their places (2,), m, that is nearest to the mean of all, weighed by their size."""
        weight = np.hypot(self.forces[:, 0], self.forces[:, 1])
        away = self.places - weight @ self.places / weight.sum()
        return np.asarray(self.places[np.argmin(np.hypot(away[:, 0], away[:, 1]))])


def pushes_at(scene: Scene, station: StationAnswer) -> list[Push]:
    """The forces of closed contacts, at the edges on which they press; none where the answer does not say them."""
    return list(_pushes(scene, station))


def _pushes(scene: Scene, station: StationAnswer) -> Iterator[Push]:
    forces = station.forces
    size, source, target = np.hypot(*forces.force.T), np.array(forces.source), np.array(forces.target)
    for name, contact in scene.contacts.items():
        acting = (source == name) & (size > 0.0)
        for on in dict.fromkeys(target[acting].tolist()):
            mine = np.flatnonzero(acting & (target == on))
            places, pressing = forces.place[mine], forces.force[mine]
            if contact.thick and on in scene.beams:  # the answer states places on the neutral line
                beam, line = scene.beams[on], station.shapes[on]
                t = beam.thickness_at(forces.s[mine] / line.s[-1])
                places = places - 0.5 * t[:, None] * pressing / size[mine, None]
            parts = [np.arange(len(mine))]
            if isinstance(contact, SelfContact) and len(mine) > 1:  # of two places of one beam
                along = np.argsort(forces.s[mine], kind="stable")
                parts = np.split(along, [int(np.argmax(np.diff(forces.s[mine][along]))) + 1])
            for part in parts:
                yield Push(name, on, places[part], pressing[part])

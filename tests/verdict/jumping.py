"""A made-up solver with ends of branches: a driven crank jumps forwards at 70.4° and back at 25.3°.

Before the jump the moment is M = sin α + C/N², and the energy the integral of M; on another branch both are smaller.
Numbers follow the law of :class:`tests.verdict.made_up.MadeUp`: an error C/N² and a step per theory.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import cos, radians, sin

import numpy as np

from comparisons.choices import Choices
from comparisons.geometry import length
from cprbm_scene import Answer, Critical, Ending, GoneOver, Loss, PinnedEnd, Scene, Shape, StationAnswer
from cprbm_scene.answer import ContactState, frozen_array
from cprbm_scene.frozendict import frozendict
from cprbm_scene.statement import TurningBody
from tests.verdict.made_up import THEORY, MadeUp

FORWARD, BACK = radians(70.4), radians(25.3)
"""Ends of the first branch forwards and of the second branch on the way back, rad."""

U = np.linspace(0.0, 1.0, 41)
HERMITE = np.stack((2.0 * U**3 - 3.0 * U**2 + 1.0, U**3 - 2.0 * U**2 + U, 3.0 * U**2 - 2.0 * U**3, U**3 - U**2))
"""Cubic shares (4, 41) of the place and the tangent at the start, and of both at the end."""

FALL = 0.3
"""Released energy of a jump forwards, J."""


@dataclass(frozen=True)
class Jumping:
    """Answer function of a solver.

    Attributes:
        solver: name; error: C/N² at N = 40 of all values, relative; critical_error: of the critical angles, rad.
        late: shift of the critical angles in every run, rad; loss, what: mechanism of the critical points.
        jumps: whether there are critical points; stops: whether the answer ends at the first.
        over: rotation of the state behind a critical point that the answer passes, rad; 0 if it jumps there.
        lands: relative change of all values behind a passed critical point.
        side: -1 for the mirror image behind a critical point, else 1.
    """

    solver: str
    error: float = 1e-3
    critical_error: float = 1e-4
    late: float = 0.0
    loss: Loss = Loss.FOLD
    what: str = ""
    jumps: bool = True
    stops: bool = False
    over: float = 0.0
    lands: float = 0.0
    side: float = 1.0
    stiffness: float = 1.0

    def __call__(self, scene: Scene, choices: Choices) -> Answer:
        count = choices.links if self.solver == "cprbm" else choices.elements
        n = count if isinstance(count, int) else min(count.values())
        theory = THEORY[choices.theory_of(scene) if self.solver == "cprbm" else choices.kinematics_of(scene)]
        factor = (1.0 + self.error * (40.0 / n) ** 2 + theory) / self.stiffness
        shift = self.late + self.critical_error * (40.0 / n) ** 2 + 0.1 * theory
        base = MadeUp(self.solver, 0.0, contact=False)(scene, choices)
        stations: list[StationAnswer] = []
        critical: list[Critical] = []
        gone: list[GoneOver] = []
        last = 0.0
        for station in base.stations:
            at = self._passed(last, station.value, shift, away=len([*critical, *gone]) % 2 == 1)
            if at is not None:
                end = Critical(station.stage, at, 1e-6, self.loss, self.what, 1e-7, -0.1, 1.0, 1.0 - FALL)
                if self.over and not self.stops:
                    gone.append(GoneOver(end, self.over))
                else:
                    critical.append(replace(end, after=None) if self.stops else end)
                if self.stops:
                    break
            off = factor * (1.0 + self.lands * len(gone))
            there = self._station(scene, station, off, len([*critical, *gone]))
            stations.append(replace(there, branch=len(critical)))
            last = station.value
        ending = Ending.BRANCH_ENDS if len(stations) < len(base.stations) else Ending.COMPLETED
        ends = {"critical": tuple(critical), "gone_over": tuple(gone)}
        return replace(base, stations=tuple(stations), ending=ending, events=(), **ends)

    def _passed(self, last: float, value: float, shift: float, *, away: bool) -> float | None:
        """The critical value between two stations: of the way forwards before the jump, of the way back behind."""
        end = BACK - shift if away else FORWARD + shift
        passed = value <= end < last if away else last < end <= value
        return end if self.jumps and passed else None

    def _station(self, scene: Scene, station: StationAnswer, factor: float, branch: int) -> StationAnswer:
        alpha, away = station.value, branch % 2
        moment = factor * (sin(alpha) - 0.6 * away * sin(2.0 * alpha))
        energy = factor * (1.0 - cos(alpha) - FALL * away * (1.0 - cos(2.0 * alpha)))
        values = dict(station.values)
        image = self.side < 0.0 and branch > 0
        for probe in scene.probes:
            if probe.quantity == "reaction_moment":
                values[probe.name] = frozen_array([-moment if image else moment])
            elif probe.quantity == "potential_energy":
                values[probe.name] = frozen_array([energy])
            elif probe.quantity == "moment":
                values[probe.name] = frozen_array([0.1 * factor * away])
            elif probe.quantity == "angle":
                values[probe.name] = frozen_array([0.7854 - 0.1 * factor * alpha])
            elif probe.quantity == "bending_stress":
                s = np.linspace(0.0, 1.0, probe.points)
                values[probe.name] = frozen_array(1e8 * factor * (1.0 + alpha - away) * np.cos(2.0 * s))
        shapes = _shapes(scene, alpha, (away + image) % 2)
        middle = next(iter(shapes.values()))
        touching = {name: frozen_array([[middle.x[9], middle.y[9]]]) for name in scene.contacts}
        return replace(
            station,
            values=frozendict(values),
            branch=branch,
            shapes=frozendict(shapes),
            touching=frozendict(touching),
            contacts=frozendict({name: ContactState(True, places) for name, places in touching.items()}),
        )


def _shapes(scene: Scene, alpha: float, away: int) -> dict[str, Shape]:
    """Cubic curves from the starts of the beams to the pins on the crank; the side of the bulge changes at the jump."""
    turn = np.array([[cos(alpha), -sin(alpha)], [sin(alpha), cos(alpha)]])
    found = {}
    for place, (name, beam) in enumerate(scene.beams.items()):
        assert isinstance(beam.end, PinnedEnd)
        crank = scene.bodies[scene.body_of(beam.end.point)]
        assert isinstance(crank, TurningBody)
        start, pivot = np.array(beam.curve.start), np.array(crank.points[crank.about])
        end = pivot + turn @ (np.array(crank.points[beam.end.point]) - pivot)
        leaves = length(beam.curve) * np.array([0.0, 1.3])
        arrives = turn @ np.array([0.08, 0.03]) * (1.0 - 2.0 * ((place + away) % 2 == 0))
        x, y = np.stack((start, leaves, end, arrives), axis=1) @ HERMITE
        s = length(beam.curve) * U
        found[name] = Shape(frozen_array(s), frozen_array(x), frozen_array(y))
    return found

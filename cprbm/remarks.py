"""What a reader of an answer should know besides its numbers.

Where no mesh that is fitted to a station's contacts has a certified state, the one on even elements stands: as
believable, but its error changes with where in their elements the contacts end, and two of them say less of it.

Of the formulation ``paper``: what that form leaves out.  A joint next to the beam's own pin holds a chord
(:mod:`cprbm.rigid_edge`): first order in 1/N.  A polynomial of one degree misses the points that it is fitted to,
however many they are: an error that stays as N grows.  And it is fitted along an axis, so that its forces do not
balance those on the joints that press it (:mod:`cprbm.boundary`).
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from cprbm.boundary import FittedBoundary
from cprbm.following import pressing
from cprbm.forces import contact_imbalance
from cprbm.mechanism import Mechanism
from cprbm.point import Point
from cprbm.rigid_edge import RigidEdge


@dataclass
class Remarks:
    """What was seen at the stations so far.

    Attributes:
        beside_pins: where a joint first pressed next to the beam's own pin, by contact.
        even: stations on even elements though there is contact, in order.
        passed: ends of branches beside which the march went on, in order.
        misfits: the most by which a polynomial missed its points, and where, by contact; units of length.
    """

    beside_pins: dict[str, str] = field(default_factory=dict)
    even: list[str] = field(default_factory=list)
    passed: list[str] = field(default_factory=list)
    misfits: dict[str, tuple[float, str]] = field(default_factory=dict)

    def look(self, mechanism: Mechanism, point: Point, where: str) -> None:
        """Look at a station, which is known as ``where``."""
        for name in sorted(pressing(point) & mechanism.boundaries.keys()):
            boundary = mechanism.boundaries[name]
            if isinstance(boundary, RigidEdge) and boundary.presses_beside_own_pin(point):
                self.beside_pins.setdefault(name, where)
            if isinstance(boundary, FittedBoundary) and boundary.approximates:
                now = (boundary.misfit(point.state, point.at), where)
                self.misfits[name] = max(now, self.misfits.get(name, now), key=lambda seen: seen[0])

    def told(self, mechanism: Mechanism, point: Point) -> list[str]:
        """Sentences of all that was seen, and of where the boundaries near by are at the last ``point``."""
        unit = mechanism.problem.model.unit_length
        said = [
            f"in contact '{name}', from {first} on, the joint next to the beam's own pin presses: it holds the chord "
            "there and not the tangent, so that energy and moments are of first order in 1/N and its force grows with N"
            for name, first in self.beside_pins.items()
        ]
        if self.even:
            said.append(
                f"at {', '.join(self.even)} no mesh fitted to where contact is had a certified state: the values are "
                "of even elements, and their error changes unevenly with the number of links"
            )
        said += [
            f"the branch ends, {end}, and was left for the state beside it to which the decrease of the energy leads"
            for end in self.passed
        ]
        said += [
            f"in contact '{name}' the polynomial misses the points that it is fitted to by up to {most * unit:.1e} m, "
            f"at {where}: more links do not take that away"
            for name, (most, where) in self.misfits.items()
        ]
        near = mechanism.near(point.state, point.at) if mechanism.boundaries else []
        for name in near:
            boundary = mechanism.boundaries[name]
            if not isinstance(boundary, FittedBoundary):
                continue
            own = contact_imbalance(mechanism.problem, point, name)
            said.append(
                f"in contact '{name}' forces on the fitted boundary's points and on the joints that press it leave a "
                f"moment of {own:.1e} of the largest; the formulation has no rotational invariance"
            )
            beyond = boundary.range_left(point.state, point.at)
            if np.any(beyond > 0.0):
                farthest = float(beyond.max()) * unit
                said.append(
                    f"in contact '{name}' {np.sum(beyond > 0.0)} of {len(beyond)} related joints lie beyond the fitted "
                    f"boundary's ends, by up to {farthest:.2g} m, where it is continued; none of them presses"
                )
        return said

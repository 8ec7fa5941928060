"""Inspection of the stations of the formulation ``paper``: beams that have crossed, and notes on the form's own errors.

Joints of a zone dip by a part of h², and joints beyond the related range are free.  An overlap of more than half the
mean thickness anywhere is a crossing: no related joint holds the beams apart there.

The notes name errors that the form itself leaves:

* A joint beside the beam's own pin holds the chord of the half link: first order in 1/N.  The force of the last joint
  flattens the beam over half an element, and grows with N without limit.
* A polynomial of one degree misses the points: an error that stays as N grows.
* The fit along an axis has no rotational invariance: the forces of a contact leave a moment.
* The boundary is continued beyond the ends.
"""

import numpy as np

from cprbm.chain import Mechanism, ends_of
from cprbm.contact import Geometry, fixed_places, near_pairs, new_counters, settle, sides_at_rest
from cprbm.equilibrium import Solved, contact_terms
from cprbm.paper.contacts import FittedLaw, beyond_ends
from cprbm.paper.fit import Boundary, fitted
from cprbm_scene.answer import Array
from cprbm_scene.statement import EdgeContact, PinnedEnd

OVERLAP = 0.5
"""Allowed overlap over the mean thickness, of two lines over the longest beam."""

THINNEST = 1e-3
"""Least thickness, over the longest beam, by which an overlap with a rigid shape is measured."""

SAG = 0.25
"""Distance of a beam from the chord, over the link's length and the turn of the joint: twice the sag of an arc."""


class Inspection:
    """What the stations of a run show.

    Attributes:
        geometry, sides: all joints of the beams in contact, and the sides as drawn.
        beside_pins: by contact the station at which a joint beside an own pin first pressed.
        misfits: by contact the largest misfit, m, and the station.
    """

    def __init__(self, m: Mechanism, geometry: Geometry) -> None:
        """Of a mechanism with all rows and the ``geometry`` of all joints."""
        self.geometry = geometry
        self.sides = sides_at_rest(geometry, np.concatenate([m.rest, np.zeros(len(m.rows))]), new_counters())
        self.beside_pins = dict[str, str]()
        self.misfits = dict[str, tuple[float, str]]()

    def crossed(self, solved: Solved) -> str:
        """Sentence on a contact whose beams have crossed; empty without such a contact."""
        z, counters = solved.state.z, new_counters()
        arrays, pairs = self.geometry.arrays, self.geometry.sites.columns
        near = near_pairs(z, arrays, pairs, 0.0, counters)
        places = fixed_places(self.geometry, z, self.sides, near, counters)
        gaps = np.empty(len(places.pair))
        settle(z, arrays, places, gaps, np.empty(len(gaps)), counters, 0)
        rigid, angles = self.geometry.sites.rigid[places.other], z[solved.system.angles]
        before = solved.system.joints.before
        sag = SAG * float(solved.system.metric.max() * np.abs(angles[before + 1] - angles[before]).max())
        thickness = arrays.thickness[places.piece] + arrays.thickness[places.foot] * ~rigid
        least = np.where(rigid, THINNEST, np.where(thickness > 0.0, 0.0, 1.0))
        overlap = (-gaps - sag) / np.maximum(thickness, least)
        if not len(overlap) or overlap.max() <= OVERLAP:
            return ""
        name = self.geometry.pairs[int(places.pair[np.argmax(overlap)])].name
        return f"in contact '{name}' the beams overlap by {overlap.max():.1e} of the mean thickness, allowed {OVERLAP}"

    def look(self, solved: Solved, where: str) -> None:
        """Look at a station, called ``where``."""
        unit = solved.system.mechanism.units.length
        for name in _beside_pins(solved):
            self.beside_pins.setdefault(name, where)
        for boundary, name, _ in _pressed_boundaries(solved):
            if boundary.degree + 1 < len(boundary.points):
                fit = fitted(solved.state.z, boundary)
                misfit = float(np.abs(fit.V[0] @ fit.q - fit.points[1]).max()) * unit, where
                self.misfits[name] = max(misfit, self.misfits.get(name, misfit))

    def sentences(self, solved: Solved) -> list[str]:
        """Sentences on all stations, and on the boundaries at the last state."""
        said = [
            f"in contact '{name}', from {first} on, the joint next to the beam's own pin presses: it holds the chord "
            "there and not the tangent, so that energy and moments are of first order in 1/N and its force grows with N"
            for name, first in self.beside_pins.items()
        ]
        said += [
            f"in contact '{name}' the polynomial misses the points that it is fitted to by up to {distance:.1e} "
            f"m, at {where}: more links do not take that away"
            for name, (distance, where) in self.misfits.items()
        ]
        z, unit = solved.state.z, solved.system.mechanism.units.length
        for boundary, name, pull in _pressed_boundaries(solved):
            said.append(
                f"in contact '{name}' forces on the fitted boundary's points and on the joints that press it leave a "
                f"moment of {_left_moment(solved, pull):.1e} of the largest; the formulation has no rotational "
                "invariance"
            )
            beyond = beyond_ends(z, boundary)
            if np.any(beyond > 0.0):
                said.append(
                    f"in contact '{name}' {np.sum(beyond > 0.0)} of {len(beyond)} related joints lie beyond the fitted "
                    f"boundary's ends, by up to {float(beyond.max()) * unit:.2g} m, where it is continued; none of "
                    "them presses"
                )
        return said


def _beside_pins(solved: Solved) -> list[str]:
    """Contacts with a rigid edge whose joint beside the beam's own pin presses."""
    geometry, contacts, m = solved.system.geometry, solved.state.contacts, solved.system.mechanism
    found: list[str] = []
    for number, pair in enumerate(geometry.pairs):
        record = m.scene.contacts[pair.name]
        if isinstance(record, EdgeContact):
            ends = zip((1, m.chains[record.beam].links - 1), ends_of(m.scene, record.beam), strict=True)
            pinned = [(joint, end.point) for joint, end in ends if isinstance(end, PinnedEnd)]
            beside = [joint for joint, point in pinned if m.scene.body_of(point) == record.body]
            joints = contacts.places.piece[contacts.pressing(number)] - geometry.arrays.first[pair.first]
            found += [pair.name] if np.isin(joints, beside).any() else []
    return found


def _pressed_boundaries(solved: Solved) -> list[tuple[Boundary, str, Array]]:
    """Boundaries with closed joints, names of the contacts, and gradients (size,) of the contacts' −F λ."""
    geometry, contacts = solved.system.geometry, solved.state.contacts
    if not isinstance(geometry.law, FittedLaw):
        return []
    found = []
    for pair, boundary in geometry.law.boundaries.items():
        closed = contacts.pressing(pair)
        if closed.any():
            pull = contact_terms(geometry, solved.state.z, contacts.places, closed)[1]
            found.append((boundary, geometry.pairs[pair].name, pull))
    return found


def _left_moment(solved: Solved, pull: Array) -> float:
    """Moment of all forces of a contact together, over the largest force or moment of a joint or a load."""
    system, z = solved.system, solved.state.z
    x, y = system.nodes.T
    moment = float(z[x] @ pull[y] - z[y] @ pull[x] + pull[system.angles].sum())
    return abs(moment) / float(np.abs(solved.state.multipliers(system)).max())

"""Contacts of the formulation ``paper``: related joints as places, and the law of fitted boundaries.

Contact with a rigid shape has rows at the related joints, with the distance from the shape as the gap.  The paper's
eq. (11) measures along an axis; both say that the joint is outside, and give the same force.  The distance is defined
beside the shape too.  A joint beside an own pin holds the chord of the half link and replaces the angle stop.

Contact of two beams has rows at the related joints of one beam against the boundary fitted to the other beam.

Related joints are joints of a beam with possible contact, by the place at rest.  The paper draws the boundary's beam
with an offset towards the other beam.  The nearest related joints at rest show the side of the offset, and the side of
the boundary on which the joints stay.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from cprbm.chain import Mechanism
from cprbm.contact import Columns, Geometry, Places, places_at
from cprbm.equilibrium import contact_columns
from cprbm.paper.fit import Boundary, basis_of, fitted, fitted_columns, fitted_gaps
from cprbm_scene import BeamContact, LineContact, Mistake, Scene, SceneError, SelfContact
from cprbm_scene.answer import Array, Flags, Ints
from cprbm_scene.clearance import overlap_at_rest
from cprbm_scene.mistakes import refuse_broken

FEWEST_POINTS = 3
"""Related joints of either beam."""


BEYOND = 0.5
"""Elements beyond the ends of a boundary, which is continued there, within which a joint may press."""


def fitted_boundary(m: Mechanism, name: str, degree: int) -> tuple[Boundary, str]:
    """Boundary of a contact of two beams, and the name of the other beam, whose joints are constrained.

    Args:
        m: the mechanism, of the plain chain.
        name: of the contact.
        degree: of the polynomial; lowered to the number of points less one.

    Raises:
        SceneError: the scene lacks the boundary's beam, has too few related joints, or a needed thickness varies.
    """
    contact, scene = m.scene.contacts[name], m.scene
    assert isinstance(contact, BeamContact)
    hints = contact.paper
    if hints is None:
        allowed = "the boundary's beam and the axis, which the formulation 'paper' needs"
        raise SceneError([Mistake(f"contacts.{name}.paper", "nothing", allowed, scene.file)])
    refuse_broken(
        *(
            Mistake(
                f"contacts.{name}.thick",
                f"contact of two beams by the edges of {beam!r}, whose thickness varies",
                "thick = false, a beam of one thickness, or the formulation 'auto'",
                scene.file,
            )
            for beam in contact.between
            if contact.thick and scene.beams[beam].tapered
        )
    )
    other = next(beam for beam in contact.between if beam != hints.boundary)
    points = related_joints(m, name, hints.boundary, FEWEST_POINTS)
    joints = related_joints(m, name, other, FEWEST_POINTS)
    carrier, held = m.chains[hints.boundary], m.chains[other]
    apart = held.nodes[joints][:, None] - carrier.nodes[points]
    nearest = divmod(int(np.argmin((apart**2).sum(axis=2))), len(points))
    gap, point = apart[nearest], int(points[nearest[1]])
    tangent = 0.5 * (carrier.link_angle[point - 1] + carrier.link_angle[point])
    along = "yx".index(hints.axis)
    left = np.cos(tangent) * gap[1] - np.sin(tangent) * gap[0] > 0.0
    thickness = [float(chain.section.thickness(chain.arcs[:1])[0]) for chain in (carrier, held)]
    offset = 0.5 * sum(thickness) if contact.thick else 0.0
    offset -= overlap_at_rest(scene, contact) / m.units.length
    boundary = Boundary(
        along=along,
        sense=1.0 if gap[1 - along] > 0.0 else -1.0,
        offset=offset if left else -offset,
        degree=min(degree, len(points) - 1),
        joints=m.beam_nodes(other)[joints],
        points=m.beam_nodes(hints.boundary)[points],
        angles=m.beam_angles(hints.boundary)[points[0] - 1 : points[-1] + 1],
    )
    return boundary, other


def related_joints(m: Mechanism, contact: str, beam: str, fewest: int) -> Ints:
    """Numbers (1 to N) of the joints of a beam within the related range of a contact; the beam's ends are no joints.

    Args:
        m: the mechanism.
        contact, beam: names.
        fewest: least number of joints.

    Raises:
        SceneError: the range holds fewer joints, or two separate parts of the beam.
    """
    hints, chain = m.scene.contacts[contact].paper, m.chains[beam]
    key = f"contacts.{contact}.paper.related.{beam}"
    related = None if hints is None else hints.related.get(beam)
    joints = np.arange(1, chain.links)
    if related is not None:
        axis, (low, high) = ("x", related.x) if related.x is not None else ("y", related.y or (-np.inf, np.inf))
        along = (chain.nodes[1:-1] * m.units.length + m.units.origin)[:, "xy".index(axis)]
        joints = joints[(along >= low) & (along <= high)]
        found, allowed = "a range that holds two separate parts of the beam", "a range that holds one part"
        refuse_broken(np.any(np.diff(joints) > 1) and Mistake(key, found, allowed, m.scene.file))
    found = f"{len(joints)} related joints of {beam} at {chain.links - 1} links"
    allowed = f"at least {fewest}: a wider range or more links"
    refuse_broken(len(joints) < fewest and Mistake(key, found, allowed, m.scene.file))
    return joints.astype(np.int64)


@dataclass(frozen=True, eq=False)
class FittedLaw:
    """Law of the fitted boundaries.

    Attributes:
        boundaries: by the numbers of the pairs.
        geometry: curves and pairs.
        beyond: distance beyond the ends of a boundary within which a joint may press, in units.
        unit: of length, m.
    """

    boundaries: Mapping[int, Boundary]
    geometry: Geometry
    beyond: float
    unit: float

    def measures(self, places: Places) -> Flags:
        """Places of the law's pairs."""
        return np.asarray((places.pair[:, None] == np.array(list(self.boundaries))).any(axis=1))

    def write_gaps(self, z: Array, places: Places, gaps: Array) -> None:
        """Write the gaps of the law's places at a state; a foot on a fitted boundary is no point."""
        for pair, boundary in self.boundaries.items():
            mine = places.pair == pair
            if mine.any():
                gaps[mine], places.at_point[mine] = fitted_gaps(z, boundary), False

    def columns(self, z: Array, places: Places, closed: Flags, gradient: Array) -> Columns:
        """Columns of all places marked ``closed``; adds the gradient of all −F λ to ``gradient``."""
        found = contact_columns(z, self.geometry.arrays, places, closed & ~self.measures(places), gradient)
        for pair, boundary in self.boundaries.items():
            mine = places.pair == pair
            if closed[mine].any():
                found = _joined(found, fitted_columns(z, boundary, places.force[mine], closed[mine], gradient))
        return found

    def force(self, z: Array, places: Places, k: int) -> Array:
        """Force (2,) on a constrained joint, normal to the boundary."""
        boundary = self.boundaries[int(places.pair[k])]
        j = int(np.count_nonzero(places.pair[:k] == places.pair[k]))
        fit, force, a = fitted(z, boundary), np.ones(2), z[[boundary.joints[j] + boundary.along]]
        force[boundary.along] = -(basis_of(a, fit.middle, fit.width, boundary.degree)[1] @ fit.q).item()
        return np.asarray(boundary.sense * places.force[k] * force)

    def invalid(self, z: Array, places: Places, closed: Flags) -> str:
        """Sentence on a joint that presses beyond the ends of the boundary; empty without such a joint."""
        for pair, boundary in self.boundaries.items():
            mine = np.flatnonzero(places.pair == pair)
            pressing = closed[mine] & (places.force[mine] > 0.0)
            beyond = np.where(pressing, beyond_ends(z, boundary), -np.inf) if pressing.any() else np.full(1, -np.inf)
            if beyond.max() > self.beyond:
                worst, curve = mine[np.argmax(beyond)], places.curve[mine[0]]
                number = places.piece[worst] - self.geometry.arrays.first[curve]
                return (
                    f"in contact '{self.geometry.pairs[pair].name}' joint {number} of "
                    f"{self.geometry.curves[curve].beam} presses {beyond.max() * self.unit:.2g} m beyond the end of "
                    "the range of the fitted polynomial"
                )
        return ""


def beyond_ends(z: Array, boundary: Boundary) -> Array:
    """Distances (joints,) of the constrained joints beyond the ends of a fitted boundary, negative between the ends."""
    A, a = fitted(z, boundary).points[0], z[boundary.joints + boundary.along]
    return np.asarray(np.maximum(a - A.max(), A.min() - a))


def paper_geometry(m: Mechanism, every: Geometry, degree: int) -> Geometry:
    """Geometry of a mechanism's contacts in the formulation ``paper``, from the geometry of all joints.

    Removes the angle stops at own pins from the mechanism's rows.

    Raises:
        SceneError: the formulation has no form for a contact, or lacks data.
    """
    pins = {f"{contact}.pin" for contact in m.scene.contacts}
    m.rows[:] = [row for row in m.rows if row.name not in pins]
    boundaries, pairs, rows, fitted_rows = dict[int, Boundary](), list(every.pairs), [], []
    for number, pair in enumerate(every.pairs):
        contact = m.scene.contacts[pair.name]
        if isinstance(contact, BeamContact):
            boundaries[number], beam = fitted_boundary(m, pair.name, degree)
            joints = np.searchsorted(m.beam_nodes(beam), boundaries[number].joints)
            own, other = (pair.first, pair.second) if beam == contact.between[0] else (pair.second, pair.first)
            fitted_rows += [(number, own, other, joint) for joint in joints.tolist()]
            pairs[number] = replace(pair, side=1)
        else:
            joints = related_joints(m, pair.name, contact.beams[0], fewest=1)
            rows += [(number, pair.first, pair.second, joint) for joint in joints.tolist()]
    longest = max(float(np.max(np.diff(chain.borders))) for chain in m.chains.values())
    law = FittedLaw(boundaries, every, BEYOND * longest, m.units.length) if boundaries else None
    possible = places_at(every.arrays, np.array(rows + fitted_rows, dtype=np.int64))
    sites = every.sites._replace(possible=possible, sharing=np.zeros_like(every.sites.sharing))
    return replace(every, pairs=pairs, sites=sites, law=law, joints_alone=True)


def refuse_contacts(scene: Scene) -> None:
    """Refuse contacts for which the paper has no form.

    Raises:
        SceneError: a beam touches itself, or a line has a convex corner on the beam's side.
    """
    refuse_broken(
        *(
            Mistake(
                f"contacts.{name}.kind",
                repr(contact.kind),
                "a kind that the formulation 'paper' offers, or the formulation 'auto'",
                scene.file,
            )
            for name, contact in scene.contacts.items()
            if isinstance(contact, SelfContact)
        ),
        *(
            Mistake(
                f"contacts.{name}.points",
                "a line with a corner that stands out, which presses a beam between its joints",
                "a line without such a corner, or the formulation 'auto'",
                scene.file,
            )
            for name, contact in scene.contacts.items()
            if isinstance(contact, LineContact) and _has_convex_corner(contact)
        ),
    )


def _has_convex_corner(line: LineContact) -> bool:
    """True if a corner of a line stands out on the side of the beam."""
    x, y = np.diff(np.array(line.points), axis=0).T
    turns = x[:-1] * y[1:] - y[:-1] * x[1:]
    return bool(np.any(turns < 0.0 if line.side == "left" else turns > 0.0))


def _joined(one: Columns, other: Columns) -> Columns:
    """Columns of both, forces first."""
    forces, more = len(one.values), len(other.values)
    first = np.where(one.entry_column < forces, one.entry_column, one.entry_column + more)
    second = other.entry_column + np.where(other.entry_column < more, forces, len(one.diagonal))

    def both(own: Array, others: Array) -> Array:
        return np.concatenate([own[:forces], others[:more], own[forces:], others[more:]])

    return Columns(
        values=np.concatenate([one.values, other.values]),
        negative=one.negative + other.negative,
        diagonal=both(one.diagonal, other.diagonal),
        beside=both(one.beside, other.beside),
        entry_column=np.concatenate([first, second]),
        entry_index=np.concatenate([one.entry_index, other.entry_index]),
        entry_value=np.concatenate([one.entry_value, other.entry_value]),
    )

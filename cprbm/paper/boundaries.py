"""The paper's related joints, and the boundaries fitted to them in contacts of two beams.

Related joints are joints of a beam with possible contact, by the place at rest.

The paper draws the boundary's beam with an offset towards the other beam.  The nearest related
joints at rest show the side of the offset, and the side of the boundary on which the joints stay.
"""

from __future__ import annotations

import numpy as np

from cprbm.chain import Mechanism
from cprbm.paper.fit import Boundary
from cprbm_scene import BeamContact, Mistake, SceneError
from cprbm_scene.answer import Ints
from cprbm_scene.clearance import overlap_at_rest

FEWEST_POINTS = 3
"""Related joints of either beam."""


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
    for beam in contact.between:
        if contact.thick and scene.beams[beam].tapered:
            found = f"contact of two beams by the edges of {beam!r}, whose thickness varies"
            allowed = "thick = false, a beam of one thickness, or the formulation 'auto'"
            raise SceneError([Mistake(f"contacts.{name}.thick", found, allowed, scene.file)])
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
        if len(joints) and joints[-1] - joints[0] >= len(joints):
            found = "a range that holds two separate parts of the beam"
            raise SceneError([Mistake(key, found, "a range that holds one part", m.scene.file)])
    if len(joints) < fewest:
        found = f"{len(joints)} related joints of {beam} at {chain.links - 1} links"
        raise SceneError([Mistake(key, found, f"at least {fewest}: a wider range or more links", m.scene.file)])
    return joints.astype(np.int64)

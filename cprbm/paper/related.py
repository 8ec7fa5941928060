"""The paper's related joints: joints of a beam with possible contact, by their place at rest."""

from __future__ import annotations

import numpy as np

from cprbm.chain import Mechanism
from cprbm_scene import Mistake, SceneError
from cprbm_scene.answer import Ints


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

"""The paper's related joints: those of a beam that a contact holds, by their initial place."""

from __future__ import annotations

import numpy as np

from cprbm.model import Chain
from cprbm_scene import Mistake, Scene, SceneError
from cprbm_scene.answer import Ints


def related_joints(scene: Scene, contact: str, chain: Chain, fewest: int) -> Ints:
    """The spring joints (1..N) of a beam that lie in a contact's related range; the beam's ends are never among them.

    Raises:
        SceneError: there are less than ``fewest``, or they are not neighbours.
    """
    hints = scene.contacts[contact].paper
    key = f"contacts.{contact}.paper.related.{chain.name}"
    related = None if hints is None else hints.related.get(chain.name)
    inner = np.arange(1, chain.n + 1)
    if related is not None:
        low, high = related.x or related.y or (-np.inf, np.inf)
        springs, line = chain.springs, chain.line
        along = line.x0 + springs.x if related.x is not None else line.y0 + springs.y
        inner = inner[(along >= low) & (along <= high)]
        if inner.size and inner[-1] - inner[0] >= inner.size:
            found = "a range that holds two separate parts of the beam"
            raise SceneError([Mistake(key, found, "a range that holds one", scene.file)])
    if len(inner) < fewest:
        found = f"{len(inner)} related joints of {chain.name} at {chain.n} links"
        raise SceneError([Mistake(key, found, f"at least {fewest}: a wider range or more links", scene.file)])
    return inner.astype(np.intp)

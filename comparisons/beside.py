"""Contacts that press a beam within an element of its own joint: what their force is there, no mesh tells.

======  ==================================================================================
symbol  meaning
======  ==================================================================================
M       the moment with which joint and contact together turn the beam beside the joint
d, F    distance of the contact's force from the joint, and the force
======  ==================================================================================

A beam that is held on what it lies on is pressed flat from its joint on.  Up to the value at which it begins to lie
flat the joint, or its stop, gives M as a couple, and the contact has no force; from there on the force at the end of
what lies flat is that of the whole beam, however short d is.  Elements longer than d can not tell the one from the
other.  What mechanics determines, and every mesh has, is the sum of the forces of joint and contact.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from comparisons.shared import NOTHING, exerted
from cprbm_scene import FreeEnd, Scene, StationAnswer
from cprbm_scene.answer import Inside
from cprbm_scene.statement import RigidContact


def joint_beside(scene: Scene, stations: Iterable[StationAnswer], name: str) -> str | None:
    """The point of a joint of its beam within an element of which alone a rigid contact presses in some answer."""
    contact = scene.contacts[name]
    if not isinstance(contact, RigidContact):
        return None
    beam = scene.beams[contact.beam]
    for station in stations:
        if station.statics is None or not isinstance(inside := station.statics.inside[contact.beam], Inside):
            continue
        mine = exerted(station.statics, {name}, contact.beam)
        size = np.hypot(*station.statics.forces[mine].T)
        s = station.statics.s[mine][size > NOTHING * size.max(initial=0.0)]
        if not s.size:
            continue
        for end, near in ((beam.start, s <= inside.borders[1]), (beam.end, s >= inside.borders[-2])):
            if not isinstance(end, FreeEnd) and near.all():
                return end.point
    return None

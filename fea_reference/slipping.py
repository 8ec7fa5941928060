"""Distance of a pressing end from the end of the other beam, the place of a slip.

======  =======================================================================
symbol  meaning
======  =======================================================================
x, x_m  the first beam's end, and the facing place of the second's neutral line
s_m     arc length of x_m; beyond an end continued along the tangent
l_m     length of the second beam
======  =======================================================================

Nothing faces an end beyond the other beam's end. The contact force vanishes suddenly, and no equilibrium is near. A
thick first beam that leads from its end towards the second is an exception: the other's end then lies on the first
beam and keeps pressing.
"""

import numpy as np

from cprbm_scene.answer import Array
from fea_reference.hermite import NeutralLine, as_complex
from fea_reference.model import Model
from fea_reference.projection import closest
from fea_reference.state import State
from fea_reference.touch import Pair, Touch

_NEAR_END = 1.0  # elements: largest distance of a zone from its end


def distance_to_end(model: Model, contact: Touch, z: State) -> float | None:
    """The smaller of l_m − s_m and s_m in state ``z``; None unless a single end presses on a side."""
    pair = contact.pair
    if not isinstance(pair, Pair) or pair.roles is not None or not contact.closed:
        return None
    first, second = (model.line(model.beams[i], z) for i in (pair.first, pair.second))
    near = [end for end in (0, first.n) if np.abs(contact.zeta - end).max() <= _NEAR_END]
    if len(near) != 1:
        return None
    inwards = first.tangents[:, near[0]] * (1.0 if near[0] == 0 else -1.0)
    if pair.distance > 0.0 and float(inwards @ contact.normal.mean(axis=1)) < 0.0:
        return None
    s_m, total = (
        arc_length_at(second, first.points[:, near], float(np.median(contact.zeta_m))),
        float(second.lengths.sum()),
    )
    return min(s_m, total - s_m)


def passed_end(model: Model, contact: Touch, before: State, after: State) -> bool:
    """True if a pressing end came past the end of the other beam between two states."""
    here = distance_to_end(model, contact, before)
    there = None if here is None else distance_to_end(model, contact, after)
    return here is not None and there is not None and here > 0.0 > there


def arc_length_at(line: NeutralLine, x: Array, near: float) -> float:
    """s_m of a point ``x`` (2, 1) on a neutral line, with the initial guess ``near`` of the closest place."""
    zeta = closest(line, as_complex(x), np.array([near]))[0]
    arcs = np.append(0.0, np.cumsum(line.lengths))
    there, ahead, _ = line.at(zeta)
    along = float(((x - there) * ahead).sum() / np.hypot(*ahead[:, 0]))
    return float(np.interp(zeta[0], np.arange(line.n + 1), arcs)) + along

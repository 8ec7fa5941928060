"""Broad phase of contact search: a lower bound of the gap from bounding discs of a few nodes.

======  =====================================================================================
symbol  meaning
======  =====================================================================================
c, r    centre and radius of a disc about consecutive nodes and their elements
d       signed distance from an edge, Lipschitz with constant one in the body's frame
g       least gap: g ≥ |c − o| − R − T − r, d(c) − T − r or |c − c_m| − T − r − r_m
======  =====================================================================================
"""

import numpy as np

from cprbm_scene.answer import Array
from fea_reference.hermite import NeutralLine
from fea_reference.model import BodyPart, Model
from fea_reference.state import Complex, State
from fea_reference.touch import Circle, Contact, Face, Pair, Rigid

FAR = 0.1  # lengths of the longest beam: gap without any contact
_RUNS = 8  # discs per beam


def gap_lower_bound(model: Model, pair: Contact, z: State) -> float:
    """A lower bound of the gap in state ``z``; −∞ for self-contact."""
    c, r = _discs(model, pair.first, z)
    match pair:
        case Pair(roles=None):
            c_m, r_m = _discs(model, pair.second, z)
            return float((np.abs(c[:, None] - c_m) - r[:, None] - r_m).min()) - pair.distance
        case Pair():
            return -np.inf
        case Circle():
            x, y = model.carried(model.bodies[pair.body], np.array(pair.arm), z)
            return float((np.abs(c - complex(x, y)) - r).min()) - pair.radius - pair.edge.farthest
        case Face():
            r = r + pair.edge.farthest
            y = _in_frame(model, model.bodies[pair.body], c, z)
            y_0, d_0 = model.known.recall(
                model.start, ("distances", pair), lambda: _distances(model, pair, model.start)
            )
            apart = float((d_0 - np.abs(y - y_0) - r).min())
            return apart if apart > FAR else float((_distance(pair, y) - r).min())


def cannot_touch(model: Model, pair: Rigid, gaps: tuple[float, float], before: State, after: State) -> bool:
    """True if a beam with these ``gaps`` in two states cannot have touched on the straight way in between."""
    beam, body = model.beams[pair.first], model.bodies[pair.body]
    dofs = model.node_dofs[:2, beam.nodes]
    moved = float(np.hypot(*(after.values[dofs] - before.values[dofs])).max())
    line = model.line(beam, before)
    X, Y, phi = model.body_state(body, after) - model.body_state(body, before)
    if body.dofs is not None:
        x, y = model.carried(body, np.zeros(2), before)
        moved += float(np.hypot(X, Y)) + abs(float(phi)) * (float(np.abs(line.nodes - complex(x, y)).max()) + moved)
    return sum(gaps) > moved + 2.0 * float(line.lengths.max())


def _distances(model: Model, face: Face, z: State) -> tuple[Complex, Array]:
    """Disc centres (k,) in the frame of the edge's body, and d (k,) there."""
    y = _in_frame(model, model.bodies[face.body], _discs(model, face.first, z)[0], z)
    return y, _distance(face, y)


def _distance(face: Face, y: Complex) -> Array:
    """d (k,) of points x + i y (k,) in the frame of the edge's body."""
    return face.outline.near(np.array([y.real, y.imag])).distance


def _discs(model: Model, beam: int, z: State) -> tuple[Complex, Array]:
    """c (k,) as x + i y and r (k,) of beam number ``beam``."""
    part = model.beams[beam]
    return model.known.recall(z, ("discs", part.name), lambda: _discs_of(model.line(part, z)))


def _discs_of(line: NeutralLine) -> tuple[Complex, Array]:
    n = line.nodes.size
    starts = np.unique(np.arange(_RUNS) * n // _RUNS)
    lengths = np.diff(starts, append=n)
    c = line.nodes[starts + lengths // 2]
    return c, np.maximum.reduceat(np.abs(line.nodes - np.repeat(c, lengths)), starts) + float(line.speeds.max())


def _in_frame(model: Model, body: BodyPart, places: Complex, z: State) -> Complex:
    """Points x + i y (k,) in the frame of a body."""
    X, Y, phi = model.body_state(body, z)
    y = places - complex(body.centre[0] + X, body.centre[1] + Y)
    return y if body.dofs is None else y * complex(np.cos(phi), -np.sin(phi))

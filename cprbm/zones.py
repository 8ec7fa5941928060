"""Where a contact begins and ends along its first beam.

==========  ==============================================================================
s_j         arc length of the beam's joints
b, e        the zone's ends
D″          curvature with which the beam parts from what it touched, zero in a zone
==========  ==============================================================================

Forces act on joints, so that the last that press tell an end only to one element.  Beyond it the moment is
smooth and D″ grows from zero: continued backwards from the next three joints, it says where it began.

Next to a pin on the edge that presses, a moment holds the beam's end.  More of it than bends the beam along the edge is
what forces at joints do on their way to the pin: there is a zone, however few elements long, and D″ says how long.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from cprbm.model import Chain
from cprbm.pairs import Touching
from cprbm.point import Point
from cprbm_scene.answer import Array

CLOSE = 1.6  # elements between joints that are close; farther, a joint between them is not
SHORTEST = 1.9  # elements between the outer forces of a zone; two neighbours share the force of one place
CONTINUED = 3  # joints
FLAT = 0.01  # of D″ times the length squared: a beam that is held at one end and pressed at the other arches by 1/27


@dataclass(frozen=True, slots=True)
class Zone:
    """Arc lengths between which a beam touches, units of length; ``long`` where it is more than a place."""

    begin: float
    end: float
    long: bool


def zones_of(pair: Touching, point: Point) -> tuple[Zone, ...]:
    """The zones of one contact in ascending order, none while it is open."""
    chain, rows = pair.a, point.rows
    mine = np.array([name == pair.name for name in rows.contact], dtype=bool)
    arcs, forces, overlaps, reach = rows.arc[mine], point.lam[mine], rows.values[mine], rows.reach[mine]
    if not (forces > 0.0).any():
        return ()
    moments = rows.holds_angles[mine]
    pinned = arcs[moments & (forces > 0.0)]
    # ends that are clamped in touch: no force is needed there
    clamped = chain.s[[0, -1]][list(pair.brought_to(point.state).clamped)]
    if np.count_nonzero(forces > 0.0) == 1 and not (pinned.size or clamped.size):
        place = float(arcs[forces > 0.0][0])
        return (Zone(place, place, long=False),)
    largest = np.max(forces[~moments], initial=0.0)
    arcs, forces = np.append(arcs, clamped), np.append(forces, np.full(len(clamped), largest))
    overlaps, reach = np.append(overlaps, np.zeros(len(clamped))), np.append(reach, np.zeros(len(clamped)))
    order = np.argsort(arcs)
    arcs, forces, overlaps, reach = arcs[order], forces[order], overlaps[order], reach[order]
    pressed = (forces > 0.0).nonzero()[0]
    h = chain.size_at(arcs)
    # one zone goes on where each joint has a row, and the beam arches by no more than unevenness
    uneven = pair.arching * largest * h**3 / chain.section.rigidity_at(arcs)
    arched = -overlaps > uneven
    apart = np.diff(arcs) > CLOSE * np.maximum(h[1:], h[:-1]) + reach[1:] + reach[:-1]
    breaks = np.concatenate(([0], np.cumsum(apart | arched[1:] | arched[:-1])))
    ends = [0, *(np.diff(breaks[pressed]).nonzero()[0] + 1).tolist(), pressed.size]
    runs = [arcs[pressed[begin:end]] for begin, end in pairwise(ends)]
    runs = _with_pins(pair, point, runs, pinned, arcs, -overlaps, uneven)
    if clamped.size:
        runs = [_without_idle_clamp(chain, run, clamped) for run in runs]
    return tuple(
        [
            _zone(pair, point, chain, run, run[np.isin(run, pinned)] if pinned.size else pinned)
            for run in runs
            if len(run) > 1 or run[0] not in clamped
        ]
    )


def _without_idle_clamp(chain: Chain, run: Array, clamped: Array) -> Array:
    """A run without the clamp from which the beam lies along the other up to one place that alone is pressed."""
    inner = run[~np.isin(run, clamped)]
    if not inner.size or inner.size == run.size:
        return run
    h = float(chain.size_at(inner).max())
    beside = min(inner[0] - run[0], run[-1] - inner[-1]) == 0.0 and np.ptp(run) - np.ptp(inner) > SHORTEST * h
    return inner if beside and np.ptp(inner) < SHORTEST * h else run


def _with_pins(
    pair: Touching, point: Point, runs: list[Array], pinned: Array, arcs: Array, gaps: Array, uneven: Array
) -> list[Array]:
    """The ``runs`` in which those that begin or end at an own pin go on to the next if the beam lies flat between."""
    if not pinned.size:
        return runs
    joined = [runs[0]]
    for run in runs[1:]:
        low, high = float(joined[-1][-1]), float(run[0])
        beside = np.isin((low, high), pinned).any()
        between = (arcs > low) & (arcs < high)
        arch = float(np.max(gaps[between], initial=-np.inf))
        if beside and (arch <= np.max(uneven[between], initial=0.0) or _flat(pair, point, low, high, arch)):
            joined[-1] = np.concatenate((joined[-1], run))
        else:
            joined.append(run)
    return joined


def _flat(pair: Touching, point: Point, low: float, high: float, arch: float) -> bool:
    """Whether an ``arch`` between two arc lengths is no more than what the beam bends by near them."""
    chain = pair.a
    h = float(np.max(chain.size_at(np.array([low, high]) + np.array([[-1.0], [1.0]]) * 0.5 * chain.sizes.min())))
    joints = chain.s[(chain.s >= low - 2.0 * h) & (chain.s <= high + 2.0 * h)]
    bent = float(np.max(np.abs(pair.parting(point.state, point.at, joints))))
    return bool(arch < bent * max(h**2, FLAT * (high - low) ** 2))


def _zone(pair: Touching, point: Point, chain: Chain, run: Array, pins: Array) -> Zone:
    """The zone whose forces act at arc lengths ``run``, ascending, own ``pins`` among them."""
    first, last = float(run[0]), float(run[-1])
    # of the elements beside the zone; at a border a place says by round-off alone in which of two it is
    h = chain.size_at(np.clip(run[[0, -1]] + 0.25 * chain.sizes.min() * np.array([-1.0, 1.0]), 0.0, chain.s[-1]))
    springs = chain.s[1:-1]
    before, after = springs[springs < first - 0.25 * h[0]][::-1], springs[springs > last + 0.25 * h[1]]
    whole = run.size > 1 and (not before.size or not after.size)
    if not whole and not pins.size and last - first < SHORTEST * h.max():
        return Zone(first, last, long=False)
    if pins.size:  # the first spring may lie within
        before, after = (_parting(pair, point, springs) for springs in (before, after))
    begin = _continued(pair, point, before[:CONTINUED], first, h[0]) if before.size else 0.0
    end = _continued(pair, point, after[:CONTINUED], last, h[1]) if after.size else float(chain.s[-1])
    if pins.size:
        begin, end = min(begin, float(pins[0])), max(end, float(pins[-1]))
    return Zone(begin, max(begin, end), long=not pins.size or end > begin)


def _parting(pair: Touching, point: Point, joints: Array) -> Array:
    """Those of some ``joints``, the nearest first, from which on the beam parts; all where it does not."""
    parts = np.flatnonzero(pair.parting(point.state, point.at, joints) > 0.0)
    return joints[parts[0] :] if parts.size else joints


def _continued(pair: Touching, point: Point, joints: Array, last: float, h: float) -> float:
    """Where D″ at some ``joints`` beyond a zone, the nearest first, was zero: near the ``last`` force."""
    parting = pair.parting(point.state, point.at, joints)
    if len(joints) < 2 or not np.all(np.diff(parting, prepend=0.0) > 0.0):
        return last
    # s as a polynomial of D″, at zero (Lagrange)
    weights = [np.prod([other / (other - own) for other in np.delete(parting, i)]) for i, own in enumerate(parting)]
    found = float(np.dot(weights, joints))
    return found if abs(found - last) <= 1.5 * h else last

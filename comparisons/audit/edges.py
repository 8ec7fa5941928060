"""What touches and overlaps of beams that are areas, by their deformed edges; which way contacts push, and where.

An outline is a beam's right edge, its end's face, its left edge back and its start's face, as one closed line.  A place
of one outline within another's is as deep as the other's nearest place is away.  Where beams overlap already at rest,
and beside a joint that both have, is left out.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations

import numpy as np
from scipy.spatial import cKDTree

from comparisons.audit.areas import AreaOfBeam
from comparisons.audit.rest import Complex, coordinates
from comparisons.audit.seen import Seen
from cprbm_scene.answer import Array, Flags

DEEP = 0.01  # of the thickness: as deep as edges of any certificate may overlap
APART = 0.01  # of the thickness: by which a contact may press across a gap
ALIGNED = 0.02  # 1 − cos: by which a force may lean from the normal
NOTHING = 1e-6  # of a contact's largest force
INWARD = 0.05  # thicknesses: where a force that pushes has gone into the beam


def areas(seen: Seen) -> dict[str, AreaOfBeam]:
    """The beams that are areas."""
    return {name: beam for name, beam in seen.beams.items() if isinstance(beam, AreaOfBeam)}


def turned_inside_out(seen: Seen) -> Iterator[str]:
    """Beams with an element in which det F is not positive."""
    for name, beam in areas(seen).items():
        if not beam.thinnest > 0.0:
            yield f"{name} is turned inside out: det F is {beam.thinnest:.2g}"


def pressing(seen: Seen, name: str) -> Iterator[tuple[str, Array, Complex, Complex]]:
    """Of every beam on which a contact presses arc lengths, places on its edge and forces (k,)."""
    for on in dict.fromkeys(seen.scene.contacts[name].beams):
        acting = seen.acting[on]
        size = np.abs(acting.forces)
        mine = np.array([by == name for by in acting.by], dtype=bool)
        mine &= size > NOTHING * float(np.max(size, initial=0.0, where=mine))
        s, forces = acting.s[mine], acting.forces[mine]
        half = 0.5 * seen.rests[on].thickness(s)
        yield on, s, acting.places[mine] - half * forces / np.abs(forces), forces


def pushes(seen: Seen, name: str) -> Iterator[str]:
    """Forces of a contact that are not on their beam's edge, or not on the other's, or go out of it or along it.

    At the corner of an end a force need not stand on the edge.
    """
    beams = seen.scene.contacts[name].beams
    for on, s, places, forces in pressing(seen, name):
        if not s.size:
            continue
        beam = areas(seen)[on]
        t = seen.rests[on].thickness(s)
        edge = outline(beam.edge(0), beam.edge(-1))
        distance, normal = nearest(places, edge)
        worst = int(np.argmax(distance - APART * t))
        if distance[worst] > APART * t[worst]:
            yield f"{name} presses {on} at {s[worst]:.4g} m, {distance[worst]:.2g} m from its edge"
        for other in set(beams) - {on}:
            beside = areas(seen)[other]
            gap, _ = nearest(places, outline(beside.edge(0), beside.edge(-1)))
            worst = int(np.argmax(gap - APART * t))
            if gap[worst] > APART * t[worst]:
                yield f"{name} presses {on} at {s[worst]:.4g} m across a gap of {gap[worst]:.2g} m to {other}"
        way = forces / np.abs(forces)
        out = ~within(places + INWARD * t * way, edge)
        if out.any():
            yield f"{name} pulls {on} at {s[out][0]:.4g} m with {np.abs(forces[out][0]):.3g} N"
        corners = np.array([beam.nodes[i, k] for i in (0, -1) for k in (0, -1)])
        rubs = np.abs((way * np.conj(normal)).real) < 1.0 - ALIGNED
        rubs &= np.abs(places[:, None] - corners).min(axis=1) > APART * t
        if rubs.any():
            yield f"{name} rubs {on} at {s[rubs][0]:.4g} m with {np.abs(forces[rubs][0]):.3g} N"


def overlaps(seen: Seen) -> Iterator[tuple[str, str, Array, Complex, Array]]:
    """Of two beams arc lengths and places (k,) of the first one's edge that lie in the second, and how deep."""
    found = areas(seen)
    for one, other in combinations(found, 2):
        for a, b in ((one, other), (other, one)):
            A, B = found[a], found[b]
            edge, rest = outline(B.edge(0), B.edge(-1)), outline(B.resting_edge(0), B.resting_edge(-1))
            for side in (0, -1):
                places = A.edge(side)
                inside = within(places, edge)
                if inside.any():
                    own = A.resting_edge(side)[inside]
                    near = within(own, rest) | (nearest(own, rest)[0] < DEEP * B.rest.beam.thickest)
                    s, deep = A.fine[inside][~near], places[inside][~near]
                    yield a, b, s, deep, nearest(deep, edge)[0]


def outline(right: Complex, left: Complex) -> Complex:
    """The closed line round a beam with these edges, its first place once more at its end."""
    return np.concatenate((right, left[::-1], right[:1]))


def nearest(places: Complex, line: Complex) -> tuple[Array, Complex]:
    """Distances (k,) of places from a closed line, and unit normals of the pieces where it is nearest."""
    if not places.size:
        return np.zeros(0), places
    at = cKDTree(coordinates(line)[:-1]).query(coordinates(places))[1]
    best, normal = np.full(places.size, np.inf), np.zeros(places.size, dtype=complex)
    for first in ((at - 1) % (line.size - 1), at):
        step = line[first + 1] - line[first]
        share = ((places - line[first]) * np.conj(step)).real / np.maximum(np.abs(step) ** 2, np.finfo(float).tiny)
        away = np.abs(places - line[first] - np.clip(share, 0.0, 1.0) * step)
        closer = away < best
        best = np.where(closer, away, best)
        normal = np.where(closer, 1j * step / np.maximum(np.abs(step), np.finfo(float).tiny), normal)
    return best, normal


def within(places: Complex, line: Complex) -> Flags:
    """Whether places (k,) lie within a closed line, by how often a ray from each crosses it."""
    found = np.zeros(places.size, dtype=bool)
    reach = np.abs(line - line.mean()).max()
    near = np.flatnonzero(np.abs(places - line.mean()) <= reach)
    if near.size:
        p, a, b = places[near][:, None], line[:-1], line[1:]
        over = (a.imag > p.imag) != (b.imag > p.imag)
        height = np.where(b.imag == a.imag, 1.0, b.imag - a.imag)
        crosses = over & (p.real < a.real + (p.imag - a.imag) * (b.real - a.real) / height)
        found[near] = crosses.sum(axis=1) % 2 == 1
    return found

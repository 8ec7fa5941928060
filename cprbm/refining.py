"""Meshes fitted to where contact is and to short spans, and carrying a state from one mesh to another.

==========  ====================================================================================
N_k         links of the meshes, N/4^k; the coarsest is where a solve begins
c_i         arc lengths at which the zones of a contact begin and end, :mod:`cprbm.zones`
β_i         numbers of the element borders that are put there
==========  ====================================================================================

A set of pressing joints that starts wrong by half a beam is put right only by a few joints at a time; a coarse
mesh has few joints, and says where the zone ends on the next.  And a force at a zone's end that must be shared by
the two joints beside it bends the beam by a part of h² that depends on where between them the end falls.
With a border at every end of a zone and a row there, and the elements between even, it is shared by none.

So is the part of h² by which the beam lies elsewhere where a moment acts within an element, and its curvature jumps:
there is a border too, as on the meshes that fit no contact (:mod:`cprbm.model`).

A beam that is held at one place and pressed at another, s further on, says the force there by the curvature between:
even over each element, it is wrong by a part (h/s)².  So a span between marks (held ends, places and ends of contact,
dead forces near held ends) has a stated share of the beam's elements, however short it is.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from itertools import pairwise

import numpy as np

from cprbm.beam_loads import BeamLoad
from cprbm.first_contact import Rows
from cprbm.kinematics import State
from cprbm.kinks import kinks_at, within
from cprbm.mechanism import Mechanism
from cprbm.model import Chain, Fit, Kinks, Model
from cprbm.pairs import Pressed
from cprbm.point import Point, point_at
from cprbm.settings import Settings
from cprbm.zones import Zone, zones_of
from cprbm_scene.answer import Array, Flags, Ints

COARSEST = 80  # links that need no coarser mesh to start from
FACTOR = 4
FEWEST = 8  # links of a beam in a coarser mesh
BESIDE = 0.6  # elements beyond a zone's end up to which a joint presses
LEAST = 1e-3  # of the largest pressure, on a joint within a zone
SHARE = 4  # a span between marks has one of so many of the beam's elements at least
BEYOND = 16  # one of so many of the beam's elements follow on a place in the size of the finer ones beside it
FIXED = 0.75  # of a beam's elements, the most that such shares may take
SHORTEST = 0.01  # elements: marks closer than this leave the elements even
BENT = 1e-6  # of the largest slope of a curvature beside a place: slopes that differ by less are the same
MOMENT = ""  # of whom the mark of a moment is: no contact and no force has that name
MOVED = 0.02  # elements: ends that have moved less since the mesh was made are where the mesh has them


def coarser(settings: Settings) -> tuple[Settings, ...]:
    """The meshes to go through, from the coarsest to the one that is asked."""
    family = [settings]
    while max(_counts(family[0])) > COARSEST:
        links = family[0].links
        fewer = _fewer(links) if isinstance(links, int) else {beam: _fewer(number) for beam, number in links.items()}
        family.insert(0, settings.model_copy(update={"links": fewer}))
    return tuple(family)


def _counts(settings: Settings) -> tuple[int, ...]:
    return (settings.links,) if isinstance(settings.links, int) else tuple(settings.links.values())


def _fewer(links: int) -> int:
    return max(min(links, FEWEST), -(-links // FACTOR))


def all_zones(mechanism: Mechanism, point: Point) -> dict[str, tuple[Zone, ...]]:
    """The zones of every contact that is closed, places of their own among them."""
    closed = point.rows.pressing(point.lam)
    found = {name: zones_of(mechanism.pairs[name], point) for name in mechanism.pairs if name in closed}
    return {name: zones for name, zones in found.items() if zones}


def long_ones(zones: Mapping[str, tuple[Zone, ...]]) -> dict[str, tuple[Zone, ...]]:
    """Those that are more than a place."""
    found = {name: tuple(zone for zone in mine if zone.long) for name, mine in zones.items()}
    return {name: mine for name, mine in found.items() if mine}


def ends_of(mechanism: Mechanism, zones: Mapping[str, tuple[Zone, ...]]) -> dict[str, Array]:
    """For every contact with a long zone, its ends c_i within the first beam, as shares of the length, ascending."""
    ends = {}
    for name, found in long_ones(zones).items():
        length = mechanism.pairs[name].a.s[-1]
        inner = {end / length for zone in found for end in (zone.begin, zone.end) if 0.0 < end < length}
        if inner:
            ends[name] = np.array(sorted(inner))
    return ends


def fitted(
    mechanism: Mechanism,
    point: Point,
    zones: Mapping[str, tuple[Zone, ...]],
    settings: Settings,
) -> Fit:
    """Elements that end where contacts do, even between; where these are much closer than that, even ones."""
    ends, pressed = ends_of(mechanism, zones), _pressed(mechanism, point, zones)
    borders: dict[str, Array] = {}
    kept: dict[str, Array] = {}
    for chain in mechanism.problem.model.chains:
        names = [name for name in ends if mechanism.pairs[name].a is chain]
        found = [(float(place), name) for name in names for place in ends[name]]
        found += _places_on(mechanism, pressed, chain)
        found += _forces_on(mechanism, chain)
        if not found:
            continue
        n = settings.links_of(chain.name)
        bent = [(mark, MOMENT) for mark in mechanism.problem.model.outset.bent.get(chain.name, ())]
        laid = _laid_out(mechanism, chain, n, found + bent, names)
        if laid is None and bent:  # beside what presses there may be no room for a border where a moment acts
            laid = _laid_out(mechanism, chain, n, found, names)
        if laid is None:
            continue
        numbers, places = laid
        borders[chain.name] = np.interp(np.arange(n + 1), numbers, places)
        kept |= {name: ends[name] for name in names}
    return Fit(borders, kept, _kinks(mechanism, point, pressed))


def _pressed(
    mechanism: Mechanism, point: Point, zones: Mapping[str, tuple[Zone, ...]]
) -> dict[str, tuple[Pressed, ...]]:
    """What contacts without a long zone press in their places, on their first beam and on their second."""
    found = {}
    for name, mine in zones.items():
        if not any(zone.long for zone in mine):
            middles = np.array([0.5 * (zone.begin + zone.end) for zone in mine])
            found[name] = mechanism.pairs[name].pressed(point.state, point.at, middles)
    return found


def _laid_out(
    mechanism: Mechanism, chain: Chain, n: int, found: list[tuple[float, str]], zoned: list[str]
) -> tuple[Array, Array] | None:
    """Numbers of n elements that end at places of a beam, and these, as shares of it; None where it is well as it is.

    What was ``found`` are marks and of whom; ends of the contacts that are ``zoned``, and moments, are borders.
    """
    in_order = sorted(found)
    marks, of = np.array([mark for mark, _ in in_order]), [name for _, name in in_order]
    # between two places of one contact the beam lies on what it touches, or nearly; a free end has no curvature;
    # and a dead force is known whatever the curvature
    dead = {MOMENT, *mechanism.problem.loads}
    between = [one != other and dead.isdisjoint((one, other)) for one, other in pairwise(of)]
    needy = np.array([chain.held[0], *between, chain.held[1]])
    numbers = _shared_out(marks, n, needy)
    # a zone's end is a border; a place need not be one, and as it goes on its way the mesh changes evenly
    at_end = np.array([False, *(name in zoned or name == MOMENT for name in of), False])
    numbers = np.where(at_end, np.round(numbers), numbers)
    as_they_are = not zoned and np.all(np.abs(numbers[1:-1] - n * marks) <= MOVED)
    if as_they_are or not (numbers[1:] - numbers[:-1] >= 1.0).all():
        return None
    places = np.concatenate(([0.0], marks, [1.0]))
    return _surrounded(numbers, places, n / BEYOND, np.flatnonzero(~at_end[1:-1]) + 1)


def _kinks(
    mechanism: Mechanism, point: Point, pressed: Mapping[str, tuple[Pressed, ...]]
) -> dict[str, tuple[Kinks, ...]]:
    """Those of what is ``pressed`` in places, of a contact's first beam and of its second; none where an end is."""
    found = {}
    for name, both in pressed.items():
        pair, places = mechanism.pairs[name], [at for _, at, _ in both]
        inner = np.all([within(chain, arc) for chain, arc in zip(pair.chains, places, strict=True)], axis=0)
        if np.any(inner):
            found[name] = tuple(
                kinks_at(chain, point.state, arc[inner]) for chain, arc in zip(pair.chains, places, strict=True)
            )
    return found


def _places_on(
    mechanism: Mechanism, pressed: Mapping[str, tuple[Pressed, ...]], chain: Chain
) -> list[tuple[float, str]]:
    """Where what is ``pressed`` in places lies within a beam, as shares of its length, and by which contact."""
    found = []
    for name, both in pressed.items():
        for of, (_, at, _) in zip(mechanism.pairs[name].chains, both, strict=True):
            if of is chain:
                found += [(float(place), name) for place in at / chain.s[-1] if 0.0 < place < 1.0]
    return found


def _forces_on(mechanism: Mechanism, chain: Chain) -> list[tuple[float, str]]:
    """The inmost dead force on a beam, as a share of its length, and its name, where all are near one of its ends."""
    model, loads = mechanism.problem.model, mechanism.problem.loads
    found = sorted(
        (load.ends[0] / float(chain.s[-1]), name)
        for name, load in loads.items()
        if isinstance(load, BeamLoad) and not load.distributed and model.chains[load.chain].name == chain.name
    )
    if found and 0.0 < found[-1][0] < 1.0 / SHARE:
        return found[-1:]
    return found[:1] if found and 1.0 - 1.0 / SHARE < found[0][0] < 1.0 else []


def _shared_out(marks: Array, n: int, needy: Flags) -> Array:
    """How many of n elements lie before the marks (shares of the length) and the ends, spans ``needy`` having a share.

    All zero where marks are too close to each other.
    """
    spans = np.diff(marks, prepend=0.0, append=1.0)
    if np.any(spans * n < SHORTEST):
        return np.zeros(len(marks) + 2)
    least = np.where(needy, min(n / SHARE, FIXED * n / max(int(np.sum(needy)), 1)), 1.0)
    wanted = np.maximum(n * spans, least)
    spare = wanted - least
    before = np.cumsum(wanted - (wanted.sum() - n) * spare / spare.sum())
    return np.concatenate(([0.0], before[:-1], [float(n)]))


def _surrounded(numbers: Array, places: Array, beyond: float, these: Ints) -> tuple[Array, Array]:
    """Numbers and places between which elements are even, the finer at some of the places going on ``beyond`` them.

    Of the coarser span no more than a third.
    """
    size = np.diff(places) / np.diff(numbers)
    more, where = [numbers], [places]
    for k in these:
        fine = min(size[k - 1], size[k])
        coarser, sign = (k, 1.0) if size[k] > fine else (k - 1, -1.0)
        step = sign * min(beyond, (numbers[coarser + 1] - numbers[coarser]) / 3.0)
        more.append(numbers[k : k + 1] + step)
        where.append(places[k : k + 1] + step * fine)
    order = np.argsort(np.concatenate(more))
    return np.concatenate(more)[order], np.concatenate(where)[order]


def fits(mechanism: Mechanism, fit: Fit) -> bool:
    """Whether the mechanism's mesh was made for (nearly) the same ends and places."""
    made = mechanism.fit
    return (
        made.ends.keys() == fit.ends.keys()
        and _same(mechanism, fit.kinks)
        and made.borders.keys() == fit.borders.keys()
        and all(
            len(made.borders[beam]) == len(borders)
            and np.all(np.abs(made.borders[beam] - borders) <= MOVED / (len(borders) - 1))
            for beam, borders in fit.borders.items()
        )
    )


def _same(mechanism: Mechanism, now: Mapping[str, tuple[Kinks, ...]]) -> bool:
    """Whether the same contacts press in points as the mesh was made for, with nearly the same slopes beside them."""
    made = mechanism.fit.kinks
    return made.keys() == now.keys() and all(
        _as_bent(chain, one, other)
        for name in now
        for chain, one, other in zip(mechanism.pairs[name].chains, made[name], now[name], strict=True)
    )


def _as_bent(chain: Chain, made: Kinks, now: Kinks) -> bool:
    """Whether slopes differ by little; what they make of the tangent falls with the square of the element there."""
    if len(made.places) != len(now.places):
        return False
    little = BENT * now.largest * (chain.h / chain.size_at(now.places)) ** 2
    change = np.abs((made.before - now.before, made.behind - now.behind))
    return bool(np.all(change <= little))


def carried_state(before: Model, state: State, after: Model) -> State:
    """The unknowns of one mesh as those of another."""
    if after is before:
        return state
    theta = after.rest.copy()
    # each link has the beam's tangent at the border that lies on it
    for source, target in zip(before.chains, after.chains, strict=True):
        turned = state.theta[source.links] - source.rest
        theta[target.links] += np.interp(target.borders, source.borders, turned)
    return State(theta, state.bodies)


def carried_over(
    before: Mechanism,
    point: Point,
    after: Mechanism,
    values: dict[str, float],
    known: Mapping[str, tuple[Zone, ...]] | None = None,
) -> Point:
    """A state of one mesh on another, with its forces: a guess; all its zones may be ``known``."""
    old, new = before.problem.model, after.problem.model
    state = carried_state(old, point.state, new)
    bare = point_at(after.problem, values, state, point.mu, np.zeros(0), Rows((), point.rows.faces, point.rows.sides))
    rows = bare.rows
    lam = np.zeros(rows.size)
    zones = long_ones(all_zones(before, point) if known is None else known)
    first = 0
    for group in rows.groups:
        name, mine = group.contact, slice(first, first + len(group.values))
        first = mine.stop
        if name in zones and not group.holds_angles:
            lam[mine] = _pressure(point, name, zones[name], (before.pairs[name].a, after.pairs[name].a), group.arc)
    _add_single(point, zones, rows, lam, 2.0 * max(chain.h for chain in old.chains))
    return replace(bare, lam=lam)


def _pressure(point: Point, contact: str, zones: tuple[Zone, ...], chains: tuple[Chain, Chain], arc: Array) -> Array:
    """Forces on rows at ``arc`` within the zones, from the pressures of an earlier mesh; its and the new chain."""
    source, target = chains
    lam = np.zeros(len(arc))
    mine = np.array([name == contact for name in point.rows.contact], dtype=bool) & ~point.rows.holds_angles
    if not np.any(mine):
        return lam
    order = np.argsort(point.rows.arc[mine])
    places, forces = point.rows.arc[mine][order], point.lam[mine][order]
    pressure = np.interp(arc, places, forces / source.size_at(places))
    size = target.size_at(arc)
    for zone in zones:
        # up to the joint beyond an end, which shares the force there; an arch's joints press too, in the limit
        inside = (arc >= zone.begin - BESIDE * size) & (arc <= zone.end + BESIDE * size)
        lam[inside] = np.maximum(pressure[inside], LEAST * pressure.max()) * size[inside]
    return lam


def _add_single(point: Point, zones: Mapping[str, tuple[Zone, ...]], rows: Rows, lam: Array, reach: float) -> None:
    """Add the forces outside of zones to the nearest rows of the same contact, and moments to their own."""
    numbers = {key: i for i, key in enumerate(rows.keys)}
    for force, arc, key, angle in zip(point.lam, point.rows.arc, point.rows.keys, point.rows.holds_angles, strict=True):
        contact = key[0]
        if angle:
            lam[numbers[key]] += force
            continue
        if force <= 0.0 or any(zone.begin - reach <= arc <= zone.end + reach for zone in zones.get(contact, ())):
            continue
        lam[rows.nearest(contact, arc)] += force

"""Point forces along a beam: places away from point forces, and shared forces.

Beside a held end, a moment, and the ends of a contact zone, a discretisation spreads a point force over a link or an
element.  By Saint-Venant's principle a point force disturbs the real stress over about a thickness.  The comparison
leaves out stresses within the longer of both lengths.  Inside a contact zone the pressure and the stress are smooth.

A clamp and a contact within an element of the clamp share one force: the sum converges with the order of the mesh, and
the shares do not.  Two contacts at one place of a beam also share a force: mechanics determines the sum alone.

In ``shear`` a point force F makes a kink F/GA_s in the neutral line, and a contact force acts along the mean normal of
both sides.  Finite elements spread the kink over the element with the force, and the normal there tilts.  The tilt is
an odd function of the distance from the middle of the element, and zero at the nodes.  On a cantilever over a circle,
with 20 to 59 elements, the tilt was up to 0.45 of F/(2 GA_s), and did not fall with the number of elements: no mesh
shows the error.  Over a probe's scale the error was up to 0.5 of this angle in random scenes.
"""

from collections.abc import Iterable, Sequence

import numpy as np

from comparisons.geometry import SHEAR_FACTOR, length
from cprbm_scene import Array, Beam, BeamMoment, Flags, FreeEnd, Scene, StationAnswer

SIGNIFICANT = 1e-3
"""Least force of a source at a place, a share of the source's largest force on the beam."""

ZONE_GAP = 3.0
"""Largest distance of neighbouring forces in a zone of contact, in elements of the coarsest mesh."""


def away_from_point_forces(scene: Scene, beam: str, places: Array, stations: Sequence[StationAnswer]) -> Flags:
    """Which places (k,) lie outside the disturbance of held ends, moments and ends of zones of contact.

    Args:
        scene: the question.
        beam: name of the beam.
        places: arc lengths (k,), m.
        stations: one station of several answers; a contact in any of them counts.
    """
    record = scene.beams[beam]
    whole = length(record.curve)
    thickness = record.thickness_at(places / whole)
    sharp = [s for s, end in ((0.0, record.start), (whole, record.end)) if not isinstance(end, FreeEnd)]
    moments = (load for load in scene.loads.values() if isinstance(load, BeamMoment) and load.beam == beam)
    sharp += [load.at * whole for load in moments]
    clear = _farther(places, sharp, thickness)
    coarsest = max((_element(station, beam) for station in stations), default=0.0)
    for contact in (name for name, record in scene.contacts.items() if beam in record.beams):
        forces = [_significant(station, contact, beam) for station in stations]
        ends = zone_ends(forces, ZONE_GAP * coarsest)
        clear &= _farther(places, ends, np.maximum(thickness, coarsest))
    return clear


def zone_ends(places: Sequence[Array], gap: float) -> list[float]:
    """First and last place of every answer in every zone of contact, m.

    Args:
        places: arc lengths (k,) of the forces, by answer, m; empty where the contact is open.
        gap: largest distance of neighbours in a zone, m.
    """
    together = np.sort(np.concatenate(places))
    borders = 0.5 * (together[:-1] + together[1:])[np.diff(together) > gap]
    zones = (zone for own in map(np.sort, places) for zone in np.split(own, np.searchsorted(own, borders)) if zone.size)
    return [float(end) for zone in zones for end in (zone[0], zone[-1])]


def sharing_sources(scene: Scene, stations: Iterable[StationAnswer], source: str) -> tuple[str, frozenset[str]] | None:
    """The beam, and all other contacts and joints on the beam within an element of ``source``; None without any.

    Args:
        scene: the question.
        stations: one station of several answers.
        source: name of a contact, or of a point that a beam is joined to.
    """
    contact, every = scene.contacts.get(source), tuple(stations)
    joined = (name for name, beam in scene.beams.items() if source in _joints(beam))
    for beam in dict.fromkeys(contact.beams if contact else joined):
        others = {other for station in every for other in _neighbours(scene, station, source, beam)}
        if others:
            return beam, frozenset(others)
    return None


def largest_tilt(scene: Scene, station: StationAnswer) -> float:
    """The largest F/(4 GA_s) of a contact's resultant F on a beam of least GA_s, rad; 0 without contact."""
    return max(
        (
            float(np.hypot(*station.forces.force[station.forces.chosen(name, beam)].sum(axis=0)))
            * (0.5 + 0.5 * scene.materials[record.material].poisson_ratio)
            / (scene.materials[record.material].youngs_modulus * SHEAR_FACTOR)
            / float(record.thinnest * np.min(record.width_at(record.knots)))
            for name, contact in scene.contacts.items()
            for beam, record in scene.beams.items()
            if beam in contact.beams
        ),
        default=0.0,
    )


def _neighbours(scene: Scene, station: StationAnswer, source: str, beam: str) -> Iterable[str]:
    own = _significant(station, source, beam)
    joints = _joints(scene.beams[beam])
    for other in {*scene.contacts, *(() if source in joints else joints)} - {source}:
        theirs = _significant(station, other, beam)
        if own.size and theirs.size and np.abs(own[:, None] - theirs).min() <= _element(station, beam):
            yield other


def _joints(beam: Beam) -> tuple[str, ...]:
    return tuple(end.point for end in (beam.start, beam.end) if not isinstance(end, FreeEnd))


def _significant(station: StationAnswer, source: str, beam: str) -> Array:
    """Arc lengths (k,) at which a source presses a beam."""
    mine = station.forces.chosen(source, beam)
    size = np.hypot(*station.forces.force[mine].T)
    return np.asarray(station.forces.s[mine][size > SIGNIFICANT * size.max(initial=0.0)])


def _element(station: StationAnswer, beam: str) -> float:
    """Length of the beam's longest element, m."""
    state = station.beams.get(beam)
    return float(np.diff(station.shapes[beam].s if state is None else state.borders).max())


def _farther(places: Array, spots: Sequence[float], distance: Array) -> Flags:
    """Which places (k,) lie at least a ``distance`` (k,) from all ``spots``; round-off counts as far enough."""
    if not spots:
        return np.ones(places.shape, dtype=bool)
    nearest = np.min(np.abs(places[:, None] - np.array(spots)), axis=1)
    return np.asarray(nearest >= distance * (1.0 - 1e-9))

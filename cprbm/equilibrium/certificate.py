"""Certificate of an equilibrium, and the Ending that a failure means.

=======  ====================================================================================
symbol   meaning
=======  ====================================================================================
r        unbalanced generalised force over the largest moment
ε        unit round-off
=======  ====================================================================================

The moments of joints are products of stiffness and angles, uncertain by ε k |θ|; the sums of a
chain add ε √m of the largest moment.  A contact holds positions, which a gap with its weights knows to some ε of the
longest beam; over a link that is an angle of some ε/h, in two neighbouring joints, and the force on a node is a moment
over h.  A moving place rests where the slope of the gap vanishes: the force times the slope's round-off over the gap's
curvature is a force, large between beams of nearly equal curvature.  Four times the sum is the floor.

Where a row prescribes the gap of a closed place too, both share the force, and round-off decides.  A round-off of all
gaps then changes the force by a large part.
"""

from math import sqrt

import numpy as np

from cprbm.chain import add_row_gradient
from cprbm.contact import on_edge
from cprbm.equilibrium.columns import contact_terms
from cprbm.equilibrium.iteration import beside_points
from cprbm.equilibrium.solving import Solved
from cprbm.equilibrium.stability import blocked, softest
from cprbm.equilibrium.system import System
from cprbm_scene import Certificate, Ending
from cprbm_scene.answer import Array, Flags

EPSILON = float(np.finfo(float).eps)

LARGEST_BEND = 1.0
"""Turn of one joint, rad, beyond which a chord no longer stands for its element."""

LARGEST_STRAIN = 0.25
"""Largest β |N|, h² |N|/12EI: beyond 1 the correction of a link loses its stability; h is 1.7 times √(EI/N) here."""

BALANCE = 1e-8
"""Largest resultant over the largest force: supports and loads balance to far less."""

LEAST_VIOLATION = 1e-13
"""Violation of a row or a link equation, over the longest beam, that round-off of positions leaves."""

SMALLEST_LOAD = 1e-12
"""Force or moment, in units, below which everything counts as unloaded."""

PULL = 1e-9
"""Moment by which a stop may pull, over the largest moment; the floor is larger where a stop bears round-off alone."""

PLACES = 12.0
"""Round-offs of a gap, three, times the weights 1, −2, 1 of three positions in the difference of two moments, four."""

UNKNOWN = 1e-3
"""Change of a contact force under a round-off of the gaps, over the largest and EI/ℓ²: a support shares the force."""

OVERLAPS = 1e-9
"""Overlap of open curves, over the longest beam, left by the active set, which closes larger ones."""

OPEN = "the joints are open by {:.1e} of the longest beam, allowed {:.1e}"
BENT = "one element turns by {:.2f} rad, more than {:.1f}: use more links"
STRAINED = "a link carries {:.2f} of 12 EI over its length squared, more than {:.2f}: use more links"


def certify(
    solved: Solved, tolerance: float, iterations: int, acting: Flags, *, with_curvature: bool = True
) -> tuple[Certificate, Ending]:
    """Certificate of an equilibrium, and COMPLETED or the Ending of the first failure.

    Args:
        solved: the state.
        tolerance: largest residual and violation; round-off may set a higher floor.
        iterations: Newton iterations spent on it.
        acting: which stops act.
        with_curvature: whether the smallest curvature is computed; inertia alone tells whether the state is a minimum.
    """
    system, state = solved.system, solved.state
    turned, bend, strain, moment = _sizes(system, state.z)
    scale = max(moment, SMALLEST_LOAD)
    contacts, law = state.contacts, system.geometry.law
    shortest = float(system.metric.min())
    columns = solved.factors.bordered.columns
    motions = np.abs(columns.diagonal[len(columns.values) :])
    rounded = float(system.joints.stiffness.max()) * (
        turned + ((PLACES + 1.0 / shortest) / shortest if contacts.closed.any() else 0.0)
    ) + PLACES / float(motions[motions > 0.0].min(initial=np.inf))
    floor = 4.0 * EPSILON * (rounded + sqrt(len(system.metric)) * scale) / scale
    gradient, (apart, overlap, pull, unknown) = np.abs(solved.gradient), contact_measures(solved)
    residual = float(gradient[~system.equations].max()) / scale
    violation = max(float(gradient[system.equations].max()), apart)
    # pull of a closed stop, turn of an open stop beyond the limit
    stops = np.where(state.driven, state.multipliers(system), -solved.values)[system.limits & acting]
    complementarity = max(float(np.max(stops, initial=0.0)), pull) / scale
    force, couple = (size / scale for size in _resultants(solved))
    balance_limit = max(BALANCE, 100.0 * floor)
    checks = (
        (residual, max(tolerance, floor), Ending.NOT_CERTIFIED, "the residual is {:.1e}, allowed {:.1e}"),
        (violation, max(tolerance, LEAST_VIOLATION), Ending.NOT_CERTIFIED, OPEN),
        (complementarity, max(PULL, floor), Ending.NOT_CERTIFIED, "a stop or contact pulls by {:.1e}, allowed {:.1e}"),
        (unknown, UNKNOWN, Ending.NOT_CERTIFIED, "round-off changes contact forces by {:.1e}, allowed {:.1e}"),
        (overlap, OVERLAPS, Ending.BEAMS_CROSSED, "an open contact overlaps by {:.1e} beams, allowed {:.1e}"),
        (bend, LARGEST_BEND, Ending.TURNED_TOO_FAR, BENT),
        (strain, LARGEST_STRAIN, Ending.TURNED_TOO_FAR, STRAINED),
        (force, balance_limit, Ending.NOT_CERTIFIED, "ΣF is {:.1e} of the largest force, allowed {:.1e}"),
        (couple, balance_limit, Ending.NOT_CERTIFIED, "ΣM is {:.1e} of the largest moment, allowed {:.1e}"),
        (float(blocked(solved).lost), 0.0, Ending.NOT_A_MINIMUM, "the energy falls in {:.0f} independent directions"),
    )
    failures = [(ending, text.format(found, most)) for found, most, ending, text in checks if not found <= most]
    invalid = law.invalid(state.z, contacts.places, contacts.closed) if law is not None else ""
    failures += [(Ending.LEFT_BOUNDARY, invalid)] if invalid else []
    certificate = Certificate(
        residual=residual,
        residual_floor=floor,
        violation=violation,
        penetration=overlap,
        complementarity=complementarity,
        force_balance=force,
        moment_balance=couple,
        smallest_curvature=softest(solved).curvature if with_curvature else float("nan"),
        iterations=iterations,
        failures=tuple(sentence for _, sentence in failures),
    )
    return certificate, failures[0][0] if failures else Ending.COMPLETED


def _sizes(system: System, z: Array) -> tuple[float, float, float, float]:
    """Largest angle of a link or body, turn of a joint, and share of a link's normal force in 12 EI/h²; largest moment.

    Moments are moments of joints, of forces on their links, and of rows.
    """
    links, joints, theta = system.links, system.joints, z[system.angles]
    x, y = z[links.first + 2], z[links.first + 3]
    turns = np.abs(theta[joints.before + 1] - theta[joints.before] - joints.rest)
    strains = np.abs(links.lean * (x * np.cos(theta) + y * np.sin(theta)))
    moments = [links.length * np.hypot(x, y), joints.stiffness * turns, np.abs(z[system.rows.first :])]
    largest = (float(each.max()) for each in (np.abs(z[system.turns]), turns, strains, np.concatenate(moments)))
    return next(largest), next(largest), next(largest), next(largest)


def _resultants(solved: Solved) -> tuple[float, float]:
    """Resultant force and moment of the forces of all rows on nodes and bodies."""
    system, z, contacts = solved.system, solved.state.z, solved.state.contacts
    acting = np.zeros(system.size)
    if system.geometry.law is not None:
        # a law along an axis leaves a moment
        acting += contact_terms(system.geometry, z, contacts.places, contacts.closed)[1]
    add_row_gradient(z, system.rows, z[system.rows.first :], acting)
    index, origin = system.arms
    forces = np.array([acting[index], acting[index + 1]])
    x, y = origin.T + np.array([z[index], z[index + 1]])
    return (
        float(np.hypot(*forces.sum(axis=1))),
        abs(float(x @ forces[1] - y @ forces[0] + acting[system.turns].sum())),
    )


def contact_measures(solved: Solved) -> tuple[float, float, float, float]:
    """Largest violation of a closed place, overlap of an open place, and pull of a closed place, in units.

    The last measure is the change of a contact force under a round-off of all closed gaps, over the largest force and
    at least 1.

    The compliance that the chain lacks at a point of contact is no overlap, within a link of the point twice as much.
    Places with a shared force overlap by the sum of both gaps.
    """
    geometry, contacts = solved.system.geometry, solved.state.contacts
    places, closed = contacts.places, contacts.closed
    beside, depth = beside_points(geometry.arrays, places, closed)
    gaps, leaders = solved.gaps.copy(), np.arange(len(closed)) + places.shares
    follows = places.shares != 0
    np.add.at(gaps, leaders[follows], solved.gaps[follows])
    thick = geometry.arrays.thickness[places.piece] + geometry.arrays.thickness[places.foot] > 0.0
    free = ~closed & ~follows & (~places.moves | on_edge(geometry.arrays, places)) & (thick | ~places.at_point)
    overlap = float(np.max((-gaps - (1.0 + beside) * depth)[free], initial=0.0))
    values = np.abs(solved.factors.bordered.columns.values)
    # a state without contacts solves nothing
    changes = (
        solved.factors.solve_both(np.zeros(solved.system.size), np.full(len(values), EPSILON))[1]
        if len(values)
        else values
    )
    unknown = float(np.abs(changes).max(initial=0.0)) / max(1.0, float(places.force.max(initial=0.0)))
    return float(values.max(initial=0.0)), overlap, float(np.max(-places.force[closed], initial=0.0)), unknown

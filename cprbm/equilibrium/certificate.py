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
over h.  Four times the sum is the floor.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import sqrt

import numpy as np

from cprbm.chain import add_row_gradient
from cprbm.equilibrium.columns import contact_terms
from cprbm.equilibrium.contact_gaps import contact_measures
from cprbm.equilibrium.newton import Solved
from cprbm.equilibrium.stability import softest
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
"""Moment by which a stop may pull, over the largest moment."""


PLACES = 12.0
"""Round-offs of a gap, three, times the weights 1, −2, 1 of three positions in the difference of two moments, four."""

OVERLAPS = 1e-9
"""Overlap of open curves, over the longest beam, left by the active set, which closes larger ones."""

OPEN = "the joints are open by {:.1e} of the longest beam, allowed {:.1e}"
BENT = "one element turns by {:.2f} rad, more than {:.1f}: use more links"
STRAINED = "a link carries {:.2f} of 12 EI over its length squared, more than {:.2f}: use more links"


@dataclass(frozen=True, slots=True)
class Balance:
    """Resultant force and moment of all supports and loads over the largest part."""

    force: float
    moment: float


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
    scale = max(_largest_moment(solved), SMALLEST_LOAD)
    turned = float(np.abs(state.z[system.angles]).max())
    stiffest = float(system.joints.stiffness.max())
    contacts = state.contacts
    shortest = float(system.metric.min())
    pressed = contacts is not None and contacts.closed.any()
    turns = turned + ((PLACES + 1.0 / shortest) / shortest if pressed else 0.0)
    floor = 4.0 * EPSILON * (stiffest * turns + sqrt(len(system.metric)) * scale) / scale
    force_rows, equations = _parts(system)
    residual = float(np.abs(solved.gradient[force_rows]).max()) / scale
    contact = contact_measures(solved)
    violation = max(float(np.abs(solved.gradient[equations]).max()), contact.violation)
    complementarity = max(_complementarity(solved, acting), contact.pull) / scale
    balance = _balance(solved, scale)
    strain = float(np.abs(system.lean * _pull(solved)).max())
    bend = float(np.abs(_turns(solved)).max(initial=0.0))
    curvature = softest(solved).curvature if with_curvature else float("nan")
    balance_limit = max(BALANCE, 100.0 * floor)
    checks = (
        (residual, max(tolerance, floor), Ending.NOT_CERTIFIED, "the residual is {:.1e}, allowed {:.1e}"),
        (violation, max(tolerance, LEAST_VIOLATION), Ending.NOT_CERTIFIED, OPEN),
        (complementarity, PULL, Ending.NOT_CERTIFIED, "a stop or contact pulls or is passed by {:.1e}, allowed {:.1e}"),
        (contact.overlap, OVERLAPS, Ending.BEAMS_CROSSED, "an open contact overlaps by {:.1e} beams, allowed {:.1e}"),
        (bend, LARGEST_BEND, Ending.TURNED_TOO_FAR, BENT),
        (strain, LARGEST_STRAIN, Ending.TURNED_TOO_FAR, STRAINED),
        (balance.force, balance_limit, Ending.NOT_CERTIFIED, "ΣF is {:.1e} of the largest force, allowed {:.1e}"),
        (balance.moment, balance_limit, Ending.NOT_CERTIFIED, "ΣM is {:.1e} of the largest moment, allowed {:.1e}"),
        (float(solved.lost), 0.0, Ending.NOT_A_MINIMUM, "the energy falls in {:.0f} independent directions"),
    )
    failures = [(ending, text.format(found, most)) for found, most, ending, text in checks if not found <= most]
    if system.geometry is not None and system.geometry.law is not None and contacts is not None:
        invalid = system.geometry.law.invalid(state.z, contacts.places, contacts.closed)
        failures += [(Ending.LEFT_BOUNDARY, invalid)] if invalid else []
    certificate = Certificate(
        residual=residual,
        residual_floor=floor,
        violation=violation,
        penetration=contact.overlap,
        complementarity=complementarity,
        force_balance=balance.force,
        moment_balance=balance.moment,
        smallest_curvature=curvature,
        iterations=iterations,
        failures=tuple(sentence for _, sentence in failures),
    )
    return certificate, failures[0][0] if failures else Ending.COMPLETED


def _turns(solved: Solved) -> Array:
    """Elastic turns of all joints."""
    system, z = solved.system, solved.state.z
    before = system.angles[system.joints.before]
    return np.asarray(z[system.angles[system.joints.before + 1]] - z[before] - system.joints.rest)


def _pull(solved: Solved) -> Array:
    """Normal forces of all links."""
    system, z = solved.system, solved.state.z
    angles = z[system.angles]
    return np.asarray(z[system.links.first + 2] * np.cos(angles) + z[system.links.first + 3] * np.sin(angles))


def _largest_moment(solved: Solved) -> float:
    """Largest moment of a joint, of a link's force on the link, or of a row."""
    system, z = solved.system, solved.state.z
    joints = np.abs(system.joints.stiffness * _turns(solved)).max(initial=0.0)
    forces = np.hypot(z[system.links.first + 2], z[system.links.first + 3])
    rows = np.abs(solved.state.multipliers(system)).max(initial=0.0)
    return float(max(joints, (system.links.length * forces).max(), rows))


def _parts(system: System) -> tuple[Array, Array]:
    """Indices of generalised forces, and of link equations and rows, in a gradient."""
    equations = np.concatenate(
        [
            (system.links.first[:, None] + [2, 3]).ravel(),
            np.arange(system.rows.first, system.size),
        ]
    )
    return np.setdiff1d(np.arange(system.size), equations), equations


def _complementarity(solved: Solved, acting: Flags) -> float:
    """Largest pull of a closed stop, or largest turn beyond an open stop's limit."""
    system, state = solved.system, solved.state
    pulls = np.where(state.driven, state.multipliers(system), -solved.values)[system.limits & acting]
    return float(np.max(pulls, initial=0.0))


def _balance(solved: Solved, scale: float) -> Balance:
    """Resultants of the forces of all rows on nodes and bodies, over the largest force or moment."""
    system, z = solved.system, solved.state.z
    acting, contacts = np.zeros(system.size), solved.state.contacts
    if system.geometry is not None and system.geometry.law is not None and contacts is not None:
        # a law along an axis leaves a moment
        acting += contact_terms(system.geometry, z, contacts.places, contacts.closed)[1]
    add_row_gradient(z, system.rows, solved.state.multipliers(system), acting)
    m = system.mechanism
    bodies = np.array(list(m.bodies.values()), dtype=np.int64)
    references = np.array([m.reference(name) for name in m.bodies]).reshape(-1, 2)
    nodes = np.concatenate([system.nodes[:, 0], system.carried])
    x = np.concatenate([z[nodes], references[:, 0] + z[bodies]])
    y = np.concatenate([z[nodes + 1], references[:, 1] + z[bodies + 1]])
    fx = np.concatenate([acting[nodes], acting[bodies]])
    fy = np.concatenate([acting[nodes + 1], acting[bodies + 1]])
    couples = np.concatenate([acting[system.angles], acting[bodies + 2]])
    moments = np.concatenate([x * fy - y * fx, couples])
    return Balance(float(np.hypot(fx.sum(), fy.sum())) / scale, abs(float(moments.sum())) / scale)

"""What makes a state believable: the certificate of the answer sheet, and which Ending a failure is."""

from __future__ import annotations

import numpy as np

from cprbm.energy import turns
from cprbm.first_equilibrium import Equilibrium
from cprbm.forces import balances
from cprbm.mechanism import Mechanism
from cprbm.overlap import overlap as largest_overlap
from cprbm.point import Point
from cprbm.settings import Settings
from cprbm.stability import smallest_curvature
from cprbm_scene import Certificate, Ending

LARGEST_BEND = 1.0  # rad: change of angle of one spring beyond which a chord no longer stands for its element
BALANCE = 1e-8
COMPLEMENTARITY = 1e-8  # gap times force, over the largest generalised force
# Of the mean thickness. Where rows stand nothing overlaps (the violation says so); between the joints of a zone
# the line dips by a part of h², which is an error of the discretisation and not a failure.
OVERLAP_AUTO = 0.05
OVERLAP_OPEN = 1e-3  # the same where nothing presses: there is no zone then, and each minimum of a gap has a row


def certify(mechanism: Mechanism, settings: Settings, found: Equilibrium) -> tuple[Certificate, Ending]:
    """The certificate of a state, and COMPLETED or the Ending that its first failure means."""
    problem, point, measure = mechanism.problem, found.point, found.measure
    failures: list[tuple[Ending, str]] = []
    asked = max(settings.tolerance, measure.floor)
    if not (found.converged and measure.residual <= asked):
        failures.append((Ending.NOT_CERTIFIED, f"the residual is {measure.residual:.1e}, asked {asked:.1e}"))
    violation_asked = max(settings.tolerance, 1e-13)
    if not measure.violation <= violation_asked:
        said = f"the closures are open by {measure.violation:.1e} of the longest beam, asked {violation_asked:.1e}"
        failures.append((Ending.NOT_CERTIFIED, said))
    if not measure.complementarity <= COMPLEMENTARITY:
        said = f"a contact presses across a gap: gap times force is {measure.complementarity:.1e}"
        failures.append((Ending.NOT_CERTIFIED, said))
    bend = float(np.abs(turns(problem.model, point.state) * (problem.model.couplings > 0.0)).max())
    if not bend <= LARGEST_BEND:
        said = f"one element turns by {bend:.2f} rad, more than {LARGEST_BEND:.1f}: use more links"
        failures.append((Ending.TURNED_TOO_FAR, said))
    overlaps = overlaps_of(mechanism, found)
    penetration = max(overlaps.values(), default=0.0)
    if not penetration <= OVERLAP_AUTO:
        said = f"the beams of a contact overlap by {penetration:.1e} of the mean thickness, allowed {OVERLAP_AUTO:.0e}"
        failures.append((Ending.BEAMS_CROSSED, said))
    for name, overlap in overlaps.items():
        if overlap > OVERLAP_OPEN and _open(mechanism, name, point):
            said = f"in contact '{name}' nothing presses, and overlaps by {overlap:.1e} of the mean thickness"
            failures.append((Ending.BEAMS_CROSSED, said))
    for name, pair in mechanism.alone.items():
        if pair.crosses(point.state, point.at):
            failures.append((Ending.BEAMS_CROSSED, f"in contact '{name}' the beam passes through itself"))
    force_balance, moment_balance = balances(problem, point)
    balance_asked = max(BALANCE, 100.0 * measure.floor)
    if not force_balance <= balance_asked:
        failures.append((Ending.NOT_CERTIFIED, f"ΣF is {force_balance:.1e} of the largest force"))
    if not moment_balance <= balance_asked:
        failures.append((Ending.NOT_CERTIFIED, f"ΣM is {moment_balance:.1e} of the largest moment"))
    curvature = smallest_curvature(problem, point) if found.converged else float("nan")
    if found.converged and not curvature > 0.0:
        said = f"the energy's smallest curvature on the feasible directions is {curvature:.3g} EI/ℓ²"
        failures.append((Ending.NOT_A_MINIMUM, said))
    certificate = Certificate(
        residual=measure.residual,
        residual_floor=measure.floor,
        violation=measure.violation,
        penetration=penetration,
        complementarity=measure.complementarity,
        force_balance=force_balance,
        moment_balance=moment_balance,
        smallest_curvature=curvature,
        iterations=found.iterations,
        failures=tuple(sentence for _, sentence in failures),
    )
    return certificate, failures[0][0] if failures else Ending.COMPLETED


def _open(mechanism: Mechanism, name: str, point: Point) -> bool:
    """Whether a contact is open all along: an end that is clamped in touch may press by its clamp alone."""
    clamped = mechanism.seen(name, point.rows).brought_to(point.state).clamped
    return not any(clamped) and name not in point.rows.pressing(point.lam)


def overlaps_of(mechanism: Mechanism, found: Equilibrium) -> dict[str, float]:
    """By contact the largest overlap of its smooth beams over the mean thickness (the longest beam for lines)."""
    deepest, state, at = {}, found.point.state, found.point.at
    for name in mechanism.near(state, at):
        pair = mechanism.seen(name, found.point.rows)
        deepest[name] = largest_overlap(pair, state, at) / pair.thickness
    return deepest

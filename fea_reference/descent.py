"""Energy descent from a critical point to a minimum of the potential energy.

======  =====================================================================================
symbol  meaning
======  =====================================================================================
Π       potential energy, with the energy of penalties
M       lumped mass
σ       drag: EI per length to the fourth
z_k     states of the descent
φ       critical mode, without positive curvature
======  =====================================================================================

The value is just beyond the critical point, and the start is displaced along φ. Every state is the minimum of

    Π(z) + ½ σ (z − z_k)ᵀ M (z − z_k)

near its predecessor: an implicit Euler step of a motion resisted by drag alone, which cannot raise Π (proximal point
method; Rockafellar, SIAM J. Control Optim. 14 (1976) 877). Contacts and stops remain active as inequalities. σ
decreases while the steps are short, until no drag is needed.

A contact closing during the descent is recorded at the critical value.

Both senses of φ are tried, and the lower minimum counts. For equally low minima the sense of the moments counts.
"""

from dataclasses import replace

import numpy as np

from cprbm_scene.answer import Ints, Loss
from fea_reference.advance import advance
from fea_reference.contacts import zones_of
from fea_reference.curvature import moment_mode
from fea_reference.energy import penalised_energy, potential_energy
from fea_reference.following import CriticalPoint
from fea_reference.march import March
from fea_reference.mass import lumped_mass
from fea_reference.newton import equilibrium
from fea_reference.state import State
from fea_reference.system import Drag, System
from fea_reference.touch import Penalty

_BEYOND = 1e-6  # times the span: distance beyond the critical point
_BEYOND_BIFURCATION = 1e-4  # the same at a bifurcation, where the distance is not critical
_KICKS = (3e-3, 1e-2)  # rad (and lengths): displacements along φ
_FARTHEST = 0.05  # rad (and lengths): largest motion of a step
_AIM = 0.03  # the intended motion of a step; a shorter step is followed by a step without drag
_CONVEX = 2.5  # times a negative curvature: the least drag
_SOFT = 1e-3  # drag against which the moments act at a bifurcation; a larger drag adds stiff motions to the mode
_FIRMER = 1.6  # factor of the drag after a failed step with negative curvature
_RAISED = 4.0  # factor of the drag after any other failed step
_SOFTER = 0.9  # factor of the least drag after a successful step
_SOON = 12  # iterations for a step
_STEPS = 400
_FEW = 60  # steps to a neighbouring state
_MAX_ROTATION_RATIO = 2.0  # times the permitted rotation: a larger rotation ends the descent
_CHANGES = 8  # changes of contacts and stops in a step
_ROUNDED = 1e-9  # relative to the energy
_SAME = 1e-3  # relative to the larger decrease: equally low senses; Newton's residual is 3e-5 of the decrease
_STRONGEST = 1e12


def descend(
    march: March, load: int, target: float, span: float, critical: CriticalPoint, beside: float = np.inf
) -> float | None:
    """Descend from a critical point to a minimum; the dimensionless energy there, or None without a minimum.

    Also None if sections or bodies rotate by more than ``beside`` (rad); a much larger rotation ends the descent.
    """
    saved = march.saved()
    # a contact opening under tight penalties may stay closed under loose ones; a minimum under loose penalties may be
    # none under tight ones, as the critical state itself
    energy = _descend(march, load, target, span, critical, beside, loose=critical.loss is not Loss.CONTACT)
    if energy is None or (march.curvature > 0.0 and march.largest_motion(march.system, critical.system.z) > _KICKS[0]):
        return energy
    march.restore(saved)
    return _descend(march, load, target, span, critical, beside, loose=False)


def _descend(
    march: March, load: int, target: float, span: float, critical: CriticalPoint, beside: float, *, loose: bool
) -> float | None:
    """Energy after a descent with ``loose`` or with the current penalties; None without a minimum."""
    beyond, remaining = _BEYOND_BIFURCATION if critical.loss is Loss.BIFURCATION else _BEYOND, target - critical.value
    march.values[load] = critical.value + float(np.sign(remaining)) * min(beyond * span, abs(remaining))
    if loose:
        march.penalties = {pair: Penalty(pair.stiffness) for pair in march.penalties}
    march.system = critical.system
    march.reassemble()
    least = 10.0 * abs(critical.left) + 1.0
    mode = (
        moment_mode(march.model, critical.system, abs(critical.left) + _SOFT)
        if critical.loss is Loss.BIFURCATION
        else critical.direction
    )
    size = float(np.abs(mode[march.model.moving]).max())
    if not size > 0.0:
        return None
    known, end = dict(march.closing), critical.value * march.model.stepped[load].unit
    iterations, energy = march.iterations, penalised_energy(march.model, march.system, march.values)
    kicks, steps = (_KICKS[:1], _FEW) if np.isfinite(beside) else (_KICKS, _STEPS)
    for kick in kicks:
        trials: list[tuple[float, March, float]] = []
        for sense in (1.0, -1.0):
            trial, drag = march.saved(), least
            start = advance(march.model, critical.system.z, sense * kick / size * mode)
            # a step with too little drag may pass the saddle and turn back
            while drag < _STRONGEST and not (
                _step(trial, load, start, drag, start)
                and _same_sense(march.model.node_dofs[2], critical.system.z, start, trial.system.z)
            ):
                trial, drag = march.saved(), 10.0 * drag
            if drag < _STRONGEST:
                trials.append((energy - penalised_energy(trial.model, trial.system, trial.values), trial, drag))
        most = max((fall for fall, *_ in trials), default=0.0)
        for _, trial, drag in sorted(trials, key=lambda item: item[0] < most - _SAME * abs(most)):
            if _reaches_minimum(trial, load, drag, critical.system.z, _MAX_ROTATION_RATIO * beside, steps):
                march.iterations += trial.iterations - iterations
                march.restore(trial)
                march.tighten()
                march.closing = dict.fromkeys(march.closing, end) | known
                if march.largest_rotation(march.system, critical.system.z) > beside:
                    return None
                return potential_energy(march.model, march.system, march.values)
    return None


def _same_sense(turns: Ints, first: State, second: State, third: State) -> bool:
    """True if the sections' ``turns`` have the same sense from the first state to the second as to the third."""
    return float((second[turns] - first[turns]) @ (third[turns] - first[turns])) > 0.0


def _reaches_minimum(march: March, load: int, drag: float, first: State, farthest: float, steps: int) -> bool:
    """Descend to a minimum within ``steps`` and a rotation ``farthest`` (rad) from ``first``; True on success."""
    march.reassemble()  # without the drag
    convex = _CONVEX
    for _ in range(steps):
        if drag > _STRONGEST or march.largest_rotation(march.system, first) > farthest:
            return False
        if stiffer := march.stiffer_penalties(march.system):
            # on coarse elements the initial penalty may be too soft to prevent passing through
            march.penalties.update(stiffer)
            march.reassemble()
        before, saved = march.system, march.saved()
        energy = penalised_energy(march.model, before, march.values)
        drag = max(drag, -convex * march.curvature)
        if not _step(march, load, before.z, drag, before.z) or _energy_increased(march, energy):
            march.restore(saved)
            soft = -march.curvature
            little = drag < _RAISED * _CONVEX * soft
            drag *= _FIRMER if little else _RAISED
            convex = max(convex, drag / soft) if little else convex
            continue
        march.reassemble()
        convex = max(_SOFTER * convex, _CONVEX)
        moved = march.largest_motion(march.system, before.z)
        drag *= min(max(moved / _AIM, 0.1), 4.0)
        if moved > _AIM or not march.curvature > 0.0:
            continue
        saved, energy = march.saved(), penalised_energy(march.model, march.system, march.values)
        at_rest = _step(march, load, march.system.z, 0.0, march.system.z)
        if at_rest and not _energy_increased(march, energy) and march.curvature > 0.0:
            return march.largest_rotation(march.system, first) <= farthest
        march.restore(saved)
    return False


def _energy_increased(march: March, energy: float) -> bool:
    """True if the energy exceeds ``energy``."""
    return penalised_energy(march.model, march.system, march.values) > energy + _ROUNDED * abs(energy)


def _step(march: March, load: int, anchor: State, drag: float, start: State) -> bool:
    """A proximal step from ``anchor``, with Newton's method started at ``start``; True on success."""
    springs = Drag(anchor, drag * lumped_mass(march.model))
    settings = replace(march.settings, newton_limit=min(_SOON, march.settings.newton_limit))
    for _ in range(_CHANGES):
        solved = equilibrium(
            march.model,
            settings,
            march.penalties,
            march.values,
            start,
            march.acting,
            march.depths(),
            march.pushes(),
            springs if drag > 0.0 else None,
        )
        march.iterations += solved.iterations
        if not solved.converged or march.largest_motion(solved.system, anchor) > _FARTHEST:
            return False
        if not _change_contacts(march, load, solved.system):
            if march.passing_failure(anchor, solved.system, "") is not None:
                return False
            march.system = solved.system
            return True
    return False


def _change_contacts(march: March, load: int, system: System) -> bool:
    """Close overlapping contacts and switch stops as needed; True if there was any change."""
    closing = [pair for pair in march.open if zones_of(march.model, pair, system.z).least < 0.0]
    changing = [stop for stop in march.model.stops if march.stop_margin(stop, system) < 0.0]
    for pair in closing:
        march.open.remove(pair)
        march.penalties[pair] = Penalty(pair.stiffness)
        march.closing[pair.name] = march.value(load)
    for stop in changing:
        march.toggle_stop(stop, load, system)
    return bool(closing or changing)

"""From the end of a branch down to a minimum of the potential energy.

======  =====================================================================================
symbol  meaning
======  =====================================================================================
Π       potential energy with what penalties store
M       lumped mass
σ       drag: EI per length to the fourth
z_k     states on the way
φ       motions along which the end of the branch has no positive curvature
======  =====================================================================================

At a value just beyond the end, and from a state a little aside of it along φ, each state is the minimum of

    Π(z) + ½ σ (z − z_k)ᵀ M (z − z_k)

near the one before: one step, backwards in time, of a motion that only a drag resists, which cannot raise Π (the
proximal point method; Rockafellar, SIAM J. Control Optim. 14 (1976) 877).  Contacts act all the way, stops as
inequalities.  σ falls as long as the steps are short, until none is needed.

What closes on the way closes at the value of the end, at which the motion begins and rests.

Of both senses of φ the lower counts.  Where both lead equally low, the sense of the moments counts.
"""

from dataclasses import replace

import numpy as np

from cprbm_scene.answer import Loss
from fea_reference.advance import advance
from fea_reference.contacts import zones_of
from fea_reference.curvature import leaning
from fea_reference.energy import penalised_energy, potential_energy
from fea_reference.following import Lost
from fea_reference.march import March
from fea_reference.mass import lumped_mass
from fea_reference.newton import equilibrium
from fea_reference.state import State
from fea_reference.system import Drag, System
from fea_reference.touch import Penalty

_BEYOND = 1e-6  # of the span
_ASIDE = 1e-4  # the same where another branch goes off: both are as good as one nearer by
_KICKS = (3e-3, 1e-2)  # rad (and lengths)
_FARTHEST = 0.05  # rad (and lengths): the most that one step may move anything
_AIM = 0.03  # the same that is aimed at; after a step no longer, none but that to the minimum is tried
_CONVEX = 2.5  # times a negative curvature: the least drag that is tried
_FIRMER = 1.6  # times as much drag where curvature is negative, after a step that failed
_RAISED = 4.0  # the same elsewhere
_SOFTER = 0.9  # of that after one that did not
_SOON = 12  # iterations in which a step is found, if it is one
_STEPS = 400
_FEW = 60  # of them, where it is not to lead far
_ASTRAY = 2.0  # times as far as what it is to lead to: what goes farther on the way is followed no further
_CHANGES = 8  # of contacts and stops in one step
_ROUNDED = 1e-9  # of the energy
_SAME = 1e-3  # of the larger fall: two senses lead equally low, the rest of Newton's residual is 3e-5 of the fall
_STRONGEST = 1e12


def descended(march: March, load: int, target: float, span: float, lost: Lost, beside: float = np.inf) -> float | None:
    """Let the march fall from the end of a branch; the energy where it comes to rest, without units, or None.

    None as well where sections or bodies are turned there by more than ``beside``, rad: what goes much farther on the
    way there is followed no further.
    """
    saved = march.saved()
    # what lets go under tight penalties holds on under loose ones, and what stands under loose ones may not under tight
    energy = _descended(march, load, target, span, lost, beside, loose=lost.loss is not Loss.CONTACT)
    if energy is None or march.curvature > 0.0:
        return energy
    march.restore(saved)
    return _descended(march, load, target, span, lost, beside, loose=False)


def _descended(
    march: March, load: int, target: float, span: float, lost: Lost, beside: float, *, loose: bool
) -> float | None:
    """The energy after a fall with ``loose`` penalties, or with the penalties of now."""
    beyond, left = _ASIDE if lost.loss is Loss.BIFURCATION else _BEYOND, target - lost.value
    march.values[load] = lost.value + float(np.sign(left)) * min(beyond * span, abs(left))
    if loose:
        march.penalties = {pair: Penalty(pair.stiffness) for pair in march.penalties}
    march.system = lost.system
    march.renew()
    least = 10.0 * abs(lost.left) + 1.0
    way = leaning(march.model, lost.system, least) if lost.loss is Loss.BIFURCATION else lost.direction
    size = float(np.abs(way[march.model.moving]).max())
    if not size > 0.0:
        return None
    known, end = dict(march.closing), lost.value * march.model.stepped[load].unit
    iterations, energy = march.iterations, penalised_energy(march.model, march.system, march.values)
    kicks, steps = (_KICKS[:1], _FEW) if np.isfinite(beside) else (_KICKS, _STEPS)
    for kick in kicks:
        ways: list[tuple[float, March, float]] = []
        for sense in (1.0, -1.0):
            trial = march.saved()
            start = advance(march.model, lost.system.z, sense * kick / size * way)
            drag = least
            while drag < _STRONGEST and not _step(trial, load, start, drag, start):
                drag *= 10.0
            if drag < _STRONGEST:
                ways.append((energy - penalised_energy(trial.model, trial.system, trial.values), trial, drag))
        most = max((fall for fall, *_ in ways), default=0.0)
        for _, trial, drag in sorted(ways, key=lambda each: each[0] < most - _SAME * abs(most)):
            if _fallen(trial, load, drag, lost.system.z, _ASTRAY * beside, steps):
                march.iterations += trial.iterations - iterations
                march.restore(trial)
                march.tighten()
                march.closing = dict.fromkeys(march.closing, end) | known
                if march.turned(march.system, lost.system.z) > beside:
                    return None
                return potential_energy(march.model, march.system, march.values)
    return None


def _fallen(march: March, load: int, drag: float, first: State, farthest: float, steps: int) -> bool:
    """Fall to a minimum, if there is one to be found in so many ``steps`` and not farther from the ``first`` state."""
    march.renew()  # without the drag
    convex = _CONVEX
    for _ in range(steps):
        if drag > _STRONGEST or march.turned(march.system, first) > farthest:
            return False
        if stiffer := march.stiffer(march.system):
            # on coarse elements a penalty may begin so soft that what presses would go through
            march.penalties.update(stiffer)
            march.renew()
        before, saved = march.system, march.saved()
        energy = penalised_energy(march.model, before, march.values)
        drag = max(drag, -convex * march.curvature)
        if not _step(march, load, before.z, drag, before.z) or _risen(march, energy):
            march.restore(saved)
            soft = -march.curvature
            little = drag < _RAISED * _CONVEX * soft
            drag *= _FIRMER if little else _RAISED
            convex = max(convex, drag / soft) if little else convex
            continue
        march.renew()
        convex = max(_SOFTER * convex, _CONVEX)
        moved = march.moved(march.system, before.z)
        drag *= min(max(moved / _AIM, 0.1), 4.0)
        if moved > _AIM or not march.curvature > 0.0:
            continue
        saved, energy = march.saved(), penalised_energy(march.model, march.system, march.values)
        at_rest = _step(march, load, march.system.z, 0.0, march.system.z)
        if at_rest and not _risen(march, energy) and march.curvature > 0.0:
            return march.turned(march.system, first) <= farthest
        march.restore(saved)
    return False


def _risen(march: March, energy: float) -> bool:
    """Whether the energy is more than it was."""
    return penalised_energy(march.model, march.system, march.values) > energy + _ROUNDED * abs(energy)


def _step(march: March, load: int, anchor: State, drag: float, start: State) -> bool:
    """One step from ``anchor``, sought from ``start``; whether it could be made."""
    held = Drag(anchor, drag * lumped_mass(march.model))
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
            held if drag > 0.0 else None,
        )
        march.iterations += solved.iterations
        if not solved.converged or march.moved(solved.system, anchor) > _FARTHEST:
            return False
        if not _changes(march, load, solved.system):
            if march.passed(anchor, solved.system, "") is not None:
                return False
            march.system = solved.system
            return True
    return False


def _changes(march: March, load: int, system: System) -> bool:
    """Let contacts close that overlap, and stops close or let go that must; whether any had to."""
    closing = [pair for pair in march.open if zones_of(march.model, pair, system.z).least < 0.0]
    changing = [stop for stop in march.model.stops if march.room(stop, system) < 0.0]
    for pair in closing:
        march.open.remove(pair)
        march.penalties[pair] = Penalty(pair.stiffness)
        march.closing[pair.name] = march.value(load)
    for stop in changing:
        march.turn(stop, load, system)
    return bool(closing or changing)

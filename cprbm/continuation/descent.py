"""Energy descent to a minimum.

=======  ====================================================================================
symbol   meaning
=======  ====================================================================================
α        strength of springs from the links to the last state, energy α/2 Σ L (θ − θ_k)²
κ        smallest curvature
m        faint moments (1 + s/ℓ)² per length, s along the beams in the scene's order
u        leaning: response to m against the springs of α just above |κ|
=======  ====================================================================================

Each step minimises Π plus the energy of the springs, so that Π falls from step to step.  Beyond a bifurcation the
branch goes on as a saddle: the descent begins there, else at the last minimum.  The first step leans by u in either
sense, and follows the lower of both.  Moments of the first degree would do no work on the antisymmetric mode of a beam
clamped at both ends.  With α near |κ| the softest mode has the largest part in u; with α = 2|κ| the distance from the
saddle doubles in a step.

The springs of the first step are so stiff that no link turns farther than by the kick and with the drives.  No later
step turns back behind a decrease of Π: a softer step may pass the saddle and end on the other side.  The springs soften
while steps are short, stiffen where a step fails, and vanish near the minimum.

Where both senses lead equally low, as at a symmetric bifurcation, the sense of m counts.  Several modes may soften at
a single load: u has all of them in fixed parts.  Neither the mesh nor the order of assembly decides.
"""

from dataclasses import replace

import numpy as np

from cprbm.continuation.closing import with_stops
from cprbm.continuation.path import potential
from cprbm.equilibrium import NotConvergedError, Solved, Springs, State, System, at_state, blocked, softest
from cprbm_scene.answer import Array, Flags

STEPS = 300
"""Steps of a descent."""

KICK = 2e-3
"""Largest turn of the first motion, rad."""

LONGEST = 0.3
"""Largest turn in one step, rad."""

SOFTEST = 1.1
"""Strength of the springs over |κ| against which the faint moments turn the links: the softest mode grows tenfold."""

STIFFER = 4.0
SOFTER = 0.5
STIFFEST = 1e12
"""Largest strength of the springs over the first: beyond it nothing moves."""

RIGID = 1e6
"""Strength of the springs over the first, under which links turn with the drives alone."""

NEAR = 0.05
"""Turn of a step, rad, after which a decreasing motion may end without springs."""

STILL = 1e-9
"""Turn of a step, rad, below which the motion has ended."""

KICKS = 5
"""Saddles that a descent may come to."""

TRIES = 20
"""Strengths of the springs for the first step, at first with a state in both senses, then in one sense alone."""

SAME = 1e-3
"""Relative difference of two energies' decreases that counts as none: a mirror image differs by the residual."""

ROUND_OFF = 1e-12
"""Relative difference of two energies that counts as none."""


def descend(system: System, saddle: Solved, curvature: float, target: Array, acting: Flags, iterations: int) -> Solved:
    """The minimum under ``target``, by decrease of the energy from a state with a smallest ``curvature`` near zero.

    Raises:
        NotConvergedError: the descent does not end.
    """
    start = replace(saddle.state, target=target)
    beyond = _step(system, start, 0.0, acting, iterations)
    if beyond is not None and blocked(beyond).lost and _moved(system, start, beyond.state) < NEAR:
        # beyond a bifurcation the branch goes on as a saddle, without a force along the mode
        start, curvature = beyond.state, softest(beyond).curvature
    state, strength = _kicked(system, start, curvature, acting, iterations)
    energy, last, kicks, stiffest = potential(system, state), 0.0, 0, STIFFEST * strength
    for _ in range(STEPS):
        step = _step(system, state, strength, acting, iterations)
        moved = _moved(system, state, step.state) if step is not None else np.inf
        if (
            step is None
            or moved > LONGEST
            or _turns_back(system, start, state, step.state)
            or potential(system, step.state) > energy + ROUND_OFF * abs(energy)
        ):
            strength *= STIFFER
            if strength > stiffest:
                break
            continue
        start, state, energy = state, step.state, potential(system, step.state)
        if (moved < NEAR and moved <= last) or moved < STILL:
            found = _step(system, state, 0.0, acting, iterations)
            if found is not None and _moved(system, state, found.state) < LONGEST:
                if blocked(found).lost == 0:
                    return found
                # a saddle above the state, such as the begin of the descent, is not on the way down
                if kicks < KICKS and potential(system, found.state) <= energy + ROUND_OFF * abs(energy):
                    kicks, start = kicks + 1, found.state
                    state, strength = _kicked(system, start, softest(found).curvature, acting, iterations)
                    energy, last = potential(system, state), 0.0
                    continue
            if moved < STILL:
                break
        strength *= SOFTER if moved < 0.5 * LONGEST else 1.0
        last = moved
    raise NotConvergedError("the descent does not end in a minimum")


def _kicked(system: System, start: State, curvature: float, acting: Flags, iterations: int) -> tuple[State, float]:
    """The lower of the states after a first step in either sense of the leaning, and the springs' strength.

    Raises:
        NotConvergedError: no step works.
    """
    soft, leaning = SOFTEST * abs(curvature) + 1e-6, np.zeros(system.size)
    leaning[system.angles] = system.metric * (1.0 + np.cumsum(system.metric)) ** 2
    while (held := at_state(system, start, Springs(soft, start.z[system.angles]))).lost and soft < STIFFEST:
        soft *= STIFFER
    change = held.response(leaning)
    change[system.rows.first :] = 0.0
    change *= KICK / np.abs(change[system.angles]).max()
    kicked = [replace(start, z=start.z + sense * change) for sense in (1.0, -1.0)]
    energy = potential(system, start)
    # a drive ahead of the critical point turns links, however stiff the springs
    driven = _step(system, start, RIGID * soft, acting, iterations)
    longest = KICK + (_moved(system, start, driven.state) if driven is not None else 0.0)
    for number in range(2 * TRIES):
        strength = 2.0 * soft * STIFFER ** (number % TRIES)
        steps = [(each, _step(system, each, strength, acting, iterations)) for each in kicked]
        ways = [(each, step.state) for each, step in steps if step is not None]
        # soft springs hold no state on the way down; the springs stiffen until both senses have states, if they ever do
        if len(ways) > 1 - number // TRIES and max(_moved(system, *way) for way in ways) <= longest:
            states = [state for _, state in ways]
            energies = [potential(system, state) for state in states]
            equal = SAME * abs(energy - min(energies)) + ROUND_OFF * abs(energy)
            return states[int(energies[0] - min(energies) > equal)], strength
    raise NotConvergedError("the descent does not begin")


def _step(system: System, state: State, strength: float, acting: Flags, iterations: int) -> Solved | None:
    """Minimum of Π plus the springs' energy near a state, without springs any equilibrium; None where none is found."""
    springs = Springs(strength, state.z[system.angles]) if strength else None
    try:
        found = with_stops(system, state, acting, iterations, springs)
    except NotConvergedError:
        return None
    return None if springs and found.lost else found


def _moved(system: System, before: State, after: State) -> float:
    """Largest turn of a link between two states."""
    return float(np.abs(after.z - before.z)[system.angles].max())


def _turns_back(system: System, first: State, second: State, third: State) -> bool:
    """True if the links turn back behind the second state after the energy has decreased on the way to that state."""
    turns = (second.z - first.z) * (third.z - second.z)
    return bool(system.metric @ turns[system.angles] < 0.0) and potential(system, second) < potential(system, first)

"""How far to go along a Newton step while a contact changes where it acts.

======  =====================================================================================
symbol  meaning
======  =====================================================================================
p       the step's share of the motions; the multipliers and axial forces have theirs already
α       the fraction of p that is gone
φ'(α)   p·(unbalanced forces on the motions after α p): slope of the Lagrangian along the step
======  =====================================================================================

A zone of contact that the step closes or opens changes the stiffness, and full steps can swing between two
zones for ever.  Along p the energy of a penalty is convex: where full length overshoots the least value, a
root of φ' lies within it (Matthies and Strang, Int. J. Numer. Meth. Engng 14 (1979) 1613).
"""

from collections.abc import Callable

from fea_reference.system import System

_OVERSHOT = 0.5  # of the slope at the start, that the slope at the end may have
_TRIALS = 6


def searched(after: Callable[[float], System], slope: Callable[[System], float], start: float) -> System:
    """The system near the least energy along a step: after all of it, unless that overshoots.

    Args:
        after: the system after a fraction of the step; slope: φ' of it; start: φ'(0).
    """
    system = after(1.0)
    end = slope(system)
    if start >= 0.0 or end <= -_OVERSHOT * start:
        return system
    low, high, slope_low, slope_high = 0.0, 1.0, start, end
    for _ in range(_TRIALS):
        fraction = (low * slope_high - high * slope_low) / (slope_high - slope_low)
        fraction = min(max(fraction, low + 0.1 * (high - low)), high - 0.1 * (high - low))
        system = after(fraction)
        now = slope(system)
        if abs(now) <= -_OVERSHOT * start:
            break
        if now < 0.0:
            low, slope_low = fraction, now
        else:
            high, slope_high = fraction, now
    return system

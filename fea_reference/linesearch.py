"""Line search along a Newton step while contact zones change.

======  =====================================================================================
symbol  meaning
======  =====================================================================================
p       the motions of the step; multipliers and axial forces take their full step
α       fraction of p
φ'(α)   p·(residual of the motions at α): slope of the Lagrangian along the step
======  =====================================================================================

A step that closes or opens a zone changes the stiffness, and full steps may oscillate between two zones for ever.
Along p the energy of a penalty is convex: if the full step overshoots the minimum, φ' has a root within the step
(Matthies and Strang, Int. J. Numer. Meth. Engng 14 (1979) 1613).
"""

from collections.abc import Callable

from fea_reference.system import System

_OVERSHOT = 0.5  # times the initial slope: accepted slope at the end
_TRIALS = 6


def line_search(after: Callable[[float], System], slope: Callable[[System], float], start: float) -> System:
    """System near the energy minimum along a step: at the full step unless this overshoots.

    Args:
        after: the system after a fraction of the step; slope: φ' of a system; start: φ'(0).
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

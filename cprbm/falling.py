"""Whether a fold may hide in a step of a drive: what holds it falls where it rose before, or more than its rates say.

======  =========================================================================================
symbol  meaning
======  =========================================================================================
h       the step, a part of the way on which drives go evenly
F       dΠ/dv along a branch, what holds the drives per unit of the way: −μ·(−∂Z/∂v)
w       h dF/dv at either end of the step, :mod:`cprbm.rate`
======  =========================================================================================

Before a fold F falls ever faster, and beyond it, on another branch, it is less.  In a step that leads from where F
still rises to where it falls, a fold may be in between as well as a smooth top; so it may where F has dropped by more
than (w_a + w_b)/2.  Over a smooth top either is the less the shorter the step; what F jumps by stays.
"""

from __future__ import annotations

DROPPED = 0.6  # of what F changes by: by how much it may be less than its rates say
NOTICED = 0.01  # of F: less than that is a bend


def falling(forces: tuple[float, float], rates: tuple[float, float]) -> bool:
    """Whether F falls so in a step that it must be looked for in shorter ones.

    Args:
        forces: F at both ends.
        rates: w at both ends.
    """
    rise, (w_a, w_b) = forces[1] - forces[0], rates
    least = NOTICED * max(map(abs, forces))
    if w_a > 0.0 > w_b and min(w_a, -w_b) > least:
        return True
    return 0.5 * (w_a + w_b) - rise > max(DROPPED * max(abs(rise), abs(w_a), abs(w_b)), least)

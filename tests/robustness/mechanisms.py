"""Mechanisms of one to three beams, laid out in units of the first beam's chord, which goes along x.

Each function adds bodies, beams and pins to a draft.  What of them can be loaded or driven is seen from the data.
"""

from __future__ import annotations

from math import cos, sin

from tests.robustness.chance import any_of, between, happens, sign, weighted
from tests.robustness.draft import Draft


def cantilever(draft: Draft) -> None:
    """A beam from the wall to a body that is free, or to nothing."""
    rng = draft.rng
    draft.body("wall", "fixed", {"R": (0.0, 0.0)})
    if happens(rng, 0.3):
        draft.body("mark", "fixed", {"Z": (1.0, 0.0)})
        ends = [("weld", "R"), ("free", "Z")]
        if happens(rng, 0.3):
            ends.reverse()
        draft.beam("beam1", ends[0], ends[1])
        del draft.data["bodies"]["mark"]
        return
    points = {"T": (1.0, 0.0)}
    if happens(rng, 0.4):
        points["Q"] = (1.0 + between(rng, -0.2, 0.4), between(rng, -0.3, 0.3))
    draft.body("tip", "free", points)
    draft.beam("beam1", ("weld", "R"), ("weld", "T"))


def guided(draft: Draft) -> None:
    """A beam from the wall to a slide, with or without rotation, or to a lever on a pivot."""
    rng = draft.rng
    draft.body("wall", "fixed", {"R": (0.0, 0.0)})
    a = between(rng, 0.5, 2.6) * sign(rng)
    kind = weighted(rng, (("slide", 1.0), ("slot", 1.2), ("lever", 1.5)))
    joints = weighted(rng, ((("weld", "weld"), 0.5), (("weld", "pin"), 0.35), (("pin", "weld"), 0.25)))
    if kind == "slide":
        draft.body("tip", "slides", {"T": (1.0, 0.0)}, along=_along(draft, a))
    elif kind == "slot":
        draft.body("tip", "slides", {"T": (1.0, 0.0)}, along=_along(draft, a), turns=True)
        joints = ("weld", "weld")
    else:
        pivot = (1.0 + 0.5 * cos(a) * between(rng, 0.4, 1.0), 0.5 * sin(a) * between(rng, 0.4, 1.0))
        draft.body("tip", "turns", {"P": pivot, "T": (1.0, 0.0)}, about="P")
    draft.beam("beam1", (joints[0], "R"), (joints[1], "T"))


def _along(draft: Draft, angle: float) -> list[float]:
    x, y = draft.frame.direction((cos(angle), sin(angle)))
    return [round(x, 4), round(y, 4)]


def bridge(draft: Draft) -> None:
    """A bowed beam between two places of the wall."""
    rng = draft.rng
    draft.body("wall", "fixed", {"R": (0.0, 0.0), "S": (1.0, 0.0)})
    joints = weighted(
        rng, ((("weld", "weld"), 0.3), (("weld", "pin"), 0.4), (("pin", "weld"), 0.2), (("pin", "pin"), 0.3))
    )
    draft.beam("beam1", (joints[0], "R"), (joints[1], "S"))


def parallel(draft: Draft) -> None:
    """Two or three beams from the wall to one body."""
    rng = draft.rng
    n = 2 if happens(rng, 0.7) else 3
    gap = between(rng, 0.2, 0.7)
    lean = between(rng, -0.6, 0.6) * gap
    roots = {f"R{i + 1}": (between(rng, -0.1, 0.1), i * gap) for i in range(n)}
    tips = {f"T{i + 1}": (1.0 + between(rng, -0.1, 0.1), lean + i * gap * between(rng, 0.6, 1.1)) for i in range(n)}
    draft.body("wall", "fixed", roots)
    draft.body("stage", "free", tips | {"Q": (1.2, 0.5 * gap)})
    bowed = between(rng, 0.1, 0.5)
    for i in range(n):
        joint = "pin" if happens(rng, 0.2) and i > 0 else "weld"
        draft.beam(f"beam{i + 1}", ("weld", f"R{i + 1}"), (joint, f"T{i + 1}"), bowed=bowed)


def series(draft: Draft) -> None:
    """A beam to a body from which another one leads on, to a body of its own or back to the wall."""
    rng = draft.rng
    draft.body("wall", "fixed", {"R": (0.0, 0.0), "W": (between(rng, 0.6, 1.4), sign(rng) * between(rng, 0.7, 1.1))})
    draft.body("knee", "free", {"K": (1.0, 0.0), "K2": (1.0, 0.12 * sign(rng)), "Q": (1.15, 0.0)})
    draft.beam("beam1", ("weld", "R"), ("weld", "K"), bowed=0.6)
    if happens(rng, 0.5):
        joint = any_of(rng, ("weld", "pin"))
        draft.beam("beam2", ("weld", "K2"), (joint, "W"), bowed=0.6)
    else:
        a = between(rng, -1.8, 1.8)
        reach = between(rng, 0.5, 1.0)
        draft.body("tip", "free", {"T": (1.0 + reach * cos(a), reach * sin(a))})
        draft.beam("beam2", ("weld", "K"), ("weld", "T"), bowed=0.6)


def linked(draft: Draft) -> None:
    """A beam whose body carries another one by a pin, which slides or is on a pivot."""
    rng = draft.rng
    draft.body("wall", "fixed", {"R": (0.0, 0.0)})
    Q = (1.0 + between(rng, 0.0, 0.2), between(rng, -0.15, 0.15))
    draft.body("tip", "free", {"T": (1.0, 0.0), "Q": Q})
    draft.beam("beam1", ("weld", "R"), ("weld", "T"))
    a, b = between(rng, 0.0, 6.28), between(rng, 0.4, 1.2) * sign(rng)
    J, K = Q, (Q[0] + 0.4 * cos(a), Q[1] + 0.4 * sin(a))
    if happens(rng, 0.5):
        draft.body("car", "slides", {"J": J, "K": K}, along=_along(draft, a + b), turns=True, about="K")
    else:
        draft.body("car", "turns", {"J": J, "K": K}, about="K")
    draft.data["pins"] = {"joint": {"points": ["Q", "J"]}}


MECHANISMS = (
    (cantilever, 0.30),
    (guided, 0.24),
    (bridge, 0.08),
    (parallel, 0.12),
    (series, 0.12),
    (linked, 0.13),
)

"""Beams pressed onto random tiny bodies on both sides, against the linear complementarity problem of points."""

import numpy as np
import pytest

from tests.cprbm.test_bump import bump
from tests.cprbm.test_tiny_bodies import beam_onto, solved
from tests.fea_reference.on_an_edge import T
from tests.references.pressed import Pressed


def body(random, place, gap, side):
    """A circle, a knife or a bump whose top is a ``gap`` below a line, or above it where ``side`` is −1."""
    top = -side * gap
    match random.integers(3):
        case 0:
            radius = 10.0 ** random.uniform(-4.0, -2.0)
            return {"kind": "beam-circle", "center": (place, top - side * radius), "radius": radius}
        case 1:
            left, right = 10.0 ** random.uniform(-4.0, -1.0, 2)
            foot = top - side * 10.0 ** random.uniform(-2.0, -0.5)
            points = ((place - left, foot), (place, top), (place + right, foot))
            return {"kind": "beam-line", "points": points, "side": "left" if side > 0.0 else "right"}
    return bump(place, top, 10.0 ** random.uniform(-3.5, -1.7), 10.0 ** random.uniform(-2.0, -1.0), side)


def drawn(random):
    """A load that bends a beam by 0.006 to 0.03, and bodies in its way: their places, gaps and sides."""
    size, tip = 10.0 ** random.uniform(-2.2, -1.5), ("free", "pinned", "clamped")[random.integers(3)]
    at = 1.0 if tip == "free" else random.uniform(0.3, 0.7)
    load = Pressed(tip, force=-size * {"free": 3.0, "pinned": 50.0, "clamped": 96.0}[tip], at=at)
    places = random.permutation(np.arange(0.1, 0.98, 0.11))[: random.integers(1, 5)] + random.uniform(-0.02, 0.02)
    moved = np.abs(load.compliance(places)[0][:-1])
    sides = np.where(random.random(len(places)) < 0.8, 1.0, -1.0)
    gaps = np.maximum(np.where(sides > 0.0, moved, size) * random.uniform(0.05, 0.9, len(places)), 1e-4)
    return load, places, gaps, sides


@pytest.mark.parametrize("links", [20, 40])
@pytest.mark.parametrize("seed", range(12))
def test_what_is_drawn_presses_as_points_do(seed, links):
    random = np.random.default_rng(seed)
    load, places, gaps, sides = drawn(random)
    thick = bool(random.random() < 0.5)
    half = 0.5 * T if thick else 0.0
    every = zip(places.tolist(), gaps.tolist(), sides.tolist(), strict=True)
    contacts = {f"c{i}": body(random, x, gap + half, side) for i, (x, gap, side) in enumerate(every)}
    values = solved(beam_onto(contacts, load, thick=thick), links)
    forces, _ = load.onto(places, gaps, sides)
    # what a gap that is off by a part of the square of the slope would change, and 3 %
    near = [load.onto(places, gaps + 2e-3 * gaps.max() * np.eye(len(gaps))[i], sides)[0] for i in range(len(gaps))]
    allowed = 0.03 * forces.max() + np.sum(np.abs(np.array(near) - forces), axis=0)
    assert np.all(np.abs([values[f"{name}.force"][0] for name in contacts] - forces) <= allowed)

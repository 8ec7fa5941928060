"""Straight beams that bend by little and press on what leaves them less, at random, with their answers in closed form.

Reference: Euler and Bernoulli's beam. Its Green's functions make of places that may touch a linear complementarity
problem: no push pulls, no gap is negative, and only one of both is more than zero. What slopes add is of the order of
their squares, 1e-4 of the pushes and less.
"""

import itertools
from dataclasses import dataclass

import numpy as np
from scipy.optimize import nnls

T, WIDTH = 0.01, 0.05
YOUNG = 12.0 / (WIDTH * T**3)  # makes EI one
KINDS = ("circle", "knife", "line's end", "bump")


@dataclass(frozen=True)
class Span:
    """A straight beam from ``begin`` on, clamped there (at its other end if ``turned``), or at both ends."""

    begin: float = 0.0
    length: float = 1.0
    stiffness: float = 1.0
    both: bool = False
    turned: bool = False

    def by(self, x, at):
        """Deflections at ``x`` under unit forces ``at``."""
        x, at = (1.0 - u if self.turned else u for u in ((one - self.begin) / self.length for one in (x, at)))
        near, far = np.minimum(x, at), np.maximum(x, at)
        rest = 1.0 - far
        clamped = rest**2 * near**2 * (3.0 * far - near * (3.0 * far + rest)) / 6.0
        return (clamped if self.both else near**2 * (3.0 * far - near) / 6.0) * self.length**3 / self.stiffness


@dataclass(frozen=True)
class Drawn:
    """A scene as plain data; ``pushes`` by contact, ``ways`` down by point; ``load`` and its ``way`` to judge by."""

    data: dict
    pushes: dict
    ways: dict
    load: float
    way: float

    def worst(self, values):
        """Errors of pushes over the largest, and of ways over that of the load alone."""
        largest = max(self.load, *self.pushes.values())
        pushes = [abs(np.nan_to_num(values[f"{name}.force"]).item() - push) for name, push in self.pushes.items()]
        ways = [abs(-values[f"{name}.displacement"][1] - way) for name, way in self.ways.items()]
        return max(pushes) / largest, max(ways) / self.way


def obstacle(random, kind, beam, x, y, side, thick):
    """A contact whose highest place is at (x, y); lowest, if it is above the beam, with side −1."""
    common = {"beam": beam, "body": "ground", "thick": thick}
    radius, slope = float(10.0 ** random.uniform(-4, -2)), float(np.tan(random.uniform(0.05, 1.0)))
    half, lean, sense = random.uniform(0.03, 1.0), random.uniform(-0.3, 0.3), float(random.choice([-1.0, 1.0]))
    free = "left" if side > 0.0 else "right"
    if kind == "circle":
        return {"kind": "beam-circle", "center": [x, y - side * radius], "radius": radius, **common}
    if kind == "knife":
        feet = [[x + 0.2 * np.sin(a), y - side * 0.2 * np.cos(a)] for a in (lean - half, lean + half)]
        points = [feet[0], [x, y], feet[1], feet[0]]
        return {"kind": "beam-line", "points": np.array(points).tolist(), "side": free, **common}
    if kind == "line's end":
        free = free if sense > 0.0 else {"left": "right", "right": "left"}[free]
        points = [[x, y], [x + sense * 0.2, y - side * slope * 0.2]]
        return {"kind": "beam-line", "points": points, "side": free, **common}
    bent, wide = side / (2.0 * radius), min(6.0 * radius, np.sqrt(0.3 * radius))
    return {
        "kind": "beam-function",
        "axis": "x",
        "coefficients": [y - bent * x * x, 2.0 * bent * x, -bent],
        "range": [float(x - wide), float(x + wide)],
        "side": "above" if side > 0.0 else "below",
        **common,
    }


def apart(random, low, high, n):
    """Some places that are not very near each other."""
    while True:
        places = np.sort(random.uniform(low, high, n))
        if n < 2 or np.diff(places).min() > 0.03:
            return places


def scene_of(spans, ends, thicknesses, contacts, load, at):
    """Beams ``b0`` and so on between ``ends``, the clamped one first, and a force down on the first."""
    bodies = {"ground": {"motion": "fixed", "points": {f"r{i}": list(root) for i, (root, _) in enumerate(ends)}}}
    for i, (span, (root, tip)) in enumerate(zip(spans, ends, strict=True)):
        along = {"motion": "slides", "along": list(np.subtract(tip, root))} if span.both else {"motion": "free"}
        bodies[f"k{i}"] = {**along, "points": {f"t{i}": list(tip)}}
    beams = {
        f"b{i}": {
            "curve": {"kind": "line", "start": list(root), "end": list(tip)},
            "thickness": thickness,
            "width": WIDTH,
            "material": "m",
            "start": {"joint": "weld", "point": f"r{i}"},
            "end": {"joint": "weld", "point": f"t{i}"},
        }
        for i, ((root, tip), thickness) in enumerate(zip(ends, thicknesses, strict=True))
    }
    return {
        "name": "small",
        "theory": "bending",
        "materials": {"m": {"youngs_modulus": YOUNG, "poisson_ratio": 0.3}},
        "bodies": bodies,
        "beams": beams,
        "loads": {"P": {"kind": "beam_force", "beam": "b0", "at": at, "direction": [0.0, -1.0]}},
        "contacts": contacts,
        "stages": [{"name": "load", "steps": "P", "stations": [load]}],
        "probes": [{"of": name, "quantity": "force"} for name in contacts]
        + [{"of": f"t{i}", "quantity": "displacement"} for i in range(len(spans))],
    }


def one_beam(seed, kinds=KINDS, magnitude=(-4.0, -2.3)):
    """A beam before one to four obstacles, whose gaps are up to a thousandth of the way of the load alone.

    ``magnitude`` is that of this way over the length.
    """
    random = np.random.default_rng(seed)
    span = Span(both=bool(random.random() < 0.5))
    at = float(random.uniform(0.2, 0.8)) if span.both else 1.0
    way = 10.0 ** random.uniform(*magnitude)
    load = float(way / span.by(at, at))
    x = apart(random, 0.05, 0.98, int(random.integers(1, 5)))
    sides = np.where(random.random(x.size) < 0.7, 1.0, -1.0)
    gaps = np.maximum(load * span.by(x, at), 1e-3 * way) * 0.9 * 10.0 ** random.uniform(-3, 0, x.size)
    thick = bool(random.random() < 0.6)
    contacts = {}
    for i in range(x.size):
        y = float(-sides[i] * (gaps[i] + 0.5 * T * thick))
        contacts[f"c{i}"] = obstacle(random, random.choice(kinds), "b0", float(x[i]), y, sides[i], thick)
    compliance = span.by(x[:, None], x) * sides[:, None] * sides
    pushes = _complementary(compliance, load * span.by(x, at) * sides - gaps)
    tip = load * span.by(1.0, at) - (span.by(1.0, x) * sides) @ pushes
    data = scene_of([span], [((0.0, 0.0), (1.0, 0.0))], [T], contacts, load, at)
    return Drawn(data, dict(zip(contacts, pushes, strict=True)), {"t0": tip}, load, way)


def two_beams(seed, magnitude=(-4.0, -2.3), places=300):
    """Two beams beside each other, the second of which may stand before obstacles; their gap may vary along them."""
    random = np.random.default_rng(seed)
    length, thickness = float(random.uniform(0.3, 1.0)), float(T * 10.0 ** random.uniform(-0.3, 0.3))
    begin = float(random.uniform(-0.2, 1.0 - 0.5 * length))
    both, turned = random.random(2) < 0.33, bool(random.random() < 0.5)
    spans = [Span(both=bool(both[0])), Span(begin, length, (thickness / T) ** 3, bool(both[1]), turned)]
    at = float(random.uniform(0.2, 0.8)) if both[0] else 1.0
    way = 10.0 ** random.uniform(*magnitude)
    load = float(way / spans[0].by(at, at))
    thick = bool(random.random() < 0.7)
    least, slope = way * 10.0 ** random.uniform(-3, 0), way * 10.0 ** random.uniform(-2, 0.5) * random.integers(-1, 2)
    low, high = max(0.0, begin), min(1.0, begin + length)

    def gap(x):
        return least + slope * (x - (low if slope > 0.0 else high))

    x, x_o = np.linspace(low, high, places), apart(random, begin + 0.05 * length, begin + 0.98 * length, 2)
    x_o = x_o[: random.integers(0, 3)]
    sides, gaps = np.where(random.random(x_o.size) < 0.7, 1.0, -1.0), way * 10.0 ** random.uniform(-4, 0, x_o.size)
    distance = 0.5 * (T + thickness) * thick
    contacts = {"pair": {"kind": "beam-beam", "between": ["b0", "b1"][:: random.choice([-1, 1])], "thick": thick}}
    for i, (place, side) in enumerate(zip(x_o, sides, strict=True)):
        y = float(-distance - gap(place) - side * (gaps[i] + 0.5 * thickness * thick))
        contacts[f"o{i}"] = obstacle(random, random.choice(KINDS), "b1", float(place), y, side, thick)
    first, second = spans
    between = -second.by(x[:, None], x_o) * sides
    compliance = np.block(
        [
            [first.by(x[:, None], x) + second.by(x[:, None], x), between],
            [between.T, second.by(x_o[:, None], x_o) * sides[:, None] * sides],
        ]
    )
    pushes = _least_squares(compliance, np.concatenate([load * first.by(x, at) - gap(x), -gaps]))
    root, tip = (begin, begin + length)[:: -1 if turned else 1]
    down = {
        "t0": load * first.by(1.0, at) - first.by(1.0, x) @ pushes[: x.size],
        "t1": second.by(tip, x) @ pushes[: x.size] - (second.by(tip, x_o) * sides) @ pushes[x.size :],
    }
    ends = [((0.0, 0.0), (1.0, 0.0)), *[tuple((float(p), float(-distance - gap(p))) for p in (root, tip))]]
    data = scene_of(spans, ends, [T, thickness], contacts, load, at)
    found = dict(zip(contacts, [pushes[: x.size].sum(), *pushes[x.size :]], strict=True))
    return Drawn(data, found, down, load, way)


def _complementary(compliance, over):
    """Pushes f ≥ 0 with C f ≥ ``over``, and equal to it where f > 0: by trial, few that they are."""
    n = over.size
    for pressing in itertools.chain.from_iterable(itertools.combinations(range(n), k) for k in range(n + 1)):
        f, some = np.zeros(n), list(pressing)
        f[some] = np.linalg.solve(compliance[np.ix_(some, some)], over[some])
        if (f >= 0.0).all() and (compliance @ f - over >= -1e-12 * np.abs(over).max()).all():
            return f
    raise AssertionError("some of the pushes always do")


def _least_squares(compliance, over):
    """The same of many places, as the least energy of pushes that do not pull."""
    n = over.size
    values, vectors = np.linalg.eigh(compliance + 1e-13 * np.trace(compliance) / n * np.eye(n))
    roots = np.sqrt(np.maximum(values, 1e-15 * values.max()))
    return nnls((vectors * roots).T, (vectors / roots).T @ over, maxiter=50 * n)[0]

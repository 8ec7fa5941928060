"""Where beam 2 of section 3.4 jumps, by what is read into the text and by who solves it.

The paper has the crank turned from 0° to 90° and sees beam 2 jump between 35° and 36°.  Its words leave open which way
the crank turns, of what line the end of a beam stays within 45°, which joints touch, and what degree the fitted curve
has; and a jump can be the mechanism's or the optimiser's.  Each piece takes one answer to all of that:

- *followed*: the branch of minima from α = 0 by small steps with exact derivatives, to where it ends and how
  (:mod:`readings_path`); from there to the state that an optimiser finds beside it, and on; and back to 0°.
- *optimised*: a general optimiser at each station, from its answer at the station before or always from one start.

A jump is a link that turns by :data:`JUMP` more than is ordinary from one station to the next.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from itertools import pairwise
from typing import Literal

import numpy as np
from scipy import optimize

from comparisons import cases
from comparisons.studies import readings_peers as peers
from comparisons.studies.readings_optimisers import Ipopt, Optimiser, Slsqp, TrustConstr, Units, bounds
from comparisons.studies.readings_path import End, State, constraints, followed, settled
from comparisons.studies.readings_problem import PAPER, Array, Mechanism, Problem, Reading
from cprbm_scene import Line, Scene
from cprbm_scene.frozendict import frozendict

JUMP = np.radians(15.0)
"""By this a link turns further than it may in an ordinary step."""
ORDINARY = 1.6
"""So much a link may turn for the crank's turn; on the branches it is about 1.5 at most."""
THEIRS = (np.radians(35.0), np.radians(36.0))
TOP = 90
TOUCHING = 1e-7
"""m or rad: a joint this near is counted as touching, and a limit as acting."""
SECONDS = 3.0
"""What an optimiser may take for one station."""

Way = Literal["forwards", "backwards"]
Start = Literal["neighbour", "state at 0°", "straight beams"]
Shape = Literal["inwards", "outwards", "beam 2 over"]


@dataclass(frozen=True, slots=True)
class Followed:
    """A branch to follow in steps of whole degrees, from 0° forwards, and back where that is asked.

    ``shape`` is how the beams bulge where it begins; ``beam 2 over`` begins at 90° and is followed backwards alone.
    """

    name: str
    reading: Reading
    step: int = 1
    shape: Shape = "inwards"
    back: bool = False


@dataclass(frozen=True, slots=True)
class Optimised:
    """An optimiser to ask in steps of whole degrees."""

    name: str
    reading: Reading
    optimiser: Optimiser
    start: Start = "neighbour"
    step: int = 2
    back: bool = False


Variant = Followed | Optimised


@dataclass(frozen=True, slots=True)
class Stood:
    """What was found at a station, rad, J, N·m; ``turned`` since the station before, rad, (2,) by beam.

    ``moment`` is None where an optimiser answered, ``turned`` at the first station; ``held`` says whether a limit acts.
    """

    alpha: float
    energy: float
    moment: float | None
    touching: int
    held: bool
    turned: tuple[float, float] | None


@dataclass(frozen=True, slots=True)
class Jump:
    """Between which stations, rad, which beam, and the energy on both sides, J."""

    before: float
    after: float
    beam: int
    energies: tuple[float, float]


@dataclass(frozen=True, slots=True)
class Track:
    """One way of a variant.

    Attributes:
        stood: the stations with an answer, in their order.
        ends: of the branches that were followed.
        failed: stations without an answer, rad, and why.
        timed_out: at how many stations the time was up.
    """

    variant: Variant
    way: Way
    stood: tuple[Stood, ...]
    ends: tuple[End, ...] = ()
    failed: tuple[tuple[float, str], ...] = ()
    timed_out: int = 0

    @property
    def jumps(self) -> tuple[Jump, ...]:
        """All of them."""
        return tuple(
            Jump(a.alpha, b.alpha, 1 + int(b.turned[1] > b.turned[0]), (a.energy, b.energy))
            for a, b in pairwise(self.stood)
            if b.turned is not None and max(b.turned) > JUMP + ORDINARY * abs(b.alpha - a.alpha)
        )

    @property
    def as_theirs(self) -> bool:
        """Whether the first jump lies between the paper's angles, to what the stations and the end can tell."""
        if self.way == "backwards" or not self.jumps:
            return False
        if self.ends:
            return bool(THEIRS[0] <= self.ends[0].alpha <= THEIRS[1])
        return bool(self.jumps[0].before < THEIRS[1] and self.jumps[0].after > THEIRS[0])

    @property
    def at_rest(self) -> float | None:
        """Where the crank's moment changes its sign to the stable side, rad: a position that holds itself."""
        known = [(each.alpha, each.moment) for each in self.stood if each.moment is not None]
        known.sort()
        for (a, low), (b, high) in pairwise(known):
            if low < 0.0 <= high:
                return float(a - low * (b - a) / (high - low))
        return None


@dataclass(frozen=True, slots=True)
class Crossing:
    """Where the branch with both beams inwards stops being the lower of two, rad; None: it does not."""

    limits: str
    alpha: float | None


@dataclass(frozen=True, slots=True)
class Readings:
    """All that is measured so far; ``left_out`` names the variants that could not be asked."""

    tracks: tuple[Track, ...] = ()
    left_out: tuple[str, ...] = ()

    def with_piece(self, piece: tuple[Track, ...] | str) -> Readings:
        """The same and the tracks of one variant more, or the name of one that is left out."""
        if isinstance(piece, str):
            return Readings(self.tracks, (*self.left_out, piece))
        return Readings((*self.tracks, *piece), self.left_out)

    def of(self, reading: Reading, way: Way, shape: Shape = "inwards") -> Track | None:
        """The followed track of a reading."""
        for track in self.tracks:
            asked = track.variant
            if isinstance(asked, Followed) and (asked.reading, asked.shape, track.way) == (reading, shape, way):
                return track
        return None

    @property
    def crossings(self) -> tuple[Crossing, ...]:
        """Where the lowest state changes, by what the limit leaves to beam 2 once it is over."""
        found = []
        for name, before, over, shape in _RIVALS:
            ahead, back = self.of(before, "forwards"), self.of(over, "backwards", shape)
            if ahead is not None and back is not None:
                found.append(Crossing(name, _crossing(ahead, back)))
        return tuple(found)


UNITS: tuple[Units, ...] = ("J, m", "mJ, mm")
STARTS: tuple[Start, ...] = ("neighbour", "state at 0°", "straight beams")
NEAREST = Reading(degree=None, reach=PAPER.beam, clamped=False)
"""No fitted curve: every joint of beam 1 that can move keeps the distance t from the nearest link of beam 2."""
_FREE, _OVER = Reading(limits="none"), Reading(limits="flipped")
_RIVALS: tuple[tuple[str, Reading, Reading, Shape], ...] = (
    ("no limit", _FREE, _FREE, "inwards"),
    ("45° from the line to the other pin", Reading(), Reading(), "inwards"),
    ("45° as the acute angle of two lines", Reading(), _OVER, "beam 2 over"),
)

VARIANTS: tuple[Variant, ...] = (
    Followed("true contact", NEAREST, back=True),
    Followed("curve of degree 4", Reading(), back=True),
    *(Followed(f"degree {degree}", Reading(degree=degree)) for degree in (3, 5, 6, 7, 8)),
    Followed("without the joint at the clamp", Reading(clamped=False)),
    Followed("all joints, degree 6", Reading(degree=6, reach=PAPER.beam)),
    Followed("clockwise", Reading(sense=-1)),
    Followed("no limit", _FREE, back=True),
    Followed("limit on one side", Reading(limits="one side")),
    Followed("limit from the opposite line", Reading(limits="away"), shape="outwards"),
    Followed("acute angle, beam 2 over", _OVER, shape="beam 2 over"),
    Followed("limit from the crank's arm", Reading(limits="arm")),
    Followed("limit from BC at 0°", Reading(limits="fixed")),
    Followed("limit from the vertical", Reading(limits="vertical")),
    Optimised("SLSQP, J and m", Reading(), Slsqp("J, m"), back=True),
    Optimised("SLSQP, mJ and mm", Reading(), Slsqp("mJ, mm")),
    Optimised("SLSQP, differences", Reading(), Slsqp("J, m", differences=True), step=10),
    Optimised("SLSQP, J and m", Reading(), Slsqp("J, m"), "state at 0°"),
    Optimised("SLSQP, J and m", Reading(), Slsqp("J, m"), "straight beams"),
    Optimised("trust-constr, J and m", Reading(), TrustConstr("J, m"), step=10),
    *(
        Optimised(
            f"IPOPT, {units.replace(',', ' and')}", Reading(), Ipopt(units), start, step=1, back=start == "neighbour"
        )
        for units in UNITS
        for start in STARTS
    ),
    *(
        Optimised(
            f"IPOPT, J and m, first barrier {barrier:g}", Reading(), Ipopt("J, m", frozendict(mu_init=barrier)), step=1
        )
        for barrier in (0.01, 0.3, 1.0)
    ),
    Optimised(
        "IPOPT, J and m, adaptive barrier",
        Reading(),
        Ipopt("J, m", frozendict(mu_strategy="adaptive")),
        step=1,
        back=True,
    ),
    Optimised(
        "IPOPT, J and m, updated Hessian",
        Reading(),
        Ipopt("J, m", frozendict(hessian_approximation="limited-memory")),
        step=2,
    ),
    Optimised("IPOPT, J and m, no limit", _FREE, Ipopt("J, m"), step=1, back=True),
    Optimised("IPOPT, J and m, degree 5", Reading(degree=5), Ipopt("J, m"), step=1),
)

Piece = Callable[[], tuple[Track, ...] | str]


def mechanism_of(scene: Scene) -> Mechanism:
    """The lengths of a scene that is built like the case ``prestressed``."""
    beam, points = scene.beams["beam2"], scene.bodies["crank"].points
    line = beam.curve
    assert isinstance(line, Line), "the beams are straight"
    along = np.array([0.5])
    A, C = points["A"], points["C"]
    return Mechanism(
        beam=float(np.hypot(line.end[0] - line.start[0], line.end[1] - line.start[1])),
        thickness=float(beam.thickness_at(along)[0]),
        width=float(beam.width_at(along)[0]),
        youngs_modulus=scene.materials[beam.material].youngs_modulus,
        base=line.start[0],
        OA=A[1],
        AD=C[1] - A[1],
        BD=C[0] - A[0],
    )


def pieces(
    mechanism: Mechanism | None = None, variants: tuple[Variant, ...] = VARIANTS, top: int = TOP, links: int = 40
) -> tuple[Piece, ...]:
    """What is to be measured up to ``top`` degrees, each piece a function without arguments; by default on the case."""
    mechanism = mechanism or mechanism_of(cases.opened("prestressed"))
    return tuple(partial(_measured, mechanism, variant, top, links) for variant in variants)


def _measured(mechanism: Mechanism, variant: Variant, top: int, links: int) -> tuple[Track, ...] | str:
    problem = Problem(mechanism, variant.reading, links)
    if isinstance(variant, Followed):
        return _followed(problem, variant, top)
    if isinstance(variant.optimiser, Ipopt) and not peers.there():
        return f"{variant.name}, from {variant.start}"
    return _optimised(problem, variant, top)


def bulging(problem: Problem, shape: Shape) -> Array:
    """z of beams that are bent about as the shape says, to begin from."""
    s = np.linspace(0.0, 1.0, problem.links)
    upright = np.full(problem.links, 0.5 * np.pi)
    late = 1.2 * np.clip(s - 0.4, 0.0, 0.6) / 0.6
    match shape:
        case "inwards":
            return np.concatenate((upright + late, upright - late))
        case "outwards":
            return np.concatenate((upright + 0.9 - 2.2 * s, upright - 0.9 + 2.2 * s))
        case "beam 2 over":
            return np.concatenate(
                (upright + 2.4 * s, upright - 1.2 * np.sin(np.pi * np.minimum(1.4 * s, 1.0)) + 2.0 * s**2)
            )


def begun(problem: Problem, alpha: float, near: Array) -> State | None:
    """A minimum beside ``near``: by SLSQP in lengths of a link and energies of a spring, then exactly."""
    lower, upper = bounds(problem, alpha)
    k, length = problem.stiffness, problem.mechanism.beam / problem.links
    found = optimize.minimize(
        lambda z: problem.energy(z)[0] / k,
        np.clip(near, lower, upper),
        jac=lambda z: problem.energy(z)[1] / k,
        method="SLSQP",
        bounds=list(zip(lower, upper, strict=True)),
        constraints=[
            {
                "type": "eq",
                "fun": lambda z: problem.closure(z, alpha)[0] / length,
                "jac": lambda z: problem.closure(z, alpha)[1] / length,
            },
            {
                "type": "ineq",
                "fun": lambda z: -problem.contact(z)[0] / length,
                "jac": lambda z: -problem.contact(z)[1] / length,
            },
        ],
        options={"maxiter": 1500, "ftol": 1e-13},
    )
    g, G = constraints(problem, found.x, alpha)
    acting = np.flatnonzero(np.concatenate((np.ones(4, dtype=bool), g[4:] > -1e-8)))
    least = np.where(acting < 4, -np.inf, 0.0)
    multipliers = np.zeros(len(g))
    multipliers[acting] = optimize.lsq_linear(G[acting].T, -problem.energy(found.x)[1], bounds=(least, np.inf)).x
    return settled(
        problem, alpha, found.x, multipliers, [int(i) - 4 for i in acting if multipliers[i] > 1e-6 and i > 3]
    )


def _followed(problem: Problem, variant: Followed, top: int) -> tuple[Track, ...]:
    ahead = tuple(float(np.radians(degree)) for degree in range(0, top + 1, variant.step))
    if variant.shape == "beam 2 over":
        start = begun(problem, ahead[-1], bulging(problem, variant.shape))
        return (_walked(problem, variant, "backwards", start, ahead[::-1])[0],)
    start = begun(problem, 0.0, bulging(problem, variant.shape))
    track, last = _walked(problem, variant, "forwards", start, ahead)
    if not variant.back or last is None:
        return (track,)
    return track, _walked(problem, variant, "backwards", last, ahead[::-1])[0]


def _walked(
    problem: Problem, variant: Followed, way: Way, start: State | None, stations: tuple[float, ...]
) -> tuple[Track, State | None]:
    """From branch to branch where the way back is asked for, else to the first station behind the first end.

    The second value is the last state, where the last station was reached.
    """
    states: list[State] = []
    ends: list[End] = []
    state, left = start, stations
    while state is not None and left and (variant.back or not ends):
        path = followed(problem, state, left)
        states.extend(path.states)
        left = left[len(path.states) :]
        if path.end is None:
            state = path.last
        else:
            ends.append(path.end)
            state = begun(problem, left[0], path.last.z)
            if state is not None and not variant.back:
                states.append(state)
    failed = ((left[0], "no state is found beside the last one"),) if state is None else ()
    stood = tuple(
        _stood(problem, state.alpha, state.z, before.z if before else None, state.moment)
        for before, state in zip([None, *states][: len(states)], states, strict=True)
    )
    return Track(variant, way, stood, tuple(ends), failed), states[-1] if states and not left else None


def _optimised(problem: Problem, variant: Optimised, top: int) -> tuple[Track, ...]:
    assembled = begun(problem, 0.0, bulging(problem, "inwards"))
    assert assembled is not None, "the beams of every optimised variant can be assembled"
    ahead = tuple(float(np.radians(degree)) for degree in range(0, top + 1, variant.step))
    track, last = _asked(problem, variant, "forwards", ahead, assembled.z)
    if not variant.back:
        return (track,)
    return track, _asked(problem, variant, "backwards", ahead[::-1], last)[0]


def _asked(
    problem: Problem, variant: Optimised, way: Way, stations: tuple[float, ...], first: Array
) -> tuple[Track, Array]:
    """The track, and the last answer."""
    start = problem.straight if variant.start == "straight beams" else first
    stood: list[Stood] = []
    failed: list[tuple[float, str]] = []
    late = 0
    last: Array | None = None
    for alpha in stations:
        answer = variant.optimiser(problem, alpha, start, SECONDS)
        late += answer.timed_out
        if answer.why:
            failed.append((alpha, answer.why))
            continue
        stood.append(_stood(problem, alpha, answer.z, last, None))
        last = answer.z
        if variant.start == "neighbour":
            start = last
    return Track(variant, way, tuple(stood), (), tuple(failed), late), first if last is None else last


def _stood(problem: Problem, alpha: float, z: Array, before: Array | None, moment: float | None) -> Stood:
    touching = int(np.sum(problem.contact(z)[0] > -TOUCHING))
    turned = None
    if before is not None:
        each = np.max(np.abs((z - before).reshape(2, -1)), axis=-1)
        turned = float(each[0]), float(each[1])
    lower, upper = bounds(problem, alpha)
    held = bool(np.any(np.minimum(z - lower, upper - z) < TOUCHING))
    return Stood(alpha, float(problem.energy(z)[0]), moment, touching, held, turned)


def _crossing(ahead: Track, back: Track) -> float | None:
    """Where the energies of two branches are the same, between stations by a straight line; rad."""
    until = ahead.ends[0].alpha if ahead.ends else np.inf
    others = {each.alpha: each.energy for each in back.stood}
    both = [(each.alpha, each.energy - others[each.alpha]) for each in ahead.stood if each.alpha in others]
    for (a, low), (b, high) in pairwise(both):
        if b <= until and low <= 0.0 < high:
            return float(a - low * (b - a) / (high - low))
    return None

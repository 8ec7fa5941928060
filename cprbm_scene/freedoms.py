"""Mobility of the mechanism: pins, supports, loose bodies, motions held twice, actions without a motion.

=======  ===============================================================================
symbol   meaning
=======  ===============================================================================
u, v, ω  small translations, and rotation times ℓ, of a part about the scene's origin
e        unit vector of a drive, a force or a guide
r        place of a point less the origin, m
ℓ        extent of all points, m: rows are pure numbers
=======  ===============================================================================

The displacement of a point along e is (e, r × e/ℓ)·(u, v, ω); a rotation is (0, 0, 1)·(u, v, ω).  All parts have the
same origin: parts with a common motion have common rows.  Rows state the geometry of the initial position.

=======  ==============================================================================
symbol   meaning
=======  ==============================================================================
A        rows of guides, pins and drives over the freedoms of all bodies
B        the same with every beam as a further rigid body, and rows of the beams' joints
=======  ==============================================================================

The rows of pins and drives must be independent in A: a linkage with a dependent row closes only by chance.  The null
space of B contains the motions without bending: no force resists them.  A load or drive acts on a movable body, along a
motion that no guide and no other drive holds.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence

import numpy as np

from cprbm_scene.curve_records import MEETING
from cprbm_scene.curves import Array, unit_vector
from cprbm_scene.fields import Record
from cprbm_scene.mistakes import Mistake, broken, first_alone, first_broken, written_place
from cprbm_scene.names import MECHANICAL, connected, references
from cprbm_scene.statement import (
    BeamForce,
    BeamMoment,
    BodyLoad,
    DisplacementDrive,
    Drive,
    FixedBody,
    Force,
    FreeEnd,
    Moment,
    PinnedEnd,
    Point,
    RotationDrive,
    Scene,
    SlidingBody,
    TurningBody,
    WeldedEnd,
)

NEGLIGIBLE = 1e-9
"""Share of a row, or of a unit vector, that counts as round-off."""
DEPENDENT = 1.5 * NEGLIGIBLE
"""Part of a row of length one, normal to the rows before, that counts as round-off: rounded directions differ so."""

TURN = np.array([0.0, 0.0, 1.0])
AXES = ((1.0, 0.0), (0.0, 1.0))


class Freedoms:
    """Rows of the parts of a scene; ``owners`` are the names of bodies by point, ``drives`` hold from the start.

    A row (3,) is that of a single part.  A wide row (3·parts,) has the freedoms of all bodies and then of all beams.
    """

    def __init__(self, scene: Scene) -> None:
        self.scene, self.owners = scene, scene.owners
        self.places = {point: np.array(scene.bodies[name].points[point]) for point, name in self.owners.items()}
        self.origin = next(iter(self.places.values()), np.zeros(2))
        self.extent = (
            max((float(np.hypot(*(place - self.origin))) for place in self.places.values()), default=0.0) or 1.0
        )
        self.parts = [*scene.bodies, *scene.beams]
        later = {stage.name for stage in scene.stages[1:]}
        self.drives = {name: drive for name, drive in scene.drives.items() if drive.begins not in later}

    def along(self, point: str, direction: Point) -> Array:
        """Row of the displacement of a ``point`` along a direction."""
        e, (x, y) = unit_vector(direction), (self.places[point] - self.origin) / self.extent
        return np.array([e[0], e[1], x * e[1] - y * e[0]])

    def pivot(self, point: str) -> list[Array]:
        """Rows of the displacements of a ``point``."""
        return [self.along(point, axis) for axis in AXES]

    def guide(self, name: str) -> list[Array]:
        """Rows of the motions of a body without freedom: all of a fixed body, across a guide, of a pivot."""
        match self.scene.bodies[name]:
            case FixedBody():
                return list(np.eye(3))
            case SlidingBody() as body:
                across = self.along(body.pin or next(iter(body.points)), (-body.along[1], body.along[0]))
                return [across] if body.pin is not None else [across, TURN]
            case TurningBody(about=about):
                return self.pivot(about)
        return []

    def parts_of(self, record: Record) -> set[str]:
        """Names of the bodies and beams that a record refers to, by their points or by name."""
        named = ((of.kind, name) for of, _, name in references(record) if of.kind in MECHANICAL)
        return {self.owners[name] if kind == "point" else name for kind, name in named}

    def owner(self, acting: BodyLoad | Drive) -> str:
        """Name of the body of a load or drive."""
        return acting.body if isinstance(acting, Moment | RotationDrive) else self.owners[acting.point]

    def row(self, acting: BodyLoad | Drive) -> Array:
        """Row of the motion prescribed by a drive, or conjugate to a load."""
        return TURN if isinstance(acting, Moment | RotationDrive) else self.along(acting.point, acting.direction)

    def wide(self, rows: Mapping[str, Array]) -> Array:
        """Wide row of length one with the ``rows`` of parts."""
        row = np.concatenate([rows.get(part, np.zeros(3)) for part in self.parts])
        return np.asarray(row / np.linalg.norm(row))

    def tied(self, one: str, other: str, rows: Iterable[Array]) -> list[Array]:
        """Wide rows of two parts with the same motions ``rows``."""
        return [self.wide({one: row, other: -row}) for row in rows]

    def constraints(self, drives: Mapping[str, Drive]) -> Iterator[tuple[str, Array]]:
        """Keys and wide rows of guides, pins and some ``drives``."""
        for name in self.scene.bodies:
            yield from ((f"bodies.{name}", self.wide({name: row})) for row in self.guide(name))
        for name, pin in self.scene.pins.items():
            one, other = (self.owners[point] for point in pin.points)
            yield from ((f"pins.{name}", row) for row in self.tied(one, other, self.pivot(pin.points[0])))
        for name, drive in drives.items():
            yield f"drives.{name}", self.wide({self.owner(drive): self.row(drive)})

    def joints(self) -> Iterator[Array]:
        """Wide rows of the beams' ends, with every beam as a rigid part."""
        for name, end in ((name, end) for name, beam in self.scene.beams.items() for _, end, _ in beam.ends):
            if not isinstance(end, FreeEnd):
                rows = np.eye(3) if isinstance(end, WeldedEnd) else self.pivot(end.point)
                yield from self.tied(name, self.owners[end.point], rows)


def independent(rows: Sequence[Array]) -> list[bool]:
    """For every row, True if the row does not depend on the rows before: the Gram-Schmidt process, done twice."""
    basis, found = np.zeros((0, len(rows[0]) if rows else 0)), []
    for row in rows:
        rest = row / np.linalg.norm(row)
        for _ in range(2):
            rest = rest - basis.T @ (basis @ rest)
        found.append(bool(np.linalg.norm(rest) > DEPENDENT))
        basis = np.vstack((basis, rest / np.linalg.norm(rest))) if found[-1] else basis
    return found


FREEDOMS = 3
"""Freedoms of a rigid body in the plane."""

_KINDS = {"slides": "sliding", "turns": "turning"}
_ACTING = {"moment": "a moment on", "force": "a force at", "rotation": "a drive of", "displacement": "a drive at"}
_HELD = {"pins": "bodies", "drives": "a motion", "bodies": "a motion"}


def wrong_mobility(scene: Scene) -> Iterator[Mistake]:
    """Pins between unsuitable points, missing supports, motions with two holders, loose bodies.

    Only a whole mechanism has supports and motions.
    """
    freedoms = Freedoms(scene)
    yield from _pins(freedoms)
    if not scene.whole():
        return
    loose = list(unsupported(freedoms))
    yield from (mistake for mistake, names in loose if not _acted_on(freedoms, names))
    joining = all(len(freedoms.parts_of(pin)) > 1 for pin in scene.pins.values())
    if scene.pins and joining:
        keys, rows = zip(*freedoms.constraints(scene.drives), strict=True)
        yield from (
            Mistake(
                key,
                f"{_HELD[key.partition('.')[0]]} that guides, pins and drives hold already where it begins",
                "as many pins and drives as there are motions to hold, each for one of its own",
            )
            for key in dict.fromkeys(key for key, free in zip(keys, independent(rows), strict=True) if not free)
        )
    if joining and not loose and scene.assembly is None:
        yield from _loose(freedoms)


def _pins(freedoms: Freedoms) -> Iterator[Mistake]:
    """Pins within a body, between fixed bodies, or between distant points."""
    bodies, places = freedoms.scene.bodies, freedoms.places
    for key, (p, q) in ((f"pins.{name}.points", pin.points) for name, pin in freedoms.scene.pins.items()):
        one, other, apart = freedoms.owners[p], freedoms.owners[q], float(np.hypot(*(places[p] - places[q])))
        yield from first_broken(
            one == other
            and Mistake(key, f"{p!r} and {q!r}, both of the body {one!r}", "points of two different bodies"),
            bodies[one].motion == bodies[other].motion == "fixed"
            and Mistake(key, f"points of two fixed bodies, {one!r} and {other!r}", "one that moves"),
            not apart <= MEETING * np.ptp(list(places.values()), axis=0).max()
            and Mistake(
                key,
                f"points {apart:.3g} m apart: {written_place(places[p])} m and {written_place(places[q])} m",
                f"at most {MEETING:g} of the scene's extent between them",
            ),
        )


def unsupported(freedoms: Freedoms) -> Iterator[tuple[Mistake, set[str]]]:
    """Scenes without ground or drives, beams without supports, bodies without a way to a support.

    Beside each mistake stand the names of the bodies and beams that move together.
    """
    scene = freedoms.scene
    if all(body.motion == "free" for body in scene.bodies.values()) and not freedoms.drives:
        yield Mistake("bodies", "no fixed body", 'at least one body with motion = "fixed"'), set()
        return
    for name, beam in scene.beams.items():
        joints = [end.joint for _, end, _ in beam.ends if end.joint != "free"]
        mistakes = broken(
            not joints
            and Mistake(
                f"beams.{name}", "two free ends", "at least one end that meets a body, or a contact that holds the beam"
            ),
            joints == ["pin"]
            and Mistake(
                f"beams.{name}",
                "a pin at one end and nothing at the other: the beam turns freely",
                "a weld, joints at both ends, or a contact or a load",
            ),
        )
        yield from ((mistake, {name}) for mistake in mistakes)
    met = {name: freedoms.parts_of(each) for name, each in (*scene.beams.items(), *scene.pins.items())}
    for name, body in scene.bodies.items():
        together, reached = connected({name}, met.values()), any(name in bodies for bodies in met.values())
        guides = [row for each in together for row in freedoms.guide(each)]
        driven = [freedoms.row(drive) for drive in freedoms.drives.values() if freedoms.owner(drive) in together]
        if sum(independent(guides + driven)) < FREEDOMS:
            yield (
                Mistake(
                    f"bodies.{name}",
                    f"a {_KINDS.get(body.motion, 'free')} body that no "
                    f"{'fixed body holds' if reached else 'beam meets'}",
                    "beams that lead to a fixed body, or slides, pivots, drives, contacts and loads that hold it"
                    if reached
                    else "a beam's end, a pin, a contact or a load on it",
                ),
                together | {beam for beam in met if met[beam] & together},
            )


def _acted_on(freedoms: Freedoms, names: set[str]) -> bool:
    """True if a contact with other parts, a load or a drive may hold the bodies and beams of the ``names``."""
    scene = freedoms.scene
    acting = (freedoms.parts_of(each) | {""} for each in (*scene.loads.values(), *scene.drives.values()))
    touching = map(freedoms.parts_of, scene.contacts.values())
    return any(parts & names and parts - names for parts in (*acting, *touching))


def _loose(freedoms: Freedoms) -> Iterator[Mistake]:
    """Bodies with a motion in the null space of B; of a scene without pins, contacts and stops may hold their parts."""
    scene = freedoms.scene
    held = set[str]().union(*map(freedoms.parts_of, (*scene.contacts.values(), *scene.stops.values())))
    rows = [
        *(freedoms.wide({name: row}) for name in (() if scene.pins else held) for row in np.eye(3)),
        *(row for _, row in freedoms.constraints(freedoms.drives)),
        *freedoms.joints(),
    ]
    _, values, motions = np.linalg.svd(np.array(rows))
    null_space = motions[np.count_nonzero(values > NEGLIGIBLE) :]
    for i, name in enumerate(scene.bodies):
        own = [motion for motion in null_space[:, 3 * i : 3 * i + 3] if np.abs(motion).max() > NEGLIGIBLE]
        if own:
            how = _in_words(freedoms, own[0]) if len(null_space) == 1 else f"move in {sum(independent(own))} ways"
            yield Mistake(
                f"bodies.{name}",
                f"a body that can {how} where it is without bending a beam",
                "pins, guides, drives and beams that hold it",
            )


def _in_words(freedoms: Freedoms, motion: Array) -> str:
    """A small motion (3,) of a body: a turn about a place, or a displacement along a direction."""
    u, v, turn = np.where(np.abs(motion) <= NEGLIGIBLE * np.abs(motion).max(), 0.0, motion)
    if turn == 0.0:
        x, y = unit_vector((float(u), float(v))) * np.sign(u if abs(u) > abs(v) else v)
        return f"move along [{x + 0.0:.4g}, {y + 0.0:.4g}]"
    x, y = freedoms.origin + freedoms.extent * np.array([-v, u]) / turn
    return f"turn about [{x + 0.0:.4g}, {y + 0.0:.4g}] m"


def wrong_actions(scene: Scene) -> Iterator[Mistake]:
    """Loads and drives of fixed bodies or across guides, and motions with two drives or with a drive and a load."""
    freedoms, driven = Freedoms(scene), dict[str, Drive]()
    loads = {f"loads.{name}": load for name, load in scene.loads.items() if isinstance(load, BodyLoad)}
    for key, acting in ({f"drives.{name}": drive for name, drive in scene.drives.items()} | loads).items():
        mistakes = list(_without_motion(freedoms, key, acting, driven))
        yield from mistakes
        if not (isinstance(acting, BodyLoad) or mistakes):
            driven[key] = acting
    for name, load in scene.loads.items():
        if isinstance(load, BeamForce | BeamMoment) and load.at in (0.0, 1.0):
            _, end, _ = scene.beams[load.beam].ends[int(load.at)]
            held = end.point in freedoms.owners and scene.bodies[freedoms.owners[str(end.point)]].motion == "fixed"
            yield from broken(
                held
                and not (isinstance(load, BeamMoment) and isinstance(end, PinnedEnd))
                and Mistake(
                    f"loads.{name}.at",
                    f"{load.at:g}, an end of {load.beam!r} that is held at {end.point!r}, a point of a fixed body",
                    "a place of the beam that can move",
                )
            )


@first_alone
def _without_motion(
    freedoms: Freedoms, key: str, acting: BodyLoad | Drive, driven: Mapping[str, Drive]
) -> Iterator[Mistake]:
    """The mistake of a fixed body, or of a motion that a guide or the ``driven`` motions of the same body hold.

    Loads compete with drives that hold from the start only.
    """
    scene, owner, load = freedoms.scene, freedoms.owner(acting), isinstance(acting, BodyLoad)
    body, turns = scene.bodies[owner], isinstance(acting, Moment | RotationDrive)
    movable = {name: each.points for name, each in scene.bodies.items() if each.motion != "fixed"}
    names = movable if turns else [point for points in movable.values() for point in points]
    place, of = ("body", "") if turns else ("point", f" {getattr(acting, 'point', '')!r}, a point of")
    yield from broken(
        body.motion == "fixed"
        and Mistake(
            f"{key}.{place}",
            f"{_ACTING[acting.kind]}{of} the fixed body {owner!r}",
            f"a {place} that can move: {', '.join(map(repr, names)) or 'there is none'}",
        )
    )
    row, guide = freedoms.row(acting), freedoms.guide(owner)
    drives = {
        name: drive for name, drive in driven.items() if freedoms.owner(drive) == owner and not (load and drive.begins)
    }
    opposed = [name for name, drive in drives.items() if _opposed(freedoms, acting, drive)]
    across = not independent([*guide, row])[-1]
    twice = bool(opposed) or not independent([*guide, *map(freedoms.row, drives.values()), row])[-1]
    first = " and ".join(opposed or drives)
    yield from broken(
        across
        and turns
        and Mistake(
            f"{key}.body", f"the rotation of {owner!r}, which slides and does not turn", "a body that can turn"
        ),
        across
        and Mistake(
            f"{key}.direction",
            f"a direction {'towards the pivot' if isinstance(body, TurningBody) else 'across the slide'} of {owner!r}",
            "a direction along which the point can move",
        ),
        twice
        and load
        and Mistake(
            key,
            f"a load on a freedom of {owner!r} that is driven by {first}",
            "a load or a drive on one freedom, not both",
        ),
        twice
        and Mistake(key, f"a freedom of {owner!r} that is driven already by {first}", "one drive for each freedom"),
    )


def _opposed(freedoms: Freedoms, load: BodyLoad | Drive, drive: Drive) -> bool:
    """True for a force at the place of a driven displacement, with a component along the displacement."""
    return (
        isinstance(load, Force)
        and isinstance(drive, DisplacementDrive)
        and bool(
            np.abs(freedoms.places[load.point] - freedoms.places[drive.point]).max() <= NEGLIGIBLE * freedoms.extent
        )
        and abs(float(unit_vector(load.direction) @ unit_vector(drive.direction))) > NEGLIGIBLE
    )

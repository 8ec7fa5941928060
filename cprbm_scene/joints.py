"""Ends of beams and their points, assembly, stops: checks of the drawn places of joints."""

from collections.abc import Iterator
from math import atan2, degrees, dist, pi, tau

import numpy as np

from cprbm_scene.curve_records import MEETING, shape_of
from cprbm_scene.mistakes import Mistake, broken, first_broken, written_place
from cprbm_scene.statement import Beam, PinnedEnd, Scene, Stop, TurningBody, WeldedEnd

TAUT = 1e-6
"""Share of the length by which a beam must exceed the distance of its points: a taut beam is straight."""
ROUNDED = 1e-6
"""Angle, rad, by which a stop's angle as drawn may exceed a limit: coordinates are rounded."""
STRAIGHT = 1e-9
"""Distance, rad, from −π within which an angle counts as π: rounded coordinates yield both."""


def distant_ends(scene: Scene) -> Iterator[Mistake]:
    """Ends of beams away from their points, unless an assembly brings them together."""
    for name, beam in scene.beams.items():
        for side, joint, place in beam.ends:
            apart, point = _distance(scene, beam, side), str(joint.point)
            yield from broken(
                apart > 0.0
                and not (side == "end" and (is_apart(scene, beam) or scene.lacks("", "assembly")))
                and Mistake(
                    f"beams.{name}.{side}",
                    f"a beam end that meets no body: the curve's {side} is at {written_place(place)} m, the point "
                    f"{point!r} at {written_place(scene.place_of(point))} m, {apart:.3g} m apart",
                    f"at most {MEETING:g} of the beam's length between them",
                )
            )


def is_apart(scene: Scene, beam: Beam) -> bool:
    """True if an assembly brings the beam's end to the point."""
    return scene.assembly is not None and isinstance(beam.end, PinnedEnd) and _distance(scene, beam, "end") > 0.0


def _distance(scene: Scene, beam: Beam, side: str) -> float:
    """Distance of an end from the point, m; zero if the end meets the point or has none."""
    point = getattr(beam, side).point
    apart = dist(getattr(beam.curve, side), scene.place_of(point)) if point in scene.owners else 0.0
    return apart if apart > MEETING * shape_of(beam.curve).length else 0.0


def wrong_assembly(scene: Scene) -> Iterator[Mistake]:
    """An assembly without distant ends, moments on other ends, beams too short for their points."""
    if scene.assembly is None:
        return
    apart = [name for name, beam in scene.beams.items() if is_apart(scene, beam)]
    yield from broken(
        not apart
        and scene.whole()
        and Mistake(
            "assembly",
            "no beam with an end to be brought to its point",
            "a beam whose pinned end is drawn apart from its point, or no assembly",
        ),
        *(
            name not in apart
            and Mistake(
                f"assembly.moments.{name}",
                f"a moment on {name!r}, whose end is where it belongs",
                f"a beam whose end is drawn apart: {', '.join(map(repr, apart))}",
            )
            for name in (scene.assembly.moments if apart else ())
        ),
    )
    for name in apart:
        beam = scene.beams[name]
        point, length = str(beam.end.point), shape_of(beam.curve).length
        reach = dist(beam.curve.start, scene.place_of(point))
        yield from broken(
            not isinstance(beam.start, WeldedEnd)
            and Mistake(
                f"beams.{name}.start",
                f"a {beam.start.joint!r} at the start of a beam whose end is to be brought to its point",
                "a weld: the beam has to stand by itself before it is assembled",
            ),
            isinstance(beam.start, WeldedEnd)
            and _stays(scene, beam.start.point)
            and _stays(scene, point)
            and reach >= (1.0 - TAUT) * length
            and Mistake(
                f"beams.{name}.end",
                f"a beam too short to reach {point!r}: {length:.6g} m long, on a way of {reach:.6g} m",
                "a beam that is longer than the way between its two points",
            ),
        )


def _stays(scene: Scene, point: str | None) -> bool:
    """True if a point is at rest without loads and with all drives at zero."""
    name = scene.body_of(str(point))
    body, turned = scene.bodies[name], [getattr(drive, "body", None) for drive in scene.drives.values()]
    return body.motion == "fixed" or (isinstance(body, TurningBody) and (body.about == point or name in turned))


def wrong_stops(scene: Scene) -> Iterator[Mistake]:
    """Stops of an end without pin or with another stop, without direction, or with limits exceeded in the drawing."""
    taken, owners = dict[tuple[str, str], str](), scene.owners
    for name, stop in scene.stops.items():
        key, first = f"stops.{name}", taken.setdefault((stop.beam, stop.end), name)
        joint = getattr(scene.beams[stop.beam], stop.end)
        body, other = owners.get(joint.point), owners[stop.towards]
        yield from broken(
            first != name
            and Mistake(key, f"the {stop.end} of {stop.beam!r}, which stops.{first} limits", "one stop for each end")
        )
        mistakes = first_broken(
            not isinstance(joint, PinnedEnd)
            and Mistake(
                f"{key}.end",
                f"the {stop.end} of {stop.beam!r}, whose joint is {joint.joint!r}",
                "an end whose joint is 'pin'",
            ),
            body != other
            and Mistake(
                f"{key}.towards",
                f"{stop.towards!r}, a point of {other!r}",
                f"a point of {body!r}, to which the end is pinned",
            ),
            body == other
            and scene.place_of(stop.towards) == scene.place_of(joint.point)
            and Mistake(f"{key}.towards", f"{stop.towards!r}, which is where the pin is", "a point away from it"),
        )
        drawn = stop.end == "start" or not is_apart(scene, scene.beams[stop.beam])
        yield from list(mistakes) or (_exceeded_as_drawn(scene, key, stop) if drawn else ())


def _exceeded_as_drawn(scene: Scene, key: str, stop: Stop) -> Iterator[Mistake]:
    """Limits that the angle of a drawn end exceeds."""
    beam, sense = scene.beams[stop.beam], 1.0 if stop.end == "start" else -1.0
    tangent = sense * shape_of(beam.curve).tangent(np.array([float(stop.end == "end")]))[0]
    line = np.subtract(scene.place_of(stop.towards), scene.place_of(getattr(beam, stop.end).point))
    angle = (atan2(*tangent[::-1]) - atan2(*line[::-1])) % tau
    angle -= tau if angle > pi + STRAIGHT else 0.0
    stands = f"rad, where the beam as drawn stands at {angle:.6g} rad ({degrees(angle):.4g} degrees)"
    allowed = "limits between which the beam stands as it is drawn"
    return broken(
        stop.least is not None
        and stop.least - angle > ROUNDED
        and Mistake(f"{key}.least", f"{stop.least:g} {stands}", allowed),
        stop.most is not None
        and angle - stop.most > ROUNDED
        and Mistake(f"{key}.most", f"{stop.most:g} {stands}", allowed),
    )

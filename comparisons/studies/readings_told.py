"""What is told of the readings: tables, sentences made of the numbers, and the documented JSON."""

from __future__ import annotations

import numpy as np

from comparisons.documents import Plain
from comparisons.formats import number
from comparisons.sheet import Sheet
from comparisons.studies.readings import JUMP, NEAREST, SECONDS, THEIRS, Followed, Optimised, Readings, Track
from comparisons.studies.readings_drawn import jumps_of_readings
from comparisons.studies.readings_optimisers import Ipopt
from comparisons.studies.readings_path import End
from comparisons.studies.readings_problem import Reading
from comparisons.studies.told import Told

_EVERY = 10  # degrees, in the table of the branch


def told(found: Readings) -> Told:
    """Everything that is told of what was measured so far."""
    sheets = (_ends(found), _asked(found), _lowest(found), _branch(found))
    return Told(
        name="readings",
        title="Where beam 2 of the prestressed mechanism jumps",
        words=_words(found),
        sheets=tuple(sheet for sheet in sheets if sheet.rows),
        pictures=(jumps_of_readings(found),) if found.tracks else (),
        data=_data(found),
    )


def _degrees(angle: float | None, decimals: int = 2) -> str:
    return "–" if angle is None else f"{np.degrees(angle):.{decimals}f}°"


def _between(track: Track) -> str:
    if not track.jumps:
        return "none"
    first = track.jumps[0]
    return f"{_degrees(first.before, 0)} to {_degrees(first.after, 0)}"


def _energies(track: Track) -> tuple[str, str, str]:
    if not track.jumps:
        return "–", "–", "–"
    first = track.jumps[0]
    return str(first.beam), number(first.energies[0], 5), number(first.energies[1], 5)


def _ends(found: Readings) -> Sheet:
    body = []
    for track in found.tracks:
        if isinstance(track.variant, Followed):
            end = track.ends[0] if track.ends else None
            body.append(
                (
                    track.variant.name,
                    track.way,
                    "none" if end is None else _degrees(end.alpha),
                    "–" if end is None else end.kind,
                    "–" if end is None else number(end.before),
                    "–" if end is None else number(end.left),
                    *_energies(track),
                    "acts" if _limited(track) else "–",
                    "yes" if track.as_theirs else "no",
                )
            )
    return Sheet(
        "Branches followed with exact derivatives",
        ("reading", "way", "end", "how", "κ", "left", "beam", "PE before", "PE after", "limit", "35°–36°"),
        tuple(body),
        "κ is the smallest curvature of the energy on the feasible directions at the end, left the one without what "
        "lets go, N·m; energies in J at the stations on both sides; limit: whether it acts before the end.",
    )


def _asked(found: Readings) -> Sheet:
    body = [
        (
            track.variant.name,
            track.variant.start,
            track.way,
            _between(track),
            str(len(track.jumps)),
            *_energies(track),
            str(len(track.failed)),
            str(track.timed_out),
            "yes" if track.as_theirs else "no",
        )
        for track in found.tracks
        if isinstance(track.variant, Optimised)
    ]
    headers = ("optimiser", "start", "way", "first jump", "jumps", "beam", "PE before", "PE after")
    return Sheet(
        "General optimisers, station by station",
        (*headers, "no answer", "out of time", "35°–36°"),
        tuple(body),
        f"A jump: a link turns by {_degrees(JUMP, 0)} more than ordinary between neighbouring stations. Energies in J. "
        f"{SECONDS:g} s for a station: out of time is what was taken as it then stood.",
    )


def _lowest(found: Readings) -> Sheet:
    return Sheet(
        "Up to where both beams inwards is the lower of the two states",
        ("limit", "up to"),
        tuple((each.limits, _degrees(each.alpha)) for each in found.crossings),
        "For somebody who looks for the lowest minimum at each station; no branch ends there.",
    )


def _branch(found: Readings) -> Sheet:
    tracks = [track for track in (found.of(NEAREST, "forwards"), found.of(NEAREST, "backwards")) if track is not None]
    largest = max((abs(each.moment or 0.0) for track in tracks for each in track.stood), default=0.0)
    body = [
        (
            track.way,
            _degrees(each.alpha, 0),
            number(each.energy, 5),
            number(_clear(each.moment, largest), 4),
            str(each.touching),
            "yes" if each.held else "no",
        )
        for track in tracks
        for each in track.stood
        if round(float(np.degrees(each.alpha))) % _EVERY == 0
    ]
    return Sheet(
        "The branches with true contact",
        ("way", "α", "PE, J", "moment, N·m", "touching joints", "limit acts"),
        tuple(body),
    )


def _clear(moment: float | None, largest: float) -> float | None:
    """Nothing in place of round-off."""
    return 0.0 if moment is not None and abs(moment) < 1e-12 * largest else moment


def _limited(track: Track) -> bool:
    """Whether a limit acts before the branch ends."""
    until = track.ends[0].alpha if track.ends else np.inf
    return any(each.held for each in track.stood if track.way == "backwards" or each.alpha <= until)


def _words(found: Readings) -> tuple[str, ...]:
    words = [
        "The paper turns the crank from 0° to 90° and sees beam 2 jump between 35° and 36°. A branch of minima can "
        "only end where its smallest curvature on the feasible directions reaches zero, or where a contact or a limit "
        "lets go and leaves a negative one; an optimiser can leave it earlier."
    ]
    true = found.of(NEAREST, "forwards")
    if true is not None:
        words.append(_physics(found, true))
    ahead = [t for t in found.tracks if isinstance(t.variant, Followed) and t.way == "forwards"]
    if ahead:
        words.append(_branches(ahead))
    asked = [t for t in found.tracks if isinstance(t.variant, Optimised) and t.way == "forwards"]
    if asked:
        words.append(_optimisers(asked))
        words.extend(_barrier(asked))
    returns = [t for t in found.tracks if t.way == "backwards" and not _over(t)]
    if returns:
        back = [t.variant.name for t in returns if t.jumps]
        words.append(
            "On the way back to 0° no beam jumps in any of the readings and optimisers that were asked: what has "
            "jumped stays."
            if not back
            else f"On the way back to 0° a beam jumps under: {', '.join(back)}."
        )
    words.extend(_lowest_words(found))
    matching = [_name(track) for track in found.tracks if track.as_theirs]
    if found.tracks:
        words.append(
            f"Between 35° and 36°: {'; '.join(matching)}."
            if matching
            else "Nothing that was asked gives 35° to 36°: no branch ends there, and no optimiser first jumps there."
            + _nearest(found)
        )
    words.extend(
        f"Left out, since CasADi is not installed (the extra peers): {len(found.left_out)} variants of IPOPT."
        for _ in found.left_out[:1]
    )
    return tuple(words)


def _name(track: Track) -> str:
    asked = track.variant
    return asked.name if isinstance(asked, Followed) else f"{asked.name}, from {asked.start}"


def _over(track: Track) -> bool:
    return isinstance(track.variant, Followed) and track.variant.shape == "beam 2 over"


def _how(end: End) -> str:
    left = "" if end.left is None else f", which leaves a curvature of {number(end.left)} N·m"
    return f"{_degrees(end.alpha)} ({end.kind} at a curvature of {number(end.before)} N·m{left})"


def _physics(found: Readings, true: Track) -> str:
    if not true.ends:
        return "With true contact the branch does not end."
    acts = "acts" if _limited(true) else "does not act"
    sentence = f"With true contact the branch ends at {_how(true.ends[0])}; the limit of 45° {acts} before."
    back = found.of(NEAREST, "backwards")
    if back is not None and not back.jumps:
        held = "its limit acts all the way" if all(each.held for each in back.stood) else "its limit acts in part"
        sentence += f" Beam 2 is then over, {held}, and it is still over when the crank is back at 0°."
    return sentence + (
        " This is the reading of the case: the crank turns counter-clockwise as Fig. 17's letters have it, so that it "
        "is beam 2 that jumps; within 45° of the line to the other pin the beams can only bulge towards each other; "
        "and contact acts wherever they meet."
    )


def _branches(ahead: list[Track]) -> str:
    ended = [track for track in ahead if track.ends]
    if not ended:
        return "No branch ends."
    ends = sorted(ended, key=lambda track: track.ends[0].alpha)
    endless = [track.variant.name for track in ahead if not track.ends and not track.failed]
    sentence = (
        f"Of {len(ahead)} readings of sense, limit, contact and degree {len(ended)} end: first "
        f"{ends[0].variant.name} at {_degrees(ends[0].ends[0].alpha)}, last {ends[-1].variant.name} at "
        f"{_degrees(ends[-1].ends[0].alpha)}."
    )
    return sentence + (f" No end up to the last station: {', '.join(endless)}." if endless else "")


def _optimisers(asked: list[Track]) -> str:
    once = [track for track in asked if len(track.jumps) == 1]
    often = [track for track in asked if len(track.jumps) > 1]
    parts = []
    if once:
        low = min(once, key=lambda track: track.jumps[0].after)
        high = max(once, key=lambda track: track.jumps[0].after)
        parts.append(
            f"Of {len(asked)} ways to ask an optimiser {len(once)} jump once, between {_between(low)} ({_name(low)}) "
            f"and {_between(high)} ({_name(high)})."
        )
    if often:
        first = min(often, key=lambda track: track.jumps[0].after)
        parts.append(
            f"{len(often)} go to and fro between the states, the first from {_between(first)} on ({_name(first)}): "
            "what they find is a matter of the start, not of the mechanism."
        )
    return " ".join(parts)


def _barrier(asked: list[Track]) -> list[str]:
    """The same question to one interior point in two units."""
    first = {
        track.variant.optimiser.units: track
        for track in asked
        if isinstance(track.variant, Optimised)
        and (track.variant.reading, track.variant.start) == (Reading(), "neighbour")
        and isinstance(track.variant.optimiser, Ipopt)
        and not track.variant.optimiser.options
    }
    if len(first) < 2:
        return []
    said = " and ".join(f"{_between(track)} in {units.replace(',', ' and')}" for units, track in first.items())
    return [
        f"IPOPT from its neighbour, asked the same in two units, jumps from {said}: its first barrier of 0.1 is 0.1 "
        "J for the one and a thousandth of that for the other, and pushes the beams apart at every station before it "
        "is let down. That is the optimiser's doing."
    ]


def _nearest(found: Readings) -> str:
    """What comes nearest to the paper's angles."""
    known = [
        (float(track.ends[0].alpha), f"the end of the branch under {_name(track)}")
        for track in found.tracks
        if track.way == "forwards" and track.ends
    ]
    known.extend(
        (0.5 * (track.jumps[0].before + track.jumps[0].after), _name(track))
        for track in found.tracks
        if isinstance(track.variant, Optimised) and track.way == "forwards" and len(track.jumps) == 1
    )
    known.extend(
        (each.alpha, f"a search for the lowest state, {each.limits}")
        for each in found.crossings
        if each.alpha is not None
    )
    if not known:
        return ""
    alpha, what = min(known, key=lambda each: abs(each[0] - 0.5 * sum(THEIRS)))
    return f" Nearest comes {what}, at {_degrees(alpha, 1)}."


def _lowest_words(found: Readings) -> list[str]:
    words = [
        f"Both beams inwards is the lower of the two states up to {_degrees(each.alpha)} with {each.limits}."
        for each in found.crossings
        if each.alpha is not None
    ]
    free = found.of(Reading(limits="none"), "backwards")
    rest = None if free is None else free.at_rest
    if rest is not None:
        words.append(
            f"Without a limit the state with beam 2 over has its least energy, and no moment, at {_degrees(rest)}: the "
            "mechanism's second position of rest, which is not where the first branch ends."
        )
    return words


def _data(found: Readings) -> Plain:
    return {
        "study": "readings",
        "jump": float(JUMP),
        "theirs": [float(angle) for angle in THEIRS],
        "tracks": [_track(track) for track in found.tracks],
        "crossings": [{"limit": each.limits, "alpha": each.alpha} for each in found.crossings],
        "left_out": list(found.left_out),
    }


def _track(track: Track) -> Plain:
    asked = track.variant
    reading = asked.reading
    return {
        "name": asked.name,
        "method": "followed" if isinstance(asked, Followed) else "optimised",
        "start": None if isinstance(asked, Followed) else asked.start,
        "way": track.way,
        "reading": {
            "degree": reading.degree,
            "reach": reading.reach,
            "clamped": reading.clamped,
            "limits": reading.limits,
            "limit": reading.limit,
            "sense": reading.sense,
        },
        "ends": [{"alpha": e.alpha, "kind": e.kind, "curvature": e.before, "left": e.left} for e in track.ends],
        "jumps": [
            {"before": j.before, "after": j.after, "beam": j.beam, "energies": list(j.energies)} for j in track.jumps
        ],
        "as_theirs": track.as_theirs,
        "at_rest": track.at_rest,
        "alpha": [each.alpha for each in track.stood],
        "energy": [each.energy for each in track.stood],
        "moment": [each.moment for each in track.stood],
        "touching": [each.touching for each in track.stood],
        "held": [each.held for each in track.stood],
        "failed": [{"alpha": alpha, "why": why} for alpha, why in track.failed],
        "timed_out": track.timed_out,
    }

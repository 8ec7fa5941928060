"""The equations of a mechanism of elasticas: pieces joined at bodies, knots and contacts.

==========  ================================================================================================
symbol      meaning
==========  ================================================================================================
z           unknowns: the bodies' freedoms, the drives' reactions, of every contact its force P and its places,
            and of every piece the state (x, y, θ, m, Fx, Fy) at its start
λ           value of the load or drive that is stepped
τ, n        unit tangent of a neutral line, and its left-hand normal
F, m        internal force and moment, what lies beyond on what lies before
o, ρ, e     a circle's centre, its radius and half the beam's thickness, (r − o)/|r − o|
g           sense in which a beam runs round a circle; κ_c = g/ρ
==========  ================================================================================================

Source: S. S. Antman, Nonlinear Problems of Elasticity, chapter 4 (balance laws of planar rods), without stretch and
shear.  At a knot everything is continuous.  At a place of contact F jumps by the contact's force, without friction
along the common normal: F(s+) = F(s−) − P e.

On a circle κ = κ_c, so m = EI (κ_c − κ0), F·n = −m', and, since nothing acts along τ, (F·τ)' = κ_c F·n:

    F·τ + κ_c m = const                                                                                    (1)

At both ends of such a zone m is continuous, which says where they are, and F·n may jump.

Derivatives are taken by the complex step, all columns at once: unknowns have the shape (n, K), with one real part
in all columns.  A piece's end follows from its start by its own exact derivatives.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from exact.model import Model, Strip
from exact.spectral import Piece, piece
from exact.structure import Meeting, Structure, Wrap
from scene import CircleContact
from scene.answer import Array
from scene.statement import DisplacementDrive, Force, RotationDrive, SlidingBody

Columns = NDArray[Any]
"""Numbers (K,), or (k, K), one column for each derivative."""

Part = tuple[Columns, Columns, Columns, Columns, Piece]
"""A piece: a, b, the state (6, K) at its start and (4, K) at its end, and what was solved."""

Guess = Callable[[str, Array], Array]
"""θ (n,) of a beam at arc lengths (n,)."""


@dataclass(frozen=True, slots=True)
class Layout:
    """Where every unknown stands in z.

    Attributes:
        bodies, drives: by name.
        forces: P by contact; wraps have none.
        places: by (contact, beam) the arc length of a place, for wraps by (contact, "begin") and (contact, "end").
        pieces: by beam, one slice of six for each piece.
        size: how many there are.
    """

    bodies: Mapping[str, slice]
    drives: Mapping[str, int]
    forces: Mapping[str, int]
    places: Mapping[tuple[str, str], int]
    pieces: Mapping[str, tuple[slice, ...]]
    size: int


def layout(model: Model, structure: Structure) -> Layout:
    """The unknowns of a structure."""
    size = 0

    def take(n: int) -> slice:
        nonlocal size
        size += n
        return slice(size - n, size)

    bodies = {name: take(n) for name, n in model.moving.items()}
    drives = {name: int(take(1).start) for name in model.scene.drives}
    forces: dict[str, int] = {}
    places: dict[tuple[str, str], int] = {}
    for name, touch in structure.touches.items():
        if isinstance(touch, Wrap):
            if not touch.from_start:
                places[name, "begin"] = int(take(1).start)
            if not touch.to_end:
                places[name, "end"] = int(take(1).start)
            continue
        forces[name] = int(take(1).start)
        if touch.at is None:
            places[name, touch.beam] = int(take(1).start)
        if isinstance(touch, Meeting):
            places[name, touch.onto] = int(take(1).start)
    pieces = {}
    for beam in model.strips:
        number = len(structure.order.get(beam, ())) + 1
        for touch in structure.touches.values():
            if isinstance(touch, Wrap) and touch.beam == beam:
                number -= touch.from_start + touch.to_end
        pieces[beam] = tuple(take(6) for _ in range(number))
    return Layout(bodies, drives, forces, places, pieces, size)


@dataclass
class Evaluation:
    """Everything at one z, columns (K,) wherever a number stands.

    Attributes:
        rows: the equations, zero at equilibrium.
        placements: (x, y, φ) displacement of every body's reference, zero for the ground.
        pieces: by beam (a, b, start (6,), end (4,), the solved piece).
        on_body: force and moment about its reference that beams, contacts, loads and drives exert on a body.
        ends: by (beam, "start" | "end") force and moment that the beam exerts on what holds it.
        resultants: by contact the force on its first beam (for two beams on ``Meeting.beam``).
        centres: of circles, by contact.
        wraps: by contact (a, b, the place and tangent angle at a, F before and after, F just inside both ends).
    """

    rows: list[Columns] = field(default_factory=list)
    placements: dict[str, Columns] = field(default_factory=dict)
    pieces: dict[str, list[Part]] = field(default_factory=dict)
    on_body: dict[str, Columns] = field(default_factory=dict)
    ends: dict[tuple[str, str], tuple[Columns, Columns, Columns]] = field(default_factory=dict)
    resultants: dict[str, Columns] = field(default_factory=dict)
    centres: dict[str, Columns] = field(default_factory=dict)
    wraps: dict[str, tuple[Columns, ...]] = field(default_factory=dict)


@dataclass(frozen=True)
class Equations:
    """The equations of a structure under given loads.

    Attributes:
        model: the mechanism.
        structure: which contacts are closed.
        stepped: the load or drive whose value is λ.
        others: values of the others, without dimension.
        nodes: Gauss points of a piece.
        guess: tangent angles from which pieces are solved.
    """

    model: Model
    structure: Structure
    stepped: str
    others: Mapping[str, float]
    nodes: int
    guess: Guess

    @property
    def layout(self) -> Layout:
        """Where the unknowns stand."""
        return layout(self.model, self.structure)

    def __call__(self, z: Columns, lam: Columns) -> Evaluation:
        """The equations at z (n, K) and λ (K,).

        Raises:
            UnsolvableError: a piece cannot be integrated.
        """
        out, where, scene, model = Evaluation(), self.layout, self.model.scene, self.model
        zero = np.zeros(z.shape[1], dtype=z.dtype)
        for name, body in scene.bodies.items():
            own = z[where.bodies[name]] if name in where.bodies else np.zeros((3, z.shape[1]), dtype=z.dtype)
            if isinstance(body, SlidingBody):
                along = _unit(body.along)
                own = np.stack([along[0] * own[0], along[1] * own[0], zero])
            out.placements[name] = own
            out.on_body[name] = np.stack([zero, zero, zero])
        for name, contact in scene.contacts.items():
            if isinstance(contact, CircleContact):
                out.centres[name] = self._moved(out, contact.body, np.array(contact.center) / model.unit_length)
        for strip in model.strips.values():
            self._beam(out, where, strip, z)
        self._contacts(out, where, z)
        self._loads(out, where, z, lam)
        for name, size in model.moving.items():
            balance = out.on_body[name]
            body = scene.bodies[name]
            if size == 1:
                assert isinstance(body, SlidingBody)
                along = _unit(body.along)
                out.rows.append(along[0] * balance[0] + along[1] * balance[1])
            else:
                out.rows += [balance[0], balance[1], balance[2]]
        return out

    # ------------------------------------------------------------------------------------------ bodies

    def _moved(self, out: Evaluation, body: str, rest: Array) -> Columns:
        """Where a body's point that is at ``rest`` (2,) is now, (2, K)."""
        u, v, phi = out.placements[body]
        arm = rest - self.model.reference(body)
        cos, sin = np.cos(phi), np.sin(phi)
        x, y = rest[0] + arm[0] * (cos - 1.0) - arm[1] * sin, rest[1] + arm[0] * sin + arm[1] * (cos - 1.0)
        return np.stack([u + x, v + y])

    def _act(self, out: Evaluation, body: str, place: Columns, force: Columns, moment: Columns) -> None:
        """Let a force (2, K) at a place (2, K) and a moment (K,) act on a body."""
        arm = place - self._moved(out, body, self.model.reference(body))
        out.on_body[body] = out.on_body[body] + np.stack(
            [force[0], force[1], moment + arm[0] * force[1] - arm[1] * force[0]]
        )

    def _loads(self, out: Evaluation, where: Layout, z: Columns, lam: Columns) -> None:
        scene, model = self.model.scene, self.model
        zero = np.zeros_like(lam)
        for name, load in scene.loads.items():
            value = lam if name == self.stepped else zero + self.others.get(name, 0.0)
            if isinstance(load, Force):
                body, rest = scene.body_of(load.point), model.rest(load.point)
                direction = _unit(load.direction)
                self._act(out, body, self._moved(out, body, rest), direction[:, None] * value, zero)
            else:
                out.on_body[load.body] = out.on_body[load.body] + np.stack([zero, zero, value])
        for name, drive in scene.drives.items():
            value = lam if name == self.stepped else zero + self.others.get(name, 0.0)
            reaction = z[where.drives[name]]
            if isinstance(drive, DisplacementDrive):
                body, rest = scene.body_of(drive.point), model.rest(drive.point)
                direction, place = _unit(drive.direction), self._moved(out, body, rest)
                self._act(out, body, place, direction[:, None] * reaction, zero)
                out.rows.append(direction @ (place - rest[:, None]) - value)
            else:
                assert isinstance(drive, RotationDrive)
                out.on_body[drive.body] = out.on_body[drive.body] + np.stack([zero, zero, reaction])
                out.rows.append(out.placements[drive.body][2] - value)

    # ------------------------------------------------------------------------------------------- beams

    def _beam(self, out: Evaluation, where: Layout, strip: Strip, z: Columns) -> None:
        """A beam's pieces, with the rows at its ends and knots and on circles it wraps."""
        order = self.structure.order.get(strip.name, ())
        wraps = {t.contact: t for t in self.structure.touches.values() if isinstance(t, Wrap) and t.beam == strip.name}
        zero = np.zeros_like(z[0])
        begins: list[Columns] = [] if _starts_in(wraps) else [zero]
        stops: list[Columns] = []
        for item in order:
            if isinstance(item, str) and item in wraps:
                if not wraps[item].from_start:
                    stops.append(z[where.places[item, "begin"]])
                if not wraps[item].to_end:
                    begins.append(z[where.places[item, "end"]])
                continue
            at = z[where.places[item, strip.name]] if isinstance(item, str) else zero + item
            stops.append(at)
            begins.append(at)
        if not _ends_in(wraps):
            stops.append(zero + strip.length)
        found = []
        for index, a, b in zip(where.pieces[strip.name], begins, stops, strict=True):
            start = z[index]
            found.append((a, b, start, *self._integrated(strip, np.concatenate([start, [a, b]]))))
        out.pieces[strip.name] = found
        k = 0
        if _starts_in(wraps):
            self._held_on_circle(out, strip, next(w for w in wraps.values() if w.from_start), z, where)
        else:
            self._end_rows(out, strip, "start", found[0][2])
        for item in order:
            wrap = wraps.get(item) if isinstance(item, str) else None
            if wrap is not None:
                if not wrap.from_start and not wrap.to_end:
                    self._zone(out, strip, wrap, found[k], found[k + 1], z, where)
                    k += 1
                continue
            end, after = found[k][3], found[k + 1][2]
            out.rows += list(after[:4] - end)
            if not isinstance(item, str):
                out.rows += list(after[4:] - found[k][2][4:])
            k += 1
        if _ends_in(wraps):
            self._held_on_circle(out, strip, next(w for w in wraps.values() if w.to_end), z, where)
        else:
            self._end_rows(out, strip, "end", np.concatenate([found[-1][3], found[-1][2][4:]]))

    def _integrated(self, strip: Strip, q: Columns) -> tuple[Columns, Piece]:
        """A piece's end (4, K), from q (8, K)."""
        real = np.ascontiguousarray(q[:, 0].real)
        nodes = _nodes(self.nodes, real[6], real[7])
        solved = piece(strip.law, real, self.guess(strip.name, nodes))
        end = np.tile(solved.end[:, None], (1, q.shape[1])).astype(q.dtype)
        if np.iscomplexobj(q):
            end = end + 1j * (solved.slopes @ q.imag)
        return end, solved

    def _end_rows(self, out: Evaluation, strip: Strip, which: str, state: Columns) -> None:
        """What holds at a beam's end; what the beam does there is noted, for contacts at free ends too."""
        end = strip.start if which == "start" else strip.end
        sign = 1.0 if which == "start" else -1.0
        out.ends[strip.name, which] = (state[:2], sign * state[4:6], sign * state[3])
        if end.point is None:
            out.rows.append(state[3])  # its two further rows, of the force, stand where contacts at ends are known
            return
        body = self.model.scene.body_of(end.point)
        place = self._moved(out, body, self.model.rest(end.point))
        out.rows += list(state[:2] - place)
        if end.welded:
            out.rows.append(state[2] - self._angle(out, strip, which))
        else:
            out.rows.append(state[3])

    def _angle(self, out: Evaluation, strip: Strip, which: str) -> Columns:
        """Tangent angle of a beam's welded end."""
        end = strip.start if which == "start" else strip.end
        assert end.point is not None
        at = np.array([0.0 if which == "start" else strip.length])
        turned: Columns = strip.line.angle(at)[0] + out.placements[self.model.scene.body_of(end.point)][2]
        return turned

    # ----------------------------------------------------------------------------------------- contacts

    def _half(self, name: str, beam: str, s: Columns) -> tuple[Columns, float]:
        """T at an arc length, and its slope."""
        strip = self.model.strips[beam]
        if not self.model.scene.contacts[name].thick:
            return np.zeros_like(s), 0.0
        at = np.array([float(np.real(s[0]))])
        step = 1e-6 * strip.length

        def half(x: Array) -> Array:
            return 0.5 * strip.beam.thickness_at(np.clip(x / strip.length, 0.0, 1.0)) / self.model.unit_length

        slope = float((half(at + step) - half(at - step))[0]) / (2.0 * step) if strip.beam.tapered else 0.0
        value = float(half(at)[0])
        return value + slope * (s - at[0]), slope

    def radius(self, name: str) -> float:
        """A circle's radius, no dimension."""
        contact = self.model.scene.contacts[name]
        assert isinstance(contact, CircleContact)
        return contact.radius / self.model.unit_length

    def _contacts(self, out: Evaluation, where: Layout, z: Columns) -> None:
        pushed: dict[tuple[str, str], Columns] = {}
        for name, touch in self.structure.touches.items():
            if isinstance(touch, Wrap):
                continue
            P = z[where.forces[name]]
            state = self._state_at(out, where, name, touch.beam, touch.at, z)
            tangent = np.stack([np.cos(state[2]), np.sin(state[2])])
            if isinstance(touch, Meeting):
                other = self._state_at(out, where, name, touch.onto, None, z)
                along = np.stack([np.cos(other[2]), np.sin(other[2])])
                normal = touch.side * np.stack([-along[1], along[0]])
                between = state[:2] - other[:2]
                out.rows.append(along[0] * between[0] + along[1] * between[1])
                out.rows.append(normal[0] * between[0] + normal[1] * between[1] - touch.apart)
                if touch.at is None:
                    out.rows.append(tangent[0] * along[1] - tangent[1] * along[0])
                self._jump(out, name, touch.onto, -P * normal)
            else:
                between = state[:2] - out.centres[name]
                distance = np.sqrt(between[0] ** 2 + between[1] ** 2)
                normal = between / distance
                s = np.full_like(P, touch.at) if touch.at is not None else z[where.places[name, touch.beam]]
                half, slope = self._half(name, touch.beam, s)
                out.rows.append(distance - self.radius(name) - half)
                if touch.at is None:
                    out.rows.append(normal[0] * tangent[0] + normal[1] * tangent[1] - slope)
                contact = self.model.scene.contacts[name]
                assert isinstance(contact, CircleContact)
                self._act(out, contact.body, out.centres[name], -P * normal, np.zeros_like(P))
            out.resultants[name] = P * normal
            if touch.at is None:
                self._jump(out, name, touch.beam, P * normal)
            else:
                key = (touch.beam, "start" if touch.at == 0.0 else "end")
                pushed[key] = pushed.get(key, 0.0) + P * normal
        for (beam, which), (place, force, moment) in out.ends.items():
            strip = self.model.strips[beam]
            end = strip.start if which == "start" else strip.end
            onto = force + pushed.get((beam, which), 0.0 * force)
            if end.point is None:
                out.rows += list(onto)
            else:
                self._act(out, self.model.scene.body_of(end.point), place, onto, moment)
                out.ends[beam, which] = (place, onto, moment)

    def _state_at(self, out: Evaluation, where: Layout, name: str, beam: str, at: float | None, z: Columns) -> Columns:
        """(x, y, θ, m) where a beam touches: at an end, or where a piece begins there."""
        found = out.pieces[beam]
        if at is not None:
            return found[0][2][:4] if at == 0.0 else found[-1][3]
        return found[self._number(beam, name)][2][:4]

    def _number(self, beam: str, name: str) -> int:
        """Number of the piece that begins where a beam touches."""
        wraps = {t.contact: t for t in self.structure.touches.values() if isinstance(t, Wrap) and t.beam == beam}
        k = 0
        for item in self.structure.order[beam]:
            if not (isinstance(item, str) and item in wraps and (wraps[item].from_start or wraps[item].to_end)):
                k += 1
            if item == name:
                return k
        raise KeyError(name)

    def _jump(self, out: Evaluation, name: str, beam: str, force: Columns) -> None:
        """The force (2, K) of a contact on a beam between its ends: F(s+) = F(s−) − force."""
        k = self._number(beam, name)
        out.rows += list(out.pieces[beam][k][2][4:] - out.pieces[beam][k - 1][2][4:] + force)

    # ---------------------------------------------------------------------------------- along a circle

    def _on_circle(self, strip: Strip, wrap: Wrap, s: Columns) -> tuple[Columns, Columns]:
        """m and m' where a beam lies on a circle, at an arc length (K,)."""
        rho = self.radius(wrap.contact) + self._half(wrap.contact, strip.name, np.real(s))[0]
        at = np.array([float(np.real(s[0]))])
        EI, kappa0, slope = (f(at)[0] for f in (strip.rigidity, strip.line.curvature, strip.line.curvature_slope))
        # the section is even there: κ0 alone varies, along the complex step in first order
        m = EI * (wrap.sense / rho - kappa0 - slope * (s - at[0]))
        return m, -EI * slope + 0.0 * s

    def _turned(self, place: Columns, centre: Columns, angle: Columns, by: Columns) -> tuple[Columns, Columns]:
        """A place on a circle and the tangent angle there after going round by an angle."""
        arm = place - centre
        cos, sin = np.cos(by), np.sin(by)
        return centre + np.stack([cos * arm[0] - sin * arm[1], sin * arm[0] + cos * arm[1]]), angle + by

    def _frame(self, angle: Columns, sense: float) -> tuple[Columns, Columns]:
        """τ and e where a beam lies on a circle."""
        tangent = np.stack([np.cos(angle), np.sin(angle)])
        return tangent, sense * np.stack([tangent[1], -tangent[0]])

    def _zone(
        self, out: Evaluation, strip: Strip, wrap: Wrap, before: Part, after: Part, z: Columns, where: Layout
    ) -> None:
        """A wrap between a beam's ends."""
        name, g = wrap.contact, wrap.sense
        centre = out.centres[name]
        a, b = z[where.places[name, "begin"]], z[where.places[name, "end"]]
        rho = self.radius(name) + self._half(name, strip.name, np.real(a))[0]
        x, y, theta, m = before[3]
        tangent, e = self._frame(theta, g)
        arm = np.stack([x, y]) - centre
        m_a, dm_a = self._on_circle(strip, wrap, a)
        m_b, dm_b = self._on_circle(strip, wrap, b)
        out.rows += list(arm - rho * e)
        out.rows.append(m - m_a)
        place, angle = self._turned(before[3][:2], centre, theta, g * (b - a) / rho)
        out.rows += [*(after[2][:2] - place), after[2][2] - angle, after[2][3] - m_b]
        tangent_b, e_b = self._frame(angle, g)
        N_a = before[2][4] * tangent[0] + before[2][5] * tangent[1]
        N_b = after[2][4] * tangent_b[0] + after[2][5] * tangent_b[1]
        out.rows.append(N_b + g / rho * m_b - N_a - g / rho * m_a)  # (1)
        self._close_zone(out, wrap, (a, b, np.stack([x, y]), theta), before[2][4:], after[2][4:],
                         N_a * tangent + g * dm_a * e, N_b * tangent_b + g * dm_b * e_b)  # fmt: skip

    def _held_on_circle(self, out: Evaluation, strip: Strip, wrap: Wrap, z: Columns, where: Layout) -> None:
        """A wrap from a beam's clamped start or to its clamped end."""
        name, g = wrap.contact, wrap.sense
        which = "start" if wrap.from_start else "end"
        end = strip.start if wrap.from_start else strip.end
        assert end.point is not None
        free = z[where.places[name, "end" if wrap.from_start else "begin"]]
        held = np.full_like(free, 0.0 if wrap.from_start else strip.length)
        rho = self.radius(name) + self._half(name, strip.name, np.real(held))[0]
        body = self.model.scene.body_of(end.point)
        clamp, angle = self._moved(out, body, self.model.rest(end.point)), self._angle(out, strip, which)
        place, turned = self._turned(clamp, out.centres[name], angle, g * (free - held) / rho)
        m_free, dm_free = self._on_circle(strip, wrap, free)
        m_held, dm_held = self._on_circle(strip, wrap, held)
        if wrap.from_start:
            state, force = out.pieces[strip.name][0][2][:4], out.pieces[strip.name][0][2][4:]
        else:
            state, force = out.pieces[strip.name][-1][3], out.pieces[strip.name][-1][2][4:]
        out.rows += [*(state[:2] - place), state[2] - turned, state[3] - m_free]
        tangent_f, e_f = self._frame(turned, g)
        tangent_h, e_h = self._frame(angle, g)
        N_free = force[0] * tangent_f[0] + force[1] * tangent_f[1]
        N_held = N_free + g / rho * (m_free - m_held)  # (1)
        inside_held = N_held * tangent_h + g * dm_held * e_h
        inside_free = N_free * tangent_f + g * dm_free * e_f
        if wrap.from_start:
            out.ends[strip.name, which] = (clamp, inside_held, m_held)
            self._close_zone(out, wrap, (held, free, clamp, angle), inside_held, force, inside_held, inside_free)
        else:
            out.ends[strip.name, which] = (clamp, -inside_held, -m_held)
            self._close_zone(out, wrap, (free, held, place, turned), force, inside_held, inside_free, inside_held)

    def _close_zone(
        self,
        out: Evaluation,
        wrap: Wrap,
        zone: tuple[Columns, ...],
        before: Columns,
        after: Columns,
        first: Columns,
        last: Columns,
    ) -> None:
        """Note a wrap, whose force on the beam is F before less F after it."""
        force = before - after
        contact = self.model.scene.contacts[wrap.contact]
        assert isinstance(contact, CircleContact)
        out.resultants[wrap.contact] = force
        out.wraps[wrap.contact] = (*zone, before, after, first, last)
        self._act(out, contact.body, out.centres[wrap.contact], -force, np.zeros_like(force[0]))


def _starts_in(wraps: Mapping[str, Wrap]) -> bool:
    return any(wrap.from_start for wrap in wraps.values())


def _ends_in(wraps: Mapping[str, Wrap]) -> bool:
    return any(wrap.to_end for wrap in wraps.values())


def _unit(direction: tuple[float, float]) -> Array:
    vector = np.array(direction)
    return vector / float(np.hypot(*vector))


def _nodes(p: int, a: float, b: float) -> Array:
    from exact.spectral import rule

    return a + (b - a) * rule(p).points

"""Equations of a mechanism of elasticas: pieces joined at bodies, knots and contacts.

==========  ================================================================================================
symbol      meaning
==========  ================================================================================================
z           unknowns, see :mod:`elastica_reference.layout`
λ           value of the stepped load or drive
==========  ================================================================================================

Source: S. S. Antman, Nonlinear Problems of Elasticity, chapter 4 (balance laws of planar rods), without stretch and
shear. At a knot all quantities are continuous except for the internal force under a point force. Contacts are in
:mod:`elastica_reference.touching` and :mod:`elastica_reference.wrapping`. The forces and moments on every moving body
are in equilibrium.

Derivatives use the complex step, for all columns at once: unknowns have the shape (n, K), with equal real parts in
all columns. The end state of a piece follows from the start state by exact derivatives of the piece.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from cprbm_scene import CircleContact
from cprbm_scene.answer import Array
from cprbm_scene.statement import BeamForce, DisplacementDrive, DistributedLoad, Force, Moment, SlidingBody
from elastica_reference.evaluation import Columns, EndAction, Evaluation, Part
from elastica_reference.layout import Layout, layout
from elastica_reference.model import Model, Strip
from elastica_reference.spectral import piece, rule
from elastica_reference.structure import Structure
from elastica_reference.touching import touch_points
from elastica_reference.wrapping import wrap_between, wrap_from_clamp

Guess = Callable[[str, Array], Array]
"""θ (n,) of a beam at arc lengths (n,)."""


@dataclass(frozen=True)
class Equations:
    """Equations of a structure under given loads.

    Attributes:
        model: the mechanism.
        structure: the closed contacts.
        stepped: name of the load or drive with the value λ.
        others: dimensionless values of the other loads and drives.
        nodes: Gauss points of a piece.
    """

    model: Model
    structure: Structure
    stepped: str
    others: Mapping[str, float]
    nodes: int

    @cached_property
    def layout(self) -> Layout:
        """Positions of the unknowns in z."""
        return layout(self.model, self.structure)

    def __call__(self, z: Columns, lam: Columns, guess: Guess) -> Evaluation:
        """All quantities at z (n, K) and λ (K,), with pieces solved from the tangent angles ``guess``.

        Raises:
            UnsolvableError: a piece cannot be integrated.
        """
        out = Evaluation(self.model)
        self._place_bodies(out, z)
        inside, at_ends = self._forces_on_beams(lam)
        for strip in self.model.strips.values():
            self._beam(out, strip, z, guess, lam, inside)
        touch_points(out, self.structure, self.layout, z, at_ends)
        self._loads(out, z, lam)
        for name, freedoms in self.model.moving.items():
            balance = out.on_body[name]
            if freedoms == 3:
                out.rows += list(balance)
                continue
            along = self._along(name)
            out.rows.append(along[0] * balance[0] + along[1] * balance[1])
            if freedoms == 2:
                x, y = out.turned(name, self._pin(name))
                out.rows.append(balance[2] - (x * balance[1] - y * balance[0]))
        return out

    # ------------------------------------------------------------------------------------------ bodies

    def _place_bodies(self, out: Evaluation, z: Columns) -> None:
        scene, bodies = self.model.scene, self.layout.bodies
        nowhere = np.zeros((3, z.shape[1]), dtype=z.dtype)
        for name in scene.bodies:
            if self.model.moving.get(name) == 1:
                along = self._along(name)
                out.placements[name] = np.outer([along[0], along[1], 0.0], z[bodies[name]][0])
            elif self.model.moving.get(name) == 2:
                # position of the pin in its slot, and rotation of the body about the pin
                along, (far, phi), pin = self._along(name), z[bodies[name]], self._pin(name)
                out.placements[name] = np.stack([0.0 * phi, 0.0 * phi, phi])
                u, v = np.outer(along, far) + (pin - self.model.reference(name))[:, None] - out.turned(name, pin)
                out.placements[name] = np.stack([u, v, phi])
            else:
                out.placements[name] = z[bodies[name]] if name in bodies else nowhere
            out.on_body[name] = nowhere
        for name, contact in scene.contacts.items():
            if isinstance(contact, CircleContact):
                out.centres[name] = out.moved(contact.body, np.array(contact.center) / self.model.unit_length)

    def _along(self, body: str) -> Array:
        """Unit direction (2,) of a slide; zero for other bodies."""
        record = self.model.scene.bodies[body]
        return unit(record.along) if isinstance(record, SlidingBody) else np.zeros(2)

    def _pin(self, body: str) -> Array:
        """Reference position (2,) of the point in the slot; zero for other bodies."""
        record = self.model.scene.bodies[body]
        if not isinstance(record, SlidingBody) or record.pin is None:
            return np.zeros(2)
        return self.model.rest(record.pin)

    def _loads(self, out: Evaluation, z: Columns, lam: Columns) -> None:
        scene, nothing = self.model.scene, np.zeros((2, len(lam)), dtype=lam.dtype)
        for name, load in scene.loads.items():
            value = self._value(name, lam)
            if isinstance(load, Force):
                body = scene.body_of(load.point)
                out.act(body, out.moved(body, self.model.rest(load.point)), np.outer(unit(load.direction), value))
            elif isinstance(load, Moment):
                out.act(load.body, nothing, nothing, value)
        for name, drive in scene.drives.items():
            value = self._value(name, lam)
            reaction = z[self.layout.drives[name]]
            if isinstance(drive, DisplacementDrive):
                body, rest = scene.body_of(drive.point), self.model.rest(drive.point)
                direction, place = unit(drive.direction), out.moved(body, rest)
                out.act(body, place, np.outer(direction, reaction))
                out.rows.append(direction @ (place - rest[:, None]) - value)
            else:
                out.act(drive.body, nothing, nothing, reaction)
                out.rows.append(out.placements[drive.body][2] - value)

    def _value(self, name: str, lam: Columns) -> Columns:
        """Value (K,) of a load or drive."""
        return lam if name == self.stepped else np.full_like(lam, self.others.get(name, 0.0))

    def _forces_on_beams(self, lam: Columns) -> tuple[dict[tuple[str, float], Columns], dict[tuple[str, str], Columns]]:
        """Point forces (2, K) by beam and knot, and by beam and end."""
        inside: dict[tuple[str, float], Columns] = {}
        at_ends: dict[tuple[str, str], Columns] = {}
        for name, load in self.model.scene.loads.items():
            if not isinstance(load, BeamForce):
                continue
            force = np.outer(unit(load.direction), self._value(name, lam))
            if load.at in (0.0, 1.0):
                end = load.beam, "start" if load.at == 0.0 else "end"
                at_ends[end] = at_ends[end] + force if end in at_ends else force
            else:
                knot = load.beam, load.at * self.model.strips[load.beam].length
                inside[knot] = inside[knot] + force if knot in inside else force
        return inside, at_ends

    # ------------------------------------------------------------------------------------------- beams

    def _beam(
        self,
        out: Evaluation,
        strip: Strip,
        z: Columns,
        guess: Guess,
        lam: Columns,
        forces: Mapping[tuple[str, float], Columns],
    ) -> None:
        """Pieces of a beam, with the rows at its ends and knots and along circles."""
        name, order = strip.name, self.structure.order[strip.name]
        wraps = {wrap.contact: wrap for wrap in self.structure.wraps(name)}
        begins, stops = self._borders(strip, z)
        parts = out.parts[name] = [
            self._integrated(strip, a, b, z[index], self._spread(strip, a, b, lam), guess)
            for index, a, b in zip(self.layout.pieces[name], begins, stops, strict=True)
        ]
        if not any(wrap.from_start for wrap in wraps.values()):
            self._end(out, strip, "start", parts[0].start)
        if not any(wrap.to_end for wrap in wraps.values()):
            self._end(out, strip, "end", np.concatenate([parts[-1].end, parts[-1].end_force]))
        k = 0
        for item in order:
            wrap = wraps.get(item) if isinstance(item, str) else None
            if wrap is not None and wrap.held:
                wrap_from_clamp(out, self.layout, wrap, z)
                continue
            before, after = parts[k], parts[k + 1]
            k += 1
            if wrap is not None:
                wrap_between(out, self.layout, wrap, before, after, z)
                continue
            if not isinstance(item, str):
                out.turnings[name, item] = (self.layout.pieces[name][k].start + 2, len(out.rows) + 3)
            out.rows += list(after.start[:4] - before.end)
            if not isinstance(item, str):
                jump = after.force - before.end_force
                out.rows += list(jump + forces[name, item] if (name, item) in forces else jump)

    def _borders(self, strip: Strip, z: Columns) -> tuple[list[Columns], list[Columns]]:
        """Arc lengths (K,) of the starts and of the ends of a beam's pieces."""
        where, touches = self.layout.places, self.structure.wraps(strip.name)
        wraps = {wrap.contact: wrap for wrap in touches}
        begins, stops = [np.zeros_like(z[0])], [np.full_like(z[0], strip.length)]
        for item in self.structure.order[strip.name]:
            wrap = wraps.get(item) if isinstance(item, str) else None
            if wrap is not None and wrap.from_start:
                begins[0] = z[where[wrap.contact, "end"]]
            elif wrap is not None and wrap.to_end:
                stops[-1] = z[where[wrap.contact, "begin"]]
            elif wrap is not None:
                stops.insert(-1, z[where[wrap.contact, "begin"]])
                begins.append(z[where[wrap.contact, "end"]])
            else:
                at = z[where[item, strip.name]] if isinstance(item, str) else np.full_like(z[0], item)
                stops.insert(-1, at)
                begins.append(at)
        return begins, stops

    def places_of(self, beam: str, z: Array) -> list[float]:
        """Arc lengths of knots, places and wraps along a beam, in the structure's order, for unknowns z (n,)."""
        where, wraps = self.layout.places, {wrap.contact: wrap for wrap in self.structure.wraps(beam)}
        places = []
        for item in self.structure.order[beam]:
            if not isinstance(item, str):
                places.append(item)
            elif item in wraps:
                places.append(0.0 if wraps[item].from_start else float(z[where[item, "begin"]]))
            else:
                places.append(float(z[where[item, beam]]))
        return places

    def begins(self, beam: str, z: Array) -> list[float]:
        """Arc lengths of the starts of a beam's pieces, for unknowns z (n,)."""
        return [float(begin[0]) for begin in self._borders(self.model.strips[beam], z[:, None])[0]]

    def _spread(self, strip: Strip, a: Columns, b: Columns, lam: Columns) -> Columns:
        """Distributed load (2, K) on a piece, constant over the piece."""
        middle, total = 0.5 * float((a[0] + b[0]).real), np.zeros((2, len(lam)), dtype=lam.dtype)
        for load, begin, end in strip.spread:
            if begin < middle < end:
                record = self.model.scene.loads[load]
                assert isinstance(record, DistributedLoad)
                total = total + np.outer(unit(record.direction), self._value(load, lam))
        return total

    def _integrated(self, strip: Strip, a: Columns, b: Columns, start: Columns, spread: Columns, guess: Guess) -> Part:
        """A piece with the start state (6, K) and the load (2, K)."""
        q = np.concatenate([start, [a, b], spread])
        real = np.ascontiguousarray(q[:, 0].real)
        nodes = real[6] + (real[7] - real[6]) * rule(self.nodes).points
        solved = piece(strip.law, real, guess(strip.name, nodes))
        end = np.tile(solved.end[:, None], (1, q.shape[1])).astype(q.dtype)
        if np.iscomplexobj(q):
            end = end + 1j * (solved.slopes @ q.imag)
        return Part(a, b, start, end, spread, solved)

    def _end(self, out: Evaluation, strip: Strip, which: str, state: Columns) -> None:
        """Rows of a beam's end except the forces, which follow once the contacts are known."""
        end, sign = (strip.start, 1.0) if which == "start" else (strip.end, -1.0)
        out.ends[strip.name, which] = EndAction(state[:2], sign * state[4:6], sign * state[3])
        if end.point is not None:
            out.rows += list(state[:2] - out.moved(self.model.scene.body_of(end.point), self.model.rest(end.point)))
        out.rows.append(state[2] - out.angle(strip.name, which) if end.welded else state[3])


def unit(direction: tuple[float, float]) -> Array:
    """Unit vector (2,) of a direction."""
    vector = np.array(direction)
    return np.asarray(vector / float(np.hypot(*vector)))

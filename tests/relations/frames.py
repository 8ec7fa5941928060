"""The same scene seen from elsewhere: moved, turned, mirrored, and in other units of length and of force.

======  =======================================================================
symbol  meaning
======  =======================================================================
x, X    a place in the scene and in its image, m
Q       2×2, the turn, or the turn of the mirror image: X = λ (Q x + b)
m       det Q: 1, or −1 in the mirror
b       the shift, m
λ       the image's length of what was one metre long
ε       the image's modulus of what had one pascal
φ       ελ², what the image has for one newton
======  =======================================================================

A polynomial stays one only where Q takes the axes to axes.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import atan2, cos, sin

import numpy as np
from numpy.polynomial import Polynomial

from cprbm_scene import Probe
from cprbm_scene.answer import Array
from tests.relations.image import Data, Image, copied

OTHER_WAY = {
    "counterclockwise": "clockwise",
    "clockwise": "counterclockwise",
    "left": "right",
    "right": "left",
    "above": "below",
    "below": "above",
}


@dataclass(frozen=True, slots=True)
class Frame:
    """Q as rows, b, λ and ε."""

    Q: tuple[tuple[float, float], tuple[float, float]] = ((1.0, 0.0), (0.0, 1.0))
    b: tuple[float, float] = (0.0, 0.0)
    length: float = 1.0
    modulus: float = 1.0

    @property
    def sense(self) -> float:
        """m."""
        (a, b), (c, d) = self.Q
        return 1.0 if a * d - b * c > 0.0 else -1.0

    @property
    def force(self) -> float:
        """φ."""
        return self.modulus * self.length**2

    def turned(self, v: list[float]) -> list[float]:
        """A direction's image; components that the turn leaves alone keep every digit."""
        (a, b), (c, d) = self.Q
        return [a * v[0] + b * v[1], c * v[0] + d * v[1]]

    def placed(self, x: list[float]) -> list[float]:
        """A place's image."""
        u, v = self.turned(x)
        return [self.length * (u + self.b[0]), self.length * (v + self.b[1])]

    def stepped(self, kind: str) -> float:
        """What the image has for one unit of a load or drive of a ``kind``."""
        return {
            "force": self.force,
            "beam_force": self.force,
            "moment": self.sense * self.force * self.length,
            "beam_moment": self.sense * self.force * self.length,
            "distributed": self.force / self.length,
            "displacement": self.length,
            "rotation": self.sense,
        }[kind]

    def value(self, probe: Probe, kind: str, value: Array) -> Array:
        """The image's value of a probe; ``kind`` is that of the load or drive stepped as a contact closed."""
        match probe.quantity:
            case "displacement":
                return self.length * (np.array(self.Q) @ value)
            case "reaction":
                return self.force * (np.array(self.Q) @ value)
            case "rotation" | "angle":
                return self.sense * value
            case "force":
                return self.force * value
            case "centre" | "ends":
                return self.length * value
            case "closing_load":
                return self.stepped(kind) * value
            case "bending_stress":
                return self.sense * self.modulus * value
            case "combined_stress":
                return self.modulus * value
            case "reaction_moment":
                return self.sense * self.force * self.length * value
            case "potential_energy" | "moment":
                return self.force * self.length * value

    def image(self, data: Data, what: str) -> Image:
        """A scene's image."""
        kinds = {name: each["kind"] for group in ("loads", "drives") for name, each in data.get(group, {}).items()}
        steps = {stage["name"]: kinds[stage["steps"]] for stage in data["stages"]}
        return Image(
            what,
            self._data(data, kinds),
            lambda probe, stage, value: self.value(probe, steps[stage], value),
            lambda stage, value: self.stepped(steps[stage]) * value,
        )

    def _data(self, data: Data, kinds: dict[str, str]) -> Data:
        new = copied(data)
        for material in new["materials"].values():
            material["youngs_modulus"] *= self.modulus
        for body in new["bodies"].values():
            body["points"] = {name: self.placed(place) for name, place in body["points"].items()}
            if "along" in body:
                body["along"] = self.turned(body["along"])
        for beam in new["beams"].values():
            beam["curve"] = self._curve(beam["curve"])
            beam["thickness"], beam["width"] = self._size(beam["thickness"]), self._size(beam["width"])
        for contact in new.get("contacts", {}).values():
            self._edge(contact)
        for acting in (*new.get("loads", {}).values(), *new.get("drives", {}).values()):
            if "direction" in acting:
                acting["direction"] = self.turned(acting["direction"])
        if self.sense < 0.0:
            for stop in new.get("stops", {}).values():
                most, least = stop.pop("least", None), stop.pop("most", None)
                stop |= {key: -limit for key, limit in (("least", least), ("most", most)) if limit is not None}
        moments: dict[str, float] = new.get("assembly", {}).get("moments", {})
        for beam in moments:
            moments[beam] *= self.stepped("moment")
        for stage in new["stages"]:
            factor = self.stepped(kinds[stage["steps"]])
            stage.update({key: [factor * v for v in stage[key]] for key in ("stations", "shown") if key in stage})
            if "critical_limit" in stage:
                stage["critical_limit"] *= abs(factor)
        return new

    def _size(self, size: float | dict[str, list[float]]) -> float | dict[str, list[float]]:
        if isinstance(size, dict):
            return {**size, "values": [self.length * value for value in size["values"]]}
        return self.length * size

    def _curve(self, curve: Data) -> Data:
        if curve["kind"] == "polynomial":
            return {**curve, **self._graph(curve)}
        new: Data = {**curve, **{key: self.placed(curve[key]) for key in ("start", "end", "center") if key in curve}}
        if "points" in curve:
            new["points"] = [self.placed(place) for place in curve["points"]]
        for key in ("start_direction", "end_direction"):
            if curve.get(key) is not None:
                new[key] = self.turned(curve[key])
        if self.sense < 0.0 and "direction" in curve:
            new["direction"] = OTHER_WAY[curve["direction"]]
        return new

    def _edge(self, contact: Data) -> None:
        """What a beam may touch, in its place."""
        match contact["kind"]:
            case "beam-circle":
                contact["center"] = self.placed(contact["center"])
                contact["radius"] *= self.length
            case "beam-ellipse":
                contact["center"] = self.placed(contact["center"])
                contact["semi_axes"] = [self.length * each for each in contact["semi_axes"]]
                angle = contact.get("angle", 0.0)
                x, y = self.turned([cos(angle), sin(angle)])
                contact["angle"] = atan2(y, x)
            case "beam-line" | "beam-spline":
                contact.update(self._curve(contact))
                if self.sense < 0.0:
                    contact["side"] = OTHER_WAY[contact["side"]]
            case "beam-half-plane":
                contact["point"] = self.placed(contact["point"])
                contact["normal"] = self.turned(contact["normal"])
            case "beam-function":
                upwards = self._ordinate(contact["axis"])
                contact.update(self._graph(contact))
                if upwards < 0.0:
                    contact["side"] = OTHER_WAY[contact["side"]]

    def _ordinate(self, axis: str) -> float:
        """The sense that the ordinate of f over an ``axis`` gets."""
        return sum(row["xy".index("y" if axis == "x" else "x")] for row in self.Q)

    def _graph(self, graph: Data) -> Data:
        """Axis, coefficients and range of the image of y = f(x) or x = f(y).

        Raises:
            ValueError: Q does not take axes to axes.
        """
        if {abs(each) for row in self.Q for each in row} != {0.0, 1.0}:
            raise ValueError("the image of a polynomial under this turn is none")
        old = "xy".index(graph["axis"])
        new = old if self.Q[0][0] != 0.0 else 1 - old
        along, upwards = self.Q[new][old], self.Q[1 - new][1 - old]
        # X = λ(±x + b), Y = λ(±f(x) + c): f's variable is ±(X/λ − b)
        variable = Polynomial([-along * self.b[new], along / self.length])
        f = self.length * (upwards * Polynomial(graph["coefficients"])(variable) + self.b[1 - new])
        coefficients = [float(each) for each in f.coef]
        return {
            "axis": "xy"[new],
            "coefficients": coefficients + [0.0] * (len(graph["coefficients"]) - len(coefficients)),
            "range": [self.length * (along * v + self.b[new]) for v in graph["range"]],
        }


def turned_by(angle: float) -> tuple[tuple[float, float], tuple[float, float]]:
    """Q of a turn, counter-clockwise."""
    return (cos(angle), -sin(angle)), (sin(angle), cos(angle))


QUARTER = ((0.0, -1.0), (1.0, 0.0))
"""Q of a quarter turn, to the last digit."""

MIRROR = ((1.0, 0.0), (0.0, -1.0))
"""Q of the mirror image in the x-axis."""


def has_graphs(data: Data) -> bool:
    """Whether there are polynomials in a scene, which stay such only where axes go to axes."""
    curves = (beam["curve"] for beam in data["beams"].values())
    return any(
        each["kind"] in ("polynomial", "beam-function") for each in (*curves, *data.get("contacts", {}).values())
    )

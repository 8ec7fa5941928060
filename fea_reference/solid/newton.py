"""Newton's method for an equilibrium at given loads and drives."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from cprbm_scene.answer import Array
from fea_reference.solid.model import Model
from fea_reference.solid.pairs import Pair
from fea_reference.solid.settings import Settings
from fea_reference.solid.system import Prediction, System, assemble, deepest

_LONGEST = 0.5  # rad, and lengths of the longest beam: limit of a step's motion
_DEEP = 0.02  # thicknesses
_PATIENCE = 12  # iterations after which a residual above the next share of the scale ends the search
_FAR = 0.3
_SHORTER = 5  # halvings of a step
_WILD = 1e12  # times the scale: divergence


@dataclass(frozen=True, slots=True)
class Solved:
    """Result of the search: the ``system`` of an equilibrium or None, the number of iterations, and the reason."""

    system: System | None
    iterations: int
    reason: str = ""


def equilibrium(model: Model, penalties: Mapping[Pair, float], settings: Settings, values: Array, z: Array) -> Solved:
    """Equilibrium near ``z``, without inverted elements.

    Arguments as for :func:`~fea_reference.solid.system.assemble`.
    """
    predicted: Prediction | None = None
    for iteration in range(settings.newton_limit):
        system = assemble(model, penalties, settings.quadrature, values, z, predicted)
        residual = float(np.abs(system.residual).max())
        if not np.isfinite(residual) or residual > _WILD * system.scale:
            return Solved(None, iteration, "Newton's iterations diverge")
        if residual <= max(settings.residual * system.scale, system.floor):
            if predicted is not None:
                system = assemble(model, penalties, settings.quadrature, values, z)
                residual = float(np.abs(system.residual).max())
            arrived = residual <= max(settings.residual * system.scale, system.floor)
            if arrived and not float(system.strained.determinants.min()) > 0.0:
                return Solved(None, iteration, "an element is inverted")
            if arrived:  # otherwise a corner without overlap was active
                return Solved(system, iteration)
        if iteration >= _PATIENCE and residual > _FAR * system.scale:
            return Solved(None, iteration, "Newton's iterations do not converge")
        step = system.solve(-system.residual)
        if step is None:
            return Solved(None, iteration, "the tangent is singular")
        motion = float(np.abs(step[: model.size - len(model.rows)]).max())
        share = min(1.0, _LONGEST / motion) if motion > 0.0 else 1.0
        share = _limited_share(model, penalties, system, share, step)
        predicted = system.prediction(share * step)
        z = z + share * step
    return Solved(None, settings.newton_limit, "Newton's iterations do not converge")


def _limited_share(model: Model, penalties: Mapping[Pair, float], system: System, share: float, step: Array) -> float:
    """Share of a step without penetrations above ``_DEEP`` or the present one: passing through would go unnoticed."""
    if not penalties:
        return share
    allowed = max(_DEEP, max((contact.penetration / contact.pair.measure for contact in system.touches), default=0.0))
    for _ in range(_SHORTER):
        if deepest(model, penalties, system.z + share * step) <= allowed:
            break
        share *= 0.5
    return share

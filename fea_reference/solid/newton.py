"""Newton's iterations to an equilibrium at given loads and drives."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from cprbm_scene.answer import Array
from fea_reference.solid.model import Model
from fea_reference.solid.pairs import Pair
from fea_reference.solid.settings import Settings
from fea_reference.solid.system import Outlook, System, assemble, deepest

_LONGEST = 0.5  # rad, and of the longest beam: a step that goes farther is shortened to this
_DEEP = 0.02  # of the thickness
_PATIENCE = 12  # iterations after which a residual that is still so far, over the scale, will not come down
_FAR = 0.3
_SHORTER = 5  # halvings of a step
_WILD = 1e12  # over the scale: what diverges


@dataclass(frozen=True, slots=True)
class Found:
    """Where the iterations ended: the ``system`` of an equilibrium or None, and how many there were."""

    system: System | None
    iterations: int
    why: str = ""


def equilibrium(model: Model, penalties: Mapping[Pair, float], settings: Settings, values: Array, z: Array) -> Found:
    """Iterate from ``z``; an equilibrium has no element that is turned inside out.

    The arguments are those of :func:`~fea_reference.solid.system.assemble`.
    """
    foreseen: Outlook | None = None
    for iteration in range(settings.newton_limit):
        system = assemble(model, penalties, settings.quadrature, values, z, foreseen)
        residual = float(np.abs(system.residual).max())
        if not np.isfinite(residual) or residual > _WILD * system.scale:
            return Found(None, iteration, "Newton's iterations diverge")
        if residual <= max(settings.residual * system.scale, system.floor):
            if foreseen is not None:
                system = assemble(model, penalties, settings.quadrature, values, z)
                residual = float(np.abs(system.residual).max())
            arrived = residual <= max(settings.residual * system.scale, system.floor)
            if arrived and not float(system.strained.determinants.min()) > 0.0:
                return Found(None, iteration, "an element is turned inside out")
            if arrived:  # else a corner was held that does not press
                return Found(system, iteration)
        if iteration >= _PATIENCE and residual > _FAR * system.scale:
            return Found(None, iteration, "Newton's iterations do not arrive")
        step = system.solve(-system.residual)
        if step is None:
            return Found(None, iteration, "the tangent is singular")
        motion = float(np.abs(step[: model.size - len(model.rows)]).max())
        share = min(1.0, _LONGEST / motion) if motion > 0.0 else 1.0
        share = _not_too_deep(model, penalties, system, share, step)
        foreseen = system.outlook(share * step)
        z = z + share * step
    return Found(None, settings.newton_limit, "Newton's iterations do not arrive")


def _not_too_deep(model: Model, penalties: Mapping[Pair, float], system: System, share: float, step: Array) -> float:
    """So much of a step that no edge goes deeper than ``_DEEP``, or than it is: what passes through is not seen."""
    if not penalties:
        return share
    allowed = max(_DEEP, max((one.penetration / one.pair.measure for one in system.touches), default=0.0))
    for _ in range(_SHORTER):
        if deepest(model, penalties, system.z + share * step) <= allowed:
            break
        share *= 0.5
    return share

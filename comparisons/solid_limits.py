"""Limits of the solid's values on meshes that double, with the uncertainty of :mod:`comparisons.verdict.uncertainty`.

Away from corners quadrilaterals of second order converge with the fourth power of the element's size.  At the corner of
a face that is held the stress has no bound, and displacements converge with an order of about 1.5 (M. L. Williams,
Stress singularities resulting from various boundary conditions in angular corners of plates in extension, J. Appl.
Mech. 19 (1952) 526).  Three meshes show the order.  Two meshes do not, and their uncertainty reaches the limit of
order 1.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from comparisons.stations import station_of
from comparisons.verdict.point_forces import away_from_point_forces
from comparisons.verdict.rows import Row
from comparisons.verdict.uncertainty import GRIDS, Limit, limit
from cprbm_scene import Answer, Scene, StationAnswer
from cprbm_scene.answer import Flags
from cprbm_scene.statement import STRESSES


def solid_limit(
    scene: Scene, row: Row, answers: Sequence[Answer], beside: Sequence[StationAnswer] = ()
) -> tuple[Limit, Flags] | None:
    """Limit (k,) of the solid at a row, and the components that count; None if the two finest meshes lack such values.

    Args:
        scene: the question.
        row: of a comparison.
        answers: the solid's, on meshes each twice as fine as the mesh before; all complete.
        beside: other answers to the row. A stress does not count near held ends and near their contacts.
    """
    stations = [station_of(answer, row.stage, row.station) for answer in answers[-GRIDS:]]
    values = [station.values[row.probe.name] for station in stations]
    alike = [value.shape == row.fea.shape for value in values]
    if len(values) < 2 or not all(alike[-2:]):
        return None
    first = max((place + 1 for place, same in enumerate(alike) if not same), default=0)
    counts = np.ones(row.fea.shape, dtype=bool)
    if row.probe.quantity in STRESSES and row.arc_length is not None:
        counts = away_from_point_forces(scene, row.probe.of, row.arc_length, (*stations[-2:], *beside))
    sizes = [2.0**place for place in range(len(values))]
    return limit(sizes[first:], values[first:]), counts

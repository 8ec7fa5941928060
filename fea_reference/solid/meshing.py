"""Choice of the mesher for rectangles: gmsh if available, else NumPy, with equal nodes."""

import tempfile
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from cprbm_scene.answer import Array
from fea_reference.solid import carried, gmshed
from fea_reference.solid.mesh import Rectangle, plain_rectangle


def choose_mesher() -> tuple[Rectangle, str]:
    """The mesher of rectangles, and a note for the answer."""
    if gmshed.available() and carried.available():
        return by_gmsh, "meshed by gmsh, structured along the beams"
    return plain_rectangle, gmshed.MISSING


def by_gmsh(along: Array, across: int) -> tuple[Array, NDArray[np.int64]]:
    """A rectangle by gmsh, see :data:`~fea_reference.solid.mesh.Rectangle`: equal elements, then moved to ``along``."""
    n = along.size - 1
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "rectangle.msh"
        gmshed.write_rectangle(path, n, across)
        corners, quadrilaterals = carried.read_quadrilaterals(path)
    corners[0] = along[np.rint(corners[0] * n).astype(np.intp)]
    corners[1] = 2.0 * np.rint(0.5 * (corners[1] + 1.0) * across) / across - 1.0
    return corners, quadrilaterals

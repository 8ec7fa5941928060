"""Reader of gmsh's mesh files through meshio, imported on demand."""

from contextlib import redirect_stdout
from io import StringIO
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from cprbm_scene.answer import Array


def available() -> bool:
    """True if meshio can be imported."""
    try:
        import meshio  # noqa: F401 - whether it loads is the question
    except ImportError:
        return False
    return True


def read_quadrilaterals(path: Path) -> tuple[Array, NDArray[np.int64]]:
    """Corners (2, k) and quadrilaterals (4, c) of a mesh in the plane."""
    import meshio

    with redirect_stdout(StringIO()):  # meshio prints an empty line, and standard output may be a document
        mesh = meshio.read(path)
    return (
        np.ascontiguousarray(mesh.points[:, :2].T, dtype=np.float64),
        np.ascontiguousarray(mesh.cells_dict["quad"].T, dtype=np.int64),
    )

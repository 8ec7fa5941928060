"""The rectangle as gmsh cuts it is the plain one, and without gmsh there is a line that says so."""

import numpy as np
import pytest

from fea_reference.solid import Settings, gmshed, meshing, prepared
from fea_reference.solid.mesh import plain_rectangle
from tests.fea_reference.solid.bars import bar, straight


def placed(corners, quadrilaterals):
    """Places of the corners of every quadrilateral, whatever their order."""
    places = np.round(corners.T[quadrilaterals.T], 12)
    return sorted(sorted(map(tuple, one.tolist())) for one in places)


@pytest.mark.skipif(meshing.choose_mesher()[0] is plain_rectangle, reason="gmsh and meshio are not there")
def test_gmsh_cuts_the_same_quadrilaterals_and_says_nothing(capfd):
    along = np.array([0.0, 0.11, 0.2, 0.47, 0.8, 1.0])
    assert placed(*meshing.by_gmsh(along, 3)) == placed(*plain_rectangle(along, 3))
    assert capfd.readouterr().out == ""


def test_without_gmsh_the_answer_says_so(monkeypatch):
    monkeypatch.setattr(gmshed, "available", lambda: False)
    ready = prepared(bar(straight(0.3), 0.005, probes=(("tip", "displacement"),)), Settings(elements=3))
    assert "gmsh cannot be imported" in ready.answer().notes[0]

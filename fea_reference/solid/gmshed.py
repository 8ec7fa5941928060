"""Rectangle meshed by gmsh's transfinite mesher, imported on demand."""

from pathlib import Path

MISSING = "gmsh cannot be imported (the extra 'solid' installs gmsh): a mapped mesh with the same nodes"


def available() -> bool:
    """True if gmsh can be imported; its wheel needs desktop libraries."""
    try:
        import gmsh  # noqa: F401 - whether it loads is the question
    except (ImportError, OSError):
        return False
    return True


def write_rectangle(path: Path, n: int, across: int) -> None:
    """Write the mesh of [0, 1] × [−1, 1], in n × ``across`` equal quadrilaterals, to a file of gmsh."""
    import gmsh

    gmsh.initialize([], readConfigFiles=False, interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.model.add("rectangle")
        geo = gmsh.model.geo
        corners = [geo.addPoint(x, y, 0.0) for x, y in ((0.0, -1.0), (1.0, -1.0), (1.0, 1.0), (0.0, 1.0))]
        sides = [geo.addLine(corners[i], corners[(i + 1) % 4]) for i in range(4)]
        surface = geo.addPlaneSurface([geo.addCurveLoop(sides)])
        for side, count in zip(sides, (n, across, n, across), strict=True):
            geo.mesh.setTransfiniteCurve(side, count + 1)
        geo.mesh.setTransfiniteSurface(surface)
        geo.mesh.setRecombine(2, surface)
        geo.synchronize()
        gmsh.model.mesh.generate(2)
        gmsh.write(str(path))
    finally:
        gmsh.finalize()

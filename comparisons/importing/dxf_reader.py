"""The door to ezdxf: lines, arcs and polylines of a DXF drawing; a layer is a group of curves or points."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from comparisons.importing.drawing import Drawing, DrawnCurve
from cprbm_scene.answer import Array
from cprbm_scene.mistakes import Mistake, SceneError

SAMPLES = 61
"""Places along an arc: the fitted circle has a relative error of round-off."""

_UNITS = {1: "in", 4: "mm", 5: "cm", 6: "m", 13: "um"}
"""Units by the number of the header's variable $INSUNITS; 0 stands for a drawing without a unit."""


def read(path: Path, unit: str) -> Drawing:
    """Curves and points of the model space.

    Args:
        path: a DXF file.
        unit: expected unit of the drawing's lengths.

    Raises:
        ImportError: ezdxf is missing.
        SceneError: ezdxf refuses the file, or the file states another unit.
    """
    import ezdxf

    try:
        document = ezdxf.readfile(path)
    except Exception as error:  # of a broken file ezdxf raises errors of any kind
        found = f"a file that ezdxf does not read ({str(error).strip() or type(error).__name__})"
        raise SceneError([Mistake("", found, "a DXF file", str(path))]) from None
    number = document.header.get("$INSUNITS", 0)
    stated = _UNITS.get(number, "another unit")
    if number and stated != unit:
        found = f"a drawing in {stated} ($INSUNITS = {number}), read in {unit}"
        raise SceneError([Mistake("", found, f"--unit {stated}" if number in _UNITS else "a drawing in mm", str(path))])
    curves, refused, points = list[DrawnCurve](), list[str](), dict[str, list[Array]]()
    for entity in document.modelspace():
        kind, layer = entity.dxftype(), entity.dxf.layer
        parts = list(entity.virtual_entities()) if kind in ("LWPOLYLINE", "POLYLINE") else [entity]
        if kind == "POINT":
            points.setdefault(layer, []).append(np.array(entity.dxf.location))
        elif not {part.dxftype() for part in parts} <= {"LINE", "ARC"}:
            refused.append(f"{kind} on the layer {layer!r} (entity {entity.dxf.handle}), no line, arc or polyline")
            continue
        for part in parts if kind != "POINT" else ():
            place = len(curves) + 1
            tag = layer if layer != "0" else f"curve{place}"
            curves.append(DrawnCurve(tag, place, f"{kind} {entity.dxf.handle}", _along(part), None))
    tagged = any(curve.tag != f"curve{curve.number}" for curve in curves)
    return Drawing(tuple(curves), {layer: np.array(each) for layer, each in points.items()}, tagged, tuple(refused))


def _along(part) -> Array:  # type: ignore[no-untyped-def]  # noqa: ANN001 - ezdxf exports no types
    """Places (k, 3) along a line or an arc."""
    if part.dxftype() == "LINE":
        return np.array([tuple(part.dxf.start), tuple(part.dxf.end)])
    return np.array([tuple(place) for place in part.vertices(part.angles(SAMPLES))])

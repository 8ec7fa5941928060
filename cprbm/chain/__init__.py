"""The chain: beams as rigid or compliant links with torsional springs, and rows."""

from cprbm.chain.beam import BeamChain, ChainUnits, Theory
from cprbm.chain.compiled import compiled, compiled_inner
from cprbm.chain.kernel import Blocks, Joints, Links, evaluate_chains, link_arrays, strain_energy
from cprbm.chain.loads import hidden_angles, hidden_flexibility
from cprbm.chain.mechanism import AXES, PER_LINK, Direction, Form, Mechanism, Row, mechanism_of
from cprbm.chain.rows import (
    END,
    RowArrays,
    add_row_gradient,
    add_rows,
    apart_ends,
    ends_of,
    row_arrays,
    row_values,
    stop_angle,
    unit_direction,
)
from cprbm.chain.spline import POWERS, lost_compliance

__all__ = [
    "AXES",
    "END",
    "PER_LINK",
    "POWERS",
    "BeamChain",
    "Blocks",
    "ChainUnits",
    "Direction",
    "Form",
    "Joints",
    "Links",
    "Mechanism",
    "Row",
    "RowArrays",
    "Theory",
    "add_row_gradient",
    "add_rows",
    "apart_ends",
    "compiled",
    "compiled_inner",
    "ends_of",
    "evaluate_chains",
    "hidden_angles",
    "hidden_flexibility",
    "link_arrays",
    "lost_compliance",
    "mechanism_of",
    "row_arrays",
    "row_values",
    "stop_angle",
    "strain_energy",
    "unit_direction",
]

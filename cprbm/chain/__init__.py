"""The chain: beams as rigid or compliant links with torsional springs, and rows."""

from cprbm.chain.arrays import RowArrays, add_row_gradient, link_arrays, row_arrays, row_values
from cprbm.chain.beam import BeamChain, ChainUnits, Theory
from cprbm.chain.kernel import Blocks, Joints, Links, empty_blocks, evaluate_chains, strain_energy
from cprbm.chain.loads import hidden_angles, hidden_flexibility
from cprbm.chain.mechanism import Form, Mechanism, Row, mechanism_of
from cprbm.chain.rows import add_rows, apart_ends, stop_angle

__all__ = [
    "BeamChain",
    "Blocks",
    "ChainUnits",
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
    "empty_blocks",
    "evaluate_chains",
    "hidden_angles",
    "hidden_flexibility",
    "link_arrays",
    "mechanism_of",
    "row_arrays",
    "row_values",
    "stop_angle",
    "strain_energy",
]

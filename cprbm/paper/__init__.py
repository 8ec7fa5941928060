"""The paper's own formulation: related joints, offset points, fitted boundary."""

from cprbm.paper.contacts import paper_geometry

__all__ = ["paper_geometry"]

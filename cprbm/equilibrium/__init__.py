"""Equilibria of a mechanism: Newton's method, exact elimination with inertia, certificate, stability."""

from cprbm.equilibrium.certificate import certify
from cprbm.equilibrium.columns import contact_columns, contact_terms, gap_rates, squares_of
from cprbm.equilibrium.contact_set import ContactClosesError, NotConvergedError, with_fixed_places
from cprbm.equilibrium.factors import Springs
from cprbm.equilibrium.neighbours import with_minima
from cprbm.equilibrium.solving import Solved, at_state, balanced_forces, equilibrium, repeated_rows, shared_multipliers
from cprbm.equilibrium.stability import Mode, blocked, softest, with_touching
from cprbm.equilibrium.system import State, System, hidden_forces, rest_state, system_of

__all__ = [
    "ContactClosesError",
    "Mode",
    "NotConvergedError",
    "Solved",
    "Springs",
    "State",
    "System",
    "at_state",
    "balanced_forces",
    "blocked",
    "certify",
    "contact_columns",
    "contact_terms",
    "equilibrium",
    "gap_rates",
    "hidden_forces",
    "repeated_rows",
    "rest_state",
    "shared_multipliers",
    "softest",
    "squares_of",
    "system_of",
    "with_fixed_places",
    "with_minima",
    "with_touching",
]

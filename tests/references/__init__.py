"""Independent exact solutions that both solvers are tested against; none of our packages is imported here."""

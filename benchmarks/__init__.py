"""Programs to measure the project's solvers against; they stand in a checkout and outside the wheel."""

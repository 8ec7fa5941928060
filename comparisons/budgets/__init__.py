"""What a difference between the solvers is made of."""

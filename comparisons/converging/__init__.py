"""How numbers go with N: limits, orders and families of runs."""

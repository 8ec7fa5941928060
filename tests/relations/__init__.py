"""What may be done to a scene without another answer, and by how much a solver's answer changes when it is done."""

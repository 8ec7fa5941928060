"""Solve a built-in case.

The rotational hinge by both solvers in bending, and a certificate.
"""

import cprbm
import fea_reference
from comparisons.cases import opened

hinge = opened("hinge")
chain = cprbm.answer(hinge, cprbm.Settings(links=20))
settings = fea_reference.Settings(elements=20, kinematics="bending")  # as the chain
elements = fea_reference.answer(hinge, settings)

for answer in (chain, elements):
    last = answer.stations[-1]  # at 0.67 N·m; values are arrays in SI
    turned = last.values["BD.rotation"][0]
    force = last.values["contact.force"][0]
    print(f"{answer.solver}: {answer.ending.name}")
    print(f"  BD turns by {turned:.4f} rad, the beams press with {force:.3f} N")

certificate = chain.stations[-1].certificate
print("holds:", certificate.holds)
print("a minimum of the potential energy:", certificate.smallest_curvature > 0.0)
print("forces balance to 1e-8:", certificate.force_balance < 1e-8)

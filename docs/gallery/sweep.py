"""Sweep a parameter.

Contact force and rotation of the hinge against the thickness of the beams.  A
scene is a frozen record, and ``with_parameters`` returns a new scene.
"""

import matplotlib.pyplot as plt

import cprbm
from comparisons.cases import opened

hinge = opened("hinge")
thicknesses = [1.8e-3, 1.9e-3, 2.0e-3, 2.1e-3, 2.2e-3]
turns, forces = [], []
for thickness in thicknesses:
    changed = hinge.with_parameters(t=thickness)
    answer = cprbm.answer(changed, cprbm.Settings(links=20))
    last = answer.stations[-1].values
    turns.append(last["BD.rotation"][0])
    forces.append(last["contact.force"][0])
    numbers = f"{turns[-1]:.3f} rad, {forces[-1]:6.3f} N, {answer.ending.name}"
    print(f"t = {1e3 * thickness:.1f} mm: {numbers}")

figure, (left, right) = plt.subplots(1, 2, figsize=(7.0, 2.8), layout="constrained")
left.plot([1e3 * thickness for thickness in thicknesses], turns, "o-")
left.set(xlabel="thickness, mm", ylabel="rotation of BD, rad")
right.plot([1e3 * thickness for thickness in thicknesses], forces, "o-")
right.set(xlabel="thickness, mm", ylabel="contact force, N")
figure.savefig("sweep.svg")

"""Sweep a parameter.

How the contact force of the hinge and the turn of its link change with the
thickness of the beams.  A scene is a frozen record: ``model_copy`` makes
another one.
"""

import matplotlib.pyplot as plt

import cprbm
from comparisons.cases import opened

hinge = opened("hinge")
thicknesses = [1.8e-3, 1.9e-3, 2.0e-3, 2.1e-3, 2.2e-3]
turns, forces = [], []
for thickness in thicknesses:
    thick = {"thickness": thickness}
    beams = {name: each.model_copy(update=thick) for name, each in hinge.beams.items()}
    changed = hinge.model_copy(update={"beams": beams})
    answer = cprbm.answer(changed, cprbm.Settings(links=20))
    last = answer.stations[-1].values
    turns.append(last["BD.rotation"][0])
    forces.append(last["contact.force"][0])
    told = f"{turns[-1]:.3f} rad, {forces[-1]:6.3f} N, {answer.ending.name}"
    print(f"t = {1e3 * thickness:.1f} mm: {told}")

figure, (left, right) = plt.subplots(1, 2, figsize=(7.0, 2.8), layout="constrained")
left.plot([1e3 * each for each in thicknesses], turns, "o-")
left.set(xlabel="thickness, mm", ylabel="rotation of BD, rad")
right.plot([1e3 * each for each in thicknesses], forces, "o-")
right.set(xlabel="thickness, mm", ylabel="contact force, N")
figure.savefig("sweep.svg")

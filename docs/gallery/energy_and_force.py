"""Energy and force of a bistable arch.

The reaction of the drive is the slope of the energy. At zero reaction the shuttle
rests without the drive: at a maximum of the energy on the way, and at a minimum
in the second stable state.
"""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import cprbm
import cprbm_scene

arch = cprbm_scene.read(Path(__file__).with_name("arch.toml"))
answer = cprbm.answer(arch, cprbm.Settings(links=24))
print(answer.ending.name)

values = [station.values for station in answer.stations]
push = np.array([0.0, *(station.value for station in answer.stations)])
energy = np.array([0.0, *(each["scene.potential_energy"][0] for each in values)])
force = np.array([0.0, *(-each["middle.reaction"][1] for each in values)])  # down

for place in np.flatnonzero(np.diff(np.sign(force[1:]))) + 1:
    share = force[place] / (force[place] - force[place + 1])
    at = push[place] + share * (push[place + 1] - push[place])
    kind = "maximum" if force[place] > 0.0 else "minimum"
    print(f"no force at about {1e3 * at:.2f} mm: {kind} of the energy")

figure, (top, bottom) = plt.subplots(
    2, 1, figsize=(6.0, 4.6), sharex=True, layout="constrained"
)
top.plot(1e3 * push, 1e3 * energy, "o-")
top.set(ylabel="energy, mJ")
bottom.axhline(0.0, color="grey", linewidth=0.6)
bottom.plot(1e3 * push, force, "o-")
bottom.set(xlabel="push, mm", ylabel="force of the drive, N")
figure.savefig("energy_and_force.svg")

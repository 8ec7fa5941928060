"""A structurally singular system of many contacts counts as singular and does not end the process."""

import os
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[2]
PROGRAM = """
import comparisons
from comparisons.choices import Choices
from cprbm_scene import read

scene = read("tests/scenes/rare/lifted-off-a-corner.toml")
print(comparisons.compare(scene, Choices(links=80, elements=40, kinematics="bending")).verdict.word.name)
"""


def test_a_structurally_singular_system_does_not_end_the_process():
    # the C library fills fresh memory with a pattern: a read of uninitialised memory is an invalid address then
    environment = {**os.environ, "MALLOC_PERTURB_": "165"}
    done = subprocess.run([sys.executable, "-c", PROGRAM], cwd=ROOT, env=environment, capture_output=True, text=True)
    assert (done.returncode, done.stdout) == (0, "AGREE\n"), done.stderr[-400:]

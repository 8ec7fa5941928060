"""Contact of a beam with itself: which parts face each other, rows and their derivatives, necks and coils."""

import numpy as np
import pytest

import cprbm
from cprbm.contact import NO_ROWS, Rows
from cprbm.crossing import own_crossings
from cprbm.equilibrium import contact_gradient, contact_rows, local_rows, measure, point_at
from cprbm.kinematics import State, positions, rest_state
from cprbm.mechanism import mechanism_of
from cprbm.strands import NO_FACES, Faces, in_coil, sides, turned_enough
from scene import SceneError
from scene.reading import scene_from
from tests.cprbm import necks
from tests.references.pressed_column import closed, closing

STEP = 1e-6



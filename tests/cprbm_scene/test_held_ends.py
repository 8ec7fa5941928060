"""Two beams welded side by side to one body: what rounded coordinates overlap there is no mistake."""

import pytest

from tests.cprbm_scene.editing import edited, mistakes, two_lines

T = 0.002
SPREAD = 0.05  # slope of the upper beam against the lower one


def _from_one_block(overlap, *, slope=SPREAD, joint="weld", body="block"):
    """A level beam and one above it that ends beside it, ``overlap`` less than a thickness above, and rises away."""
    y = T - overlap
    base = two_lines(0.0, second=((0.0, y + 0.1 * slope), (0.1, y)))
    base["bodies"][body]["points"]["S"] = [0.1, y]
    return edited(("beams/upper/end", {"joint": joint, "point": "S"}), base=base)


@pytest.mark.parametrize("share", [0.0, 6.35e-4, 9e-4])
def test_what_rounding_overlaps_beside_one_block_passes(share):
    """6.35e-4 is what the gripper's coordinates make with the digits that are printed."""
    assert mistakes(base=_from_one_block(share * T)) == {}


@pytest.mark.parametrize(
    ("share", "change"),
    [
        (2e-3, {}),
        (6.35e-4, {"joint": "pin"}),
        (6.35e-4, {"body": "ground"}),
        (6.35e-4, {"slope": 0.0}),
    ],
    ids=["too much", "a pin", "two bodies", "all along"],
)
def test_every_other_overlap_is_refused(share, change):
    found = mistakes(base=_from_one_block(share * T, **change))
    assert f"{share:.3g} of their mean thickness" in found["contacts.touch"]

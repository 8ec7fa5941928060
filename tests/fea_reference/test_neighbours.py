"""Nodes that are near each other, against all pairs of them."""

import numpy as np
import pytest

from fea_reference.neighbours import near_each_other, nearest


def _walk(seed: int, nodes: int, start: complex) -> np.ndarray:
    steps = np.exp(1j * np.cumsum(np.random.default_rng(seed).normal(0.0, 0.1, nodes)))
    return start + np.cumsum(steps) / nodes


@pytest.mark.parametrize("reach", [0.0, 0.01, 0.1, 10.0])
@pytest.mark.parametrize("start", [0.0, 0.05j, 3.0 + 1.0j])
def test_no_pair_of_nodes_within_reach_is_left_out_nor_the_nearest(reach, start):
    first, second = _walk(1, 330, 0.0), _walk(2, 517, start)
    apart = np.abs(first[:, None] - second)
    one, other = near_each_other(first, second, reach)
    here, there = np.nonzero(apart < reach)
    assert set(here) <= set(one)
    assert set(there) <= set(other)
    assert nearest(first[one], second[other])[0].min() == pytest.approx(apart.min(), rel=1e-15)


def test_runs_of_nodes_that_are_far_are_left_out():
    first, second = np.linspace(0.0, 1.0, 1000) + 0.0j, np.linspace(1.0, 2.0, 1000) + 0.01j
    one, other = near_each_other(first, second, 0.02)
    assert one.size < 100
    assert other.size < 100

"""Bordered tridiagonal systems and the complementarity problem against dense algebra."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cprbm.bordered import SINGULAR, anchored, bordered, factorised, generic
from cprbm.complementarity import pressing


def dense(diagonal, off, border, corner):
    Q = np.diag(diagonal) + np.diag(off, 1) + np.diag(off, -1)
    return np.block([[Q, border], [border.T, corner]])


@pytest.mark.parametrize("shift", [3.0, 0.31, -0.7])
def test_solution_and_inertia(shift):
    random = np.random.default_rng(23)
    n, m = 31, 5
    diagonal, off = shift + random.random(n), random.standard_normal(n - 1)
    border, corner = random.standard_normal((n, m)), random.standard_normal((m, m))
    corner = corner + corner.T
    found = bordered(factorised(diagonal, off), border, corner)
    K = dense(diagonal, off, border, corner)
    right = random.standard_normal(n + m)
    a, b = found.kept(np.arange(m)).solve(right[:n], right[n:])
    assert np.concatenate((a, b)) == pytest.approx(np.linalg.solve(K, right), rel=1e-8, abs=1e-9)
    assert found.kept(np.arange(m)).negative == np.sum(np.linalg.eigvalsh(K) < 0.0)
    keep = np.array([0, 3])
    smaller = K[np.ix_([*range(n), n, n + 3], [*range(n), n, n + 3])]
    assert found.kept(keep).negative == np.sum(np.linalg.eigvalsh(smaller) < 0.0)


def test_a_singular_middle_is_refined_away():
    # Q is singular to one part in 1e11, the whole system is not
    n = 12
    diagonal, off = np.full(n, 2.0), np.full(n - 1, -1.0)
    diagonal = diagonal - 2.0 * (1.0 - np.cos(np.pi / (n + 1))) * (1.0 - 1e-11)
    border = np.linspace(0.4, 1.3, n)[:, None]
    found = bordered(factorised(diagonal, off), border, np.zeros((1, 1)))
    right = np.sin(np.arange(n + 1.0))
    a, b = found.kept(np.arange(1)).solve(right[:n], right[n:])
    exact = np.linalg.solve(dense(diagonal, off, border, np.zeros((1, 1))), right)
    assert np.concatenate((a, b)) == pytest.approx(exact, rel=1e-12, abs=1e-12)


@given(st.integers(1, 9), st.integers(0, 2**32 - 1), st.integers(0, 3))
@settings(deadline=None, derandomize=True, max_examples=200)
def test_complementarity_holds_for_any_compliance(m, seed, lost):
    random = np.random.default_rng(seed)
    rank = max(1, m - lost)
    R = random.standard_normal((rank, m))
    G = R.T @ R
    # b in the range of G and a little less: the gaps can be opened, as those of a mechanism can
    b = G @ random.standard_normal(m) - 0.1 * random.random(m)
    lam, active = pressing(G, b, random.random(m) < 0.5)
    w = G @ lam - b
    scale = 1.0 + np.max(np.abs(b))
    assert np.all(lam >= 0.0)
    assert np.all(w >= -1e-6 * scale)
    assert np.max(np.abs(lam * w)) < 1e-5 * scale * (1.0 + np.max(lam))
    assert np.all(lam[~active] == 0.0)


def all_but_singular(n, mode, smallest):
    """Second differences of n values with one eigenvalue, of a certain ``mode``, shifted to ``smallest``."""
    closed_form = 2.0 - 2.0 * np.cos(mode * np.pi / (n + 1))
    return np.full(n, 2.0 - closed_form + smallest), np.full(n - 1, -1.0)


NONE = np.zeros(0, dtype=np.intp)


@pytest.mark.parametrize("mode", [1, 6, 11])
@pytest.mark.parametrize(("smallest", "few"), [(0.37, False), (-0.83, False), (1.7, True), (-2.3, True)])
def test_what_is_nearly_singular_is_anchored(mode, smallest, few):
    # reference: the eigenvalues by LAPACK; of a vector that often changes its sign there is little in a smooth one
    n = 23
    diagonal, off = all_but_singular(n, mode, smallest * SINGULAR)
    metric = np.ones(n)
    anchors = anchored(diagonal, off, metric, NONE, NONE)
    assert (len(anchors) == 0) is few
    kept = np.setdiff1d(np.arange(n), anchors)
    Q = (np.diag(diagonal) + np.diag(off, 1) + np.diag(off, -1))[np.ix_(kept, kept)]
    assert np.min(np.abs(np.linalg.eigvalsh(Q))) > SINGULAR


@pytest.mark.parametrize(("smallest", "suspect"), [(0.37 * SINGULAR, True), (-0.61 * SINGULAR, True), (0.0043, False)])
def test_what_is_nearly_singular_is_suspect(smallest, suspect):
    # SUSPECT is thirty times SINGULAR: 0.003
    n = 23
    diagonal, off = all_but_singular(n, 1, smallest)
    metric = np.ones(n)
    assert factorised(diagonal, off).nearly_singular(generic(metric, NONE), metric) is suspect

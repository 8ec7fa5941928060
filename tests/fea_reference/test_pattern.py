"""Sums of local matrices against the same sums one entry after the other."""

import numpy as np

from fea_reference.pattern import Block, Patterns, Single

SIZE = 23


def blocks(rng, width):
    """Elements that follow each other, and one contact of so many unknowns that couples what is far apart."""
    every = np.arange(SIZE - 4) + np.arange(5)[:, None]
    contact = rng.permutation(SIZE)[: 3 * width].reshape(width, 3)
    rows, columns = rng.integers(0, SIZE, (2, 7))
    return [
        Single(rows, columns, rng.standard_normal(7)),
        Block(every, rng.standard_normal((5, 5, SIZE - 4))),
        Block(contact, rng.standard_normal((width, width, 3))),
    ]


def summed(parts):
    total = np.zeros((SIZE, SIZE))
    single, *local = parts
    np.add.at(total, (single.rows, single.columns), single.values)
    for one in local:
        for dofs, matrix in zip(one.dofs.T, np.moveaxis(one.local, 2, 0), strict=True):
            for a, i in enumerate(dofs):
                for b, j in enumerate(dofs):
                    total[i, j] += matrix[a, b]
    return total


def test_matrices_of_patterns_that_come_again_and_change():
    """Symmetric local matrices, as stiffnesses are; three values of each of two patterns, by turns."""
    patterns = Patterns(SIZE)
    for turn in range(6):
        parts = blocks(np.random.default_rng(turn % 2), 3 + 2 * (turn % 2))
        rng = np.random.default_rng(100 + turn)
        parts = [
            Single(parts[0].rows, parts[0].columns, rng.standard_normal(7)),
            *(
                Block(one.dofs, local + local.swapaxes(0, 1))
                for one in parts[1:]
                for local in [rng.standard_normal(one.local.shape)]
            ),
        ]
        found = patterns.matrix(parts)
        assert found.has_sorted_indices
        np.testing.assert_allclose(found.toarray(), summed(parts), rtol=0.0, atol=1e-13)

"""The chain's second edition: formulas, elimination, truths, rates."""

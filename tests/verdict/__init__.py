"""The verdict on made-up answers, by families: uncertainties, rows, words, events, completeness and sentences."""

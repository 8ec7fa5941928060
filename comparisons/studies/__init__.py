"""The longer questions: each a measurement piece by piece, and what is told of it in data, words and a figure."""

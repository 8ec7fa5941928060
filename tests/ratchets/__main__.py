"""``python -m tests.ratchets``: the table of current numbers and limits; ``--lower`` writes the lower limits first.

The exit code is 1 if a number is above the limit, else 0.
"""

import argparse
import sys
from pathlib import Path

from tests.ratchets.limits import FILE, NAMES, departures, lowered, read, write
from tests.ratchets.sizes import sizes

ROOT = Path(__file__).parents[2]


def main(arguments: list[str] | None = None, file: Path = FILE, root: Path = ROOT) -> int:
    """Print the table and the departures from the limits, and return the exit code."""
    parser = argparse.ArgumentParser(prog="python -m tests.ratchets", description="Sizes of the product packages.")
    parser.add_argument("--lower", action="store_true", help="lower the limits to the current numbers")
    options = parser.parse_args(arguments)
    limits = read(file)
    current = {package: sizes(root / package) for package in limits}
    if options.lower:
        limits = lowered(limits, current)
        write(limits, file)
    rows = [
        (package, NAMES[name], current[package][name], limit)
        for package, numbers in limits.items()
        for name, limit in numbers.items()
    ]
    sys.stdout.write(f"{'package':18} {'current':>8} {'limit':>8}\n")
    sys.stdout.writelines(f"{package:18} {number:8} {limit:8}  {name}\n" for package, name, number, limit in rows)
    sys.stdout.writelines(f"{sentence}\n" for sentence in departures(limits, current))
    return int(any(number > limit for _, _, number, limit in rows))


if __name__ == "__main__":
    sys.exit(main())

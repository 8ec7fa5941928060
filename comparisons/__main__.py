"""``python -m comparisons``: the program ``cprbm`` under the Python that is named, wherever its own file was put."""

from comparisons.cli.program import main

if __name__ == "__main__":
    main()

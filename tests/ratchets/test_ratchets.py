"""The ratchets hold for the product packages, and a planted violation changes the number.

The planted package and the expected numbers are written by hand.
"""

import tomllib
from pathlib import Path

import pytest

from tests.ratchets.__main__ import main
from tests.ratchets.limits import departures, lowered, read, write
from tests.ratchets.sizes import MEASURES, sizes

ROOT = Path(__file__).parents[2]
PACKAGES = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["tool"]["mypy"]["packages"]

LONG_FUNCTION = "def long(x):\n" + "    x += 1\n" * 59 + "    return x\n"
"""A function of 61 lines: ``def``, 59 sums, ``return``."""
COMPLEX_FUNCTION = "def branching(x):  # noqa: C901\n" + "".join(
    f"    if x == {n}:\n        return {n}\n" for n in range(15)
)
"""A function of complexity 16: 15 branches and the way past the branches."""
LONG_MODULE = "\n" * 401
PLAIN = '"""Gap of two beams at one station."""\n# two words\nGAP = 1.0\n"""Gap in metres."""\n'
"""A single statement; seven counted words with a single pronoun."""


@pytest.fixture
def package(tmp_path):
    """Function from further sources to the five numbers of a package with a plain module."""

    def package(**sources):
        folder = tmp_path / "planted" / "inner"
        folder.mkdir(parents=True, exist_ok=True)
        for name, source in ({"plain": PLAIN} | sources).items():
            (folder / f"{name}.py").write_text(source, encoding="utf-8")
        return sizes(tmp_path / "planted")

    return package


SMALL = {"pronouns": 14.3, "long-functions": 0, "complex-functions": 0, "long-modules": 0, "statements": 1}
"""Numbers of the plain package: a pronoun in seven words."""


def test_a_plain_package_has_the_numbers_counted_by_hand(package):
    assert package() == SMALL


@pytest.mark.parametrize(
    ("source", "changes"),
    [
        # def, 59 sums, return
        (LONG_FUNCTION, {"long-functions": 1, "statements": 62}),
        (LONG_FUNCTION.replace("    x += 1\n", "", 1), {"statements": 61}),
        # def, 15 times if and return
        (COMPLEX_FUNCTION, {"complex-functions": 1, "statements": 32}),
        (COMPLEX_FUNCTION.replace("    if x == 0:\n        return 0\n", ""), {"statements": 30}),
        (LONG_MODULE, {"long-modules": 1}),
        (LONG_MODULE[1:], {}),
        # five pronouns in thirteen words
        ("# what it is that one sees\n", {"pronouns": 38.5}),
        # a pronoun in eleven words: an indented block does not count
        (
            "def f():\n    '''Length of a beam.\n\n    Example::\n\n        it that which one\n    '''\n",
            {"pronouns": 9.1, "statements": 2},
        ),
        ("x = 1; y = 2\nif x:\n    pass\n", {"statements": 5}),
    ],
)
def test_a_planted_source_changes_its_numbers_only(package, source, changes):
    assert package(planted=source) == SMALL | changes


@pytest.mark.parametrize("name", MEASURES)
def test_a_number_above_its_limit_is_a_departure(package, name):
    limits = {"planted": SMALL | {name: SMALL[name] - 1}}
    (sentence,) = departures(limits, {"planted": package()})
    assert f"limit {SMALL[name] - 1}. The number may only fall" in sentence


@pytest.mark.parametrize("name", MEASURES)
def test_a_number_below_its_limit_is_a_departure(package, name):
    limits = {"planted": SMALL | {name: SMALL[name] + 1}}
    (sentence,) = departures(limits, {"planted": package()})
    assert sentence.endswith("Run `python -m tests.ratchets --lower` in the same commit.")


def test_limits_are_lowered_and_never_raised(package):
    limits = {"planted": SMALL | {"statements": 9, "long-modules": -1}}
    assert lowered(limits, {"planted": package()}) == {"planted": SMALL | {"long-modules": -1}}


def test_the_program_prints_the_table_and_writes_lower_limits(package, tmp_path, capsys):
    package(planted=LONG_FUNCTION)
    file = tmp_path / "limits.toml"
    write({"planted": SMALL | {"statements": 70}}, file)
    assert main(["--lower"], file, tmp_path) == 1
    assert read(file) == {"planted": SMALL | {"statements": 62}}
    table, _, sentences = capsys.readouterr().out.partition("planted: ")
    assert "planted                   1        0  functions above 60 lines\n" in table
    assert "planted                  62       62  statements\n" in table
    assert sentences.startswith("1 functions above 60 lines, limit 0. The number may only fall")


def test_every_product_package_has_all_limits():
    limits = read()
    assert list(limits) == PACKAGES
    assert all(list(numbers) == list(MEASURES) for numbers in limits.values())


@pytest.mark.parametrize("package_name", PACKAGES)
def test_the_numbers_are_at_their_limits(package_name):
    current = {package_name: sizes(ROOT / package_name)}
    assert list(departures({package_name: read()[package_name]}, current)) == []

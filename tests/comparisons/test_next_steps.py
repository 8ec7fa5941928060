"""What is said of a wrong question: what was found, what is allowed, what may have been meant, and what comes next."""

from pathlib import Path

import pytest

from comparisons.cli.main import run
from comparisons.starting.begun import begin

WORDS = [
    (
        ["slove", "hinge"],
        "found 'slove'",
        "is 'solve' meant?",
        "allowed: new, import, solve, compare",
        "Try 'cprbm --help'",
    ),
    (["study", "calibrate"], "found 'calibrate'", "is 'calibration' meant?", "Try 'cprbm study --help'"),
    (["study", "zzz"], "found 'zzz', no command of 'cprbm study'; allowed: calibration, relations"),
    (["solve"], "'CASE|FILE.toml'", "'cprbm list' names the cases", "'cprbm new NAME'", "Try 'cprbm solve --help'"),
    (["compare"], "'CASE|FILE.toml...|all'", "'cprbm list' names the cases", "Try 'cprbm compare --help'"),
    (["new"], "'NAME'", "Try 'cprbm new --help'"),
    (["solve", "Hinge"], "found 'Hinge' (is 'hinge' meant?)", "or the path of a file that ends in .toml"),
    (["compare", "gripper_driven"], "is 'gripper-driven' meant?"),
    (["solve", "zzz"], "found 'zzz'; allowed: a built-in case (five-bar, "),
    (["solve", "mine"], "found 'mine' (is the file mine.toml meant?)"),
    (["solve", "mnie.toml"], "No such file", "is mine.toml meant?", "'cprbm new NAME' writes a scene"),
    (["solve", "hinge", "--slover", "fea"], "'--slover'", "'--solver'?", "Try 'cprbm solve --help'"),
    (["solve", "hinge", "--solver", "fem"], "'fem'", "'cprbm', 'fea', 'exact', 'solid'"),
    (["solve", "hinge", "-n", "forty"], "found 'forty'; allowed: a whole number", "Try 'cprbm solve --help'"),
    (["solve", "hinge", "-n", "bem1=30,beam2=40"], "found bem1=30", "the beams beam1, beam2"),
    (["compare", "hinge", "--tol", "2"], "found '2'; allowed: as 0.1%", "Try 'cprbm compare --help'"),
    (["converge", "hinge", "--sizes", "40,20"], "found '40,20'", "each larger than the one before"),
    (["new", "mine"], "found mine.toml, an existing file", "another name"),
]
FILES = [
    ("thickness =", "thicknes =", "beams.strip.thicknes: found 'thicknes'", "is 'thickness' meant?"),
    ('material = "steel"', 'material = "stel"', "beams.strip.material", "is 'steel' meant?"),
    ('point = "clamp"', 'point = "clmap"', "beams.strip.start.point", "is 'clamp' meant?"),
    (
        'kind = "line"',
        'kind = "Lien"',
        "beams.strip.curve.kind: found 'Lien' (is 'line' meant?); allowed: one of 'line'",
    ),
    ('motion = "fixed"', 'motion = "fix"', "bodies.ground.motion: found 'fix' (is 'fixed' meant?)"),
    ('kind = "beam-circle"', 'kind = "beam_circle"', "contacts.pin.kind", "is 'beam-circle' meant?"),
    (
        'quantity = "displacement"',
        'quantity = "displacment"',
        "probes[0].quantity",
        "is 'displacement' meant?",
        "'rotation'",
    ),
    ('name = "mine"', 'name = "mine"\nunits = { lenght = "mm" }', "units.lenght", "is 'length' meant?"),
    ('name = "mine"', 'name = "mine"\nunits = { stress = "mpa" }', "units.stress: found 'mpa' (is 'MPa' meant?)"),
    ('name = "mine"', 'name = "mine"\nunits = { angle = "degree" }', "is 'deg' meant?"),
    ('name = "mine"', 'name = "mine"\nunits = { force = "mm" }', "units.force: found 'mm'; allowed: one of 'N', 'kN'"),
    ('name = "mine"', 'name = "mine"\nunits = "mm"', "units: found 'mm'; allowed: a table, as units = {"),
    (
        "thickness = 0.0011",
        'thickness = "1.1 mm"',
        "found '1.1 mm'",
        "a number, or a table",
        "states its once, as units",
    ),
    ("radius = 0.006", 'radius = "6mm"', "found '6mm'; allowed: a number; numbers have no units", "units = { length"),
    ("radius = 0.006", 'radius = "six"', "found 'six'; allowed: a number\n"),
]


@pytest.fixture
def folder(tmp_path, monkeypatch):
    begin("mine", tmp_path)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def _said(arguments, capsys):
    assert run(arguments) == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err.startswith("cprbm: ")
    assert "?." not in captured.err
    assert ".." not in captured.err.replace("...", "")
    return captured.err


@pytest.mark.parametrize(("arguments", "parts"), [(words[0], words[1:]) for words in WORDS], ids=lambda it: str(it[-1]))
def test_wrong_words(arguments, parts, folder, capsys):
    said = _said(arguments, capsys)
    for part in parts:
        assert part in said


@pytest.mark.parametrize(("old", "new", "parts"), [(line[0], line[1], line[2:]) for line in FILES])
def test_wrong_files(old, new, parts, folder, capsys):
    path = Path("mine.toml")
    text = path.read_text(encoding="utf-8")
    assert old in text
    path.write_text(text.replace(old, new, 1), encoding="utf-8")
    said = _said(["solve", "mine.toml"], capsys)
    assert "mine.toml: " in said
    for part in parts:
        assert part in said


def test_several_mistakes_have_a_line_each(folder, capsys):
    path = Path("mine.toml")
    text = (
        path.read_text(encoding="utf-8")
        .replace('"steel"', '"stel"')
        .replace("poisson_ratio = 0.3", "poisson_ratio = 0.7")
    )
    path.write_text(text.replace("width =", "widht ="), encoding="utf-8")
    first, *lines = _said(["solve", "mine.toml"], capsys).splitlines()
    assert first == "cprbm: The question is wrong."
    assert len(lines) >= 3
    assert all(line.startswith("  mine.toml: ") for line in lines)


@pytest.mark.parametrize("unit", ["M", "nm", "lb"])
def test_between_short_words_nothing_is_guessed(unit, folder, capsys):
    """Any two units are near each other: what was meant could be one or the other."""
    path = Path("mine.toml")
    text = path.read_text(encoding="utf-8")
    path.write_text(text.replace('name = "mine"', f'name = "mine"\nunits = {{ force = "{unit}" }}'), encoding="utf-8")
    said = _said(["solve", "mine.toml"], capsys)
    assert f"units.force: found {unit!r}; allowed: one of 'N'" in said

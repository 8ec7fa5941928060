"""A wrong question: a paragraph with the file, the key, the words found and allowed, and the next step; exit code 2."""

import re
import shutil
from pathlib import Path

import pytest

from comparisons import cases
from comparisons.cli.main import run
from comparisons.pairing import Solvers
from cprbm_scene import SceneError

HINGE = (Path(cases.__file__).parent / "hinge.toml").read_text("utf-8")
PRESTRESSED = (Path(cases.__file__).parent / "prestressed.toml").read_text("utf-8")
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
    (["sweep", "hinge", "--sample", "absent.csv"], "absent.csv: found a file that cannot be read (No such file"),
    (["solve", "mnie.toml"], "No such file", "is mine.toml meant?", "'cprbm new NAME' writes a scene"),
    (["solve", "hinge", "--slover", "fea"], "'--slover'", "'--solver'?", "Try 'cprbm solve --help'"),
    (["solve", "hinge", "--solver", "fem"], "'fem'", "'cprbm', 'fea', 'exact', 'solid'"),
    (["solve", "hinge", "-n", "forty"], "found 'forty'; allowed: a whole number", "Try 'cprbm solve --help'"),
    (["solve", "hinge", "-n", "bem1=30,beam2=40"], "found bem1=30", "the beams beam1, beam2"),
    (["compare", "hinge", "--tol", "2"], "found '2'; allowed: as 0.1%", "Try 'cprbm compare --help'"),
    (["converge", "hinge", "--sizes", "40,20"], "found '40,20'", "each larger than the one before"),
    (["new", "mine"], "found mine.toml, an existing file", "another name"),
    (["solve", "hinge", "-n", "10000"], "from 1 to 9999"),
    (["solve", "hinge", "-n", "beam1=3,beam1=4"], "once for each beam"),
    (["solve", "hinge", "-n", "beam1=3"], "found beam1=3", "the beams beam1, beam2"),
    (["solve", "hinge", "--links", "10", "--tol", "1%"], "--tol and -n"),
    (["compare", "hinge", "--penetration", "nan"], "found 'nan'"),
    (["compare", "hinge", "--kinematics", "timoshenko"], "timoshenko", "'stretch'"),
    (["compare", "hinge", "--set", "a"], "found a; allowed: NAME=VALUE"),
    (["compare", "hinge", "--set", "t=2mm", "--set", "t=1.9mm"], "found t=2mm, t=1.9mm", "once for each name"),
    (["compare", "hinge", "mine-hinge.toml"], "Several scenes have the name hinge"),
    (["compare", "hinge", "no/such/file.toml"], "no/such/file.toml", "'cprbm new NAME'"),
    (["solve", "bytes.toml"], "bytes.toml"),
    (["solve", "."], "built-in case"),
    (["new", "9lives"], "found '9lives'; allowed: letters"),
    (["new", "a  b"], "found 'a  b'; allowed: letters"),
    (["new", "a/b"], "found 'a/b'; allowed: letters"),
    (["new", ""], "found ''; allowed: letters"),
]
NUMBERS = [
    *(
        ([command, "hinge", f"--tol={text}"], f"found {text!r}; allowed")
        for command in ("solve", "compare")
        for text in ("0", "-1%", "100%", "1", "nan", "%", "tight", "1e-3%%", "inf")
    ),
    *(
        ([command, "hinge", "--tol", "1%", *option], f"--tol and {option[0]}")
        for command in ("solve", "compare")
        for option in (["-n", "40"], ["--elements", "beam1=30,beam2=40"], ["--across", "3"])
    ),
    *((["converge", "hinge", "--sizes", sizes], "allowed") for sizes in ("40", "20,20", "ten,20", "", "0,10")),
    (["bench", "hinge", "--sizes", "40,many"], "'many'"),
    (["bench", "hinge", "--sizes", ""], "''"),
    (["bench", "hinge", "--repeat", "0"], "'0'"),
    (["bench", "hinge", "--at-most", "-1"], "'-1'"),
    (["bench", "hinge", "--at-most", "nan"], "'nan'"),
    (["bench", "hinge", "--method", "other"], "'other'"),
    (["bench", "hinge", "--stations", "first"], "'first'"),
    (["bench", "hinge", "-n", "beam1=many"], "'many'"),
    (["bench", "hinge", "-n", "beam1=30"], "beam1=30"),
    (["bench", "hinge", "-n", "40", "--sizes", "40"], "--sizes and -n"),
]
OUTPUTS = [
    (["compare", "hinge", "--plot", "a.tiff"], "allowed: a name that ends in .svg or .png"),
    (["solve", "offset"], "no equilibrium"),
    (["bench", "offset"], "no equilibrium"),
    (["view", "tapered", "--out", "t.pdf"], "found 't.pdf'; allowed: a name that ends in .3d.png, .3d.gif"),
    (["view", "tapered", "--out", ".png"], "found '.png'; allowed"),
    (["view", "tapered", "--station", "0.8"], "'0.8'; allowed: one of load:0.3, load:0.7, load:1.3, load:2.9"),
    (["view", "tapered", "--station", "unload:0.7"], "found 'unload:0.7'; allowed"),
    (["view", "tapered", "--station", "nan"], "found 'nan'; allowed"),
    (["view", "tapered", "--quantity", "colour"], "'colour' is not one of"),
]
UNITS = 'units = { length = "mm", force = "N", angle = "deg", stress = "MPa" }'
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
    (UNITS, 'units = { lenght = "mm" }', "units.lenght", "is 'length' meant?"),
    (UNITS, 'units = { stress = "mpa" }', "units.stress: found 'mpa' (is 'MPa' meant?)"),
    (UNITS, 'units = { angle = "degree" }', "is 'deg' meant?"),
    (UNITS, 'units = { force = "mm" }', "units.force: found 'mm'; allowed: one of 'N', 'kN'"),
    # between short words nothing is guessed: any two units are near each other
    *(
        (UNITS, f'units = {{ force = "{unit}" }}', f"units.force: found {unit!r}; allowed: one of 'N'")
        for unit in ("M", "nm", "lb")
    ),
    (UNITS, 'units = "mm"', "units: found 'mm'; allowed: a table, as units = {"),
    (
        "thickness = 1.1",
        'thickness = "1.1 mm"',
        "found '1.1 mm'",
        "a number, or a table",
        "the key 'units', as units",
    ),
    ("radius = 6.0", 'radius = "6mm"', "found '6mm'; allowed: a number; numbers have no units", "units = { length"),
    ("radius = 6.0", 'radius = "six"', "found 'six'; allowed: a number, or an expression that begins with '='\n"),
]
SCENES = {
    "no TOML": (HINGE.replace("[bodies.AC]", "[bodies.AC"), "TOML"),
    "not finite": (HINGE.replace("2.3e9", "nan"), "materials.abs.youngs_modulus"),
    "an end that meets nothing": (HINGE.replace('"weld", point = "B"', '"weld", point = "D"'), "beams.beam1.end"),
    "a load on ground": (HINGE.replace('body = "BD"', 'body = "AC"'), "loads.M.body"),
    "a load on a driven body": (
        HINGE.replace("[loads.M]", '[drives.d]\nkind = "rotation"\nbody = "BD"\n[loads.M]'),
        "loads.M",
    ),
    "beams that overlap": (HINGE.replace('thickness = "= t"', "thickness = 0.0032"), "contacts.contact"),
    "a beam too short": (PRESTRESSED.replace("0.06]", "0.05]", 1), "a beam too short to reach 'B'"),
    "no stations": (re.sub(r"stations = \[.*?\]", "stations = []", PRESTRESSED, flags=re.DOTALL), "stages[0].stations"),
    "a stop in the way as drawn": (
        PRESTRESSED.replace('["= -t/2", 0.06]', "[-0.02, 0.05]")
        .replace("beam1 = 4.0, ", "")
        .replace("most = 0.785398163397448", "most = -1.3", 1)
        .replace("least = -0.785398163397448", "least = -1.4", 1),
        "stops.stopB",
    ),
    "a limit above the other": (PRESTRESSED.replace("least = -0.78", "least = 0.79", 1), "less than the most"),
}


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    folder = tmp_path_factory.mktemp("files")
    assert run(["new", "mine", "--out", str(folder), "--quiet"]) == 0
    (folder / "mine-hinge.toml").write_text(HINGE, "utf-8")
    (folder / "bytes.toml").write_bytes(b'name = "\xff"')
    (folder / "in the way").write_text("", "utf-8")
    return folder


@pytest.fixture
def folder(files, tmp_path, monkeypatch):
    shutil.copytree(files, tmp_path, dirs_exist_ok=True)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def _said(arguments, capsys):
    """The sentence on standard error; nothing is solved before the question is read and the folders are made."""
    asked = []

    def noting(scene, choices):
        asked.append(scene.name)
        raise RuntimeError

    assert run(arguments, Solvers(noting, noting)) == 2
    assert asked == []
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err.startswith("cprbm: ")
    assert "?." not in captured.err
    assert ".." not in captured.err.replace("...", "")
    return captured.err


@pytest.mark.parametrize(
    ("arguments", "parts"),
    [(words[0], words[1:]) for words in (*WORDS, *NUMBERS, *OUTPUTS)],
    ids=lambda it: str(it[-1]),
)
def test_wrong_words(arguments, parts, folder, capsys):
    said = _said(arguments, capsys)
    assert said.count("\n") == 1
    for part in parts:
        assert part in said


def test_a_built_in_case_has_the_name_of_its_question_and_no_other_name_opens_it():
    assert len(cases.names()) > 5
    assert [cases.asked(name).name for name in cases.names()] == list(cases.names())
    for name in ("", "Hinge", "hinge2", "../cases/hinge", "hinge\n"):
        with pytest.raises(SceneError, match=r"hinge|cannot be read"):
            cases.opened(name)


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


@pytest.mark.parametrize(("text", "part"), SCENES.values(), ids=SCENES)
def test_wrong_scenes(text, part, folder, capsys):
    assert text not in (HINGE, PRESTRESSED)
    Path("wrong.toml").write_text(text, "utf-8")
    said = [_said([command, "wrong.toml"], capsys) for command in ("solve", "compare", "converge")]
    assert said[0] == said[1] == said[2]
    assert said[0].startswith("cprbm: The question is wrong.")
    assert "wrong.toml: " in said[0]
    assert part in said[0]


def test_several_mistakes_have_a_line_each(folder, capsys):
    """The misspelt key, which alone stands for the missing key, and the width of both beams."""
    text = HINGE.replace("poisson_ratio", "poison_ratio").replace("width = 0.008", "width = -1.0")
    Path("wrong.toml").write_text(text, "utf-8")
    first, *lines = _said(["solve", "wrong.toml"], capsys).splitlines()
    assert first == "cprbm: The question is wrong."
    assert len(lines) == 3
    assert all(line.startswith("  wrong.toml: ") for line in lines)
    for part in ("poison_ratio", "beams.beam1.width: found -1.0", "beams.beam2.width: found -1.0"):
        assert sum(part in line for line in lines) == 1


@pytest.mark.parametrize(
    "arguments",
    [["compare hinge", "--out"], ["compare hinge", "--json"], ["solve hinge", "--json"], ["solve hinge", "--csv"],
     ["converge hinge", "--out"], ["bench tapered", "--out"], ["study table1", "--out"]],
    ids=" ".join,
)  # fmt: skip
def test_a_place_that_takes_no_file_is_a_sentence_before_any_solve(arguments, folder, capsys):
    command, option = arguments
    said = _said([*command.split(), "--quiet", option, str(folder / "in the way" / "numbers")], capsys)
    assert said.startswith(f"cprbm: Cannot write {folder / 'in the way'}")
    assert said.count("\n") == 1


@pytest.mark.parametrize(
    "arguments",
    [["compare", "no\x1b[35m.toml"], ["solve", "tapered", "--set", "\x1b[35m=3"], ["compare", "key.toml"],
     ["import", "\x1b[35m.dxf", "--thickness", "1", "--width", "1"], ["\x1b[35m"]],
    ids=["path", "parameter", "key", "drawing", "command"],
)  # fmt: skip
def test_no_control_character_of_a_file_or_argument_reaches_the_terminal(arguments, monkeypatch, folder, capsys):
    Path("key.toml").write_text('name = "a"\n["\\u001b[35m"]\na = 1\n', "utf-8")
    monkeypatch.setattr("click.utils.should_strip_ansi", lambda *given: False)  # as on a terminal
    said = _said(arguments, capsys)
    assert "\x1b" not in said
    assert "\\x1b[35m" in said

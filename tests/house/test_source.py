"""Rules of the house that a look at the source can check."""

import ast
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
HERE = Path(__file__).resolve()
FILES = sorted(
    path
    for part in ("cprbm_scene", "cprbm", "fea_reference", "elastica_reference", "comparisons", "benchmarks", "tests")
    for path in (ROOT / part).rglob("*")
    if path.suffix in {".py", ".toml", ".html", ".css", ".js", ".md"} and path.resolve() != HERE
)
# a folder below the root that only one machine has, or a Windows drive
MACHINE_PATH = re.compile(r"""(?<![\w.)\]}/-])/(?:home|root|tmp|work|opt|mnt|srv|Users)/\w|\b[A-Z]:\\\\?Users""")


def _called(node):
    """Last name of what a call calls, or nothing."""
    function = node.func if isinstance(node, ast.Call) else None
    return getattr(function, "attr", getattr(function, "id", ""))


def _is_idle(node):
    if isinstance(node, ast.Assert):
        # a tuple and a constant are always true, and NumPy's assertions answer None
        constant = isinstance(node.test, ast.Tuple | ast.Constant | ast.Lambda)
        return constant or _called(node.test).startswith("assert_")
    if isinstance(node, ast.Expr):
        # a comparison nobody looks at, an exception that is built and not raised
        dropped = _called(node.value) in {"allclose", "isclose", "approx"} or _called(node.value).endswith("Error")
        return dropped or isinstance(node.value, ast.Compare)
    return False


def idle_asserts(source):
    """Lines of checks that cannot fail."""
    return [node.lineno for node in ast.walk(ast.parse(source)) if _is_idle(node)]


def test_there_are_files_to_look_at():
    assert len(FILES) > 10


def test_no_source_names_a_folder_of_one_machine():
    found = [
        f"{path.relative_to(ROOT)}:{number}: {line.strip()}"
        for path in FILES
        for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), start=1)
        if MACHINE_PATH.search(line)
    ]
    assert found == []


@pytest.mark.parametrize("line", ['open("/home/me/x")', "x = '/tmp/a.txt'", "C:\\\\Users", "see /opt/data"])
def test_a_planted_path_is_found(line):
    assert MACHINE_PATH.search(line)


@pytest.mark.parametrize("line", ["N·m/rad", "a/home/b", "https://example.org/home/x", "(n,)/tmp", "../tmp/x"])
def test_what_is_no_path_of_a_machine_passes(line):
    assert not MACHINE_PATH.search(line)


def test_every_assert_can_fail():
    found = [
        f"{path.relative_to(ROOT)}:{line}"
        for path in FILES
        if path.suffix == ".py"
        for line in idle_asserts(path.read_text(encoding="utf-8"))
    ]
    assert found == []


@pytest.mark.parametrize(
    "source",
    [
        "assert (a == b, 'never')",
        "assert True",
        "np.allclose(a, b)",
        "a == b",
        "ValueError('built, not raised')",
        "assert np.testing.assert_allclose(a, b)",
    ],
)
def test_a_planted_assert_that_cannot_fail_is_found(source):
    assert idle_asserts(source)


def test_the_rooms_print_nothing():
    """Only the command line speaks: print and exit stand in comparisons.cli alone."""
    found = [
        f"{path.relative_to(ROOT)}:{node.lineno}"
        for path in FILES
        if path.suffix == ".py"
        and path.relative_to(ROOT).parts[0] != "tests"
        and path.relative_to(ROOT).parts[:2] != ("comparisons", "cli")
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(node, ast.Call)
        and (getattr(node.func, "id", "") in {"print", "exit", "quit"} or ast.unparse(node.func) == "sys.exit")
    ]
    assert found == []


def writes(source):
    """Lines that write a file."""
    return [
        node.lineno
        for node in ast.walk(ast.parse(source))
        if _called(node) in {"write_text", "write_bytes", "tofile", "savetxt", "savez", "mkstemp"}
        or (_called(node) in {"open", "fdopen"} and any(set("wax+") & set(mode) for mode in _texts(node)))
    ]


def _texts(call):
    given = [*call.args, *(keyword.value for keyword in call.keywords)]
    return [
        each.value for each in given if isinstance(each, ast.Constant) and re.fullmatch("[rwaxbt+]+", str(each.value))
    ]


def test_files_are_written_in_one_place_where_they_are_whole_or_not_there():
    found = [
        f"{path.relative_to(ROOT)}:{line}"
        for path in FILES
        if path.suffix == ".py"
        and path.relative_to(ROOT).parts[0] != "tests"
        and path.relative_to(ROOT).parts != ("comparisons", "writing.py")
        for line in writes(path.read_text(encoding="utf-8"))
    ]
    assert found == []


@pytest.mark.parametrize("source", ["p.write_text(x)", "open(p, 'w')", "p.open(mode='ab')", "np.savez(p, x)"])
def test_a_planted_write_is_found(source):
    assert writes(source)

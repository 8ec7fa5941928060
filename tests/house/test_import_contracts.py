"""The contracts of pyproject.toml on imports hold, and break on planted imports.

The planted packages carry the names of the product packages and lie in a temporary folder. A single run of
``lint-imports`` reads all planted packages, and the tests look for every planted import in the report.
"""

import ast
import json
import os
import re
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
SETTINGS = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["tool"]["importlinter"]
CONTRACTS = {contract["id"]: contract for contract in SETTINGS["contracts"]}
PACKAGES = (*SETTINGS["root_packages"], "fea_reference.solid", "comparisons.verdict")
PLANTED = tomllib.loads(Path(__file__).with_name("planted_imports.toml").read_text(encoding="utf-8"))
PROGRAM = Path(sys.executable).with_name("lint-imports")


def lint(packages, settings, configuration):
    """Exit code and report of ``lint-imports`` on the packages in a folder."""
    lines = [f"{key} = {json.dumps(value)}" for key, value in settings.items() if key != "contracts"]
    for contract in settings["contracts"]:
        lines += ["[[tool.importlinter.contracts]]", *(f"{key} = {json.dumps(each)}" for key, each in contract.items())]
    (configuration / "contracts.toml").write_text("\n".join(["[tool.importlinter]", *lines]), encoding="utf-8")
    done = subprocess.run(
        [PROGRAM, "--no-cache", "--no-logo", configuration / "contracts.toml"],
        cwd=packages,
        env=os.environ | {"PYTHONPATH": str(packages), "COLUMNS": "300"},
        capture_output=True,
        text=True,
        check=False,
    )
    return done.returncode, done.stdout + done.stderr


def lawful():
    """Lawful sources by file: a plain module in every package and forbidden room, and the doors of the libraries."""
    rooms = CONTRACTS["verdict"]["forbidden_modules"]
    sources = {f"{package.replace('.', '/')}/plain.py": "import numpy\n" for package in (*PACKAGES, *rooms)}
    for contract in CONTRACTS.values():
        for door in contract.get("allowed_importers", ()):
            name = f"{door.replace('.', '/')}{'/__init__' if door in PACKAGES else ''}.py"
            doors = [f"    import {each}\n" for each in contract["protected_modules"]]
            sources[name] = "".join([sources.get(name, "def f():\n"), *doors])
    return sources


def planted(folder, sources):
    """The folder with the sources written, and an ``__init__.py`` in every package."""
    for name, source in sources.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(source, encoding="utf-8")
        for above in path.relative_to(folder).parents[:-1]:
            (folder / above / "__init__.py").touch()
    return folder


def settings_for_planted(**changes):
    """The settings of the project without the present exceptions."""
    contracts = [{key: value for key, value in each.items() if key != "ignore_imports"} for each in CONTRACTS.values()]
    return SETTINGS | {"contracts": contracts} | changes


@pytest.fixture(scope="module")
def report(tmp_path_factory):
    """The report on all planted sources."""
    folder = planted(tmp_path_factory.mktemp("planted"), lawful() | PLANTED["sources"])
    code, text = lint(folder, settings_for_planted(), folder)
    assert code == 1
    return text


def test_the_contracts_hold():
    done = subprocess.run([PROGRAM, "--no-cache", "--no-logo"], cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout


def test_lawful_packages_pass(tmp_path):
    code, text = lint(planted(tmp_path, lawful()), settings_for_planted(), tmp_path)
    assert (code, re.findall(r"(\d+) broken", text)) == (0, ["0"]), text


@pytest.mark.parametrize("contract", PLANTED["report"])
def test_a_contract_breaks_on_planted_imports(report, contract):
    name = CONTRACTS[contract]["name"]
    assert f"{name} BROKEN" in report
    titles = "|".join(re.escape(each["name"]) for each in CONTRACTS.values())
    parts = re.split(rf"\n({titles})\n-+\n", report)
    found = dict(zip(parts[1::2], parts[2::2], strict=True))[name]
    assert [link for link in PLANTED["report"][contract] if link not in found] == [], found


def test_every_contract_has_a_planted_violation():
    assert set(PLANTED["report"]) == set(CONTRACTS)


def between_packages():
    """Settings with the contracts between packages, and with imports for type checkers counted."""
    names = ("scene", "solvers", "harness", "solid", "beams")
    return settings_for_planted(contracts=[CONTRACTS[name] for name in names], exclude_type_checking_imports=False)


def test_contracts_between_packages_hold_for_imports_of_type_checkers(tmp_path):
    code, text = lint(ROOT, between_packages(), tmp_path)
    assert code == 0, text


def test_a_planted_import_for_type_checkers_is_found(tmp_path):
    folder = planted(tmp_path, lawful() | {"cprbm/bad.py": PLANTED["for_type_checkers"]})
    code, text = lint(folder, between_packages(), tmp_path)
    assert code == 1
    assert "cprbm.bad -> fea_reference.plain" in text


def imports_by_computed_name(source):
    """Lines with a call of ``import_module`` or ``__import__``; contracts do not see the module."""
    calls = [node for node in ast.walk(ast.parse(source)) if isinstance(node, ast.Call)]
    names = {"import_module", "__import__"}
    return [call.lineno for call in calls if getattr(call.func, "attr", getattr(call.func, "id", "")) in names]


def test_no_module_is_imported_by_a_computed_name():
    files = [path for package in SETTINGS["root_packages"] for path in (ROOT / package).rglob("*.py")]
    found = {path for path in files if imports_by_computed_name(path.read_text(encoding="utf-8"))}
    assert len(files) > 100
    # the door to the developers' tools of a checkout; the commands, modules of the package of the module itself
    assert found == {ROOT / "comparisons" / "cli" / "commands.py"}


@pytest.mark.parametrize("source", ["importlib.import_module('fea' + name)", "m = __import__('comparisons')"])
def test_a_planted_import_by_a_computed_name_is_found(source):
    assert imports_by_computed_name(source) == [1]

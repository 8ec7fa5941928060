from pathlib import Path

import pytest

HINGE = Path(__file__).parents[2] / "comparisons" / "cases" / "hinge.toml"


@pytest.fixture
def hinge_text():
    return HINGE.read_text(encoding="utf-8")

"""The line on the log when kernels are compiled."""

import logging

import numba
import pytest
from numba.core.event import install_listener

from cprbm.chain.compiled import COMPILATION, Compilation, compiled


@pytest.fixture(autouse=True)
def _told(monkeypatch):
    # the process has said so already
    monkeypatch.setattr(COMPILATION, "spent", 1e9)


@pytest.mark.skipif(numba.config.DISABLE_JIT, reason="nothing is compiled")
def test_a_long_compilation_is_said_once(caplog):
    # functions without a file have no stored machine code, so that each is compiled here
    with caplog.at_level(logging.INFO, logger="cprbm"), install_listener("numba:compile", Compilation(0.0)):
        for text in ("lambda x: x + 1.0", "lambda x: 2.0 * x"):
            compiled(eval(text))(1.0)  # noqa: S307 - own text
    assert [record.getMessage() for record in caplog.records].count(caplog.records[0].getMessage()) == 1
    assert "compiles its kernels" in caplog.records[0].getMessage()


def test_a_short_compilation_is_not_mentioned(caplog):
    with caplog.at_level(logging.INFO, logger="cprbm"), install_listener("numba:compile", Compilation(1e6)):
        compiled(eval("lambda x: 3.0 * x"))(1.0)  # noqa: S307 - own text
    assert not caplog.records

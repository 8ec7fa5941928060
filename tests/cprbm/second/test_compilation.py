"""The line on standard error when kernels are compiled."""

import logging
import pickle

import numba
import pytest
from numba.core.event import install_listener

from cprbm.chain.compiled import COMPILATION, STAMP, Compilation, compiled
from cprbm.chain.kernel import evaluate_chains

pytestmark = pytest.mark.skipif(numba.config.DISABLE_JIT, reason="nothing is compiled")


@pytest.fixture(autouse=True)
def _said(monkeypatch):
    # the process's own listener is silent here
    monkeypatch.setattr(COMPILATION, "said", True)


def kernel(text, module):
    """A function without a file: without stored machine code, the function is compiled here."""
    function = eval(text)  # noqa: S307 - own text
    function.__module__ = module
    return compiled(function)


def test_a_compilation_is_said_once_and_at_once(caplog):
    with caplog.at_level(logging.WARNING, logger="cprbm"), install_listener("numba:compile", Compilation()):
        for text in ("lambda x: x + 1.0", "lambda x: 2.0 * x"):
            kernel(text, "cprbm.chain.kernel")(1.0)
    assert len(caplog.records) == 1
    assert "compiles its kernels" in caplog.records[0].getMessage()


def test_where_no_machine_code_is_stored_the_line_says_what_to_do(caplog, monkeypatch):
    listener = Compilation()
    monkeypatch.setattr(listener, "stored", False)
    with caplog.at_level(logging.WARNING, logger="cprbm"), install_listener("numba:compile", listener):
        kernel("lambda x: x + 2.0", "cprbm.chain.kernel")(1.0)
    assert "set NUMBA_CACHE_DIR" in caplog.records[0].getMessage()


def test_the_compilation_of_another_program_is_not_mentioned(caplog):
    with caplog.at_level(logging.WARNING, logger="cprbm"), install_listener("numba:compile", Compilation()):
        kernel("lambda x: 3.0 * x", "elsewhere")(1.0)
    assert not caplog.records


def test_stored_machine_code_is_out_of_date_once_any_module_with_kernels_changes():
    """Numba's index of a kernel holds the stamp of all modules, not of the kernel's module alone."""
    assert evaluate_chains._cache._cache_file._version == f"{numba.__version__} {STAMP}"


def test_an_older_index_that_names_a_class_which_is_gone_is_not_read(tmp_path, monkeypatch):
    stored = evaluate_chains._cache._cache_file
    monkeypatch.setattr(stored, "_index_path", str(tmp_path / "index"))
    gone = b"ccprbm.chain.kernel\nNoClassOfThisName\n."
    (tmp_path / "index").write_bytes(pickle.dumps(numba.__version__) + gone)
    assert stored._load_index() == {}
    (tmp_path / "index").write_bytes(pickle.dumps(stored._version) + gone)
    with pytest.raises(AttributeError, match="NoClassOfThisName"):
        stored._load_index()

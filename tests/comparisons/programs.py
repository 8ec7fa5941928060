"""Programs that run in a process of their own, and the texts of several commands of a process."""

import os
import pty
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

ROOT = Path(__file__).parents[2]
ENVIRONMENT = {**os.environ, "PYTHONPATH": str(ROOT), "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
MAIN = "from comparisons.cli.program import main; main()"
"""The command line; its words come from ``sys.argv``."""

WAITING = """
import signal
import time
from dataclasses import dataclass
from pathlib import Path

import comparisons.pairing
from comparisons.cli.program import main


class Waiting:
    def __call__(self, scene, choices):
        Path("started").touch()
        time.sleep(600.0)


@dataclass(frozen=True)
class Planted:
    cprbm: Waiting = Waiting()
    fea: Waiting = Waiting()
    exact: Waiting = Waiting()
    solid: None = None


if __name__ == "__main__":
    signal.signal(signal.SIGINT, signal.default_int_handler)  # a test run may be started so that it ignores the signal
    comparisons.pairing.Solvers = Planted
    main()
"""
"""The command line with solvers that make the file ``started`` and then wait."""

WORKERS = """
import os, time
from pathlib import Path
from comparisons.choices import Choices
from comparisons.executor import crew_of


def waits(scene, choices):
    Path(f"worker{os.getpid()}").touch()
    time.sleep(600.0)


if __name__ == "__main__":
    with crew_of(2) as crew:
        crew.answers([(waits, None, Choices()), (waits, None, Choices())])
"""
"""Two workers that make files with their numbers and then wait."""

SIGNALLED = """
import os, signal, sys
signal.signal({number}, signal.SIG_DFL)  # a test run may be started so that it ignores the signal
class Sending:
    def find_spec(self, name, path=None, target=None):
        if name == 'cprbm_scene.statement':
            os.kill(os.getpid(), {number})
sys.meta_path.insert(0, Sending())
sys.argv[1:] = ['solve', 'hinge']
from comparisons.cli.program import main
main()
"""
"""A program that sends itself the signal ``number`` at the import of a module, neither too early nor too late."""

ENDS = re.compile(r"== ended with (\d+) ==\r?\n")


def in_turn(commands):
    """Source of a program that runs command lines in turn, since a process loads all modules anew."""
    return f"""
import sys
from comparisons.cli.main import run

for asked in {list(commands)}:
    code = run(asked)
    for stream in (sys.stdout, sys.stderr):
        print(f"== ended with {{code}} ==", file=stream, flush=True)
"""


def told(out, err):
    """Exit code, standard output and standard error of every command of :func:`in_turn`."""
    codes = ENDS.findall(out)
    assert codes == ENDS.findall(err)
    texts = ENDS.split(out)[::2], ENDS.split(err)[::2]
    return [(int(code), *said) for code, *said in zip(codes, *texts, strict=False)]


def interrupted(words, folder, begun):
    """Standard output of ``program.py`` in a folder after an interrupt from the keyboard once ``begun()`` is true.

    The whole group of processes is interrupted, as on a terminal.  Checks the exit code and the sentence.
    """
    process = subprocess.Popen(
        [sys.executable, "program.py", *words],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        cwd=folder,
        env=ENVIRONMENT,
        start_new_session=True,
    )
    while not begun():
        assert process.poll() is None, process.communicate()
        time.sleep(0.05)
    os.killpg(process.pid, signal.SIGINT)
    out, sentence = process.communicate(timeout=60)
    assert process.returncode == 130
    assert sentence == "cprbm: Interrupted. Finished results stand; repeat the command to go on.\n"
    return out


def on_a_terminal(commands):
    """The texts of command lines with standard output in a pipe and standard error on a terminal.

    Raises:
        OSError: no pseudo-terminal can be opened.
    """
    mine, its = pty.openpty()
    # with few links, machine code takes longer to load
    environment = ENVIRONMENT | {"TERM": "xterm", "COLUMNS": "100", "NUMBA_DISABLE_JIT": "1"}
    process = subprocess.Popen(
        [sys.executable, "-c", in_turn(commands)], stdout=subprocess.PIPE, stderr=its, env=environment, cwd=ROOT
    )
    os.close(its)
    seen = b""
    while True:
        try:
            piece = os.read(mine, 4096)
        except OSError:  # the program's end of the terminal is closed
            break
        if not piece:
            break
        seen += piece
    os.close(mine)
    out = process.stdout.read().decode()
    process.stdout.close()
    assert process.wait() == 0, seen.decode()
    return told(out, seen.decode())

"""The worker's side: it ends with its studio, however that ends."""

import signal
import subprocess
import sys
from multiprocessing import Pipe
from pathlib import Path

import pytest

from studio.engine import worker
from studio.engine.worker import Finished, Found, Trouble, serve
from tests.engine.long_work import Counting, Failing

ROOT = Path(__file__).resolve().parents[2]

# A studio that is killed while it has something done.
_KILLED = """
import os, signal, time
from studio.engine.work import Work
from tests.engine.long_work import Slow

if __name__ == "__main__":
    work = Work(time.monotonic)
    work.start(Slow(10_000, 0.05))
    while work.poll() is None:
        time.sleep(0.01)
    os.kill(os.getpid(), signal.SIGKILL)
"""


def test_it_answers_until_nobody_is_there(monkeypatch) -> None:
    monkeypatch.setattr(worker.signal, "signal", lambda *_: None)
    monkeypatch.setattr(worker.os, "nice", lambda _: None)
    ours, theirs = Pipe()
    for task in (Counting(2), Failing(True)):
        ours.send(task)
    ours.send("no task at all")
    messages = []

    class Listening:
        recv = theirs.recv

        @staticmethod
        def send(message) -> None:
            messages.append(message)
            if len(messages) == 6:
                ours.close()

    serve(Listening())
    kinds = [type(message) for message in messages]
    assert kinds == [Found, Found, Finished, Found, Trouble, Trouble]
    assert "AttributeError" in messages[-1].words


@pytest.mark.skipif(sys.platform == "win32", reason="signals are those of POSIX")
def test_it_ends_when_its_studio_is_killed(tmp_path: Path) -> None:
    """The worker, with minutes of work before it, has the studio's output open as long as it lives.

    So waiting for the end of that output, as ``run`` does, is waiting for the worker's end.
    """
    script = tmp_path / "studio_to_be_killed.py"
    script.write_text(f"import sys; sys.path.insert(0, {str(ROOT)!r})\n{_KILLED}")
    killed = subprocess.run(
        [sys.executable, str(script)], capture_output=True, timeout=60, check=False
    )
    assert killed.returncode == -signal.SIGKILL
    assert killed.stderr == b""  # it goes quietly

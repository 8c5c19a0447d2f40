import subprocess
import sys

SCRIPT = """
import ctypes, logging, os, sys, threading
from studio.engine.silence import STDERR, STDOUT, silenced

logging.basicConfig(level={level}, stream=sys.stderr, format="log: %(message)s")
libc = ctypes.CDLL(None)
print("before")
with silenced(STDOUT), silenced(STDERR):
    libc.puts(b"buffered by C")
    os.write(1, b"written at once")
    os.write(2, b"an error of C")
    print("meanwhile")
    other = threading.Thread(target=print, args=("elsewhere",))
    other.start()
    other.join()
    print("complaint", file=sys.stderr)
libc.puts(b"C again")
print("after")
try:
    with silenced(STDOUT):
        raise RuntimeError
except RuntimeError:
    print("still")
"""


def run(level: str) -> tuple[list[str], str]:
    done = subprocess.run(
        [sys.executable, "-c", SCRIPT.format(level=level)],
        capture_output=True,
        text=True,
        check=True,
    )
    return done.stdout.split("\n"), done.stderr


def test_only_c_is_silenced_and_only_meanwhile() -> None:
    printed, complained = run("logging.INFO")
    python = [line for line in printed if line != "C again"]  # C flushes its own when it likes
    assert python == ["before", "meanwhile", "elsewhere", "after", "still", ""]
    assert "C again" in printed
    assert complained == "complaint\n"


def test_what_c_said_is_in_the_debug_log() -> None:
    _, complained = run("logging.DEBUG")
    for said in ("buffered by C", "written at once", "an error of C"):
        assert said in complained


def said_by_importing(module: str) -> str:
    done = subprocess.run(
        [sys.executable, "-c", f"import {module}"], capture_output=True, text=True, check=True
    )
    return done.stdout + done.stderr


def test_importing_the_world_prints_nothing_although_pybullet_does() -> None:
    assert said_by_importing("pybullet") != ""
    assert said_by_importing("studio.engine.world") == ""

"""Run the README's main job in a folder, and see that the address it prints answers with a page.

Usage: ``python .ci/serves.py FOLDER COMMAND``. Exit status 0 where the page is there.
"""

import os
import re
import signal
import subprocess
import sys
import urllib.request
from pathlib import Path


def main(folder: str, command: str) -> int:
    """Start the command, wait for its address, fetch the page, and end what was started."""
    process = subprocess.Popen(
        ["bash", "-c", command],
        cwd=folder,
        stdout=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )
    try:
        for line in process.stdout or ():
            print(line, end="")
            if found := re.search(r"http://127\.0\.0\.1:\d+", line):
                with urllib.request.urlopen(found[0], timeout=60) as answer:
                    page = answer.read()
                print(f"{found[0]} answers with {len(page):,} bytes")
                return 0 if b"<html" in page else 1
    finally:
        os.killpg(process.pid, signal.SIGTERM)
        process.wait()
    print(f"no address was printed in {Path(folder)}")
    return 1


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))

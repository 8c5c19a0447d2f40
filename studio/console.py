"""What commands print, and where: results to standard output, everything else to standard error."""

import contextlib
import json
import os
import sys
from collections.abc import Iterator
from typing import Any


@contextlib.contextmanager
def only_ours_on_stdout() -> Iterator[None]:
    """Send what libraries print to standard output to standard error, C code's prints included."""
    sys.stdout.flush()
    kept = os.dup(1)
    os.dup2(2, 1)
    try:
        yield
    finally:
        sys.stdout.flush()
        os.dup2(kept, 1)
        os.close(kept)


def log(text: str) -> None:
    """Tell on standard error what goes on."""
    print(f"studio: {text}", file=sys.stderr)


def as_json_text(value: dict[str, Any]) -> str:
    """Return an object as ``--json`` prints it."""
    return json.dumps(value, indent=2, allow_nan=False)

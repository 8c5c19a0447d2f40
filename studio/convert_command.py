"""The command ``studio convert``."""

from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Annotated

import tyro

from studio.console import as_json_text, log
from studio.engine.conversion import convert


@dataclass(frozen=True)
class Convert:
    """Write the skeletons of any file that is read as the studio's JSONL, or as MCAP."""

    source: Annotated[Path, tyro.conf.Positional, tyro.conf.arg(metavar="IN")]
    """A skeleton file in any supported format, or an MCAP recording of the studio."""
    target: Annotated[Path, tyro.conf.Positional, tyro.conf.arg(metavar="OUT")]
    """The file to write, with all bodies: a name that ends in .jsonl, .jsonl.gz or .mcap."""
    force: bool = False
    """Overwrite OUT if it exists."""
    json: bool = False
    """Print one JSON object."""

    def run(self) -> int:
        """Convert."""
        done = convert(self.source, self.target, self.force)
        for note in done.notes:
            log(f"{done.target}: {note}")
        text = f"{done.target}: {done.frames} frames, {done.bodies} bodies, from {done.format}"
        print(as_json_text(asdict(done)) if self.json else text)
        return 0

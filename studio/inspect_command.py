"""The command ``studio inspect``."""

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Literal

import tyro

from studio.console import as_json_text
from studio.engine.inspection import inspect_file


@dataclass(frozen=True)
class Inspect:
    """Say what is in a skeleton file or a recording, and how well Baxter could follow it."""

    file: Annotated[Path, tyro.conf.Positional]
    """A skeleton file in any supported format, or an MCAP recording of the studio."""
    arm: Literal["left", "right", "both"] | None = None
    """The arm to measure: by default the left one; of a recording, the one that was taught."""
    mapping: Literal["exact", "paper"] | None = None
    """The mapping to measure with: by default exact; of a recording, the one that was used."""
    mirror: bool = False
    """Measure as in a mirror: the robot's left arm follows the person's right one. A recording that
    was made so is measured so anyway."""
    calibrate_at: float | None = None
    """Seconds into the file at which the person stands still for 2 s, both arms hanging: corrects
    how the torso seems to lean. By default, of a recording, the calibration that was used."""
    body: str | None = None
    """The id of the body to follow, where several are seen."""
    json: bool = False
    """Print one JSON object."""

    def run(self) -> int:
        """Inspect the file."""
        inspection = inspect_file(
            self.file, self.body, self.arm, self.mapping, self.mirror, self.calibrate_at
        )
        print(as_json_text(inspection.to_dict()) if self.json else inspection)
        return 0

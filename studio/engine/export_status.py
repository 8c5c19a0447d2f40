"""What a snapshot tells of exports."""

from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True, eq=False)
class ExportStatus:
    """How an export stands."""

    running: tuple[str, ...] = ()  # kinds that are being written
    share: float = 0.0  # of the work
    number: int = 0  # of the newest export that is done
    files: tuple[Path, ...] = ()  # which it wrote
    opening: str = ""  # the session's archive that is being read, as people know it
    opened_from: Path | None = None  # where that lies

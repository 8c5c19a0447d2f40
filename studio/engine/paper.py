"""What the source paper states in its Table I, read from seeds/."""

import csv
from dataclasses import dataclass

from studio.engine.resources import resource_root

PAPER_JOINTS = ("s0", "s1", "e1")


@dataclass(frozen=True)
class PaperRow:
    """One column of the paper's Table I."""

    neurons: int
    mse: dict[str, float]  # by joint; the paper gives no unit, we read rad²


def paper_table() -> tuple[PaperRow, ...]:
    """Return the paper's Table I."""
    path = resource_root() / "seeds" / "table1.csv"
    with path.open(newline="", encoding="utf-8") as file:
        return tuple(
            PaperRow(
                int(row["neurons"]), {joint: float(row[f"mse_{joint}"]) for joint in PAPER_JOINTS}
            )
            for row in csv.DictReader(file)
        )

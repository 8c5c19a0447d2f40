"""A number with its equation: in symbols, with its values, and as a program that checks it."""

from dataclasses import dataclass
from pathlib import Path

_HERE = 'folder = "."'
_BEGIN = f"""\
import csv
import numpy as np

{_HERE}  # where the exported tables are


def columns(name, *wanted):
    with open(f"{{folder}}/{{name}}", newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    return np.array([[row[column] for row in rows] for column in wanted], dtype=float)


"""


@dataclass(frozen=True)
class Equation:
    """One number that the studio shows."""

    name: str  # for people
    unit: str  # of the value; empty for a pure number
    value: float
    formula: str  # what it is, in symbols
    filled: str  # the same with the present values in it
    source: str  # where the formula stands
    lines: str  # the end of the program, which prints the value

    def program(self, folder: Path | str = ".") -> str:
        """Return a program that prints the value from the tables in a folder; it needs NumPy."""
        return _BEGIN.replace(_HERE, f"folder = {str(folder)!r}") + self.lines


def short(value: float) -> str:
    """Return a number as an equation shows it."""
    return f"{value:.4g}"


def listed(names: list[str]) -> str:
    """Return names of columns as the arguments of a program's call."""
    return ", ".join(f'"{name}"' for name in names)

"""Tables of numbers, one frame a line, told apart by the number of their columns.

==========  =====================================================================================
75          25 x (x, y, z)
100         25 x (x, y, z, state or confidence), as in KiMoRe
101         a stamp in units of 100 ns, then as 100, as in LabanotationSuite (with a trailing comma)
175         25 x (x, y, z, qx, qy, qz, qw), as in Keraal; the orientations are passed over
==========  =====================================================================================

Cells are separated by commas, semicolons, tabs or blanks; one trailing separator, blank lines, any
line ends and header lines (fewer numbers than words, or column numbers from 0) are accepted.
No table tells hand states. Time starts at the first line; without stamps, 30 frames a second.

A fourth value a joint is the SDK's tracking state where the whole file holds nothing but 0, 1 and
2 there, and else a confidence from 0 to 1: tracked from 0.5 up, inferred above 0, not tracked at 0.
"""

from collections.abc import Iterable, Iterator

import numpy as np
from numpy.typing import NDArray

from studio.engine.errors import StudioError
from studio.engine.skeleton import (
    FRAME_RATE,
    JOINT_COUNT,
    FloatArray,
    Joint,
    Skeleton,
    Tracking,
    all_tracked,
)
from studio.engine.sources.family import Family, Frame, ParsedFile, check_time, shown

TRACKED_FROM = 0.5  # of confidence
STAMPS_A_SECOND = 10_000_000  # units of 100 ns
_VALUES_A_JOINT = {75: 3, 100: 4, 101: 4, 175: 7}  # by the number of columns
_MOST_CELLS = 1000  # that are counted; what looks like a table may be one endless line
_HEADER_LINES = 20  # at most; a longer beginning without numbers is no table
_NUMBER_CHARACTERS = frozenset(
    "0123456789+-.eEinfatyINFATY"
)  # float() also takes _ and other digits


def recognizes(head: str) -> bool:
    """Return whether one of the first lines is a row of numbers."""
    lines = head.replace("\r\n", "\n").replace("\r", "\n").split("\n")
    for count, (_, cells) in enumerate(_rows(lines)):
        if not _is_header(cells):
            return len(cells) > 1
        if count >= _HEADER_LINES:
            break
    return False


def read(text: Iterable[str]) -> ParsedFile:
    """Return the frames of a table's lines; raise StudioError that names line and column."""
    lines: list[int] = []  # the number of each row's line, counted from 1
    rows: list[FloatArray] = []  # as arrays: a list takes four times as much
    stamps: list[int | float] = []
    for line, cells in _rows(text):
        if not rows and _is_header(cells):
            continue
        if not rows or len(cells) != len(rows[0]):
            _check_width(line, cells, rows, lines)
        lines.append(line)
        numbers = [_number(cell, line, column) for column, cell in enumerate(cells, start=1)]
        rows.append(np.array(numbers))
        if len(cells) == 101:
            stamps.append(_exact(cells[0]))
    if not rows:
        raise StudioError("expected rows of numbers, found none")
    values = np.array(rows)  # (F, columns)
    rows.clear()  # a long table is large enough once
    columns = values.shape[1]
    joints = values[:, columns % 25 :].reshape(-1, JOINT_COUNT, _VALUES_A_JOINT[columns])
    tracking = _tracking(joints[:, :, 3], lines) if columns in (100, 101) else None
    return ParsedFile(
        format=f"table {columns}",
        frames=_frames(_times(stamps, lines) if stamps else None, joints[:, :, :3], tracking),
        has_hand_states=False,
        has_tracking=tracking is not None,
        has_stamps=bool(stamps),
    )


def _rows(lines: Iterable[str]) -> Iterator[tuple[int, list[str]]]:
    """Yield each line that is not blank: its number from 1, and its cells."""
    for line, content in enumerate(lines, start=1):
        if not content.strip():
            continue
        separator = next((mark for mark in ";," if mark in content), None)  # None: blanks and tabs
        cells = [cell.strip() for cell in content.strip().split(separator, _MOST_CELLS)]
        yield line, cells[:-1] if not cells[-1] else cells


def _is_header(cells: list[str]) -> bool:
    """Return whether these are words rather than numbers, or the columns' own numbers."""
    numbers = sum(_as_float(cell) is not None for cell in cells)
    return 2 * numbers <= len(cells) or cells == [str(column) for column in range(len(cells))]


def _check_width(line: int, cells: list[str], rows: list[FloatArray], lines: list[int]) -> None:
    if rows:
        expected = f"{len(rows[0])} columns as in line {lines[0]}"
    elif len(cells) not in _VALUES_A_JOINT:
        hands = ", since 26 x 3 are a HoloLens's hand and no body" if len(cells) in (78, 79) else ""
        expected = f"75, 100, 101 or 175 columns{hands}"
    else:
        return
    more = "more than " if len(cells) > _MOST_CELLS else ""
    found = f"{more}{min(len(cells), _MOST_CELLS)}"
    raise StudioError(f"line {line}: expected {expected}, found {found}")


def _number(cell: str, line: int, column: int) -> float:
    number = _as_float(cell)
    if number is None or not -np.inf < number < np.inf:
        raise StudioError(
            f"line {line}, column {column}: expected a finite number, found {shown(cell)}"
        )
    return number


def _as_float(cell: str) -> float | None:
    try:
        return float(cell) if _NUMBER_CHARACTERS.issuperset(cell) else None
    except ValueError:
        return None


def _exact(stamp: str) -> int | float:
    """Return a stamp without loss: as a float, one of 18 digits would lose its last."""
    try:
        return int(stamp)
    except ValueError:
        return float(stamp)


def _times(stamps: list[int | float], lines: list[int]) -> list[float]:
    """Return the times (F,) [s] since the first frame."""
    times: list[float] = []
    for stamp, line in zip(stamps, lines, strict=True):
        time = (stamp - stamps[0]) / STAMPS_A_SECOND
        try:
            check_time(time, times[-1] if times else None)
        except StudioError as error:
            raise StudioError(f"line {line}, column 1: {error}") from None
        times.append(time)
    return times


def _tracking(marks: FloatArray, lines: list[int]) -> NDArray[np.int8]:
    """Return the tracking states (F, 25) that the joints' fourth values (F, 25) stand for."""
    states = np.isin(marks, list(Tracking))
    if states.all():
        return marks.astype(np.int8)
    confidences = (marks >= 0.0) & (marks <= 1.0)
    if confidences.all():
        inferred = np.where(marks > 0.0, Tracking.INFERRED, Tracking.NOT_TRACKED)
        return np.where(marks >= TRACKED_FROM, Tracking.TRACKED, inferred).astype(np.int8)
    row, joint = np.argwhere(~states)[0]
    raise StudioError(
        f"line {lines[row]}, joint {joint} ({Joint(joint).name.lower()}): expected a tracking "
        f"state 0, 1 or 2 (or, in the whole file, confidences from 0 to 1), "
        f"found {marks[row, joint]:g}"
    )


def _frames(
    times: list[float] | None, positions: FloatArray, tracking: NDArray[np.int8] | None
) -> list[Frame]:
    unknown = all_tracked()
    frames: list[Frame] = []
    for index, points in enumerate(positions):
        time = times[index] if times is not None else index / FRAME_RATE
        states = tracking[index] if tracking is not None else unknown
        frames.append(Frame(time, (Skeleton(time, points, states),)))
    return frames


FAMILY = Family(
    "tables of 75, 100, 101 or 175 columns", recognizes, lambda content: read(content.lines())
)

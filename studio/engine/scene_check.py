"""Whether what a scene's file tells fits together: all on the desk, nothing in anything else."""

from collections.abc import Sequence

from studio.engine.errors import FileError
from studio.engine.scene_parts import Block, Desk, Zone, overlap

IN_DESK = 1e-3  # [m] by which a block may stand in the desk, for rounding


def check_blocks(file: str, desk: Desk, blocks: Sequence[Block]) -> None:
    """Look whether all blocks stand on the desk, and none in another.

    Raises
    ------
    FileError
        Where one does not; the message names the file, the place in it, and the cure.
    """
    for number, block in enumerate(blocks, 1):
        place = f"{file}: block {number}.position: {block.name!r}"
        lowest = block.position[2] - block.size[2] / 2
        if lowest < desk.top - IN_DESK:
            at = desk.top + block.size[2] / 2
            raise FileError(
                f"{place} stands in the desk; the lowest that its center fits is {at:g}"
            )
        if not _is_above(desk, block.position[0], block.position[1]):
            raise FileError(f"{place} is beside the desk, which spans {_span(desk)}: put it there")
        for other in blocks[: number - 1]:
            if overlap(block, other):
                raise FileError(f"{place} stands in {other.name!r}: move one of them")


def check_zones(file: str, desk: Desk, zones: Sequence[Zone]) -> None:
    """Look whether all zones lie on the desk; raise FileError as `check_blocks` does."""
    for number, zone in enumerate(zones, 1):
        corners = [
            (zone.center[0] + i * zone.size[0] / 2, zone.center[1] + j * zone.size[1] / 2)
            for i in (-1, 1)
            for j in (-1, 1)
        ]
        if not all(_is_above(desk, x, y) for x, y in corners):
            raise FileError(
                f"{file}: zone {number}.center: {zone.name!r} reaches beyond the desk, which spans "
                f"{_span(desk)}: move it, or make it smaller"
            )


def _is_above(desk: Desk, x: float, y: float) -> bool:
    (mx, my, _), (length, width, _) = desk.position, desk.size
    return abs(x - mx) <= length / 2 + IN_DESK and abs(y - my) <= width / 2 + IN_DESK


def _span(desk: Desk) -> str:
    (x, y, _), (length, width, _) = desk.position, desk.size
    return (
        f"x {x - length / 2:.2f} to {x + length / 2:.2f} m and "
        f"y {y - width / 2:.2f} to {y + width / 2:.2f} m"
    )

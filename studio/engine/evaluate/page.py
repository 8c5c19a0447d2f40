"""An evaluation as Markdown tables, and as one HTML page that needs no network."""

from collections.abc import Iterable, Sequence
from html import escape

import studio
from studio.engine.evaluate.charts import grid_picture
from studio.engine.evaluate.evaluation import Evaluation, Tested
from studio.engine.evaluate.grid import Grid
from studio.engine.evaluate.report import (
    conditions_in_words,
    hurting_in_words,
    paired_in_words,
    pooled_in_words,
)
from studio.engine.sweep_report import as_number, label_of

Rows = tuple[tuple[str, ...], list[tuple[str, ...]]]  # the head, then a row each
_STYLE = (
    'body{font:15px/1.5 system-ui,"DejaVu Sans",sans-serif;color:#222;background:#fff;'
    "margin:0 auto;max-width:1100px;padding:18px 28px 40px}"
    "table{border-collapse:collapse;font-variant-numeric:tabular-nums;margin:10px 0 18px}"
    "th,td{padding:3px 10px;text-align:left;vertical-align:top;border-bottom:1px solid #ddd}"
    "svg{max-width:100%;height:auto}footer{margin-top:30px;font-size:12.5px;color:#555}"
)


def evaluation_rows(found: Evaluation) -> Rows:
    """Return a motion beside the demonstrations as a table."""
    head = ("who", "success (95 % interval)", "why not", "in the same trials")
    rows: list[tuple[str, ...]] = [
        (found.tested.motion.name, found.tested.rate.words, failures(found.tested), "")
    ]
    rows += [
        (each.motion.name, each.rate.words, failures(each), paired_in_words(found.tested, each))
        for each in found.replays
    ]
    return head, rows


def parts_rows(found: Evaluation) -> Rows:
    """Return the success by what was drawn as a table: a row for each variation."""
    head = ("drawn", "lowest", "middle", "highest")
    rows = []
    for name, parts in found.parts.items():
        lowest, *middle, highest = [
            f"{100 * part.rate.value:.3g} % of {part.rate.trials} "
            f"({part.low:.3g} to {part.high:.3g})"
            for part in parts
        ]
        rows.append((name, lowest, *(middle or [""]), highest))
    return head, rows


def grid_rows(grid: Grid) -> Rows:
    """Return the networks as a table: a row for each number of neurons, a column a learner."""
    head = ("neurons", *(f"{name}: success, MSE / floor" for name in grid.learners))
    counts = sorted({cell.network.neurons for cell in grid.cells})
    rows = []
    for count in counts:
        cells = [
            cell
            for name in grid.learners
            for cell in grid.of(name)
            if cell.network.neurons == count
        ]
        told = [
            f"{100 * cell.tested.rate.value:.3g} % ({100 * cell.tested.rate.low:.3g} to "
            f"{100 * cell.tested.rate.high:.3g} %), {as_number(cell.network.floor_ratio, '.4g')}"
            for cell in cells
        ]
        rows.append((str(count), *told))
    own = pooled_in_words(grid.replays)
    rows.append(("the demonstrations' own", *([own] * len(grid.learners))))
    return head, rows


def markdown(rows: Rows) -> str:
    """Return a table as Markdown."""
    head, body = rows
    lines = [head, tuple("---" for _ in head), *body]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)


def evaluation_markdown(found: Evaluation) -> str:
    """Return a motion's evaluation as tables to be put into a text."""
    return f"{markdown(evaluation_rows(found))}\n\n{markdown(parts_rows(found))}\n"


def grid_markdown(grid: Grid) -> str:
    """Return the table of many networks, and below it the answers."""
    answers = [f"- {name}: {grid.answer(name)}." for name in grid.learners]
    return "\n".join([markdown(grid_rows(grid)), "", *answers, ""])


def evaluation_page(found: Evaluation) -> str:
    """Return a motion's evaluation as a page."""
    parts = [_table(evaluation_rows(found))]
    if found.replays:
        parts.append(_paragraph(f"The demonstrations' own rate: {pooled_in_words(found.replays)}."))
    parts += [_paragraph(words) for words in hurting_in_words(found)]
    parts.append(_table(parts_rows(found)))
    return _page("Does it do the task?", conditions_in_words(found.conditions), parts)


def grid_page(grid: Grid) -> str:
    """Return the evaluation of many networks as a page: picture, answers, table."""
    answers = [f"{label_of(name)}: {grid.answer(name)}." for name in grid.learners]
    parts = [grid_picture(grid), *map(_paragraph, answers), _table(grid_rows(grid))]
    return _page(
        "How many neurons does the task need?", conditions_in_words(grid.conditions), parts
    )


def failures(tested: Tested) -> str:
    """Return why trials failed, in one line."""
    return "; ".join(f"{count} × {why}" for why, count in tested.failures) or "–"


def _page(title: str, under: str, parts: Iterable[str]) -> str:
    return (
        '<!doctype html>\n<html lang="en"><head><meta charset="utf-8">'
        f'<meta name="viewport" content="width=device-width"><title>{escape(title)}</title>'
        f"<style>{_STYLE}</style></head>\n<body>\n<h1>{escape(title)}</h1>\n"
        + "\n".join([_paragraph(f"{under}."), *parts])
        + f"\n<footer>Made by <code>studio evaluate</code> of the teaching studio "
        f"{studio.__version__}. The same recordings and seed give the same numbers.</footer>"
        "\n</body></html>\n"
    )


def _paragraph(words: str) -> str:
    return f"<p>{escape(words)}</p>"


def _table(rows: Rows) -> str:
    head, body = rows

    def line(kind: str, cells: Sequence[str]) -> str:
        return f"<tr>{''.join(f'<{kind}>{escape(cell)}</{kind}>' for cell in cells)}</tr>"

    return f"<table>{line('th', head)}{''.join(line('td', row) for row in body)}</table>"

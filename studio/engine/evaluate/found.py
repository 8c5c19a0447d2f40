"""What an evaluation found, in all the forms in which it leaves the studio."""

from dataclasses import dataclass
from typing import Any

from studio.engine.evaluate.charts import grid_picture
from studio.engine.evaluate.evaluation import Evaluation
from studio.engine.evaluate.grid import Grid
from studio.engine.evaluate.page import (
    evaluation_markdown,
    evaluation_page,
    grid_markdown,
    grid_page,
)
from studio.engine.evaluate.report import (
    evaluation_as_json,
    evaluation_as_text,
    grid_as_json,
    grid_as_text,
)


@dataclass(frozen=True, eq=False)
class Found:
    """See the module; the same trials give the same of all of it, to the byte."""

    json: dict[str, Any]
    text: str
    tables: str  # Markdown
    page: str  # HTML
    picture: str = ""  # SVG; empty where one motion alone was evaluated


def shown_evaluation(found: Evaluation) -> Found:
    """Return one motion's evaluation."""
    return Found(
        evaluation_as_json(found),
        evaluation_as_text(found),
        evaluation_markdown(found),
        evaluation_page(found),
    )


def shown_grid(grid: Grid) -> Found:
    """Return the evaluation of many networks."""
    return Found(
        grid_as_json(grid),
        grid_as_text(grid),
        grid_markdown(grid),
        grid_page(grid),
        grid_picture(grid),
    )

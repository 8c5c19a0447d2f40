"""Small pieces of HTML. Whatever comes from outside, a file's name first of all, goes through here.

Sizes in ``em`` follow the panel's; sizes in ``vh`` grow with the screen, for the last row.
"""

import html
from collections.abc import Iterable, Sequence

from studio.panels.palette import PROBLEM, Color, css

_CODE = (  # one click marks all of it
    "user-select:all;padding:.15em .4em;border-radius:.25em;overflow-wrap:anywhere;flex:1;"
    "background:rgba(127,127,127,.16)"
)
_COPY = (
    "font:inherit;font-size:.85em;white-space:nowrap;cursor:pointer;padding:.1em .5em;"
    "color:inherit;background:none;"
    "border:1px solid var(--mantine-color-default-border);border-radius:.3em"
)
_BLOCK = "margin:0 .75em .6em .75em;line-height:1.35;overflow-wrap:anywhere"


def text(words: str) -> str:
    """Return words as HTML that shows exactly these words."""
    return html.escape(words)


def block(content: str, style: str = "") -> str:
    """Return HTML set apart as a paragraph of a panel."""
    return f'<div style="{_BLOCK};{style}">{content}</div>'


def note(words: str) -> str:
    """Return a quiet remark; nothing for no words."""
    return block(text(words), "font-size:.85em;color:var(--mantine-color-dimmed)") if words else ""


def command(words: str) -> str:
    """Return a command to type, and a button that copies it where the browser lets it."""
    copy = "navigator.clipboard?.writeText(this.previousElementSibling.textContent)"
    click = f"{copy}.then(()=>{{this.textContent='✔ copied'}})"
    return (
        '<span style="display:flex;gap:.4em;align-items:center">'
        f'<code style="{_CODE}">{text(words)}</code>'
        f'<button type="button" style="{_COPY}" onclick="{click}">copy</button>'
        "</span>"
    )


def problem(words: str) -> str:
    """Return something that went wrong: framed, with a word and a sign beside the color."""
    frame = f"border:2px solid {css(PROBLEM)};border-left-width:10px;border-radius:.3em;"
    return block(f"<b>⚠ Problem:</b> {text(words)}", f"{frame}padding:.3em .5em")


def reasons(words: Iterable[str]) -> str:
    """Return why something cannot be done yet, one line each; nothing for no words."""
    lines = [f"✖ {text(each)}" for each in dict.fromkeys(words) if each]
    return block("<br>".join(lines), "font-size:.9em") if lines else ""


def table(
    head: Sequence[str], rows: Iterable[Sequence[str]], bold: int | None = None, left: int = 1
) -> str:
    """Return a table: ``left`` columns of words, the others of numbers; row ``bold`` stands out."""

    def cell(kind: str, words: str, column: int, extra: str = "") -> str:
        align = "left" if column < left else "right;white-space:nowrap"
        style = f"text-align:{align};padding:.15em .3em;font-variant-numeric:tabular-nums;{extra}"
        return f'<{kind} style="{style}">{text(words)}</{kind}>'

    border = "border-bottom:1px solid var(--mantine-color-default-border)"
    lines = ["".join(cell("th", words, i, border) for i, words in enumerate(head))]
    for number, row in enumerate(rows):
        weight = "font-weight:700" if number == bold else ""
        lines.append("".join(cell("td", words, i, weight) for i, words in enumerate(row)))
    body = "".join(f"<tr>{line}</tr>" for line in lines)
    style = "width:100%;border-collapse:collapse;font-size:.9em"
    return block(f'<table style="{style}">{body}</table>')


def pill(sign: str, word: str, color: Color) -> str:
    """Return a word in a colored pill with a sign before it."""
    style = (
        f"display:inline-block;background:{css(color)};color:#fff;border-radius:999px;"
        "padding:0 .6em;font-weight:700;white-space:nowrap;font-size:max(24px,3vh)"
    )
    return f'<span style="{style}">{sign} {text(word)}</span>'

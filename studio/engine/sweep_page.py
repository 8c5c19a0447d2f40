"""A sweep as one HTML page that needs no network: a handout, on the screen and on paper."""

import math
from collections.abc import Sequence
from html import escape

import studio
from studio.engine.arms import in_words, short_names
from studio.engine.comparison import Contestant
from studio.engine.demonstration import SAMPLES
from studio.engine.learners import BUDGET
from studio.engine.paper import PAPER_JOINTS, paper_table
from studio.engine.sweep import Played, Quality, Sweep
from studio.engine.sweep_charts import (
    demonstration_charts,
    error_charts,
    output_charts,
    path_charts,
)
from studio.engine.sweep_report import as_number, label_of, settings_in_words
from studio.engine.task_words import TaskWords, task_words

_STYLE = """
:root { color-scheme: light; }
body { font: 15px/1.5 system-ui, "DejaVu Sans", sans-serif; color: #222; background: #fff;
  margin: 0 auto; max-width: 1260px; padding: 18px 28px 40px; }
section table { margin-top: 8px; }
h1 { font-size: 26px; margin: 0 0 2px; } h2 { font-size: 19px; margin: 34px 0 4px; }
p, ul { margin: 6px 0; max-width: 76em; } .lead { color: #555; } li { margin: 2px 0; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; font-size: 14px; }
th, td { padding: 3px 9px; text-align: right; white-space: nowrap; }
thead th { border-bottom: 1.5px solid #222; vertical-align: bottom; font-weight: 600; }
tbody tr:last-child td, tbody tr:last-child th { border-bottom: 1.5px solid #222; }
th.name, td.name { text-align: left; } tr.group th { text-align: left; padding-top: 9px; }
tr.taken td { background: #eef4fb; } tr.floor td { color: #555; font-style: italic; }
caption { text-align: left; font-weight: 600; padding-bottom: 4px; }
.tables { display: flex; gap: 44px; align-items: flex-start; margin-top: 10px; }
.charts { display: flex; flex-wrap: wrap; gap: 10px; }
.legend { font-size: 13px; max-width: none; } .key { margin-right: 18px; white-space: nowrap; }
.title { font-size: 13px; font-weight: 600; } .tick { font-size: 10.5px; fill: #444; }
.label { font-size: 11.5px; fill: #222; } .middle { text-anchor: middle; }
.end { text-anchor: end; } .grid { stroke: #e4e4e4; } .axis { stroke: #555; fill: none; }
svg text { font-family: inherit; } .note { font-size: 13px; color: #444; }
.side { flex: 0 0 330px; } dl { font-size: 12.5px; line-height: 1.4; margin: 16px 0 0; }
dt { font-weight: 600; float: left; margin-right: 6px; } dd { margin: 0 0 5px; }
footer { margin-top: 30px; font-size: 12.5px; color: #555; }
@page { size: A4 landscape; margin: 12mm; }
@media print { body { padding: 0; font-size: 11px; } table { font-size: 10px; }
  td, th { padding: 2px 6px; } dl, .legend, .note { font-size: 10px; }
  .side { flex-basis: 260px; } .tables { gap: 24px; } h2 { font-size: 15px; margin-top: 18px; }
  .charts { gap: 0; flex-wrap: nowrap; } .charts svg { flex: 1 1 0; min-width: 0; height: auto; }
  section, tr, .charts, dl { break-inside: avoid; } h2 { break-after: avoid; } }
"""


def sweep_page(table: Sweep, contestants: Sequence[Contestant] = ()) -> str:
    """Return the page: tables, curves, demonstrations, outputs, and the hand's path."""
    taught = table.taught
    count = len(taught.demonstrations)
    parts = [
        "<h1>Table I, with your own demonstrations</h1>",
        f'<p class="lead">{count} demonstration{"s" if count > 1 else ""} of {taught.duration:.1f}'
        f" s in the mean, {SAMPLES} × {len(taught.joints)} joint angles each, "
        f"{in_words(taught.arms)}, {taught.mapping} mapping.</p>",
        f"<ul>{''.join(f'<li>{line}</li>' for line in findings(table))}</ul>",
        f'<div class="tables"><div class="side">{_paper_table()}{_COLUMNS}</div>'
        f"{_own_table(table)}</div>",
        _section("How the error falls", error_charts(table), _ERRORS),
        _section("The demonstrations (the paper’s Fig. 9)", demonstration_charts(table), _SAMPLES),
        _section("The networks’ outputs (its Fig. 10, a to c)", output_charts(table), _OUTPUTS),
        _section("The hand’s path (its Fig. 10, d)", path_charts(table), _PATHS),
        _played_table(table),
    ]
    if contestants:
        parts.append(_section("Which learner?", _contest(contestants), _CONTEST))
    parts.append(_footer())
    return (
        '<!doctype html>\n<html lang="en"><head><meta charset="utf-8">'
        '<meta name="viewport" content="width=device-width"><title>Table I, with your own '
        f"demonstrations</title><style>{_STYLE}</style></head>\n<body>\n"
        + "\n".join(parts)
        + "\n</body></html>\n"
    )


_ERRORS = (
    "1 is the floor: what the demonstrations differ by among themselves at equal times, which no "
    "function of time can undercut. The paper’s demonstrations are not published, so its errors "
    "are divided by its own last column instead."
)
_SAMPLES = "Resampled to equal length, as sent to Baxter; how they differ is what makes the floor."
_OUTPUTS = "The networks of the marked rows over all demonstrations; these motions Baxter played."
_CONTEST = (
    f"Every learner had {BUDGET} settings to choose from, each judged by leaving out one "
    "demonstration at a time; shown is the best. The held-out error is the one that chose it, so "
    "it flatters all of them alike. Differences of a percent say nothing with few demonstrations."
)


_COLUMNS = """<dl>
<dt>MSE</dt><dd>mean square error over all demonstrations and samples. The paper names no unit for
 its own.</dd>
<dt>floor</dt><dd>the pooled variance of the demonstrations at equal times. MSE is exactly this plus
 the error on the mean curve.</dd>
<dt>held out</dt><dd>MSE on a demonstration that was not learned from, over that of the other
 demonstrations’ mean curve. About 1 is all that can be had.</dd>
<dt>ε*</dt><dd>the largest error over all joints and samples: the bound of the paper’s Eq. 12.</dd>
<dt>acceleration</dt><dd>root mean square between the samples, over that of a smoothing spline
 through the mean demonstration. Far above 1 the curve ripples where no sample sees it.</dd>
<dt>ripple</dt><dd>the largest distance from that spline.</dd>
<dt>fit</dt><dd>the quickest of three fits on this machine.</dd>
<dt>marked row</dt><dd>the smallest network within 1 % of the floor and of the best held-out error;
 where none is, the smallest within 1 % of that error alone. Baxter played it.</dd></dl>"""


def findings(table: Sweep) -> list[str]:
    """Return what a reader should see first, as HTML."""
    lines = []
    floored = [(row, row.quality.floor_ratio) for row in table.rows]
    known = [(row, ratio) for row, ratio in floored if ratio is not None]
    if table.floor is None:
        lines.append(f"There is no floor to compare with: {escape(table.floor_note)}.")
    if known:
        fewest = min(row.neurons for row, _ in known)
        shown = ", ".join(
            f"<b>{ratio:.4g}</b> for {escape(label_of(row.learner))}"
            for row, ratio in known
            if row.neurons == fewest
        )
        lines.append(f"The error with {fewest} neurons is this many times its floor: {shown}.")
    lines += [
        f"<b>{escape(label_of(name))}</b>, {escape(each.words)}"
        for name, each in table.suggestions.items()
    ]
    return lines


def _paper_table() -> str:
    head = "".join(f"<th>{joint}</th>" for joint in PAPER_JOINTS)
    body = "".join(
        f"<tr><td>{row.neurons}</td>"
        + "".join(f"<td>{row.mse[joint]:.4f}</td>" for joint in PAPER_JOINTS)
        + "</tr>"
        for row in paper_table()
    )
    return (
        "<table><caption>The paper’s Table I: MSE</caption>"
        f"<thead><tr><th>neurons</th>{head}</tr></thead><tbody>{body}</tbody></table>"
    )


def _own_table(table: Sweep) -> str:
    joints = short_names(table.taught.joints)
    head = "".join(f"<th>{joint}</th>" for joint in joints)
    rows = []
    for name in table.learners:
        rows.append(f'<tr class="group"><th colspan="{len(joints) + 7}">{label_of(name)}</th></tr>')
        for row in table.of(name):
            taken = ' class="taken"' if row is table.shown_row(name) else ""
            mse = "".join(f"<td>{value:.5f}</td>" for value in row.quality.mse)
            rows.append(f"<tr{taken}><td>{row.neurons}</td>{mse}{_quality(row.quality)}</tr>")
    if table.floor is not None:
        floor = "".join(f"<td>{value:.5f}</td>" for value in table.floor)
        rows.append(f'<tr class="floor"><td>floor</td>{floor}<td colspan="6"></td></tr>')
    return (
        "<table><caption>Yours: MSE [rad²], and what stands beside it</caption><thead><tr>"
        f"<th>neurons</th>{head}{_QUALITY_HEAD}</tr></thead><tbody>{''.join(rows)}</tbody></table>"
    )


_QUALITY_HEAD = (
    "<th>MSE /<br>floor</th><th>held<br>out</th><th>ε*<br>[deg]</th><th>accele-<br>ration</th>"
    "<th>ripple<br>[deg]</th><th>fit<br>[ms]</th>"
)


def _quality(quality: Quality) -> str:
    cells = (
        as_number(quality.floor_ratio, ".4f"),
        as_number(quality.held_out_ratio, ".4f"),
        f"{math.degrees(quality.largest.max()):.1f}",
        f"{quality.acceleration_ratio:.2f}",
        f"{math.degrees(quality.ripple):.2f}",
        f"{1000.0 * quality.fit_seconds:.1f}",
    )
    return "".join(f"<td>{cell}</td>" for cell in cells)


def _contest(contestants: Sequence[Contestant]) -> str:
    rows = "".join(
        f'<tr><td class="name">{escape(each.kind.label)}</td>'
        f'<td class="name">{escape(settings_in_words(each))}</td>{_quality(each.quality)}'
        f"<td>{1000.0 * each.quality.predict_seconds:.2f}</td>"
        f"{_played_cells(each.played)}</tr>"
        for each in contestants
    )
    return (
        '<table><thead><tr><th class="name">learner</th><th class="name">settings</th>'
        f"{_QUALITY_HEAD}<th>predict<br>[ms]</th>{_played_head(contestants[0].played.task)}"
        "</tr></thead>"
        f"<tbody>{rows}</tbody></table>"
    )


_PATHS = (
    "Baxter alone, by the networks of the marked rows, as measured. The hand’s error is its mean "
    "distance from the mean demonstration at equal times, and once time is warped: of a network of "
    "time most of the difference is the arm’s lag; a field keeps no time at all."
)


def _played_table(table: Sweep) -> str:
    rows = "".join(
        f'<tr><td class="name">{escape(label_of(name))}</td>'
        f"<td>{table.shown_row(name).neurons}</td>{_played_cells(played)}</tr>"
        for name, played in table.played.items()
    )
    remarks = "".join(
        f'<p class="note">{escape(label_of(name))}: {escape(played.remark)}.</p>'
        for name, played in table.played.items()
        if played.remark
    )
    return (
        '<table><thead><tr><th class="name">Baxter alone</th><th>neurons</th>'
        f"{_played_head(task_words(table.taught.scene))}</tr></thead>"
        f"<tbody>{rows}</tbody></table>{remarks}"
    )


def _played_head(task: TaskWords) -> str:
    return (
        "<th>hand’s<br>error [mm]</th><th>time<br>warped</th>"
        f'<th class="name">the<br>{task.what}</th>'
    )


def _played_cells(played: Played) -> str:
    error = played.deviation
    return (
        f"<td>{1000.0 * error.hand_mean:.1f}</td><td>{1000.0 * error.hand_dtw:.1f}</td>"
        f'<td class="name">{played.task.verb[not played.performance.done]}</td>'
    )


def _section(title: str, content: str, note: str) -> str:
    if not content:
        return ""
    words = f'<p class="note">{escape(note)}</p>' if note else ""
    return f"<section><h2>{title}</h2>{words}{content}</section>"


def _footer() -> str:
    return (
        f"<footer>Made by <code>studio sweep</code> of the teaching studio {studio.__version__}. "
        "Every number can be had again by running it on the same recordings; times differ between "
        "machines.</footer>"
    )

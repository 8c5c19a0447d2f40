"""The live stream in words: who sends, how fast, what became of it, and how late it is."""

from dataclasses import asdict

from studio.engine.live.access import Address
from studio.engine.live.latency import LatencyChain, Spread
from studio.engine.live.status import LiveStatus, in_short
from studio.panels import markup

MANY_LOST = 0.05  # of all messages; a sensor that is faster than 30 Hz loses more, as it must
_LINKS = (
    ("transit", "from the sensor (beyond its quickest)"),
    ("waiting", "waits for a tick"),
    ("computing", "until the command"),
    ("total", "arrival to command"),
    ("limiting", "the velocity limit adds"),
)


def described(live: LiveStatus | None) -> str:
    """Return a live stream's state as HTML; nothing where none are taken."""
    if live is None:
        return ""
    where = markup.block(f"Send to: {markup.command(live.address or 'not taken')}")
    return (
        where + _flow(live) + markup.note(in_short(live)) + _counts(live) + _latency(live.latency)
    )


def instructions(live: LiveStatus | None) -> str:
    """Return as HTML which command makes a webcam, or a recording, a sensor of this studio."""
    if live is None:
        return ""
    usual = live.address in ("", Address().url)
    to = "" if usual else f" --to {live.address}"
    play = f"studio play FILE --to {live.address or Address().url}"
    return (
        markup.block(
            f"<b>Your webcam</b>, in a second terminal: {markup.command('studio webcam' + to)}"
        )
        + markup.note(
            "The first time it sets up its tracker, which takes a few minutes. No picture is "
            "stored, and none leaves your computer."
        )
        + markup.block(f"<b>A recording</b> as a sensor: {markup.command(play)}")
    )


def _flow(live: LiveStatus) -> str:
    """Return rate and drops, each with a shape."""
    if not live.is_flowing:
        return markup.block("○ <b>nothing comes in</b>")
    counts = live.counts
    lost = counts.dropped + counts.late + counts.too_fast + counts.unreadable
    share = lost / counts.received if counts.received else 0.0
    sign = "✔" if share < MANY_LOST else "▲"
    return markup.block(
        f"● <b>{live.rate:.0f} frames/s</b> &nbsp; {sign} <b>{lost:,} lost</b> ({share:.1%})"
    )


def _counts(live: LiveStatus) -> str:
    """Return where the messages have gone, in one line; nothing before the first one."""
    counts = asdict(live.counts)
    received = counts.pop("received")
    if not received:
        return ""
    gone = [f"{number:,} {name.replace('_', ' ')}" for name, number in counts.items() if number]
    age = "" if live.age is None else f"; the newest frame is {live.age:.1f} s old"
    publishers = f"{live.publishers} connected; " if live.publishers != 1 else ""
    return markup.note(f"{publishers}{received:,} messages: {', '.join(gone)}{age}")


def _latency(chain: LatencyChain) -> str:
    """Return the latency chain as a table, as far as it was measured."""
    rows = []
    for link, words in _LINKS:
        spread: Spread | None = getattr(chain, link)
        if spread is not None:
            rows.append((words, f"{1000 * spread.p50:.1f}", f"{1000 * spread.p99:.1f}"))
    return markup.table(("latency [ms]", "p50", "p99"), rows) if rows else ""

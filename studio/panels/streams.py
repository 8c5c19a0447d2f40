"""The live stream in words: who sends, how fast, what became of it, and how late it is."""

from dataclasses import asdict

from studio.engine.live.latency import LatencyChain, Spread
from studio.engine.live.status import LiveStatus, in_short
from studio.panels import markup

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
    where = markup.block(f"Live streams: <b>{markup.text(live.address or 'not taken')}</b>")
    return where + markup.note(in_short(live)) + _counts(live) + _latency(live.latency)


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

"""What is wrong with a demonstration, in words: value, threshold and place of each flag."""

from studio.engine.entry import Entry
from studio.engine.quality import Flag
from studio.panels import markup

_SHOWN_PLACES = 3
_BLOCKS = "blocks down"  # the unit of what is counted, and not measured


def verdict(entry: Entry) -> str:
    """Return how many flags there are, in words with a shape."""
    if entry.flags is None:
        return "… being checked"
    count = len(entry.flags)
    return f"⚑ {count} flag{'s' if count > 1 else ''}" if count else "✔ no flags"


def explained(entry: Entry) -> str:
    """Return all flags as HTML, numbered as the sparkline marks them; nothing without any."""
    lines = [
        f"<div style='margin-bottom:.35em'><b>⚑ {number} {markup.text(flag.name)}</b>: "
        f"{markup.text(_figures(flag))}{markup.text(_places(flag, entry))}<br>"
        f"{markup.text(_sentence(flag.words))}</div>"
        for number, flag in enumerate(entry.flags or (), start=1)
    ]
    return markup.block("".join(lines), "font-size:.85em") if lines else ""


def _figures(flag: Flag) -> str:
    """Return a value against its threshold."""
    if flag.unit == _BLOCKS:
        return f"{flag.value:.0f} of {flag.threshold:.0f} {flag.unit}"
    relation = "over" if flag.value > flag.threshold else "under"
    return f"{_amount(flag.value, flag.unit)}, {relation} {_amount(flag.threshold, flag.unit)}"


def _amount(value: float, unit: str) -> str:
    if unit == "of the time":
        return f"{100.0 * value:.0f} % {unit}"
    return f"{value:.1f}°" if unit == "deg" else f"{value:.1f} {unit}"


def _places(flag: Flag, entry: Entry) -> str:
    """Return when, counted as in the sparkline: from the beginning of the whole."""
    begin, _ = entry.span
    spans = [f"{begin + start:.1f} to {begin + end:.1f} s" for start, end in flag.places]
    if flag.unit == _BLOCKS:
        return " at its end"
    if not spans:
        return ""
    more = f" and {len(spans) - _SHOWN_PLACES} more" if len(spans) > _SHOWN_PLACES else ""
    return f"; at {', '.join(spans[:_SHOWN_PLACES])}{more}"


def _sentence(words: str) -> str:
    return f"{words[:1].upper()}{words[1:]}."

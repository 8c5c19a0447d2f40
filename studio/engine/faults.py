"""Faults of the studio's own: said in words, and the traceback on standard error, once each."""

import logging
import traceback

_LOG = logging.getLogger(__name__)
_HOLDS = "nothing recorded is lost, and Baxter holds still"


class Faults:
    """What went wrong that nobody foresaw; ``outcome`` tells people what is left all the same."""

    def __init__(self, outcome: str = _HOLDS) -> None:
        self._outcome = outcome
        self._traced: set[tuple[str, int | None]] = set()  # file and line of each

    def in_words(self, fault: Exception) -> str:
        """Return what to tell people; log the traceback where this fault is a new one."""
        place = traceback.extract_tb(fault.__traceback__)[-1:]
        where = (place[0].filename, place[0].lineno) if place else ("", None)
        if where not in self._traced:  # a fault in every tick would otherwise flood the terminal
            self._traced.add(where)
            _LOG.error("internal fault", exc_info=fault)
        what = ascii(f"{type(fault).__name__}: {str(fault)[:200]}")[1:-1]
        return (
            f"Internal fault: {what}; {self._outcome}. The terminal that the studio was started in "
            "shows where it happened."
        )

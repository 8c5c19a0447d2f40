"""How long a frame is on its way, link by link, over the last seconds of a live run."""

from collections import deque
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from statistics import median_low
from typing import Any

from studio.engine.sources.strict_json import as_numbers

WINDOW = 300  # frames: ten seconds at 30 Hz


@dataclass(frozen=True)
class Spread:
    """What is usual and what is rare: the 50th and the 99th percentile [s]."""

    p50: float
    p99: float


@dataclass(frozen=True)
class LatencyChain:
    """The links of a live run's chain [s]; None where nothing was measured yet.

    - ``transit``: from the sensor's stamp to the arrival here, beyond the quickest frame of the
      window. The two clocks share no origin, so that only the difference is known; None for a
      publisher without stamps.
    - ``waiting``: from the arrival to the tick that takes the frame; a tick comes every 33 ms.
    - ``computing``: from that to the command given to the robot.
    - ``total``: from the arrival to the command.
    - ``limiting``: how long the robot would need to where the person is, at its top speed, if the
      person held still: what the velocity limits add, at every tick in which the robot follows (and
      on arming, what its slow approach adds).
    """

    transit: Spread | None = None
    waiting: Spread | None = None
    computing: Spread | None = None
    total: Spread | None = None
    limiting: Spread | None = None

    @classmethod
    def over(cls, chains: Sequence["LatencyChain"]) -> "LatencyChain":
        """Return the chain of a whole run of which ``chains`` tell some seconds each.

        Usual is the median of what was usual, and rare the worst of what was rare.
        """
        return cls(**{link: _over([getattr(each, link) for each in chains]) for link in LINKS})

    def to_dict(self) -> dict[str, Any]:
        """Return the same as JSON knows it: for each link [p50, p99] in seconds, or null."""
        spreads = {link: getattr(self, link) for link in LINKS}
        return {link: each and [each.p50, each.p99] for link, each in spreads.items()}

    @classmethod
    def of_dict(cls, told: Mapping[str, Any]) -> "LatencyChain":
        """Undo `to_dict`.

        Raises
        ------
        StudioError
            Where a link is no two finite numbers.
        """
        return cls(**{link: _spread(told.get(link), link) for link in LINKS})


LINKS = ("transit", "waiting", "computing", "total", "limiting")


def _over(spreads: Sequence[Spread | None]) -> Spread | None:
    known = [each for each in spreads if each is not None]
    if not known:
        return None
    return Spread(median_low(each.p50 for each in known), max(each.p99 for each in known))


def _spread(told: object, link: str) -> Spread | None:
    return None if told is None else Spread(*as_numbers(told, f"delays of {link}", 2).tolist())


class Delays:
    """The last delays of one link. Not thread-safe."""

    def __init__(self) -> None:
        self._delays: deque[float] = deque(maxlen=WINDOW)

    def add(self, seconds: float) -> None:
        """Take note of one more."""
        self._delays.append(seconds)

    def clear(self) -> None:
        """Forget all: another stream has begun."""
        self._delays.clear()

    def spread(self, above_least: bool = False) -> Spread | None:
        """Return the percentiles; with ``above_least``, of what each is above the least one."""
        if not self._delays:
            return None
        ordered = sorted(self._delays)
        least = ordered[0] if above_least else 0.0
        last = len(ordered) - 1
        middle, rare = ordered[last // 2], ordered[round(0.99 * last)]
        return Spread(middle - least, rare - least)

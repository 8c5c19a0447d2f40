"""What a studio's recording says of its own run: gate, limits and guard as they were."""

import math
import re
from collections import Counter
from dataclasses import dataclass
from itertools import pairwise

from studio.engine.calibration import Calibration, in_words
from studio.engine.gate_summary import GateSummary, summarize
from studio.engine.live.latency import LatencyChain, Spread
from studio.engine.recording import Recording, RecordingInfo
from studio.engine.retarget import Mapping

_LINKS = {
    "transit": "on the way here, beyond the quickest,",
    "waiting": "waiting for a tick",
    "computing": "computing",
    "total": "from arrival to command",
    "limiting": "limits' lag",
}
_WRISTS = {"zero": "wrists at zero", "level": "wrists level", "follow": "wrists follow the hands"}
_DISTANCE = re.compile(r" is (\d+) cm from ")  # as the guard words it, unless an arm just hangs


@dataclass(frozen=True)
class Recorded:
    """Counts over the ticks of a recording, 30 a second."""

    info: RecordingInfo
    gate: GateSummary
    limited: int  # ticks in which a position or velocity limit bit
    held: tuple[tuple[str, int], ...]  # why an armed robot did not follow, in how many ticks
    # What the guard did, in how many ticks, and the nearest [cm]; None for an arm that just hangs.
    guarded: tuple[tuple[str, int, int | None], ...]
    wrists: tuple[tuple[str, float, float], ...] = ()  # least and most [rad] of each driven one
    closings: int = 0  # of the grippers
    closed: int = 0  # ticks in which they were told to be closed
    latency: LatencyChain | None = None  # None where it was not followed live

    @classmethod
    def of(cls, recording: Recording) -> "Recorded":
        """Return what was recorded."""
        samples = recording.samples
        held = Counter(
            _without_distance(sample.held)
            for sample in samples
            if sample.gate.armed and sample.held
        )
        grips = [bool(sample.hands.closed) for sample in samples]
        chains = [sample.latency for sample in samples if sample.latency is not None]
        return cls(
            info=recording.info,
            gate=summarize(sample.gate for sample in samples),
            limited=sum(sample.limited for sample in samples),
            held=_counted(held),
            guarded=_guarded([sample.guarded for sample in samples if sample.guarded]),
            wrists=_wrists(recording),
            closings=sum(now and not before for before, now in pairwise([False, *grips])),
            closed=sum(grips),
            latency=LatencyChain.over(chains) if chains else None,
        )

    def to_dict(self) -> dict[str, object]:
        """Return the same as JSON knows it."""
        calibration = self.info.calibration
        return {
            "arms": self.info.arms,
            "mapping": self.info.mapping,
            "mirrored": self.info.mirrored,
            "lean_deg": None if calibration is None else math.degrees(calibration.lean),
            "gate_mode": self.info.gate,
            "source": self.info.source,
            "gate": self.gate.to_dict(),
            "limited_ticks": self.limited,
            "held": [{"reason": reason, "ticks": count} for reason, count in self.held],
            "guard": [
                {"what": what, "ticks": count, "nearest_cm": nearest}
                for what, count, nearest in self.guarded
            ],
            "hands": {
                "wrist": self.info.hands.wrist,
                "wrist_joints": [
                    {"joint": joint, "least_deg": math.degrees(a), "most_deg": math.degrees(b)}
                    for joint, a, b in self.wrists
                ],
                "gripper": self.info.hands.gripper,
                "closings": self.closings,
                "closed_ticks": self.closed,
            },
            "latency_s": None if self.latency is None else self.latency.to_dict(),
        }

    def lines(self) -> list[str]:
        """Return the same in words."""
        held = ", ".join(f"{reason} ({count})" for reason, count in self.held)
        guarded = ", ".join(
            f"{what} ({count})" if nearest is None else f"{what} ({count}, nearest {nearest} cm)"
            for what, count, nearest in self.guarded
        )
        return [
            f"source      {self.info.source}",
            f"gate        {self.gate}",
            f"limits      bit in {self.limited} of {self.gate.frames} ticks",
            f"held        {held or 'never'}",
            f"guard       {guarded or 'nothing came near'}",
            f"hands       {self._hands()}",
            *([] if self.latency is None else _latency_lines(self.latency)),
        ]

    def _hands(self) -> str:
        options = self.info.hands
        turned = ", ".join(
            f"{joint} {math.degrees(least):.0f}° to {math.degrees(most):.0f}°"
            for joint, least, most in self.wrists
        )
        wrist = f"{_WRISTS[options.wrist]} ({turned})" if turned else _WRISTS[options.wrist]
        times = "once" if self.closings == 1 else f"{self.closings} times"
        closed = f"closed {times}, for {self.closed} ticks" if self.closings else "never closed"
        return f"{wrist}; {f'gripper {closed}' if options.gripper else 'no gripper'}"


def how_in_words(mapping: Mapping, mirrored: bool, calibration: Calibration | None) -> str:
    """Return how a person's motion was made the robot's."""
    lean = "" if calibration is None else f", {in_words(calibration)}"
    return f"{mapping} mapping{', mirrored' if mirrored else ''}{lean}"


def _wrists(recording: Recording) -> tuple[tuple[str, float, float], ...]:
    """Return the least and the most [rad] that each driven joint of a wrist was sent."""
    joints = recording.info.hands.wrist_joints(recording.info.arms)
    columns = zip(*(sample.hands.wrist for sample in recording.samples), strict=True)
    found = zip(joints, columns, strict=False)  # without ticks there are no columns
    return tuple((joint, min(sent), max(sent)) for joint, sent in found)


def _guarded(reasons: list[str]) -> tuple[tuple[str, int, int | None], ...]:
    """Return what the guard did without the distances, how often, and the nearest [cm]."""
    counts: Counter[str] = Counter()
    nearest: dict[str, int] = {}
    for reason in reasons:
        distance = _DISTANCE.search(reason)
        what = _without_distance(reason)
        counts[what] += 1
        if distance:
            centimeters = int(distance[1])
            nearest[what] = min(nearest.get(what, centimeters), centimeters)
    return tuple((what, count, nearest.get(what)) for what, count in _counted(counts))


def _without_distance(reason: str) -> str:
    return _DISTANCE.sub(" near ", reason)


def _latency_lines(chain: LatencyChain) -> list[str]:
    """Return the live run's latency chain in words, usual and rare in milliseconds."""
    told = []
    for link, words in _LINKS.items():
        spread: Spread | None = getattr(chain, link)
        if spread is not None:
            told.append(f"{words} {1000 * spread.p50:.1f} ({1000 * spread.p99:.1f})")
    return ["latency     in ms, p50 (p99): " + (", ".join(told) or "nothing was measured")]


def _counted(counts: Counter[str]) -> tuple[tuple[str, int], ...]:
    return tuple(counts.most_common())

"""How well the arm's stages do on real recordings, against their bars, misses included.

Run it by ``python tests/bench/bench_arm.py [FOLDER]``; the folder of recordings is
``../shared/data/kinect`` unless told otherwise. It takes about ten seconds. The measures are
defined in `studio.engine.motion_measures`.
"""

import argparse
import math
import time
from collections.abc import Iterator
from pathlib import Path

from studio.engine.errors import FileError
from studio.engine.follow import newest_frames
from studio.engine.motion_measures import ArmMeasures, measure_arm, pooled
from studio.engine.pipeline import Pipeline
from studio.engine.retarget import MAPPINGS, Mapping
from studio.engine.robot import load_robot
from studio.engine.skeleton import SIDES
from studio.engine.sources import SkeletonRecording, read_skeletons

ROOT = Path(__file__).resolve().parents[2]
HEADER = (
    "| recording, arm | s | inside limits | flips (unexcused; clamp alone) | jitter [mm] before, "
    "after, ratio | lag [ms]: filter | end to end | limiter alone | limiter bit |"
)


def main() -> None:
    """Measure every recording of the folder, print the tables, and say which bars are missed."""
    parser = argparse.ArgumentParser(description=__doc__)
    default = ROOT.parent / "shared" / "data" / "kinect"
    parser.add_argument("folder", type=Path, nargs="?", default=default)
    recordings = list(read(parser.parse_args().folder))
    if not recordings:
        parser.error("no skeleton files there")
    for mapping in MAPPINGS:
        table(recordings, mapping)
    cost(recordings)


def read(folder: Path) -> Iterator[SkeletonRecording]:
    """Yield every skeleton file of a folder."""
    for path in sorted(folder.rglob("*")):
        if path.is_file() and path.suffix != ".md":
            try:
                yield read_skeletons(path)
            except FileError as error:
                print(f"left out: {error}")


def table(recordings: list[SkeletonRecording], mapping: Mapping) -> None:
    """Print one mapping's measures, recording by recording and pooled, and its bars."""
    print(f"\n## mapping {mapping}\n\n{HEADER}\n{'|---' * 9}|")
    found = []
    for recording in recordings:
        for side in SIDES:
            found.append(measure_arm(recording, side, mapping))
            print(row(f"{Path(recording.path).name}, {side}", found[-1]))
    every = pooled(found)
    print(row("all of them, pooled", every))
    for bite in every.bites:
        print(
            f"- {bite.joint} beyond its limit in {bite.ticks / every.ticks:.1%}, by "
            f"{math.degrees(bite.mean):.1f}° in the mean, {math.degrees(bite.largest):.1f}° at most"
        )
    worst = max(each.lag_of_filter for each in found if not math.isnan(each.lag_of_filter))
    print("\n| bar | reached | limit | |\n|---|---|---|---|")
    for name, reached, limit in (
        ("flips an arm-minute", every.flips_per_minute, 1.0),
        ("unexcused flips an arm-minute", every.unexcused_flips / every.minutes, 0.5),
        ("jitter after / before, pooled", every.jitter_after / every.jitter_before, 0.4),
        ("lag of the filter, pooled [s]", every.lag_of_filter, 0.10),
        ("lag of the filter, worst recording [s]", worst, 0.15),
        ("what the filter adds end to end [s]", every.lag_end_to_end - every.lag_of_limiter, 0.08),
    ):
        print(f"| {name} | {reached:.3f} | {limit} | {'' if reached <= limit else 'MISSED'} |")


def row(name: str, found: ArmMeasures) -> str:
    """Return one line of the table."""
    before, after = 1000 * found.jitter_before, 1000 * found.jitter_after
    lags = (found.lag_of_filter, found.lag_end_to_end, found.lag_of_limiter)
    return (
        f"| {name} | {60 * found.minutes:.1f} | {found.share_inside:.0%} | {found.flips} "
        f"({found.unexcused_flips}; {found.raw_flips}) | {before:.2f}, {after:.2f}, "
        f"{after / before if before else math.nan:.2f} of {found.quiet} | "
        f"{' | '.join(f'{1000 * lag:.0f}' for lag in lags)} | "
        f"{found.velocity_limited / max(found.ticks, 1):.0%} |"
    )


def cost(recordings: list[SkeletonRecording]) -> None:
    """Print what a frame costs, in the fastest of five passes over all recordings."""
    print("\n| arms | advance() [µs a frame] | of it the arms' stages |\n|---|---|---|")
    frames = [list(newest_frames(each)) for each in recordings]
    count = sum(map(len, frames))
    for arms in ("left", "both"):
        line = Pipeline.for_robot(load_robot(), arms, "exact", "open")
        whole, stages = [], []
        for _ in range(5):
            began = time.perf_counter()
            for each in frames:
                memory = line.start()
                for tick, frame in enumerate(each):
                    memory, _ = line.advance(memory, frame, tick / 30)
            whole.append(time.perf_counter() - began)
            began = time.perf_counter()
            for each in frames:
                seen = line.start().arms
                for tick, frame in enumerate(each):
                    pairs = zip(line.stages, seen, strict=True)
                    seen = tuple(stage.step(arm, frame, tick / 30) for stage, arm in pairs)
            stages.append(time.perf_counter() - began)
        print(f"| {arms} | {1e6 * min(whole) / count:.0f} | {1e6 * min(stages) / count:.0f} |")


if __name__ == "__main__":
    main()

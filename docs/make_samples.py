"""Make the recordings that ship with the studio: ``python docs/make_samples.py``."""

import shutil
from pathlib import Path

from studio.engine.follow import follow
from studio.engine.mcap_file import write_recording
from studio.engine.pipeline import Pipeline
from studio.engine.robot import load_robot
from studio.engine.skeleton import HandState
from studio.engine.sources import write_skeletons
from studio.engine.sources.demonstrator import demonstrate

SAMPLES = Path(__file__).resolve().parent.parent / "recordings" / "samples"
SEED = 0


def main() -> None:
    """Write four demonstrations, one of their streams, and one stream that never arms."""
    shutil.rmtree(SAMPLES, ignore_errors=True)
    SAMPLES.mkdir(parents=True)
    pipeline = Pipeline.for_robot(load_robot(), "left")
    for take in range(1, 5):
        path = SAMPLES / f"demonstration-{take}.mcap"
        write_recording(path, follow(demonstrate(SEED, take), pipeline))
    write_skeletons(SAMPLES / "teaches-the-push.jsonl", demonstrate(SEED, 1))
    without_lasso = (HandState.OPEN, HandState.CLOSED)
    write_skeletons(SAMPLES / "never-arms.jsonl", demonstrate(SEED, 1, without_lasso))


if __name__ == "__main__":
    main()

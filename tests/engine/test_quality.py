from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from studio.engine.demonstration import demonstrations_of
from studio.engine.follow import follow
from studio.engine.pipeline import Pipeline
from studio.engine.quality import (
    FARTHEST,
    LEAST_MOTION,
    LONGEST_DROPOUT,
    MOST_LIMITED,
    MOST_SHAKE,
    flags_of,
)
from studio.engine.robot import CONTROL_PERIOD, load_robot
from studio.engine.sources.demonstrator import demonstrate

FIRST, LAST = 40, 70  # ticks of a demonstration in which a defect is planted


@cache
def take(number, seed=3):
    pipeline = Pipeline.for_robot(load_robot(), "left", "exact", "sequence")
    recording = follow(demonstrate(seed, number), pipeline)
    (shown,) = demonstrations_of(recording, f"take {number}")
    return shown, recording


def peers_of(number):
    return [take(other)[0] for other in (1, 2, 3, 4) if other != number]


def planted(change, ticks=range(FIRST, LAST)):
    """Return take 1, some of its samples changed, as a demonstration and its recording."""
    shown, recording = take(1)
    samples = list(recording.samples)
    for tick in ticks:
        place = shown.first_sample + tick
        samples[place] = change(samples[place], tick)
    changed = replace(recording, samples=tuple(samples))
    rows = [sample.sent for sample in samples[shown.first_sample : shown.last_sample + 1]]
    return replace(shown, sent=np.array(rows)), changed


@pytest.mark.parametrize("number", [1, 2, 3, 4])
def test_clean_takes_raise_no_flag(number):
    assert flags_of(*take(number), peers_of(number)) == ()


def tremor(sample, tick):
    shaken = tuple(angle + np.radians(4.0) * np.sin(1.2 * tick) for angle in sample.wanted)
    return replace(sample, wanted=shaken)


DEFECTS = {
    "dropout": (lambda sample, _: replace(sample, held="left wrist not tracked"), LONGEST_DROPOUT),
    "limits hit": (lambda sample, _: replace(sample, limited=True), MOST_LIMITED),
    "jerk": (tremor, MOST_SHAKE),
}


@pytest.mark.parametrize("name", DEFECTS)
def test_a_planted_defect_is_found_alone_and_in_its_place(name):
    change, threshold = DEFECTS[name]
    (flag,) = flags_of(*planted(change), peers_of(1))
    assert (flag.name, flag.threshold) == (name, threshold)
    assert flag.value > threshold
    begin, end = max(flag.places, key=lambda place: place[1] - place[0])
    assert begin == pytest.approx(FIRST * CONTROL_PERIOD, abs=0.1)
    assert end == pytest.approx(LAST * CONTROL_PERIOD, abs=0.1)


def test_an_arm_that_hardly_moves_is_found():
    shown, recording = take(1)
    still = np.tile(shown.sent[:1], (len(shown.sent), 1))
    (flag,) = flags_of(replace(shown, sent=still), recording)
    assert (flag.name, flag.value, flag.threshold) == ("too little motion", 0.0, LEAST_MOTION)
    assert flag.places == ((0.0, shown.duration),)


def test_the_odd_one_out_is_found_and_nobody_else():
    shown, recording = take(1)
    odd = replace(shown, sent=shown.sent + np.radians(25.0))
    (flag,) = flags_of(odd, recording, peers_of(1))
    assert flag.name == "outlier"
    assert flag.value > flag.threshold >= FARTHEST
    assert flag.places[0][0] == 0.0
    for number in (2, 3, 4):
        others = [odd, *(peer for peer in peers_of(number) if peer.name != shown.name)]
        assert flags_of(*take(number), others) == ()
    assert flags_of(odd, recording, peers_of(1)[:1]) == ()  # of two, nobody knows which


def test_a_block_left_standing_is_found():
    shown, recording = take(1)
    last = recording.samples[-1]
    standing = replace(last, world=replace(last.world, done=False))
    untouched = replace(recording, samples=(*recording.samples[:-1], standing))
    (flag,) = flags_of(shown, untouched)
    assert flag.name == "block stands"


def test_all_defects_at_once_are_all_told():
    def everything(sample, tick):
        for change, _ in DEFECTS.values():
            sample = change(sample, tick)
        return sample

    assert {flag.name for flag in flags_of(*planted(everything))} == set(DEFECTS)

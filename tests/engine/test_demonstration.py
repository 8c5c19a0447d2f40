"""From recordings to aligned rows: trimmed to what was armed, resampled, split by demonstration."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from studio.engine.demonstration import (
    SAMPLES,
    Demonstration,
    DemonstrationSet,
    armed_stretches,
    demonstrations_of,
    resample,
)
from studio.engine.engage import ARRIVED_WITHIN, COMING
from studio.engine.errors import NothingTaughtError, StudioError
from studio.engine.follow import follow
from studio.engine.pipeline import Pipeline
from studio.engine.recording import Recording, Sample
from studio.engine.robot import load_robot
from studio.engine.sources.demonstrator import demonstrate


def made_up(
    duration: float = 3.0, mapping="exact", columns: int = 4, name: str = "a"
) -> Demonstration:
    times = np.linspace(0.0, duration, 90)
    sent = np.column_stack([np.sin(times + i) for i in range(columns)])
    return Demonstration(name, "left", mapping, times, sent, 0, 89)


@pytest.fixture(scope="module")
def recording() -> Recording:
    return follow(demonstrate(2, 1), Pipeline.for_robot(load_robot(), "left"))


def behind(sample: Sample) -> float:
    return float(np.abs(np.array(sample.wanted) - sample.sent).max())


def test_a_demonstration_is_the_armed_part_of_what_was_sent(recording: Recording) -> None:
    (only,) = demonstrations_of(recording, "take")
    armed = [i for i, each in enumerate(recording.samples) if each.gate.armed]
    assert recording.samples[armed[0]].held == COMING
    while behind(recording.samples[armed[0]]) > ARRIVED_WITHIN:  # on its way to the person
        armed.pop(0)
    assert recording.samples[armed[1]].held == ""
    assert (only.first_sample, only.last_sample) == (armed[0], armed[-1])
    assert np.array_equal(only.sent, [recording.samples[i].sent for i in armed])
    assert only.times[0] == 0.0
    assert only.duration == pytest.approx((armed[-1] - armed[0]) / 30)


def test_each_armed_stretch_is_a_demonstration_of_its_own(recording: Recording) -> None:
    twice = Recording(recording.info, recording.samples * 2)
    first, last = armed_stretches(recording)[0]
    n = len(recording.samples)
    assert armed_stretches(twice) == [(first, last), (first + n, last + n)]
    assert [d.name for d in demonstrations_of(twice, "take")] == ["take", "take (2)"]
    short = Recording(recording.info, recording.samples[: first + 15])
    assert demonstrations_of(short, "take") == []


@settings(deadline=None, derandomize=True)
@given(duration=st.floats(1.0, 20.0), seed=st.integers(0, 1000))
def test_resampling_keeps_the_ends_and_stays_between_what_was_sent(
    duration: float, seed: int
) -> None:
    shown = made_up(duration)
    for rows in (resample(shown), resample(shown, "random", np.random.default_rng(seed))):
        assert rows.shape == (SAMPLES, 4)
        assert np.allclose(rows[[0, -1]], shown.sent[[0, -1]])
        assert (rows >= shown.sent.min(axis=0) - 1e-12).all()
        assert (rows <= shown.sent.max(axis=0) + 1e-12).all()


def test_even_resampling_of_even_samples_is_the_identity() -> None:
    times = np.linspace(0.0, 5.0, SAMPLES)
    sent = np.random.default_rng(0).normal(size=(SAMPLES, 3))
    assert np.allclose(resample(Demonstration("a", "left", "paper", times, sent, 0, 1)), sent)


def test_random_interpolation_is_the_seeds() -> None:
    shown = made_up()
    same = [resample(shown, "random", np.random.default_rng(1)) for _ in range(2)]
    assert np.array_equal(*same)
    assert not np.array_equal(same[0], resample(shown))
    with pytest.raises(StudioError, match="seed"):
        resample(shown, "random")


def test_demonstrations_of_different_kinds_are_not_mixed() -> None:
    with pytest.raises(StudioError, match="paper mapping"):
        DemonstrationSet.of([made_up(), made_up(mapping="paper", columns=3, name="b")])
    with pytest.raises(NothingTaughtError):
        DemonstrationSet.of([])


def test_a_set_is_aligned_and_as_long_as_its_mean() -> None:
    taught = DemonstrationSet.of([made_up(2.0), made_up(4.0)])
    assert taught.rows.shape == (2, SAMPLES, 4)
    assert taught.duration == 3.0
    assert np.allclose(taught.mean, taught.rows.mean(axis=0))


def test_where_the_robot_never_gets_there_all_is_kept_in_which_somebody_is_followed(
    recording: Recording,
) -> None:
    first, last = armed_stretches(recording)[0]
    far = [
        replace(each, wanted=tuple(np.array(each.wanted) + 1.0)) if each.wanted else each
        for each in recording.samples
    ]
    far[first : first + 5] = [replace(each, wanted=None) for each in far[first : first + 5]]
    (only,) = demonstrations_of(Recording(recording.info, tuple(far)), "take")
    assert (only.first_sample, only.last_sample) == (first + 5, last)
    nobody = tuple(replace(each, wanted=None) for each in far)
    assert demonstrations_of(Recording(recording.info, nobody), "take") == []


def test_of_two_arms_the_first_that_has_come_begins(recording: Recording) -> None:
    first, _ = armed_stretches(recording)[0]
    arms = replace(recording.info, arms="both")
    pairs = []
    for i, each in enumerate(recording.samples):
        other = 1.0 if i < first + 60 else 0.0  # [rad] behind, of an arm that comes later
        wanted = None if each.wanted is None else (*each.wanted, *(each.sent + other).tolist())
        pairs.append(replace(each, sent=np.tile(each.sent, 2), wanted=wanted))
    (alone,) = demonstrations_of(recording, "take")
    (both,) = demonstrations_of(Recording(arms, tuple(pairs)), "take")
    assert both.first_sample == alone.first_sample
    assert np.array_equal(both.sent, np.tile(alone.sent, 2))

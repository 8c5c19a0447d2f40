"""What a recording tells of its run: counted from its samples, in JSON and in words."""

import math
from dataclasses import replace

import pytest

from studio.engine.calibration import Calibration
from studio.engine.follow import follow
from studio.engine.hands import HandCommand, HandOptions
from studio.engine.live.latency import LatencyChain, Spread
from studio.engine.pipeline import Pipeline
from studio.engine.recorded import Recorded
from studio.engine.recording import Recording
from studio.engine.robot import load_robot
from studio.engine.sources.demonstrator import demonstrate


@pytest.fixture(scope="module")
def recording() -> Recording:
    return follow(demonstrate(1, 1), Pipeline.for_robot(load_robot(), "left"))


def test_guard_and_holds_are_counted_without_their_numbers(recording: Recording) -> None:
    samples = list(recording.samples)
    first = next(i for i, sample in enumerate(samples) if sample.gate.armed) + 100
    for i, centimeters in enumerate((4, 3, 2)):
        words = f"left forearm is {centimeters} cm from the desk: slowed"
        samples[first + i] = replace(samples[first + i], guarded=words, held="left wrist")
    for i, centimeters in enumerate((2, 1), start=3):
        words = f"left upper arm is {centimeters} cm from the torso: stopped"
        samples[first + i] = replace(samples[first + i], guarded=words, held=words)
    hangs = "left upper arm rests beside the torso"
    samples[first + 5] = replace(samples[first + 5], guarded=hangs)
    found = Recorded.of(Recording(recording.info, tuple(samples)))
    assert ("left forearm near the desk: slowed", 3, 2) in found.guarded
    assert ("left upper arm near the torso: stopped", 2, 1) in found.guarded
    assert (hangs, 1, None) in found.guarded
    assert ("left wrist", 3) in found.held
    assert ("left upper arm near the torso: stopped", 2) in found.held
    text = "\n".join(found.lines())
    assert "left forearm near the desk: slowed (3, nearest 2 cm)" in text
    assert f"{hangs} (1)" in text
    assert f"bit in {found.limited} of {len(samples)} ticks" in text


def test_a_refusal_while_the_gate_is_closed_is_the_gates(recording: Recording) -> None:
    found = Recorded.of(recording)
    closed = sum(not sample.gate.armed for sample in recording.samples)
    assert sum(count for _, count in found.gate.reasons) == closed
    assert not {reason for reason, _ in found.held} & {reason for reason, _ in found.gate.reasons}
    assert found.to_dict()["source"] == "demonstrator:1 (demonstrator, seed 1)"


def test_hands_and_how_it_was_made_are_told(recording: Recording) -> None:
    assert "hands       wrists at zero; no gripper" in Recorded.of(recording).lines()
    info = replace(
        recording.info,
        mirrored=True,
        calibration=Calibration((math.sin(0.1), 0.0, -math.cos(0.1))),
        hands=HandOptions(gripper=True, wrist="level"),
    )
    grips = [False, True, True, False, True, False]
    samples = [
        replace(sample, hands=HandCommand((0.1 * i, -0.2, 0.0), grip))
        for i, (sample, grip) in enumerate(zip(recording.samples, grips, strict=False))
    ]
    found = Recorded.of(Recording(info, tuple(samples)))
    told = found.to_dict()
    assert (told["mirrored"], told["lean_deg"]) == (True, pytest.approx(math.degrees(0.1)))
    hands = told["hands"]
    assert (hands["wrist"], hands["gripper"]) == ("level", True)
    assert (hands["closings"], hands["closed_ticks"]) == (2, 3)
    assert hands["wrist_joints"][0] == {
        "joint": "left_w0",
        "least_deg": 0.0,
        "most_deg": pytest.approx(math.degrees(0.5)),
    }
    text = "\n".join(found.lines())
    assert "wrists level (left_w0 0° to 29°, left_w1 -11° to -11°, left_w2 0° to 0°)" in text
    assert "gripper closed 2 times, for 3 ticks" in text


def test_the_latency_of_a_live_run_is_told_and_a_files_is_not(recording: Recording) -> None:
    assert Recorded.of(recording).to_dict()["latency_s"] is None
    assert "latency" not in "\n".join(Recorded.of(recording).lines())
    samples = list(recording.samples)
    for i, usual in enumerate((0.001, 0.002, 0.004)):
        chain = LatencyChain(total=Spread(usual, 10 * usual))
        samples[30 * i] = replace(samples[30 * i], latency=chain)
    found = Recorded.of(Recording(recording.info, tuple(samples)))
    assert found.to_dict()["latency_s"]["total"] == [0.002, 0.04]
    assert "from arrival to command 2.0 (40.0)" in found.lines()[-1]

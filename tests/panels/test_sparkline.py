"""The picture of a demonstration: well-formed, in proportion, with marks where flags say."""

import re
from dataclasses import replace
from xml.etree import ElementTree

import numpy as np
import pytest

from studio.engine.arms import learned_joints
from studio.engine.demonstration import demonstrations_of
from studio.engine.entry import Entry
from studio.engine.export.material import Take
from studio.engine.quality import Flag
from studio.panels.sparkline import HEIGHT, MARK, TOP, WIDTH, legend, playhead, sparkline
from tests.engine.cards_at_hand import DEFECTS, listed, take, takes

CARD = Entry.of(1, take(1))


def drawn(entry: Entry) -> ElementTree.Element:
    return ElementTree.fromstring(sparkline(entry))


def lines(entry: Entry) -> list[np.ndarray]:
    found = []
    for line in drawn(entry).iter("polyline"):
        pairs = [pair.split(",") for pair in line.get("points", "").split()]
        found.append(np.array(pairs, dtype=float))
    return found


def marks(entry: Entry) -> list[ElementTree.Element]:
    return [r for r in drawn(entry).iter("rect") if r.get("fill") == MARK]


def test_each_joint_is_a_line_of_its_own_look_within_the_frame() -> None:
    svg = drawn(CARD)
    styles = {(e.get("stroke"), e.get("stroke-dasharray")) for e in svg.iter("polyline")}
    assert len(styles) == len(lines(CARD)) == 4
    for line in lines(CARD):
        assert (line[0, 0], line[-1, 0]) == (0.0, WIDTH)
        assert line[:, 1].min() >= TOP - 0.1
        assert line[:, 1].max() <= HEIGHT


def test_all_joints_share_one_scale() -> None:
    """Twice the angle is twice the height."""
    ranges = np.ptp(CARD.whole.sent, axis=0)
    heights = np.array([np.ptp(line[:, 1]) for line in lines(CARD)])
    np.testing.assert_allclose(heights / heights[0], ranges / ranges[0], atol=0.02)


def test_a_mark_lies_where_its_flag_says_also_when_trimmed() -> None:
    recording = DEFECTS["dropout"](1)
    (shown,) = demonstrations_of(recording, "planted")
    made = listed(Take(shown, recording), *takes()[1:])
    whole = made.entry(1)
    for kept in (whole, whole.trimmed(0.5, 6.0)):
        begin, _ = kept.span
        entry = replace(kept, flags=_moved(whole.flags, begin))
        (mark,) = marks(entry)
        ((start, end),) = whole.flags[0].places
        scale = WIDTH / entry.whole.duration
        assert float(mark.get("x")) == pytest.approx(start * scale, abs=0.1)
        assert float(mark.get("width")) == pytest.approx((end - start) * scale, abs=0.1)


def _moved(flags: tuple[Flag, ...], by: float) -> tuple[Flag, ...]:
    """Return flags as they are counted from a later beginning."""
    return tuple(
        replace(flag, places=tuple((a - by, b - by) for a, b in flag.places)) for flag in flags
    )


def test_a_moment_is_wide_enough_to_be_seen_and_stays_inside() -> None:
    end = CARD.whole.duration
    flag = Flag("block stands", 0.0, 1.0, "blocks down", "", ((end, end),))
    (mark,) = marks(replace(CARD, flags=(flag,)))
    assert float(mark.get("width")) >= 2.0
    assert float(mark.get("x")) + float(mark.get("width")) <= WIDTH


def test_flags_wear_the_numbers_under_which_they_are_explained() -> None:
    flags = tuple(
        Flag(str(n), 1.0, 0.0, "s", "", ((0.0, 0.5),) if n != 1 else ()) for n in range(4)
    )
    svg = drawn(replace(CARD, flags=flags))
    shown = [(text.text, float(text.get("x"))) for text in svg.iter("text")]
    assert [number for number, _ in shown] == ["1", "3", "4"]  # the second one has no place
    places = [x for _, x in shown]
    assert len(set(places)) == 3


def test_what_is_trimmed_off_lies_behind_a_veil() -> None:
    def veiled(entry: Entry) -> float:
        return sum(float(r.get("width")) for r in drawn(entry).iter("rect") if r.get("opacity"))

    assert veiled(CARD) == 0.0
    kept = CARD.trimmed(1.0, 4.0)
    off = 1.0 - kept.demonstration.duration / CARD.whole.duration
    assert veiled(kept) == pytest.approx(WIDTH * off, abs=0.5)


def test_the_playhead_is_upright_and_hidden_until_it_is_moved() -> None:
    (line,) = drawn(CARD).findall("line")
    assert line.get("visibility") == "hidden"
    assert (line.get("x1"), line.get("x2")) == ("0", "0")
    assert (float(line.get("y1")), float(line.get("y2"))) == (0.0, HEIGHT)


def test_the_playhead_is_where_the_replay_is_in_the_picture() -> None:
    whole = CARD.whole.duration
    assert playhead(CARD, CARD.take, 0.0) == 0.0
    assert playhead(CARD, CARD.take, whole / 2) == pytest.approx(WIDTH / 2)
    assert playhead(CARD, CARD.take, whole + 1.0) == WIDTH  # the block falls meanwhile
    kept = CARD.trimmed(1.0, 4.0)
    begin, _ = kept.span
    expected = WIDTH * (begin + 0.5) / whole
    assert playhead(kept, kept.take, 0.5) == pytest.approx(expected)
    # Trimmed or renamed while it is replayed, it is at the same place of the recording.
    assert playhead(CARD.renamed("other"), kept.take, 0.5) == pytest.approx(expected)


def test_another_demonstrations_replay_is_not_in_the_picture() -> None:
    assert playhead(CARD, None, 1.0) is None
    alike = replace(CARD.take, recording=take(2).recording)  # the same stretch of another one
    assert playhead(CARD, alike, 1.0) is None
    # Of the same recording, but another stretch of it.
    later = replace(CARD.whole, first_sample=CARD.whole.last_sample + 30)
    assert playhead(CARD, replace(CARD.take, demonstration=later), 1.0) is None
    assert playhead(replace(CARD, whole=later), CARD.take, 1.0) is None


def test_names_are_escaped_and_the_legend_shows_the_lines_looks() -> None:
    assert "<b>me" not in sparkline(CARD.renamed('<b>me"'))
    ElementTree.fromstring(sparkline(CARD.renamed('<b>me" &')))
    shown = legend(CARD.demonstration.joints)
    assert re.findall(r"</svg>(\w+)</div>", shown) == list(CARD.demonstration.joints)
    for line in drawn(CARD).iter("polyline"):
        assert f'stroke="{line.get("stroke")}"' in shown


def test_both_arms_joints_all_look_different() -> None:
    shown = legend(learned_joints("both", "exact"))
    looks = re.findall(r'stroke="[^"]*" stroke-width="[^"]*" stroke-dasharray="[^"]*"', shown)
    assert len(set(looks)) == len(looks) == 8

"""The list: numbers stay, only included ones are learned from, every planted defect is found."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from studio.engine.commands import Choose, Include, Rename, Trim
from studio.engine.demonstration import demonstrations_of
from studio.engine.errors import NothingTaughtError, StudioError
from studio.engine.export.material import Take
from studio.engine.listed import Listed
from studio.engine.quality import flags_of
from studio.engine.robot import CONTROL_PERIOD
from tests.engine.cards_at_hand import DEFECTS, MIDDLE, listed, names_of, settle, take, takes

events = st.lists(
    st.one_of(
        st.just(("add",)),
        st.tuples(st.sampled_from(["remove", "choose", "restore"]), st.integers(-1, 6)),
    ),
    max_size=14,
)


@settings(deadline=None, derandomize=True, max_examples=60)
@given(events)
def test_numbers_stay_and_the_chosen_one_is_always_listed(events) -> None:
    """Against a list of numbers, as simple as can be."""
    made, numbers, removed, added = Listed(), [], [], 0
    for kind, *which in events:
        if kind == "add":
            added += 1
            assert [entry.number for entry in made.add([take(1)])] == [added]
            numbers.append(added)
        elif kind == "restore":
            if removed:
                place, entry = removed.pop()
                made.insert(place, entry)
                numbers.insert(place, entry.number)
                assert made.chosen == entry.number
        elif which[0] not in numbers:
            with pytest.raises(StudioError, match="no such demonstration"):
                made.take(Choose(which[0])) if kind == "choose" else made.remove(which[0])
        elif kind == "remove":
            removed.append(made.remove(which[0]))
            assert removed[-1][1].number == which[0]
            numbers.remove(which[0])
        else:
            made.take(Choose(which[0]))
            assert made.chosen == which[0]
        assert [entry.number for entry in made.entries] == numbers
        assert (made.chosen in numbers) or (made.chosen, numbers) == (-1, [])
        assert made.index == (numbers.index(made.chosen) if numbers else -1)


def test_only_included_ones_of_the_arms_and_mapping_asked_for_are_learned_from() -> None:
    made = listed()
    assert len(made.taught("left", "exact").demonstrations) == 4
    made.take(Include(2, included=False))
    assert [each.name for each in made.taught("left", "exact").demonstrations] == [
        "take 1",
        "take 3",
        "take 4",
    ]
    with pytest.raises(NothingTaughtError, match="paper mapping"):
        made.taught("left", "paper")
    for number in (1, 3, 4):
        made.take(Include(number, included=False))
    with pytest.raises(NothingTaughtError, match="left out: include one"):
        made.taught("left", "exact")


def test_exports_get_what_the_list_shows() -> None:
    made = listed()
    made.take(Include(3, included=False))
    made.take(Rename(1, "Push"))
    made.take(Trim(2, 1.0, 4.0))
    shown = made.takes()
    assert [each.included for each in shown] == [True, True, False, True]
    assert shown[0].demonstration.name == "Push"
    assert shown[1].demonstration.duration == pytest.approx(3.0, abs=CONTROL_PERIOD)
    assert all(
        each.recording is entry.recording for each, entry in zip(shown, made.entries, strict=True)
    )


def test_four_clean_takes_have_no_flag() -> None:
    made = listed()
    assert [names_of(made, number) for number in (1, 2, 3, 4)] == [[], [], [], []]


@pytest.mark.parametrize("name", DEFECTS)
def test_a_planted_defect_is_found_through_the_list_and_nowhere_else(name: str) -> None:
    recording = DEFECTS[name](1)
    (shown,) = demonstrations_of(recording, "planted")
    made = listed(Take(shown, recording), *takes()[1:])
    found = names_of(made, 1)
    assert name in found
    assert set(found) <= {name, "outlier"}  # an arm that hardly moves is unlike the others, too
    assert [names_of(made, number) for number in (2, 3, 4)] == [[], [], []]
    (flag,) = [flag for flag in made.entry(1).flags if flag.name == name]
    beyond = flag.value < flag.threshold if "little" in name else flag.value > flag.threshold
    assert beyond
    assert flag.places
    if name in ("dropout", "limits hit", "jerk"):
        begin, end = max(flag.places, key=lambda place: place[1] - place[0])
        assert begin == pytest.approx(MIDDLE.start * CONTROL_PERIOD, abs=0.1)
        assert end == pytest.approx(MIDDLE.stop * CONTROL_PERIOD, abs=0.1)


def test_peers_are_the_included_ones() -> None:
    recording = DEFECTS["outlier"](1)
    (shown,) = demonstrations_of(recording, "odd")
    made = listed(Take(shown, recording), *takes()[1:])

    def flagged_after(*changes: Include) -> list[str]:
        for change in changes:
            made.take(change)
        settle(made)
        return names_of(made, 1)

    assert flagged_after() == ["outlier"]
    assert flagged_after(Include(1, included=False)) == ["outlier"]  # left out, and still unlike
    assert flagged_after(Include(2, included=False), Include(3, included=False)) == []  # 1 to 1
    assert flagged_after(Include(2, included=True), Include(3, included=True)) == ["outlier"]


def test_flags_are_those_of_the_demonstration_among_its_peers_after_any_change() -> None:
    made = listed()
    made.take(Trim(1, 2.0, 6.0))
    made.take(Include(4, included=False))
    made.remove(3)
    settle(made)
    shown = {entry.number: entry for entry in made.entries}
    for number, peers in ((1, (2,)), (2, (1,)), (4, (1, 2))):
        expected = flags_of(
            shown[number].demonstration,
            shown[number].recording,
            [shown[peer].demonstration for peer in peers],
        )
        assert names_of(made, number) == [flag.name for flag in expected]


def test_a_look_costs_one_comparison_and_nothing_is_looked_at_twice(monkeypatch) -> None:
    looked = []
    monkeypatch.setattr(
        "studio.engine.listed.flags_of", lambda shown, *_: looked.append(shown.name) or ()
    )
    made = Listed()
    made.add(takes())
    assert all(entry.flags is None for entry in made.entries)
    made.look()
    assert len(looked) == 1
    settle(made)
    settle(made)
    assert sorted(looked) == ["take 1", "take 2", "take 3", "take 4"]
    made.take(Trim(3, 1.0, 5.0))
    made.look()
    assert looked[4:] == ["take 3"]  # what was changed comes first
    settle(made)
    made.take(Rename(3, "another"))
    made.take(Choose(1))
    assert not made.look()
    assert len(looked) == 8

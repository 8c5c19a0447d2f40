"""The list of demonstrations: whatever is added and removed, what is chosen is on it."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from studio.engine.errors import NothingTaughtError, StudioError
from studio.engine.listed import Listed, why_nothing_armed
from studio.engine.mcap_file import read_recording
from studio.engine.recording import Recording
from studio.engine.resources import samples_folder

RECORDING = read_recording(samples_folder() / "demonstration-1.mcap")
NOTHING = Recording(RECORDING.info, RECORDING.samples[:20])
events = st.lists(
    st.one_of(
        st.just(("add",)),
        st.tuples(st.sampled_from(["remove", "choose"]), st.integers(-2, 5)),
    ),
    max_size=12,
)


@settings(deadline=None, derandomize=True, max_examples=40)
@given(events)
def test_the_chosen_one_is_always_listed(events) -> None:
    listed, names = Listed(), []
    for number, (kind, *index) in enumerate(events):
        match kind:
            case "add":
                names += [each.name for each in listed.add(RECORDING, str(number))]
            case _ if not 0 <= index[0] < len(names):
                with pytest.raises(StudioError, match="no such demonstration"):
                    getattr(listed, kind)(*index)
            case "remove":
                assert listed.remove(*index).name == names.pop(*index)
            case "choose":
                listed.choose(*index)
                assert listed.chosen == index[0]
        assert [entry.demonstration.name for entry in listed.entries] == names
        assert (0 <= listed.chosen < len(names)) or (listed.chosen, names) == (-1, [])


def test_only_the_arms_and_mapping_asked_for_are_learned_from() -> None:
    listed = Listed()
    listed.add(RECORDING, "one")
    assert len(listed.taught("left", "exact").demonstrations) == 1
    with pytest.raises(NothingTaughtError, match="paper mapping"):
        listed.taught("left", "paper")


def test_a_recording_in_which_nothing_armed_adds_nothing_and_says_why() -> None:
    listed = Listed()
    assert listed.add(NOTHING, "nothing") == []
    assert (listed.entries, listed.chosen) == ([], -1)
    assert why_nothing_armed(NOTHING, "nothing").startswith("nothing: nothing armed")

from dataclasses import replace

import numpy as np
import pytest

from studio.engine.errors import FileError, NothingTaughtError
from studio.engine.experiment import Setup
from studio.engine.export.material import cut, material_of
from studio.engine.resources import samples_folder
from tests.engine.export.materials import done, listed


def test_a_cut_is_the_demonstration_to_the_bit() -> None:
    for take in listed().takes:
        whole = take.demonstration
        found = cut(take.recording, whole.name, whole.first_sample, whole.last_sample)
        assert found.times.tobytes() == whole.times.tobytes()
        assert found.sent.tobytes() == whole.sent.tobytes()
        assert (found.arms, found.mapping, found.hands) == (whole.arms, whole.mapping, whole.hands)


def test_a_narrower_cut_is_a_trimmed_demonstration() -> None:
    take = listed().takes[0]
    whole = take.demonstration
    found = cut(take.recording, "trimmed", whole.first_sample + 10, whole.last_sample - 5)
    np.testing.assert_array_equal(found.sent, whole.sent[10:-5])
    np.testing.assert_allclose(found.times, whole.times[10:-5] - whole.times[10], atol=1e-12)


@pytest.mark.parametrize(("first", "last"), [(-1, 5), (5, 5), (6, 5), (0, 10**6)])
def test_samples_that_are_not_there_are_refused(first: int, last: int) -> None:
    with pytest.raises(FileError, match="push: samples"):
        cut(listed().takes[0].recording, "push", first, last)


def test_what_was_learned_from_is_found_by_its_motion_and_not_by_its_name() -> None:
    material = done()
    renamed = [
        replace(take, demonstration=replace(take.demonstration, name=f"my {i}"))
        for i, take in enumerate(material.takes)
    ]
    assert replace(material, takes=(*reversed(renamed),)).learned_from == (3, 2, 1, 0)
    assert replace(material, takes=(*renamed[1:],)).learned_from is None
    assert listed().learned_from is None


def test_demonstrations_left_out_are_not_taught() -> None:
    takes = listed().takes
    chosen = replace(listed(), takes=(replace(takes[0], included=False), *takes[1:]))
    assert len(chosen.taught.rows) == len(takes) - 1
    assert len(chosen.recordings) == len(takes)


def test_a_file_in_which_nothing_arms_says_why() -> None:
    with pytest.raises(NothingTaughtError, match=r"never-arms\.jsonl"):
        material_of([samples_folder() / "never-arms.jsonl"], Setup())

import numpy as np
import pytest

from studio.rbf import NewrbRegressor, suggest_from, suggest_neurons


@pytest.mark.parametrize("seed", range(3))
def test_the_suggestion_is_the_smallest_that_keeps_both_promises(demonstrations, seed):
    found = suggest_neurons(demonstrations(seed), counts=(30, 4, 8, 12, 20, 50))
    assert found.counts == (4, 8, 12, 20, 30, 50)
    assert found.reached
    enough = (found.floor_ratios <= 1.01) & (found.held_out <= 1.01 * found.held_out.min())
    assert found.neurons == np.array(found.counts)[enough][0]
    assert 4 < found.neurons <= 20
    assert found.words.startswith(f"{found.neurons} neurons: the smallest of the 6 counts")


def test_a_wider_tolerance_never_asks_for_more():
    ratios, errors = [2.0, 1.05, 1.004, 1.0], [9.0, 5.1, 5.01, 5.0]
    suggested = [suggest_from((5, 10, 20, 40), ratios, errors, t).neurons for t in (0, 0.01, 0.1)]
    assert suggested == [40, 20, 10]


def test_where_no_network_reaches_the_floor_it_says_so():
    found = suggest_from((5, 10), [1.5, 1.4], [3.0, 2.0])
    assert not found.reached
    assert found.neurons == 10
    assert "None that is comes within 1 % of the floor (1.4 times it)" in found.words


def test_without_a_floor_the_held_out_error_decides():
    arrays = [np.sin(np.linspace(0, 6, n))[:, None] for n in (50, 60)]
    stamps = [np.linspace(0, 6, n) for n in (50, 60)]
    found = suggest_neurons(arrays, stamps, counts=(2, 10))
    assert found.neurons == 10
    assert found.floor_ratios is None
    assert "no floor" in found.words


def test_newrb_is_asked_by_its_own_setting(demonstrations):
    learner = NewrbRegressor(spread=10.0)
    found = suggest_neurons(demonstrations(0), counts=(5, 25), estimator=learner)
    assert found.neurons == 25
    assert learner.max_neurons is None


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"counts": ()}, "at least one count"),
        ({"counts": (0,)}, "at least 1, not 0"),
        ({"tolerance": -0.1, "counts": (2,)}, "tolerance is a finite number at least 0"),
    ],
)
def test_what_cannot_be_tried_is_refused_in_words(demonstrations, arguments, words):
    with pytest.raises(ValueError, match=words):
        suggest_neurons(demonstrations(0, samples=20), **arguments)

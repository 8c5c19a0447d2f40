import numpy as np
import pytest
from sklearn.gaussian_process import GaussianProcessRegressor
from sklearn.model_selection import GridSearchCV, LeaveOneGroupOut, cross_val_score

from studio.rbf import LeaveOneDemonstrationOut, RBFRegressor, leave_one_demonstration_out

INDEX = np.arange(1.0, 143.0)


def test_it_splits_as_scikit_learn_does_by_groups():
    lengths = [3, 5, 4]
    groups = np.repeat([0, 1, 2], lengths)
    ours = list(LeaveOneDemonstrationOut(lengths).split(np.empty(12)))
    theirs = list(LeaveOneGroupOut().split(np.empty(12), groups=groups))
    assert len(ours) == LeaveOneDemonstrationOut(lengths).get_n_splits() == 3
    for (train, test), (other_train, other_test) in zip(ours, theirs, strict=True):
        np.testing.assert_array_equal(train, other_train)
        np.testing.assert_array_equal(test, other_test)


def test_scikit_learns_tools_take_it_and_find_the_same_error(demonstrations, pool):
    taught = demonstrations(0)
    index, rows = pool(taught)
    splitter = LeaveOneDemonstrationOut([142] * 4)
    scores = cross_val_score(
        RBFRegressor(20), index[:, None], rows, cv=splitter, scoring="neg_mean_squared_error"
    )
    held_out = leave_one_demonstration_out(RBFRegressor(20), taught)
    np.testing.assert_allclose(-scores, held_out.mse.mean(axis=1), rtol=1e-9)
    search = GridSearchCV(RBFRegressor(), {"n_neurons": [2, 15]}, cv=splitter)
    assert search.fit(index[:, None], rows).best_params_ == {"n_neurons": 15}


def test_the_others_mean_curve_scores_one_and_a_wrong_curve_more(demonstrations):
    class Mean:
        """Answers with the mean row of each stamp, whatever the network."""

        def fit(self, X, Y):
            self.curve = Y.reshape(-1, 142, 3).mean(axis=0)
            return self

        def predict(self, X):
            return self.curve

    taught = demonstrations(1)
    assert leave_one_demonstration_out(Mean(), taught).ratio == pytest.approx(1.0, rel=1e-12)
    assert leave_one_demonstration_out(RBFRegressor(1), taught).ratio > 2.0


def test_the_learner_is_left_alone_and_others_are_welcome(demonstrations):
    model = RBFRegressor(5)
    leave_one_demonstration_out(model, demonstrations(2))
    assert not hasattr(model, "weights_")
    short = demonstrations(2, samples=20)
    assert leave_one_demonstration_out(GaussianProcessRegressor(alpha=0.1), short).ratio > 0.5


def test_demonstrations_of_unlike_stamps_have_no_mean_curve():
    arrays = [np.sin(np.linspace(0, 3, n))[:, None] for n in (30, 40)]
    stamps = [np.linspace(0, 3, n) for n in (30, 40)]
    held_out = leave_one_demonstration_out(RBFRegressor(10), arrays, stamps)
    assert held_out.of_means is None
    assert held_out.ratio is None
    assert held_out.mse.max() < 1e-6
    alike = leave_one_demonstration_out(RBFRegressor(3), np.ones((2, 9, 1)))
    assert alike.ratio is None  # nothing differs


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: leave_one_demonstration_out(RBFRegressor(), np.ones((1, 9, 1))), "two or more"),
        (lambda: leave_one_demonstration_out(RBFRegressor(), [np.ones(3)]), r"shape \(K, T, D\)"),
        (
            lambda: leave_one_demonstration_out(RBFRegressor(), np.ones((2, 9, 1)), np.ones(8)),
            "stamps are one a row",
        ),
        (lambda: next(LeaveOneDemonstrationOut([2, 2]).split(np.ones(5))), "X has 5 rows"),
        (lambda: next(LeaveOneDemonstrationOut([4, 0]).split(np.ones(4))), "at least 1, not 0"),
    ],
)
def test_what_cannot_be_left_out_is_refused_in_words(call, words):
    with pytest.raises(ValueError, match=words):
        call()

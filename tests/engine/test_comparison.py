import numpy as np
import pytest

from studio.engine import comparison
from studio.engine.comparison import compare
from studio.engine.errors import StudioError
from studio.engine.learners import BUDGET, LEARNER_KINDS, LearnerKind
from studio.rbf import RBFRegressor, leave_one_demonstration_out
from tests.engine.sweeps import Ticking, samples


@pytest.fixture(scope="module")
def contestants():
    return compare(samples(), Ticking(), ("rbf", "spline"))


def test_each_wins_by_the_setting_that_leaves_out_best(contestants):
    rbf, spline = contestants
    errors = [
        leave_one_demonstration_out(
            RBFRegressor(settings["neurons"], width="dmax", solver="svd"), samples().rows
        ).mse.mean()
        for settings in rbf.kind.settings
    ]
    assert rbf.settings == rbf.kind.settings[int(np.argmin(errors))]
    assert rbf.quality.held_out == pytest.approx(min(errors))
    assert spline.kind.name == "spline"


def test_baxter_plays_the_winner_and_the_block_is_judged(contestants):
    assert all(each.played.performance.block_down for each in contestants)
    assert all(each.failed == 0 for each in contestants)


class Broken:
    """Fails, or answers nonsense, unless told otherwise."""

    def __init__(self, way):
        self.way = way

    def fit(self, X, Y):
        if self.way == "raises":
            raise np.linalg.LinAlgError("singular")
        self.rows = Y[:142] * (np.nan if self.way == "nan" else 1.0)
        return self

    def predict(self, X):
        return self.rows[(X.ravel() - 1.0).astype(int)]


@pytest.mark.parametrize("ways", [("raises",) * 11 + ("works",), ("nan",) * 12])
def test_settings_that_fail_are_counted_and_never_win(monkeypatch, ways):
    kind = LearnerKind("broken", "broken", Broken, tuple({"way": way} for way in ways))
    assert len(kind.settings) == BUDGET
    monkeypatch.setitem(LEARNER_KINDS, "broken", kind)
    if "works" not in ways:
        with pytest.raises(StudioError, match="broken can make nothing of these"):
            compare(samples(), Ticking(), ("broken",))
        return
    monkeypatch.setattr(comparison, "play", lambda task: task)
    (only,) = compare(samples(), Ticking(), ("broken",))
    assert only.settings == {"way": "works"}
    assert only.failed == 11


def test_one_demonstration_cannot_be_left_out():
    with pytest.raises(StudioError, match="give two or more"):
        compare(samples(1), Ticking(), ("rbf",))
